"""The winding angle of family +1, spread from its fibres over the surface."""

import numpy as np
from numba import njit

from meshwind.core.cast import Bools, Floats
from meshwind.path.paths import Paths, Status


def winding_angle(paths: Paths, nu: int, nv: int) -> Floats:
    """Angle (nu, nv) between the fibres of family +1 and the meridian s_v, in radians, 0 along v, pi/2 hoop.

    On rows of constant v, linear in u from fibre to fibre; a row that no fibre passes takes the nearest that
    one does, and 0 stands where there is no fibre at all.
    """
    u = np.arange(nu) / nu if paths.surface.periodic else np.linspace(0.0, 1.0, nu)
    mine = _drawn_from(paths)
    uv = paths.uv[mine]
    at, angle, passed = _on_rows(uv, _along(paths, uv), nv)
    out = np.zeros((nu, nv))
    rows = np.flatnonzero(passed.any(axis=1))
    if not len(rows):
        return out
    for row in rows:
        here = passed[row]
        out[:, row] = np.interp(u, at[row, here], angle[row, here], period=1.0)
    nearest = rows[np.abs(np.arange(nv)[:, None] - rows).argmin(axis=1)]
    return np.ascontiguousarray(out[:, nearest])


def _drawn_from(paths: Paths) -> Bools:
    """The converged paths of family +1, or all of it where none converged."""
    plus = paths.family > 0
    taut = plus & (paths.status == Status.CONVERGED)
    return np.asarray(taut if taut.any() else plus)


def _along(paths: Paths, uv: Floats) -> Floats:
    """Angle between each fibre's direction and the meridian (p, n), at the particle or its foot."""
    frames = paths.surface.frames(uv.reshape(-1, 2))
    step = np.gradient(uv, axis=1).reshape(-1, 2)
    meridian = frames[:, 2]
    tangent = frames[:, 1] * step[:, :1] + meridian * step[:, 1:]
    across = np.linalg.norm(np.cross(tangent, meridian), axis=1)
    return np.asarray(np.arctan2(across, np.abs((tangent * meridian).sum(axis=1))).reshape(uv.shape[:2]))


@njit(cache=True)
def _on_rows(uv: Floats, angle: Floats, nv: int) -> tuple[Floats, Floats, Bools]:
    """Where each path last passes each row v = j / (nv - 1): its u, angle, and whether it does (nv, p)."""
    p, n = angle.shape
    at, there = np.zeros((nv, p)), np.zeros((nv, p))
    passed = np.zeros((nv, p), np.bool_)
    for i in range(p):
        for k in range(n - 1):
            y0, y1 = uv[i, k, 1] * (nv - 1), uv[i, k + 1, 1] * (nv - 1)
            low, high = max(int(np.ceil(min(y0, y1))), 0), min(int(np.floor(max(y0, y1))), nv - 1)
            for j in range(low, high + 1):
                f = (j - y0) / (y1 - y0) if y1 != y0 else 0.0
                at[j, i] = uv[i, k, 0] + f * (uv[i, k + 1, 0] - uv[i, k, 0])
                there[j, i] = angle[i, k] + f * (angle[i, k + 1] - angle[i, k])
                passed[j, i] = True
    return at, there, passed
