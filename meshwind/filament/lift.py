"""Where fibres leave the part before a rim that its prism stands up from: no taut fibre lies in that corner.

Just before such a rim the ray along a fibre already meets the prism.  The fibre leaves the part where that ray first
does: there it grazes the prism, as the fibre is to lie on both, and goes over to it in a straight line.  Where pins
stop it from sliding so far up the prism, it leaves where the ray meets the prism at the pins.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.interpolate import CubicSpline

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.vectors import TINY, unit
from meshwind.filament.edge import Edge, Legs, Lift, legs
from meshwind.filament.part_edge import PartEdge
from meshwind.filament.section import Meeting
from meshwind.filament.turnaround import Catch, Turnaround
from meshwind.path.paths import Paths
from meshwind.path.winding_angle import winding_angle

_FLUSH = np.sin(np.radians(0.1))
"""Sine of the angle by which a fibre must come in to the prism for a corner: a fit leaves less on a cylinder."""
_ENDLESS = 10.0
"""Height over the rim, in perimeters of the hull, up to which no collar is made: above it a fibre aims at the axis."""
_SAME = 1e-9
"""Heights that differ by less than this share of the hull's perimeter are the same."""
_LEAST = 2
"""Particles on the way from part to prism at least, so that one of them is in the air."""
_WINDOW = 1 / 8
"""Share of a path next to a rim through which splines are laid at first: most fibres leave from its nearer half."""
_FEWEST = 32
"""Particles that this is at least."""
_ROUNDS = 48
"""Most rounds in which the place where a fibre leaves is found; ten do where the part is smooth."""
_HALVED = 4
"""Rounds of which one halves the way that is left, however the others get on."""
_LEAP = 1e-6
"""Length over the hull's by which no ray that grazes the prism passes it by."""
_NEAR = 1e-12
"""Numbers of a particle, and lengths over the hull's, that are round-off."""


def legs_over(turn: Turnaround, paths: Paths, family: int) -> Legs:
    """The fibres of a family on the prism of a turnaround, from where they come to lie on it.

    The height of those is infinite that slide up the prism without end, as they aim at its axis and no pins stop them.
    """
    on, catch = turn.edge, turn.catch
    crossing = legs(on, paths, family)
    if isinstance(on, PartEdge):
        return crossing
    window = max(int(_WINDOW * paths.points.shape[1]), _FEWEST)
    rays = _Rays.of(on, paths, family, window)
    point, ahead = rays.at(np.zeros(len(crossing)))
    corner = (ahead * on.normals(crossing.around, crossing.height)).sum(axis=1) < -_FLUSH
    if not corner.any():
        return crossing
    which = np.flatnonzero(corner)
    rays = rays.chosen(which)
    last = (paths.points.shape[1] - 1) / 2.0  # the other end of a path has the other half to leave from
    place, found = _first(rays, on, catch, min(last, 0.5 * window))
    if not found.all():
        rays = _Rays.of(on, paths, family).chosen(which)
        place, found = _first(rays, on, catch, last)
    legs_ = _lifted(crossing, which[found], rays.chosen(found), (on, catch, place[found])) if found.any() else crossing
    if np.isfinite(catch.height):
        return legs_
    height = np.where(legs_.height > on.highest + _ENDLESS * on.hull.perimeter, np.inf, legs_.height)
    height[which[~found]] = np.inf
    return replace(legs_, height=frozen(height))


def leaning(turn: Turnaround, paths: Paths, family: int) -> float:
    """Largest angle, in radians, at which fibres of a family come down to pins from further out.

    So much of their pull goes along the pins, outwards.  Fibres that come to lie on the prism below them do not count.
    """
    on, over = turn.edge, legs_over(turn, paths, family)
    ahead = _Rays.of(on, paths, family).at(np.zeros(len(over)))[1]
    if over.lift is not None:
        ahead = np.where(over.lift.aloft[:, None] > 0, over.lift.ahead, ahead)
    inwards = -(ahead * on.normals(over.around, over.height)).sum(axis=1)
    if over.lift is not None:
        inwards = np.where((over.lift.aloft > 0) & ~over.lift.held, 0.0, inwards)
    return float(np.arcsin(np.clip(inwards, 0.0, 1.0)).max())


@dataclass(frozen=True)
class Hung:
    """Paths of n points as their fibres lie, some of which hang between the part and what they turn on.

    Attributes
    ----------
    points, normal : ndarray of float, shape (p, n, 3)
        Points of the fibres, and normals of what they lie on; where they hang, between those of both its ends.
    angle : ndarray of float, shape (p, n)
        Their winding angle, in radians, likewise.
    aloft : ndarray of bool, shape (p, n)
        Which points lie on the part no more.
    before : tuple of float
        Largest length of a path that no fibre lies on, at the start and at the end of the part.
    """

    points: Floats
    normal: Floats
    angle: Floats
    aloft: Bools
    before: tuple[float, float] = (0.0, 0.0)


def hung(paths: Paths, over: Sequence[tuple[Legs, int, int]]) -> Hung:
    """Paths as their fibres lie; over: legs with the end and the family that they are of.

    The particle next to where a fibre leaves the part is moved there, those between it and the rim to the straight way
    to the prism, and the last to where that ends.
    """
    points, normals, angle = np.array(paths.points), np.array(paths.normal), np.array(winding_angle(paths))
    aloft, before = np.zeros(points.shape[:2], dtype=bool), [0.0, 0.0]
    many = points.shape[1]
    for legs_, end, family in over:
        if legs_.lift is None:
            continue
        leaves = np.flatnonzero(legs_.lift.aloft)
        rows, lift = np.flatnonzero(paths.family == family)[leaves], legs_.lift.chosen(leaves)
        reach = int(lift.aloft.max()) + 1
        near = slice(many - reach, many) if end else slice(0, reach)
        left = np.arange(reach)[::-1] if end else np.arange(reach)
        share = np.clip(left / lift.aloft[:, None], 0.0, 1.0)[..., None]  # from the rim, 1 where it leaves the part
        moved = (left <= lift.aloft[:, None])[..., None]
        way = share * lift.off[:, None] + (1.0 - share) * legs_.points[leaves][:, None]
        last = many - 1 - lift.aloft if end else lift.aloft
        turn = unit(share * normals[rows, last][:, None] + (1.0 - share) * lift.normal[:, None])
        lean = share[..., 0] * angle[rows, last][:, None] + (1.0 - share[..., 0]) * lift.angle[:, None]
        angle[rows, near] = np.where(moved[..., 0], lean, angle[rows, near])
        points[rows, near] = np.where(moved, way, points[rows, near])
        normals[rows, near] = np.where(moved, turn, normals[rows, near])
        aloft[rows, near] |= left < lift.aloft[:, None]
        before[end] = max(before[end], float(lift.before.max(initial=0.0)))
    return Hung(frozen(points), frozen(normals), frozen(angle), frozen(aloft), (before[0], before[1]))


@dataclass(frozen=True)
class _Rays:
    """Rays along n fibres: their points (n, k, 3) from the rim inwards, and splines through these."""

    points: Floats
    coefficients: Floats
    sense: int

    @staticmethod
    def of(on: Edge, paths: Paths, family: int, window: int | None = None) -> "_Rays":
        """Those of a family at an edge, as far as some particles from there."""
        rows = np.flatnonzero(paths.family == family)
        points = paths.points[rows][:, :: -1 if on.end else 1]
        near = points[:, :window]
        spline = CubicSpline(np.arange(near.shape[1]), near, axis=1)
        return _Rays(points, spline.c, family if on.end else -family)

    def chosen(self, index: Ints | Bools) -> "_Rays":
        """Some of them."""
        return _Rays(self.points[index], self.coefficients[:, :, index], self.sense)

    def at(self, place: Floats) -> tuple[Floats, Floats]:
        """Points and outward unit tangents (n, 3) at places (n,): numbers of particles from the rim, with fractions."""
        index = np.clip(place.astype(np.int64), 0, self.coefficients.shape[1] - 1)
        a, b, c, d = self.coefficients[:, index, np.arange(len(place))]
        s = (place - index)[:, None]
        return d + s * (c + s * (b + s * a)), -unit(c + s * (2.0 * b + 3.0 * s * a))


def _met(on: Edge, point: Floats, ahead: Floats) -> Meeting:
    """Where rays from points (n, 3) meet the prism."""
    return on.hull.met((point - on.origin) @ on.across.T, ahead @ on.across.T)


def _touch(on: Edge, point: Floats, ahead: Floats, sense: int) -> tuple[Floats, Floats]:
    """Length (n,) along the hull where rays that pass the prism by touch it, or come nearest, and (n,) how far off.

    There its normal is square to the ray.
    """
    way = ahead @ on.across.T
    grazed = on.hull.passed_at(np.arctan2(-sense * way[:, 0], sense * way[:, 1]))
    short = on.hull.at(grazed) - (point - on.origin) @ on.across.T
    return grazed, (short * way).sum(axis=1) / np.maximum((way**2).sum(axis=1), TINY)


def _beyond(rays: _Rays, on: Edge, catch: Catch, place: Floats) -> Floats:
    """Lengths (n,), over the hull's, by which rays at places pass the prism by, or meet it above the pins."""
    point, ahead = rays.at(place)
    met = _met(on, point, ahead)
    height = (point - on.origin) @ on.axis + np.where(np.isfinite(met.length), met.length, 0.0) * (ahead @ on.axis)
    # one that has the prism behind it passes by as well
    over = np.where(np.isfinite(met.length), height - catch.height, np.abs(met.depth))
    past = np.maximum(-met.depth, over)
    # but beside a notch it may touch what would be the prism within the part
    touched = point + _touch(on, point, ahead, rays.sense)[1][:, None] * ahead
    within = ((touched - on.origin) @ on.axis < on.lowest) & ~np.isfinite(met.length)
    return np.asarray(np.where(within, -np.abs(past), past) / on.hull.perimeter)


def _bracketed(rays: _Rays, on: Edge, catch: Catch, last: float) -> tuple[Floats, Floats, Floats, Floats, Bools]:
    """Places (n,) between which rays come beyond first, by how much they are there, and which do.

    Rays are tried ever further from the rim; of those that are not beyond there, as it goes back again, all are tried.
    """
    count = len(rays.points)
    low, high, found = np.zeros(count), np.zeros(count), np.zeros(count, dtype=bool)
    under, above = np.zeros(count), np.zeros(count)
    step = 1.0
    while not found.all() and step < 2.0 * last:
        tried = np.full(count, min(step, last))
        value = _beyond(rays, on, catch, tried)
        now = (value >= 0.0) & ~found
        high, above = np.where(now, tried, high), np.where(now, value, above)
        more = ~found & ~now
        low, under = np.where(more, tried, low), np.where(more, value, under)
        found, step = found | now, 2.0 * step
    missed = np.flatnonzero(~found)
    if len(missed):
        places = np.arange(1.0, last + 1.0)
        each = rays.chosen(np.repeat(missed, len(places)))
        value = _beyond(each, on, catch, np.tile(places, len(missed))).reshape(len(missed), -1)
        first, row = (value >= 0.0).argmax(axis=1), np.arange(len(missed))
        found[missed] = value[row, first] >= 0.0
        high[missed], above[missed] = places[first], value[row, first]
        low[missed], under[missed] = places[first] - 1.0, np.where(first > 0, value[row, first - 1], 0.0)
    return low, high, under, above, found


def _first(rays: _Rays, on: Edge, catch: Catch, last: float) -> tuple[Floats, Bools]:
    """Places (n,) nearest to the rim from which rays pass the prism by or meet it at the pins, and which have one.

    last: the farthest place that is looked at.
    """
    low, high, under, above, found = _bracketed(rays, on, catch, last)
    value, middle, passes = above, high, above
    # false position as in the Illinois method: an end that stays counts half
    stayed = np.zeros(len(low))
    for turn in range(_ROUNDS):
        span = above - under
        share = np.divide(
            -under, span, out=np.full_like(low, 0.5), where=(under < 0.0) & np.isfinite(span) & (span > 0.0)
        )
        middle = low + (0.5 if turn % _HALVED == _HALVED - 1 else share) * (high - low)
        value = _beyond(rays, on, catch, middle)
        there = value >= 0.0
        passes = np.where(there, value, passes)
        under = np.where(there, np.where(stayed > 0.0, 0.5 * under, under), value)
        above = np.where(there, value, np.where(stayed < 0.0, 0.5 * above, above))
        low, high = np.where(there, low, middle), np.where(there, middle, high)
        stayed = np.where(there, 1.0, -1.0)
        if (np.minimum(high - low, np.abs(value)) < _NEAR).all():
            break
    # on a rough part what is beyond may begin with a leap, where no fibre lies on both
    return np.where(np.abs(value) < _NEAR, middle, high), found & (np.minimum(passes, np.abs(value)) < _LEAP)


def _lifted(crossing: Legs, which: Ints, rays: _Rays, found: tuple[Edge, Catch, Floats]) -> Legs:
    """Legs of which some leave the part at places."""
    on, catch, place = found
    off, ahead = rays.at(place)
    met = _met(on, off, ahead)
    length, hits = met.length, np.isfinite(met.length)  # or grazes, but for round-off
    level = (off - on.origin) @ on.axis + np.where(hits, length, 0.0) * (ahead @ on.axis)
    held = hits & (level >= catch.height - _SAME * on.hull.perimeter)
    grazed, touch = _touch(on, off, ahead, rays.sense)
    grazed += on.hull.perimeter * np.round((crossing.around[which] - grazed) / on.hull.perimeter)
    length = np.where(held, length, touch)
    corner = off + length[:, None] * ahead
    turns = np.round((crossing.around[which] - met.passed) / on.hull.perimeter)
    around = np.where(held, met.passed + on.hull.perimeter * turns, grazed)
    height = (corner - on.origin) @ on.axis
    hoop = rays.sense * on.tangents(around)
    # of a fibre that pins hold, the angle that it turns by on its pin is what counts
    leans = np.arccos(np.clip(ahead @ on.axis, 0.0, 1.0))
    angle = np.where(held, np.arcsin(np.clip((ahead * hoop).sum(axis=1), -1.0, 1.0)), leans)
    points = np.where(held[:, None], corner - (catch.radius * np.tan(0.25 * np.pi - 0.5 * angle))[:, None] * ahead,
                      on.points(around, height))  # fmt: skip
    last = max((rays.points.shape[1] - 1) // 2, 1)
    aloft = np.clip(np.round(place), min(_LEAST, last), last).astype(np.int64)
    index, row = place.astype(np.int64), np.arange(len(which))
    steps = np.linalg.norm(np.diff(rays.points[:, : index.max(initial=0) + 2], axis=1), axis=2)
    passed = np.concatenate([np.zeros((len(which), 1)), np.cumsum(steps, axis=1)], axis=1)
    before = passed[row, index] + (place - index) * steps[row, np.minimum(index, steps.shape[1] - 1)]
    full = [np.array(values) for values in (crossing.around, crossing.height, crossing.angle, crossing.points)]
    for values, new in zip(full, (around, height, angle, points), strict=True):
        values[which] = new
    n = len(crossing)
    lift = Lift(
        np.zeros(n, dtype=np.int64), full[3].copy(), full[3].copy(), np.zeros((n, 3)), np.zeros(n, dtype=bool),
        np.zeros(n), np.zeros((n, 3)), np.zeros(n),
    )  # fmt: skip
    made = aloft, off, corner, ahead, held, before, on.normals(around, height), leans
    for values, new in zip(vars(lift).values(), made, strict=True):
        values[which] = new
    at, high, lean, start = (frozen(values) for values in full)
    return Legs(at, high, lean, start, crossing.sense, lift)
