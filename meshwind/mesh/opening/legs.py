"""Legs of a part beside the way between its two rims, found from distances on its surface."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import connected_components, dijkstra

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas
from meshwind.mesh.geometry.edge_graph import edge_graph
from meshwind.mesh.geometry.mesh import Annulus
from meshwind.mesh.geometry.prominence import saddles

_LONG = 1.2
"""Length of a leg over its radius from which on it is one.  Heads of hammers have 1.5, condyles and faces below 0.9."""
_ROOT = 0.05
"""Share of its length from which on a surface counts to a leg."""
_MOST = 24
"""Tips that are looked at: the furthest ones."""


@dataclass(frozen=True)
class Leg:
    """A leg: its tip (3,), its length from where it branches off, its girth half way, and its vertices (n,)."""

    tip: Floats
    length: float
    girth: float
    vertices: Bools


@dataclass(frozen=True)
class _Surface:
    """Vertices and faces of an annulus, and the lengths of its edges as a symmetric matrix."""

    vertices: Floats
    faces: Ints
    steps: sparse.csr_array


def legs(annulus: Annulus) -> tuple[list[Leg], float]:
    """Legs of a part that is opened at its ends, the longest first, and the mean girth of the part without them.

    A tip is a place on the surface from which all ways to the one rim are shorter than from around it, and all to the
    other rim as well: it has a prominence over the saddle behind it, where the ways past the leg meet again.  A bump
    has none, as the way over its top is the shorter one.
    """
    surface = _Surface(annulus.vertices, annulus.faces, edge_graph(annulus.vertices, annulus.faces))
    first, second = (_tips(surface, *rims) for rims in (annulus.rims, annulus.rims[::-1]))
    found = list[Leg]()
    for leg in first[0]:
        same = [other for other in second[0] if _overlap(leg, other)]
        if same and not any(_overlap(leg, other) for other in found):
            # as the one of the two that stands out less tells it
            found.append(min([leg, max(same, key=_length)], key=_length))
    in_legs = np.logical_or.reduce([leg.vertices for leg in found], initial=False) & np.ones(
        len(surface.vertices), bool
    )
    trunk = areas(surface.vertices, surface.faces)[~in_legs[surface.faces].any(axis=1)].sum()
    return sorted(found, key=_length, reverse=True), float(trunk) / first[1]


def _length(leg: Leg) -> float:
    return leg.length


def _overlap(leg: Leg, other: Leg) -> bool:
    return bool((leg.vertices & other.vertices).any())


def _tips(surface: _Surface, start: Ints, end: Ints) -> tuple[list[Leg], float]:
    """Legs as seen from the start, and the distance of the two rims."""
    away = dijkstra(surface.steps, indices=start, min_only=True)
    height = away.copy()
    height[end] = np.inf
    above = np.arange(len(away))
    order = np.argsort(-height, kind="stable")
    above[end] = order[0]
    met = saddles(order, above, surface.steps.indptr.astype(np.int64), surface.steps.indices.astype(np.int64))
    tips = np.flatnonzero(met >= 0)
    rise = away[tips] - away[met[tips]]
    most = np.argsort(-rise, kind="stable")[:_MOST]
    found = [
        _leg(surface, away, int(tip), float(length))
        for tip, length in zip(tips[most], rise[most], strict=True)
        if length > 0.0
    ]
    return [leg for leg in found if leg.length > _LONG * leg.girth / (2.0 * np.pi)], float(away[end].min())


def _leg(surface: _Surface, away: Floats, tip: int, length: float) -> Leg:
    crotch = float(away[tip]) - length
    middle, root = crotch + 0.5 * length, crotch + _ROOT * length
    girth = _girth(surface, away - middle, _above(surface, away, tip, middle))
    return Leg(surface.vertices[tip], length, girth, _above(surface, away, tip, root))


def _above(surface: _Surface, away: Floats, tip: int, level: float) -> Bools:
    """The vertices that a tip is joined with above a level."""
    upper = np.flatnonzero(away > level)
    label = connected_components(surface.steps[upper][:, upper], directed=False)[1]
    found = np.zeros(len(away), dtype=bool)
    found[upper[label == label[np.searchsorted(upper, tip)]]] = True
    return found


def _girth(surface: _Surface, height: Floats, above: Bools) -> float:
    """Length of the level line about the vertices above it."""
    inside = above[surface.faces]
    cut = inside.any(axis=1) & ~inside.all(axis=1)
    faces, inside = surface.faces[cut], inside[cut]
    # the corner that is alone on its side comes first
    alone = np.argmax(inside == (inside.sum(axis=1) == 1)[:, None], axis=1)
    a, b, c = (faces[np.arange(len(faces)), (alone + k) % 3] for k in range(3))
    ends = [
        surface.vertices[a]
        + (height[a] / (height[a] - height[other]))[:, None] * (surface.vertices[other] - surface.vertices[a])
        for other in (b, c)
    ]
    return float(np.linalg.norm(ends[0] - ends[1], axis=1).sum())
