"""Helical paths between two level lines: revolutions for an angle, and as many paths as cover the part."""

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.filament.levels import Levels, station
from meshwind.filament.stations import angles_at, circuits_to_cover
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction
from meshwind.planning.families import families
from meshwind.surface import Surface
from meshwind.workflow.notes import Note

_TRIAL_PATHS, _TRIAL_PARTICLES = 24, 101
"""Paths a family at most, and their particles, with which revolutions and the number of paths are found."""
_COUNTED_PATHS = 96
"""Paths a family with which those that cover are counted: on the sample parts within 0.03 % of as many as one likes."""
_TRIALS = 30
"""Trials for an angle; each brings it nearer by a factor of about ten on smooth parts."""
_SAME_TURNS = 1e-3
"""Share by which revolutions differ where a search between them ends."""
_HALVINGS = 10
"""Halvings that find where the first path slides off: to a thousandth of the revolutions."""
_AS_WIDE = 1e-6
"""Share by which level lines may be shorter than the longest and still count as the widest place."""
_NEAR = np.radians(0.05)
"""How near an angle is to be met, ..."""
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
    def shortfall(self) -> str:
        """What is wound instead of the angle that was asked for, and why; "" where that is met."""
        if self.met:
            return ""
        if self.reached > self.asked:
            why = f"fewer revolutions than {self.revolutions:.4g} bring it no nearer"
        elif np.isfinite(self.lost):
            why = f"at {self.lost:.4g} paths slide off or are unstable"
        else:
            why = "more bring it no nearer"
        return (
            f"its angle of {np.degrees(self.asked):g} degrees is out of reach at v={self.v:.3g}: wound at "
            f"{np.degrees(self.reached):.2f} degrees with {self.revolutions:.4g} revolutions, the nearest found; "
            f"{why}; give more friction, wider openings, another place or another angle"
        )

    def moved(self, paths: Paths) -> tuple[Note, ...]:
        """Note on the angle that paths have at the place, where it is another one as a filament closes with it."""
        now = float(np.nanmedian(angles_at(paths, np.array([self.v]))))
        if abs(now - self.reached) <= _ENOUGH:
            return ()
        return (
            Note(
                f"the filament closes at {np.degrees(now):.2f} degrees at v={self.v:.3g} instead of "
                f"{np.degrees(self.reached):.2f}; give another number of paths, or one of the patterns above",
                warning=True,
            ),
        )


class Settled(NamedTuple):
    """Paths a family, their revolutions, and what is wound instead of an angle that is out of reach, or ""."""

    paths: int
    revolutions: float
    shortfall: str


@dataclass(frozen=True)
class Helices:
    """The helical paths of a layer, with any number of them and any revolutions; paths: of trials, a family."""

    surface: Surface
    between: tuple[float, float]
    friction: float | Friction
    lines: Levels
    paths: int = _TRIAL_PATHS

    def laid(self, paths: int, revolutions: float, particles: int | None) -> Paths:
        """Lay both families."""
        ends = families(self.surface, paths, revolutions, between=self.between)
        return solve(
            self.surface, ends.start, ends.end, family=ends.family, particles=particles, friction=self.friction
        )

    def tried(self, revolutions: float, paths: int) -> Paths | None:
        """Trial paths, so many a family, or None where none of them comes to rest."""
        laid = self.laid(paths, revolutions, _TRIAL_PARTICLES)
        held = laid.status == Status.CONVERGED
        return laid.subset(held) if held.any() else None

    def settled(
        self, angle: float | None, revolutions: float | str | None, paths: int | str, width: float
    ) -> "Settled":
        """Paths a family and revolutions for an angle in degrees or for revolutions, with a band of this width."""
        turned = None if angle is None else self.turned_to(np.radians(angle))
        turns = revolutions if turned is None else turned.revolutions
        assert isinstance(turns, float)
        count = self.circuits(turns, width) if isinstance(paths, str) else paths
        return Settled(count, turns, "" if turned is None else turned.shortfall)

    def circuits(self, revolutions: float, width: float) -> int:
        """Paths a family that cover the part with a band of this width."""
        trial = self.tried(revolutions, _COUNTED_PATHS)
        if trial is None:
            raise BadInputError(f"no path comes to rest at {revolutions:.4g} revolutions; give fewer, or more friction")
        return circuits_to_cover(trial, self.lines, width)

    def turned_to(self, angle: float, place: str | None = None) -> Turned:
        """Revolutions at which the median winding angle is as wanted, in radians, or as near as the part allows.

        place: where, as `station` reads it, or the widest place of the layer: of several the one nearest to its middle.
        Raises BadInputError where no path comes to rest at all.
        """
        lines, (low, high) = self.lines, self.between
        inside = (lines.v >= low) & (lines.v <= high)
        inside |= np.abs(lines.v - 0.5 * (low + high)) <= 1.0 / len(lines.v)
        longest = lines.length[inside].max() * (1.0 - _AS_WIDE)
        wide = lines.v[inside][lines.length[inside] >= longest]
        widest = wide[int(np.argmin(np.abs(wide - 0.5 * (low + high))))]
        at = np.array([widest if place is None else station(place, lines)])
        along = float(np.interp(high, lines.v, lines.mean) - np.interp(low, lines.v, lines.mean))
        turns = float(np.tan(angle) * along / float(lines.length[inside].mean()))
        low_turns, high_turns, lost = 0.0, np.inf, np.inf
        best, reached = 0.0, -np.inf
        for _ in range(_TRIALS):
            trial = self.tried(turns, min(self.paths, _TRIAL_PATHS))
            if trial is None:
                lost = high_turns = min(lost, turns)
                turns = 0.5 * (low_turns + lost)
                if lost - low_turns < _SAME_TURNS * lost:
                    break
                continue
            now = float(np.nanmedian(angles_at(trial, at)))
            if abs(now - angle) < abs(reached - angle):
                best, reached = turns, now
            if abs(now - angle) <= _NEAR:
                break
            low_turns, high_turns = (turns, high_turns) if now < angle else (low_turns, turns)
            turns *= float(np.clip(np.tan(angle) / max(np.tan(now), _NEAR), 0.5, 2.0))
            if not low_turns < turns < high_turns:
                turns = 0.5 * (low_turns + high_turns)
            if high_turns - low_turns < _SAME_TURNS * high_turns:
                break
        if not np.isfinite(reached):
            raise BadInputError(f"no path comes to rest at {lost:.4g} revolutions and below; give more friction")
        found = Turned(best, float(at[0]), angle, reached, lost)
        return found if found.met else self._steepest(found)

    def _steepest(self, found: Turned) -> Turned:
        """The most revolutions up to those found at which every trial path is at rest; those found if there are none.

        An angle that is out of reach is not worth paths that slide off.
        """
        low, high, best = 0.0, found.revolutions, found
        turns, lost = high, found.lost
        for _ in range(_HALVINGS):
            laid = self.laid(_TRIAL_PATHS, turns, _TRIAL_PARTICLES)
            if (laid.status == Status.CONVERGED).all():
                low, reached = turns, float(np.nanmedian(angles_at(laid, np.array([found.v]))))
                best = replace(found, revolutions=turns, reached=reached)
            else:
                high = lost = turns
            if low == high:
                break
            turns = 0.5 * (low + high)
        return replace(best, lost=lost) if low > 0.0 else found
