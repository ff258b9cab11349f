"""Cutting of an opening: the surface around a pole within a sphere, or all beyond a lip, is removed."""

from collections.abc import Callable
from dataclasses import replace
from typing import TypeAlias

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths
from meshwind.mesh.geometry.subdivide import crossing
from meshwind.mesh.geometry.topology import boundary, compact, edges, euler, loops, patches
from meshwind.mesh.opening.curved_facets import CurvedFacets, edge_points, split_edges
from meshwind.mesh.opening.poles import Lip, nearest

_Field: TypeAlias = Callable[[Floats], Floats]
"""Signed distance (n,) of points (n, 3) from the sphere or plane of the rim."""

_SNAP = 0.05
"""A vertex closer to the rim than this share of an edge is moved along it onto the rim, to avoid slivers."""
_LONGEST_EDGE = 0.5
"""Longest edge near the rim over the radius."""
_CLEARANCE = 1e-6
"""Smallest distance of the disc from the other pole over the radius."""
_MAX_HALVINGS = 40
"""Maximum number of times that long edges are halved."""
_BISECTIONS = 60
"""Halvings of the interval [0, 1] down to round-off."""


def cut_opening(
    surface: CurvedFacets, pole: Floats, other: Floats, radius: float, max_area: float
) -> CurvedFacets | None:
    """Cut an opening whose rim is at the Euclidean distance `radius` from the pole, to round-off.

    Returns None if the surface within the sphere is not a disc around the pole, if the disc reaches a boundary or
    contains the `other` pole, or if its area exceeds `max_area`.
    """
    near = _around(surface, pole, radius)
    fine = _refined(replace(surface, faces=surface.faces[near]), pole, radius)
    rim = np.unique(boundary(fine.faces))  # a disc that reaches the end of the neighbourhood is not complete
    split, side = split_where(fine, lambda points: np.linalg.norm(points - pole, axis=1) - radius)
    removed = _disc(split, side, pole)
    if removed is None:
        return None
    disc, kept = split.faces[removed], split.faces[~removed]
    if np.isin(rim, disc).any() or euler(disc) != 1 or areas(split.vertices, disc).sum() > max_area:
        return None
    clearance = float(np.linalg.norm(nearest(split.vertices, disc, other) - other))
    if clearance < _CLEARANCE * radius or pinched(kept, disc):
        return None
    return without_unused(replace(split, faces=np.concatenate([surface.faces[~near], kept])))


def pinched(faces: Ints, among: Ints | None = None) -> bool:
    """Whether two rims, or one with itself, meet in a vertex; `among`: the faces whose vertices are considered."""
    tails = boundary(faces)[:, 0]
    tails = tails if among is None else tails[np.isin(tails, among)]
    return len(np.unique(tails)) < len(tails)


def _around(surface: CurvedFacets, pole: Floats, radius: float) -> Bools:
    """Mask (m,) of the faces that the sphere may reach and of their neighbours: an opening changes no others."""
    reached = np.zeros(len(surface.vertices), dtype=bool)
    reached[surface.faces[_reached(surface, pole, radius)]] = True
    return np.asarray(reached[surface.faces].any(axis=1))


def _reached(surface: CurvedFacets, pole: Floats, radius: float) -> Bools:
    """Mask (m,) of the faces whose bounding sphere meets the sphere."""
    corners = surface.vertices[surface.faces]
    middle = corners.mean(axis=1)
    reach = np.sqrt(((corners - middle[:, None]) ** 2).sum(axis=2).max(axis=1))
    return np.asarray(np.linalg.norm(middle - pole, axis=1) - reach < radius)


def cut_at_lip(surface: CurvedFacets, lip: Lip) -> CurvedFacets | None:
    """Cut the surface at the lip and keep the largest piece below it, the outside of the cup.

    Returns None if the new rim is not one loop, because the lip is ragged.
    """
    split, side = split_where(surface, lambda points: points @ lip.direction - lip.height)
    below = split.faces[(side[split.faces] <= 0).all(axis=1)]
    label = patches(below)
    largest = np.argmax(np.bincount(label, areas(split.vertices, below)))
    kept = without_unused(replace(split, faces=below[label == largest]))
    if pinched(kept.faces):
        return None
    return kept if len(loops(kept.faces)) == 1 + len(loops(surface.faces)) else None


def _refined(surface: CurvedFacets, pole: Floats, radius: float) -> CurvedFacets:
    """Halve long edges near the rim, so that it has enough vertices even on the large faces of a flat end."""
    for _ in range(_MAX_HALVINGS):
        near = _reached(surface, pole, radius)
        long = edge_lengths(surface.vertices, surface.faces[near]) > _LONGEST_EDGE * radius
        if not long.any():
            break
        found = edges(surface.faces)
        cut = found.ends[np.unique(found.of_face[near][long])]
        surface = split_edges(surface, cut, edge_points(surface, cut, np.full(len(cut), 0.5)))
    return surface


def split_where(surface: CurvedFacets, field: _Field, above: Bools | None = None) -> tuple[CurvedFacets, Ints]:
    """Split the surface where the field is 0; also returns the sign (n,) of the field at each vertex.

    above: mask (n,) of the vertices that may count as above 0, where not all do.
    """
    side = np.sign(field(surface.vertices)).astype(np.int64)
    side = side if above is None else np.where(above, side, -1)
    cut = crossing(surface.faces, side)
    t = _where(surface, cut, side, field)
    points = edge_points(surface, cut, t)
    surface, side = _snapped(surface, side, cut, t, points)
    still = (side[cut] != 0).all(axis=1)
    side = np.concatenate([side, np.zeros(int(still.sum()), dtype=np.int64)])
    return split_edges(surface, cut[still], points[still]), side


def _where(surface: CurvedFacets, cut: Ints, side: Ints, field: _Field) -> Floats:
    """Parameters (k,) at which the field is 0 on the cubics over the edges cut (k, 2), by bisection."""
    low, high = np.zeros(len(cut)), np.ones(len(cut))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        on_low_side = np.sign(field(edge_points(surface, cut, middle))) == side[cut[:, 0]]
        low, high = np.where(on_low_side, middle, low), np.where(on_low_side, high, middle)
    return 0.5 * (low + high)


def _snapped(surface: CurvedFacets, side: Ints, cut: Ints, t: Floats, points: Floats) -> tuple[CurvedFacets, Ints]:
    """Move vertices close to the rim onto it, each along the edge on which it is closest."""
    close = np.minimum(t, 1.0 - t)
    order = np.argsort(close, kind="stable")
    order = order[close[order] < _SNAP]
    vertex = np.where(t[order] < 0.5, cut[order, 0], cut[order, 1])
    slid, first = np.unique(vertex, return_index=True)
    vertices, trusted, side = surface.vertices.copy(), surface.trusted.copy(), side.copy()
    vertices[slid] = points[order[first]]
    trusted[slid] = False
    side[slid] = 0
    return replace(surface, vertices=vertices, trusted=trusted), side


def _disc(surface: CurvedFacets, side: Ints, pole: Floats) -> Bools | None:
    """Mask (m,) of the faces within the sphere that are connected to the vertex closest to the pole."""
    within = np.flatnonzero((side[surface.faces] <= 0).all(axis=1))
    if len(within) == 0:
        return None
    faces = surface.faces[within]
    label = patches(faces)
    distance = np.linalg.norm(surface.vertices[faces] - pole, axis=2).min(axis=1)
    removed = np.zeros(len(surface.faces), dtype=bool)
    removed[within[label == label[np.argmin(distance)]]] = True
    return removed


def without_unused(surface: CurvedFacets) -> CurvedFacets:
    """Surface without unused vertices."""
    keep, renumber = compact(surface.faces, len(surface.vertices))
    return CurvedFacets(surface.vertices[keep], renumber[surface.faces], surface.trusted[keep],
                surface.normals[keep], surface.creased[keep])  # fmt: skip
