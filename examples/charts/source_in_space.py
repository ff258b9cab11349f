"""The source's figure 7.6 (a, b) redone: the length over wall-clock time and over simulated time, method by method."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import attempt
from comparison.problems import TABLE

from charts.record import Results
from charts.style import GREEN, LOOKS, ORANGE, PURPLE, save
from charts.timing import least
from meshwind.methods import Motion, run

PROBLEM = TABLE["bottle-neck"]
PARTICLES = 201
STEP, DAMPING, STEPS = 3.0, 0.1, 1000
WIDTHS = (1e-2, 1e-3, 1e-4)


def settings() -> dict[str, tuple[str, dict[str, Any], str, str]]:
    """Each line: scheme, parameters, colour and line style; one step size for all, as in the source."""
    size = PROBLEM.surface().size
    be, kkt = LOOKS["backward-euler"], LOOKS["kkt"]
    lines: dict[str, tuple[str, dict[str, Any], str, str]] = {
        "backward Euler (the source's own method)": ("backward-euler", dict(weighted=True), be.colour, "-"),
        "the same, matrix reused 5 steps": (
            "backward-euler",
            dict(weighted=True, reuse=5),
            LOOKS["backward-euler-reuse"].colour,
            "--",
        ),
        "KKT method": ("kkt", dict(), kkt.colour, "-"),
    }
    for width, colour in zip(WIDTHS, (ORANGE, PURPLE, GREEN), strict=True):
        lines[f"penalty force, width {width:g} of the size"] = ("penalty", dict(width=width * size), colour, ":")
    return lines


def measure(results: Results) -> list[dict[str, Any]]:
    """Run every line once with its history and several times without for the seconds; draw both panels."""
    figure, (wall, simulated) = plt.subplots(1, 2, figsize=(13, 5.2), sharey=True)
    rows = []
    for name, (scheme, extra, colour, line) in settings().items():

        def go(steps: int, history: bool, scheme: str = scheme, extra: dict[str, Any] = extra) -> Motion:
            return run(
                scheme,
                PROBLEM.surface(),
                PROBLEM.start,
                PROBLEM.end,
                particles=PARTICLES,
                steps=steps,
                step_size=STEP,
                damping=DAMPING,
                history=history,
                tolerance=0.0,
                **extra,
            )

        found = go(STEPS, True)
        if found.history is None:
            raise SystemExit("the run kept no history")
        taken = max(found.counters.iterations, 1)
        # the cost of a step depends on what touches, so that seconds are measured at a few marks and drawn between
        marks = np.unique(np.r_[1, np.geomspace(4, taken, 7).astype(int)])
        seconds = np.interp(np.arange(1, taken + 1), marks, [least(lambda k=int(k): go(k, False)) for k in marks])  # type: ignore[misc]
        off = np.maximum(np.abs(found.history.length[1 : taken + 1] / PROBLEM.length - 1), 1e-12)
        wall.plot(1e3 * seconds, off, line, color=colour, label=name)
        simulated.plot(STEP * np.arange(1, taken + 1), off, line, color=colour)
        settled = np.flatnonzero(np.abs(found.history.length / found.length - 1) < 1e-6)
        last = np.flatnonzero(np.abs(found.history.length / found.length - 1) >= 1e-6)
        rows.append(
            dict(
                method=name,
                steps=taken,
                status=found.status.name,
                seconds=float(seconds[-1]),
                error=float(off[-1]),
                steps_until_settled=int(last[-1] + 1) if len(last) else int(settled[0]),
                evaluations=found.counters.evaluations,
                length=found.length,
            )
        )
    ours = attempt("meshwind", PROBLEM, PARTICLES)
    spent = least(lambda: attempt("meshwind", PROBLEM, PARTICLES))
    wall.plot(
        [1e3 * spent],
        [PROBLEM.error(ours.length)],
        "o",
        ms=9,
        color=LOOKS["meshwind"].colour,
        label=LOOKS["meshwind"].label,
    )
    simulated.axhline(PROBLEM.error(ours.length), color=LOOKS["meshwind"].colour, lw=1)
    rows.append(
        dict(
            method="meshwind",
            steps=ours.iterations,
            status=str(ours.outcome),
            seconds=spent,
            error=PROBLEM.error(ours.length),
            steps_until_settled=ours.iterations,
            evaluations=ours.evaluations,
            length=ours.length,
        )
    )
    wall.set(
        xscale="log",
        yscale="log",
        xlabel="wall-clock time [ms], one thread",
        ylabel="relative error of the length",
        title="as the source's 7.6 (a)",
    )
    simulated.set(xscale="log", xlabel="simulated time [sqrt(m/K)]", title="as the source's 7.6 (b)")
    wall.legend()
    figure.suptitle(
        f"{PROBLEM.name}, {PROBLEM.hard}: {PARTICLES} particles, length {PROBLEM.length:.9g}; every scheme with h ="
        f" {STEP:g} sqrt(m/K), damping {DAMPING:g} sqrt(K m), {STEPS} steps"
    )
    figure.tight_layout()
    save(figure, results.folder, "source_7_6")
    results.table("source_7_6", rows)
    return rows
