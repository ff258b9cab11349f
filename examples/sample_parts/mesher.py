"""Irregular triangulation of a smooth map: Lloyd's relaxation on a dense sample, and the dual of its cells.

A dense, jittered grid stands for the surface.  Sites chosen at random among its points move to the centroids
of their cells until they are spread as a mesher or a scanner spreads them; where three cells meet there is a
triangle.  All vertices are points of the grid, so they lie on the surface itself.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import trimesh
from numpy.typing import NDArray
from scipy.spatial import KDTree

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Map = Callable[[Floats, Floats], Floats]

ROUNDS = 20
"""Of Lloyd's relaxation."""
JITTER = 0.35
"""Largest offset of the dense grid's points, over its pitch."""
RIM_JITTER, SITE_JITTER = 0.3, 0.8
"""Largest offset of a first site along a rim, and within its share of the area, over what each site has."""


@dataclass(frozen=True)
class Part:
    """A smooth map and how to mesh it.

    vertices is the count wanted; grid counts the dense sample around and along; sharpness, a length, draws
    vertices to where the radius of curvature is smaller than it.
    """

    file: str
    shape: Map
    closed: bool
    vertices: int
    grid: tuple[int, int] = (500, 600)
    sharpness: float = 0.0


def dense_grid(part: Part, random: np.random.Generator) -> tuple[Floats, Ints]:
    """Return points (n, 3) and outward faces (m, 3) of a dense sample; a pole is a single point."""
    around, along = part.grid
    u = np.tile(np.arange(around), along + 1) + JITTER * (2 * random.random(around * (along + 1)) - 1)
    # whole rows move, lest they cross where they crowd around a pole
    rows = np.arange(along + 1) + JITTER * (2 * random.random(along + 1) - 1)
    rows[0], rows[-1] = 0, along
    v = np.repeat(rows, around)
    points = part.shape(u / around, v / along)
    index = np.arange(u.size).reshape(along + 1, around)
    if part.closed:
        index[0], index[-1] = index[0, 0], index[-1, 0]
    a, b = index[:-1], np.roll(index[:-1], -1, axis=1)
    c, d = np.roll(index[1:], -1, axis=1), index[1:]
    faces = np.concatenate([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)]).reshape(-1, 3)
    faces = faces[(faces != np.roll(faces, 1, axis=1)).all(axis=1)]
    used, compact = np.unique(faces, return_inverse=True)
    return points[used], compact.reshape(-1, 3)


def embed(points: Floats, faces: Ints, sharpness: float) -> tuple[Floats, Floats]:
    """Return the space in which vertices spread evenly, (n, 3) or (n, 6), and the area weights (n,)."""
    space = points
    if sharpness > 0:
        normals = trimesh.Trimesh(points, faces, process=False).vertex_normals
        space = np.hstack([points, sharpness * normals])
    one, two = space[faces[:, 1]] - space[faces[:, 0]], space[faces[:, 2]] - space[faces[:, 0]]
    gram = (one**2).sum(1) * (two**2).sum(1) - (one * two).sum(1) ** 2
    area = 0.5 * np.sqrt(np.maximum(gram, 0))
    return space, np.bincount(faces.ravel(), np.repeat(area / 3, 3), len(points)).astype(np.float64)


def rim_sites(space: Floats, rims: Ints, spacing: float, random: np.random.Generator) -> Ints:
    """Return those of the points of the two rims that become vertices, a little unevenly spaced as inside."""
    chosen = [np.empty(0, dtype=np.int64)]
    for rim in np.split(rims, 2):
        length = np.cumsum(np.linalg.norm(space[rim] - np.roll(space[rim], 1, axis=0), axis=1))
        count = round(float(length[-1:].sum()) / spacing)
        share = (np.arange(count) + RIM_JITTER * random.random(count)) / max(count, 1)
        chosen.append(rim[np.searchsorted(length, share * length[-1:].sum())])
    return np.concatenate(chosen)


def nearest(among: Floats, points: Floats) -> Ints:
    """Return the index (n,) of the row of `among` nearest to each of the points (n, d)."""
    return np.asarray(KDTree(among).query(points, workers=-1)[1], dtype=np.int64)


def cells(space: Floats, sites: Floats, fixed: Ints, rim: Ints) -> Ints:
    """Return the index of the site nearest to each point; the points of the rims go to the sites on them."""
    label = nearest(sites, space)
    if len(rim):
        # a cell of the interior that reached a rim would leave a notch in it
        label[rim] = nearest(space[fixed], space[rim])
    return label


def relax(space: Floats, weight: Floats, fixed: Ints, count: int, random: np.random.Generator) -> Floats:
    """Return sites (count, d), the fixed ones first, after Lloyd's relaxation of the others."""
    free_weight = weight.copy()
    free_weight[fixed] = 0
    total = np.cumsum(free_weight)
    wanted = count - len(fixed)
    # one site in each equal share of the area, so that no two begin at one point
    free = np.searchsorted(total, (np.arange(wanted) + SITE_JITTER * random.random(wanted)) * total[-1] / wanted)
    sites: Floats = space[np.concatenate([fixed, free])]
    for _ in range(ROUNDS):
        label = nearest(sites, space)
        mass = np.bincount(label, weight, count)
        centre = np.column_stack([np.bincount(label, weight * x, count) for x in space.T]) / mass[:, None]
        sites[len(fixed) :] = centre[len(fixed) :]
    return sites


def dual(label: Ints) -> Ints:
    """Return a triangle (m, 3) where three cells meet, from the cells (k, 3) of the dense faces' corners."""
    met = label[(label != np.roll(label, 1, axis=1)).all(axis=1)]
    lowest = met.argmin(axis=1)[:, None]
    met = np.take_along_axis(met, (lowest + np.arange(3)) % 3, axis=1)
    odd = met[:, 1] > met[:, 2]
    triangle, number = np.unique(np.sort(met, axis=1), axis=0, return_inverse=True)
    # a ragged border of cells may meet there and back again: the passes cancel
    sense = np.sign(np.bincount(number, np.where(odd, -1.0, 1.0)))
    oriented: Ints = np.where((sense < 0)[:, None], triangle[:, [0, 2, 1]], triangle)[sense != 0]
    return oriented


def triangulate(part: Part, seed: int) -> tuple[Floats, Ints]:
    """Return vertices (n, 3) and outward faces (m, 3) of an irregular triangle mesh on the part's map."""
    random = np.random.default_rng(seed)
    points, faces = dense_grid(part, random)
    space, weight = embed(points, faces, part.sharpness)
    # the spacing of an even hexagonal packing
    spacing = float(np.sqrt(2 / np.sqrt(3) * weight.sum() / part.vertices))
    rim = np.flatnonzero(np.arange(len(points)) % (len(points) - part.grid[0]) < part.grid[0])
    rim = rim[:0] if part.closed else rim
    fixed = rim_sites(space, rim, spacing, random)
    chosen = nearest(space, relax(space, weight, fixed, part.vertices, random))
    return points[chosen], dual(cells(space, space[chosen], fixed, rim)[faces])
