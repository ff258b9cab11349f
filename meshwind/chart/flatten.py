"""Flatten an annulus to the periodic rectangle: two sparse harmonic systems, positive weights where needed."""

from typing import Any

import igl
import numpy as np
from scipy import sparse
from scipy.sparse.linalg import splu

from meshwind.cast import Bools, Floats, frozen
from meshwind.chart.chart import Chart
from meshwind.chart.cut import far_side, seam
from meshwind.chart.spacing import even_speed
from meshwind.errors import BadInputError
from meshwind.mandrel.annulus import Annulus


def flatten(annulus: Annulus) -> Chart:
    """Map the annulus one to one to u in turns and v in [0, 1], v = 0 on the start rim and 1 on the end rim.

    v is harmonic between the rims; u is harmonic with natural conditions at the rims and gains one turn across
    the cut, so the twist between the ends comes out by itself and the cut leaves no trace.  Cotangent weights
    are taken where they give an embedding; otherwise mean-value weights, which are positive and always do: the
    annulus mirrored into a torus is then a discrete one-form embedding (Gortler, Gotsman and Thurston 2006).
    v is then re-spaced so that the mean speed on the part is constant.  Raises BadInputError if a triangle
    still flips, which only degenerate triangles can bring about.
    """
    jump = far_side(annulus, seam(annulus)).astype(np.float64)
    for weights in (_cotangents, _mean_values):
        uv = _solve(annulus, weights(annulus), jump)
        corner = _corners(annulus, uv, jump)
        if not (_area(corner) <= 0).any():
            break
    else:
        count = int((_area(corner) <= 0).sum())
        raise BadInputError(f"{count} triangles flip in the flattening; remesh the part without slivers")
    uv, corner = even_speed(annulus, uv, corner)
    area = _area(corner)
    space = igl.doublearea(annulus.vertices, annulus.faces) / 2
    stretch = space / area
    return Chart(
        annulus,
        frozen(uv),
        frozen(corner),
        int((area <= 0).sum()),
        frozen(stretch * area.sum() / space.sum()),
    )


def _cotangents(annulus: Annulus) -> Floats:
    """Half cotangents of the angles opposite the edges (1,2), (2,0), (0,1) of each triangle, (m, 3)."""
    return np.asarray(igl.cotmatrix_entries(annulus.vertices, annulus.faces))


def _mean_values(annulus: Annulus) -> Floats:
    """Mean-value weights of each corner towards the next and the previous one, (m, 3, 2) (Floater 2003)."""
    V, F = annulus.vertices, annulus.faces
    a = V[np.roll(F, -1, axis=1)] - V[F]
    b = V[np.roll(F, 1, axis=1)] - V[F]
    la, lb = np.linalg.norm(a, axis=2), np.linalg.norm(b, axis=2)
    dot = (a * b).sum(axis=2) / (la * lb)
    cross = np.linalg.norm(np.cross(a, b), axis=2) / (la * lb)
    tangent = cross / (1 + dot)
    return np.asarray(np.stack([tangent / la, tangent / lb], axis=2))


def _edges(annulus: Annulus, weights: Floats, jump: Floats) -> tuple[Any, ...]:
    """Directed edges as (from, to, weight, jump of u), from cotangents (m, 3) or mean values (m, 3, 2)."""
    F = annulus.faces
    i, j = np.roll(F, -1, axis=1), np.roll(F, 1, axis=1)
    ti, tj = np.roll(jump, -1, axis=1), np.roll(jump, 1, axis=1)
    if weights.ndim == 2:
        pairs = [(i, j, weights, tj - ti), (j, i, weights, ti - tj)]
    else:
        pairs = [(F, i, weights[..., 0], ti - jump), (F, j, weights[..., 1], tj - jump)]
    return tuple(np.concatenate([p[k].ravel() for p in pairs]) for k in range(4))


def _solve(annulus: Annulus, weights: Floats, jump: Floats) -> Floats:
    n = len(annulus.vertices)
    start, end, weight, gain = _edges(annulus, weights, jump)
    off = sparse.csc_array((weight, (start, end)), shape=(n, n))
    laplacian = (sparse.diags_array(np.asarray(off.sum(axis=1))) - off).tocsc()
    turned = np.bincount(start, weights=weight * gain, minlength=n)
    uv = np.zeros((n, 2))
    free_u = np.ones(n, dtype=bool)
    free_u[annulus.rims[0][0]] = False
    uv[free_u, 0] = _inner(laplacian, free_u, turned[free_u])
    uv[annulus.rims[1], 1] = 1.0
    free_v = np.ones(n, dtype=bool)
    free_v[np.concatenate(annulus.rims)] = False
    uv[free_v, 1] = _inner(laplacian, free_v, -(laplacian @ uv[:, 1])[free_v])
    return uv


def _inner(laplacian: sparse.csc_array, free: Bools, right: Any) -> Floats:
    where = np.flatnonzero(free)
    if not len(where):
        return np.zeros(0)
    block = laplacian[where][:, where].tocsc()
    factor = splu(block, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return np.asarray(factor.solve(right))


def _corners(annulus: Annulus, uv: Floats, jump: Floats) -> Floats:
    corner = uv[annulus.faces]
    corner[..., 0] += jump
    return corner


def _area(corner: Floats) -> Floats:
    a, b = corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)
