"""The Jacobian J_C of (6.7), of the surface by the control points, as sparse rows of 4 x 4 control points each."""

from typing import TypeAlias

import numpy as np
from scipy import sparse

from meshwind.core.cast import Floats, Ints
from meshwind.surface.evaluate import DEGREE, basis, bend, slope
from meshwind.surface.surface import Surface

Order: TypeAlias = tuple[int, int]
"""Orders of the derivatives by u and by v."""


def weights(surface: Surface, uv: Floats, orders: tuple[Order, ...]) -> tuple[Ints, list[Floats]]:
    """Control points (k, 16) that the surface at uv (k, 2) depends on, and their weights (k, 16) per derivative."""
    nu, nv = surface.control_points.shape[:2]
    spans = np.array(surface.spans)
    local = (uv - [1.0, 0.0] * np.floor(uv) * surface.periodic) * spans
    first = np.clip(np.floor(local).astype(np.int64), 0, spans - 1)
    in_u, in_v = (_derivatives(local[:, a] - first[:, a], int(spans[a])) for a in range(2))
    offset = np.arange(DEGREE + 1)
    rows, columns = (first[:, :1] + offset) % nu, first[:, 1:] + offset
    which = (rows[:, :, None] * nv + columns[:, None, :]).reshape(len(uv), (DEGREE + 1) ** 2)
    parts = [(in_u[a][:, :, None] * in_v[b][:, None, :]).reshape(len(uv), (DEGREE + 1) ** 2) for a, b in orders]
    return which, parts


def _derivatives(x: Floats, spans: int) -> list[Floats]:
    """The four weights (k, 4) at local coordinates x, and their first and second derivatives."""
    return [np.stack(values, axis=1) for values in (basis(x), slope(x, spans), bend(x, spans))]


def along(which: Ints, part: Floats, direction: Floats, points: int) -> sparse.csr_array:
    """Rows (k, 3 points) of the move along `direction` (k, 3): d^T J_C of (6.9); coordinates vary fastest."""
    value = part[:, :, None] * direction[:, None, :]
    column = 3 * which[:, :, None] + np.arange(3)
    row = np.repeat(np.arange(len(which)), value[0].size if len(value) else 0)
    return sparse.csr_array((value.ravel(), (row, column.ravel())), shape=(len(which), 3 * points))


def bending(surface: Surface) -> sparse.csr_array:
    """Bending energy (m, m) of a change of the net: its second differences, squared and summed, in 1 / length^4."""
    nu, nv = surface.control_points.shape[:2]
    pitch_u, pitch_v = pitches(surface)
    once = sparse.eye_array(nu, k=1) - sparse.eye_array(nu) + sparse.eye_array(nu, k=1 - nu)
    across = once if surface.periodic else once.tocsr()[: nu - 1]
    second = (once @ once).tocsr()[slice(None) if surface.periodic else slice(nu - 2)]
    keep_u, keep_v = sparse.eye_array(nu), sparse.eye_array(nv)
    first_v = sparse.diags_array([-1.0, 1.0], offsets=[0, 1], shape=(nv - 1, nv))
    second_v = sparse.diags_array([1.0, -2.0, 1.0], offsets=[0, 1, 2], shape=(nv - 2, nv))
    terms = (
        (1.0, sparse.kron(second, keep_v) / pitch_u**2),
        (2.0, sparse.kron(across, first_v) / (pitch_u * pitch_v)),
        (1.0, sparse.kron(keep_u, second_v) / pitch_v**2),
    )
    return sparse.csr_array(sum(factor * (term.T @ term) for factor, term in terms))


def pitches(surface: Surface) -> tuple[float, float]:
    """Mean lengths of a span in u and in v, in the surface's units."""
    side = (np.arange(32) + 0.5) / 32
    frames = surface.frames(np.stack(np.meshgrid(side, side), axis=-1).reshape(-1, 2))
    speed = np.linalg.norm(frames[:, 1:3], axis=2).mean(axis=0)
    return float(speed[0]) / surface.spans[0], float(speed[1]) / surface.spans[1]


def lattice(surface: Surface, per_span: int) -> Floats:
    """Parameters (k, 2) of samples, around for each of the stations along."""
    around, along_ = (per_span * spans for spans in surface.spans)
    v, u = np.meshgrid(np.linspace(0.0, 1.0, along_ + 1), np.arange(around) / around, indexing="ij")
    return np.stack([u.ravel(), v.ravel()], axis=1)
