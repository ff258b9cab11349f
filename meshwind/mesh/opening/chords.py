"""Edges that run from a rim to itself across the surface: no chart can keep the faces behind them from collapsing."""

import numpy as np

from meshwind.mesh.geometry.topology import edges, loops
from meshwind.mesh.opening.skin import Skin, edge_points, with_vertices


def without_chords(surface: Skin) -> Skin:
    """Halve every inner edge both of whose ends lie on the same rim."""
    found = edges(surface.faces)
    rim = np.full(len(surface.vertices), -1)
    for number, loop in enumerate(loops(surface.faces)):
        rim[loop] = number
    start, end = rim[found.ends].T
    cut = found.ends[(found.count == 2) & (start == end) & (start >= 0)]
    if len(cut) == 0:
        return surface
    return with_vertices(surface, cut, edge_points(surface, cut, np.full(len(cut), 0.5)))
