"""Cut openings: the part of the surface about a pole within a sphere, or all that lies beyond a lip."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths
from meshwind.mesh.geometry.subdivide import crossing
from meshwind.mesh.geometry.topology import boundary, compact, edges, euler, loops, patches
from meshwind.mesh.opening.poles import Lip, nearest
from meshwind.mesh.opening.skin import Skin, edge_points, with_vertices

_Field: TypeAlias = Callable[[Floats], Floats]  # signed distance of points to the rim's sphere or plane

SNAP = 0.05
"""A vertex closer to the rim than this part of an edge slides along it onto the rim, which spares slivers."""
_FINEST = 0.5  # longest edge near the rim over its radius
_CLEAR = 1e-6  # distance to the other pole over the radius
_ROUNDS = 40


def opened(surface: Skin, pole: Floats, other: Floats, radius: float, most: float) -> Skin | None:
    """Cut the opening whose rim lies at Euclidean distance `radius` from the pole, to round-off.

    None where the sphere holds no disc of the surface about the pole, where the disc reaches a boundary or
    holds the `other` pole, or where its area is over `most`.
    """
    near = _around(surface, pole, radius)
    fine = _refined(replace(surface, faces=surface.faces[near]), pole, radius)
    rim = np.unique(boundary(fine.faces))  # where the neighbourhood ends is out of the disc's reach
    split, side = _split(fine, lambda points: np.linalg.norm(points - pole, axis=1) - radius)
    removed = _disc(split, side, pole)
    if removed is None:
        return None
    disc, kept = split.faces[removed], split.faces[~removed]
    if np.isin(rim, disc).any() or euler(disc) != 1 or areas(split.vertices, disc).sum() > most:
        return None
    reach = float(np.linalg.norm(nearest(split.vertices, disc, other) - other))
    if reach < _CLEAR * radius or pinched(kept, disc):
        return None
    return _kept(replace(split, faces=np.concatenate([surface.faces[~near], kept])))


def pinched(faces: Ints, among: Ints | None = None) -> bool:
    """Whether two rims, or one with itself, meet in a vertex, one of the given ones if any are."""
    tails = boundary(faces)[:, 0]
    tails = tails if among is None else tails[np.isin(tails, among)]
    return len(np.unique(tails)) < len(tails)


def _around(surface: Skin, pole: Floats, radius: float) -> Bools:
    """Mask (m,) of the faces that the sphere may reach and of those about them: an opening changes no other."""
    reached = np.zeros(len(surface.vertices), dtype=bool)
    reached[surface.faces[_near(surface, pole, radius)]] = True
    return np.asarray(reached[surface.faces].any(axis=1))


def _near(surface: Skin, pole: Floats, radius: float) -> Bools:
    """Mask (m,) of the faces whose bounding sphere the sphere reaches."""
    corners = surface.vertices[surface.faces]
    middle = corners.mean(axis=1)
    reach = np.sqrt(((corners - middle[:, None]) ** 2).sum(axis=2).max(axis=1))
    return np.asarray(np.linalg.norm(middle - pole, axis=1) - reach < radius)


def without_lining(surface: Skin, lip: Lip) -> Skin | None:
    """Cut the surface at the lip and keep the largest piece below it, the outside of the cup.

    None where its new rim is not one loop: a ragged lip.
    """
    split, side = _split(surface, lambda points: points @ lip.direction - lip.height)
    below = split.faces[(side[split.faces] <= 0).all(axis=1)]
    label = patches(below)
    largest = np.argmax(np.bincount(label, areas(split.vertices, below)))
    kept = _kept(replace(split, faces=below[label == largest]))
    if pinched(kept.faces):
        return None
    return kept if len(loops(kept.faces)) == 1 + len(loops(surface.faces)) else None


def _refined(surface: Skin, pole: Floats, radius: float) -> Skin:
    """Halve long edges near the rim, so that it gets enough vertices even on the large faces of a flat end."""
    for _ in range(_ROUNDS):
        near = _near(surface, pole, radius)
        long = edge_lengths(surface.vertices, surface.faces[near]) > _FINEST * radius
        if not long.any():
            break
        found = edges(surface.faces)
        cut = found.ends[np.unique(found.of_face[near][long])]
        surface = with_vertices(surface, cut, edge_points(surface, cut, np.full(len(cut), 0.5)))
    return surface


def _split(surface: Skin, field: _Field) -> tuple[Skin, Ints]:
    """Split the surface where the field is 0; also gives the sign (n,) of the field at each vertex."""
    side = np.sign(field(surface.vertices)).astype(np.int64)
    cut = crossing(surface.faces, side)
    t = _where(surface, cut, side, field)
    points = edge_points(surface, cut, t)
    surface, side = _snapped(surface, side, cut, t, points)
    still = (side[cut] != 0).all(axis=1)
    side = np.concatenate([side, np.zeros(int(still.sum()), dtype=np.int64)])
    return with_vertices(surface, cut[still], points[still]), side


def _where(surface: Skin, cut: Ints, side: Ints, field: _Field) -> Floats:
    """Parameter (k,) at which the field is 0 on each edge cubic, by bisection to the last bit."""
    low, high = np.zeros(len(cut)), np.ones(len(cut))
    for _ in range(60):
        middle = 0.5 * (low + high)
        on_low_side = np.sign(field(edge_points(surface, cut, middle))) == side[cut[:, 0]]
        low, high = np.where(on_low_side, middle, low), np.where(on_low_side, high, middle)
    return 0.5 * (low + high)


def _snapped(surface: Skin, side: Ints, cut: Ints, t: Floats, points: Floats) -> tuple[Skin, Ints]:
    """Slide vertices close to the rim onto it, each along the edge on which it is closest."""
    close = np.minimum(t, 1.0 - t)
    order = np.argsort(close, kind="stable")
    order = order[close[order] < SNAP]
    vertex = np.where(t[order] < 0.5, cut[order, 0], cut[order, 1])
    slid, first = np.unique(vertex, return_index=True)
    vertices, trusted, side = surface.vertices.copy(), surface.trusted.copy(), side.copy()
    vertices[slid] = points[order[first]]
    trusted[slid] = False
    side[slid] = 0
    return replace(surface, vertices=vertices, trusted=trusted), side


def _disc(surface: Skin, side: Ints, pole: Floats) -> Bools | None:
    """Mask (m,) of the faces within the sphere that hang together with the vertex closest to the pole."""
    within = np.flatnonzero((side[surface.faces] <= 0).all(axis=1))
    if len(within) == 0:
        return None
    faces = surface.faces[within]
    label = patches(faces)
    distance = np.linalg.norm(surface.vertices[faces] - pole, axis=2).min(axis=1)
    removed = np.zeros(len(surface.faces), dtype=bool)
    removed[within[label == label[np.argmin(distance)]]] = True
    return removed


def _kept(surface: Skin) -> Skin:
    """Surface without the vertices that no face uses."""
    keep, renumber = compact(surface.faces, len(surface.vertices))
    return Skin(surface.vertices[keep], renumber[surface.faces], surface.trusted[keep],
                surface.normals[keep], surface.creased[keep])  # fmt: skip
