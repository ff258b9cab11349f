"""The direction of a family's fibres, spread from the fibres over the whole surface.

Between the fibres it is linear on rows of constant v, and a row that no fibre passes takes the nearest that one does.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.lists import spread
from meshwind.core.vectors import unit
from meshwind.path.paths import Paths, converged_or_all
from meshwind.path.winding_angle import axes, headings
from meshwind.path.winding_angle import winding_angle as angle_of
from meshwind.surface.grid import MOST, PER_SPAN


def fibres_of(paths: Paths, family: int) -> Paths:
    """The paths of a family that converged, or all of the family where none did."""
    return paths.subset(converged_or_all(paths.status, paths.family == family))


def winding_angle(paths: Paths, nu: int, nv: int) -> Floats:
    """Winding angle (nu, nv) of the fibres of family +1, in radians, as `meshwind.path.winding_angle` defines it.

    On the points of `grid`; 0 where there is no fibre of the family.
    """
    mine = fibres_of(paths, 1)
    u = np.arange(nu) / nu if paths.surface.periodic else np.linspace(0.0, 1.0, nu)
    at = _passages(mine, nv)
    first, last = _ends(angle_of(mine))
    angle = first[at.segment] + at.share * (last[at.segment] - first[at.segment])
    return _spread(at, angle, u, nv, paths.surface.periodic)


def directions(paths: Paths, uv: Floats) -> tuple[Floats, Floats]:
    """Unit tangents (k, 3) of the fibres at uv (k, 2) and their angle (k,) in radians.

    The angle is from the direction along the part, square to the level line of v, and positive towards s_u; between the
    rows it is linear, too.
    """
    surface = paths.surface
    nu, nv = (min(PER_SPAN * spans, MOST) + 1 for spans in surface.spans)
    at, u = _passages(paths, nv), np.linspace(0.0, 1.0, nu)
    first, last = (part.reshape(-1, 2) for part in _ends(_headings(paths)))
    share = at.share[:, None]
    heading = (1.0 - share) * first[at.segment] + share * last[at.segment]
    field = np.stack([_spread(at, heading[:, axis], u, nv, surface.periodic) for axis in (0, 1)], axis=2)
    x, y = uv[:, 0], np.clip(uv[:, 1], 0.0, 1.0) * (nv - 1)
    x = (x - np.floor(x) if surface.periodic else np.clip(x, 0.0, 1.0)) * (nu - 1)
    i, j = np.minimum(x.astype(np.int64), nu - 2), np.minimum(y.astype(np.int64), nv - 2)
    f, g = (x - i)[:, None], (y - j)[:, None]
    below = (1.0 - f) * field[i, j] + f * field[i + 1, j]
    above = (1.0 - f) * field[i, j + 1] + f * field[i + 1, j + 1]
    mixed = unit((1.0 - g) * below + g * above)
    mixed = np.where((mixed == 0.0).all(axis=1)[:, None], [1.0, 0.0], mixed)
    along, around, _ = axes(surface, uv)
    return mixed[:, :1] * along + mixed[:, 1:] * around, np.arctan2(mixed[:, 1], mixed[:, 0])


@dataclass(frozen=True)
class _Passages:
    """Where fibres pass rows of constant v: the row (m,) in order, u there (m,), and where on the fibre that is.

    segment (m,) numbers the segments of all paths, path by path, and share (m,) is how far along it the row lies.
    """

    row: Ints
    u: Floats
    segment: Ints
    share: Floats


def _passages(paths: Paths, nv: int) -> _Passages:
    """Where fibres pass the rows v = j / (nv - 1)."""
    (u0, u1), (y0, y1) = _ends(paths.uv[..., 0]), _ends(paths.uv[..., 1] * (nv - 1))
    low = np.maximum(np.ceil(np.minimum(y0, y1)), 0.0).astype(np.int64)
    high = np.minimum(np.floor(np.maximum(y0, y1)), nv - 1.0).astype(np.int64)
    many = np.maximum(high - low + 1, 0)
    k = np.repeat(np.arange(len(many)), many)
    row = spread(low, many)
    rise = y1[k] - y0[k]
    share = np.divide(row - y0[k], rise, out=np.zeros(len(k)), where=rise != 0.0)
    order = np.argsort(row, kind="stable")
    k, share = k[order], share[order]
    return _Passages(row[order], u0[k] + share * (u1[k] - u0[k]), k, share)


def _ends(values: Floats) -> tuple[Floats, Floats]:
    """What is known at the particles (p, n, ...), at the first and at the last end of each segment (p (n - 1), ...)."""
    first, last = values[:, :-1], values[:, 1:]
    return first.reshape(-1, *values.shape[2:]), last.reshape(-1, *values.shape[2:])


def _spread(at: _Passages, values: Floats, u: Floats, nv: int, closed: bool) -> Floats:
    """Values (m,) at the passages, spread over all u (nu,) and rows (nu, nv); 0 where there is no passage at all.

    Around a closed part u has the period 1; on an open one the outermost fibres' values go on to its edges.
    """
    field = np.zeros((len(u), nv))
    passed = np.unique(at.row)
    if not len(passed):
        return field
    first = np.searchsorted(at.row, np.append(passed, nv))
    for k, j in enumerate(passed):
        here = slice(first[k], first[k + 1])
        order = np.argsort(at.u[here], kind="stable")
        field[:, j] = np.interp(u, at.u[here][order], values[here][order], period=1.0 if closed else None)
    nearest = passed[np.abs(np.arange(nv)[:, None] - passed).argmin(axis=1)]
    return np.ascontiguousarray(field[:, nearest])


def _headings(paths: Paths) -> Floats:
    """Cosine and sine (p, n, 2) of the angle of each path from the direction along the part, at particle or foot."""
    return unit(np.stack(headings(paths), axis=1)).reshape(paths.uv.shape)
