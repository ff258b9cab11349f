"""SciPy's general solvers on the geodesic's equation: shooting with DOP853, and collocation.

Both take our compiled right-hand side (3.22), so that methods are compared rather than implementations.  They have
neither contact nor friction: a path must stay on the surface, without friction.
"""

from collections.abc import Callable

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import root

from comparison.attempt import Attempt, Outcome
from comparison.problem import Problem
from meshwind.core.cast import Floats
from meshwind.march import Stop, trace
from meshwind.march.geodesic_equation import rates
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV
from meshwind.surface.surface import Surface

NODES = 9
"""Nodes of the collocation's first mesh, which SciPy refines."""
MOST_NODES = 4000
"""Nodes at which the refinement gives up."""
GUESS_POINTS = 201
"""Points on the straight line in (u, v) whose polyline gives a first length."""
SHORTEST = 1e-3
"""Least length that the search may try, over the first one."""
SLACK = 10.0
"""Miss of the end, over the tolerance, up to which it counts as met."""


def shoot(problem: Problem, tolerance: float) -> Attempt:
    """Shooting: `solve_ivp` with DOP853 marches, `scipy.optimize.root` finds angle and length that meet the end.

    tolerance: of the march, relative and absolute in the parameters; the root is found to ten times that.
    """
    surface, count = problem.surface(), 0
    spline = surface.spline
    at, out = np.empty((7, 3)), np.empty(4)

    def rate(_: float, y: Floats) -> Floats:
        nonlocal count
        count += 1
        rates(spline, 0.0, y, at, out)
        return out.copy()

    def march(rates_at_start: Floats, length: float) -> Floats:
        start = np.r_[problem.start, rates_at_start]
        done = solve_ivp(rate, (0.0, length), start, method="DOP853", rtol=tolerance, atol=tolerance)
        return np.asarray(done.y[:, -1])

    outcome, length, marches = _search(problem, march, tolerance)
    return Attempt(outcome, length, count, iterations=marches)


def shoot_traced(problem: Problem, tolerance: float) -> Attempt:
    """Shooting by our own forward solver, of order 8 and compiled whole, with the same search."""
    surface, count = problem.surface(), 0

    def march(rates_at_start: Floats, length: float) -> Floats:
        nonlocal count
        way = trace(surface, problem.start, rates_at_start, length, tolerance=tolerance, press="ignore")
        count += way.evaluations
        uv, rate = way.uv[-1], way.uv_rate[-1]
        if way.stop != Stop.LENGTH:  # beyond a rim: extrapolated, so that the search sees by how much it missed
            uv = uv + rate * (length - way.arc_length[-1])
        return np.r_[uv, rate]

    outcome, length, marches = _search(problem, march, tolerance)
    return Attempt(outcome, length, count, iterations=marches)


def _search(problem: Problem, march: Callable[[Floats, float], Floats], tolerance: float) -> tuple[Outcome, float, int]:
    """Find the angle and length at which `march`, which gives (u, v, du/ds, dv/ds) at its end, meets the problem's end.

    The derivative by the length is the end's own rate; that by the angle is a difference over a step that balances
    the march's error.
    """
    back, guess = _guess(problem)
    end, slack, count = np.array(problem.end), SLACK * tolerance, 0

    def reach(x: Floats) -> Floats:
        nonlocal count
        count += 1
        return march(back @ [np.cos(x[0]), np.sin(x[0])], max(x[1], SHORTEST * guess[1]))

    def miss(x: Floats) -> Floats:
        return np.asarray(reach(x)[:2] - end)

    def slopes(x: Floats) -> Floats:
        step = np.sqrt(tolerance)
        here, aside = reach(x), reach(x + [step, 0.0])
        return np.stack([(aside - here)[:2] / step, here[2:]], axis=1)

    found = root(miss, guess, jac=slopes, tol=tolerance)
    met = bool(np.abs(found.fun).max() <= slack)
    return Outcome.REST if met else Outcome.STALLED, float(found.x[1]), count


def collocate(problem: Problem, tolerance: float) -> Attempt:
    """Collocation of order 4 by `solve_bvp`, from the straight line in (u, v); tolerance: its relative residual."""
    surface = problem.surface()
    t = np.linspace(0.0, 1.0, NODES)
    a, b = np.array(problem.start), np.array(problem.end)
    line = np.concatenate([a[:, None] + (b - a)[:, None] * t, np.repeat((b - a)[:, None], NODES, axis=1)])
    count = 0

    def rate(_: Floats, y: Floats) -> Floats:
        nonlocal count
        count += y.shape[1]
        return np.asarray(np.concatenate([y[2:], _bend(surface, y)]))

    def ends(ya: Floats, yb: Floats) -> Floats:
        return np.concatenate([ya[:2] - a, yb[:2] - b])

    done = solve_bvp(rate, ends, t, line, tol=tolerance, max_nodes=MOST_NODES)
    frames = surface.frames(np.ascontiguousarray(done.y[:2, :1].T))[0]
    speed = float(np.linalg.norm(done.y[2, 0] * frames[SU] + done.y[3, 0] * frames[SV]))  # constant along the path
    return Attempt(Outcome.REST if done.status == 0 else Outcome.STALLED, speed, count, iterations=int(done.niter))


def _guess(problem: Problem) -> tuple[Floats, Floats]:
    """From orthonormal tangents at the start to (u, v) rates, (2, 2); and (angle, length) of the straight line."""
    surface = problem.surface()
    a, b = np.array(problem.start), np.array(problem.end)
    line = a + (b - a) * np.linspace(0.0, 1.0, GUESS_POINTS)[:, None]
    length = np.linalg.norm(np.diff(surface.points(line), axis=0), axis=1).sum()
    J = surface.frames(a[None])[0, [SU, SV]].T
    basis, scale = np.linalg.qr(J)
    along = scale @ (b - a)
    return np.linalg.inv(scale), np.array([np.arctan2(along[1], along[0]), length])


def _bend(surface: Surface, y: Floats) -> Floats:
    """Second derivatives (2, n) of u and v along a geodesic of constant speed (3.21), for rows y (4, n)."""
    frames = surface.frames(np.ascontiguousarray(y[:2].T))
    p, q = y[2][:, None], y[3][:, None]
    turn = p * p * frames[:, SUU] + 2 * p * q * frames[:, SUV] + q * q * frames[:, SVV]
    J = frames[:, [SU, SV]]
    metric, push = J @ np.swapaxes(J, 1, 2), np.einsum("iak,ik->ia", J, turn)
    return np.asarray(-np.linalg.solve(metric, push[:, :, None])[:, :, 0].T)
