"""The claims of the source, each confirmed or contradicted by figures measured here."""

from typing import Any

import numpy as np
from comparison.attempt import move
from comparison.problems import TABLE

from charts.record import Results
from charts.source_on_surface import rub
from meshwind.methods import Ending

PARTICLES = 101
"""Of the runs on problems."""


def divergences() -> dict[str, int]:
    """Steps until the explicit schemes diverge at a step of 10 sqrt(m/K), with which backward Euler is stable."""
    steps = {}
    for scheme in ("explicit-euler", "symplectic-euler", "rk4"):
        found = move(scheme, TABLE["barrel-1.5"], PARTICLES, steps=200, step_size=10.0)
        steps[scheme] = found.counters.iterations if found.status == Ending.DIVERGED else -1
    return steps


def steps_to_rest(tolerance: float) -> dict[str, int]:
    """Backward Euler's steps to a residual on four problems, with h = 10 and some damping."""
    counts = {}
    for name in ("barrel-1.5", "sphere", "ellipsoid", "vase"):
        found = move("backward-euler", TABLE[name], PARTICLES, steps=5000, step_size=10.0, damping=0.1,
                     tolerance=tolerance, weighted=True, lifting=TABLE[name].bridges)  # fmt: skip
        counts[name] = found.counters.iterations if found.status == Ending.CONVERGED else -1
    return counts


def mean_angles() -> list[dict[str, float]]:
    """Mean angle at rest over arctan(mu) by velocity scaling with steps of different size."""
    rows = []
    for step in (0.1, 0.5, 3.0, 30.0):
        found, angle = rub(0.1, step_size=step, steps=6000)
        rows.append(dict(step=step, mean_over_limit=float(angle[-1] / np.arctan(0.1)), residual=found.residual))
    return rows


def penalty_errors() -> list[dict[str, float]]:
    """Length error of the penalty method at rest over its width, on the sphere."""
    problem, rows = TABLE["sphere"], []
    for width in (1e-2, 3e-3, 1e-3, 3e-4):
        found = move("penalty", problem, 51, steps=6000, step_size=0.3, damping=0.1, tolerance=1e-6,
                     width=width * problem.surface().size)  # fmt: skip
        rows.append(
            dict(width=width, error=found.length / problem.length - 1, rest=float(found.status == Ending.CONVERGED))
        )
    return rows


def judge(results: Results, figure_7_6: list[dict[str, Any]], setting: dict[str, float]) -> list[dict[str, str]]:
    """The table of claims."""
    by_name = {row["method"]: row for row in figure_7_6}
    be = by_name["backward Euler (the source's own method)"]
    reused, kkt, ours = by_name["the same, matrix reused 5 steps"], by_name["KKT method"], by_name["meshwind"]
    diverged, rest, loose = divergences(), steps_to_rest(1e-6), steps_to_rest(1e-3)
    angles, floats = mean_angles(), penalty_errors()
    slope = float(np.log(floats[0]["error"] / floats[2]["error"]) / np.log(floats[0]["width"] / floats[2]["width"]))
    rows = [
        claim(
            "explicit schemes diverge within several steps",
            all(0 < k <= 50 for k in diverged.values()),
            ", ".join(f"{k} after {v} steps" for k, v in diverged.items())
            + " at h = 10 sqrt(m/K), barrel-1.5, 101 particles; below their limits (stability.py) they do not",
        ),
        claim(
            "backward Euler converges within 50 to 200 steps",
            all(0 < k <= 200 for k in rest.values()),
            f"to a residual of 1e-6 in {rest}, to 1e-3 in {loose} steps (h = 10, damping 0.1, 101 particles); the count"
            " grows with the particles' number at a fixed h, and falls to 5 to 40 at h = 1e6",
        ),
        claim(
            "the mean angle tends to arctan(mu) or below",
            all(a["mean_over_limit"] <= 1.01 for a in angles),
            "mean angle / arctan(mu) at mu = 0.1: "
            + ", ".join(f"{a['mean_over_limit']:.2f} at h = {a['step']:g}" for a in angles)
            + "; where h is long particles stick before they are at rest (4.19)",
        ),
        claim(
            "KKT and the source's method give the same result",
            abs(kkt["length"] / be["length"] - 1) < 1e-6,
            f"lengths agree to {abs(kkt['length'] / be['length'] - 1):.1e} on bottle-neck after 1000 steps",
        ),
        claim(
            "KKT is slower than the source's method",
            kkt["seconds"] > be["seconds"],
            f"1000 steps in {1e3 * kkt['seconds']:.3g} ms against {1e3 * be['seconds']:.3g} ms",
        ),
        claim(
            "the penalty method's error grows with its width",
            slope > 0.8,
            "relative errors "
            + ", ".join(f"{f['error']:.1e} at {f['width']:g}" for f in floats)
            + f" of the size: order {slope:.2f}",
        ),
        claim(
            "a reused matrix is quicker and still accurate",
            reused["seconds"] < be["seconds"] and reused["error"] < 1.1 * be["error"],
            f"{1e3 * reused['seconds']:.3g} ms against {1e3 * be['seconds']:.3g} ms, error {reused['error']:.1e}"
            f" against {be['error']:.1e}",
        ),
        claim(
            "70 % of the time goes into building and solving",
            setting["linear_share"] >= 0.6,
            f"{100 * setting['linear_share']:.0f} % here: 2 x 2 blocks need no sparse matrix, so that evaluating"
            " the surface is the larger part",
        ),
        claim(
            "without lifting another 25 % is saved",
            None,
            (
                f"1000 steps on bottle-neck in {setting['their_ms']:.3g} ms, {setting['on_surface_ms']:.3g} ms without"
                " lifting: lifted particles drop out of the system, which saves more than lifting costs"
                if setting["on_surface_ms"] > setting["their_ms"]
                else (
                    f"1000 steps on bottle-neck in {setting['their_ms']:.3g} ms, {setting['on_surface_ms']:.3g} ms"
                    " without lifting"
                )
            ),
        ),
        claim(
            "(not the source's) ours against 1000 steps at equal error: at least 100 times quicker",
            min(setting["equal_ratio"], setting["barrel_equal_ratio"]) >= 100,
            f"{setting['equal_ratio']:.0f} times on bottle-neck with {setting['equal_particles']} particles and"
            f" {setting['barrel_equal_ratio']:.0f} times on barrel-1.5 with {setting['barrel_equal_particles']}, where"
            f" lengths are as accurate; {setting['ratio']:.0f} and {setting['barrel_ratio']:.0f} times with as many"
            f" particles, errors {ours['error']:.1e} against {be['error']:.1e}",
        ),
    ]
    results.table("source_claims", rows)
    return rows


def claim(text: str, holds: bool | None, figures: str) -> dict[str, str]:
    """A row of the table."""
    verdict = "see figures" if holds is None else "confirmed" if holds else "contradicted"
    return dict(claim=text, verdict=verdict, figures=figures)
