"""How far a fitted surface and its mesh lie apart, measured from both, and where."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import igl
import numpy as np
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_row
from meshwind.core.threads import parallel_for
from meshwind.mesh.geometry.mesh import Annulus
from meshwind.surface.grid import Grid, grid
from meshwind.surface.surface import Surface
from meshwind.surface.tree import Body, nearest_foot

_FINE = 8, 320
"""Samples of the surface per span and, at most, in each direction."""
_REGION = 1.0 / 3.0
"""Least distance of a region that is reported, over the largest distance of all."""
_CLOSE = 0.05
"""Least distance over the diagonal between two regions; the better one of closer regions is left out."""
_MOST = 5
"""Maximum number of regions, as many as a picture can show."""


@dataclass(frozen=True)
class Triangles:
    """Triangles (m, 3) between points (n, 3), with libigl's search tree.

    The tree of `mesh.geometry` is faster, but its distances differ from libigl's in the last bits, which files hold.
    """

    points: Floats
    faces: Ints

    @cached_property
    def _tree(self) -> Any:
        tree = igl.AABB()
        tree.init(self.points, self.faces)
        return tree

    def distances(self, points: Floats) -> Floats:
        """Distances (k,) of points (k, 3) to the nearest triangle."""
        return self.nearest(points)[0]

    def nearest(self, points: Floats) -> tuple[Floats, Ints, Floats]:
        """Distance (k,) of points (k, 3) to the triangles, the nearest face (k,) and the nearest point (k, 3) on it."""
        squared, face, foot = self._tree.squared_distance(self.points, self.faces, np.ascontiguousarray(points))
        return np.sqrt(squared), np.asarray(face), np.asarray(foot)

    def normal(self, point: Floats) -> Floats:
        """Unit normal (3,) of the face nearest to a point (3,)."""
        corner = self.points[self.faces[self.nearest(point[None])[1][0]]]
        across = np.cross(corner[1] - corner[0], corner[2] - corner[0])
        return np.asarray(across / max(float(np.linalg.norm(across)), 1e-300))

    def clear(self, point: Floats, directions: Floats, skip: float) -> Bools:
        """Whether no triangle lies before a point (3,) in each direction (k, 3), past a length to skip."""
        origins = point + skip * directions
        hit, _, _ = self._tree.intersect_ray_first(self.points, self.faces, origins, np.ascontiguousarray(directions))
        return np.asarray(hit < 0)


@dataclass(frozen=True)
class Mismatch:
    """A region where surface and mesh lie apart, by its worst pair: a point (3,) on each, and their distance."""

    distance: float
    on_mesh: Floats
    on_surface: Floats


@dataclass(frozen=True)
class Deviation:
    """A surface and its mesh as triangles, the distances of the points of each to the other, and the worst regions.

    to_surface (n,) is of the mesh's vertices, to_mesh (k,) of the grid's points.  A region is a patch of the mesh that
    lies off by more than a third of the worst, or that such a part of the surface is nearest to; the worst is first.
    """

    grid: Grid
    surface: Triangles
    mesh: Triangles
    to_surface: Floats
    to_mesh: Floats
    regions: tuple[Mismatch, ...]


def deviation(surface: Surface, annulus: Annulus) -> Deviation:
    """Measure a surface against the mesh that it was fitted to, both ways, and find the regions where it misses it.

    Vertices that trimming made have a distance but make no region, as they do not lie on the part.
    """
    on = grid(surface, *_FINE)
    facets = Triangles(on.points, np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]]))
    mesh = Triangles(np.ascontiguousarray(annulus.vertices), np.ascontiguousarray(annulus.faces))
    to_surface, on_surface = _feet(on, facets, annulus.vertices)
    to_mesh, face, on_mesh = mesh.nearest(on.points)
    # both sides in one list: the pairs of points, and the corners of the mesh that they lie at
    distance = np.concatenate([np.where(annulus.trusted, to_surface, 0.0), to_mesh])
    pairs = np.concatenate([np.stack([annulus.vertices, on_surface], 1), np.stack([on_mesh, on.points], 1)])
    corners = np.concatenate([np.repeat(np.arange(len(to_surface))[:, None], 3, axis=1), annulus.faces[face]])
    worst = _worst(distance, pairs, corners, annulus)
    regions = tuple(Mismatch(float(distance[k]), frozen(pairs[k, 0]), frozen(pairs[k, 1])) for k in worst)
    return Deviation(on, facets, mesh, frozen(to_surface), frozen(to_mesh), regions)


def _feet(on: Grid, facets: Triangles, points: Floats) -> tuple[Floats, Floats]:
    """Distances (n,) of points (n, 3) to the surface itself and their feet (n, 3), found from the grid's facets."""
    surface, points = on.surface, np.ascontiguousarray(points)
    guess = on.uv[on.quads[facets.nearest(points)[1] % len(on.quads), 0]]
    feet = np.empty_like(points)
    parallel_for(_nearest_feet, len(points), 500, surface.body, points, guess, feet)
    return np.asarray(np.linalg.norm(points - feet, axis=1)), feet


@njit(nogil=True, cache=True)
def _nearest_feet(first: int, last: int, body: Body, points: Floats, guesses: Floats, feet: Floats) -> None:
    """Write the feet (n, 3) of points (n, 3) first to last, each found from its guess (n, 2)."""
    frame = np.empty((6, 3))
    for i in range(first, last):
        copy_row(points[i], feet[i])  # of one type, whatever the points are
        nearest_foot(body, feet[i], guesses[i], frame)
        copy_row(frame[0], feet[i])


def _worst(distance: Floats, pairs: Floats, corners: Ints, annulus: Annulus) -> list[int]:
    """Rows of the worst pair of each region, the worst of all first."""
    order = np.argsort(-distance, kind="stable")
    order = order[: max(int((distance > _REGION * distance[order[0]]).sum()), 1)]
    off = np.zeros(len(annulus.vertices), dtype=bool)
    off[corners[order]] = True
    a, b = annulus.faces.ravel(), np.roll(annulus.faces, -1, axis=1).ravel()
    both = off[a] & off[b]
    links = coo_array((np.ones(both.sum()), (a[both], b[both])), shape=(len(off), len(off)))
    region = connected_components(links, directed=False)[1][corners[order, 0]]
    peaks = order[np.sort(np.unique(region, return_index=True)[1])]
    chosen: list[int] = []
    while len(peaks) and len(chosen) < _MOST:
        chosen.append(int(peaks[0]))
        apart = np.linalg.norm(pairs[peaks] - pairs[peaks[0]], axis=2).min(axis=1)
        peaks = peaks[apart > _CLOSE * annulus.mesh.diagonal]
    return chosen
