"""Where along its path a fibre leaves the part: the place next to the rim whose ray grazes the prism beyond it."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.interpolate import CubicSpline

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import TINY, unit
from meshwind.filament.edge import Edge
from meshwind.filament.section import Meeting
from meshwind.filament.turnaround import Catch
from meshwind.path.paths import Paths

_SHARES = np.linspace(0.0, 1.0, 9)
"""Places, over the way between two, all of which are tried at once."""
_ROUNDS = 48
"""Most rounds in which the place where a fibre leaves is found; five do where the part is smooth."""
_HALVED = 4
"""Rounds of which one halves the way that is left, however the others get on."""
_NEAR = 1e-10
"""Numbers of a particle, and lengths over the hull's, beyond which no fit is right."""
_LEAP = 1e-6
"""Length over the hull's by which no ray that grazes the prism passes it by."""


@dataclass(frozen=True)
class Rays:
    """Rays along n fibres: their points (n, k, 3) from the rim inwards, splines through these, and their senses (n,).

    The sense is +1 for fibres that arrive at the rim in the sense of turning, and -1 for those that leave it.
    """

    points: Floats
    coefficients: Floats
    sense: Ints

    @staticmethod
    def of(on: Edge, paths: Paths, rows: Ints, window: int | None = None) -> "Rays":
        """Those of some paths at an edge, as far as some particles from there."""
        points = paths.points[rows, :: -1 if on.end else 1]
        near = points[:, :window]
        spline = CubicSpline(np.arange(near.shape[1]), near, axis=1)
        return Rays(points, spline.c, paths.family[rows] if on.end else -paths.family[rows])

    def chosen(self, index: Ints | Bools) -> "Rays":
        """Some of them."""
        return Rays(self.points[index], self.coefficients[:, :, index], self.sense[index])

    def at(self, place: Floats, which: Ints | None = None) -> tuple[Floats, Floats]:
        """Points and outward unit tangents (m, 3) at places (m,): numbers of particles from the rim, with fractions.

        which: the rays that these are on; by default each is on its own.
        """
        index = np.minimum(place.astype(np.int64), self.coefficients.shape[1] - 1)
        a, b, c, d = self.coefficients[:, index, np.arange(len(place)) if which is None else which]
        s = (place - index)[:, None]
        return d + s * (c + s * (b + s * a)), -unit(c + s * (2.0 * b + 3.0 * s * a))


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
            past[by[(touched - on.origin) @ on.axis < on.lowest]] = -np.inf
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
        made = self.crossed(np.tile(places, (len(self.rays.points), 1)))
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
