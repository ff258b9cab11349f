"""Rows that a change of the control net must keep in every round: only outward or inward, and the volume."""

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from meshwind.core.cast import Floats, Ints
from meshwind.editing.stencil import along, lattice, weights
from meshwind.mesh.geometry.areas_and_volumes import area_vectors, volume
from meshwind.surface.surface import Surface

PER_SPAN = 2
"""Samples per span and direction where the surface keeps its side, and of the body whose volume is kept."""
KEPT, FINE = 2e-4, 5e-4
"""Shares of the volume: by which a round may change it to first order, and by which an edit may have changed it.

With the refit and the caps it is kept to 1e-3.
"""


@dataclass(frozen=True)
class Kept:
    """Rows matrix @ change >= least (k,) over the net's coordinates (k, 3m), in the surface's units."""

    matrix: sparse.csr_array
    least: Floats

    def and_(self, other: "Kept") -> "Kept":
        """Both."""
        matrix = sparse.csr_array(sparse.vstack([self.matrix, other.matrix]))
        return Kept(matrix, np.concatenate([self.least, other.least]))


def nothing(surface: Surface) -> Kept:
    """No rows."""
    return Kept(sparse.csr_array((0, surface.control_points.size)), np.zeros(0))


def one_way(first: Surface, moved: Floats, inward: bool) -> Kept:
    """The first surface moves outward only, or inward, counting what it has moved so far (m, 3)."""
    uv = lattice(first, PER_SPAN)
    direction = first.normals(uv) * (-1.0 if inward else 1.0)
    which, (part,) = weights(first, uv, ((0, 0),))
    matrix = along(which, part, direction, len(moved))
    return Kept(matrix, -(matrix @ moved.ravel()))


def same_volume(first: Surface, now: Surface) -> Kept:
    """The volume inside stays that of the first surface, its rims capped by fans."""
    body, faces = _body(now)
    before, after = (body @ net.control_points.reshape(-1, 3) for net in (first, now))
    slope = np.zeros_like(after)
    vectors = area_vectors(after, faces)
    for corner in range(3):  # the volume is a sum of tetrahedra, linear in each vertex
        a, b = after[faces[:, (corner + 1) % 3]], after[faces[:, (corner + 2) % 3]]
        np.add.at(slope, faces[:, corner], np.cross(a, b) / 6.0)
    whole, gone = volume(before, faces), volume(after, faces) - volume(before, faces)
    sign = np.sign(whole)
    gradient = sign * (body.T @ slope).reshape(1, -1)
    size = float(np.linalg.norm(vectors, axis=1).sum())  # of the order of the area: the rows become lengths
    room = KEPT * abs(whole)
    matrix = sparse.csr_array(np.concatenate([gradient, -gradient]) / size)
    return Kept(matrix, np.array([-sign * gone - room, sign * gone - room]) / size)


def volume_gain(first: Surface, now: Surface) -> float:
    """Share of the first surface's volume by which another has more."""
    body, faces = _body(now)
    before, after = (volume(body @ net.control_points.reshape(-1, 3), faces) for net in (first, now))
    return after / before - 1.0


def _body(surface: Surface) -> tuple[sparse.csr_array, Ints]:
    """Vertices (n, m) by the control points, and triangles (k, 3), of a body with the surface's shape."""
    uv = lattice(surface, PER_SPAN)
    around = PER_SPAN * surface.spans[0]
    which, (part,) = weights(surface, uv, ((0, 0),))
    row = np.repeat(np.arange(len(uv)), part.shape[1])
    points = surface.control_points.size // 3
    samples = sparse.csr_array((part.ravel(), (row, which.ravel())), shape=(len(uv), points))
    rims = [np.arange(around), len(uv) - around + np.arange(around)]
    caps = [sparse.csr_array(samples[rim].sum(axis=0).reshape(1, -1) / around) for rim in rims]
    return sparse.csr_array(sparse.vstack([samples, *caps])), _faces(around, len(uv) // around)


def _faces(around: int, rings: int) -> Ints:
    """Triangles (k, 3) of a lattice that is closed around, with fans to two more points at its ends."""
    here = np.arange(around)
    beside = (here + 1) % around
    ring = around * np.arange(rings - 1)[:, None]
    a, b = (ring + here).ravel(), (ring + beside).ravel()
    sides = [np.stack([a, b, b + around], axis=1), np.stack([a, b + around, a + around], axis=1)]
    last, end = around * (rings - 1), around * rings
    first = np.stack([beside, here, np.full(around, end)], axis=1)
    return np.concatenate([*sides, first, np.stack([last + here, last + beside, np.full(around, end + 1)], axis=1)])
