"""A taut path that stays on the surface: Newton's method on the springs' energy, on few particles first, then on all.

Most paths never leave the surface, and what they need is little: no trial states, no contacts, no feet, one pass over
the particles per step.  The few particles take the steps from the starting curve; the many start from their answer,
which is off by their spacing squared, and need two.  What is not as simple as that (a step that gains energy, a rim, a
saddle, a pull off the surface in equilibrium) is left to `relax`.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.block_tridiagonal import DEFINITE
from meshwind.path.kernels.state import EVALUATIONS, ITERATIONS, SOLVES, distance
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, frame, position, tangents, unit_normal

FEW = 24
"""Segments of the first solve per turn: a quarter of a radian each."""
MAX_STEPS, MAX_LAST_STEPS = 12, 5
"""Maximum number of steps of the few, and then of the many particles: a path that needs more is not simple."""
LONGEST_MOVE = 0.25
"""No step moves a particle further than this in u or v: beyond it the quadratic model means nothing."""
NEAR = 1e-5
"""Unbalanced force from which one more step of Newton's mostly ends: the balance after it needs no second
derivatives."""
ROUND_OFF = 1e-12
"""Relative increase of the energy that is none."""


class Factors(NamedTuple):
    """Room for the linear system of a path of n particles.

    inverse (n, 3): the pivots' inverses; upper (n, 2, 2): the couplings; x (n, 2): right-hand sides, then the solution.
    """

    inverse: Floats
    upper: Floats
    x: Floats


@njit(cache=True)
def glide(spline, limits, uv, frames, factors, counters):
    """Bring the path uv (n, 2) to equilibrium on the surface, in place; returns its residual and whether it is there.

    frames (n, 6, 3) are left as they are there.
    """
    n = len(uv)
    before = np.inf
    near = False
    residual = np.inf
    for _ in range(limits.iterations):
        counters[ITERATIONS] += 1
        energy, length = evaluate(spline, uv, frames, near, counters)
        if not energy <= before * (1.0 + ROUND_OFF):
            return residual, False
        before, spacing = energy, length / (n - 1)
        if near:
            residual = unbalanced(frames) / spacing
            if residual <= limits.tolerance:
                return residual, presses(frames, limits.pull_off * spacing)
            evaluate(spline, uv, frames, not near, counters)  # a literal would be compiled apart
        counters[SOLVES] += 1
        worst = eliminate(frames, 1.0, factors)
        stable = worst >= 0.0
        if not stable:
            counters[SOLVES] += 1
            worst = eliminate(frames, 0.0, factors)
        residual = worst / spacing
        if residual <= limits.tolerance:
            return residual, stable and presses(frames, limits.pull_off * spacing)
        if not substitute(spline.periodic, uv, factors):
            return residual, False
        near = stable and residual <= NEAR
    return residual, False


@njit(cache=True)
def evaluate(spline, uv, frames, lean, counters):
    """Frames at all particles, without second derivatives if `lean`; returns the springs' energy and the length."""
    energy = length = 0.0
    counters[EVALUATIONS] += len(uv)
    for i in range(len(uv)):
        if lean:
            tangents(spline, uv[i, 0], uv[i, 1], frames[i])
        else:
            frame(spline, uv[i, 0], uv[i, 1], frames[i])
        if i > 0:
            square = 0.0
            for k in range(3):
                square += (frames[i, S, k] - frames[i - 1, S, k]) ** 2
            energy += square
            length += np.sqrt(square)
    return 0.5 * energy, length


@njit(cache=True)
def eliminate(frames, bend, factors):
    """Assemble the Hessian and force of the energy and eliminate forward, all in one pass.

    bend: 1 for Newton's step, 0 for Gauss-Newton's, which (4.16) is with a long time step.  Returns the largest
    unbalanced force in the tangent plane, or -1 where the matrix is not positive definite.
    """
    n, pivots, upper, x = len(frames), factors.inverse, factors.upper, factors.x
    worst = 0.0
    for i in range(1, n - 1):
        a = b = d = fu = fv = guu = guv = gvv = w00 = w01 = w10 = w11 = 0.0
        for k in range(3):
            f = frames[i - 1, S, k] + frames[i + 1, S, k] - 2.0 * frames[i, S, k]
            su, sv = frames[i, SU, k], frames[i, SV, k]
            tu, tv = frames[i - 1, SU, k], frames[i - 1, SV, k]
            fu, fv = fu + f * su, fv + f * sv
            guu, guv, gvv = guu + su * su, guv + su * sv, gvv + sv * sv
            f *= bend
            a -= f * frames[i, SUU, k]
            b -= f * frames[i, SUV, k]
            d -= f * frames[i, SVV, k]
            w00, w01, w10, w11 = w00 - tu * su, w01 - tu * sv, w10 - tv * su, w11 - tv * sv
        det = guu * gvv - guv * guv
        if det > 0.0:
            worst = max(worst, (fu * fu * gvv - 2.0 * fu * fv * guv + fv * fv * guu) / det)
        a, b, d = a + 2.0 * guu, b + 2.0 * guv, d + 2.0 * gvv
        bound = DEFINITE * abs(a * d)
        if i > 1:
            pa, pb, pd = pivots[i - 1, 0], pivots[i - 1, 1], pivots[i - 1, 2]
            m00, m10 = pa * w00 + pb * w10, pb * w00 + pd * w10
            m01, m11 = pa * w01 + pb * w11, pb * w01 + pd * w11
            a -= w00 * m00 + w10 * m10
            b -= w00 * m01 + w10 * m11
            d -= w01 * m01 + w11 * m11
            fu -= m00 * x[i - 1, 0] + m10 * x[i - 1, 1]
            fv -= m01 * x[i - 1, 0] + m11 * x[i - 1, 1]
            upper[i - 1, 0, 0], upper[i - 1, 0, 1] = w00, w01
            upper[i - 1, 1, 0], upper[i - 1, 1, 1] = w10, w11
        x[i, 0], x[i, 1] = fu, fv
        det = a * d - b * b
        if not (a > 0.0 and det > bound):
            return -1.0
        inverse = 1.0 / det
        pivots[i, 0], pivots[i, 1], pivots[i, 2] = d * inverse, -b * inverse, a * inverse
    return np.sqrt(worst)


@njit(cache=True)
def substitute(periodic, uv, factors):
    """Substitute backwards and move the particles; False where one would go too far, or over a rim."""
    n, pivots, upper, x = len(uv), factors.inverse, factors.upper, factors.x
    reach = 0.0
    p = q = 0.0
    for i in range(n - 2, 0, -1):
        u, v = x[i, 0], x[i, 1]
        if i < n - 2:
            u -= upper[i, 0, 0] * p + upper[i, 0, 1] * q
            v -= upper[i, 1, 0] * p + upper[i, 1, 1] * q
        p = pivots[i, 0] * u + pivots[i, 1] * v
        q = pivots[i, 1] * u + pivots[i, 2] * v
        reach = max(reach, abs(p), abs(q))
        uv[i, 0] += p
        uv[i, 1] += q
        if not 0.0 < uv[i, 1] < 1.0 or not (periodic or 0.0 < uv[i, 0] < 1.0):
            return False
    return reach <= LONGEST_MOVE


@njit(cache=True)
def unbalanced(frames):
    """Largest force in the tangent plane."""
    n = len(frames)
    worst = 0.0
    for i in range(1, n - 1):
        fu = fv = guu = guv = gvv = 0.0
        for k in range(3):
            f = frames[i - 1, S, k] + frames[i + 1, S, k] - 2.0 * frames[i, S, k]
            su, sv = frames[i, SU, k], frames[i, SV, k]
            fu, fv = fu + f * su, fv + f * sv
            guu, guv, gvv = guu + su * su, guv + su * sv, gvv + sv * sv
        det = guu * gvv - guv * guv
        if det > 0.0:
            worst = max(worst, (fu * fu * gvv - 2.0 * fu * fv * guv + fv * fv * guu) / det)
    return np.sqrt(worst)


@njit(cache=True)
def presses(frames, slack):
    """Whether no particle is pulled off the surface by more than `slack`."""
    n = len(frames)
    normal = np.empty(3)
    for i in range(1, n - 1):
        unit_normal(frames[i], normal)
        out = 0.0
        for k in range(3):
            out += (frames[i - 1, S, k] + frames[i + 1, S, k] - 2.0 * frames[i, S, k]) * normal[k]
        if out > slack:
            return False
    return True


@njit(cache=True)
def along(curve, t, out):
    """The point (2,) of a polyline (m, 2) at the fractional index t."""
    k = min(int(t), len(curve) - 2)
    for a in range(2):
        out[a] = curve[k, a] + (t - k) * (curve[k + 1, a] - curve[k, a])


@njit(cache=True)
def spread_along(spline, curve, uv, frames, counters):
    """Fill uv (n, 2) with points of a polyline (m, 2) in the plane, evenly spaced by length on the surface."""
    n, last = len(uv), len(curve) - 1.0
    for i in range(n):
        along(curve, last * i / (n - 1), uv[i])
        position(spline, uv[i, 0], uv[i, 1], frames[i, S])
    counters[EVALUATIONS] += n
    X = frames[:, S]
    length = 0.0
    for i in range(1, n):
        length += distance(X, i, i - 1)
    j, s = 0, 0.0
    reach = distance(X, 0, 1)
    for i in range(1, n - 1):
        want = length * i / (n - 1)
        while j < n - 2 and s + reach < want:
            s += reach
            j += 1
            reach = distance(X, j, j + 1)
        share = min((want - s) / max(reach, TINY), 1.0)
        along(curve, last * (j + share) / (n - 1), uv[i])


@njit(cache=True)
def resample(coarse, uv):
    """Fill uv (n, 2) with the cubic through the four nearest of `coarse` (m, 2), m at least 4, evenly by index."""
    m, n = len(coarse), len(uv)
    for i in range(n):
        t = i * (m - 1.0) / (n - 1.0)
        k = min(max(int(t) - 1, 0), m - 4)
        t -= k
        a, b, c, d = (
            -(t - 1.0) * (t - 2.0) * (t - 3.0) / 6.0,
            t * (t - 2.0) * (t - 3.0) / 2.0,
            -t * (t - 1.0) * (t - 3.0) / 2.0,
            t * (t - 1.0) * (t - 2.0) / 6.0,
        )
        for e in range(2):
            uv[i, e] = a * coarse[k, e] + b * coarse[k + 1, e] + c * coarse[k + 2, e] + d * coarse[k + 3, e]
    for e in range(2):
        uv[0, e], uv[n - 1, e] = coarse[0, e], coarse[m - 1, e]
