"""How a user turns the ends of paths: by another number of revolutions, or each by a share of its own turn."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.path.asked import Asked
from meshwind.surface.rims import rim
from meshwind.surface.surface import Surface

_ALIKE = 1e-9
"""Turns that differ by less are one number."""


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

    def ends(self, turn: float) -> list[Floats]:
        """Ends (p, 2) with another number of revolutions or, where turns differ, with so much of each path's own.

        Where ends are spread by arc length, both as `families` sets them and with u changed by just that number.
        """
        start, end = self.asked.start, self.asked.end
        if self.revolutions == 0.0:
            return [_with_u(end, start[:, 0] + turn * (end[:, 0] - start[:, 0]))]
        sense = np.sign(end[:, 0] - start[:, 0])
        found = [_with_u(end, start[:, 0] + sense * turn)]
        if self.by_length:
            share = rim(self.surface, 0.0).shares(start[:, 0])
            found.append(_with_u(end, rim(self.surface, 1.0).parameters(share + sense * turn)))
        return found


def turning(surface: Surface, asked: Asked) -> Turning | None:
    """How the ends turn; None where curves were given, which say how a path turns, or where no path turns."""
    if asked.initial is not None or not len(asked):
        return None
    start, end = asked.start, asked.end
    turn = np.abs(end[:, 0] - start[:, 0])
    if not turn.max() > _ALIKE:
        return None
    if np.ptp(turn) <= _ALIKE:
        return Turning(surface, asked, float(turn.mean()), False)
    if surface.periodic and not start[:, 1].any() and (end[:, 1] == 1.0).all():
        share = np.abs(rim(surface, 1.0).shares(end[:, 0]) - rim(surface, 0.0).shares(start[:, 0]))
        if np.ptp(share) <= _ALIKE:
            return Turning(surface, asked, float(share.mean()), True)
    return Turning(surface, asked, 0.0, False)


def _with_u(end: Floats, u: Floats) -> Floats:
    return np.stack([u, end[:, 1]], axis=1)
