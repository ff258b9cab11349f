"""Our solver over mesh noise, units and offset, and chart stretch: how the description of a part changes the answer."""

from functools import cache, partial

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, attempt
from comparison.parts import PARTS, irregular
from comparison.problem import TURN, Problem
from comparison.problems import BARREL_LIMIT, TABLE, barrel_length, barrel_radius

import meshwind as mw
from charts.maps import Row, classify, key, paint, sweep
from charts.record import Results
from charts.style import BLUE, GREEN, ORANGE, PURPLE, RED, log_axes, save
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh import mesh_from
from meshwind.surface import Surface, shapes

N = 201
"""Particles of every path."""
NOISE = (0.0, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2)
"""Standard deviation of each vertex along each axis, over the diagonal."""
VERTICES = 2000
"""Of the noisy meshes."""
ROUGH = 1e-3
"""Noise from which it can lift the rims themselves, so that paths exist beyond the exact part's limit."""


def noisy_barrel(level: float, vertices: Floats, faces: Ints, random: np.random.Generator) -> Surface | str:
    """The surface fitted to a mesh with rougher vertices, or why it is refused."""
    moved = vertices + level * np.linalg.norm(np.ptp(vertices, axis=0)) * random.standard_normal(vertices.shape)
    try:
        return mw.fit(mw.flatten(mw.annulus(mesh_from(moved, faces))))
    except BadInputError as refusal:
        return str(refusal)


def noise(results: Results, quick: bool) -> None:
    """A barrel's mesh with ever rougher vertices: whether the path is found, and how far its length is off."""
    twists = np.linspace(0.5, 4.75, 7 if quick else 18).tolist()
    levels = NOISE[::2] if quick else NOISE
    vertices, faces = irregular(PARTS["barrel"], 2 * VERTICES)
    random = np.random.default_rng(3)
    surfaces = {level: noisy_barrel(level, vertices, faces, random) for level in levels}

    def cell(level: float, twist: float) -> Row:
        surface = surfaces[level]
        if isinstance(surface, str):
            return dict(noise=level, twist=twist, result="refused", error=float("nan"), why=surface, error_ends=0.0)
        exact = barrel_length(min(twist, BARREL_LIMIT - 1e-9))
        problem = Problem("noisy barrel", "", lambda: surface, (0, 0), (twist / TURN, 1), exact)
        found = attempt(OURS, problem, N)
        error = problem.error(found.length)
        # the ends lie on the noisy rims themselves: no length can be more exact than they are
        allowed = 1e-4 + 10.0 * level
        if twist >= BARREL_LIMIT:  # no path exists, but where the noise lifts the rims
            result = classify(found, np.inf if level < ROUGH else 0.0, allowed)
        else:
            result = classify(found, error, allowed)
        return dict(noise=level, twist=twist, result=result, error=error, why="", error_ends=allowed)

    classes, rows = sweep(levels, twists, cell)
    figure, axes = plt.subplots(figsize=(9, 4.8))
    paint(axes, twists, list(range(len(classes))), classes)
    axes.axvline(BARREL_LIMIT, color="k", ls="--", lw=1.4)
    axes.text(BARREL_LIMIT, len(classes) - 0.6, "no path exists beyond ", ha="right", va="top", fontsize=8)
    axes.set_yticks(range(len(levels)), [f"{level:g}" for level in levels])
    axes.set(
        xlabel="twist from rim to rim [rad]",
        ylabel="noise of the vertices over the diagonal",
        title=(
            f"meshwind from an irregular mesh of the barrel, {VERTICES} vertices, {N} particles\nright: at rest, length"
            " within 1e-4 + 10 x noise of Clairaut's;\nbeyond the limit a refusal is the right answer, below"
            f" {ROUGH:g} of noise the only one"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "ours_noise")
    results.table("ours_noise", rows)


def units(results: Results, quick: bool) -> None:
    """Every unit from 1e-6 to 1e6 and every offset up to 1e6 sizes: the same path."""
    scales = np.geomspace(1e-6, 1e6, 5 if quick else 13).tolist()
    offsets = [0.0, *np.geomspace(1.0, 1e6, 4 if quick else 7).tolist()]
    names = ("barrel-1.5", "vase", "catenary-0.3")
    figure, grid = plt.subplots(1, 3, figsize=(16, 5.4), sharey=True)
    rows = []
    for name, axes in zip(names, grid, strict=True):
        problem = TABLE[name]
        here = attempt(OURS, problem, N).length

        def cell(offset: float, scale: float, problem: Problem = problem, here: float = here) -> Row:
            surface = problem.surface()
            points = scale * (surface.control_points + offset * surface.size * np.array([1.0, -0.7, 0.4]))
            moved = Problem(problem.name, "", partial(Surface, points), problem.start, problem.end, scale * here,
                            problem.bridges, friction=problem.friction, initial=problem.initial)  # fmt: skip
            found = attempt(OURS, moved, N)
            error = abs(found.length / moved.length - 1)
            result = classify(found, error, 1e-12 + 1e-15 * 30 * offset)
            return dict(problem=problem.name, scale=scale, offset=offset, result=result, change=error)

        classes, found = sweep(offsets, scales, cell)
        rows += found
        paint(axes, scales, list(range(len(offsets))), classes, log_x=True)
        worst = max(row["change"] for row in found)
        axes.set(xlabel="unit: scale of all lengths", title=f"{name}; worst change of the length {worst:.0e}")
        key(axes, classes)
    grid[0].set_yticks(range(len(offsets)), [f"{o:g}" for o in offsets])
    grid[0].set_ylabel("offset from the origin over the part's size")
    figure.suptitle(
        f"meshwind in other units and positions, {N} particles; right: the same length to 1e-12, plus what round-off"
        " in the coordinates leaves (3e-14 of the offset)"
    )
    save(figure, results.folder, "ours_units")
    results.table("ours_units", rows)


@cache
def stretched(squeeze: float, shear: float) -> Surface:
    """The barrel with its rows squeezed towards one end by a factor, and its columns sheared by turns."""
    k = np.log(squeeze)

    def formula(u: Floats, v: Floats) -> Floats:
        z = 2.0 * (np.expm1(k * v) / np.expm1(k) if squeeze > 1.0 else v)
        r = barrel_radius(z)
        t = TURN * (u + shear * v)
        return np.stack([r * np.cos(t), r * np.sin(t), z], -1)

    return shapes.parametric(formula, (192, 512))


def stretch(results: Results, quick: bool) -> None:
    """The same barrel and path through charts of other stretch and shear."""
    squeezes = np.geomspace(1.0, 1e6, 7 if quick else 13).tolist()
    shears = (0.0, 0.5, 2.0) if quick else (0.0, 0.25, 0.5, 1.0, 2.0)
    twist = 1.5
    length = barrel_length(twist)

    def cell(shear: float, squeeze: float) -> Row:
        surface = partial(stretched, squeeze, shear)
        problem = Problem("stretched", "", surface, (0, 0), (twist / TURN - shear, 1), length)
        found = attempt(OURS, problem, N)
        error = problem.error(found.length)
        return dict(stretch=squeeze, shear=shear, result=classify(found, error, 1e-4), error=error,
                    iterations=found.iterations, evaluations=found.evaluations)  # fmt: skip

    classes, rows = sweep(shears, squeezes, cell)
    figure, (left, right) = plt.subplots(1, 2, figsize=(14, 5))
    for shear, colour in zip(shears, (BLUE, GREEN, ORANGE, RED, PURPLE), strict=False):
        cost = [row["evaluations"] / N for row in rows if row["shear"] == shear]
        right.plot(squeezes, cost, "o-", color=colour, label=f"sheared by {shear:g} turns")
    paint(left, squeezes, list(range(len(shears))), classes, log_x=True)
    left.set_yticks(range(len(shears)), [f"{s:g}" for s in shears])
    left.set(
        xlabel="stretch: longest over shortest s_v",
        ylabel="shear of the chart [turns]",
        title="right: at rest, error of the length below 1e-4",
    )
    key(left, classes)
    log_axes(right, "stretch: longest over shortest s_v", "surface evaluations per particle")
    right.set_title("cost")
    right.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncol=3)
    figure.suptitle(
        f"meshwind on the barrel through stretched and sheared charts, twist {twist:g} rad, {N} particles, length "
        f"{length:.9g}"
    )
    figure.tight_layout()
    save(figure, results.folder, "ours_stretch")
    results.table("ours_stretch", rows)


def draw(results: Results, quick: bool) -> None:
    """All three maps."""
    noise(results, quick)
    units(results, quick)
    stretch(results, quick)
