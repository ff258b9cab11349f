"""Run any of the literature's schemes on one path."""

import math

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Bools, Floats, Ints, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.methods import march, march_space
from meshwind.methods.chain import Physics
from meshwind.methods.run import Ending, History, Method, Run
from meshwind.path.paths import Counters
from meshwind.path.solve import check_count
from meshwind.surface.evaluate import S
from meshwind.surface.surface import Surface

SCHEMES = {
    Method.EXPLICIT_EULER: march.EXPLICIT,
    Method.SYMPLECTIC_EULER: march.SYMPLECTIC,
    Method.RUNGE_KUTTA: march.RUNGE_KUTTA,
    Method.BACKWARD_EULER: march.BACKWARD,
    Method.PENALTY: march_space.PENALTY,
    Method.KKT: march_space.KKT,
}
WIDTHS = {Method.PENALTY: 1e-3, Method.KKT: 1e-5}
"""Default contact width over the surface's size."""
FAR = 10.0
"""A part this many times its size from the origin is moved there and back."""


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
    width: float | None = None,
    push: float | None = None,
    stabilisation: float = 0.2,
    history: bool = False,
) -> Run:
    """Let one path move from rest until it comes to rest, the steps run out, or it explodes.

    method: one of `Method`.  start, end (2,): parametric ends, u unwrapped; initial (particles, 2): the starting
    curve, a straight line in (u, v) by default.  Each particle has `mass` m and each spring the constant `stiffness`
    K of (4.1) and no rest length, so that only K/m counts: step_size h is a time, `damping` beta of (4.7) a mass
    over time, and the highest natural frequency 2 sqrt(K/m) whatever the part's size; see `largest_frequency` and
    `stable_step`.  steps: at most so many.  tolerance: largest unbalanced tangential force over the tension.

    On the surface: lifting=False keeps every particle there (chapter 4); weighted=True lifts by the force of (5.2)
    rather than by Algorithm 1's test; inertial=True keeps the velocity term of (4.10) that (4.12) drops; friction
    scales velocities by (4.19), and the run has then converged when nothing moves at all.  reuse: steps that
    backward Euler's factored matrix serves (section 7.2).

    In space: width is epsilon_PF of (7.1), 1e-3 of the surface's size by default, and for KKT the gap below which a
    particle is in contact, 1e-5 of it; push is the penalty force k_PF, the tension at the start by default;
    stabilisation in [0, 1] is the share of a contact's gap that a step of KKT takes back.
    """
    scheme = _method(method)
    if scheme.in_space and friction != 0.0:
        raise BadInputError(f"method {scheme} has no friction; set friction=0 or choose a scheme on the surface")
    if inertial and scheme is Method.BACKWARD_EULER:
        raise BadInputError("(4.13) drops the velocity term: set inertial=False or choose an explicit scheme")
    if stabilisation > 1.0:
        raise BadInputError(f"stabilisation is {stabilisation}; give a number from 0 to 1")
    check_count(steps, "steps", 1)
    check_count(reuse, "reuse", 1)
    _positive(step_size=step_size, stiffness=stiffness, mass=mass, width=width, push=push)
    _not_negative(damping=damping, friction=friction, tolerance=tolerance, stabilisation=stabilisation)
    curve = _curve(start, end, particles, initial)
    physics = Physics(float(step_size), stiffness / mass, damping / mass, float(friction))
    tally, record = np.zeros(4, np.int64), np.empty((steps + 1 if history else 0, 3))
    if not scheme.in_space:
        rules = march.Rules(SCHEMES[scheme], int(steps), float(tolerance), int(reuse), inertial, lifting, weighted)
        return _on_surface(scheme, surface, rules, physics, curve, record, tally)
    reach = WIDTHS[scheme] * surface.size if width is None else width
    force = stiffness * _spacing(surface, curve) if push is None else push
    contact = march_space.Contact(
        SCHEMES[scheme], int(steps), float(tolerance), float(reach), float(force / mass), float(stabilisation)
    )
    return _in_space(scheme, surface, contact, physics, curve, record, tally)


def _method(name: str) -> Method:
    try:
        return Method(name)
    except ValueError:
        raise BadInputError(f"no method {name!r}; choose one of {', '.join(Method)}") from None


def _positive(**values: float | None) -> None:
    for name, value in values.items():
        if value is not None and not (value > 0.0 and math.isfinite(value)):
            raise BadInputError(f"{name} is {value}; give a positive number")


def _not_negative(**values: float) -> None:
    for name, value in values.items():
        if not (value >= 0.0 and math.isfinite(value)):
            raise BadInputError(f"{name} is {value}; give a number that is not negative")


def _curve(start: ArrayLike, end: ArrayLike, particles: int, initial: ArrayLike | None) -> Floats:
    """The starting curve (particles, 2), checked: a straight line (6.2) unless one is given."""
    check_count(particles, "particles", 3)
    ends = np.array([floats(start, "start", 2), floats(end, "end", 2)])
    if initial is None:
        t = np.linspace(0.0, 1.0, particles)[:, None]
        curve = np.ascontiguousarray((1.0 - t) * ends[0] + t * ends[1])
    else:
        curve = floats(initial, "initial", particles, 2).copy()
        curve[0], curve[-1] = ends
    if np.any((curve[:, 1] < 0) | (curve[:, 1] > 1)):
        raise BadInputError("the starting curve has v outside [0, 1]; v runs from rim to rim")
    if np.ptp(curve, axis=0).max() == 0.0:
        raise BadInputError("the starting curve has no length; give two different ends")
    return curve


def _spacing(surface: Surface, uv: Floats) -> float:
    """Mean distance of neighbours, in the surface's units."""
    return float(np.linalg.norm(np.diff(surface.points(uv), axis=0), axis=1).mean())


def _on_surface(
    method: Method,
    surface: Surface,
    rules: march.Rules,
    physics: Physics,
    uv: Floats,
    record: Floats,
    tally: Ints,
) -> Run:
    n, centred, origin = len(uv), surface.centred, surface.middle
    X, V, frames, normal = np.empty((n, 3)), np.zeros((n, 2)), np.empty((n, 6, 3)), np.empty((n, 3))
    touching = np.ones(n, np.bool_)
    chain = X, uv, V, frames, normal, touching, np.zeros(n)
    ending = march.march(centred.spline, rules, physics, chain, record, tally)
    return _result(method, surface, X + origin, uv, touching, ending, record, tally)


def _in_space(
    method: Method,
    surface: Surface,
    contact: march_space.Contact,
    physics: Physics,
    uv: Floats,
    record: Floats,
    tally: Ints,
) -> Run:
    n, centred, origin = len(uv), surface.centred, surface.middle
    frames = surface.frames(uv)
    X, W, normal = frames[:, S] - origin, np.zeros((n, 3)), np.empty((n, 3))
    touching = np.ones(n, np.bool_)
    strand = X, W, uv, frames, normal, touching, np.zeros(n)
    ending = march_space.march(
        centred.body,
        contact,
        physics,
        strand,
        record,
        tally,
    )
    return _result(method, surface, X + origin, uv, touching, ending, record, tally)


def _result(
    method: Method,
    surface: Surface,
    points: Floats,
    uv: Floats,
    touching: Bools,
    ending: tuple[float, float, int],
    record: Floats,
    tally: Ints,
) -> Run:
    residual, length, status = ending
    gap = np.zeros(len(uv))
    apart = np.ones(len(uv), bool) if method.in_space else ~touching
    if apart.any():
        offset = points[apart] - surface.points(uv[apart])
        height = np.einsum("ik,ik->i", offset, surface.normals(uv[apart]))
        gap[apart] = np.copysign(np.linalg.norm(offset, axis=1), height)
    lengths, residuals, angles = record[: tally[3] + 1].T
    return Run(
        method=method,
        points=frozen(points),
        uv=frozen(uv),
        on_surface=frozen(touching),
        gap=frozen(gap),
        length=float(length),
        residual=float(residual),
        status=Ending(status),
        counters=Counters(*(int(k) for k in tally)),
        history=History(frozen(lengths), frozen(residuals), frozen(angles)) if len(record) else None,
    )
