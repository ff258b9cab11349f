"""Turnarounds on a collar: friction steers the fibre to a hoop, which dwells, and back again."""

from dataclasses import dataclass, field

import numpy as np

from meshwind.core.cast import Floats
from meshwind.filament.course import Courses, Kind, in_turn
from meshwind.filament.edge import Edge, Legs
from meshwind.filament.turnaround import Catch, Place, on_prism, straight

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

    @property
    def catch(self) -> Catch:
        """See `Turnaround.catch`."""
        return Catch()

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """Turns (n,) to spare beyond the two legs and the stretch that levels them."""
        (in_, up), (out, down) = (self.reached(legs, np.zeros(len(legs))) for legs in (arriving, leaving))
        level = np.abs(down - up) / np.tan(_LEAN)
        return np.asarray((later - arriving.around - in_ - out - level) / self.edge.hull.perimeter)

    def reached(self, legs: Legs, lean: Floats) -> tuple[Floats, Floats]:
        """Length along the hull (n,) that legs take until they lean by (n,) short of a hoop, and their height there."""
        (around, height), _ = self._steered(legs, lean)
        return np.abs(around[:, -1] - legs.around), height[:, -1]

    def _steered(self, legs: Legs, lean: Floats) -> tuple[Place, Floats]:
        """Places and angles (n, m) of legs until they lean by (n,) short of a hoop; past it where that is negative."""
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
        return (around, height), at

    def _laid(self, steered: tuple[Place, Floats]) -> Courses:
        """The courses of steered legs."""
        (around, height), angle = steered
        count = np.full(len(around), around.shape[1])
        slip = np.full(around.size, self.slip)
        return on_prism(self.edge, (around.ravel(), height.ravel()), angle.ravel(), slip, count, Kind.TURN)

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> Courses:
        """See `Turnaround.courses`."""
        lean = np.zeros(len(later))
        for _ in range(_LEVELLING):
            (in_, up), (out, down) = self.reached(arriving, lean), self.reached(leaving, -lean)
            left = np.maximum(later - arriving.around - in_ - out, 1e-9 * self.edge.hull.perimeter)
            lean = np.clip(np.arctan2(down - up, left), -_LEAN, _LEAN)
        into, back = self._steered(arriving, lean), self._steered(leaving, -lean)
        back[0][0][...] += (later - leaving.around)[:, None]
        (there, up), (away, down) = ((around[:, -1], height[:, -1]) for (around, height), _ in (into, back))
        hoop = straight(self.edge, (there, up), (away, down), Kind.DWELL)
        self.reach = max(self.reach, float(max(into[0][1].max(), back[0][1].max())) - self.edge.highest)
        whole = in_turn([self._laid(into), hoop, self._laid(back).backwards], share=True)
        return whole.between(arriving.points, leaving.points)
