"""Carry the surface's displacement over to the user's own mesh, vertex by vertex."""

from dataclasses import replace

import igl
import numpy as np
from scipy.spatial import cKDTree

from meshwind.cast import Bools, Floats, frozen
from meshwind.chart.chart import Chart
from meshwind.mandrel.measure import area_vectors, perimeter, volume
from meshwind.mandrel.mesh import Mesh
from meshwind.surface.foot import feet
from meshwind.surface.surface import Surface
from meshwind.threads import spread

FADE = 0.15
"""Of a rim's length (a cap's radius, nearly): beyond the wound region the displacement dies out over this distance."""


def displacement(chart: Chart, before: Surface, after: Surface, bound: float | None = None) -> Floats:
    """How far each vertex (n, 3) of the mesh that was read moves when the surface goes from `before` to `after`.

    A vertex of the wound region moves as the surface does at its foot point, so that it keeps its own distance to
    it.  Vertices that were cut away (caps, the lining of a cup) follow their rim smoothly and stay where they are
    further off: the field is biharmonic between, so that neither it nor its slope breaks at a rim.
    """
    annulus = chart.annulus
    vertices = annulus.mesh.vertices
    own = _feet_moves(chart, before, after)
    place, nearest = cKDTree(annulus.vertices).query(vertices)
    wound = place == 0.0  # trimming copies the coordinates of the vertices that it keeps
    moved = np.zeros_like(vertices)
    moved[wound] = own[nearest[wound]]
    if not wound.all() and np.abs(own).max() > 0:
        moved = _faded(annulus.mesh, moved, wound, max(perimeter(annulus.vertices, rim) for rim in annulus.rims))
    if bound is not None:
        size = np.linalg.norm(moved, axis=1, keepdims=True)
        moved = moved * np.minimum(1.0, bound / np.maximum(size, 1e-300))
    return moved


def displaced(mesh: Mesh, moves: Floats) -> Mesh:
    """The mesh with its vertices moved by `moves` (n, 3), in the same order and with the same faces."""
    return replace(mesh, vertices=frozen(mesh.vertices + moves))


def volume_change(mesh: Mesh, moves: Floats) -> float:
    """By how much the moves (n, 3) change the mesh's volume, open rims capped, in its units cubed."""
    return volume(mesh.vertices + moves, mesh.faces) - volume(mesh.vertices, mesh.faces)


def turned_over(mesh: Mesh, moves: Floats) -> int:
    """How many faces the moves (n, 3) turn by more than a right angle."""
    old, new = area_vectors(mesh.vertices, mesh.faces), area_vectors(mesh.vertices + moves, mesh.faces)
    return int(((old * new).sum(axis=1) <= 0).sum())


def _feet_moves(chart: Chart, before: Surface, after: Surface) -> Floats:
    """The surface's move (k, 3) at the foot of every vertex of the annulus."""
    points = chart.annulus.vertices
    middle = points.mean(axis=0)  # far from the origin the feet would lose digits
    uv, frames = np.array(chart.uv), np.empty((len(points), 6, 3))
    net = frozen(before.net - middle)
    spread(feet, len(points), 500, net, before.periodic, points - middle, uv, frames)
    change = Surface(after.control_points - before.control_points, before.periodic)
    return change.points(uv)


def _faded(mesh: Mesh, moved: Floats, wound: Bools, rim: float) -> Floats:
    """The displacement (n, 3) given at the wound vertices, led over to zero away from them."""
    away = cKDTree(mesh.vertices[wound]).query(mesh.vertices)[0]
    known = np.flatnonzero(wound | (away > FADE * rim))
    if len(known) == len(moved):
        return moved
    between = igl.harmonic(mesh.vertices, mesh.faces, known, moved[known], 2)
    return np.asarray(between)
