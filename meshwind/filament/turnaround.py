"""What every turnaround is: the way of a fibre over a rim, from the end of one path to the start of the next."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from meshwind.core.cast import Floats
from meshwind.filament.course import Course, Kind
from meshwind.filament.edge import Edge, Legs

_STEP = np.radians(3.0)
"""Turn of the prism's normal between points of a straight stretch."""


@dataclass(frozen=True)
class Stretch:
    """A stretch of fibre on the unrolled prism, of n points: around, height, angle, slip (n,), and one kind."""

    around: Floats
    height: Floats
    angle: Floats
    slip: Floats
    kind: Kind

    @property
    def rest(self) -> "Stretch":
        """All points but the first."""
        return Stretch(self.around[1:], self.height[1:], self.angle[1:], self.slip[1:], self.kind)

    @property
    def backwards(self) -> "Stretch":
        """The same stretch from its last point to its first."""
        return Stretch(self.around[::-1], self.height[::-1], self.angle[::-1], self.slip[::-1], self.kind)


class Turnaround(Protocol):
    """A turnaround at one end of the part.

    name: its word of `core.defaults.TURNAROUNDS`; edge: the prism that it stands on; rule: how its hold is proved;
    slip: the largest friction that it needs.
    """

    name: str
    edge: Edge
    rule: str
    slip: float

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """Turns (n,) to spare from n legs that arrive to those that leave next, at lengths `later` along the hull."""
        ...

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> list[Course]:
        """The course from each of n legs that arrive to the one that leaves next, at a length `later` (n,)."""
        ...

    @property
    def reach(self) -> float:
        """Height over the rim's highest point up to which fibre comes, of the turns that were made."""
        ...


def straight(start: tuple[float, float], end: tuple[float, float], edge: Edge, kind: Kind) -> Stretch:
    """A straight stretch on the unrolled prism, between two places (around, height), sampled as the hull turns."""
    a, b = start[0], end[0]
    turned = abs(float(np.diff(edge.hull.normal_angle(np.array([a, b])))[0]))
    share = np.linspace(0.0, 1.0, max(int(np.ceil(turned / _STEP)), 1) + 1)
    angle = np.arctan2(abs(b - a), abs(end[1] - start[1])) if (a, start[1]) != (b, end[1]) else 0.5 * np.pi
    around, height = a + share * (b - a), start[1] + share * (end[1] - start[1])
    return Stretch(around, height, np.full_like(share, angle), np.zeros_like(share), kind)


def course(edge: Edge, stretches: list[Stretch], first: Floats, last: Floats) -> Course:
    """The course over stretches in a row, with the points (3,) where it comes from the part and goes back to it."""
    parts = [stretches[0], *(each.rest for each in stretches[1:])]
    around, height, angle, slip = (
        np.concatenate([getattr(each, name) for each in parts]) for name in ("around", "height", "angle", "slip")
    )
    kind = np.concatenate([np.full(len(each.around), each.kind) for each in parts])
    points = edge.points(around, height)
    points[0], points[-1] = first, last  # on the rim itself, which may be hollow
    none = np.full(len(points), -1)
    return Course(points, edge.normals(around), np.minimum(angle, np.pi - angle), slip, kind, none, none, none)
