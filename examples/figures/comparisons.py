"""Figures on the methods of the source: a fibre dragged against a peak, and error against work."""

import matplotlib.pyplot as plt
import numpy as np
from charts.source_in_space import DAMPING, PARTICLES, PROBLEM, STEP, STEPS, lines
from charts.style import BLUE, GREY, LOOKS, RED, log_axes
from comparison.attempt import OURS, attempt
from matplotlib.figure import Figure
from moving_ends import FRAMES, PEAKS, valley

import meshwind as mw


def peaks() -> Figure:
    """Where a fibre's middle is while its ends are dragged along a valley, held to the surface and free to lift."""
    figure, both = plt.subplots(1, 2, figsize=(7.6, 3.3), layout="constrained", sharey=True)
    v = np.linspace(0.25, 0.8, FRAMES)
    ends = np.stack([0 * v, v], axis=1), np.stack([0 * v + 1, v], axis=1)
    for axes, (name, peak) in zip(both, PEAKS.items(), strict=True):
        for bridging, colour, line in ((False, BLUE, "s--"), (True, RED, "o-")):
            laid = mw.drag(valley(peak), *ends, bridging=bridging)
            middle = laid.points[np.arange(FRAMES), np.abs(laid.points[:, :, 0]).argmin(axis=1), 1]
            label = "free to lift" if bridging else "confined to the surface"
            axes.plot(6 * (v - 0.5), middle, line, ms=4, color=colour, label=label)
            print(f"  peaks: {name}, {label}: ends at {6 * (v[-1] - 0.5):.2f}, middle at {middle[-1]:.3f}")
        axes.axhline(0.0, color=GREY, lw=0.8, ls=":")
        axes.set(xlabel="y of the ends", title=name)
    both[0].set_ylabel("y of the fibre's middle; peak at 0")
    both[0].legend(loc="best")
    return figure


def work() -> Figure:
    """Error of the length over surface evaluations, step by step, of the source's methods and of ours."""
    figure, axes = plt.subplots(figsize=(6.8, 4.8), layout="constrained")
    for line in lines():
        found = line.run(STEPS, history=True)
        assert found.history is not None
        taken = max(found.counters.iterations, 1)
        off = np.maximum(np.abs(found.history.length[1 : taken + 1] / PROBLEM.length - 1), 1e-12)
        spent = found.counters.evaluations / PARTICLES * np.arange(1, taken + 1) / taken
        axes.plot(spent, off, line.style, color=line.colour, label=line.name)
    ours = attempt(OURS, PROBLEM, PARTICLES)
    axes.plot(
        ours.evaluations / PARTICLES,
        PROBLEM.error(ours.length),
        "o",
        ms=9,
        color=LOOKS[OURS].colour,
        label=LOOKS[OURS].label,
    )
    print(f"  work: ours {ours.evaluations / PARTICLES:.1f} a particle, error {PROBLEM.error(ours.length):.1e}")
    log_axes(axes, "surface evaluations for each particle", "relative error of the length")
    axes.set_title(
        f"{PARTICLES} particles over a bottle's neck; h = {STEP:g} $\\sqrt{{m/K}}$, damping {DAMPING:g} $\\sqrt{{Km}}$"
    )
    figure.legend(loc="outside lower center", ncol=2)
    return figure
