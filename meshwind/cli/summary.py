"""The closing summary: what a person wants to know of a run, in a few lines."""

from typing import Any

from meshwind.core.units import unit_told


def described(report: dict[str, Any]) -> list[str]:
    """A run's report in a few lines; raises LookupError or TypeError where a figure is missing."""
    part = report["mesh"]
    units = unit_told(part["units"])
    return [
        f"part      {part['name']}: {part['vertices']} vertices, {part['faces']} faces; {part['ends']}",
        *_surface(report["surface"], part["diagonal"], units),
        *_paths(report["paths"], units),
        *_layup(report, units),
        *_unsettled(report["paths"]["not_converged"]),
        *(f"repair    {act}" for act in part["repairs"]),
        *(note_line(note) for note in report["notes"]),
        "seconds   " + ", ".join(f"{stage} {value:.2f}" for stage, value in report["seconds"].items()),
    ]


def note_line(told: str) -> str:
    """A note of a report as a line, which warns where it does."""
    text = told.removeprefix("warning: ")
    return f"{'note' if text == told else 'warning':<10}{text}"


def _surface(surface: dict[str, Any], size: float, units: str) -> list[str]:
    """The fit's errors both ways, each also over the part's diagonal."""
    from meshwind.appearance.words import quantity, ratio

    around, along = surface["control_points"]
    vertices, facets = surface["fit_error"]["to_surface"]["max"], surface["fit_error"]["to_mesh"]["max"]
    return [
        f"surface   {around} x {along} control points; largest distance to the vertices {quantity(vertices, units, 2)} "
        f"({ratio(vertices / size)} of the part, tolerance {ratio(surface['tolerance'])}), "
        f"to the facets {quantity(facets, units, 2)} ({ratio(facets / size)})"
    ]


def _paths(paths: dict[str, Any], units: str) -> list[str]:
    from meshwind.appearance.words import quantity

    failed = len(paths["not_converged"])
    whose = f"; {'these' if paths['converged'] else 'all'}" if failed else ""
    bridged = f"bridged {100 * paths['bridged_fraction']:.1f} %" if paths["bridges"] else "no bridges"
    lines = [
        f"paths     {paths['converged']} of {paths['converged'] + failed} at rest{whose}: length "
        f"{quantity(paths['length_total'], units)}, {bridged}"
    ]
    if paths["bridges"]:
        lines.append(
            f"bridges   {paths['bridges']}, the longest {quantity(paths['longest_bridge'], units)}, "
            f"the largest gap {quantity(paths['max_gap'], units, 3)}"
        )
    return lines


def _layup(report: dict[str, Any], units: str) -> list[str]:
    """Coverage and spacing; the fibre's mass where it is known."""
    from meshwind.appearance.words import quantity

    cover, near, fibre = report["coverage"], report["spacing"]["neighbours"], report["fibre"]
    shares = ", ".join(f"{name} {100.0 * cover[name]:.0f} %" for name in ("bare", "once", "twice", "more"))
    lines = [f"coverage  band {quantity(cover['band_width'], units, 3)}: {shares}"]
    if near["max"] is not None:
        lines[0] += f"; neighbours up to {quantity(near['max'], units, 3)} apart"
    if fibre["mass"] is not None:
        lines.append(f"fibre     {quantity(fibre['length'], units)}, mass {fibre['mass']:.4g}")
    return lines


def _unsettled(failures: list[dict[str, object]]) -> list[str]:
    """One line a reason, with how many paths it holds for."""
    reasons: dict[str, list[object]] = {}
    for failure in failures:
        reasons.setdefault(str(failure["why"]), []).append(failure["path"])
    return [
        f"warning   {len(paths)} path{'s' * (len(paths) > 1)} not at rest: {why} "
        f"(path {', '.join(map(str, paths[:8]))}{', ...' * (len(paths) > 8)})"
        for why, paths in reasons.items()
    ]
