"""What every turnaround is: the way of a fibre over a rim, from the end of one path to the start of the next."""

from dataclasses import dataclass
from typing import Protocol, TypeAlias

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.filament.course import Course, Courses, Kind, runs
from meshwind.filament.edge import Edge, Legs

_STEP = np.radians(3.0)
"""Turn of the prism's normal between points of a straight stretch, ..."""
_LONGEST = 1 / 60
"""... and share of the hull's perimeter: its sides are straight where the rim is hollow."""


@dataclass(frozen=True)
class Catch:
    """What stops a fibre from sliding up the prism: pins whose far side is at a height, of a radius."""

    height: float = np.inf
    radius: float = 0.0


class Turnaround(Protocol):
    """A turnaround at one end of the part.

    name: its word of `core.defaults.TURNAROUNDS`, or "bend" on the part; rule: how its hold is proved; slip: the
    largest friction that it needs.
    """

    name: str
    rule: str
    slip: float

    @property
    def edge(self) -> Edge:
        """The prism that it stands on."""
        ...

    @property
    def catch(self) -> Catch:
        """What stops a fibre from sliding up the prism."""
        ...

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """Turns (n,) to spare from n legs that arrive to those that leave next, at lengths `later` along the hull."""
        ...

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> Courses:
        """The course from each of n legs that arrive to the one that leaves next, at a length `later` (n,)."""
        ...

    @property
    def reach(self) -> float:
        """Height over the rim's highest point up to which fibre comes, of the turns that were made."""
        ...


Place: TypeAlias = tuple[Floats, Floats]
"""Where n fibres are on the unrolled prism: length along the hull and height, (n,) each."""


def straight(edge: Edge, start: Place, end: Place, kind: Kind) -> Courses:
    """Straight stretches on the unrolled prism, between places, sampled as the hull turns."""
    (a, low), (b, high) = start, end
    turned = np.abs(edge.hull.normal_angle(b) - edge.hull.normal_angle(a))
    far = np.abs(b - a) / (_LONGEST * edge.hull.perimeter)
    count = np.maximum(np.ceil(np.maximum(turned / _STEP, far)).astype(np.int64), 1) + 1
    angle = np.where((a != b) | (low != high), np.arctan2(np.abs(b - a), np.abs(high - low)), 0.5 * np.pi)
    share, many = shares(count), int(count.sum())
    around, height = (np.repeat(x, count) + share * np.repeat(y - x, count) for x, y in ((a, b), (low, high)))
    return on_prism(edge, (around, height), np.repeat(angle, count), np.zeros(many), count, kind)


def shares(count: Ints) -> Floats:
    """Even shares from 0 to 1, count[k] of them for each of n stretches, at least 2, one after the other."""
    return np.asarray(runs(np.zeros_like(count), count) / np.repeat(count - 1, count))


def on_prism(edge: Edge, at: Place, angle: Floats, slip: Floats, count: Ints, kind: Kind) -> Courses:
    """Courses of count[k] points each on the prism, from places, angles and slips of all points, one after another."""
    around, height = at
    none = np.full(len(around), -1)
    course = Course(
        edge.points(around, height), edge.normals(around, height), np.minimum(angle, np.pi - angle), slip,
        np.full(len(around), int(kind)), none, none, none,
    )  # fmt: skip
    return Courses(course, count)
