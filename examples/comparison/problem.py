"""A taut path with a known answer: the input of every method, and what its result is compared with."""

from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from meshwind.core.cast import Floats
from meshwind.surface import Surface

TURN = 2.0 * np.pi
"""A turn of u, in radians."""
FRAMES = 21
"""Positions of an end that is dragged, the first and the last among them."""


class Kind(StrEnum):
    """What a problem asks of a method."""

    ON_SURFACE = "on the surface"
    BRIDGING = "bridging"
    FRICTION = "friction"
    FREEFORM = "freeform"
    LONG = "long windings"
    MOVING = "moving ends"


@dataclass(frozen=True)
class Problem:
    """A path whose answer is known.

    difficulty: what makes it hard; start, end (u, v): u in turns and unwrapped; length in the surface's units; bridges:
    whether the fibre leaves the surface; gap: its largest distance from the surface, None where it is not known;
    friction: Coulomb's coefficient; initial: the starting curve for a number of particles, (n, 2), None for a straight
    line in (u, v); dragged_from: where the ends are first, with the fibre straight between them, if they move;
    accuracy: relative accuracy of `length` on the spline that stands for the shape.
    """

    name: str
    difficulty: str
    surface: Callable[[], Surface]
    start: tuple[float, float]
    end: tuple[float, float]
    length: float
    bridges: bool = False
    gap: float | None = None
    kind: Kind = Kind.ON_SURFACE
    friction: float = 0.0
    initial: Callable[[int], Floats] | None = None
    dragged_from: tuple[tuple[float, float], tuple[float, float]] | None = None
    accuracy: float = 1e-12

    @property
    def motion(self) -> tuple[Floats, Floats]:
        """Positions (f, 2) of the start and of the end, from where they are first to where they are dragged."""
        share = np.linspace(0.0, 1.0, FRAMES)[:, None]
        before = self.dragged_from or (self.start, self.end)
        starts, ends = (
            (1.0 - share) * np.array(a) + share * np.array(b)
            for a, b in zip(before, (self.start, self.end), strict=True)
        )
        return starts, ends

    def error(self, length: float) -> float:
        """Relative error of a length, at least that of the answer."""
        return max(abs(length / self.length - 1.0), self.accuracy)
