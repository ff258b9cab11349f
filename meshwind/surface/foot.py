"""Foot points: where on the surface a point is nearest, by Newton from a guess (5.4 to 5.7)."""

import numpy as np
from numba import njit

from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, frame, position

MAX_STEPS = 40
"""Newton settles in 3 to 6 steps from a near guess; more only where the distance is nearly flat."""


@njit(cache=True)
def foot(net, periodic, point, guess, at):
    """Minimise g = |s(u, v) - point|^2 / 2 from `guess` (2,); leave the frame at the foot in `at` (6, 3).

    v stays within [0, 1] (and u, where not periodic).  `guess` becomes the foot.  Returns the number of
    surface evaluations.  A step is Newton's where the Hessian (5.7) is positive definite, Gauss-Newton's
    otherwise, halved until g falls, so that g never grows.
    """
    return approach(net, periodic, point, guess, at, np.empty(3), 0.0)[0]


@njit(cache=True)
def approach(net, periodic, point, guess, at, trial, close):
    """As `foot`, but done with the first full step that is shorter than `close` turns, and without its frame.

    The error after such a step is of the order of close^2.  Returns the number of evaluations and the squared
    distance; trial (3,) is room to work in.
    """
    u, v = guess[0], guess[1]
    frame(net, periodic, u, v, at)
    count = 1
    g0 = 0.0
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
        huu += auu
        huv += auv
        hvv += avv
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
        reach = np.sqrt(auu * du * du + avv * dv * dv)
        scale = np.sqrt(auu + avv)
        if reach <= 1e-13 * scale:
            break
        step = min(1.0, 0.25 / max(abs(du), abs(dv), 1e-300))
        better = False
        for _ in range(30):
            nu_, nv_ = u + step * du, min(max(v + step * dv, 0.0), 1.0)
            if not periodic:
                nu_ = min(max(nu_, 0.0), 1.0)
            position(net, periodic, nu_, nv_, trial)
            count += 1
            g1 = 0.0
            for k in range(3):
                g1 += (trial[k] - point[k]) ** 2
            if g1 < g0:
                better = True
                break
            step *= 0.5
            if step * reach <= 1e-13 * scale:
                break
        if not better:
            break
        free = nu_ == u + du and nv_ == v + dv
        u, v, g0 = nu_, nv_, g1
        if free and reach <= close * scale:
            break
        frame(net, periodic, u, v, at)
        count += 1
    guess[0], guess[1] = u, v
    return count, g0


@njit(nogil=True, cache=True)
def feet(first, last, net, periodic, points, guesses, frames):
    """Move guesses (n, 2) first to last to the feet of their points (n, 3); leave the frames (n, 6, 3) there."""
    for i in range(first, last):
        foot(net, periodic, points[i], guesses[i], frames[i])
