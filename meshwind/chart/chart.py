"""The annulus laid out on the periodic rectangle, and areas and speeds of its triangles."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, PicklableRecord, frozen
from meshwind.core.kernel import njit
from meshwind.mesh.geometry.mesh import Annulus


@dataclass(frozen=True)
class Chart(PicklableRecord):
    """One-to-one map of an annulus to the periodic rectangle.

    Attributes
    ----------
    annulus : Annulus
        Mesh with two rims that was flattened.
    uv : ndarray of float, shape (n, 2)
        One representative of each vertex: u in turns, with period 1, and v in [0, 1].
    corner_uv : ndarray of float, shape (m, 3, 2)
        Corners of each triangle with u unwrapped, so that a triangle across the seam is whole.
    flipped : int
        Number of triangles without positive area in the rectangle; 0 in a chart from `flatten`.
    stretch : ndarray of float, shape (m,)
        Area of each triangle on the part over that in the rectangle, divided by its mean.

    Examples
    --------
    >>> import meshwind as mw
    >>> chart = mw.flatten(mw.annulus(mw.read("data/elbow.obj")))
    >>> chart.flipped
    0
    """

    annulus: Annulus
    uv: Floats
    corner_uv: Floats
    flipped: int
    stretch: Floats

    __repr__ = brief


def signed_areas(corner_uv: Floats) -> Floats:
    """Area (m,) of each triangle in the plane from its corners (m, 3, 2); negative where it is flipped."""
    a, b = corner_uv[:, 1] - corner_uv[:, 0], corner_uv[:, 2] - corner_uv[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)


def speeds(annulus: Annulus, corner_uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Signed area of each triangle in the plane and the speeds |s_u| and |s_v| on the part, (m,) each."""
    area, s_u, s_v = _speeds(annulus.vertices, annulus.faces, frozen(corner_uv))
    return area, s_u, s_v


@njit(nogil=True, cache=True, error_model="numpy")
def _speeds(vertices: Floats, faces: Ints, corner_uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Compiled, as it takes a tenth of the time of NumPy: flattening and fitting call it several times."""
    area, s_u, s_v = np.empty(len(faces)), np.empty(len(faces)), np.empty(len(faces))
    for m in range(len(faces)):
        i, j, k = faces[m, 0], faces[m, 1], faces[m, 2]
        a0, a1 = corner_uv[m, 1, 0] - corner_uv[m, 0, 0], corner_uv[m, 1, 1] - corner_uv[m, 0, 1]
        b0, b1 = corner_uv[m, 2, 0] - corner_uv[m, 0, 0], corner_uv[m, 2, 1] - corner_uv[m, 0, 1]
        double = a0 * b1 - a1 * b0
        u = v = 0.0
        for d in range(3):
            p, q = vertices[j, d] - vertices[i, d], vertices[k, d] - vertices[i, d]
            u += (b1 * p - a1 * q) ** 2
            v += (a0 * q - b0 * p) ** 2
        area[m] = double / 2
        s_u[m], s_v[m] = np.sqrt(u) / abs(double), np.sqrt(v) / abs(double)
    return area, s_u, s_v
