"""How many revolutions hold: the interval in which no fibre slides off an end.

On a shape of revolution on which the fibre presses this is Clairaut's bound.  Elsewhere windings with more and more
revolutions are tried, and the end of the interval is found by halving.
"""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.path.friction import Friction, friction_of
from meshwind.planning.clairaut import profile
from meshwind.planning.trials import PATHS, Trial, trial
from meshwind.surface.interpolate import interpolate
from meshwind.surface.surface import Surface

Wound = Callable[[float], Trial]
"""Winds by so many revolutions."""
VALUES = 24
"""Numbers of revolutions that are tried first."""
_LOST = 3
"""So many in a row that do not hold end the search."""
_STEEPEST = np.radians(80.0)
"""Winding angle from the axis, on average, past which a winding is a hoop and no longer runs from end to end."""


@dataclass(frozen=True)
class Holding:
    """The interval [low, high] of revolutions that hold, high <= low where none does.

    high is infinite where no number slides off; by says how it was found, "Clairaut" or "trials"; slides names the end
    where fibres slide off past it, "start", "end", "both" or ""; trials are the windings that were tried.
    """

    low: float
    high: float
    by: str
    slides: str
    trials: tuple[Trial, ...]

    @property
    def any(self) -> bool:
        """Whether any number of revolutions holds."""
        return self.high > self.low


def holding(
    surface: Surface,
    friction: float | Friction = 0.0,
    most: float | None = None,
    paths: int = PATHS,
    close: float = 1e-3,
) -> Holding:
    """Find the interval, up to `most` revolutions (by default those of a hoop), its ends to `close` revolutions.

    paths: of each family, where windings have to be tried.
    """
    most = hoop_revolutions(surface) if most is None else most
    shape = profile(surface) if friction_of(surface, friction).none else None
    if shape is not None:
        bound, narrow = shape.bound(), min(shape.rims)
        if shape.presses(narrow) and np.isfinite(bound):
            ends = tuple(rim <= narrow * (1.0 + 1e-3) for rim in shape.rims)
            return Holding(0.0, bound, "Clairaut", _ends(*ends), ())
    return _by_trials(lambda turns: trial(surface, turns, friction, paths), most, close)


def hoop_revolutions(surface: Surface) -> float:
    """Revolutions of a winding that is all but a hoop."""
    return float(np.tan(_STEEPEST)) * square_revolutions(surface)


def square_revolutions(surface: Surface) -> float:
    """Revolutions of a winding at 45 degrees on average, so that the two families cross square: the best angle."""
    t = (np.arange(32) + 0.5) / 32
    uv = np.stack(np.meshgrid(t, t, indexing="ij"), axis=2).reshape(-1, 2)
    around, along = np.linalg.norm(surface.frames(uv)[:, 1:3], axis=2).mean(axis=0)
    return float(along / max(around, 1e-300))


def _by_trials(wound: Wound, most: float, close: float) -> Holding:
    tried: list[Trial] = [wound(0.0)]
    run = 0
    for turns in np.linspace(most / VALUES, most, VALUES):
        tried.append(wound(float(turns)))
        run = 0 if tried[-1].holds else run + 1
        if run == _LOST:
            break
    first, last = _longest_run([each.holds for each in tried])
    if last < first:
        return Holding(0.0, 0.0, "trials", _who(tried), tuple(tried))
    halved = _halve(wound, tried[first], tried[first - 1], close) if first > 0 else []
    low = halved[-1].revolutions if halved else 0.0
    if last + 1 == len(tried):
        return Holding(low, float("inf"), "trials", "", _sorted([*tried, *halved]))
    above = _halve(wound, tried[last], tried[last + 1], close)
    slides = _who([each for each in (*above, tried[last + 1]) if not each.holds])
    return Holding(low, above[-1].revolutions, "trials", slides, _sorted([*tried, *halved, *above]))


def _sorted(tried: list[Trial]) -> tuple[Trial, ...]:
    return tuple(sorted(set(tried), key=lambda each: each.revolutions))


def _halve(wound: Wound, holds: Trial, fails: Trial, close: float) -> list[Trial]:
    """The windings tried between one that holds and one that does not; the last holds, next to one that does not."""
    tried = []
    while abs(fails.revolutions - holds.revolutions) > close:
        middle = wound(0.5 * (holds.revolutions + fails.revolutions))
        tried.append(middle)
        holds, fails = (middle, fails) if middle.holds else (holds, middle)
    return [*tried, holds]


def _longest_run(flags: list[bool]) -> tuple[int, int]:
    """First and last index of the longest run of True; (0, -1) where there is none."""
    change = np.flatnonzero(np.diff([0, *map(int, flags), 0]))
    if not len(change):
        return 0, -1
    starts, stops = change[::2], change[1::2]
    best = int(np.argmax(stops - starts))
    return int(starts[best]), int(stops[best]) - 1


def _who(failed: list[Trial]) -> str:
    return _ends(any(each.slid[0] for each in failed), any(each.slid[1] for each in failed))


def _ends(start: bool, end: bool) -> str:
    return {(True, True): "both", (True, False): "start", (False, True): "end", (False, False): ""}[start, end]


def opened(surface: Surface, wider: float, ends: str = "both") -> Surface | None:
    """The surface cut back to where its rings are `wider` times as long as its rims, at the ends named.

    None where it never widens so far.
    """
    v = np.linspace(0.0, 1.0, 201)
    u = np.arange(48) / 48
    uv = np.stack(np.meshgrid(v, u, indexing="ij")[::-1], axis=2).reshape(-1, 2)
    ring = np.linalg.norm(surface.frames(uv)[:, 1], axis=1).reshape(len(v), -1).mean(axis=1)
    first = _reach(v, ring, wider) if ends in ("start", "both") else 0.0
    last = 1.0 - _reach(v, ring[::-1], wider) if ends in ("end", "both") else 1.0
    if not first < last - 0.05:
        return None

    def formula(around: Floats, along: Floats) -> Floats:
        where = np.stack([around, first + (last - first) * along], axis=-1)
        return surface.points(where.reshape(-1, 2)).reshape(*where.shape[:-1], 3)

    cut = interpolate(formula, surface.spans, surface.periodic)
    return replace(cut, error=surface.error)


def _reach(v: Floats, ring: Floats, wider: float) -> float:
    """The first v at which the ring is so many times the rim's length; 1 where none is."""
    wide = np.flatnonzero(ring >= wider * ring[0])
    if not len(wide):
        return 1.0
    k = int(wide[0])
    share = (wider * ring[0] - ring[k - 1]) / (ring[k] - ring[k - 1])
    return float(v[k - 1] + share * (v[k] - v[k - 1]))
