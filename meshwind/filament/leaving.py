"""Where along its path a fibre leaves the part: the place next to the rim whose ray grazes the prism beyond it."""

from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.vectors import TINY, unit
from meshwind.filament.edge import Edge
from meshwind.filament.section import Meeting
from meshwind.filament.turnaround import Catch
from meshwind.path.paths import Paths

_STENCIL = 5
"""Points in a row whose polynomial gives a tangent: with these it is of fourth order."""
_SHARES = np.linspace(0.0, 1.0, 9)
"""Places, over the way between two, all of which are tried at once."""
_ROUNDS = 48
"""Most rounds in which the place where a fibre leaves is found; five do where the part is smooth."""
_HALVED = 4
"""Rounds of which one halves the way that is left, however the others get on."""
_NEAR = 1e-10
"""Numbers of a particle, and lengths over the hull's, beyond which no fit is right."""
_WITHIN = 0.02
"""Depth below the rim, over the hull's perimeter, of what would be the prism within the part."""
_LEAP = 1e-6
"""Length over the hull's by which no ray that grazes the prism passes it by."""


@dataclass(frozen=True)
class Rays:
    """Rays along n fibres, through whose particles they run as cubics with tangents of fourth order.

    points (m, k, 3): those of all paths, from the rim inwards; rows, sense (n,): whose the rays are, and +1 for fibres
    that arrive at the rim in the sense of turning, -1 for those that leave it.
    """

    points: Floats
    rows: Ints
    sense: Ints

    @staticmethod
    def of(on: Edge, paths: Paths, rows: Ints) -> "Rays":
        """Those of some paths at an edge."""
        return Rays(paths.points[:, :: -1 if on.end else 1], rows, (1 if on.end else -1) * paths.family[rows])

    def chosen(self, index: Ints | Bools) -> "Rays":
        """Some of them."""
        return Rays(self.points, self.rows[index], self.sense[index])

    def at(self, place: Floats, which: Ints | None = None) -> tuple[Floats, Floats]:
        """Points and outward unit tangents (m, 3) at places (m,): numbers of particles from the rim, with fractions.

        which: the rays that these are on; by default each is on its own.
        """
        rows, many = self.rows if which is None else self.rows[which], self.points.shape[1]
        wide = min(_STENCIL, many - 1)
        index = np.minimum(place.astype(np.int64), many - 2)
        begin = np.clip(index - (wide - 1) // 2, 0, many - wide - 1)
        near = self.points[rows[:, None], begin[:, None] + np.arange(wide + 1)]
        one, two = _hermite(place - index, index - begin, wide)
        return np.einsum("ij,ijk->ik", one, near), -unit(np.einsum("ij,ijk->ik", two, near))


def _hermite(share: Floats, at: Ints, wide: int) -> tuple[Floats, Floats]:
    """Weights (m, wide + 1) of points in a row for the place, and the tangent, a share (m,) from point `at` (m,) on."""
    here, row = _slopes(wide), np.arange(len(at))
    s = share[:, None]
    # the tangents at both ends, from the first points and from the last but the first
    left, right = np.zeros((len(at), wide + 1)), np.zeros((len(at), wide + 1))
    left[:, :wide], right[:, 1:] = here[np.minimum(at, wide - 1)], here[at]
    place = (s**3 - 2.0 * s**2 + s) * left + (s**3 - s**2) * right
    tangent = (3.0 * s**2 - 4.0 * s + 1.0) * left + (3.0 * s**2 - 2.0 * s) * right
    blend, rise = (3.0 - 2.0 * share) * share**2, 6.0 * share * (1.0 - share)
    place[row, at] += 1.0 - blend
    place[row, at + 1] += blend
    tangent[row, at] -= rise
    tangent[row, at + 1] += rise
    return place, tangent


@cache
def _slopes(many: int) -> Floats:
    """Weights (many, many) of points in a row for the derivative at each of them, exact for polynomials."""
    powers = np.arange(many)
    values = np.vander(powers.astype(float), increasing=True)
    rates = np.where(powers > 0, powers * np.power(powers[:, None], np.maximum(powers - 1, 0), dtype=float), 0.0)
    return frozen(np.linalg.solve(values.T, rates.T).T)


def met(on: Edge, point: Floats, ahead: Floats) -> Meeting:
    """Where rays from points (n, 3) meet the prism."""
    return on.hull.met((point - on.origin) @ on.across.T, ahead @ on.across.T)


def touch(on: Edge, point: Floats, ahead: Floats, sense: Ints) -> tuple[Floats, Floats]:
    """Length (n,) along the hull where rays that pass the prism by touch it, or come nearest, and (n,) how far off.

    There its normal is square to the ray.
    """
    way = ahead @ on.across.T
    grazed = on.hull.passed_at(np.arctan2(-sense * way[:, 0], sense * way[:, 1]))
    short = on.hull.at(grazed) - (point - on.origin) @ on.across.T
    return grazed, (short * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), TINY)


def first(rays: Rays, on: Edge, catch: Catch, last: float) -> tuple[Floats, Bools]:
    """Places (n,) nearest to the rim from which rays pass the prism by or meet it at the pins, and which have one.

    last: the farthest place that is looked at.
    """
    search = _Search(rays, on, catch)
    between = search.bracketed(last)
    place, which = between.high.copy(), np.flatnonzero(between.found)
    low, high = between.low[which], between.high[which]
    search = _Search(rays.chosen(which), on, catch)
    place[which], grazes = search.settled(search.crossed(low[:, None] + (high - low)[:, None] * _SHARES))
    found = np.zeros(len(place), dtype=bool)
    found[which] = grazes
    return place, found


class _Between(NamedTuple):
    """Places (n,) between which rays come beyond first, by how much they are there, and which do."""

    low: Floats
    high: Floats
    under: Floats
    above: Floats
    found: Bools
    lost: Bools


@dataclass(frozen=True)
class _Search:
    """The search for places on rays at an edge."""

    rays: Rays
    on: Edge
    catch: Catch

    def beyond(self, place: Floats, which: Ints | None = None) -> Floats:
        """Lengths (m,), over the hull's, by which rays at places pass the prism by, or meet it above the pins.

        They are endless below where a ray would touch the prism within the part, as beside a notch.
        """
        on = self.on
        point, ahead = self.rays.at(place, which)
        there = met(on, point, ahead)
        hits = np.isfinite(there.length)
        height = (point - on.origin) @ on.axis + np.where(hits, there.length, 0.0) * (ahead @ on.axis)
        # one that has the prism behind it passes by as well
        past = np.maximum(-there.depth, np.where(hits, height - self.catch.height, np.abs(there.depth)))
        by = np.flatnonzero(~hits)
        if len(by):
            sense = self.rays.sense[by if which is None else which[by]]
            touched = point[by] + touch(on, point[by], ahead[by], sense)[1][:, None] * ahead[by]
            past[by[(touched - on.origin) @ on.axis < on.lowest - _WITHIN * on.hull.perimeter]] = -np.inf
        return np.asarray(past / on.hull.perimeter)

    def crossed(self, places: Floats, which: Ints | None = None) -> _Between:
        """The first of places (n, m), growing, beyond which rays are, and those before."""
        which = np.arange(len(places)) if which is None else which
        value = self.beyond(places.ravel(), np.repeat(which, places.shape[1])).reshape(places.shape)
        there, row = value[:, 1:] >= 0.0, np.arange(len(places))
        k = there.argmax(axis=1)
        lost = ~there[row, k] & np.isneginf(value).any(axis=1)
        return _Between(places[row, k], places[row, k + 1], value[row, k], value[row, k + 1], there[row, k], lost)

    def bracketed(self, last: float) -> _Between:
        """The same anywhere; rays are tried ever further from the rim."""
        places = np.append(0.0, np.minimum(2.0 ** np.arange(np.ceil(np.log2(last)) + 1.0), last))
        made = self.crossed(np.tile(places, (len(self.rays.rows), 1)))
        lost = np.flatnonzero(made.lost)
        if len(lost):
            every = np.arange(np.ceil(last) + 1.0)
            for values, new in zip(made, self.crossed(np.tile(every, (len(lost), 1)), lost), strict=True):
                values[lost] = new
        return made

    def settled(self, between: _Between) -> tuple[Floats, Bools]:
        """Places (n,) between those, and from which of them rays graze the prism or come to the pins.

        On a rough part what is beyond may begin with a leap, where no fibre lies on both.
        """
        low, high, under, above, *_ = between
        value, middle, passes = above, high, above
        # false position as in the Illinois method: an end that stays counts half
        stayed = np.zeros(len(low))
        for turn in range(_ROUNDS):
            span = above - under
            share = np.divide(-under, span, out=np.full_like(low, 0.5), where=(under < 0.0) & (span < np.inf))
            middle = low + (0.5 if turn % _HALVED == _HALVED - 1 else share) * (high - low)
            value = self.beyond(middle)
            there = value >= 0.0
            passes = np.where(there, value, passes)
            under = np.where(there, np.where(stayed > 0.0, 0.5 * under, under), value)
            above = np.where(there, value, np.where(stayed < 0.0, 0.5 * above, above))
            low, high = np.where(there, low, middle), np.where(there, middle, high)
            stayed = np.where(there, 1.0, -1.0)
            if (np.minimum(high - low, np.abs(value)) < _NEAR).all():
                break
        return np.where(np.abs(value) < _NEAR, middle, high), np.minimum(passes, np.abs(value)) < _LEAP
