"""Feasible revolutions: the interval of the number of revolutions in which no fibre slides off an end.

On a shape of revolution on which the fibre presses everywhere the interval ends at Clairaut's bound.  Elsewhere more
and more revolutions are tried with few, coarse paths; the ends of the interval are then found with all paths.
"""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.defaults import PARTICLES
from meshwind.path.friction import Friction, friction_of
from meshwind.planning.clairaut import profile
from meshwind.planning.families import hoop_revolutions
from meshwind.planning.trials import PATHS, Trial, trial
from meshwind.planning.windings import Windings, spread
from meshwind.surface.surface import Surface

NUMBERS = 24
"""Numbers of revolutions that are tried before the bisection."""
_MAX_FAILURES = 3
"""Windings in a row that are not feasible, after which no larger number is tried."""
_SAME_RIM = 1e-3
"""Relative difference of the rims' radii up to which fibres slide off both ends at once."""
ALLOWANCE = 0.01
"""Share of the interval by which its ends are moved inward, for starts between those that were tried."""
_STEPS = (2e-4, 1e-3, 4e-3, 1.6e-2)
"""Relative steps back from Clairaut's bound, of which the first is taken with which the particles hold."""
_NEAR = 0.98
"""Share of a number that does not hold that is tried next."""
_WITHIN, _MAX_GAPS = 8, 4
"""Numbers within the interval that are tried, and times that it is cut at one that does not hold, or moved inward."""
_COARSE = 3
"""Most paths per family in coarse windings."""


@dataclass(frozen=True)
class Feasible:
    """The interval [low, high] of feasible revolutions, high <= low where there is none.

    It is an inner one: all in it hold.  high is infinite where no number slides off; by: how the interval was found,
    "Clairaut" or "trials"; slides: the end where fibres slide off past it, "start", "end", "both" or ""; trials: the
    coarse windings that were tried.
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
    particles: int | None = PARTICLES,
) -> Feasible:
    """Find an interval up to `most` revolutions (by default those of a hoop) within which every path holds.

    paths, particles: those for which it is meant.  The interval is an inner one: its ends are tried as `solve` lays
    the paths, with starts between those asked for, and moved inward by an allowance for all others.
    """
    most = hoop_revolutions(surface) if most is None else most
    windings = spread(surface, friction, paths, particles)
    shape = profile(surface) if friction_of(surface, friction).none else None
    if shape is not None:
        bound, narrow = shape.bound(), min(shape.rims)
        if shape.presses(narrow) and np.isfinite(bound):
            ends = tuple(rim <= narrow * (1.0 + _SAME_RIM) for rim in shape.rims)
            back = [bound * (1.0 - step) for step in _STEPS]
            first = next((k for k, number in enumerate(back) if windings.holds(number, coarse=True)), len(back))
            held = next((number for number in back[first:] if windings.holds(number)), None)
            if held is not None:
                return Feasible(0.0, held, "Clairaut", _ends(*ends), ())
    return _verified(windings, coarse_interval(surface, friction, most, min(paths, _COARSE)), most)


def coarse_interval(
    surface: Surface, friction: float | Friction, most: float, paths: int, slides: bool = True
) -> Feasible:
    """The interval as few coarse paths have it, its ends to a step of the numbers that are tried.

    slides: whether the end is wanted where fibres slide off all the same where no number holds.
    """
    tried: list[Trial] = [trial(surface, 0.0, friction, paths)]
    failures = 0
    for turns in np.linspace(most / NUMBERS, most, NUMBERS):
        tried.append(trial(surface, float(turns), friction, paths, slides and not any(each.feasible for each in tried)))
        failures = 0 if tried[-1].feasible else failures + 1
        if failures == _MAX_FAILURES:
            break
    first, last = _longest_run([each.feasible for each in tried])
    if last < first:
        return Feasible(0.0, 0.0, "trials", _slid_off(tried), tuple(tried))
    high = float("inf") if last + 1 == len(tried) else tried[last].revolutions
    return Feasible(tried[first].revolutions, high, "trials", _slid_off(tried[last + 1 :]), tuple(tried))


def _verified(windings: Windings, coarse: Feasible, most: float) -> Feasible:
    """The interval with its ends found, and numbers within it tried, as `solve` lays the paths."""
    if not any(each.feasible for each in coarse.trials):
        return coarse
    numbers = [each.revolutions for each in coarse.trials]
    low, high = coarse.low, coarse.high
    if low > 0.0:
        low = windings.limit(max(n for n in numbers if n < low), low, min(high, most)) or np.inf
    if np.isfinite(high):
        high = windings.limit(min(n for n in numbers if n > high), high, min(low, high))
    elif not windings.holds_some(most, _WITHIN):
        high = windings.limit(most, _NEAR * most, min(low, most))
    if not high > low:
        return replace(coarse, low=0.0, high=0.0)
    low, high = _without_gaps(windings, low, high, most)
    slides = coarse.slides or (_ends(*windings.settling.slid) if np.isfinite(high) else "")
    return replace(coarse, low=low, high=high, slides=slides)


def _without_gaps(windings: Windings, low: float, high: float, most: float) -> tuple[float, float]:
    """The larger part of an interval in which numbers hold that are spread over it, and its ends after an allowance."""
    for _ in range(_MAX_GAPS):
        top = min(high, most)
        inside = np.linspace(low, top, _WITHIN + 2)[1:-1]
        gaps = (float(number) for k, number in enumerate(inside[::-1]) if not windings.holds_some(float(number), k))
        gap = next(gaps, None)
        if gap is None:
            return _confirmed(windings, low, high, most)
        upper = top - gap > gap - low
        low, high = (
            (windings.limit(gap, gap / _NEAR, top), high) if upper else (low, windings.limit(gap, _NEAR * gap, low))
        )
        if not high > low:
            break
    return 0.0, 0.0


def _confirmed(windings: Windings, low: float, high: float, most: float) -> tuple[float, float]:
    """The interval with its ends moved inward by an allowance, and to where paths hold with all their particles."""
    top = min(high, most)
    inward = ALLOWANCE * (top - low)
    if np.isfinite(high):
        high = windings.confirmed(top - inward, low, -inward)
    if low > 0.0 and high > low:
        low = windings.confirmed(low + inward, min(high, top), inward) or np.inf
    return (low, high) if high > low else (0.0, 0.0)


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
