"""The closing summary of a run and of a redesign: their reports in a few lines."""

from collections.abc import Sequence

from meshwind.appearance.words import quantity, ratio, size
from meshwind.core.spoken import argument
from meshwind.core.units import reported_unit
from meshwind.results.pattern_types import AlternativeFigures, PatternFigures
from meshwind.results.redesign_report_types import (
    CourseFigures,
    LeftFigures,
    RedesignFigures,
    RedesignReport,
    RoundFigures,
)
from meshwind.results.report_types import Failure, PathsFigures, Report, StationFigures, SurfaceFigures
from meshwind.run.layer_table import layer_table

_LISTED = 12
"""Paths that a warning lists by their numbers."""


def run_lines(report: Report) -> list[str]:
    """A run's report in a few lines; raises LookupError or TypeError where a figure is missing."""
    part = report["mesh"]
    units = reported_unit(part["units"])
    return [
        f"part      {part['name']}: {size(part['size'], units, part['units_from'])}",
        f"mesh      {part['vertices']} vertices, {part['faces']} faces; {part['ends']}",
        *_surface(report["surface"], part["diagonal"], units),
        *_paths(report["paths"], units),
        *_layup(report, units),
        *_patterns(report.get("pattern", []), units),
        *layer_table(report, units),
        *_not_converged(report["paths"]["not_converged"], report["paths"]["advice"]["text"]),
        *(f"repair    {act}" for act in part["repairs"]),
        *(note_line(note) for note in report["notes"]),
        "seconds   " + ", ".join(f"{stage} {value:.2f}" for stage, value in report["seconds"].items()),
    ]


def note_line(note: str) -> str:
    """A note of a report as a line of a summary."""
    text = note.removeprefix("warning: ")
    return f"{'note' if text == note else 'warning':<10}{text}"


def _surface(surface: SurfaceFigures, diagonal: float, units: str) -> list[str]:
    """The errors of the fit in both directions, also over the part's diagonal."""
    around, along = surface["control_points"]
    vertices, facets = surface["fit_error"]["to_surface"]["max"], surface["fit_error"]["to_mesh"]["max"]
    tolerance = surface["tolerance"]
    led = surface["evidence"]["data"] if "evidence" in surface else "vertices"
    fitted_to = "" if tolerance is None or led != "vertices" else f", tolerance {ratio(tolerance)}"
    lines = [
        f"surface   {around} x {along} control points; largest distance to the vertices {quantity(vertices, units, 2)} "
        f"({ratio(vertices / diagonal)} of the part{fitted_to}), "
        f"to the facets {quantity(facets, units, 2)} ({ratio(facets / diagonal)})"
    ]
    if "evidence" in surface:
        found, doubt = surface["evidence"], surface["evidence"]["uncertainty"]
        lines.append(
            f"          fitted to the {led}; noise of the vertices {quantity(found['noise'], units, 2)}, "
            f"sagitta of the facets {quantity(found['sagitta'], units, 2)}; "
            f"uncertain by {quantity(doubt['rms'], units, 2)} (root mean squares), "
            f"at most {quantity(doubt['max'], units, 2)}"
        )
    return lines


def _paths(paths: PathsFigures, units: str) -> list[str]:
    failed = len(paths["not_converged"])
    which = f"; {'these' if paths['converged'] else 'all'}" if failed else ""
    bridged = f"bridged {100 * paths['bridged_fraction']:.1f} %" if paths["bridges"] else "no bridges"
    lines = [
        f"paths     {paths['converged']} of {paths['converged'] + failed} at rest{which}: length "
        f"{quantity(paths['length_total'], units)}, {bridged}"
    ]
    if paths["bridges"]:
        lines.append(
            f"bridges   {paths['bridges']}, the longest {quantity(paths['longest_bridge'], units)}, "
            f"the largest gap {quantity(paths['max_gap'], units, 3)}"
        )
    return lines


def _layup(report: Report, units: str) -> list[str]:
    """Coverage and spacing, and the winding angle along the part."""
    cover, near = report["coverage"], report["spacing"]
    shares = {"bare": cover["bare"], "once": cover["once"], "twice": cover["twice"], "more": cover["more"]}
    covered = ", ".join(f"{name} {100.0 * share:.0f} %" for name, share in shares.items())
    lines = [f"coverage  band {quantity(cover['band_width'], units, 3)}: {covered}"]
    if near["neighbours"]["max"] is not None:
        lines[0] += f"; neighbours up to {quantity(near['kept'], units, 3)} apart"
    if near["partings"]:
        many = len(near["partings"])
        lines[0] += f", {'but one pair' if many == 1 else f'but {many} pairs'} that part round a body, by up to "
        lines[0] += quantity(near["widest_parting"], units, 3)
    if report.get("angle_stations"):
        lines.append(_angles(report["angle_stations"]))
    return lines


def _angles(stations: Sequence[StationFigures]) -> str:
    """The winding angle by station: the median over the paths, and its extremes."""
    shown = [f"{each['angle']['median']:.1f} at v={each['v']:.3g}" for each in stations[::2]]
    least = min(each["angle"]["min"] or 0.0 for each in stations)
    most = max(each["angle"]["max"] or 0.0 for each in stations)
    return f"angle     {', '.join(shown)} degrees (median of the paths; {least:.1f} to {most:.1f} over all of them)"


def _patterns(layers: Sequence[PatternFigures], units: str) -> list[str]:
    """How each layer closes, and what else it could close in."""
    lines = []
    for layer in layers:
        angle, dwell = layer["angle"], layer["dwell"]
        lines += [
            f"filament  {layer['words']}; {quantity(layer['fibre_length'], units)}, {angle['min']:.1f} to "
            f"{angle['max']:.1f} degrees (median {angle['median']:.1f})",
        ]
        if not layer["turnarounds"]:
            continue
        lines += [
            f"turns     {_turn(layer, 0)}, dwell {dwell['start']['mean']:.3f}; {_turn(layer, 1)}, dwell "
            f"{dwell['end']['mean']:.3f} turns (mean)",
        ]
        others = [_alternative(each, angle["median"] or 0.0) for each in layer["alternatives"]]
        if others:
            lines.append(f"or        {'; '.join(others)}")
    return lines


def _alternative(each: AlternativeFigures, angle: float) -> str:
    side = "leading" if each["leading"] else "lagging"
    dwell = "" if each["dwell"] is None else f", or dwell {each['dwell']:+.3f}"
    return (
        f"{each['circuits']} circuits in {each['turns']} turns, {each['pattern_number']} {side} "
        f"({each['angle'] - angle:+.2f} degrees, cover {each['cover']:.3f}{dwell})"
    )


def _turn(layer: PatternFigures, k: int) -> str:
    turn = layer["turnarounds"][k]
    return f"{turn['kind']} at the {turn['end']}"


def _not_converged(failures: Sequence[Failure], holds: str) -> list[str]:
    """One line per status, with the paths that have it; what holds all of them follows on the same line if it can."""
    kinds: dict[str, list[Failure]] = {}
    for failure in failures:
        kinds.setdefault(failure["name"], []).append(failure)
    lines = []
    for alike in kinds.values():
        why = alike[0]["meaning"] if holds else alike[0]["why"]
        numbers = ", ".join(str(each["path"]) for each in alike[:_LISTED]) + ", ..." * (len(alike) > _LISTED)
        lines.append(f"warning   {len(alike)} path{'s' * (len(alike) > 1)} not at rest, {numbers}: {why}")
    if not holds:
        return lines
    return [f"{lines[0]}; {holds}"] if len(lines) == 1 else [*lines, f"advice    {holds}"]


def redesign_lines(report: RedesignReport) -> list[str]:
    """A redesign's report in a few lines; raises LookupError or TypeError where a figure is missing."""
    units = reported_unit(report["mesh"]["units"])
    return [
        *_edited_part(report),
        *(_round(each, units) for each in report["rounds"]),
        *_edit(report["redesign"], units),
        *_windings(report["windings"], units),
        *_left(report["redesign"]["left"], units),
        *_warnings(report),
    ]


def _edited_part(report: RedesignReport) -> list[str]:
    part, winding, windings = report["mesh"], report["winding"], report["windings"]
    if len(windings) > 1:
        wound = f"windings  {'; '.join(each['name'] for each in windings)}"
    elif (only := windings[0])["name"].startswith("layer"):
        families = f"; {winding['paths_per_family']} paths per family" if only["kind"] == "helical" else ""
        wound = f"winding   {only['name']}{families}"
    else:
        wound = (
            f"winding   {winding['revolutions']:.4g} revolutions, {winding['why']}; "
            f"{winding['paths_per_family']} paths per family"
        )
    return [
        f"part      {part['name']}: {size(part['size'], reported_unit(part['units']), part['units_from'])}",
        f"mesh      {part['vertices']} vertices, {part['faces']} faces",
        wound,
    ]


def _windings(windings: list[CourseFigures], units: str) -> list[str]:
    """What became of each winding, where there are several."""
    if len(windings) == 1:
        return []
    return [
        f"{'' if at else 'each':<10}{each['name']}: bridged {100 * each['bridged']['before']:.3g} % before, "
        f"{100 * each['bridged']['after']:.3g} % after; largest gap {quantity(each['max_gap']['before'], units, 3)} "
        f"before, {quantity(each['max_gap']['after'], units, 3)} after"
        for at, each in enumerate(windings)
    ]


def _round(figures: RoundFigures, units: str) -> str:
    bridged, gap = figures["bridged"], figures["max_gap"]
    return (
        f"round {figures['stage']}.{figures['round']} bridged {100 * bridged['before']:.2g} % to "
        f"{100 * bridged['after']:.2g} %, gap {quantity(gap['before'], units, 3)} to {quantity(gap['after'], units, 3)}"
    )


def _edit(figures: RedesignFigures, units: str) -> list[str]:
    """What the edit came to, on the mesh that was fitted and wound again."""
    bridged, gap, moved, volume = figures["bridged"], figures["max_gap"], figures["displacement"], figures["volume"]
    usual = quantity(figures["threshold"], units, 2)
    ignored = f"below {usual}"
    if bridged["after"] == 0.0 and gap["after"] > figures["threshold"]:  # which is more in some places
        ignored = f"within the surface's uncertainty, usually {usual},"
    return [
        f"wound     from the edited mesh: bridged {100 * bridged['before']:.3g} % before, "
        f"{100 * bridged['after']:.3g} % after; largest gap {quantity(gap['before'], units, 3)} before, "
        f"{quantity(gap['after'], units, 3)} after (gaps {ignored} are ignored)",
        f"moved     up to {quantity(moved['max'], units, 3)}, {quantity(moved['mean'], units, 3)} on average; "
        + (f"volume {100 * volume['relative']:+.2g} %" if volume["relative"] is not None else "volume unknown"),
    ]


def _left(bridges: list[LeftFigures], units: str) -> list[str]:
    """The bridges that are left, and what holds them."""
    if not bridges:
        return []
    worst, names = bridges[0], dict.fromkeys(name for each in bridges for name in each["held_by"])
    place = ", ".join(f"{x:.4g}" for x in worst["at"])
    by = " and ".join(worst["held_by"]) or "neither a bound nor what is frozen"
    lines = [
        f"left      {len(bridges)} bridges; the largest, {quantity(worst['gap'], units, 3)} at ({place}), v "
        f"{worst['v'][0]:.2f} to {worst['v'][1]:.2f}, is held by {by}"
    ]
    for name in names:
        held = [each["gap"] for each in bridges if name in each["held_by"]]
        lines.append(f"          {name} holds {len(held)} of them, gaps up to {quantity(max(held), units, 3)}")
    return lines


def _warnings(report: RedesignReport) -> list[str]:
    """Warnings and notes, and how the redesign ended."""
    figures, failed = report["redesign"], report["wound"]["after"]["not_converged"]
    lines = []
    if figures["faces_turned_over"]:
        lines.append(f"warning   the edit turned {figures['faces_turned_over']} faces over; give a {argument('bound')}")
    if failed:
        lines.append(f"warning   {len(failed)} paths do not converge on the edited part: {failed[0]['why']}")
    lines += [note_line(note) for note in report["notes"]]
    return [*lines, f"{'outcome' if figures['windable'] else 'warning'}   {figures['advice']}"]
