"""How a user turns the ends of paths: by another number of revolutions, or each by a share of its own turn."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from meshwind.core.cast import Floats
from meshwind.path.asked import Asked
from meshwind.surface.rims import Rim, rim
from meshwind.surface.surface import Surface

_ALIKE = 1e-9
"""Turns that differ by less are one number."""
_DIGITS = 6
"""Most digits of a number of revolutions that somebody asks for."""


@dataclass(frozen=True)
class Turning:
    """The turns of all paths: one number, or each its own.

    revolutions: the number that all turn by, 0 where they differ.  by_length: whether ends are spread over the rims by
    arc length, as `families` does, so that only the mean change of u is the number of revolutions.
    """

    surface: Surface
    asked: Asked
    revolutions: float
    by_length: bool

    def ends(self, turn: float) -> Floats:
        """Ends (p, 2) with another number of revolutions or, where turns differ, with so much of each path's own."""
        start, end = self.asked.start, self.asked.end
        if self.by_length:
            share = self.rims[0].shares(start[:, 0])
            return _with_u(end, self.rims[1].parameters(share + np.sign(end[:, 0] - start[:, 0]) * turn))
        if self.revolutions > 0.0:
            return self.ends_by_u(turn)
        return _with_u(end, start[:, 0] + turn * (end[:, 0] - start[:, 0]))

    def ends_by_u(self, turn: float) -> Floats:
        """Ends (p, 2) with u changed by just the number of revolutions."""
        start, end = self.asked.start, self.asked.end
        return _with_u(end, start[:, 0] + np.sign(end[:, 0] - start[:, 0]) * turn)

    @cached_property
    def rims(self) -> tuple[Rim, Rim]:
        """The rims at both ends."""
        return rim(self.surface, 0.0), rim(self.surface, 1.0)


def turning(surface: Surface, asked: Asked) -> Turning | None:
    """How the ends turn; None where they cannot be turned, as with curves given, or where no path turns."""
    if asked.initial is not None or not asked.turns or not len(asked):
        return None
    start, end = asked.start, asked.end
    turn = np.abs(end[:, 0] - start[:, 0])
    if not turn.max() > _ALIKE:
        return None
    alike, number = np.ptp(turn) <= _ALIKE, float(turn.mean())
    if surface.periodic and not start[:, 1].any() and (end[:, 1] == 1.0).all():
        share = np.abs(rim(surface, 1.0).shares(end[:, 0]) - rim(surface, 0.0).shares(start[:, 0]))
        spread = float(share.mean())
        # a single path, or some on a symmetric part, turn alike both ways: one of the two was asked for
        if np.ptp(share) <= _ALIKE and not (alike and (_plain(number) or not _plain(spread))):
            return Turning(surface, asked, spread, True)
    return Turning(surface, asked, number if alike else 0.0, False)


def _plain(number: float) -> bool:
    """Whether a number has few digits."""
    return abs(number - float(f"{number:.{_DIGITS}g}")) <= _ALIKE


def _with_u(end: Floats, u: Floats) -> Floats:
    return np.stack([u, end[:, 1]], axis=1)
