"""Feasible revolutions: the interval of the number of revolutions in which no fibre slides off an end.

On a shape of revolution on which the fibre presses everywhere the interval is Clairaut's bound.  Elsewhere windings
with more and more revolutions are tried, and the ends of the interval are found by bisection.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwind.path.friction import Friction, friction_of
from meshwind.planning.clairaut import profile
from meshwind.planning.families import hoop_revolutions
from meshwind.planning.trials import PATHS, Trial, trial
from meshwind.surface.surface import Surface

Wind = Callable[[float], Trial]
"""Winds by a number of revolutions."""
NUMBERS = 24
"""Numbers of revolutions that are tried before the bisection."""
_MAX_FAILURES = 3
"""Windings in a row that are not feasible, after which no larger number is tried."""
_SAME_RIM = 1e-3
"""Relative difference of the rims' radii up to which fibres slide off both ends at once."""


@dataclass(frozen=True)
class Feasible:
    """The interval [low, high] of feasible revolutions, high <= low where there is none.

    high is infinite where no number slides off; by: how the interval was found, "Clairaut" or "trials"; slides: the end
    where fibres slide off past it, "start", "end", "both" or ""; trials: the windings that were tried.
    """

    low: float
    high: float
    by: str
    slides: str
    trials: tuple[Trial, ...]

    @property
    def any(self) -> bool:
        """Whether any number of revolutions is feasible."""
        return self.high > self.low


def feasible_revolutions(
    surface: Surface,
    friction: float | Friction = 0.0,
    most: float | None = None,
    paths: int = PATHS,
    accuracy: float = 1e-3,
) -> Feasible:
    """Find the interval up to `most` revolutions (by default those of a hoop), its ends to an absolute accuracy.

    paths: number per family, where windings have to be tried.
    """
    most = hoop_revolutions(surface) if most is None else most
    shape = profile(surface) if friction_of(surface, friction).none else None
    if shape is not None:
        bound, narrow = shape.bound(), min(shape.rims)
        if shape.presses(narrow) and np.isfinite(bound):
            ends = tuple(rim <= narrow * (1.0 + _SAME_RIM) for rim in shape.rims)
            return Feasible(0.0, bound, "Clairaut", _ends(*ends), ())
    return _by_trials(lambda turns: trial(surface, turns, friction, paths), most, accuracy)


def _by_trials(wind: Wind, most: float, accuracy: float) -> Feasible:
    """The longest run of feasible windings among even numbers of revolutions, its ends refined by bisection."""
    tried: list[Trial] = [wind(0.0)]
    failures = 0
    for turns in np.linspace(most / NUMBERS, most, NUMBERS):
        tried.append(wind(float(turns)))
        failures = 0 if tried[-1].feasible else failures + 1
        if failures == _MAX_FAILURES:
            break
    first, last = _longest_run([each.feasible for each in tried])
    if last < first:
        return Feasible(0.0, 0.0, "trials", _slid_off(tried), tuple(tried))
    below = _bisect(wind, tried[first], tried[first - 1], accuracy) if first > 0 else []
    low = below[-1].revolutions if below else 0.0
    if last + 1 == len(tried):
        return Feasible(low, float("inf"), "trials", "", _sorted([*tried, *below]))
    above = _bisect(wind, tried[last], tried[last + 1], accuracy)
    slides = _slid_off([each for each in (*above, tried[last + 1]) if not each.feasible])
    return Feasible(low, above[-1].revolutions, "trials", slides, _sorted([*tried, *below, *above]))


def _sorted(tried: list[Trial]) -> tuple[Trial, ...]:
    return tuple(sorted(set(tried), key=lambda each: each.revolutions))


def _bisect(wind: Wind, feasible: Trial, failed: Trial, accuracy: float) -> list[Trial]:
    """The windings tried between a feasible one and one that is not; the last is feasible, next to one that is not."""
    tried = []
    while abs(failed.revolutions - feasible.revolutions) > accuracy:
        middle = wind(0.5 * (feasible.revolutions + failed.revolutions))
        tried.append(middle)
        feasible, failed = (middle, failed) if middle.feasible else (feasible, middle)
    return [*tried, feasible]


def _longest_run(flags: list[bool]) -> tuple[int, int]:
    """First and last index of the longest run of True; (0, -1) where there is none."""
    change = np.flatnonzero(np.diff([0, *map(int, flags), 0]))
    if not len(change):
        return 0, -1
    starts, stops = change[::2], change[1::2]
    best = int(np.argmax(stops - starts))
    return int(starts[best]), int(stops[best]) - 1


def _slid_off(failed: list[Trial]) -> str:
    """The ends that fibres slid off in some windings."""
    return _ends(any(each.slid[0] for each in failed), any(each.slid[1] for each in failed))


def _ends(start: bool, end: bool) -> str:
    return {(True, True): "both", (True, False): "start", (False, True): "end", (False, False): ""}[start, end]
