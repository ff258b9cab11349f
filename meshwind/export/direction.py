"""The direction of a family's fibres, spread from the fibres over the whole surface."""

from dataclasses import fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.path.paths import Paths, Status
from meshwind.surface.surface import Surface

_PER_SPAN, _MOST = 4, 200


def subset(paths: Paths, chosen: Bools) -> Paths:
    """Those paths alone, chosen (p,)."""
    arrays = {f.name: getattr(paths, f.name) for f in fields(paths)}
    kept: dict[str, Any] = {n: frozen(value[chosen]) for n, value in arrays.items() if isinstance(value, np.ndarray)}
    return replace(paths, **kept)


def laid(paths: Paths, family: int) -> Paths:
    """The paths of a family that came to rest, or all of it where none did."""
    mine = paths.family == family
    taut = mine & (paths.status == Status.CONVERGED)
    return subset(paths, taut if taut.any() else mine)


def axes(surface: Surface, uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Unit vectors (k, 3) at uv (k, 2): along the meridian s_v, across it towards s_u, and the outward normal."""
    frames = surface.frames(uv)
    along, normal = _unit(frames[:, 2]), _unit(np.cross(frames[:, 1], frames[:, 2]))
    return along, np.cross(along, normal), normal


def directions(paths: Paths, uv: Floats) -> tuple[Floats, Floats]:
    """Unit tangents (k, 3) of the fibres at uv (k, 2) and their angle (k,) in radians.

    The angle is from the meridian s_v, 0 along the part, positive towards s_u.  Linear between the fibres on rows of
    constant v, and between the rows; a row that no fibre passes takes the nearest that one does.
    """
    surface = paths.surface
    nu, nv = (min(_PER_SPAN * spans, _MOST) + 1 for spans in surface.spans)
    field = _on_rows(paths, nu, nv)
    x, y = uv[:, 0], np.clip(uv[:, 1], 0.0, 1.0) * (nv - 1)
    x = (x - np.floor(x) if surface.periodic else np.clip(x, 0.0, 1.0)) * (nu - 1)
    i, j = np.minimum(x.astype(np.int64), nu - 2), np.minimum(y.astype(np.int64), nv - 2)
    f, g = (x - i)[:, None], (y - j)[:, None]
    below = (1.0 - f) * field[i, j] + f * field[i + 1, j]
    above = (1.0 - f) * field[i, j + 1] + f * field[i + 1, j + 1]
    mixed = _unit((1.0 - g) * below + g * above)
    mixed = np.where((mixed == 0.0).all(axis=1)[:, None], [1.0, 0.0], mixed)
    along, across, _ = axes(surface, uv)
    return mixed[:, :1] * along + mixed[:, 1:] * across, np.arctan2(mixed[:, 1], mixed[:, 0])


def _on_rows(paths: Paths, nu: int, nv: int) -> Floats:
    """Cosine and sine (nu, nv, 2) of the angle at u = i / (nu - 1), v = j / (nv - 1)."""
    row, at, heading = _passages(paths, nv)
    passed = np.unique(row)
    field = np.zeros((nu, nv, 2))
    if not len(passed):
        return field
    period = 1.0 if paths.surface.periodic else None
    u = np.linspace(0.0, 1.0, nu)
    first = np.searchsorted(row, np.append(passed, nv))
    for k, j in enumerate(passed):
        here = slice(first[k], first[k + 1])
        order = np.argsort(at[here], kind="stable")
        for axis in (0, 1):
            field[:, j, axis] = np.interp(u, at[here][order], heading[here][order, axis], period=period)
    nearest = passed[np.abs(np.arange(nv)[:, None] - passed).argmin(axis=1)]
    return np.ascontiguousarray(field[:, nearest])


def _passages(paths: Paths, nv: int) -> tuple[Ints, Floats, Floats]:
    """Where fibres pass the rows v = j / (nv - 1): the row (m,) in order, u (m,), cosine and sine (m, 2)."""
    heading = _headings(paths)
    u, y = paths.uv[..., 0], paths.uv[..., 1] * (nv - 1)
    u0, u1, y0, y1 = u[:, :-1].ravel(), u[:, 1:].ravel(), y[:, :-1].ravel(), y[:, 1:].ravel()
    h0, h1 = heading[:, :-1].reshape(-1, 2), heading[:, 1:].reshape(-1, 2)
    low = np.maximum(np.ceil(np.minimum(y0, y1)), 0.0).astype(np.int64)
    high = np.minimum(np.floor(np.maximum(y0, y1)), nv - 1.0).astype(np.int64)
    many = np.maximum(high - low + 1, 0)
    k = np.repeat(np.arange(len(many)), many)
    row = low[k] + np.arange(len(k)) - np.repeat(np.cumsum(many) - many, many)
    rise = y1[k] - y0[k]
    share = np.divide(row - y0[k], rise, out=np.zeros(len(k)), where=rise != 0.0)
    order = np.argsort(row, kind="stable")
    at = u0[k] + share * (u1[k] - u0[k])
    between = (1.0 - share[:, None]) * h0[k] + share[:, None] * h1[k]
    return row[order], at[order], between[order]


def _headings(paths: Paths) -> Floats:
    """Cosine and sine (p, n, 2) of the angle of each path from the meridian, at the particle or its foot."""
    flat = np.ascontiguousarray(paths.uv.reshape(-1, 2))
    frames = paths.surface.frames(flat)
    step = np.gradient(paths.uv, axis=1).reshape(-1, 2)
    tangent = frames[:, 1] * step[:, :1] + frames[:, 2] * step[:, 1:]
    along, across, _ = axes(paths.surface, flat)
    both = np.stack([(tangent * along).sum(axis=1), (tangent * across).sum(axis=1)], axis=1)
    return _unit(both).reshape(paths.uv.shape)


def _unit(vectors: NDArray[np.float64]) -> Floats:
    size = np.linalg.norm(vectors, axis=1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)
