"""Foot points: where on the surface a point is nearest, by Newton from a guess (5.4 to 5.7)."""

import numpy as np
from numba import njit

from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, basis, bend, frame, locate, position, slope

MAX_STEPS = 40
"""Newton settles in 3 to 6 steps from a near guess; more only where the distance is nearly flat."""
CLOSE = 1e-8
"""After a step of this length over that of s_u and s_v what is left is of the order of its square."""


@njit(inline="always", cache=True)
def newton_step(periodic, u, v, gu, gv, auu, auv, avv, huu, huv, hvv):
    """Step (du, dv) from the gradient of g, the metric a and the part of the Hessian (5.7) that curvature adds.

    Newton's where the Hessian is positive definite, Gauss-Newton's otherwise; none across an end.
    """
    huu, huv, hvv = huu + auu, huv + auv, hvv + avv
    if huu <= 0.0 or huu * hvv - huv * huv <= 1e-6 * auu * avv:
        huu, huv, hvv = auu, auv, avv
    fix_v = (v <= 0.0 and gv > 0.0) or (v >= 1.0 and gv < 0.0)
    fix_u = not periodic and ((u <= 0.0 and gu > 0.0) or (u >= 1.0 and gu < 0.0))
    du = dv = 0.0
    if fix_v and not fix_u:
        du = -gu / huu
    elif fix_u and not fix_v:
        dv = -gv / hvv
    elif not fix_u:
        det = huu * hvv - huv * huv
        if det <= 1e-14 * huu * hvv:
            det = 1e-14 * huu * hvv + 1e-300
        du = (-gu * hvv + gv * huv) / det
        dv = (-gv * huu + gu * huv) / det
    return du, dv


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
        g0 = gu = gv = 0.0
        huu = huv = hvv = auu = auv = avv = 0.0
        for k in range(3):
            r = at[S, k] - point[k]
            g0 += r * r
            gu += r * at[SU, k]
            gv += r * at[SV, k]
            auu += at[SU, k] * at[SU, k]
            auv += at[SU, k] * at[SV, k]
            avv += at[SV, k] * at[SV, k]
            huu += r * at[SUU, k]
            huv += r * at[SUV, k]
            hvv += r * at[SVV, k]
        du, dv = newton_step(spline.periodic, u, v, gu, gv, auu, auv, avv, huu, huv, hvv)
        reach = np.sqrt(auu * du * du + avv * dv * dv)
        scale = np.sqrt(auu + avv)
        if reach <= 1e-13 * scale:
            break
        step = min(1.0, 0.25 / max(abs(du), abs(dv), 1e-300))
        whole = step == 1.0
        better = False
        for _ in range(30):
            nu_, nv_ = u + step * du, min(max(v + step * dv, 0.0), 1.0)
            if not spline.periodic:
                nu_ = min(max(nu_, 0.0), 1.0)
            if whole:  # it mostly counts, and then its frame is wanted
                frame(spline, nu_, nv_, trial)
            else:
                position(spline, nu_, nv_, trial[S])
            count += 1
            g1 = 0.0
            for k in range(3):
                g1 += (trial[S, k] - point[k]) ** 2
            if g1 < g0:
                better = True
                break
            step *= 0.5
            whole = False
            if step * reach <= 1e-13 * scale:
                break
        if not better:
            break
        u, v = nu_, nv_
        if whole:
            for row in range(6):
                for k in range(3):
                    at[row, k] = trial[row, k]
            if reach <= CLOSE * scale:
                break
        else:
            frame(spline, u, v, at)
            count += 1
    guess[0], guess[1] = u, v
    return count


@njit(inline="always", cache=True)
def _moments(net, i, x, j, y, point):
    """Sums that a Newton step needs, at local coordinates (x, y) of span (i, j), without a frame on the way."""
    nu, nv = net.shape[0] - 3, net.shape[1] - 3
    b, d, e = basis(x), slope(x, nu), bend(x, nu)
    c, f, g = basis(y), slope(y, nv), bend(y, nv)
    g0 = gu = gv = huu = huv = hvv = auu = auv = avv = 0.0
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
        g0, gu, gv = g0 + r * r, gu + r * su, gv + r * sv
        auu, auv, avv = auu + su * su, auv + su * sv, avv + sv * sv
        huu, huv, hvv = huu + r * suu, huv + r * suv, hvv + r * svv
    return g0, gu, gv, auu, auv, avv, huu, huv, hvv


@njit(inline="always", cache=True)
def _square(net, i, x, j, y, point):
    """Squared distance to a point."""
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
    spans_u, spans_v = net.shape[0] - 3, net.shape[1] - 3
    for n in range(first, last):
        u, v, square = guesses[n, 0], guesses[n, 1], 0.0
        for _ in range(MAX_STEPS):
            i, x = locate(u, spans_u, True)
            j, y = locate(v, spans_v, False)
            square, gu, gv, auu, auv, avv, huu, huv, hvv = _moments(net, i, x, j, y, points[n])
            du, dv = newton_step(True, u, v, gu, gv, auu, auv, avv, huu, huv, hvv)
            reach, scale = auu * du * du + avv * dv * dv, auu + avv
            if reach <= 1e-26 * scale:
                break
            step, widest, trial = 1.0, max(abs(du), abs(dv)), np.inf
            if widest > 0.25:
                step = 0.25 / widest
            u1 = v1 = 0.0
            for _ in range(30):
                u1, v1 = u + step * du, min(max(v + step * dv, 0.0), 1.0)
                i, x = locate(u1, spans_u, True)
                j, y = locate(v1, spans_v, False)
                trial = _square(net, i, x, j, y, points[n])
                if trial < square or step * step * reach <= 4e-26 * scale:
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
