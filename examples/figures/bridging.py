"""Figures on bridging: a bridge over a vase's hollow beside its exact answer, and tests for lifting."""

import matplotlib.pyplot as plt
import numpy as np
from charts.style import BLACK, BLUE, GREY, ORANGE, RED
from comparison.problems import TABLE, vase, vase_radius
from matplotlib.figure import Figure
from scipy.spatial import ConvexHull

import meshwind as mw
from meshwind.methods import run


def bridge() -> Figure:
    """A fibre along a vase's meridian: touching and lifted particles, feet, and the hull of the profile."""
    path = mw.solve(vase(), [(0.0, 0.0)], [(0.0, 1.0)], particles=61)[0]
    fine = mw.solve(vase(), [(0.0, 0.0)], [(0.0, 1.0)], particles=1601)
    z = np.linspace(0.0, 4.0, 200001)
    profile = np.stack([z, vase_radius(z)], axis=1)
    corners = np.sort(ConvexHull(profile).vertices)
    upper = profile[[k for k in corners if profile[k, 1] >= np.interp(z[k], [0, 4], profile[[0, -1], 1]) - 1e-12]]
    exact = np.linalg.norm(np.diff(upper, axis=0), axis=1).sum()
    spans = [k for k in range(len(upper) - 1) if upper[k + 1, 0] - upper[k, 0] > 0.01]
    figure, axes = plt.subplots(figsize=(7.2, 3.2), layout="constrained")
    axes.fill_between(z[::400], vase_radius(z[::400]), 0.3, color="0.88")
    axes.plot(z[::400], vase_radius(z[::400]), color=GREY)
    feet = vase().points(path.uv[~path.on_surface])
    air = path.points[~path.on_surface]
    axes.plot(np.stack([air[:, 2], feet[:, 2]]), np.stack([air[:, 0], feet[:, 0]]), color=BLUE, lw=0.6)
    axes.plot(path.points[:, 2], path.points[:, 0], color=RED, lw=1)
    axes.plot(path.points[path.on_surface, 2], path.points[path.on_surface, 0], "o", ms=3, color=RED, label="touching")
    axes.plot(air[:, 2], air[:, 0], "o", ms=3, mfc="white", color=ORANGE, label="lifted")
    axes.plot(feet[:, 2], feet[:, 0], ".", ms=3, color=BLUE, label="their feet")
    for k in spans:
        axes.plot(upper[k : k + 2, 0], upper[k : k + 2, 1], "|", ms=16, color=BLACK)
    axes.set(xlabel="z", ylabel="r", ylim=(0.3, 1.6), aspect="equal")
    axes.legend(loc="lower right", ncol=3)
    far, last = [k + 1 for k in spans], float(fine.gap.max())
    print(f"  bridge: exact spans from {upper[spans, 0]} to {upper[far, 0]}, largest gap {last:.4f}")
    print(f"  bridge: off by {path.length / exact - 1:.0e}, with 1601 particles by {fine.length[0] / exact - 1:.0e}")
    return figure


def lifting() -> Figure:
    """Unbalanced force of lifting and landing in turn by both tests, and of the solver, over a vase's neck."""
    problem = TABLE["vase"]
    figure, axes = plt.subplots(figsize=(6.4, 3.4), layout="constrained")
    for weighted, colour in ((False, ORANGE), (True, BLUE)):
        found = run("backward-euler", problem.surface(), problem.start, problem.end, particles=101, steps=300,
                    step_size=100.0, weighted=weighted, history=True)  # fmt: skip
        assert found.history is not None
        name = "weighted by (5.2)" if weighted else "as in Algorithm 1"
        axes.plot(found.history.residual, color=colour, label=f"lift and land in turn, {name}")
        print(f"  lifting: {name} {found.status.name} after {found.counters.iterations}, {found.residual:.1e}")
    path = mw.solve(problem.surface(), [problem.start], [problem.end], particles=101)
    taken, rest = path.counters.iterations, float(path.residual[0])
    axes.plot(taken, rest, "o", ms=9, color=RED, label="meshwind, at rest: the energy fell in every step")
    print(f"  lifting: at rest after {taken} iterations, {rest:.1e}")
    axes.set(xscale="symlog", yscale="log", xlabel="steps", ylabel="largest unbalanced force over the tension")
    figure.legend(loc="outside lower center", ncol=2)
    return figure
