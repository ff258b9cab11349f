"""The closing summary: what a person wants to know of a run, in a few lines."""

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from meshwind.pipeline import Result


def summary(result: "Result", folder: Path) -> str:
    """Lines for the terminal."""
    report = result.report()
    surface, paths, seconds = report["surface"], report["paths"], report["seconds"]
    total = paths["converged"] + len(paths["not_converged"])
    fit = surface["fit_error"]
    lines = [
        f"part      {result.mesh.name}: {report['mesh']['vertices']} vertices, {report['mesh']['faces']} faces; "
        f"{result.chart.annulus.ends}",
        f"surface   {surface['control_points'][0]} x {surface['control_points'][1]} control points, "
        f"fit error rms {fit['rms']:.2g}, max {fit['max']:.2g} ({fit['relative_max']:.1e} of the part)",
        f"paths     {paths['converged']} of {total} at rest, length {paths['length_total']:.6g}, "
        f"bridged {100 * paths['bridged_fraction']:.1f} %, largest gap {paths['max_gap']:.3g}",
    ]
    if paths["longest_bridge"] > 0:
        lines.append(f"bridges   {paths['bridges']}, the longest {paths['longest_bridge']:.4g}")
    lines += _unsettled(paths["not_converged"])
    lines += [f"repair    {act}" for act in result.mesh.repairs]
    lines += [f"note      {note}" for note in result.notes]
    lines.append("seconds   " + ", ".join(f"{stage} {value:.2f}" for stage, value in seconds.items()))
    lines.append(f"files     {folder}")
    return "\n".join(lines)


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
