"""Helical paths between two level lines: revolutions for an angle, and as many paths as cover the part."""

from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.core.progress import Progress, silent
from meshwind.filament.cap_turn import passes_on_caps
from meshwind.filament.ends import CAP, LayerPlan, Wish
from meshwind.filament.levels import Levels, station, with_v
from meshwind.filament.settling import SCOUTS_PER_TURN
from meshwind.filament.stations import circuits_to_cover, median_angle, wound_angle
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction, friction_of
from meshwind.planning.families import families
from meshwind.surface import Surface
from meshwind.workflow.angle_search import Hunt, hunt, survey
from meshwind.workflow.angle_trials import MOST, Trials, Tried
from meshwind.workflow.notes import Note

_PARTICLES = 401
"""Particles of a trial's path: fewer do not come to rest round the edges of a flat part, and take longer to say so."""
_TRIAL_PATHS, _ROUGH_PATHS, _FEWEST_PATHS = 24, 8, 4
"""Paths a family at most with which revolutions and the number of paths are found, those that a search begins with, and
with friction, which takes long: it keeps neighbours alike, so that fewer tell the angle of all.
"""
_ON_CAPS = 23
"""Circuits over caps with which those that cover are counted: a prime, next to which many turns close."""
_COUNTED_PATHS = 96
"""Paths a family with which those that cover are counted: on the sample parts within 0.03 % of as many as one likes."""
_FURTHEST = 4.0
"""Revolutions over those of the angle on a tube as long and as wide, beyond which none are tried.

A fibre that needs more winds on and on at a narrow place, and hardly gets steeper at the widest.
"""
_PAST = 2.0
"""Factor over the least revolutions at which paths do not come to rest, beyond which they are not tried again."""
_FEWEST = 1 / 200
"""Share of these that is tried at the least where the angle is not met: nearly none, along the part."""
_ABOUT = 1.3
"""Factor about the revolutions of a few paths within which those of more paths are looked for."""
_AS_WIDE = 1e-6
"""Share by which level lines may be shorter than the longest and still count as the widest place, ..."""
_CYLINDER, _LONG = 1e-3, 0.1
"""... and those by which, and over how much of the part, they may where it is a cylinder there.

A fit of a cylinder between domes is wider by some 2e-4 just beside these; 1e-3 of the width is 0.06 degrees at 45.
"""
_BACK = (0.02, 0.04, 0.07, 0.1, 0.13, 0.17, 0.22, 0.3)
"""Shares of the revolutions that are given up at a brink, as more paths and particles slide off sooner, ..."""
_ASIDE = (0.01, -0.01, 0.02, -0.02, 0.04, 0.07, 0.1, 0.13)
"""... those that are tried where the angle is met, but not with every path, ..."""
_MOVES = np.radians(1.5)
"""... up to this change of the angle, were the part a tube: next to a brink it changes by less, ..."""
_BRINK = 0.06
"""... how closely the brink is looked for where an angle is far beyond it, ..."""
_FOR_ALL = 0.05
"""... and the share that a few paths are worth which slide off, where some always do."""
_WITHIN_REACH = np.radians(3.0)
"""How short of an angle a few paths may fall for it to be tried with more of them, and all over the revolutions."""
_NEAR, _ROUGHLY = np.radians(0.05), np.radians(0.2)
"""How near an angle is to be met in the end and by the search's beginning, ..."""
_ENOUGH = np.radians(0.5)
"""... and how near without a warning, where paths that come to rest or not make the median leap."""


@dataclass(frozen=True)
class Turned:
    """Revolutions for an angle: where that is taken, v, the angle there that they give, and why it is no nearer.

    reached, asked: in radians; lost: least revolutions with which paths did not come to rest, infinite without any;
    had: least and largest angle of the trials in which they did.
    """

    revolutions: float
    v: float
    asked: float
    reached: float
    lost: float = np.inf
    had: tuple[float, float] = (np.nan, np.nan)

    @property
    def met(self) -> bool:
        """Whether the angle is met."""
        return abs(self.reached - self.asked) <= _ENOUGH

    @property
    def wish(self) -> Wish | None:
        """The angle that a filament is to have; none where fibres run along the part."""
        wanted = self.asked if self.met else self.reached
        return Wish(self.v, wanted) if self.revolutions > 0.0 and wanted > 0.0 else None

    @property
    def shortfall(self) -> str:
        """What is wound instead of the angle that was asked for, and why; "" where that is met."""
        if self.met:
            return ""
        if self.reached > self.asked:
            why = "neither fewer revolutions nor more bring it nearer"
        elif np.isfinite(self.lost):
            why = f"at {self.lost:.4g} paths slide off or are unstable, more than {1.0 - MOST:.0%} of them"
        else:
            why = f"up to {_FURTHEST:g} times the revolutions of a tube were tried"
        low, high = np.degrees(self.had)
        return (
            f"its angle of {np.degrees(self.asked):g} degrees is out of reach at v={self.v:.3g}: wound at "
            f"{np.degrees(self.reached):.2f} degrees with {self.revolutions:.4g} revolutions, the nearest found; "
            f"{why}; trials held at {low:.1f} to {high:.1f} degrees; give more friction, wider openings, another place "
            "or another angle"
        )

    def taken(self, place: str | None = None) -> str:
        """The revolutions that an angle takes which is met; place: where it was asked for, None for the widest."""
        where = f"v={self.v:.3g}, the widest place," if place is None else with_v(place, self.v)
        return f"{np.degrees(self.asked):g} degrees at {where} take {self.revolutions:.6g} revolutions"

    def moved(self, paths: Paths) -> tuple[Note, ...]:
        """Note on the angle that paths have at the place, where it is another one as a filament closes with it."""
        now = wound_angle(paths, self.v)
        wanted = self.asked if self.met else self.reached
        if abs(now - wanted) <= _ENOUGH:
            return ()
        return (
            Note(
                f"the filament closes at {np.degrees(now):.2f} degrees at v={self.v:.3g} instead of "
                f"{np.degrees(wanted):.2f}; give another number of paths, or one of the patterns above",
                warning=True,
            ),
        )


class Settled(NamedTuple):
    """Paths a family, their revolutions, and those of an angle if one was asked for."""

    paths: int
    revolutions: float
    turned: Turned | None

    @property
    def shortfall(self) -> str:
        """What is wound instead of an angle out of reach, or ""."""
        return "" if self.turned is None else self.turned.shortfall

    @property
    def wish(self) -> Wish | None:
        """The angle that a filament is to have."""
        return None if self.turned is None else self.turned.wish

    @property
    def taken(self) -> str:
        """The revolutions that an angle takes which is met, or ""."""
        return self.turned.taken() if self.turned is not None and self.turned.met else ""


@dataclass(frozen=True)
class Helices:
    """The helical paths of a layer, with any number of them and any revolutions; paths: those of the angle; say: told
    of each trial."""

    surface: Surface
    between: tuple[float, float]
    friction: float | Friction
    lines: Levels
    paths: int = _COUNTED_PATHS
    say: Progress = silent

    def laid(self, paths: int, revolutions: float, particles: int | None, which: Ints | None = None) -> Paths:
        """Lay both families, or some of their paths."""
        ends = families(self.surface, paths, revolutions, between=self.between)
        some = np.arange(len(ends.family)) if which is None else which
        start, end, family = ends.start[some], ends.end[some], ends.family[some]
        return solve(self.surface, start, end, family=family, particles=particles, friction=self.friction)

    def tried(self, revolutions: float, paths: int) -> Paths | None:
        """Trial paths, so many a family, that come to rest; None where none does."""
        laid = self._on_trial(paths, revolutions)
        held = laid.status == Status.CONVERGED
        return laid.subset(held) if held.any() else None

    def _on_trial(self, paths: int, revolutions: float, which: Ints | None = None) -> Paths:
        """Lay both families, or some of their paths, with enough particles a turn."""
        if which is None:  # some go before all
            self.say(f"{revolutions:.4g} revolutions")
        return self.laid(paths, revolutions, max(_PARTICLES, int(np.ceil(SCOUTS_PER_TURN * revolutions))), which)

    def _trials(self, paths: int, v: float) -> Trials:
        """Trials with at most so many paths a family, and the angle at v."""
        many = min(paths, self.paths)
        return Trials(partial(self._on_trial, many), lambda laid: median_angle(laid, v, self.paths), 2 * many)

    def settled(
        self,
        angle: float | None,
        revolutions: float | str | None,
        paths: int | str,
        width: float,
        turns: tuple[str, str] = (AUTO, AUTO),
    ) -> "Settled":
        """Paths a family and revolutions for an angle in degrees or for revolutions, with a band of this width.

        turns: the turnarounds of a filament at the start and the end.
        """
        turned = None if angle is None else self.turned_to(np.radians(angle))
        number = revolutions if turned is None else turned.revolutions
        assert isinstance(number, float)
        count = self.circuits(number, width, turns) if isinstance(paths, str) else paths
        return Settled(count, number, turned)

    def circuits(self, revolutions: float, width: float, turns: tuple[str, str] = (AUTO, AUTO)) -> int:
        """Paths a family that cover the part with a band of this width; over caps they have an angle of their own."""
        if CAP in turns:
            few = LayerPlan(_ON_CAPS, revolutions, self.friction, turns=turns, clearance=0.5 * width)
            return circuits_to_cover(passes_on_caps(self.surface, few).paths, self.lines, width)
        trial = self.tried(revolutions, _COUNTED_PATHS)
        if trial is None:
            raise BadInputError(f"no path comes to rest at {revolutions:.4g} revolutions; give fewer, or more friction")
        return circuits_to_cover(trial, self.lines, width)

    def turned_to(self, angle: float, place: str | None = None) -> Turned:
        """Revolutions at which the median winding angle is as wanted, in radians, or as near as the part allows.

        place: where, as `station` reads it, or the widest place of the layer.  A few paths come first, and then those
        that tell the angle, most often once or twice.
        Raises BadInputError where too few paths come to rest at any revolutions.
        """
        v = self._widest if place is None else station(place, self.lines)
        tube = self._on_a_tube(angle)
        most = _FURTHEST * tube
        limits = _FEWEST * most, most
        few = _ROUGH_PATHS if friction_of(self.surface, self.friction).none else _FEWEST_PATHS
        rough, fine = self._trials(few, v), self._trials(_TRIAL_PATHS, v)
        found = _found(rough, angle, tube, (_ROUGHLY, _WITHIN_REACH), limits)
        if found.within or found.reached > angle - _WITHIN_REACH:
            start = found.revolutions
            found = _found(fine, angle, start, (_NEAR, 0.0), limits, _ABOUT)
        elif whole := [each for each in rough.counted if each.whole]:
            top = max(whole)
            found = found._replace(revolutions=top.revolutions, reached=top.angle)
        if not np.isfinite(found.reached):
            raise BadInputError(
                f"under {100 * MOST:.0f} % of the paths come to rest at {found.lost:.4g} revolutions, and at fewer; "
                "give more friction"
            )
        best = _held(fine, found, angle)
        angles = [each.angle for each in (*rough.counted, *fine.counted)]
        return Turned(best.revolutions, v, angle, best.angle, found.lost, (min(angles), max(angles)))

    @property
    def _inside(self) -> Bools:
        """Which of the level lines (k,) the layer passes; at least those about its middle."""
        lines, (low, high) = self.lines, self.between
        near: Bools = np.abs(lines.v - 0.5 * (low + high)) <= 1.0 / len(lines.v)
        return near | ((lines.v >= low) & (lines.v <= high))

    @property
    def _widest(self) -> float:
        """The v of the widest place of the layer: of several the one nearest to its middle."""
        v, length = self.lines.v[self._inside], self.lines.length[self._inside]
        wide = v[length >= length.max() * (1.0 - _CYLINDER)]
        if np.ptp(wide) < _LONG:
            wide = v[length >= length.max() * (1.0 - _AS_WIDE)]
        return float(wide[int(np.argmin(np.abs(wide - 0.5 * sum(self.between))))])

    def _on_a_tube(self, angle: float) -> float:
        """Revolutions of an angle in radians on a tube as long as the layer and as wide as it is on average."""
        low, high = np.interp(self.between, self.lines.v, self.lines.mean)
        return float(np.tan(angle) * (high - low) / self.lines.length[self._inside].mean())


def _found(
    trials: Trials,
    angle: float,
    start: float,
    reach: tuple[float, float],
    limits: tuple[float, float],
    about: float = np.inf,
) -> Hunt:
    """The revolutions next to an angle: from a start on and, where that does not meet it, all over.

    reach: how near the angle is to be met, and how short of it a brink may be for that, in radians; limits: least and
    most revolutions; about: the factor about those that were found within which others are looked for.
    """
    (near, short), (low, most) = reach, limits
    best = hunt(trials.angle, angle, start, near, most, least=low, brink=_BRINK)
    at_a_brink = np.isfinite(best.lost) and best.reached < angle
    if abs(best.reached - angle) <= _ENOUGH or (at_a_brink and best.reached < angle - short):
        return best
    low, high = max(low, start / about), min(most, _PAST * best.lost, start * about)
    return survey(trials.angle, angle, near, (low, max(high, 2.0 * low)), best)


def _held(trials: Trials, found: Hunt, angle: float) -> Tried:
    """The trial next to an angle at which every path is at rest, or else most are.

    An angle that is out of reach, or can be had to half a degree without, is not worth paths that slide off.
    """

    def off(each: Tried) -> float:
        return abs(each.angle - angle)

    whole = [each for each in trials.counted if each.whole]
    near = [each for each in whole if off(each) <= _ENOUGH]
    if near:
        return min(near, key=off)
    if found.reached > angle + _ENOUGH:
        return min([*whole, trials.at(found.revolutions)], key=off)
    best = trials.at(found.revolutions)
    met = best.counts and off(best) <= _ENOUGH

    def good(each: Tried) -> bool:
        return each.counts and (off(each) <= _ENOUGH or not met)

    aside = [share for share in _ASIDE if abs(share) * np.sin(2.0 * angle) <= 2.0 * _MOVES]
    for share in aside if met else _BACK:
        if best.whole:
            break
        turns = (1.0 - share) * found.revolutions
        now = trials.if_whole(turns) if best.counts else trials.at(turns)
        best = best if now is None or not good(now) else now
    if not best.counts:
        return Tried(found.revolutions, found.reached, best.held)
    if not (best.whole or met):
        trials.at((1.0 - _FOR_ALL) * found.revolutions)
    others = [each for each in trials.counted if each.held > best.held and good(each)]
    return min(others, key=lambda each: (-each.held, off(each)), default=best)
