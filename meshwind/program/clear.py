"""Whether free span and eye are clear of the part."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, frozen
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.rays import cast
from meshwind.surface.evaluate import S
from meshwind.surface.grid import grid
from meshwind.surface.surface import Surface

_SKIN = 1e-3
"""Depth, over the part's diagonal, to which a span may dip below the surface: it starts along it."""


@dataclass(frozen=True)
class Obstacle:
    """The part as spans may not meet it: just below its surface, closed over its rims; and the surface itself.

    below, surface: trees of their triangles.
    """

    below: FacetTree
    surface: FacetTree

    def hits(self, points: Floats, rays: Floats, spans: Floats) -> Bools:
        """Whether spans from points along unit vectors (n, 3), of lengths (n,), meet the part."""
        return np.asarray(cast(self.below, frozen(points), frozen(rays), 0.0)[1] < spans)

    def near(self, eyes: Floats, distance: float) -> Bools:
        """Whether eyes (n, 3) are nearer to the part than a distance."""
        return np.asarray(self.surface.distances(eyes) < distance)


def obstacle(surface: Surface, diagonal: float) -> Obstacle:
    """The obstacle that a part of a diagonal is."""
    on = grid(surface)
    frames = on.frames.reshape(*on.shape, *on.frames.shape[1:])
    normal = surface.normals(on.uv).reshape(*on.shape, 3)
    skin = frames[:, :, S]
    trees = []
    for depth in (_SKIN * diagonal, 0.0):
        points = skin - depth * normal
        middles = points[:, [0, -1]].mean(axis=0)
        faces = np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]])
        count, (nu, nv) = points[..., 0].size, on.shape
        ring = np.arange(nu) * nv
        lids = [
            np.stack([ring + row, np.roll(ring, -1) + row, np.full(nu, count + k)], axis=1)
            for k, row in enumerate((0, nv - 1))
        ]
        vertices = np.concatenate([points.reshape(-1, 3), middles])
        trees.append(FacetTree.of(frozen(vertices), frozen(np.concatenate([faces, *lids]))))
    return Obstacle(trees[0], trees[1])
