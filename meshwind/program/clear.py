"""Whether free span and eye are clear of the part."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.rays import cast
from meshwind.program.mandrel import Mandrel
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.grid import Grid

_SKIN = 1e-3
"""Depth, over the part's diagonal, to which a span may dip below the surface: it starts along it."""
_SURE = 2.0
"""Distance from the surface, over the skin's depth or the fit's usual error, that is surely outside of the part."""
_SIDES = 36
"""Sides of the shaft, whose radius it then has to 0.4 %."""


@dataclass(frozen=True)
class Obstacle:
    """The part as spans may not meet it: just below its surface, closed over its rims; and the surface itself.

    below, surface: trees of their triangles, those of the part first; own: how many these are.
    sure: distance from the surface from which the part is surely not met.
    """

    below: FacetTree
    surface: FacetTree
    own: int
    sure: float

    __repr__ = brief

    @property
    def held(self) -> bool:
        """Whether there is a shaft."""
        return len(self.surface.numbers) > self.own

    def free(self, points: Floats, rays: Floats) -> Floats:
        """Lengths (n,) from points along unit vectors (n, 3) to the part; infinity where they miss it."""
        return cast(self.below, frozen(points), frozen(rays), 0.0)[1]

    def hits(self, points: Floats, rays: Floats, spans: Floats) -> tuple[Bools, Bools]:
        """Whether spans from points along unit vectors (n, 3), of lengths (n,), meet anything, and the shaft first."""
        face, free = cast(self.below, frozen(points), frozen(rays), 0.0)
        met = np.asarray(free < spans)
        return met, met & (face >= self.own)


@dataclass(frozen=True)
class Shaft:
    """A shaft on the mandrel's axis: its radius, 0 if there is none, and where it ends along the axis."""

    radius: float
    ends: tuple[float, float]


def obstacle(on: Grid, diagonal: float, held: tuple[Mandrel, Shaft] | None = None) -> Obstacle:
    """The obstacle that a part of a diagonal, sampled on a grid, is, with the shaft that holds it on its axis."""
    trees = []
    for depth in (_SKIN * diagonal, 0.0):
        points, faces = skin_below(on, depth)
        own = len(faces)
        if held is not None and held[1].radius > depth:
            round_, sides = rod(held[1].radius - depth, held[1].ends)
            faces = np.concatenate([faces, sides + len(points)])
            points = np.concatenate([points, held[0].outside(round_)])
        trees.append(FacetTree.of(frozen(points), frozen(faces)))
    fit = on.surface.error
    return Obstacle(trees[0], trees[1], own, _SURE * max(_SKIN * diagonal, 0.0 if fit is None else fit.rms))


def skin_below(on: Grid, depth: float) -> tuple[Floats, Ints]:
    """Vertices and triangles of a surface at a depth below it, closed over its rims."""
    normal = unit(np.cross(on.frames[:, SU], on.frames[:, SV])).reshape(*on.shape, 3)
    return _closed(on.points.reshape(*on.shape, 3) - depth * normal, on.quads)


def _closed(points: Floats, quads: Ints) -> tuple[Floats, Ints]:
    """Vertices and triangles of a grid (nu, nv, 3) with its quads, closed over its rims, that face outwards."""
    nu, nv = points.shape[:2]
    ring, count = np.arange(nu) * nv, nu * nv
    lids = [
        np.stack([ring + row, np.roll(ring, -1) + row, np.full(nu, count + k)], axis=1)[:, ::way]
        for k, (row, way) in enumerate(((0, -1), (nv - 1, 1)))
    ]
    vertices = np.concatenate([points.reshape(-1, 3), points[:, [0, -1]].mean(axis=0)])
    return vertices, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]], *lids])


def rod(radius: float, ends: tuple[float, float]) -> tuple[Floats, Ints]:
    """Vertices and triangles of a rod on the axis, in the mandrel's frame, that lies outside of its radius nowhere."""
    turn = 2.0 * np.pi * np.arange(_SIDES) / _SIDES
    ring = radius * np.stack([np.cos(turn), np.sin(turn)], axis=1)
    points = np.concatenate([np.column_stack([np.full(_SIDES, end), ring]) for end in ends])
    k = np.arange(_SIDES)
    after = (k + 1) % _SIDES
    sides = [np.stack([k, after, after + _SIDES], axis=1), np.stack([k, after + _SIDES, k + _SIDES], axis=1)]
    return points, np.concatenate(sides)
