"""Ours over mesh noise, units and offset, and chart stretch: what the part's description does to the answer."""

from functools import cache, partial
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import attempt
from comparison.problem import Problem
from comparison.problems import BARREL_LIMIT, TABLE, barrel_length, barrel_radius
from comparison.rubbing import TURN
from fit_cost import PARTS, irregular

import meshwind as mw
from charts.maps import classify, key, paint
from charts.record import Results
from charts.style import BLUE, GREEN, ORANGE, RED, log_axes, save
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh import mesh_from
from meshwind.surface import Surface, shapes

NOISE = (0.0, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2)
"""Standard deviation of each vertex along each axis, over the diagonal."""
VERTICES = 2000


def noise(results: Results, quick: bool) -> None:
    """A barrel's mesh with ever rougher vertices: whether the path is found, and how far its length is off."""
    twists = np.linspace(0.5, 4.75, 7 if quick else 18)
    levels = NOISE[::2] if quick else NOISE
    vertices, faces = irregular(PARTS["barrel"], 2 * VERTICES)
    rng = np.random.default_rng(3)
    classes, rows = [], []
    for level in levels:
        moved = vertices + level * np.linalg.norm(np.ptp(vertices, axis=0)) * rng.standard_normal(vertices.shape)
        try:
            surface = mw.fit(mw.flatten(mw.annulus(mesh_from(moved, faces))))
        except BadInputError as refusal:
            classes.append(["refused"] * len(twists))
            rows.append(
                dict(noise=level, twist=0.0, result="refused", error=float("nan"), why=str(refusal), error_ends=0.0)
            )
            continue
        line = []
        for twist in twists:
            exact = barrel_length(min(float(twist), BARREL_LIMIT - 1e-9))
            problem = Problem("noisy barrel", "", lambda s=surface: s, (0, 0), (float(twist / TURN), 1), exact)  # type: ignore[misc]
            found = attempt("meshwind", problem, 201)
            error = problem.error(found.length)
            # the ends lie on the noisy rims themselves: nothing can be righter than they are
            allowed = 1e-4 + 10.0 * level
            # beyond the limit there is nothing to find, but where the noise lifts the rims themselves
            line.append(classify(found, error if twist < BARREL_LIMIT else np.inf if level < 1e-3 else 0.0, allowed))
            rows.append(dict(noise=level, twist=float(twist), result=line[-1], error=error, why="", error_ends=allowed))
        classes.append(line)
    figure, axes = plt.subplots(figsize=(9, 4.8))
    paint(axes, list(twists), list(range(len(classes))), classes)
    axes.axvline(BARREL_LIMIT, color="k", ls="--", lw=1.4)
    axes.text(BARREL_LIMIT, len(classes) - 0.6, "no path exists beyond ", ha="right", va="top", fontsize=8)
    axes.set_yticks(range(len(levels)), [f"{level:g}" for level in levels])
    axes.set(
        xlabel="twist from rim to rim [rad]",
        ylabel="noise of the vertices over the diagonal",
        title=(
            f"meshwind from an irregular mesh of the barrel, {VERTICES} vertices, 201 particles\nright: at rest, length"
            " within 1e-4 + 10 x noise of Clairaut's;\nbeyond the limit a refusal is the right answer, below 0.001 of"
            " noise the only one"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "ours_noise")
    results.table("ours_noise", rows)


def units(results: Results, quick: bool) -> None:
    """Every unit from 1e-6 to 1e6 and every offset up to 1e6 sizes: the same path."""
    scales = np.geomspace(1e-6, 1e6, 5 if quick else 13)
    offsets = np.concatenate([[0.0], np.geomspace(1.0, 1e6, 4 if quick else 7)])
    names = ("barrel-1.5", "vase", "catenary-0.3")
    figure, grid = plt.subplots(1, 3, figsize=(16, 5.4), sharey=True)
    rows = []
    for name, axes in zip(names, grid, strict=True):
        problem, classes = TABLE[name], []
        here = attempt("meshwind", problem, 201).length
        for offset in offsets:
            line = []
            for scale in scales:
                points = scale * (
                    problem.surface().control_points + offset * problem.surface().size * np.array([1.0, -0.7, 0.4])
                )
                moved = Problem(
                    name,
                    "",
                    partial(Surface, points),
                    problem.start,
                    problem.end,
                    scale * here,
                    problem.bridges,
                    friction=problem.friction,
                    initial=problem.initial,
                )
                found = attempt("meshwind", moved, 201)
                error = abs(found.length / moved.length - 1)
                line.append(classify(found, error, 1e-12 + 1e-15 * 30 * offset))
                rows.append(dict(problem=name, scale=scale, offset=offset, result=line[-1], change=error))
            classes.append(line)
        paint(axes, list(scales), list(range(len(offsets))), classes, log_x=True)
        worst = max(row["change"] for row in rows if row["problem"] == name)
        axes.set(xlabel="unit: scale of all lengths", title=f"{name}; worst change of the length {worst:.0e}")
        key(axes, classes)
    grid[0].set_yticks(range(len(offsets)), [f"{o:g}" for o in offsets])
    grid[0].set_ylabel("offset from the origin over the part's size")
    figure.suptitle(
        "meshwind in other units and places, 201 particles; right: the same length to 1e-12, plus what round-off in the"
        " coordinates leaves (3e-14 of the offset)"
    )
    save(figure, results.folder, "ours_units")
    results.table("ours_units", rows)


@cache
def stretched(squeeze: float, shear: float) -> Surface:
    """The barrel with its rows squeezed towards one end by a factor, and its columns sheared by turns."""
    k = np.log(squeeze)

    def formula(u: Floats, v: Floats) -> Floats:
        z = 2.0 * (np.expm1(k * v) / np.expm1(k) if squeeze > 1.0 else v)
        r = barrel_radius(z)  # type: ignore[arg-type]
        t = TURN * (u + shear * v)
        return np.stack([r * np.cos(t), r * np.sin(t), z], -1)

    return shapes.parametric(formula, (192, 512))


def stretch(results: Results, quick: bool) -> None:
    """The same barrel and path through charts of other stretch and shear."""
    squeezes = np.geomspace(1.0, 1e6, 7 if quick else 13)
    shears = (0.0, 0.5, 2.0) if quick else (0.0, 0.25, 0.5, 1.0, 2.0)
    twist = 1.5
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 5))
    classes: list[list[str]] = []
    rows: list[dict[str, Any]] = []
    for shear, colour in zip(shears, (BLUE, GREEN, ORANGE, RED, "#CC79A7"), strict=False):
        line = []
        for squeeze in squeezes:
            problem = Problem(
                "stretched",
                "",
                partial(stretched, float(squeeze), shear),
                (0, 0),
                (twist / TURN - shear, 1),
                barrel_length(twist),
            )
            found = attempt("meshwind", problem, 201)
            error = problem.error(found.length)
            line.append(classify(found, error, 1e-4))
            rows.append(
                dict(
                    stretch=float(squeeze),
                    shear=shear,
                    result=line[-1],
                    error=error,
                    iterations=found.iterations,
                    evaluations=found.evaluations,
                )
            )
        classes.append(line)
        right.plot(
            squeezes,
            [row["evaluations"] / 201 for row in rows[-len(line) :]],
            "o-",
            color=colour,
            label=f"sheared by {shear:g} turns",
        )
    paint(left, list(squeezes), list(range(len(shears))), classes, log_x=True)
    left.set_yticks(range(len(shears)), [f"{s:g}" for s in shears])
    left.set(
        xlabel="stretch: longest over shortest s_v",
        ylabel="shear of the chart [turns]",
        title="right: at rest, error of the length below 1e-4",
    )
    key(left, classes)
    log_axes(right, "stretch: longest over shortest s_v", "surface evaluations a particle")
    right.set_title("what it costs")
    right.legend()
    figure.suptitle(
        f"meshwind on the barrel through stretched and sheared charts, twist {twist:g} rad, 201 particles, length "
        f"{barrel_length(twist):.9g}"
    )
    figure.tight_layout()
    save(figure, results.folder, "ours_stretch")
    results.table("ours_stretch", rows)


def draw(results: Results, quick: bool) -> None:
    """All three."""
    noise(results, quick)
    units(results, quick)
    stretch(results, quick)
