"""Run any of the literature's schemes on one path."""

import math

import numpy as np
from numpy.typing import ArrayLike

from meshwind.cast import Bools, Floats, Ints, floats, frozen
from meshwind.errors import BadInputError
from meshwind.methods import march
from meshwind.methods.chain import Physics
from meshwind.methods.run import Ending, History, Method, Run
from meshwind.path.paths import Counters
from meshwind.surface.surface import Surface

SCHEMES = {
    Method.EXPLICIT_EULER: march.EXPLICIT,
    Method.SYMPLECTIC_EULER: march.SYMPLECTIC,
    Method.RUNGE_KUTTA: march.RUNGE_KUTTA,
    Method.BACKWARD_EULER: march.BACKWARD,
}
CLOSEST = 1e-12
"""Ends nearer than this times the surface's size leave no fibre between them."""


def run(
    method: str,
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    particles: int = 401,
    steps: int,
    step_size: float,
    damping: float = 0.0,
    stiffness: float = 1.0,
    mass: float = 1.0,
    friction: float = 0.0,
    initial: ArrayLike | None = None,
    reuse: int = 1,
    tolerance: float = 1e-10,
    lifting: bool = True,
    weighted: bool = False,
    inertial: bool = False,
    history: bool = False,
) -> Run:
    """Let one path move from rest until it comes to rest, the steps run out, or it explodes.

    method: one of `Method`.  start, end (2,): parametric ends, u unwrapped; initial (particles, 2): the starting
    curve, a straight line in (u, v) by default.  Each particle has `mass` and each spring the constant `stiffness`
    (K of 4.1) and no rest length, so that time counts in sqrt(mass / stiffness): step_size h is in those units of
    time, `damping` (beta of 4.7) in mass over time, and the highest natural frequency is 2 sqrt(K / m) whatever the
    part's size; see `largest_frequency` and `stable_step`.  reuse: steps that a factored matrix serves (7.2).
    tolerance: largest unbalanced tangential force over the tension.

    lifting=False keeps every particle on the surface (chapter 4).  weighted=True lifts by the force of (5.2) rather
    than by Algorithm 1's test.  inertial=True keeps the velocity term of (4.10) that (4.12) drops.  friction > 0
    scales velocities by (4.19); the run has converged when nothing moves at all.
    """
    scheme = _method(method)
    for name, value in (("steps", steps), ("reuse", reuse)):
        if not isinstance(value, int | np.integer) or value < 1:
            raise BadInputError(f"{name} is {value}; give a whole number, at least 1")
    for name, number in (("step_size", step_size), ("stiffness", stiffness), ("mass", mass)):
        if not (number > 0.0 and math.isfinite(number)):
            raise BadInputError(f"{name} is {number}; give a positive number")
    for name, number in (("damping", damping), ("friction", friction), ("tolerance", tolerance)):
        if not (number >= 0.0 and math.isfinite(number)):
            raise BadInputError(f"{name} is {number}; give a number that is not negative")
    curve = _curve(surface, start, end, particles, initial)
    physics = Physics(float(step_size), stiffness / mass, damping / mass, float(friction))
    record = np.empty((steps + 1 if history else 0, 3))
    tally = np.zeros(4, np.int64)
    middle = surface.control_points.reshape(-1, 3).mean(axis=0)
    net = frozen(surface.net - middle)
    count = len(curve)
    gap = np.zeros(count)
    chain = (np.empty((count, 3)), curve, np.zeros((count, 2)), np.empty((count, 6, 3)), np.empty((count, 3)),
             np.ones(count, np.bool_), gap)  # fmt: skip
    rules = march.Rules(SCHEMES[scheme], int(steps), float(tolerance), int(reuse), inertial, lifting, weighted)
    residual, length, status = march.march(net, surface.periodic, rules, physics, chain, record, tally)
    X, touching = chain[0], chain[5]
    return _result(surface, scheme, X + middle, curve, touching, residual, length, status, record, tally)


def _method(name: str) -> Method:
    try:
        return Method(name)
    except ValueError:
        raise BadInputError(f"no method {name!r}; choose one of {', '.join(Method)}") from None


def _curve(surface: Surface, start: ArrayLike, end: ArrayLike, particles: int, initial: ArrayLike | None) -> Floats:
    """The starting curve (particles, 2), checked: a straight line (6.2) unless one is given."""
    if not isinstance(particles, int | np.integer) or particles < 3:
        raise BadInputError(f"particles is {particles}; give a whole number, at least 3")
    ends = np.array([floats(start, "start", 2), floats(end, "end", 2)])
    if initial is None:
        t = np.linspace(0.0, 1.0, particles)[:, None]
        curve = (1.0 - t) * ends[0] + t * ends[1]
    else:
        curve = floats(initial, "initial", particles, 2).copy()
        curve[0], curve[-1] = ends
    if np.any((curve[:, 1] < 0) | (curve[:, 1] > 1)):
        raise BadInputError("the starting curve has v outside [0, 1]; v runs from rim to rim")
    if np.ptp(surface.points(curve), axis=0).max() <= CLOSEST * surface.size:
        raise BadInputError("the starting curve has no length; give two different ends")
    return np.ascontiguousarray(curve)


def _result(
    surface: Surface,
    method: Method,
    points: Floats,
    uv: Floats,
    touching: Bools,
    residual: float,
    length: float,
    status: int,
    record: Floats,
    tally: Ints,
) -> Run:
    frames = surface.frames(uv)
    offset = points - frames[:, 0]
    gap = np.copysign(np.linalg.norm(offset, axis=1), np.einsum("ik,ik->i", offset, surface.normals(uv)))
    taken = record[: tally[3] + 1]
    return Run(
        method=method,
        points=frozen(points),
        uv=frozen(uv),
        on_surface=frozen(touching),
        gap=frozen(np.where(np.abs(gap) > CLOSEST * surface.size, gap, 0.0)),
        length=float(length),
        residual=float(residual),
        status=Ending(status),
        counters=Counters(*(int(k) for k in tally)),
        history=History(*(frozen(taken[:, k]) for k in range(3))) if len(record) else None,
    )
