"""Fig. 4.2 (c, d) and Fig. 4.3 (e to g) of the source redone: on half a sphere, with and without friction.

The source gives neither the sphere's radius, nor the time step, nor the number of particles, only that the ends are 2
apart in figure 4.2 and that the runs of figure 4.3 are damped.  The values here are our choice, the best found for the
source's method.
"""

from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.problem import TURN
from matplotlib.axes import Axes

from charts.record import Results
from charts.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, SKY, save
from meshwind.core.cast import Floats
from meshwind.methods import Motion, run
from meshwind.path import solve
from meshwind.surface import Surface, shapes

RADIUS = 1.2
"""Of the sphere."""
PARTICLES = 101
STEP, DAMPING = 10.0, 0.1
"""Of the runs without friction."""
STEPS = (50, 100, 150, 200)
"""After which their errors are shown."""
FRICTIONS = (0.3, 0.2, 0.1, 0.0)
RUB_STEP, RUB_DAMPING, RUB_STEPS = 0.5, 0.05, 3000
"""Of the runs with friction."""
ZERO = 1e-17
"""What stands for 0 on a logarithmic axis."""
INNER = np.arange(1, PARTICLES - 1)
"""Numbers of the particles but for the two ends."""


def half_sphere() -> tuple[Surface, Floats]:
    """A sphere less its poles, and a start bent away from the great circle; the ends are 2 apart."""
    surface = shapes.sphere_band(RADIUS, 0.05 * np.pi, 0.95 * np.pi, (256, 256))
    t = np.linspace(0.0, 1.0, PARTICLES)
    half = np.arcsin(1.0 / RADIUS) / TURN
    bulge = 0.25 * np.sin(np.pi * t)
    return surface, np.stack([half * (2 * t - 1), 0.5 + bulge], axis=1)


def off_circle(X: Floats) -> Floats:
    """Distance (n,) of points from the great circle through the ends, which is the equator's arc."""
    return np.asarray(np.hypot(np.hypot(X[:, 0], X[:, 1]) - RADIUS, X[:, 2]))


def angles(surface: Surface, uv: Floats, X: Floats) -> Floats:
    """Angle (n - 2,) between the surface's and minus the curve's normal (3.12), radians."""
    n = surface.normals(uv)[1:-1]
    bend, along = X[:-2] - 2 * X[1:-1] + X[2:], X[2:] - X[:-2]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    across = bend - (bend * along).sum(axis=1, keepdims=True) * along
    side = across - (across * n).sum(axis=1, keepdims=True) * n
    return np.asarray(np.arctan2(np.linalg.norm(side, axis=1), np.abs((across * n).sum(axis=1))))


def release(**settings: Any) -> Motion:
    """A run of backward Euler on the surface, from the bent start."""
    surface, curve = half_sphere()
    return run("backward-euler", surface, curve[0], curve[-1], particles=PARTICLES, initial=curve, lifting=False,
               **settings)  # fmt: skip


def rub(friction: float, step_size: float = RUB_STEP, steps: int = RUB_STEPS) -> tuple[Motion, Floats]:
    """A run with friction by velocity scaling (4.19), and the mean angle between the normals before each step."""
    found = release(steps=steps, step_size=step_size, damping=RUB_DAMPING, friction=friction, history=True)
    if found.history is None:
        raise SystemExit("the run kept no history")
    return found, found.history.angle


def convergence(results: Results) -> dict[str, float]:
    """Figure 4.2 (c, d): error of every particle after 50 to 200 steps of backward Euler, and of ours."""
    surface, curve = half_sphere()
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.3))
    rows: list[dict[str, Any]] = []
    for steps, colour in zip(STEPS, (ORANGE, SKY, BLUE, GREEN), strict=True):
        found = release(steps=steps, step_size=STEP, damping=DAMPING, tolerance=0.0)
        line = Line(surface, found.uv, found.points, f"backward Euler, {steps} steps", found.counters.evaluations)
        rows.append(line.draw(left, right, colour))
    ours = solve(surface, [curve[0]], [curve[-1]], particles=PARTICLES, initial=[curve])
    label = f"meshwind, {ours.counters.iterations} iterations"
    rows.append(Line(surface, ours.uv[0], ours.points[0], label, ours.counters.evaluations).draw(left, right, RED))
    left.set(yscale="log", xlabel="particle", ylabel="distance to the great circle [ends 2 apart]", ylim=(ZERO, 1))
    right.set(yscale="log", xlabel="particle", ylabel="angle between the normals [rad]", ylim=(ZERO, 3))
    left.set_title("as the source's 4.2 (c): distance errors")
    right.set_title("as the source's 4.2 (d): angle differences")
    figure.suptitle(
        f"Half sphere of radius {RADIUS:g}, {PARTICLES} particles, from a bent start; backward Euler with"
        f" h = {STEP:g} sqrt(m/K), damping {DAMPING:g} sqrt(K m)"
    )
    figure.tight_layout(rect=(0, 0.14, 1, 1))
    figure.legend(*left.get_legend_handles_labels(), loc="lower center", ncol=3)
    save(figure, results.folder, "source_4_2")
    results.table("source_4_2", rows)
    return {row["state"]: row["largest_distance"] for row in rows}


@dataclass(frozen=True)
class Line:
    """A path that figure 4.2 shows: its particles, its name and what it cost."""

    surface: Surface
    uv: Floats
    points: Floats
    label: str
    evaluations: int

    def draw(self, left: Axes, right: Axes, colour: str) -> dict[str, Any]:
        """Draw both of its errors, particle by particle; their largest and mean values are the row of the table."""
        far, angle = off_circle(self.points)[1:-1], angles(self.surface, self.uv, self.points)
        for axes, values in ((left, far), (right, angle)):
            label = f"{self.label}, {self.evaluations} evaluations"
            axes.plot(INNER, np.maximum(values, ZERO), color=colour, label=label)
        return dict(
            state=self.label,
            evaluations=self.evaluations,
            largest_distance=float(far.max()),
            mean_distance=float(far.mean()),
            largest_angle=float(angle.max()),
            mean_angle=float(angle.mean()),
        )


def friction(results: Results) -> list[dict[str, Any]]:
    """Figure 4.3 (e to g): four coefficients by velocity scaling (4.19) and by ours; the mean angle over the steps."""
    surface, curve = half_sphere()
    figure, (far, angle, mean) = plt.subplots(1, 3, figsize=(16, 4.6))
    rows = []
    for mu, colour in zip(FRICTIONS, (BLACK, PURPLE, BLUE, GREEN), strict=True):
        found, history = rub(mu)
        ours = solve(surface, [curve[0]], [curve[-1]], particles=PARTICLES, initial=[curve], friction=mu)
        for name, uv, X, line in (
            ("(4.19)", found.uv, found.points, "--"),
            ("meshwind", ours.uv[0], ours.points[0], "-"),
        ):
            inner, turn = off_circle(X)[1:-1], angles(surface, uv, X)
            far.plot(INNER, np.maximum(inner, ZERO), line, color=colour, label=f"{name}, mu = {mu:g}")
            angle.plot(INNER, np.maximum(turn, ZERO), line, color=colour)
            rows.append(
                dict(
                    friction=mu,
                    method=name,
                    mean_angle=float(turn.mean()),
                    largest_angle=float(turn.max()),
                    allowed=float(np.arctan(mu)),
                    breaking=int((turn > np.arctan(mu) + 1e-6).sum()),
                    largest_distance=float(inner.max()),
                )
            )
        mean.plot(history, color=colour, ls="--")
        mean.plot([len(history) - 1], [rows[-1]["mean_angle"]], "o", color=colour)
        mean.axhline(np.arctan(mu), color=colour, lw=0.8, ls=":")
    far.set(
        yscale="log",
        xlabel="particle",
        ylabel="distance to the great circle [ends 2 apart]",
        ylim=(1e-12, 2),
        title="as 4.3 (e): distance at rest",
    )
    angle.set(
        yscale="log",
        xlabel="particle",
        ylabel="angle between the normals [rad]",
        ylim=(1e-10, 3),
        title="as 4.3 (f): angle at rest",
    )
    mean.set(
        xlabel="time step",
        ylabel="mean angle between the normals [rad]",
        xscale="log",
        xlim=(1, None),
        title="as 4.3 (g): mean angle; dotted: arctan(mu); dots: meshwind",
    )
    figure.suptitle(
        f"Half sphere of radius {RADIUS:g}, {PARTICLES} particles; velocity scaling (4.19, dashed) with"
        f" h = {RUB_STEP:g} sqrt(m/K), damping {RUB_DAMPING:g} sqrt(K m), against Coulomb's law exactly (full lines)"
    )
    figure.tight_layout(rect=(0, 0.13, 1, 1))
    figure.legend(*far.get_legend_handles_labels(), loc="lower center", ncol=4)
    save(figure, results.folder, "source_4_3")
    results.table("source_4_3", rows)
    return rows
