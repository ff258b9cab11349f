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


def in_hollows(spans: Spans, blocked: Obstacle, mandrel: Mandrel, clearance: float, lift: float) -> Spans:
    """Spans that end before they meet a part that turns on a mandrel; see `Spans` for the lift."""
    found = _Hollows(spans, blocked, mandrel, clearance)
    return Spans(found, lift, found.lacks)


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

    def lacks(self, eyes: Floats) -> Floats:
        """How far (n,) eyes (n, 3) in the mandrel's frame are still to move off the part."""
        off = eyes * [0.0, 1.0, 1.0]
        outside = self.mandrel.outside(eyes)
        away = self.blocked.surface.distances(frozen(outside))
        inside = within(self.blocked.surface, outside, unit(off) @ self.mandrel.frame)
        return np.asarray(np.maximum(self.blocked.sure - np.where(inside, -away, away), 0.0))

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
