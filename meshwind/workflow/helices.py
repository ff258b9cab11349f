"""Helical paths between two level lines: revolutions for an angle, and as many paths as cover the part."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.filament.levels import Levels, station
from meshwind.filament.stations import angles_at, circuits_to_cover
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction
from meshwind.planning.families import families
from meshwind.surface import Surface

_TRIAL_PATHS, _TRIAL_PARTICLES = 24, 101
"""Paths a family at most, and their particles, with which revolutions and the number of paths are found."""
_TRIALS = 30
"""Trials for an angle; each brings it nearer by a factor of about ten on smooth parts."""
_AS_WIDE = 1e-6
"""Share by which level lines may be shorter than the longest and still count as the widest place."""
_NEAR = np.radians(0.05)
"""How near an angle is to be met, ..."""
_ENOUGH = np.radians(0.5)
"""... and how near it has to be, where paths that come to rest or not make the median leap."""


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

    def tried(self, revolutions: float) -> Paths | None:
        """Some paths, or None where none of them comes to rest."""
        paths = self.laid(min(self.paths, _TRIAL_PATHS), revolutions, _TRIAL_PARTICLES)
        held = paths.status == Status.CONVERGED
        return paths.subset(held) if held.any() else None

    def settled(
        self, angle: float | None, revolutions: float | str | None, paths: int | str, width: float
    ) -> tuple[int, float]:
        """Paths a family and revolutions for an angle in degrees or for revolutions, with a band of this width."""
        turns = revolutions if angle is None else self.revolutions_at(np.radians(angle))
        assert isinstance(turns, float)
        return (self.circuits(turns, width) if isinstance(paths, str) else paths), turns

    def circuits(self, revolutions: float, width: float) -> int:
        """Paths a family that cover the part with a band of this width."""
        trial = self.tried(revolutions)
        if trial is None:
            raise BadInputError(f"no path comes to rest at {revolutions:.4g} revolutions; give fewer, or more friction")
        return circuits_to_cover(trial, self.lines, width)

    def revolutions_at(self, angle: float, place: str | None = None) -> float:
        """Revolutions at which the median winding angle is as wanted, in radians.

        place: where, as `station` reads it, or the widest place of the layer; raises BadInputError where the part does
        not allow the angle, with what it allows.
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
            trial = self.tried(turns)
            if trial is None:
                lost = high_turns = min(lost, turns)
                turns = 0.5 * (low_turns + lost)
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
        if abs(reached - angle) <= _ENOUGH:
            return best
        raise BadInputError(
            f"its angle of {np.degrees(angle):g} degrees is not met: {np.degrees(reached):.2f} at {best:.4g} "
            f"revolutions{f', and past {lost:.4g} no path comes to rest' if np.isfinite(lost) else ''}; give another "
            "angle, or more friction"
        )
