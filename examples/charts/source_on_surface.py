"""The source's figure 4.2 (c, d) and figure 4.3 (e to g) redone: on half a sphere, with and without friction.

The source gives neither its sphere's radius, nor its time step, nor its number of particles, only that the ends are 2
apart in figure 4.2 and that the runs of figure 4.3 are damped.  The values here are our choice, the best found for its
method.
"""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np

from charts.record import Results
from charts.style import BLACK, BLUE, GREEN, ORANGE, PURPLE, RED, SKY, save
from meshwind.core.cast import Floats
from meshwind.methods import run
from meshwind.path import solve
from meshwind.surface import Surface, shapes

PARTICLES = 101
STEP, DAMPING = 10.0, 0.1
STEPS = (50, 100, 150, 200)
FRICTIONS = (0.3, 0.2, 0.1, 0.0)
RUB_STEP, RUB_DAMPING, RUB_STEPS = 0.5, 0.05, 3000


def half_sphere() -> tuple[Surface, Floats]:
    """A sphere of radius 1.2 less its poles, and a start bent away from the great circle; the ends are 2 apart."""
    surface = shapes.sphere_band(1.2, 0.05 * np.pi, 0.95 * np.pi, (256, 256))
    t = np.linspace(0.0, 1.0, PARTICLES)
    half = np.arcsin(1.0 / 1.2) / (2 * np.pi)
    bulge = 0.25 * np.sin(np.pi * t)
    return surface, np.stack([half * (2 * t - 1), 0.5 + bulge], axis=1)


def off_circle(X: Floats) -> Floats:
    """Distance (n,) of points from the great circle through the ends, which is the equator's arc."""
    return np.asarray(np.hypot(np.hypot(X[:, 0], X[:, 1]) - 1.2, X[:, 2]))


def angles(surface: Surface, uv: Floats, X: Floats) -> Floats:
    """Angle (n - 2,) between the surface's and minus the curve's normal (3.12), radians."""
    n = surface.normals(uv)[1:-1]
    bend, along = X[:-2] - 2 * X[1:-1] + X[2:], X[2:] - X[:-2]
    along = along / np.linalg.norm(along, axis=1, keepdims=True)
    across = bend - (bend * along).sum(axis=1, keepdims=True) * along
    side = across - (across * n).sum(axis=1, keepdims=True) * n
    return np.asarray(np.arctan2(np.linalg.norm(side, axis=1), np.abs((across * n).sum(axis=1))))


def convergence(results: Results) -> dict[str, float]:
    """Figure 4.2 (c, d): error of every particle after 50 to 200 steps of backward Euler, and of ours."""
    surface, curve = half_sphere()
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.3))
    rows: list[dict[str, Any]] = []
    for steps, colour in zip(STEPS, (ORANGE, SKY, BLUE, GREEN), strict=True):
        found = run(
            "backward-euler",
            surface,
            curve[0],
            curve[-1],
            particles=PARTICLES,
            initial=curve,
            steps=steps,
            step_size=STEP,
            damping=DAMPING,
            tolerance=0.0,
            lifting=False,
        )
        rows.append(
            _series(
                left,
                right,
                surface,
                found.uv,
                found.points,
                colour,
                f"backward Euler, {steps} steps",
                found.counters.evaluations,
            )
        )
    ours = solve(surface, [curve[0]], [curve[-1]], particles=PARTICLES, initial=[curve])
    rows.append(
        _series(
            left,
            right,
            surface,
            ours.uv[0],
            ours.points[0],
            RED,
            f"meshwind, {ours.counters.iterations} iterations",
            ours.counters.evaluations,
        )
    )
    left.set(yscale="log", xlabel="particle", ylabel="distance to the great circle [ends 2 apart]", ylim=(1e-17, 1))
    right.set(yscale="log", xlabel="particle", ylabel="angle between the normals [rad]", ylim=(1e-17, 3))
    left.legend()
    left.set_title("as the source's 4.2 (c): distance errors")
    right.set_title("as the source's 4.2 (d): angle differences")
    figure.suptitle(
        f"Half sphere of radius 1.2, {PARTICLES} particles, from a bulged start; backward Euler with h = {STEP:g} "
        f"sqrt(m/K), damping {DAMPING:g} sqrt(K m)"
    )
    figure.tight_layout()
    save(figure, results.folder, "source_4_2")
    results.table("source_4_2", rows)
    return {row["state"]: row["largest_distance"] for row in rows}


def _series(
    left: Any, right: Any, surface: Surface, uv: Floats, X: Floats, colour: str, label: str, evaluations: int
) -> dict[str, Any]:
    far, angle = off_circle(X)[1:-1], angles(surface, uv, X)
    for axes, values in ((left, far), (right, angle)):
        axes.plot(
            np.arange(1, len(X) - 1),
            np.maximum(values, 1e-17),
            color=colour,
            label=f"{label}, {evaluations} evaluations",
        )
    return dict(
        state=label,
        evaluations=evaluations,
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
        found = run(
            "backward-euler",
            surface,
            curve[0],
            curve[-1],
            particles=PARTICLES,
            initial=curve,
            steps=RUB_STEPS,
            step_size=RUB_STEP,
            damping=RUB_DAMPING,
            friction=mu,
            lifting=False,
            history=True,
        )
        ours = solve(surface, [curve[0]], [curve[-1]], particles=PARTICLES, initial=[curve], friction=mu)
        assert_history = found.history
        if assert_history is None:
            raise SystemExit("the run kept no history")
        for name, uv, X, line in (
            ("(4.19)", found.uv, found.points, "--"),
            ("meshwind", ours.uv[0], ours.points[0], "-"),
        ):
            inner, turn = off_circle(X)[1:-1], angles(surface, uv, X)
            far.plot(
                np.arange(1, PARTICLES - 1), np.maximum(inner, 1e-17), line, color=colour, label=f"{name}, mu = {mu:g}"
            )
            angle.plot(np.arange(1, PARTICLES - 1), np.maximum(turn, 1e-17), line, color=colour)
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
        mean.plot(assert_history.angle, color=colour, ls="--")
        mean.plot([len(assert_history.angle) - 1], [rows[-1]["mean_angle"]], "o", color=colour)
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
    far.legend(ncol=2, fontsize=7)
    figure.suptitle(
        f"Half sphere of radius 1.2, {PARTICLES} particles; velocity scaling (4.19, dashed) with h = {RUB_STEP:g}"
        f" sqrt(m/K), damping {RUB_DAMPING:g} sqrt(K m), against Coulomb's law exactly (full lines)"
    )
    figure.tight_layout()
    save(figure, results.folder, "source_4_3")
    results.table("source_4_3", rows)
    return rows
