"""The number of revolutions, chosen: where the fibre presses (6.3), where it does not slide off, what bridges least."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.defaults import PARTICLES, STEPS_PER_TURN
from meshwind.core.errors import BadInputError
from meshwind.path.friction import Friction, friction_of
from meshwind.planning.holding import Holding, Wound, holding, hoop_revolutions, opened, square_revolutions
from meshwind.planning.pressing import Pressing, pressing
from meshwind.planning.trials import PATHS, Trial, full_trial, trial
from meshwind.surface.surface import Surface

CANDIDATES = 32
"""Numbers of revolutions that are compared."""
MARGIN = 0.97
"""Share of the bound at which the last candidate lies: at the bound itself the fibre is about to slide."""
NEAR = 0.005
"""Bridged shares of a path that differ by less are alike; among those the better crossing angle decides."""
_CHECKS, _ENOUGH = 10, 4
"""So many candidates are wound in earnest at most, and so many that hold are compared where all of them bridge."""
_APART = 0.04
"""A candidate this close to one that was wound in earnest, relative, is passed over."""
_CLOSE = 0.02
"""The best number is looked for to within this, relative, where all bridge."""
_TRIED, _FEW = 16, 3
"""Most paths a family in coarse windings; and with friction, which costs more."""
_GAIN = 3.0
"""So many times the bound is as far as it is looked for with friction."""
FRICTION, WIDER = 0.2, 1.5
"""What more would allow: this friction (a wet fibre's), and openings so many times as wide."""

Intervals = tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class Revolutions:
    """The choice of the number of revolutions, and what it rests on.

    chosen: the winding in earnest of the choice; pressing: by points of the surface; common: the interval(s), among
    the numbers that hold, in which most of the surface presses; common_share: that share; holding: the numbers that
    hold; trials: all windings that were tried, by growing revolutions; square: revolutions whose families cross at
    right angles on average; with_friction, with_opening: most revolutions that would hold with friction `FRICTION`
    or openings `WIDER` times as wide, 0 where not looked for or none, infinity where no number slides off.
    """

    chosen: Trial
    pressing: Pressing
    common: tuple[tuple[float, float], ...]
    common_share: float
    holding: Holding
    trials: tuple[Trial, ...]
    square: float
    with_friction: float = 0.0
    with_opening: float = 0.0

    @property
    def choice(self) -> float:
        """Revolutions from end to end that were chosen."""
        return self.chosen.revolutions

    @property
    def why(self) -> str:
        """The choice in words."""
        high = self.holding.high
        bound = "no number slides off" if not np.isfinite(high) else f"more than {high:.3g} slide off"
        if not self.holding.any:
            return f"{self.choice:.3g} revolutions: none keeps every fibre on the part; most fibres hold at this number"
        share = self.chosen.bridged
        bridged = "no fibre bridges" if share == 0.0 else f"{100.0 * share:.2g}% of the fibre bridges, the least"
        return f"{self.choice:.3g} revolutions: {bridged}; {bound}"


def choose_revolutions(
    surface: Surface,
    *,
    paths: int = PATHS,
    particles: int | None = PARTICLES,
    friction: float | Friction = 0.0,
    most: float | None = None,
    further: bool = True,
) -> Revolutions:
    """Choose the number of revolutions.

    Only feasible revolutions are considered: those at which no fibre slides off an end.  Of these a number with the
    least bridging is taken; among numbers that are alike in that, one at which most of the surface presses, and then
    the one whose families cross closest to a right angle.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    paths : int, default 8
        Number of paths per family for which the choice is wound at full resolution.
    particles : int or None, default 401
        Number of particles per path there, as for `solve`.
    friction : float or Friction, default 0
        Coefficient of friction.
    most : float, optional
        Largest number of revolutions.  By default that of a hoop winding, and no more than `particles` can follow.
    further : bool, default True
        Whether to find what more friction and wider openings would allow as well.

    Returns
    -------
    Revolutions
        The choice as `choice`, a line on it as `why`, the winding as `chosen`, and what the choice rests on.

    Raises
    ------
    BadInputError
        If the surface does not close in u, or `paths` or `most` is out of range.

    Examples
    --------
    >>> import meshwind as mw
    >>> barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0, spans=(32, 16))
    >>> found = mw.choose_revolutions(barrel, paths=4, particles=51, further=False)
    >>> 0.0 < found.choice < 0.6
    True
    """
    if not surface.periodic:
        raise BadInputError("revolutions need a surface that closes in u; give end points to `solve` instead")
    if not isinstance(paths, int | np.integer) or paths < 1:
        raise BadInputError(f"paths is {paths}; give a whole number of paths a family, at least 1")
    if most is None:
        most = hoop_revolutions(surface)
        most = most if particles is None else min(most, (particles - 1) / STEPS_PER_TURN)
    elif not 0.0 < most < np.inf:
        raise BadInputError(f"most is {most}; give a largest number of revolutions above 0")
    tried = min(paths, _TRIED)
    held = holding(surface, friction, most, tried, 2e-3)
    square = square_revolutions(surface)
    pressed = pressing(surface)
    top = min(held.high, most)
    common = pressed.most_common(held.low, top)
    share = max((float(pressed.share(np.array([_inside(*each)]))[0]) for each in common), default=0.0)
    candidates = [trial(surface, float(turns), friction, tried) for turns in _candidates(held, top, paths)]
    chosen, trials = _choose(
        _order(candidates, held, common, square),
        [*held.trials, *candidates],
        lambda turns: full_trial(surface, turns, friction, paths, particles),
        0.5 / paths,
    )
    gains = _further(surface, held, most, friction) if further and held.any and np.isfinite(held.high) else (0.0, 0.0)
    trials.sort(key=lambda each: each.revolutions)
    return Revolutions(chosen, pressed, common, share, held, tuple(trials), square, *gains)


def _inside(low: float, high: float) -> float:
    return 0.5 * (low + high) if np.isfinite(high) else low + 1.0


def _limit(held: Holding) -> float:
    return held.low + MARGIN * (held.high - held.low)


def _candidates(held: Holding, top: float, paths: int) -> Floats:
    """Numbers spread evenly over those that hold, such that ends of both families meet on the end rim too."""
    last = min(top, _limit(held))
    if not held.any:
        return np.zeros(0)
    even = np.linspace(held.low, last, CANDIDATES + 1)[1:]
    meeting = np.unique(_meeting(even, paths))
    meeting = meeting[(meeting > held.low) & (meeting <= last) & (meeting > 0.0)]
    return meeting if len(meeting) else even


def _meeting(turns: Floats, paths: int) -> Floats:
    """The nearest revolutions by which both families end in the same points: whole multiples of 1 / 2 paths."""
    return np.asarray(np.round(2.0 * paths * turns) / (2.0 * paths))


def _order(trials: list[Trial], held: Holding, common: Intervals, square: float) -> list[Trial]:
    """The trials that hold, the best first: those that bridge no more than the least, then by what they bridge."""
    good = [each for each in trials if each.holds and 0.0 < each.revolutions <= _limit(held) * (1.0 + 1e-12)]
    least = min((each.bridged for each in good), default=0.0)

    def merit(each: Trial) -> tuple[float, bool, float]:
        excess = each.bridged - least
        presses = any(low <= each.revolutions <= high for low, high in common)
        return (0.0 if excess <= NEAR else excess), not presses, abs(float(np.log(each.revolutions / square)))

    return sorted(good, key=merit)


def _choose(order: list[Trial], trials: list[Trial], wound: Wound, grain: float) -> tuple[Trial, list[Trial]]:
    """The winding in earnest that holds and bridges least, or has most paths at rest; and all windings tried.

    Coarse paths miss the bridged share by several percent of the fibre: where all bridge, candidates are compared by
    windings in earnest, and the numbers on both sides of the best as well.
    """
    checked: list[Trial] = []
    for best in order:
        held = [each for each in checked if each.holds]
        near = [abs(each.revolutions - best.revolutions) < _APART * best.revolutions for each in checked]
        if len(checked) == _CHECKS or len(held) == _ENOUGH or any(each.bridged <= NEAR for each in held):
            break
        if not any(near):
            checked.append(wound(best.revolutions))
    numbers = sorted(each.revolutions for each in order)
    step = 0.5 * float(np.diff(numbers).max(initial=0.0))
    while checked and step > max(_CLOSE * _least(checked).revolutions, 0.5 * grain) and _least(checked).bridged > NEAR:
        whole = grain * np.ceil(step / grain - 1e-9)
        middle = _least(checked).revolutions
        beside = [middle - whole, middle + whole]
        known = [each.revolutions for each in checked]
        beside = [turns for turns in beside if 0.0 < turns <= numbers[-1] + 1e-9 and not np.isclose(known, turns).any()]
        checked += [wound(turns) for turns in beside]
        step *= 0.5
    turned = checked or [each for each in trials if each.revolutions > 0.0]
    return _least(turned), [*trials, *checked]


def _least(trials: list[Trial]) -> Trial:
    return max(trials, key=lambda each: (each.at_rest, -each.bridged))


def _further(surface: Surface, held: Holding, most: float, friction: float | Friction) -> tuple[float, float]:
    """Most revolutions with more friction, and with wider openings; 0 where they gain nothing."""
    rougher = max(FRICTION, 2.0 * friction_of(surface, friction).largest)
    gained = _rougher(surface, rougher, held.high, min(most, _GAIN * held.high))
    wider = opened(surface, WIDER, held.slides or "both")
    high = 0.0 if wider is None else holding(wider, friction, most, _FEW, 0.02 * held.high).high
    return gained, high if high > held.high else 0.0


def _rougher(surface: Surface, friction: float, high: float, most: float) -> float:
    """Most revolutions that hold with friction, to a step of a tenth; 0 where it does not hold the next step."""
    best = 0.0
    for turns in np.arange(1.1 * high, most, 0.1 * high):
        if not trial(surface, float(turns), friction, _FEW).holds:
            break
        best = float(turns)
    return best
