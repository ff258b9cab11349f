"""Facets with vertex normals, whose edges are split at points of the curved surface that they approximate.

It is the mesh while it is being trimmed (PN triangles: Vlachos et al., "Curved PN triangles", I3D 2001).
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import area_vectors, edge_lengths
from meshwind.mesh.geometry.subdivide import subdivide
from meshwind.mesh.geometry.topology import edges, loops

_SMOOTH_VERTEX = np.cos(np.radians(30.0))
"""Cosine between a vertex's normal and those of its faces, below which the vertex is on a crease."""
_SMOOTH_EDGE = np.cos(np.radians(40.0))
"""Cosine between the normals at the two ends of an edge, below which the edge stays straight."""


@dataclass(frozen=True)
class CurvedFacets:
    """Triangles with normals.

    vertices (n, 3), faces (m, 3), trusted (n,) as in `Annulus`, unit normals (n, 3), creased (n,) where the surface
    has no normal.
    """

    vertices: Floats
    faces: Ints
    trusted: Bools
    normals: Floats
    creased: Bools


def curved_facets(vertices: Floats, faces: Ints, trusted: Bools) -> CurvedFacets:
    """Facets with normals at their vertices; a face more than 30 degrees off the normal makes a crease."""
    normals = _normals(vertices, faces)
    vectors = area_vectors(vertices, faces)
    size = np.linalg.norm(vectors, axis=1)
    cosine = np.einsum("fci,fi->fc", normals[faces], vectors)
    sharp = cosine < _SMOOTH_VERTEX * size[:, None]
    creased: Bools = np.linalg.norm(normals, axis=1) == 0.0
    creased[faces[sharp]] = True
    return CurvedFacets(vertices, faces, trusted, normals, creased)


def _normals(vertices: Floats, faces: Ints) -> Floats:
    """Unit normals (n, 3) by Max's weights (J. Graphics Tools 4, 1999), exact where the vertices lie on a sphere.

    On a ball of 5120 faces trimming's new vertices are 28 times as close to it as with angle weights (9e-7, 2.5e-5).
    """
    squares = edge_lengths(vertices, faces) ** 2
    squares = squares * np.roll(squares, 1, axis=1)
    weights = np.divide(1.0, squares, out=np.zeros_like(squares), where=squares > 0)
    share = weights[:, :, None] * area_vectors(vertices, faces)[:, None]
    total = np.column_stack([np.bincount(faces.ravel(), share[:, :, k].ravel(), len(vertices)) for k in range(3)])
    return unit(total.astype(np.float64))


def bends(surface: CurvedFacets, ends: Ints) -> Bools:
    """Whether the surface is smooth and curves to one side along each of the edges (k, 2), so that a cubic follows it.

    An edge of which only one end curves, as from a flat face to its border, stays straight.
    """
    low, high = ends.T
    along = surface.vertices[high] - surface.vertices[low]
    turn_low = np.einsum("ij,ij->i", surface.normals[low], along)
    turn_high = -np.einsum("ij,ij->i", surface.normals[high], along)
    even = np.abs(turn_low - turn_high) <= 0.5 * (np.abs(turn_low) + np.abs(turn_high))
    alike = np.einsum("ij,ij->i", surface.normals[low], surface.normals[high]) > _SMOOTH_EDGE
    return np.asarray(even & alike & ~surface.creased[low] & ~surface.creased[high])


def edge_points(surface: CurvedFacets, ends: Ints, t: Floats) -> Floats:
    """Points (k, 3) at the parameters t (k,) in [0, 1] of the cubics over the edges (k, 2)."""
    low, high = ends.T
    start, end = surface.vertices[low], surface.vertices[high]
    along = end - start
    bent = bends(surface, ends)[:, None]
    rise = np.einsum("ij,ij->i", surface.normals[low], along)[:, None] * surface.normals[low]
    drop = np.einsum("ij,ij->i", surface.normals[high], -along)[:, None] * surface.normals[high]
    s, r = t[:, None], 1.0 - t[:, None]
    bow = -(s * r * r * rise + s * s * r * drop)  # the two inner Bezier points leave the chord by -rise/3, -drop/3
    return np.asarray(start + s * along + np.where(bent, bow, 0.0))


def split_edges(surface: CurvedFacets, cut: Ints, points: Floats) -> CurvedFacets:
    """Split the edges cut (k, 2) at the given points (k, 3), which are new, untrusted vertices."""
    low, high = cut.T
    normals = unit(surface.normals[low] + surface.normals[high])
    vertices = np.concatenate([surface.vertices, points])
    return CurvedFacets(
        vertices,
        subdivide(vertices, surface.faces, cut, len(surface.vertices)),
        np.concatenate([surface.trusted, np.zeros(len(cut), dtype=bool)]),
        np.concatenate([surface.normals, normals]),
        np.concatenate([surface.creased, ~bends(surface, cut)]),
    )


def split_chords(surface: CurvedFacets) -> CurvedFacets:
    """Halve all inner edges with both ends on the same rim.

    In every chart both ends have the same v, so that the faces between such an edge and the rim would collapse.
    """
    found = edges(surface.faces)
    rim = np.full(len(surface.vertices), -1)
    for number, loop in enumerate(loops(surface.faces)):
        rim[loop] = number
    start, end = rim[found.ends].T
    cut = found.ends[(found.count == 2) & (start == end) & (start >= 0)]
    if len(cut) == 0:
        return surface
    return split_edges(surface, cut, edge_points(surface, cut, np.full(len(cut), 0.5)))
