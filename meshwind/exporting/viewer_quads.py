"""The quad mesh between crossings in the page for a browser, as the edges of its faces."""

from typing import TypedDict

import numpy as np

from meshwind.core.cast import Ints
from meshwind.exporting.packing import Packed, packed
from meshwind.results.reading import Results
from meshwind.results.schema import QUADS
from meshwind.results.vtk_reading import read_faces

_MOST = 20_000
"""Faces in the page at most: each takes some 30 bytes of it."""


class QuadData(TypedDict):
    """Edges of the quad mesh: points (3, k), ends (2, e) of the edges among them; count: of quads, shown or not."""

    points: Packed
    ends: Packed
    count: int


def quad_data(results: Results) -> QuadData | None:
    """The edges of a run's quad mesh, None where it has no faces."""
    file = results.folder / QUADS
    if not file.is_file():
        return None
    read = read_faces(file)
    if not len(read.quads):
        return None
    sides = np.concatenate([_sides(faces) for faces in (read.quads, read.triangles)])
    edges = np.unique(np.sort(sides, axis=1), axis=0)
    if len(read.quads) > _MOST:
        edges = edges[:0]
    return {
        "points": packed(read.points[: edges.max(initial=-1) + 1].T),
        "ends": packed(edges.T),
        "count": len(read.quads),
    }


def _sides(faces: Ints) -> Ints:
    """Sides (k, 2) of faces (f, n)."""
    return np.stack([faces, np.roll(faces, -1, axis=1)], axis=2).reshape(-1, 2)
