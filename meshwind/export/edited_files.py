"""The report of a redesign."""

from typing import Any

import numpy as np

from meshwind.core.version import version
from meshwind.editing.redesign import Redesign
from meshwind.editing.result import Round
from meshwind.path.paths import Status
from meshwind.results.report import mesh_figures, plain, unsettled


def redesign_report(
    edited: Redesign, *, command: str = "", units: str = "", seconds: dict[str, float] | None = None
) -> dict[str, Any]:
    """All figures of a redesign as plain Python values; lengths in the mesh's units.

    `wound` holds those of the mesh that was read and of the edited one, each fitted and wound by itself: the second
    is the proof, and the last of the rounds but foretells it.
    """
    moved = np.linalg.norm(edited.displacement, axis=1)
    figures = {
        "meshwind": version(),
        "command": command,
        "mesh": mesh_figures(edited.part, units) | {"ends": edited.before.chart.annulus.ends},
        "winding": {
            "revolutions": edited.revolutions,
            "paths_per_family": len(edited.paths) // 2,
            "particles": edited.paths.gap.shape[1],
            "why": "as asked for" if edited.chosen is None else edited.chosen.why,
        },
        "redesign": {
            "windable": edited.windable,
            "outcome": edited.outcome.name.lower(),
            "advice": edited.outcome.advice,
            "rounds": len(edited.rounds),
            "threshold": edited.after.threshold,
            "bridged": {"before": edited.before.bridged, "after": edited.after.bridged},
            "max_gap": {"before": edited.before.gap, "after": edited.after.gap},
            "displacement": {
                "max": moved.max(),
                "mean": moved.mean(),
                "vertices_moved": int((moved > 0.01 * max(float(moved.max()), 1e-300)).sum()),
            },
            "volume": {
                "before": edited.volume,
                "change": edited.volume_change,
                "relative": edited.volume_change / edited.volume if edited.volume else None,
            },
            "faces_turned_over": edited.turned_over,
        },
        "rounds": [
            {"stage": stage + 1, "round": k + 1} | _round(each)
            for stage, rounds in enumerate(edited.stages)
            for k, each in enumerate(rounds)
        ],
        "wound": {
            name: {
                "control_points": list(wound.surface.control_points.shape[:2]),
                "converged": int((wound.paths.status == Status.CONVERGED).sum()),
                "not_converged": unsettled(wound.paths),
                "bridged": wound.bridged,
                "max_gap": wound.gap,
                "threshold": wound.threshold,
            }
            for name, wound in (("before", edited.before), ("after", edited.after))
        },
        "seconds": dict(seconds or {}),
    }
    told: dict[str, Any] = plain(figures)
    return told


def _round(each: Round) -> dict[str, Any]:
    return {
        "threshold": each.threshold,
        "bridged": {"before": each.bridged_before, "after": each.bridged_after},
        "max_gap": {"before": each.gap_before, "after": each.gap_after},
        "largest_move": each.change,
        "objective": each.objective,
        "shortfall": each.shortfall,
        "kkt_residual": max(each.primal, each.dual),
        "constraints": each.rows,
        "iterations": each.iterations,
    }
