"""The natural spread of touch points on two caps: where a fibre turns that needs the least slip and goes on evenly.

Circuit after circuit a fibre's touch points wander round the two openings.  A coordinate theta in which each circuit
advances by the same turns is sought as smooth maps a = theta + ..., b = theta + ... of a few waves, such that the sum
of squares of the slips on all half-legs is least.  On integrable shapes, such as those of revolution with equal
openings, or a triaxial ellipsoid opened along lines of curvature, no slip is left, and theta is the canonical
coordinate of their geodesics.  With other turns a circuit than the natural ones the same maps share out the slip.
"""

from dataclasses import dataclass
from functools import partial
from typing import NoReturn

import numpy as np
from scipy.interpolate import CubicSpline

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.core.threads import side_by_side
from meshwind.filament.half_leg_table import follow, look_up
from meshwind.filament.polar_legs import End

_AROUND = 128
"""Touch points around an opening from which half-legs are tabulated: the table is a start, exact legs follow it."""
_SPARSE = 8, 4, 1
"""Of so many of them one comes first, then more, and these are enough where their waves have come to an end, ..."""
_ENDED = 1e-6
"""... the last quarter of them, and the miss half-way between two, being no larger than this, in turns and radians."""
_STEERED = 4
"""Touch points for each of those from which half-legs with slip are tabulated as well, at first."""
_ROUGH = 1e-9
"""Tolerance of the marches for the table, far below what it is off by between its touch points."""
_FINER = 8
"""Places of the table's spline between two of them, by Fourier series: it is then as good as these."""
_REACH = 0.05
"""Slip up to which half-legs are tabulated at first."""
_FURTHEST = 1.0
"""Slip up to which they are tabulated where more is needed: more than any friction on a mould."""
_SMALLEST = 0.01
"""Slip up to which half-legs must get away from their opening at the least."""
_WAVES = 24
"""Waves around an opening in the maps from theta: smooth enough to pass over resonances, which would bunch circuits."""
_FEWER = 8
"""Those that are enough where half-legs are smooth enough to be tabulated from a few touch points."""
_SAMPLES = 5
"""Values of theta at which slips are summed, for each of these waves: more than twice as many."""
_DAMPING = 1e-4
"""Share of the answer to a step, squared, by which the step is damped at first."""
_GAIN = 1e-3
"""Share of the sum of squares of slips below which a further step is not worth it."""
_CIRCUITS = 200
"""Circuits that the start is averaged over."""
_STEPS = 40
"""Most steps of Gauss and Newton; ten do where the maps exist."""
_DONE = 1e-11
"""Steps, in turns, that are round-off."""


@dataclass(frozen=True)
class Table:
    """Half-legs of a kind by touch point and slip: u and angle at the level half-way, as smooth functions.

    splines: as `half_leg_table.look_up` takes them.
    """

    splines: Floats
    reach: float
    touches: int

    def at(self, u: Floats, slip: Floats) -> tuple[Floats, Floats, Floats]:
        """u and angle (n, 2) at touch points u (n,) and slips (n,), and their derivatives by both."""
        found, by_u, by_slip = (np.empty((len(u), 2)) for _ in range(3))
        look_up(self.splines, self.reach, frozen(u), frozen(slip), found, by_u, by_slip)
        return found, by_u, by_slip


@dataclass(frozen=True)
class Tables:
    """The four kinds of half-legs: leaving the start, arriving at the end, leaving the end, arriving at the start."""

    kinds: tuple[Table, Table, Table, Table]

    @property
    def reach(self) -> float:
        """Slip up to which all are tabulated."""
        return min(table.reach for table in self.kinds)

    @property
    def waves(self) -> int:
        """Waves in maps that suit them."""
        return _WAVES if max(table.touches for table in self.kinds) == _AROUND else _FEWER

    def mismatch(self, touch: Floats, slip: Floats) -> tuple[Floats, Floats, Floats]:
        """How far the two half-legs of each pass miss each other, in u and angle, and derivatives.

        touch (n, 3): the touch points a, b, a' of circuits; slip (n, 4).  Returns (n, 2, 2) by pass and quantity; by
        touch point (n, 2, 2, 3); and by the two slips of each pass (n, 2, 2, 2).
        """
        miss, by_touch = np.empty((len(touch), 2, 2)), np.zeros((len(touch), 2, 2, 3))
        by_slip = np.empty((len(touch), 2, 2, 2))
        for p in range(2):
            first, u1, s1 = self.kinds[2 * p].at(touch[:, p], slip[:, 2 * p])
            second, u2, s2 = self.kinds[2 * p + 1].at(touch[:, p + 1], slip[:, 2 * p + 1])
            miss[:, p] = first - second
            by_touch[:, p, :, p], by_touch[:, p, :, p + 1] = u1, -u2
            by_slip[:, p, :, 0], by_slip[:, p, :, 1] = s1, -s2
        return miss, by_touch, by_slip


def tables(ends: tuple[End, End], reach: float = _REACH, steered: int = _STEERED) -> Tables:
    """Tabulate half-legs up to a slip, or up to a smaller one where they would not get away from the opening.

    steered: touch points for each of those from which half-legs with slip are tabulated as well.
    """
    kinds = (ends[0], True), (ends[1], False), (ends[1], True), (ends[0], False)
    # a kind alone is too few half-legs to keep two cores busy
    first, second, third, fourth = side_by_side(*(partial(_table, *kind, reach, steered) for kind in kinds))
    return Tables((first, second, third, fourth))


def _table(end: End, leaving: bool, reach: float, steered: int) -> Table:
    free = _free(end, leaving)
    # how a half-leg answers to slip is nearly linear, and need be known less well than where it leads without
    u = np.arange(len(free)) / len(free)
    few = u[::steered]
    while True:
        legs = end.march(np.tile(few, 2), np.repeat([reach, -reach], len(few)), leaving, _ROUGH)
        if legs.arrived.all():
            break
        reach *= 0.5
        if reach < _SMALLEST:
            _stays(end, few[np.argmin(legs.arrived) % len(few)])
    left, right = np.split(np.stack([legs.u - np.tile(few, 2), legs.angle], axis=1), 2)
    odd, even = 0.5 * (left - right), 0.5 * (left + right) - free[::steered]
    powers = np.stack([_finer(each, _FINER * _AROUND) for each in (free, odd, even)], axis=1)
    closed = np.concatenate([powers, powers[:1]])
    return Table(_splines(closed), reach, len(free))


def _splines(values: Floats) -> Floats:
    """Periodic splines (4, m, ...) through values (m + 1, ...) at even places around an opening."""
    return frozen(CubicSpline(np.linspace(0.0, 1.0, len(values)), values, bc_type="periodic").c)


def _free(end: End, leaving: bool) -> Floats:
    """The way in u and the angle (n, 2) of half-legs without slip: from as few touch points as tell it."""
    u, found = np.arange(_AROUND) / _AROUND, np.full((_AROUND, 2), np.nan)
    for stride in _SPARSE:
        these = np.flatnonzero(np.isnan(found[:, 0]) & (np.arange(_AROUND) % stride == 0))
        if stride > 1:
            these = np.append(these, stride // 2)  # as many lobes as touch points look like none
        legs = end.march(u[these], np.zeros(len(these)), leaving, _ROUGH)
        if not legs.arrived.all():
            _stays(end, u[these][np.argmin(legs.arrived)])
        found[these] = np.stack([legs.u - u[these], legs.angle], axis=1)
        free = found[::stride]
        last = np.fft.rfft(free, axis=0)[3 * len(free) // 8 :] / len(free)
        miss = _finer(free, 2 * len(free))[1] - found[stride // 2]
        if max(np.abs(last).max(), np.abs(miss).max()) < _ENDED:
            break
    return free


def _stays(end: End, u: float) -> NoReturn:
    """Say that a fibre does not get away from its opening."""
    raise BadInputError(
        f"a fibre that touches the opening at the {end.name} does not get from there to the middle of the part, at "
        f"u={u:.3f}: that end is no dome, as at a neck; let it turn by {argument(f'turn_{end.name}', 'pins')}, "
        f"collar or shaft, or give another {argument('opening')}"
    )


def _finer(values: Floats, count: int) -> Floats:
    """Values (n, 2) around an opening at `count` places, by their Fourier series."""
    return np.asarray(np.fft.irfft(np.fft.rfft(values, axis=0), count, axis=0) * (count / len(values)))


@dataclass(frozen=True)
class Natural:
    """Maps from theta to touch points, and the turns a circuit.

    waves (2, 1 + 2 m): a and b less theta: mean, cosines and sines; slip (n, 4): on the half-legs of a circuit at
    evenly spread theta.
    """

    waves: Floats
    turns: float
    slip: Floats

    @property
    def many(self) -> int:
        """Number of waves m."""
        return self.waves.shape[1] // 2

    @property
    def worst(self) -> float:
        """Largest slip."""
        return float(np.abs(self.slip).max())

    def touches(self, theta: Floats) -> Floats:
        """Touch points (n, 3) of circuits that begin at theta (n,): at the start, the end, and the start again."""
        here, after = _waves_at(theta, self.many), _waves_at(theta + self.turns, self.many)
        a, b = theta + here @ self.waves[0], theta + here @ self.waves[1]
        after = theta + self.turns + after @ self.waves[0]
        return np.stack([a, b, after], axis=1)


def _waves_at(theta: Floats, many: int) -> Floats:
    angle = 2.0 * np.pi * np.outer(theta, np.arange(1, many + 1))
    return np.concatenate([np.ones((len(theta), 1)), np.cos(angle), np.sin(angle)], axis=1)


def natural(legs: Tables, turns: float | None = None, near: Natural | None = None) -> Natural:
    """The maps with the least slip at so many turns a circuit, or at those that need the least, from `near`.

    By the method of Levenberg and Marquardt, in which changes of a and b weigh more the more waves they have.
    """
    samples = _SAMPLES * legs.waves if near is None else len(near.slip)
    theta = np.arange(samples) / samples
    first = near if near is not None else _guess(legs, theta)
    first = Natural(first.waves, first.turns if turns is None else turns, first.slip)
    now = _with_slips(legs, first, theta)
    damping = _DAMPING
    for _ in range(_STEPS):
        answer = _answer(legs, now, theta, turns is None)
        weight = _weights(now.many, turns is None) * np.linalg.norm(answer) / np.sqrt(answer.shape[1])
        square = answer.T @ answer
        while True:
            step = np.asarray(-np.linalg.solve(square + np.diag(damping * weight**2), answer.T @ now.slip.ravel()))
            trial = _with_slips(legs, _moved(now, step), theta)
            better = float(np.square(trial.slip).sum()) < float(np.square(now.slip).sum())
            small = float(np.abs(step).max()) < _DONE
            if better or small:
                break
            damping *= 10.0
        if better:
            gain = 1.0 - float(np.square(trial.slip).sum() / np.square(now.slip).sum())
            now, damping = trial, 0.1 * damping
            small |= gain < _GAIN
        if small:
            break
    return now


def with_least(
    ends: tuple[End, End], legs: Tables, free: Natural, wanted: list[int], circuits: int
) -> tuple[int, Natural, Tables]:
    """The turns with the least slip, their maps, and tables that reach as far as their slips."""
    each = [natural(legs, turns / circuits, free) for turns in wanted]
    if min(maps.worst for maps in each) > legs.reach:
        legs = tables(ends, min(1.5 * max(maps.worst for maps in each), _FURTHEST), steered=1)
        each = [natural(legs, turns / circuits, maps) for turns, maps in zip(wanted, each, strict=True)]
    best = min(range(len(each)), key=lambda k: each[k].worst)
    return wanted[best], each[best], legs


def _with_slips(legs: Tables, maps: Natural, theta: Floats) -> Natural:
    return Natural(maps.waves, maps.turns, slips(legs, maps.touches(theta), maps.slip))


def _moved(maps: Natural, step: Floats) -> Natural:
    """The maps with the waves of a (without its mean, which is where theta begins), those of b, and the turns moved."""
    waves, many = maps.waves.copy(), 2 * maps.many
    waves[0, 1:] += step[:many]
    waves[1] += step[many : 2 * many + 1]
    return Natural(waves, maps.turns + float(step[2 * many + 1 :].sum()), maps.slip)


def _weights(many: int, free: bool) -> Floats:
    rank = np.tile(np.arange(1.0, many + 1), 2)
    return np.concatenate([rank, [1.0], rank, [1.0] * free])


def _answer(legs: Tables, maps: Natural, theta: Floats, free: bool) -> Floats:
    """How the slips answer to a step: (4 n, steps)."""
    many, after, here = 2 * maps.many, theta + maps.turns, _waves_at(theta, maps.many)
    move = np.zeros((len(theta), 3, 2 * many + 2))
    move[:, 0, :many], move[:, 1, many : 2 * many + 1] = here[:, 1:], here
    move[:, 2, :many] = _waves_at(after, maps.many)[:, 1:]
    move[:, 2, 2 * many + 1] = 1.0 + _slope(after, maps.many) @ maps.waves[0]
    _, by_touch, by_slip = legs.mismatch(maps.touches(theta), maps.slip)
    found = -np.einsum("npij,npjt,ntk->npik", np.linalg.inv(by_slip), by_touch, move)
    found = found.reshape(-1, 2 * many + 2)
    return np.asarray(found if free else found[:, :-1])


def _slope(theta: Floats, many: int) -> Floats:
    """Derivatives of the waves by theta."""
    rank = 2.0 * np.pi * np.arange(1, many + 1)
    angle = np.outer(theta, rank)
    return np.concatenate([np.zeros((len(theta), 1)), -rank * np.sin(angle), rank * np.cos(angle)], axis=1)


def _guess(legs: Tables, theta: Floats) -> Natural:
    """A start: circuits whose half-legs without slip meet half-way in u, whatever their angles there.

    Their map of the start's opening to itself is a rotation in the mean of a + its lead over that rotation, taken along
    circuit after circuit, with weights that vanish with all derivatives at both ends (Das and Yorke, Super convergence
    of ergodic averages for quasiperiodic orbits).
    """
    a = np.linspace(0.0, 1.0, _FINER * _AROUND + 1)
    b = _over(legs.kinds[0], legs.kinds[1], a)
    ahead = _splines(_closed(_over(legs.kinds[2], legs.kinds[3], b) - a))
    share = (np.arange(_CIRCUITS) + 0.5) / _CIRCUITS
    weight = np.exp(-1.0 / (share * (1.0 - share)))
    weight /= weight.sum()
    leads, orbit = np.empty((_CIRCUITS, len(a))), np.empty((_CIRCUITS, len(a)))
    follow(ahead, a, leads, orbit)
    turns = float((weight @ leads).mean())
    natural_of_a = np.maximum.accumulate(weight @ (orbit - turns * np.arange(_CIRCUITS)[:, None]))
    natural_of_a -= natural_of_a[0]
    a_of_theta = np.interp(theta, natural_of_a / natural_of_a[-1], a)
    b_of_a = CubicSpline(a, _closed(b - a), bc_type="periodic")
    touch = np.stack([a_of_theta, a_of_theta + b_of_a(a_of_theta)])
    waves = np.asarray(np.linalg.lstsq(_waves_at(theta, legs.waves), (touch - theta).T, rcond=None)[0].T)
    return Natural(waves, turns, np.zeros((len(theta), 4)))


def _closed(values: Floats) -> Floats:
    """Values (n,) around an opening, the last of which is the first to the last digit."""
    return np.append(values[:-1], values[0])


def _over(leave: Table, arrive: Table, u: Floats) -> Floats:
    """Touch points (n,) at which fibres arrive, without slip, that leave at u (n,), unwrapped."""
    wanted = leave.at(u, np.zeros_like(u))[0][:, 0]
    fine = np.linspace(0.0, 1.0, _FINER * _AROUND + 1)
    across = np.maximum.accumulate(arrive.at(fine, np.zeros_like(fine))[0][:, 0])  # legs of a family do not cross
    whole = np.floor(wanted - across[0])
    return np.asarray(whole + np.interp(wanted - whole, across, fine))


def slips(legs: Tables, touch: Floats, near: Floats | None = None) -> Floats:
    """Slips (n, 4) with which circuits pass through touch points (n, 3), by the tables."""
    slip = np.zeros((len(touch), 4)) if near is None else near
    for _ in range(_STEPS):
        miss, _, by_slip = legs.mismatch(touch, slip)
        step = np.linalg.solve(by_slip, miss[..., None])[..., 0].reshape(-1, 4)
        slip = np.clip(slip - step, -4.0 * legs.reach, 4.0 * legs.reach)  # the tables go no further
        if np.abs(step).max() < _DONE:
            break
    return slip
