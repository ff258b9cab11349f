"""Points between the vertices, where triangles are larger than the net's spans.

Vertices alone leave the net free over large triangles (a cylinder meshed in one strip), and it would swing there.
The points lie on curved triangles (`point_normal`), and on the flat facets next to creases.
"""

from typing import TypeAlias

import igl
import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.surface.fitting import point_normal

Int8s: TypeAlias = NDArray[np.int8]

ANGLE = igl.PER_VERTEX_NORMALS_WEIGHTING_TYPE_ANGLE
FINEST = 64
"""Maximum number of pieces that an edge is divided into."""


def infill(corners: Floats, normals: Floats, corner_uv: Floats, pieces: Int8s) -> tuple[Floats, Floats]:
    """Points (k, 2) in the plane and (k, 3) in space that leave no span of the net without data.

    Each triangle has corners (c, 3, 3) in space, normals (c, 3, 3) there and corner_uv (c, 3, 2) in the plane.  It gets
    a lattice that divides its edges into `pieces` (c,), without the corners.
    """
    tangent, _ = point_normal.tangent_normals(corners, normals)
    found = []
    for count in np.unique(pieces):
        chosen = np.flatnonzero(pieces == count)
        found.append(_lattice(corners[chosen], tangent[chosen], corner_uv[chosen], int(count)))
    return np.concatenate([f[0] for f in found]), np.concatenate([f[1] for f in found])


@njit(nogil=True, cache=True)
def spans_across(
    first: int, last: int, faces: Ints, uv: Floats, turns: Int8s, spans: tuple[int, int], out: Int8s
) -> None:
    """Write into `out` (m,) the widths of the triangles first to last in spans, at most FINEST.

    uv (n, 2) are the vertices' parameters, turns (m, 3) the turns of u by which a triangle's corners differ from them.
    One pass over the faces: array expressions cost ten times as much, and there are few coarse triangles or none.
    """
    for m in range(first, last):
        i, j, k = faces[m, 0], faces[m, 1], faces[m, 2]
        widest = 0.0
        for axis in range(2):
            a, b, c = uv[i, axis], uv[j, axis], uv[k, axis]
            if axis == 0:
                a, b, c = a + turns[m, 0], b + turns[m, 1], c + turns[m, 2]
            widest = max(widest, (max(a, b, c) - min(a, b, c)) * spans[axis])
        out[m] = min(int(np.ceil(widest)), FINEST)


def _lattice(corners: Floats, normals: Floats, corner_uv: Floats, pieces: int) -> tuple[Floats, Floats]:
    i, j = np.meshgrid(np.arange(pieces + 1), np.arange(pieces + 1), indexing="ij")
    inside = (i + j <= pieces) & (np.maximum(np.maximum(i, j), pieces - i - j) < pieces)
    weight = np.stack([i[inside], j[inside], (pieces - i - j)[inside]], axis=1) / pieces
    uv = np.einsum("sk,mkd->msd", weight, corner_uv).reshape(-1, 2)
    facet, share = np.repeat(np.arange(len(corners)), len(weight)), np.tile(weight, (len(corners), 1))
    corner = 3 * facet[:, None] + np.arange(3)
    return uv, point_normal.curved(facet, corner, share, corners.reshape(-1, 3), normals)
