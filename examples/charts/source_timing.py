"""Table 7.1 of the source redone: where the time of 1000 backward Euler steps goes, and what our solver takes."""

from collections.abc import Callable
from functools import partial
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, attempt, move
from comparison.problem import Problem
from comparison.problems import TABLE

from charts.record import Results
from charts.settings import SIZES
from charts.style import BLUE, GREY, ORANGE, SKY, save
from charts.timing import least, timed
from meshwind.methods import Motion, backward_euler
from meshwind.methods.chain import Physics, chain_at_rest, gather, link, move_contacts, put_on_surface
from meshwind.methods.lifting import PULL, update_touching
from meshwind.methods.on_surface import surface_work

SOURCE = {"build": 233.22, "solve": 204.35, "lift and land": 149.65, "other": 15.86}
"""Milliseconds, C++ on 6 threads of a Core i7 7700K; its surface and number of particles are not given."""
NAMES = {"other": "other (here: surface frames and forces)"}
PROBLEM = TABLE["bottle-neck"]
"""A freeform part with a bridge, as the source's figure 7.2-b."""
CONVEX = TABLE["barrel-1.5"]
"""A part that is pressed on everywhere, for steps on the surface only."""
PARTICLES, STEPS = 401, 1000
STEP, DAMPING = 10.0, 0.1
SPLITS = 3
"""Times that the split is measured: the shortest counts."""


def clocked(call: Callable[..., Any], *arguments: Any) -> tuple[float, Any]:
    """Seconds of one call and its result."""
    return timed(partial(call, *arguments))


def steps(problem: Problem, **extra: Any) -> Motion:
    """The thousand steps of backward Euler, compiled whole."""
    return move("backward-euler", problem, PARTICLES, steps=STEPS, step_size=STEP, damping=DAMPING, tolerance=0.0,
                **extra)  # fmt: skip


def split() -> dict[str, float]:
    """Milliseconds of 1000 steps by part: the compiled parts called one by one, less what an idle call costs."""
    spline, n = PROBLEM.surface().spline, PARTICLES
    physics = Physics(STEP, 1.0, DAMPING, 0.0, False)
    t = np.linspace(0.0, 1.0, n)[:, None]
    chain = chain_at_rest(np.ascontiguousarray((1 - t) * np.array(PROBLEM.start) + t * np.array(PROBLEM.end)))
    work, tally = surface_work(n), np.zeros(4, np.int64)
    forces, system, steps_uv = work.forces, work.system, work.move
    put_on_surface(spline, chain, np.arange(n), n, False)
    link(chain.touching, chain.before, chain.after)
    slack = PULL * PROBLEM.length / (n - 1)
    spent = {"build": 0.0, "solve": 0.0, "lift and land": 0.0, "other": 0.0}
    update_touching(spline, chain, True, slack, work.former, tally)
    for _ in range(STEPS):
        gathered, (count, _worst) = clocked(gather, chain, spline.periodic, 0.0, forces)
        building = (chain, physics, forces)
        idle = clocked(backward_euler.build, *building, 0, system)[0]
        built = clocked(backward_euler.build, *building, count, system)[0]
        stepping = (True, system, steps_uv, tally)
        idle_step = clocked(backward_euler.step, *building, 0, *stepping)[0]
        stepped = clocked(backward_euler.step, *building, count, *stepping)[0]
        idle_move = clocked(move_contacts, spline, chain, forces.particle, 0, steps_uv, False)[0]
        moved = clocked(move_contacts, spline, chain, forces.particle, count, steps_uv, False)[0]
        landed = clocked(update_touching, spline, chain, True, slack, work.former, tally)[0]
        spent["build"] += built - idle
        spent["solve"] += stepped - idle_step - (built - idle)
        spent["lift and land"] += landed - idle_move
        spent["other"] += gathered - idle_move + moved - idle_move
    return {key: 1e3 * max(value, 0.0) for key, value in spent.items()}


def measure(results: Results) -> dict[str, float]:
    """The split beside the source's, and the whole compiled run beside ours."""
    split()  # compile
    here = min((split() for _ in range(SPLITS)), key=lambda s: sum(s.values()))
    theirs, total = sum(SOURCE.values()), sum(here.values())
    rows = [
        dict(part=key, source_ms=SOURCE[key], source_share=SOURCE[key] / theirs, here_ms=here[key],
             here_share=here[key] / total) for key in SOURCE
    ]  # fmt: skip
    rows.append(dict(part="total", source_ms=theirs, source_share=1.0, here_ms=total, here_share=1.0))
    results.table("source_table_7_1", rows)
    whole = partial(steps, PROBLEM, weighted=True)
    figures = dict(
        linear_share=(here["build"] + here["solve"]) / total,
        on_surface_ms=1e3 * least(partial(whole, lifting=False)),
        reused_ms=1e3 * least(partial(whole, reuse=20)),
        **beside_ours(PROBLEM, whole),
        **beside_ours(CONVEX, partial(steps, CONVEX, lifting=False), "barrel_"),
    )
    results.table("source_setting", [figures])
    _draw(results, here, figures)
    return figures


def beside_ours(problem: Problem, run: Callable[[], Motion], prefix: str = "") -> dict[str, float]:
    """Milliseconds and errors of a run and of our solver, and how many times quicker ours is.

    The ratio at equal error is to our solver with the fewest particles that are no less accurate.
    """
    seconds, error = least(run), problem.error(run().length)
    our_seconds = least(partial(attempt, OURS, problem, PARTICLES))
    particles, equal_seconds = as_accurate(problem, error)
    return {
        f"{prefix}their_ms": 1e3 * seconds,
        f"{prefix}our_ms": 1e3 * our_seconds,
        f"{prefix}ratio": seconds / our_seconds,
        f"{prefix}their_error": error,
        f"{prefix}our_error": problem.error(attempt(OURS, problem, PARTICLES).length),
        f"{prefix}equal_particles": particles,
        f"{prefix}equal_ratio": seconds / equal_seconds,
    }


def as_accurate(problem: Problem, error: float) -> tuple[int, float]:
    """The fewest particles with which our solver is off by no more than `error`, and its seconds."""
    for n in SIZES:
        if problem.error(attempt(OURS, problem, n).length) <= error:
            return n, least(partial(attempt, OURS, problem, n))
    raise SystemExit(f"ours is off by more than {error:.1e} on {problem.name} with any number of particles")


def _draw(results: Results, here: dict[str, float], figures: dict[str, float]) -> None:
    figure, axes = plt.subplots(figsize=(10, 3.6))
    bars = (
        (f"source, C++ on 6 threads:\n{sum(SOURCE.values()):.0f} ms", SOURCE),
        (f"here, one thread, {PROBLEM.name},\n{PARTICLES} particles: {sum(here.values()):.1f} ms", here),
    )
    for row, (_, parts) in enumerate(bars):
        left, total = 0.0, sum(parts.values())
        for (key, value), colour in zip(parts.items(), (BLUE, SKY, ORANGE, GREY), strict=True):
            share = 100 * value / total
            axes.barh(row, share, left=left, color=colour, label=NAMES.get(key, key) if row == 0 else None)
            axes.annotate(
                f"{share:.0f} %\n{value:.3g} ms", (left + share / 2, row), ha="center", va="center", fontsize=7
            )
            left += share
    axes.set_yticks(range(2), [name for name, _ in bars])
    axes.set(xlabel="share of the time of 1000 backward Euler steps [%]", xlim=(0, 100))
    axes.set_title(
        f"The source's Table 7.1 and the same steps here (h = {STEP:g} sqrt(m/K), damping {DAMPING:g} sqrt(K m)); the"
        f" source gives neither part nor particles.\nThe steps compiled whole: {figures['their_ms']:.3g} ms, error"
        f" {figures['their_error']:.1e}; meshwind: {figures['our_ms']:.3g} ms, error {figures['our_error']:.1e},"
        f" {figures['ratio']:.0f} times quicker;\nwith {figures['equal_particles']} particles no less accurate and"
        f" {figures['equal_ratio']:.0f} times quicker",
        fontsize=8.5,
    )
    axes.invert_yaxis()
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.22), ncol=4)
    figure.tight_layout()
    save(figure, results.folder, "source_table_7_1")
