"""Turnarounds on a collar: friction steers the fibre to a hoop, which dwells, and back again."""

from dataclasses import dataclass, field

import numpy as np

from meshwind.core.cast import Floats
from meshwind.filament.course import Course, Kind
from meshwind.filament.edge import Edge, Legs
from meshwind.filament.turnaround import Stretch, course, straight

_STEP = np.radians(2.0)
"""Turn of the normal between points of a steered leg: heights are then right to 1e-5."""
_LEAN = np.radians(10.0)
"""Most that the stretch between two legs may lean from a hoop, where they end at different heights."""
_LEVELLING = 20
"""Rounds in which the lean between two legs settles."""
_LEAST = np.radians(0.5)
"""Winding angle below which a leg is taken to have this one: a fibre along the axis is not steered at all."""


@dataclass
class Collar:
    """A collar as long as the turns need: the rim's hull, continued as a prism.

    Parameters
    ----------
    edge : Edge
        The prism.
    slip : float
        Slip |kg|/kn with which the fibre is steered, above 0 and at most the friction.
    """

    edge: Edge
    slip: float
    name: str = field(default="collar", init=False)
    rule: str = field(default="steered at a constant slip on a convex prism; the hoop needs none", init=False)
    reach: float = field(default=0.0, init=False)

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """Turns (n,) to spare beyond the two legs and the stretch that levels them."""
        (in_, up), (out, down) = (self.reached(legs, np.zeros(len(legs))) for legs in (arriving, leaving))
        level = np.abs(down - up) / np.tan(_LEAN)
        return np.asarray((later - arriving.around - in_ - out - level) / self.edge.hull.perimeter)

    def reached(self, legs: Legs, lean: Floats) -> tuple[Floats, Floats]:
        """Length along the hull (n,) that legs take until they lean by (n,) short of a hoop, and their height there."""
        steered = self._steered(legs, lean)
        return np.abs(steered.around[:, -1] - legs.around), steered.height[:, -1]

    def _steered(self, legs: Legs, lean: Floats) -> Stretch:
        """Legs (n, m) until they lean by (n,) short of a hoop; past it where that is negative."""
        angle = np.maximum(legs.angle, _LEAST)
        whole = (np.log(np.tan(0.5 * (0.5 * np.pi - lean))) - np.log(np.tan(0.5 * angle))) / self.slip
        whole = np.maximum(whole, 0.0)
        share = np.linspace(0.0, 1.0, int(np.ceil(whole.max(initial=0.0) / _STEP)) + 2)
        turned = whole[:, None] * share
        start = self.edge.hull.normal_angle(legs.around)[:, None]
        around = self.edge.hull.passed_at(start + legs.sense * turned)
        at = 2.0 * np.arctan(np.tan(0.5 * angle)[:, None] * np.exp(self.slip * turned))
        steps = np.abs(np.diff(around, axis=1))
        slope = 1.0 / np.tan(at)
        rise = np.cumsum(0.5 * (slope[:, 1:] + slope[:, :-1]) * steps, axis=1)
        height = legs.height[:, None] + np.concatenate([np.zeros((len(legs), 1)), rise], axis=1)
        return Stretch(around, height, at, np.full_like(at, self.slip), Kind.TURN)

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> list[Course]:
        """See `Turnaround.courses`."""
        lean = np.zeros(len(later))
        for _ in range(_LEVELLING):
            (in_, up), (out, down) = self.reached(arriving, lean), self.reached(leaving, -lean)
            left = np.maximum(later - arriving.around - in_ - out, 1e-9 * self.edge.hull.perimeter)
            lean = np.clip(np.arctan2(down - up, left), -_LEAN, _LEAN)
        into, back = self._steered(arriving, lean), self._steered(leaving, -lean)
        shift = later - leaving.around
        made = []
        for k in range(len(later)):
            there = Stretch(into.around[k], into.height[k], into.angle[k], into.slip[k], Kind.TURN)
            away = Stretch(back.around[k] + shift[k], back.height[k], back.angle[k], back.slip[k], Kind.TURN).backwards
            ends = [(float(one.around[i]), float(one.height[i])) for one, i in ((there, -1), (away, 0))]
            hoop = straight(ends[0], ends[1], self.edge, Kind.DWELL)
            made.append(course(self.edge, [there, hoop, away], arriving.points[k], leaving.points[k]))
        self.reach = max(self.reach, float(max(into.height.max(), back.height.max())) - self.edge.highest)
        return made
