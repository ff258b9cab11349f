"""Paths over a collar that leans over itself: whether any lies deeper inside the fitted surface than it states."""

from dataclasses import dataclass

import igl
import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from comparison.parts import Revolved, irregular
from comparison.problem import TURN
from scipy.spatial import cKDTree

import meshwind as mw
from charts.maps import Row, filled, key, paint, settled, worst_of
from charts.record import Results
from charts.style import note, save
from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh import mesh_from
from meshwind.path import Paths, Status
from meshwind.surface import Surface

LENGTH, TALL = 4.0, 0.3
"""Of the tube of radius 1 from rim to rim, and the collar's mean height."""
WIDTHS = (0.3, 0.08)
"""Of the collars, from its middle to where it is 1/e as high."""
UNEVEN = 0.4
"""How much taller the collar is on one side, over its mean height."""
COUNTS = (51, 101, 201, 401)
"""Numbers of particles; ours also chooses its own."""
PATHS, TURNS = 3, 0.15
"""Paths of each of the two families, and their revolutions."""
BETWEEN = 8
"""Points of each segment at which its depth is taken."""
GRID = (400, 1200)
"""Points of the surface from which feet are looked for."""
STARTS = 64
"""Of them, where a first foot says that a point is too deep."""
STEPS = 12
"""Gauss-Newton steps to a foot."""
ROUND_OFF = 1e-5
"""Over the part's size, added to the stated error of the position."""


@dataclass(frozen=True)
class Collar(Revolved):
    """A tube with a collar of a width, whose points are moved along the axis by `lean` times their height."""

    width: float = 0.3
    lean: float = 0.0

    def points(self, u: Floats, v: Floats) -> Floats:
        """Points (n, 3) at turns u and shares v of the height."""
        z = self.height * v
        tall = TALL * (1.0 + UNEVEN * np.cos(TURN * u)) * np.exp(-(((z - 0.5 * self.height) / self.width) ** 2))
        r = 1.0 + tall
        return np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), z + self.lean * tall], axis=-1)

    @property
    def overhangs_from(self) -> float:
        """Lean from which the collar's tallest side hangs over: the inverse of its steepest slope."""
        return float(self.width / (TALL * (1.0 + UNEVEN) * np.sqrt(2.0 / np.e)))


class Depths:
    """How deep points lie inside a surface, by the nearest of many of its points and Gauss-Newton steps from there.

    Next to folds that may be a foot on the wrong sheet: what is deeper than allowed is looked at again from many of
    the surface's points that are near, and counts only where the winding number of the triangles between them says that
    it is inside.
    """

    def __init__(self, surface: Surface) -> None:
        u, v = np.meshgrid(np.arange(GRID[0]) / GRID[0], np.linspace(0.0, 1.0, GRID[1]), indexing="ij")
        self._surface, self._uv = surface, np.stack([u.ravel(), v.ravel()], axis=1)
        self._points = surface.points(self._uv)
        self._tree = cKDTree(self._points)

    def of(self, points: Floats, starts: int = 1) -> Floats:
        """Depths (n,) of points (n, 3), 0 outside, by the nearest foot from a number of starts."""
        near, index = (each.reshape(-1) for each in self._tree.query(points, k=starts))
        many = np.repeat(points, starts, axis=0)
        uv, best = self._uv[index].copy(), near.copy()
        foot = self._surface.frames(uv)
        for _ in range(STEPS):
            s, su, sv = (foot[:, k] for k in range(3))
            way = many - s
            a, b, c = (np.einsum("nk,nk->n", *pair) for pair in ((su, su), (su, sv), (sv, sv)))
            d, e = np.einsum("nk,nk->n", su, way), np.einsum("nk,nk->n", sv, way)
            scale = a * c - b * b
            moved = uv + np.stack([c * d - b * e, a * e - b * d], axis=1) / scale[:, None]
            moved[:, 1] = np.clip(moved[:, 1], 0.0, 1.0)
            there = self._surface.frames(moved)
            distance = np.linalg.norm(many - there[:, 0], axis=1)
            nearer = distance < best
            uv[nearer], foot[nearer], best[nearer] = moved[nearer], there[nearer], distance[nearer]
        above = np.einsum("nk,nk->n", many - foot[:, 0], self._surface.normals(uv))
        depth = np.where(above < 0.0, best, 0.0).reshape(-1, starts)
        return np.asarray(np.take_along_axis(depth, best.reshape(-1, starts).argmin(axis=1)[:, None], axis=1)[:, 0])

    def deepest(self, paths: Paths, allowed: Floats) -> Floats:
        """Largest depth (p,) of each path, at points between its particles too."""
        dense = filled(paths.points, BETWEEN)
        depth = self.of(dense.reshape(-1, 3)).reshape(dense.shape[:2])
        doubted = (depth > allowed[:, None]) & (paths.status == Status.CONVERGED)[:, None]
        if doubted.any():
            depth[doubted] = np.where(self.inside(dense[doubted]), self.of(dense[doubted], STARTS), 0.0)
        return np.asarray(depth.max(axis=1))

    def inside(self, points: Floats) -> Bools:
        """Whether points (n, 3) are inside the triangles between the surface's points, closed at its ends."""
        nu, nv = GRID
        low = np.arange(nu) * nv
        high, beside, count = low + nv - 1, np.roll(low, -1), len(self._points)
        a, b = (each[:, None] + np.arange(nv - 1) for each in (low, beside))
        faces = [
            np.stack([a, b, b + 1], axis=-1).reshape(-1, 3),
            np.stack([a, b + 1, a + 1], axis=-1).reshape(-1, 3),
            np.stack([beside, low, np.full(nu, count)], axis=-1),
            np.stack([high, beside + nv - 1, np.full(nu, count + 1)], axis=-1),
        ]
        corners = np.concatenate([self._points, [self._points[end].mean(axis=0) for end in (low, high)]])
        winding = igl.fast_winding_number(corners, np.concatenate(faces), points)
        return np.asarray(np.abs(winding) > 0.5)


def fitted(width: float, lean: float, faces: int) -> Surface | str:
    """The surface fitted to a mesh of a collar, or why it is refused."""
    part = Collar(lambda z: np.ones_like(z), LENGTH, width, lean)
    try:
        return mw.fit(mw.flatten(mw.annulus(mesh_from(*irregular(part, faces)))))
    except BadInputError as refusal:
        return str(refusal)


def cell(surface: Surface | str, depths: Depths | None, particles: int | None) -> Row:
    """A row for one surface and number of particles: of the path that is the deepest against what it states."""
    if isinstance(surface, str) or depths is None:
        return dict(method=OURS, asked=particles, result="refused", why=str(surface))
    ends = mw.families(surface, PATHS, TURNS)
    paths = mw.solve(surface, ends.start, ends.end, family=ends.family, particles=particles)
    stated = paths.position_error
    allowed = stated + ROUND_OFF * surface.size
    deep = depths.deepest(paths, allowed)
    right = deep <= allowed
    results = [settled(status, bool(each)) for status, each in zip(paths.status, right, strict=True)]
    rest = paths.status == Status.CONVERGED
    k = int(np.argmax(np.where(rest, deep - stated, -np.inf)))
    return dict(method=OURS, asked=particles, particles=paths.points.shape[1], result=worst_of(results),
                deep=deep[k], stated_position_error=stated[k], size=surface.size, at_rest=int(rest.sum()),
                why="" if rest.all() else Status(int(paths.status[np.argmin(rest)])).name)  # fmt: skip


def draw(results: Results, quick: bool) -> None:
    """A map for each width of the collar, over its lean and particles."""
    leans = np.linspace(0.0, 3.0, 4 if quick else 7).tolist()
    counts = [*(COUNTS[1::2] if quick else COUNTS), None]
    faces = 8000 if quick else 16_000
    figure, grid = plt.subplots(1, len(WIDTHS), figsize=(6.8 * len(WIDTHS), 5.2), sharey=True)
    rows: list[Row] = []
    for width, axes in zip(WIDTHS, grid, strict=True):
        classes: list[list[str]] = []
        for lean in leans:
            surface = fitted(width, lean, faces)
            depths = None if isinstance(surface, str) else Depths(surface)
            found = [dict(width=width, lean=lean) | cell(surface, depths, n) for n in counts]
            classes.append([row["result"] for row in found])
            rows += found
            for k, row in enumerate(found):
                if "deep" in row:
                    deep, stated = (1e3 * row[what] for what in ("deep", "stated_position_error"))
                    axes.text(k, lean - 0.1, f"{deep:.2g} of {stated:.2g}", ha="center", va="center", fontsize=7)
        paint(axes, [float(k) for k in range(len(counts))], leans, classes)
        axes.axhline(Collar(np.ones_like, LENGTH, width).overhangs_from, color="k", ls="--", lw=1.4)
        axes.set_xticks(range(len(counts)), ["chosen" if n is None else str(n) for n in counts])
        axes.set(xlabel="particles of each fibre", title=f"collar {width:g} wide")
        key(axes, classes)
    grid[0].set_ylabel("lean: shift along the axis over height")
    note(grid[0], 0.02, 0.95, "above the dashed line the collar hangs over", transform=grid[0].transAxes)
    figure.suptitle(
        f"meshwind on fits of a tube (radius 1, length {LENGTH:g}) with a leaning collar {TALL:g} high, {faces} faces,"
        f" {2 * PATHS} paths of {TURNS:g} revolutions;\nright: at {BETWEEN} points between particles no path is deeper"
        " inside the fitted surface than it states (numbers: depth of what is stated, in 1e-3)"
    )
    figure.tight_layout()
    save(figure, results.folder, "rough_folds")
    results.table("rough_folds", rows)
