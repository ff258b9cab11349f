"""Run any of the literature's schemes on one path."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Ints, floats, frozen
from meshwind.core.checks import whole
from meshwind.core.defaults import PARTICLES
from meshwind.core.errors import BadInputError
from meshwind.methods import in_space, on_surface
from meshwind.methods.chain import STEPS, Chain, Physics, chain_at_rest
from meshwind.methods.in_space import SpaceRules, run_in_space
from meshwind.methods.motion import Ending, History, Method, Motion
from meshwind.methods.on_surface import SurfaceRules, run_on_surface
from meshwind.methods.strand import Strand
from meshwind.path.paths import Counters
from meshwind.surface.evaluate import S
from meshwind.surface.surface import Surface

SCHEMES = {
    Method.EXPLICIT_EULER: on_surface.EXPLICIT,
    Method.SYMPLECTIC_EULER: on_surface.SYMPLECTIC,
    Method.RUNGE_KUTTA: on_surface.RUNGE_KUTTA,
    Method.BACKWARD_EULER: on_surface.BACKWARD,
    Method.PENALTY: in_space.PENALTY,
    Method.KKT: in_space.KKT,
}
WIDTHS = {Method.PENALTY: 1e-3, Method.KKT: 1e-5}
"""Default contact width over the surface's size."""


def run(  # noqa: PLR0913
    method: str,
    surface: Surface,
    start: ArrayLike,
    end: ArrayLike,
    *,
    particles: int = PARTICLES,
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
) -> Motion:
    """Step one path through time until it is in equilibrium, the steps run out, or it diverges.

    Each particle has a mass m and each spring the constant K of (4.1) and no rest length, so that only K/m counts: the
    step size is a time, and the highest natural frequency is 2 sqrt(K/m), whatever the size of the part; see
    `largest_frequency` and `stable_step`.

    Parameters
    ----------
    method : str
        One of `Method`.
    surface : Surface
        The surface to wind on.
    start, end : array (2,)
        Parameters of the ends, u unwrapped.
    particles : int
        Number of particles, the ends included.
    steps : int
        Maximum number of steps.
    step_size : float
        Time step h.
    damping : float
        beta of (4.7), a mass over a time.
    stiffness, mass : float
        K and m.
    friction : float
        Coefficient mu: velocities are scaled by (4.19), and the run has converged when nothing moves at all.  Only on
        the surface.
    initial : array (particles, 2), optional
        Initial path, a straight line in (u, v) by default.
    reuse : int
        Number of steps for which backward Euler keeps a factored matrix (7.2).
    tolerance : float
        Largest unbalanced tangential force over the tension.
    lifting : bool
        False keeps every particle on the surface (chapter 4).  Only on the surface.
    weighted : bool
        Lift by the force of (5.2) rather than by Algorithm 1's test.  Only on the surface.
    inertial : bool
        Keep the velocity term of (4.10) that (4.12) drops.  Only for explicit schemes on the surface.
    width : float, optional
        In space: epsilon_PF of (7.1), 1e-3 of the surface's size by default, and for KKT the gap below which a particle
        is in contact, 1e-5 of it by default.
    push : float, optional
        In space: the penalty force k_PF, the initial tension by default.
    stabilisation : float
        In space: share in [0, 1] of a contact's gap that a step of KKT takes back.
    history : bool
        Whether to keep measures of every step.

    Returns
    -------
    Motion
        The last state, how the run ended, and its history if asked for.

    Raises
    ------
    BadInputError
        If a value is out of its range, or the method does not have the property asked for.
    """
    scheme = _method(method)
    if scheme.in_space and friction != 0.0:
        raise BadInputError(f"method {scheme} has no friction; set friction=0 or choose a scheme on the surface")
    if inertial and scheme is Method.BACKWARD_EULER:
        raise BadInputError("(4.13) drops the velocity term: set inertial=False or choose an explicit scheme")
    if stabilisation > 1.0:
        raise BadInputError(f"stabilisation is {stabilisation}; give a number from 0 to 1")
    steps = whole(steps, "steps", 1)
    reuse = whole(reuse, "reuse", 1)
    _positive(step_size=step_size, stiffness=stiffness, mass=mass, width=width, push=push)
    _not_negative(damping=damping, friction=friction, tolerance=tolerance, stabilisation=stabilisation)
    curve = _curve(start, end, particles, initial)
    physics = Physics(float(step_size), stiffness / mass, damping / mass, float(friction), inertial)
    records = _Records(np.empty((steps + 1 if history else 0, 3)), np.zeros(4, np.int64))
    code = SCHEMES[scheme]
    if not scheme.in_space:
        rules = SurfaceRules(code, int(steps), float(tolerance), int(reuse), lifting, weighted)
        return _on_surface(scheme, surface, rules, physics, curve, records)
    reach = WIDTHS[scheme] * surface.size if width is None else width
    force = stiffness * _spacing(surface, curve) if push is None else push
    contact = SpaceRules(code, int(steps), float(tolerance), float(reach), float(force / mass), float(stabilisation))
    return _in_space(scheme, surface, contact, physics, curve, records)


class _Records(NamedTuple):
    """What a run writes down: history (steps + 1, 3) or (0, 3), and the counters (4,)."""

    history: Floats
    tally: Ints


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
    """The initial path (particles, 2), checked: a straight line (6.2) unless one is given."""
    particles = whole(particles, "particles", 3)
    ends = np.array([floats(start, "start", 2), floats(end, "end", 2)])
    if initial is None:
        t = np.linspace(0.0, 1.0, particles)[:, None]
        curve = np.ascontiguousarray((1.0 - t) * ends[0] + t * ends[1])
    else:
        curve = floats(initial, "initial", particles, 2).copy()
        curve[0], curve[-1] = ends
    if np.any((curve[:, 1] < 0) | (curve[:, 1] > 1)):
        raise BadInputError("the initial path has v outside [0, 1]; v runs from rim to rim")
    if np.ptp(curve, axis=0).max() == 0.0:
        raise BadInputError("the initial path has no length; give two different ends")
    return curve


def _spacing(surface: Surface, uv: Floats) -> float:
    """Mean distance of neighbours, in the surface's units."""
    return float(np.linalg.norm(np.diff(surface.points(uv), axis=0), axis=1).mean())


def _on_surface(
    method: Method, surface: Surface, rules: SurfaceRules, physics: Physics, uv: Floats, records: _Records
) -> Motion:
    chain = chain_at_rest(uv)
    state = run_on_surface(surface.centred.spline, rules, physics, chain, *records)
    return _motion(method, surface, chain, state, records)


def _in_space(
    method: Method, surface: Surface, rules: SpaceRules, physics: Physics, uv: Floats, records: _Records
) -> Motion:
    n, frames = len(uv), surface.frames(uv)
    strand = Strand(
        X=frames[:, S] - surface.middle,
        V=np.zeros((n, 3)),
        uv=uv,
        frames=frames,
        normal=np.empty((n, 3)),
        touching=np.ones(n, np.bool_),
        loose=np.zeros(n, np.bool_),
        gap=np.zeros(n),
    )
    state = run_in_space(surface.centred.body, rules, physics, strand, *records)
    return _motion(method, surface, strand, state, records)


def _motion(
    method: Method, surface: Surface, particles: Chain | Strand, state: tuple[float, float, int], records: _Records
) -> Motion:
    """The result of a run from its particles about the surface's middle and what the time loop returned."""
    residual, length, status = state
    points, uv, touching = particles.X + surface.middle, particles.uv, particles.touching
    gap = np.zeros(len(uv))
    apart = np.ones(len(uv), bool) if method.in_space else ~touching
    if apart.any():
        offset = points[apart] - surface.points(uv[apart])
        height = np.einsum("ik,ik->i", offset, surface.normals(uv[apart]))
        gap[apart] = np.copysign(np.linalg.norm(offset, axis=1), height)
    lengths, residuals, angles = records.history[: records.tally[STEPS] + 1].T
    return Motion(
        method=method,
        points=frozen(points),
        uv=frozen(uv),
        on_surface=frozen(touching),
        gap=frozen(gap),
        length=float(length),
        residual=float(residual),
        status=Ending(status),
        counters=Counters(*(int(k) for k in records.tally)),
        history=History(frozen(lengths), frozen(residuals), frozen(angles)) if len(records.history) else None,
    )
