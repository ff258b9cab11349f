"""The report of a redesign."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np

from meshwind.core.version import version
from meshwind.editing.left import Left
from meshwind.editing.proof import Proof
from meshwind.editing.redesign import Redesign
from meshwind.editing.result import Round
from meshwind.path.paths import Status
from meshwind.results.redesign_report_types import (
    CourseFigures,
    LeftFigures,
    RedesignFigures,
    RedesignReport,
    RoundFigures,
    WoundFigures,
)
from meshwind.results.report import failures, mesh_figures, plain


def redesign_report(
    edited: Redesign,
    *,
    command: str = "",
    seconds: Mapping[str, float] | None = None,
    notes: Sequence[str] = (),
) -> RedesignReport:
    """All figures of a redesign as plain Python values; lengths in the mesh's units.

    `wound` has those of the mesh that was read and of the edited one, each fitted and wound by itself: the second is
    the proof, which the last of the rounds only predicts.
    """
    figures: RedesignReport = {
        "meshwind": version(),
        "command": command,
        "mesh": mesh_figures(edited.part, edited.before.chart),
        "winding": {
            "revolutions": edited.revolutions,
            "paths_per_family": len(edited.paths) // 2,
            "particles": edited.paths.gap.shape[1],
            "why": "as asked for" if edited.chosen is None else edited.chosen.why,
        },
        "windings": [_winding(edited, number) for number in range(len(edited.windings))],
        "redesign": _redesign(edited),
        "rounds": [
            _round(stage, number, each)
            for stage, rounds in enumerate(edited.stages, start=1)
            for number, each in enumerate(rounds, start=1)
        ],
        "wound": {"before": _proof(edited.before), "after": _proof(edited.after)},
        "seconds": dict(seconds or {}),
        "notes": list(notes),
    }
    result: RedesignReport = plain(figures)
    return result


def _winding(edited: Redesign, number: int) -> CourseFigures:
    course, before, after = edited.windings[number], edited.before, edited.after
    laid = after.wound[number]
    return {
        "name": course.name,
        "kind": "hoop" if course.is_hoop else "helical",
        "revolutions": course.revolutions,
        "paths": len(laid),
        "particles": laid.gap.shape[1],
        "between": list(course.between),
        "bridged": {"before": before.shares[number], "after": after.shares[number]},
        "max_gap": {"before": before.gaps[number], "after": after.gaps[number]},
        "converged": int((laid.status == Status.CONVERGED).sum()),
        "bridges_left": sum(each.winding == number for each in edited.left),
    }


def _redesign(edited: Redesign) -> RedesignFigures:
    moved = np.linalg.norm(edited.displacement, axis=1)
    return {
        "windable": edited.windable,
        "outcome": edited.outcome.name.lower(),
        "advice": edited.outcome.advice,
        "rounds": len(edited.rounds),
        "threshold": edited.after.threshold,
        "bridged": {"before": edited.before.bridged, "after": edited.after.bridged},
        "max_gap": {"before": edited.before.gap, "after": edited.after.gap},
        "displacement": {
            "max": float(moved.max()),
            "mean": float(moved.mean()),
            "vertices_moved": int((moved > 0.01 * max(float(moved.max()), 1e-300)).sum()),
        },
        "volume": {
            "before": edited.volume,
            "change": edited.volume_change,
            "relative": edited.volume_change / edited.volume if edited.volume else None,
        },
        "faces_turned_over": edited.turned_over,
        "left": [_left(each) for each in edited.left],
    }


def _left(each: Left) -> LeftFigures:
    return {
        "winding": each.winding,
        "path": each.path,
        "family": each.family,
        "v": list(each.v),
        "gap": each.gap,
        "at": list(each.at),
        "held_by": list(each.held_by),
        "by_bound": each.by_bound,
        "by_frozen": dict(each.by_frozen),
    }


def _round(stage: int, number: int, each: Round) -> RoundFigures:
    return {
        "stage": stage,
        "round": number,
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


def _proof(proof: Proof) -> WoundFigures:
    wound = [replace(paths, asked=None) for paths in proof.wound]  # no other revolutions are advised: another edit
    return {
        "control_points": list(proof.surface.control_points.shape[:2]),
        "converged": sum(int((paths.status == Status.CONVERGED).sum()) for paths in wound),
        "not_converged": [failure for paths in wound for failure in failures(paths)],
        "bridged": proof.bridged,
        "max_gap": proof.gap,
        "threshold": proof.threshold,
    }
