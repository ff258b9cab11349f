"""Figures on geodesics: a saddle between two minima, steps to rest, and the order of the error."""

import matplotlib.pyplot as plt
import numpy as np
from charts.source_on_surface import half_sphere
from charts.style import BLUE, GREEN, ORANGE, PURPLE, RED, log_axes
from comparison.attempt import polyline_length
from comparison.problems import TABLE
from matplotlib.figure import Figure

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.methods import run


def hill(u: Floats, v: Floats) -> Floats:
    """A plate 2 by 2 with a hill 0.4 high."""
    x, y = 2 * u - 1, 2 * v - 1
    return np.stack([x, y, 0.4 * np.exp(-(x**2 + y**2) / 0.18)], axis=-1)


def saddle() -> Figure:
    """The length of a geodesic that is led through a point beside a hill's top, over the place of that point."""
    plate = mw.shapes.parametric(hill, (96, 96), periodic=False)
    passing = 0.5 + np.linspace(-0.3, 0.3, 41)
    ends = np.broadcast_to([[0.0, 0.5], [1.0, 0.5]], (41, 2, 2))
    through = np.stack([np.full(41, 0.5), passing], axis=1)
    first = mw.solve(plate, ends[:, 0], through, particles=201, bridging=False)
    last = mw.solve(plate, through, ends[:, 1], particles=201, bridging=False)
    length = first.length + last.length
    along = np.linspace(0.0, 1.0, 51)
    bent = [np.stack([along, 0.5 + share * np.sin(np.pi * along)], axis=1) for share in (0.05, 0.0, -0.05)]
    laid = mw.solve(plate, ends[:3, 0], ends[:3, 1], particles=201, bridging=False, initial=bent)
    figure, (lines, graph) = plt.subplots(1, 2, figsize=(7.6, 3.4), layout="constrained")
    x, y, z = np.moveaxis(hill(*np.meshgrid(np.linspace(0, 1, 81), np.linspace(0, 1, 81), indexing="ij")), -1, 0)
    lines.contour(x, y, z, levels=np.arange(0.02, 0.4, 0.05), colors="0.7", linewidths=0.6)
    graph.plot(2 * passing - 1, length, color="0.3", label="led through the point")
    for path, start, colour, marker in zip(
        laid, ("a start above", "a straight start", "a start below"), (BLUE, RED, GREEN), "osv", strict=True
    ):
        middle = path.points[100, 1]
        lines.plot(path.points[:, 0], path.points[:, 1], color=colour)
        graph.plot(
            middle, path.length, marker, ms=7 + 4 * (marker == "o"), color=colour, label=f"at rest, from {start}"
        )
        print(f"  saddle: from {start} at rest at y = {middle:.4f}, length {path.length:.6f}, {path.status.name}")
    print(f"  saddle: straight over the top {length[20]:.6f}, least {length.min():.6f}")
    lines.set(xlabel="x", ylabel="y", aspect="equal", title="a hill from above")
    graph.set(xlabel="y where the fibre passes x = 0", ylabel="length", title="two minima, and a saddle between")
    graph.legend(loc="best")
    return figure


def steps() -> Figure:
    """Unbalanced force over the steps of backward Euler, and at rest by Newton's method, on half a sphere."""
    surface, curve = half_sphere()
    figure, axes = plt.subplots(figsize=(6.4, 3.6), layout="constrained")
    for step, colour in ((1.0, ORANGE), (10.0, PURPLE), (100.0, BLUE), (1e4, GREEN)):
        found = run("backward-euler", surface, curve[0], curve[-1], particles=101, initial=curve, lifting=False,
                    steps=400, step_size=step, damping=0.1, tolerance=1e-13, history=True)  # fmt: skip
        assert found.history is not None
        left = found.history.residual
        axes.plot(np.arange(len(left)), left, color=colour, label=f"backward Euler, h = {step:g} $\\sqrt{{m/K}}$")
    path = mw.solve(surface, [curve[0]], [curve[-1]], particles=101, initial=[curve])
    taken, rest = path.counters.iterations, float(path.residual[0])
    axes.plot(taken, rest, "o", ms=9, color=RED, label="meshwind (Newton), at rest")
    print(f"  steps: at rest after {taken} iterations, {rest:.1e}")
    axes.set(xscale="symlog", yscale="log", xlabel="steps", ylabel="largest unbalanced force over the tension")
    axes.set_xlim(0, 400)
    axes.legend(loc="best")
    return figure


def order() -> Figure:
    """Errors of the polyline's length and of the fibre's over the particles, on parts with closed forms."""
    figure, axes = plt.subplots(figsize=(6.4, 4.0), layout="constrained")
    counts = np.array([13, 25, 51, 101, 201, 401, 801])
    for name, colour in (("cone-3", BLUE), ("barrel-1.5", GREEN), ("ellipsoid", ORANGE)):
        problem = TABLE[name]
        laid = [mw.solve(problem.surface(), [problem.start], [problem.end], particles=int(n)) for n in counts]
        chords = [problem.error(polyline_length(path.points[0])) for path in laid]
        ruled = [problem.error(float(path.length[0])) for path in laid]
        axes.plot(counts, chords, "s--", ms=4, color=colour, label=f"{name}, polyline")
        axes.plot(counts, ruled, "o-", ms=4, color=colour, label=f"{name}, Paths.length")
        print(
            f"  order: {name}, 101 particles {chords[3]:.1e} and {ruled[3]:.1e}, at 401 {chords[5]:.1e}, {ruled[5]:.1e}"
        )
    for power, scale in ((2, 0.03), (4, 8.0)):
        axes.plot(counts[:5], scale * counts[:5] ** -float(power), color="0.6", lw=0.8)
        axes.text(counts[4], scale * counts[4] ** -float(power), f" order {power}", color="0.4", va="center")
    log_axes(axes, "particles", "relative error of the length")
    axes.set_xticks(counts, [str(n) for n in counts])
    axes.minorticks_off()
    figure.legend(loc="outside lower center", ncol=3)
    return figure
