"""Passes over caps: the fibre touches the opening of a closed end along its tangent and comes back, with no dwell.

A solver between fixed ends cannot turn on a cap, as a fibre from equator to equator of a dome is no shortest one.  It
lies there by friction all the same, for which the criterion is local: |kg| <= mu kn and kn > 0.  So passes are marched
from where they touch, tangent to the opening, with as little constant slip on each half-leg as closes the layer.
"""

from dataclasses import dataclass, replace
from math import gcd
from typing import Literal, TypeAlias

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.checks import whole
from meshwind.core.defaults import PARTICLES
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.filament.pattern import Pattern
from meshwind.filament.polar_hollow import hollows
from meshwind.filament.polar_legs import End, Half, halves, opening
from meshwind.filament.polar_meet import MEETS, met
from meshwind.filament.polar_natural import natural, tables, with_least
from meshwind.filament.polar_rows import Stretch, evenly
from meshwind.march.march import EVALUATIONS
from meshwind.march.traced import Stop
from meshwind.path.paths import Counters, Paths, Status
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.surface import Surface

Side: TypeAlias = Literal["start", "end"]

_INSIDE = 1e-9
"""How far out over its opening in v a fibre may be for round-off."""
_SHARES = 4096
"""Points of an opening between which its length is summed, to spread touch points evenly by it."""


@dataclass(frozen=True)
class PolarPasses:
    """N circuits of a layer that turns on caps, in order of winding: pass there k, then pass back k, then there k + 1.

    Attributes
    ----------
    paths : Paths
        N passes there, family +1, then the N passes back, family -1, each from the start rim to the end rim; u of each
        begins within [0, 1).  On a cap the pass before ends where the next begins.
    slip : ndarray of float, shape (2 N, 2)
        Slip |kg|/kn on the half-leg at the start and on that at the end of each pass, with its sign: positive to the
        left of the fibre on its way.
    angle : ndarray of float, shape (2 N, n)
        Winding angle at each point of each pass, in radians.
    miss : ndarray of float, shape (2 N,)
        By how much the two half-legs miss each other half-way: turns, or radians of their angle, the larger.
    pattern : Pattern or None
        How the circuits close; None where one end is a rim, at which a dwell closes them.
    natural : float or None
        Turns a circuit that need the least slip; None where one end is a rim.
    """

    paths: Paths
    slip: Floats
    angle: Floats
    miss: Floats
    pattern: Pattern | None = None
    natural: float | None = None

    @property
    def worst(self) -> float:
        """Largest slip of all passes."""
        return float(np.abs(self.slip).max())

    @property
    def holds(self) -> bool:
        """Whether friction holds all passes, and all press on the part all along."""
        return bool((self.paths.status == Status.CONVERGED).all())

    @property
    def words(self) -> str:
        """What the layer needs in a line and, where it does not hold, what would help."""
        told = "" if self.pattern is None else f"{self.pattern.words}; "
        told += f"passes over caps need a slip of {self.worst:.4f} at most, and friction is {self.paths.friction:g}"
        bad = self.paths.status != Status.CONVERGED
        if not bad.any():
            return told
        told += f"; {np.count_nonzero(bad)} of {len(bad)} passes do not hold"
        if (self.paths.status == Status.STALLED).any():
            return f"{told}, as the part is hollow under them or they run over the opening: another opening may help"
        if self.pattern is None or self.natural is None:
            return told
        return (
            f"{told}: more friction, another opening, or other circuits may, whose turns come nearer to"
            f" {self.natural:.6f}, which these pass by {self.pattern.turns / self.pattern.circuits - self.natural:+.6f}"
        )


def natural_turns(surface: Surface, *, clearance: tuple[float, float] = (0.0, 0.0)) -> float:
    """Find the turns a circuit that need the least slip, between two caps.

    Parameters
    ----------
    surface : Surface
        Surface whose two rims are the openings of caps.
    clearance : tuple of float, default (0, 0)
        Distance at which the fibre passes each opening, in the surface's units.

    Returns
    -------
    float
        Turns of the part from touching the start's opening to touching it again.

    Raises
    ------
    BadInputError
        If an end is not a cap, as fibres that touch its opening do not get away from it.

    Examples
    --------
    Geodesics of a sphere close after one turn:

    >>> import meshwind as mw
    >>> from meshwind.filament.polar import natural_turns
    >>> ball = mw.shapes.sphere_band(1.0, polar0=0.5, polar1=2.64159265, spans=(96, 48))
    >>> round(natural_turns(ball), 5)
    1.0
    """
    return natural(tables(_two_caps(surface, clearance))).turns


def passes_between_caps(
    surface: Surface,
    circuits: int,
    *,
    turns: int | None = None,
    clearance: tuple[float, float] = (0.0, 0.0),
    friction: float = 0.0,
    particles: int = PARTICLES,
) -> PolarPasses:
    """Wind a layer of one filament between two caps, closed by a small slip on the legs.

    Touch points are spread evenly in the coordinate in which circuits advance evenly, so that a layer that closes by
    itself takes no slip.

    Parameters
    ----------
    surface : Surface
        Surface whose two rims are the openings of caps.
    circuits : int
        Circuits N, at least 1.
    turns : int, optional
        Turns M of the whole layer, without a common divisor with N.  By default of those next to the natural ones, on
        either side, the one with the least slip.
    clearance : tuple of float, default (0, 0)
        Distance at which the fibre passes each opening, in the surface's units: half a band, say.
    friction : float, default 0
        Coefficient of friction against which the slip is judged; the passes do not depend on it.
    particles : int, default 401
        Points of each pass, at least 3.

    Returns
    -------
    PolarPasses
        The passes; where friction does not hold them, or the part is hollow under them, their status says so.

    Raises
    ------
    BadInputError
        If an end is not a cap, or a number is out of range.

    Examples
    --------
    >>> import meshwind as mw
    >>> from meshwind.filament.polar import passes_between_caps
    >>> ball = mw.shapes.sphere_band(1.0, polar0=0.5, polar1=2.64159265, spans=(96, 48))
    >>> layer = passes_between_caps(ball, 12, friction=0.2, particles=51)
    >>> layer.pattern.turns, len(layer.paths), layer.holds
    (13, 24, True)
    """
    circuits = whole(circuits, "circuits", 1)
    particles = whole(particles, "particles", 3)
    _check_friction(friction)
    if turns is not None and gcd(turns, circuits) != 1:
        raise BadInputError(f"{turns} turns of {circuits} circuits are not one filament; give coprime numbers")
    ends = _two_caps(surface, clearance)
    legs = tables(ends)
    free = natural(legs)
    wanted = [turns] if turns is not None else _next_to(free.turns * circuits, circuits)
    chosen, maps, legs = with_least(ends, legs, free, wanted, circuits)
    theta = np.arange(circuits) * (chosen / circuits)
    touch = maps.touches(np.asarray(theta))
    touch[:, 2] = np.append(touch[1:, 0], touch[0, 0] + chosen)
    found = met(ends, legs, touch)
    (leave_start, come_to_end), (leave_end, come_to_start) = found.legs
    fibres = (
        Stretch(leave_start.with_more(come_to_start), ends[0].half, False),
        Stretch(come_to_end.with_more(leave_end), ends[1].half, True),
    )
    paths, angle = _as_paths(surface, ends, fibres, particles, friction)
    slip, miss = np.concatenate([found.slip[0], found.slip[1][:, ::-1]]), found.miss.ravel()
    paths = replace(paths, residual=frozen(miss), status=_met(paths.status, miss))
    return PolarPasses(paths, frozen(slip), angle, frozen(miss), Pattern(circuits, chosen), free.turns)


def passes_over_a_cap(
    surface: Surface,
    circuits: int,
    *,
    cap: Side = "end",
    clearance: float = 0.0,
    friction: float = 0.0,
    particles: int = PARTICLES,
) -> PolarPasses:
    """Wind passes from a rim over the cap at the other end and back to the rim, as geodesics.

    Touch points are spread evenly around the opening by its length.  The angle is that of the opening, as by Clairaut's
    relation on a part of revolution: nothing is left to choose.  At the rim the fibre dwells as it is joined.

    Parameters
    ----------
    surface : Surface
        Surface one rim of which is the opening of a cap.
    circuits : int
        Circuits N, at least 1.
    cap : {"start", "end"}, default "end"
        Which end is the cap.
    clearance : float, default 0
        Distance at which the fibre passes the opening, in the surface's units.
    friction : float, default 0
        Coefficient of friction that the paths are said to have; geodesics need none.
    particles : int, default 401
        Points of each pass, at least 3.

    Returns
    -------
    PolarPasses
        The passes, without a pattern.

    Raises
    ------
    BadInputError
        If the end is not a cap, a fibre does not reach the rim, or a number is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> import meshwind as mw
    >>> from meshwind.filament.polar import passes_over_a_cap
    >>> bowl = mw.shapes.sphere_band(1.0, polar0=0.5 * np.pi, polar1=2.5, spans=(96, 48))
    >>> layer = passes_over_a_cap(bowl, 5, particles=51)
    >>> layer.paths.family.tolist()
    [1, 1, 1, 1, 1, -1, -1, -1, -1, -1]
    """
    circuits = whole(circuits, "circuits", 1)
    particles = whole(particles, "particles", 3)
    _check_friction(friction)
    if cap not in ("start", "end"):
        raise BadInputError(f"cap is {cap!r}; give 'start' or 'end'")
    at_end = cap == "end"
    end = End(Half(surface, 0.0, 1.0), opening(surface, int(at_end), clearance))
    touch, none = _spread(surface, end, circuits), np.zeros(circuits)
    there, back = (end.march(touch, none, leaving) for leaving in (not at_end, at_end))
    lost = ~(there.arrived & back.arrived)
    if lost.any():
        raise BadInputError(
            f"a fibre that touches the opening at the {cap} at u={touch[np.argmax(lost)] % 1.0:.3f} does not reach the"
            f" rim across from it: it turns back before; give an {argument('opening')} that is, with half a band's "
            "width, as narrow as the part at its narrowest, or another turnaround there, as at a rim that is open"
        )
    fibres = (Stretch(there.marched.with_more(back.marched), end.half, at_end),)
    paths, angle = _as_paths(surface, (end,), fibres, particles, friction)
    return PolarPasses(paths, frozen(np.zeros((2 * circuits, 2))), angle, frozen(np.zeros(2 * circuits)))


def _two_caps(surface: Surface, clearance: tuple[float, float]) -> tuple[End, End]:
    openings = [opening(surface, end, clearance[end]) for end in (0, 1)]
    lower, upper = halves(surface)
    return End(lower, openings[0]), End(upper, openings[1])


def _check_friction(friction: float) -> None:
    if not 0.0 <= friction < np.inf:
        raise BadInputError(f"friction is {friction}; give a coefficient from 0 up")


def _next_to(turns: float, circuits: int) -> list[int]:
    """The whole turns below and above that have no common divisor with the circuits."""
    below, above = int(np.floor(turns)), int(np.floor(turns)) + 1
    while gcd(below, circuits) != 1:
        below -= 1
    while gcd(above, circuits) != 1:
        above += 1
    return [below, above]


def _spread(surface: Surface, end: End, count: int) -> Floats:
    """Touch points (n,) that share out the length of the opening."""
    u = np.linspace(0.0, 1.0, _SHARES + 1)
    frames, way = surface.frames(end.opening.at(u)), end.opening.tangent(u)
    speed = np.linalg.norm(way[:, :1] * frames[:, SU] + way[:, 1:] * frames[:, SV], axis=1)
    passed = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]))])
    return np.asarray(np.interp(np.arange(count) / count, passed / passed[-1], u))


def _as_paths(
    surface: Surface, ends: tuple[End, ...], fibres: tuple[Stretch, ...], particles: int, friction: float
) -> tuple[Paths, Floats]:
    """Paths with the status that the local criterion gives them, and their winding angles (p, n)."""
    laid = evenly(surface, fibres, particles, angles=True)
    shape = laid.slip.shape
    slip = np.abs(np.stack([stretch.marched.slip for stretch in fibres], axis=1))
    laid.slip[:, [0, -1]] = np.nan
    half = shape[0] // 2
    steps = sum(int(stretch.marched.counts[:, EVALUATIONS].sum()) for stretch in fibres)
    paths = Paths(
        surface=surface,
        points=frozen(laid.points),
        uv=frozen(laid.uv),
        on_surface=frozen(np.ones(shape, dtype=bool)),
        gap=frozen(np.zeros(shape)),
        normal=frozen(laid.normal),
        slip=frozen(laid.slip),
        family=frozen(np.repeat([1, -1], half)),
        status=_status(surface, ends, fibres, laid.uv, slip > friction + MEETS),
        residual=frozen(np.zeros(shape[0])),
        friction=friction,
        counters=Counters(steps, 0, 0, 0),
    )
    return paths, frozen(laid.angle)


def _status(surface: Surface, ends: tuple[End, ...], fibres: tuple[Stretch, ...], uv: Floats, beyond: Bools) -> Ints:
    status = np.full(len(uv), int(Status.CONVERGED))
    status[beyond[:, -1]] = Status.SLID_OFF_END
    status[beyond[:, 0]] = Status.SLID_OFF_START
    lifts = np.any([hollows(surface, stretch) for stretch in fibres], axis=0)
    out = np.min([end.opening.inside(uv) for end in ends], axis=0)
    stopped = np.any([stretch.marched.stop == Stop.STEP_LIMIT for stretch in fibres], axis=0)
    status[lifts | (out < -_INSIDE) | stopped] = Status.STALLED
    return frozen(status)


def _met(status: Ints, miss: Floats) -> Ints:
    """The status of passes, also those whose half-legs do not meet."""
    return frozen(np.where(miss <= 1e3 * MEETS, status, int(Status.STALLED)))
