"""Shorter spans in hollows: where a span would meet the part beyond one, the eye goes in between."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.vectors import unit
from meshwind.program.clear import Obstacle
from meshwind.program.eye import Spans
from meshwind.program.head import within
from meshwind.program.mandrel import Mandrel

_PLACES = 16
"""Places on the way to the part at which it is seen how much room the eye has."""
_ENOUGH = 0.5
"""Distance from the part, over the clearance, with which the eye goes no deeper into a hollow."""
_APART = 1e-3
"""Distance of two places, over that from which the part is surely not met, that tells which way leads away from it."""


def in_hollows(spans: Spans, blocked: Obstacle, mandrel: Mandrel, clearance: float, lift: float) -> Spans:
    """Spans that end before they meet a part that turns on a mandrel; see `Spans` for the lift."""
    found = _Hollows(spans, blocked, mandrel, clearance)
    return Spans(found, lift, found.off)


@dataclass(frozen=True)
class _Hollows:
    """Lengths of spans that end before they meet a part."""

    spans: Spans
    blocked: Obstacle
    mandrel: Mandrel
    clearance: float

    def __call__(self, points: Floats, rays: Floats) -> tuple[Floats, Floats]:
        """Lengths (n,) as wanted, and the most that may be."""
        wanted, most = self.spans.find(points, rays)
        start, ahead = self.mandrel.outside(points), rays @ self.mandrel.frame
        free = self.blocked.free(start, ahead)
        short = np.flatnonzero(free < np.minimum(wanted, most))
        most[short] = self._roomy(start[short], ahead[short], free[short])
        return wanted, most

    def off(self, eyes: Floats) -> Floats:
        """How eyes (n, 3) are still to move (n, 3) off the part, straight away from it, in the mandrel's frame."""
        outside, surface = self.mandrel.outside(eyes), self.blocked.surface
        away = surface.distances(frozen(outside))
        inside = within(surface, outside, unit(eyes * [0.0, 1.0, 1.0]) @ self.mandrel.frame)
        lacks = self.blocked.sure - np.where(inside, -away, away)
        close = np.flatnonzero(lacks > 0.0)
        step = _APART * self.blocked.sure * np.eye(3)
        sides = outside[close, None, None] + np.stack([step, -step])
        far = surface.distances(frozen(sides.reshape(-1, 3))).reshape(-1, 2, 3)
        slope = unit(far[:, 0] - far[:, 1]) * np.where(inside[close], -1.0, 1.0)[:, None]
        move = np.zeros_like(eyes)
        move[close] = lacks[close, None] * self.mandrel.turned(slope)
        return move

    def _roomy(self, start: Floats, ahead: Floats, free: Floats) -> Floats:
        """The longest spans (n,) with room enough for the eye, or those with most, on rays free up to a length (n,).

        Infinity where there is none: the fibre's line goes below the surface.
        """
        lengths = free[:, None] * np.arange(1, _PLACES) / _PLACES
        eyes = start[:, None] + lengths[:, :, None] * ahead[:, None]
        room = self.blocked.surface.distances(eyes.reshape(-1, 3)).reshape(lengths.shape)
        best = np.minimum(room, _ENOUGH * self.clearance)
        number, last = np.arange(len(free)), best.shape[1] - 1 - np.argmax(best[:, ::-1], axis=1)
        # a ray may run between skin and surface before it meets the skin
        return np.where(room[number, last] > self.blocked.sure, lengths[number, last], np.inf)
