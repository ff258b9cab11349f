"""Where along its path a fibre leaves the part: the place next to the rim whose ray grazes the prism beyond it."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.threads import parallel_for
from meshwind.filament.edge import Edge
from meshwind.filament.grazing import Fibres, Looks, Prism, leave, look, look_ahead
from meshwind.filament.turnaround import Catch
from meshwind.path.paths import Paths

_STENCIL = 5
"""Points in a row whose polynomial gives a tangent: with these it is of fourth order."""
_BLOCK = 64
"""Rays at least that a thread searches: fewer are done before it has begun."""


@dataclass(frozen=True)
class Rays:
    """Rays along n fibres, through whose particles they run as cubics with tangents of fourth order.

    points (m, k, 3): those of all paths; rows, sense (n,): whose the rays are, and +1 for fibres that arrive at the rim
    in the sense of turning, -1 for those that leave it; end: 1 where the rim is at the last particles, else 0.
    """

    points: Floats
    rows: Ints
    sense: Ints
    end: int

    @staticmethod
    def of(on: Edge, paths: Paths, rows: Ints) -> "Rays":
        """Those of some paths at an edge."""
        return Rays(paths.points, rows, (1 if on.end else -1) * paths.family[rows], on.end)

    def chosen(self, index: Ints | Bools) -> "Rays":
        """Some of them."""
        return Rays(self.points, self.rows[index], self.sense[index], self.end)

    def from_rim(self, count: int) -> Floats:
        """The points (n, count, 3) next to the rim, from it inwards."""
        last = self.points.shape[1] - 1
        return self.points[self.rows[:, None], np.arange(last, last - count, -1) if self.end else np.arange(count)]

    def at(self, place: Floats) -> tuple[Floats, Floats]:
        """Points and outward unit tangents (n, 3) at places (n,): numbers of particles from the rim, with fractions."""
        point, ahead = np.empty((len(place), 3)), np.empty((len(place), 3))
        look_ahead(0, len(place), self._fibres, place, point, ahead)
        return point, ahead

    def looks(self, on: Edge, place: Floats) -> Looks:
        """The rays at places (n,), and where they meet the prism."""
        made = Looks(*(np.empty((len(place), 3)) for _ in range(2)), *(np.empty(len(place)) for _ in range(4)))
        look(0, len(place), _prism(on, Catch()), self._fibres, place, made)
        return made

    def first(self, on: Edge, catch: Catch, last: float) -> tuple[Floats, Bools]:
        """Places (n,) nearest to the rim from which rays pass the prism by or meet it at the pins, and which have one.

        last: the farthest place that is looked at.
        """
        place, found = np.empty(len(self.rows)), np.empty(len(self.rows), dtype=np.bool_)
        parallel_for(leave, len(place), _BLOCK, _prism(on, catch), self._fibres, float(last), place, found)
        return place, found

    @property
    def _fibres(self) -> Fibres:
        many = self.points.shape[1]
        return Fibres(
            self.points, bool(self.end), frozen(self.rows), frozen(self.sense), _slopes(min(_STENCIL, many - 1))
        )


def _prism(on: Edge, catch: Catch) -> Prism:
    return Prism(on.origin, on.axis, on.across, on.hull.ring, on.lowest, float(catch.height))


@cache
def _slopes(many: int) -> Floats:
    """Weights (many, many) of points in a row for the derivative at each of them, exact for polynomials."""
    powers = np.arange(many)
    values = np.vander(powers.astype(float), increasing=True)
    rates = np.where(powers > 0, powers * np.power(powers[:, None], np.maximum(powers - 1, 0), dtype=float), 0.0)
    return frozen(np.linalg.solve(values.T, rates.T).T)
