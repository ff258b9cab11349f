"""The nodes of a shell deck: corners, middles of sides where its elements are of second order, and both rims."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.exporting.elements import Elements


@dataclass(frozen=True)
class Rim:
    """Nodes (r,) of a rim, the share (r,) of a uniform load on each, and the area (3,) of its opening inside.

    The area is a vector square to the opening that points out of the part.
    """

    nodes: Ints
    shares: Floats
    area: Floats


@dataclass(frozen=True)
class Nodes:
    """Points (n, 3) and the elements' nodes, quads (q, 4 or 8) and triangles (t, 3 or 6), from 0; start and end rim."""

    points: Floats
    quads: Ints
    triangles: Ints
    rims: tuple[Rim, Rim]


def nodes_of(elements: Elements, quadratic: bool) -> Nodes:
    """Number the nodes; mid-side nodes lie on the surface."""
    edges = elements.edges
    uv, faces, number = elements.uv, (elements.quads, elements.triangles), None
    if quadratic:
        number = len(uv) + np.arange(len(edges))
        uv = np.concatenate([uv, elements.between(edges)])
        faces = _with_middles(elements.quads, edges, number), _with_middles(elements.triangles, edges, number)
    inside = elements.skin.points(uv)
    start, end = (
        Rim(*_shares(elements, edges, rim, number), _opening(inside, faces, rim)) for rim in elements.rims
    )  # fmt: skip
    return Nodes(elements.surface.points(uv), *faces, (start, end))


def _with_middles(faces: Ints, edges: Ints, number: Ints) -> Ints:
    """Faces (m, 2 c): corners, then mid-side nodes, of faces (m, c)."""
    most = edges.max(initial=0) + 1
    sides = np.sort(np.stack([faces, np.roll(faces, -1, axis=1)], axis=2), axis=2)
    at = np.searchsorted(edges[:, 0] * most + edges[:, 1], sides[..., 0] * most + sides[..., 1])
    return np.concatenate([faces, number[at]], axis=1)


def _shares(elements: Elements, edges: Ints, rim: Ints, number: Ints | None) -> tuple[Ints, Floats]:
    """Nodes of a rim and the share of a uniform load on each: Simpson's weights if there are mid-side nodes."""
    along = np.isin(edges, rim).all(axis=1)
    mine = edges[along]
    length = np.linalg.norm(np.diff(elements.points[mine], axis=1)[:, 0], axis=1)
    length = length / length.sum()
    corner = 0.5 if number is None else 1.0 / 6.0
    nodes = mine.ravel() if number is None else np.concatenate([mine.ravel(), number[along]])
    weight = np.repeat(corner * length, 2)
    if number is not None:
        weight = np.concatenate([weight, 2.0 / 3.0 * length])
    unique, where = np.unique(nodes, return_inverse=True)
    return unique.astype(np.int64), np.bincount(where, weight).astype(np.float64)


def _opening(points: Floats, faces: tuple[Ints, Ints], rim: Ints) -> Floats:
    """Area of the opening inside of a rim of corners, as a vector out of the part, by the polygon of its nodes.

    Faces run counterclockwise seen from outside, so that their sides on the rim run so round the opening's inward
    normal; a side that two faces share counts twice, there and back.
    """
    area, middle = np.zeros(3), points[rim].mean(axis=0)
    for each in faces:
        count = each.shape[1] if each.shape[1] < 6 else each.shape[1] // 2
        corners = each[:, :count]
        ring = corners
        if each.shape[1] > count:
            ring = np.stack([corners, each[:, count:]], axis=2).reshape(len(each), 2 * count)
        here = np.isin(corners, rim) & np.isin(np.roll(corners, -1, axis=1), rim)
        here = np.repeat(here, ring.shape[1] // count, axis=1)
        first, last = points[ring][here] - middle, points[np.roll(ring, -1, axis=1)][here] - middle
        area -= 0.5 * np.cross(first, last).sum(axis=0)
    return area
