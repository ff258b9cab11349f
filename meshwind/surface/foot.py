"""Foot points: where on the surface a point is nearest, by Newton's method from a guess (5.4 to 5.7)."""

from typing import NamedTuple

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import copy_table
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, basis, bend, frame, locate, position, slope, spans_of

MAX_STEPS = 40
"""Maximum number of Newton steps; 3 to 6 suffice from a near guess, more only where the distance is nearly flat."""
MAX_HALVINGS = 30
"""Maximum number of halvings of a step: it is then a billionth of what it was."""
LONGEST = 0.25
"""Longest step in u or in v: further off the expansion of the distance means nothing."""
CONVEX = 1e-6
"""Least determinant of the Hessian over the metric's at which the Hessian counts as positive definite."""
SINGULAR = 1e-14
"""Least determinant over the product of the diagonal: below it the two directions are parallel."""
TINY = 1e-300
"""Keeps a quotient finite where the divisor may vanish."""
CLOSE = 1e-8
"""After a step of this length over that of s_u and s_v what is left is of the order of its square."""
ROUND_OFF = 1e-13
"""A step of this length over that of s_u and s_v is round-off."""


class Gradient(NamedTuple):
    """Derivatives of a function of (u, v)."""

    u: float
    v: float


class Symmetric(NamedTuple):
    """A symmetric 2 x 2 matrix in (u, v)."""

    uu: float
    uv: float
    vv: float


class Expansion(NamedTuple):
    """The distance function g = |s(u, v) - p|^2 / 2 about (u, v) to second order.

    square is 2 g; gradient that of g; its Hessian (5.7) is metric + curvature: the products of s_u and s_v, and the
    products of s - p with the second derivatives.
    """

    square: float
    gradient: Gradient
    metric: Symmetric
    curvature: Symmetric


@njit(forceinline=True, cache=True)
def newton_step(periodic, u, v, g):
    """Step (du, dv) from (u, v) towards the minimum of the expansion g; none across an end.

    Newton's step where the Hessian is positive definite, the Gauss-Newton step otherwise.
    """
    a = g.metric
    huu, huv, hvv = g.curvature.uu + a.uu, g.curvature.uv + a.uv, g.curvature.vv + a.vv
    if huu <= 0.0 or huu * hvv - huv * huv <= CONVEX * a.uu * a.vv:
        huu, huv, hvv = a.uu, a.uv, a.vv
    gu, gv = g.gradient.u, g.gradient.v
    fix_v = (v <= 0.0 and gv > 0.0) or (v >= 1.0 and gv < 0.0)
    fix_u = not periodic and ((u <= 0.0 and gu > 0.0) or (u >= 1.0 and gu < 0.0))
    du = dv = 0.0
    if fix_v and not fix_u:
        du = -gu / huu
    elif fix_u and not fix_v:
        dv = -gv / hvv
    elif not fix_u:
        det = huu * hvv - huv * huv
        if det <= SINGULAR * huu * hvv:
            det = SINGULAR * huu * hvv + TINY
        du = (-gu * hvv + gv * huv) / det
        dv = (-gv * huu + gu * huv) / det
    return du, dv


@njit(forceinline=True, cache=True)
def expand(at, point):
    """The expansion of the distance to a point about where the frame `at` (6, 3) stands."""
    square = gu = gv = 0.0
    huu = huv = hvv = auu = auv = avv = 0.0
    for k in range(3):
        r = at[S, k] - point[k]
        square += r * r
        gu += r * at[SU, k]
        gv += r * at[SV, k]
        auu += at[SU, k] * at[SU, k]
        auv += at[SU, k] * at[SV, k]
        avv += at[SV, k] * at[SV, k]
        huu += r * at[SUU, k]
        huv += r * at[SUV, k]
        hvv += r * at[SVV, k]
    return Expansion(square, Gradient(gu, gv), Symmetric(auu, auv, avv), Symmetric(huu, huv, hvv))


@njit(cache=True)
def foot(spline, point, guess, at):
    """Minimise g = |s(u, v) - point|^2 / 2 from `guess` (2,); leave the frame at the foot in `at` (6, 3).

    v stays within [0, 1] (and u, where the spline is not periodic).  `guess` becomes the foot.  Returns the number of
    surface evaluations.  A step is Newton's where the Hessian (5.7) is positive definite, Gauss-Newton's
    otherwise, halved until g falls, so that g never grows.
    """
    trial = np.empty((6, 3))
    u, v = guess[0], guess[1]
    frame(spline, u, v, at)
    count = 1
    for _ in range(MAX_STEPS):
        g = expand(at, point)
        du, dv = newton_step(spline.periodic, u, v, g)
        reach = np.sqrt(g.metric.uu * du * du + g.metric.vv * dv * dv)
        scale = np.sqrt(g.metric.uu + g.metric.vv)
        if reach <= ROUND_OFF * scale:
            break
        step = min(1.0, LONGEST / max(abs(du), abs(dv), TINY))
        whole = step == 1.0
        better = False
        for _ in range(MAX_HALVINGS):
            nu_, nv_ = u + step * du, min(max(v + step * dv, 0.0), 1.0)
            if not spline.periodic:
                nu_ = min(max(nu_, 0.0), 1.0)
            if whole:  # it mostly counts, and then its frame is wanted
                frame(spline, nu_, nv_, trial)
            else:
                position(spline, nu_, nv_, trial[S])
            count += 1
            if squared_distance(trial, point) < g.square:
                better = True
                break
            step *= 0.5
            whole = False
            if step * reach <= ROUND_OFF * scale:
                break
        if not better:
            break
        u, v = nu_, nv_
        if whole:
            copy_table(trial, at)
            if reach <= CLOSE * scale:
                break
        else:
            frame(spline, u, v, at)
            count += 1
    guess[0], guess[1] = u, v
    return count


@njit(forceinline=True, cache=True)
def squared_distance(at, point):
    """Squared distance of a point to where the frame `at` (6, 3) stands."""
    total = 0.0
    for k in range(3):
        total += (at[S, k] - point[k]) ** 2
    return total


@njit(forceinline=True, cache=True)
def _expand_at(net, i, x, j, y, point):
    """The expansion of the distance to a point at local coordinates (x, y) of span (i, j), with no frame on the way."""
    nu, nv = spans_of(net)
    b, d, e = basis(x), slope(x, nu), bend(x, nu)
    c, f, g = basis(y), slope(y, nv), bend(y, nv)
    square = gu = gv = huu = huv = hvv = auu = auv = avv = 0.0
    for k in range(3):
        s = su = sv = suu = suv = svv = 0.0
        for p in range(4):
            n0, n1, n2, n3 = net[i + p, j, k], net[i + p, j + 1, k], net[i + p, j + 2, k], net[i + p, j + 3, k]
            q = c[0] * n0 + c[1] * n1 + c[2] * n2 + c[3] * n3
            qv = f[0] * n0 + f[1] * n1 + f[2] * n2 + f[3] * n3
            s += b[p] * q
            su += d[p] * q
            suu += e[p] * q
            sv += b[p] * qv
            suv += d[p] * qv
            svv += b[p] * (g[0] * n0 + g[1] * n1 + g[2] * n2 + g[3] * n3)
        r = s - point[k]
        square, gu, gv = square + r * r, gu + r * su, gv + r * sv
        auu, auv, avv = auu + su * su, auv + su * sv, avv + sv * sv
        huu, huv, hvv = huu + r * suu, huv + r * suv, hvv + r * svv
    return Expansion(square, Gradient(gu, gv), Symmetric(auu, auv, avv), Symmetric(huu, huv, hvv))


@njit(forceinline=True, cache=True)
def _squared_distance_at(net, i, x, j, y, point):
    """Squared distance of a point to the surface at local coordinates (x, y) of span (i, j)."""
    b, c = basis(x), basis(y)
    total = 0.0
    for k in range(3):
        s = -point[k]
        for p in range(4):
            n0, n1, n2, n3 = net[i + p, j, k], net[i + p, j + 1, k], net[i + p, j + 2, k], net[i + p, j + 3, k]
            s += b[p] * (c[0] * n0 + c[1] * n1 + c[2] * n2 + c[3] * n3)
        total += s * s
    return total


@njit(nogil=True, cache=True)
def near_feet(first, last, net, points, close, guesses, distances):
    """Move guesses (n, 2) first to last to the feet of their points (n, 3) on a surface periodic in u.

    As `foot`, but done with the first whole step below `close` of the plane, and in half the time: what such a
    step leaves is of the order of close^2.  Writes the distances (n,).
    """
    spans_u, spans_v = spans_of(net)
    for n in range(first, last):
        u, v, square = guesses[n, 0], guesses[n, 1], 0.0
        for _ in range(MAX_STEPS):
            i, x = locate(u, spans_u, True)
            j, y = locate(v, spans_v, False)
            g = _expand_at(net, i, x, j, y, points[n])
            square = g.square
            du, dv = newton_step(True, u, v, g)
            reach, scale = g.metric.uu * du * du + g.metric.vv * dv * dv, g.metric.uu + g.metric.vv
            if reach <= ROUND_OFF**2 * scale:
                break
            step, widest, trial = 1.0, max(abs(du), abs(dv)), np.inf
            if widest > LONGEST:
                step = LONGEST / widest
            u1 = v1 = 0.0
            for _ in range(MAX_HALVINGS):
                u1, v1 = u + step * du, min(max(v + step * dv, 0.0), 1.0)
                i, x = locate(u1, spans_u, True)
                j, y = locate(v1, spans_v, False)
                trial = _squared_distance_at(net, i, x, j, y, points[n])
                if trial < square or step * step * reach <= (2.0 * ROUND_OFF) ** 2 * scale:
                    break
                step *= 0.5
            if not trial < square:
                break
            whole = u1 == u + du and v1 == v + dv
            u, v, square = u1, v1, trial
            if whole and reach <= close * close * scale:
                break
        guesses[n, 0], guesses[n, 1], distances[n] = u, v, np.sqrt(square)


@njit(nogil=True, cache=True)
def feet(first, last, spline, points, guesses, frames):
    """Move guesses (n, 2) first to last to the feet of their points (n, 3); leave the frames (n, 6, 3) there."""
    for i in range(first, last):
        foot(spline, points[i], guesses[i], frames[i])
