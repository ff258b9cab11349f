"""Transfer the displacement of the surface to the vertices of the mesh."""

from dataclasses import replace

import igl
import numpy as np
from scipy.spatial import cKDTree

from meshwind.chart.chart import Chart
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.editing.feet import feet_of
from meshwind.mesh.geometry.areas_and_volumes import area_vectors, perimeter, volume
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.surface.surface import Surface

FADE = 0.15
"""Over the length of a rim (about the radius of a cap): distance over which the displacement dies out beyond a rim."""
RINGS = 2
"""Rings of vertices beyond a cut rim that move as the extended surface does.

The next run cuts among them.  With a field that dies out from the rim, they lie 0.08 mm off the edited surface on the
sample bottle, enough to bring bridges back; with these rings, 0.02 mm.
"""
BEYOND = 3
"""Spans by which the surface is extended at each end, with the polynomials of its last span."""
OFF = 0.01
"""Over the part's size: a vertex further off the extended surface is not part of it."""


def displacement(chart: Chart, before: Surface, after: Surface, fixed: Bools | None = None) -> Floats:
    """Displacement (n, 3) of each vertex of the mesh that was read when the surface changes from `before` to `after`.

    A vertex of the wound region moves as the surface does at its foot point, and keeps its distance to it.  Of the
    vertices that were cut away (caps, the lining of a cup), those next to their rim move as the extended surface does
    and those far off stay, as do those of the other skin of a part with a wall.  Between, the field is biharmonic, so
    that it and its slope are continuous.  fixed: mask (n,) of vertices that must not move.
    """
    annulus = chart.annulus
    vertices = annulus.mesh.vertices
    change = Surface(after.control_points - before.control_points, before.periodic)
    uv = feet_of(before, annulus.vertices, chart.uv)
    distance, nearest = cKDTree(annulus.vertices).query(vertices)
    wound = distance == 0.0  # trimming copies the coordinates of the vertices that it keeps
    moved = np.zeros_like(vertices)
    moved[wound] = change.points(uv[nearest[wound]])
    held = np.zeros_like(wound) if fixed is None else fixed
    moved[held] = 0.0
    if not wound.all() and np.abs(moved).max() > 0:
        still = np.zeros_like(wound)
        still[[] if annulus.wall is None else annulus.wall.opposite] = True
        still |= held
        still &= ~wound
        near, on = _next_to(annulus.mesh, before, wound | still, uv[nearest])
        moved[near] = _extended(change).points(on)
        known = wound | still
        known[near] = True
        moved = _blended(
            annulus.mesh, moved, wound, known, max(perimeter(annulus.vertices, rim) for rim in annulus.rims)
        )
    return moved


def within(moves: Floats, bound: float | Floats | None) -> Floats:
    """The moves (n, 3), with those longer than the bound, of all or of each (n,), shortened to it."""
    if bound is None:
        return moves
    size = np.linalg.norm(moves, axis=1, keepdims=True)
    return np.asarray(moves * np.minimum(1.0, np.reshape(bound, (-1, 1)) / np.maximum(size, 1e-300)))


def displaced(mesh: Mesh, moves: Floats) -> Mesh:
    """The mesh with its vertices moved by `moves` (n, 3), in the same order and with the same faces."""
    return replace(mesh, vertices=frozen(mesh.vertices + moves))


def volume_change(mesh: Mesh, moves: Floats) -> float:
    """Change of the mesh's volume by the moves (n, 3), open rims capped, in its units cubed."""
    return volume(mesh.vertices + moves, mesh.faces) - volume(mesh.vertices, mesh.faces)


def turned_over(mesh: Mesh, moves: Floats) -> int:
    """Number of faces that the moves (n, 3) turn by more than a right angle."""
    old, new = area_vectors(mesh.vertices, mesh.faces), area_vectors(mesh.vertices + moves, mesh.faces)
    return int(((old * new).sum(axis=1) <= 0).sum())


def _extended(surface: Surface) -> Surface:
    """The surface with BEYOND more spans at both ends, which continue its outermost polynomials."""
    net = surface.control_points
    for _ in range(BEYOND):  # their fourth difference is zero
        first, last = (4 * net[:, a] - 6 * net[:, b] + 4 * net[:, c] - net[:, d] for a, b, c, d in (_FIRST, _LAST))
        net = np.concatenate([first[:, None], net, last[:, None]], axis=1)
    return Surface(net, surface.periodic)


_FIRST, _LAST = (0, 1, 2, 3), (-1, -2, -3, -4)


def _next_to(mesh: Mesh, surface: Surface, wound: Bools, uv: Floats) -> tuple[Ints, Floats]:
    """Vertices (k,) within RINGS of the wound ones that lie on the extended surface, and their parameters (k, 2) there.

    uv (n, 2): first guess of each vertex's parameters, on the surface itself.
    """
    ring = wound.copy()
    for _ in range(RINGS):
        ring[mesh.faces[ring[mesh.faces].any(axis=1)]] = True
    near = np.flatnonzero(ring & ~wound)
    spans = surface.spans[1]
    extended = _extended(surface)
    guess = np.array(uv[near])
    guess[:, 1] = (guess[:, 1] * spans + BEYOND) / (spans + 2 * BEYOND)
    on = feet_of(extended, mesh.vertices[near], guess)
    distance = np.linalg.norm(extended.points(on) - mesh.vertices[near], axis=1)
    past = np.maximum(-on[:, 1], on[:, 1] - 1.0) * (spans + 2 * BEYOND) + BEYOND  # spans beyond the rim
    found = (past > 0.0) & (past < BEYOND - 1e-6) & (distance < OFF * surface.size)
    return near[found], on[found]


def _blended(mesh: Mesh, moved: Floats, wound: Bools, known: Bools, rim: float) -> Floats:
    """The displacement (n, 3) that is given at the known vertices, blended to zero away from the wound ones."""
    away = cKDTree(mesh.vertices[wound]).query(mesh.vertices)[0]
    fixed = np.flatnonzero(known | (away > FADE * rim))
    if len(fixed) == len(moved):
        return moved
    between = igl.harmonic(mesh.vertices, mesh.faces, fixed, moved[fixed], 2)
    return np.asarray(between)
