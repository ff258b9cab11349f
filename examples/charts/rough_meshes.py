"""Paths from noisy and decimated meshes of known parts: whether what surface and solver state covers the difference."""

from functools import cache

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from comparison.parts import PARTS, Revolved, decimated, irregular
from comparison.problem import TURN

import meshwind as mw
from charts.maps import Row, key, paint, settled, worst_of
from charts.record import Results
from charts.style import save
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh import mesh_from
from meshwind.path import Paths, Status
from meshwind.surface import Surface, shapes

SHOWN = {"barrel": 0.3, "vase": 0.35}
"""Parts, and the revolutions of their paths; on the vase they bridge both hollows."""
NOISE = (0.0, 1e-3, 3e-3, 1e-2, 2e-2, 3e-2)
"""Standard deviation of each vertex along each axis, over the part's mean radius."""
KEPT = (1.0, 0.5, 0.25, 0.1, 0.05, 0.03)
"""Shares of the faces that decimation keeps."""
PATHS, PARTICLES = 3, 201
"""Paths of each of the two families, and the particles of each."""
FINER = 2
"""Times as many segments of the exact paths."""
BEYOND = 0.1
"""How far the exact part goes on beyond its rims, over its height: noise moves rims."""


def roughened(vertices: Floats, faces: Ints, level: float, kept: float, seed: int = 3) -> tuple[Floats, Ints]:
    """The mesh with noise of a level over its mean radius, and then with a share of its faces."""
    radius = float(np.hypot(vertices[:, 0], vertices[:, 1]).mean())
    moved = vertices + level * radius * np.random.default_rng(seed).standard_normal(vertices.shape)
    return decimated(moved, faces, kept) if kept < 1.0 else (moved, faces)


@cache
def exact(part: Revolved) -> Surface:
    """The part itself, with v from -BEYOND to 1 + BEYOND of its height."""
    over = BEYOND * part.height
    return shapes.revolution(part.radius, -over, part.height + over, (64, 256))


def on_exact(part: Revolved, paths: Paths) -> tuple[Floats, Floats]:
    """Parameters (p, 2) of the ends of paths on the exact part, u unwrapped along each path."""
    x, y, z = np.moveaxis(paths.points, -1, 0)
    u = np.unwrap(np.arctan2(y, x), axis=1) / TURN
    v = (z / part.height + BEYOND) / (1.0 + 2.0 * BEYOND)
    start, end = (np.stack([u[:, k], v[:, k]], axis=1) for k in (0, -1))
    return start, end


def allowed(paths: Paths, truth: Paths) -> Floats:
    """What surface and solver state of each length (p,): the uncertainty along it times its turn, and at its ends."""
    chords = np.diff(truth.points[:, ::FINER], axis=1)
    chords /= np.linalg.norm(chords, axis=2, keepdims=True)
    turn = np.linalg.norm(np.diff(chords, axis=1), axis=2)
    p, n = paths.gap.shape
    doubt = paths.surface.uncertainty_at(paths.uv.reshape(-1, 2)).reshape(p, n)
    along = (turn * doubt[:, 1:-1]).sum(axis=1) + doubt[:, 0] + doubt[:, -1]
    return np.asarray(along + paths.length_error + truth.length_error)


def cell(name: str, mesh: tuple[Floats, Ints], level: float, kept: float) -> Row:
    """A row for a mesh, of the path that is off the most against what is allowed."""
    part = PARTS[name]
    row: Row = dict(method=OURS, part=name, noise=level, kept=kept, faces=len(mesh[1]))
    try:
        surface = mw.fit(mw.flatten(mw.annulus(mesh_from(*mesh))))
    except BadInputError as refusal:
        return row | dict(result="refused", why=str(refusal))
    ends = mw.families(surface, PATHS, SHOWN[name])
    paths = mw.solve(surface, ends.start, ends.end, family=ends.family, particles=PARTICLES)
    truth = mw.solve(exact(part), *on_exact(part, paths), particles=FINER * (PARTICLES - 1) + 1)
    if (truth.status != Status.CONVERGED).any():
        raise SystemExit(f"no exact path on {name}")
    bound = allowed(paths, truth)
    off = np.abs(paths.length - truth.length)
    results = [settled(status, bool(right)) for status, right in zip(paths.status, off <= bound, strict=True)]
    k = int(np.argmax(off / bound))
    error = surface.error
    return row | dict(
        result=worst_of(results),
        why=Status(int(paths.status.max())).name,
        led_by=error.data if error else "",
        error=off[k],
        allowed=bound[k],
        share=off[k] / bound[k],
        length=truth.length[k],
    )


def draw(results: Results, quick: bool) -> None:
    """A map for each part, over noise and the share of faces kept."""
    levels, shares, faces = (NOISE[::2], KEPT[::2], 4000) if quick else (NOISE, KEPT, 8000)
    figure, grid = plt.subplots(1, len(SHOWN), figsize=(6.8 * len(SHOWN), 5.2), sharey=True)
    rows: list[Row] = []
    for name, axes in zip(SHOWN, grid, strict=True):
        vertices, corners = irregular(PARTS[name], faces)
        classes: list[list[str]] = []
        for level in levels:
            found = [cell(name, roughened(vertices, corners, level, kept), level, kept) for kept in shares]
            classes.append([row["result"] for row in found])
            rows += found
            for k, row in enumerate(found):
                if "share" in row:
                    off, bound = (100.0 * row[what] / row["length"] for what in ("error", "allowed"))
                    axes.text(k, len(classes) - 1.25, f"{off:.2g} of {bound:.2g}", ha="center", va="center", fontsize=7)
        places = [float(k) for k in range(len(shares))]
        paint(axes, places, [float(k) for k in range(len(levels))], classes)
        axes.set_xticks(places, [f"{100 * kept:g} %\n{round(kept * len(corners))}" for kept in shares])
        axes.set_yticks(range(len(levels)), [f"{100 * level:g} %" for level in levels])
        mine = [row for row in rows if row["part"] == name and "share" in row and row["result"] == "ok"]
        axes.set(
            xlabel="faces kept by decimation",
            title=f"{name}, {SHOWN[name]} revolutions; where right, off by at most"
            f" {max((row['share'] for row in mine), default=0.0):.0%} of what is stated\n(numbers: how far the length"
            " that is off the most is off, of what is stated, in % of it)",
        )
        key(axes, classes, bbox_to_anchor=(0.5, -0.17))
    grid[0].set_ylabel("noise of the vertices over the mean radius")
    figure.suptitle(
        f"meshwind from noisy and decimated irregular meshes, {2 * PATHS} paths a mesh, {PARTICLES} particles; right:"
        " all lengths as on the exact part within what surface\nand solver state (the surface's uncertainty times the"
        " path's turn and at its ends, and the length's error)"
    )
    figure.tight_layout()
    save(figure, results.folder, "rough_meshes")
    results.table("rough_meshes", rows)
