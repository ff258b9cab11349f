"""Helical paths between two level lines: revolutions for an angle, and as many paths as cover the part."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.core.progress import Progress, silent
from meshwind.filament.cap_turn import passes_on_caps
from meshwind.filament.ends import CAP, LayerPlan, Wish
from meshwind.filament.levels import Levels, station
from meshwind.filament.settling import SCOUTS_PER_TURN
from meshwind.filament.stations import angles_at, circuits_to_cover, median_angle
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction
from meshwind.planning.families import families
from meshwind.surface import Surface
from meshwind.workflow.angle_search import Hunt, hunt, survey
from meshwind.workflow.notes import Note

_PARTICLES = 401
"""Particles of a trial's path: fewer do not come to rest round the edges of a flat part, and take longer to say so."""
_TRIAL_PATHS, _ROUGH_PATHS = 24, 8
"""Paths a family at most with which revolutions and the number of paths are found, and those that a search begins with.
"""
_MOST = 0.75
"""Share of the paths that are to come to rest for their angle to count: a layer is not wound with a few of them."""
_FIRST = (0.0, 0.2, 0.6, 0.9)
"""Places in the order of a trial's paths of those that go first: where one at most comes to rest, most will not."""
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
"""Share by which level lines may be shorter than the longest and still count as the widest place."""
_BACK = (0.02, 0.04, 0.07, 0.1, 0.13, 0.17, 0.22, 0.3)
"""Shares of the revolutions that are given up at a brink, as more paths and particles slide off sooner, ..."""
_FOR_ALL = 0.05
"""... and the largest share that the last path which slides off is worth."""
_NEAR, _ROUGHLY = np.radians(0.05), np.radians(0.2)
"""How near an angle is to be met in the end and by the search's beginning, ..."""
_ENOUGH = np.radians(0.5)
"""... and how near without a warning, where paths that come to rest or not make the median leap."""


@dataclass(frozen=True)
class Turned:
    """Revolutions for an angle: where that is taken, v, the angle there that they give, and why it is no nearer.

    reached, asked: in radians; lost: least revolutions with which paths did not come to rest, infinite without any.
    """

    revolutions: float
    v: float
    asked: float
    reached: float
    lost: float = np.inf

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
            why = f"at {self.lost:.4g} paths slide off or are unstable, more than {1.0 - _MOST:.0%} of them"
        else:
            why = f"up to {_FURTHEST:g} times the revolutions of a tube were tried"
        return (
            f"its angle of {np.degrees(self.asked):g} degrees is out of reach at v={self.v:.3g}: wound at "
            f"{np.degrees(self.reached):.2f} degrees with {self.revolutions:.4g} revolutions, the nearest found; "
            f"{why}; give more friction, wider openings, another place or another angle"
        )

    def moved(self, paths: Paths) -> tuple[Note, ...]:
        """Note on the angle that paths have at the place, where it is another one as a filament closes with it."""
        now = float(np.nanmedian(angles_at(paths, np.array([self.v]))))
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
    """Paths a family, their revolutions, what is wound instead of an angle out of reach, or "", and the angle."""

    paths: int
    revolutions: float
    shortfall: str
    wish: Wish | None


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

    def tried(self, revolutions: float, paths: int, most: float = 0.0) -> Paths | None:
        """Trial paths, so many a family, that come to rest; None where none does, or not a share `most` of them."""
        self.say(f"{revolutions:.4g} revolutions")
        if most > 0.0:
            first = self._on_trial(paths, revolutions, (np.array(_FIRST) * 2 * paths).astype(np.int64))
            if np.count_nonzero(first.status == Status.CONVERGED) <= 1:
                return None
        laid = self._on_trial(paths, revolutions)
        held = laid.status == Status.CONVERGED
        return laid.subset(held) if held.any() and held.mean() >= most else None

    def _on_trial(self, paths: int, revolutions: float, which: Ints | None = None) -> Paths:
        """Lay both families, or some of their paths, with enough particles a turn."""
        return self.laid(paths, revolutions, max(_PARTICLES, int(np.ceil(SCOUTS_PER_TURN * revolutions))), which)

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
        return Settled(count, number, *(("", None) if turned is None else (turned.shortfall, turned.wish)))

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

        def found_with(paths: int, start: float, near: float, span: tuple[float, float]) -> Hunt:
            def measure(turns: float) -> float | None:
                trial = self.tried(turns, min(self.paths, paths), _MOST)
                return None if trial is None else median_angle(trial, v, self.paths)

            best = hunt(measure, angle, start, near, most)
            at_a_brink = np.isfinite(best.lost) and best.reached < angle
            if abs(best.reached - angle) <= _ENOUGH or at_a_brink:
                return best
            return survey(measure, angle, near, (span[0], max(min(span[1], _PAST * best.lost), 2.0 * span[0])), best)

        found = found_with(_ROUGH_PATHS, tube, _ROUGHLY, (_FEWEST * most, most))
        if found.within or found.reached > angle:
            start = found.revolutions
            found = found_with(_TRIAL_PATHS, start, _NEAR, (start / _ABOUT, start * _ABOUT))
        if not np.isfinite(found.reached):
            raise BadInputError(
                f"under {100 * _MOST:.0f} % of the paths come to rest at {found.lost:.4g} revolutions, and at fewer; "
                "give more friction"
            )
        turned = Turned(found.revolutions, v, angle, found.reached, found.lost)
        return turned if turned.met else self._steepest(turned)

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
        wide = v[length >= length.max() * (1.0 - _AS_WIDE)]
        return float(wide[int(np.argmin(np.abs(wide - 0.5 * sum(self.between))))])

    def _on_a_tube(self, angle: float) -> float:
        """Revolutions of an angle in radians on a tube as long as the layer and as wide as it is on average."""
        low, high = np.interp(self.between, self.lines.v, self.lines.mean)
        return float(np.tan(angle) * (high - low) / self.lines.length[self._inside].mean())

    def _steepest(self, found: Turned) -> Turned:
        """A little less than the revolutions found, at which every path is at rest, or else most are.

        An angle that is out of reach is not worth paths that slide off.
        """
        best, most = found, 0.0
        at_a_brink = np.isfinite(found.lost) and found.reached < found.asked
        for share in _BACK if at_a_brink else (0.0,):
            if most and share > _FOR_ALL:
                break
            turns = (1.0 - share) * found.revolutions
            trial = self.tried(turns, min(self.paths, _TRIAL_PATHS), _MOST)
            if trial is not None and len(trial) > most:
                reached = median_angle(trial, found.v, self.paths)
                best, most = replace(found, revolutions=turns, reached=reached), len(trial)
            if most == 2 * min(self.paths, _TRIAL_PATHS):
                break
        return best
