"""Where fibres leave the part before a rim that its prism stands up from: no taut fibre lies in that corner.

Just before such a rim the ray along a fibre already meets the prism.  The fibre leaves the part where that ray first
does: there it grazes the prism, as the fibre is to lie on both, and goes over to it in a straight line.  Where pins
stop it from sliding so far up the prism, it leaves where the ray meets the prism at the pins.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.filament.edge import Edge, Legs, Lift, legs
from meshwind.filament.hanging import Fibres, Hanging, hang
from meshwind.filament.leaving import Rays
from meshwind.filament.part_edge import PartEdge
from meshwind.filament.turnaround import Catch, Turnaround
from meshwind.path.paths import Paths

_FLUSH = np.sin(np.radians(0.1))
"""Sine of the angle by which a fibre must come in to the prism for a corner: a fit leaves less on a cylinder."""
_ENDLESS = 10.0
"""Height over the rim, in perimeters of the hull, up to which no collar is made: above it a fibre aims at the axis."""
_SAME = 1e-9
"""Heights that differ by less than this share of the hull's perimeter are the same."""
_LEAST = 2
"""Particles on the way from part to prism at least, so that one of them is in the air."""


def legs_over(turn: Turnaround, paths: Paths, family: int) -> Legs:
    """The fibres of a family on the prism of a turnaround, from where they come to lie on it.

    The height of those is infinite that slide up the prism without end, as they aim at its axis and no pins stop them.
    """
    return legs_of_all(turn, paths, (family,))[0]


def legs_of_all(turn: Turnaround, paths: Paths, families: tuple[int, ...] = (1, -1)) -> list[Legs]:
    """The same of some families, found at once."""
    on, catch = turn.edge, turn.catch
    crossing = [legs(on, paths, family) for family in families]
    if isinstance(on, PartEdge):
        return crossing
    rows = np.concatenate([np.flatnonzero(paths.family == family) for family in families])
    around, height = (np.concatenate([getattr(each, name) for each in crossing]) for name in ("around", "height"))
    rays = Rays.of(on, paths, rows)
    which = _coming_in(on, rays, around, height)
    if not len(which):
        return crossing
    rays = rays.chosen(which)
    last = (paths.points.shape[1] - 1) / 2.0  # the other end of a path has the other half to leave from
    place, found = rays.first(on, catch, last)
    made = []
    begin = np.cumsum([0, *(len(each) for each in crossing)])
    for each, start, end in zip(crossing, begin[:-1], begin[1:], strict=True):
        mine = np.flatnonzero((which >= start) & (which < end))
        held = mine[found[mine]]
        one = _lifted(each, which[held] - start, rays.chosen(held), (on, catch, place[held])) if len(held) else each
        if not np.isfinite(catch.height):
            up = np.where(one.height > on.highest + _ENDLESS * on.hull.perimeter, np.inf, one.height)
            up[which[mine[~found[mine]]] - start] = np.inf
            one = replace(one, height=frozen(up))
        made.append(one)
    return made


def lifts(on: Edge, paths: Paths) -> bool:
    """Whether any fibre comes in to the prism of an edge, so that it leaves the part before the rim."""
    around, height = on.around(paths.uv[:, -on.end, 0]), (paths.points[:, -on.end] - on.origin) @ on.axis
    return len(_coming_in(on, Rays.of(on, paths, np.arange(len(paths))), around, height)) > 0


def _coming_in(on: Edge, rays: Rays, around: Floats, height: Floats) -> Ints:
    """Which rays meet the prism as they cross the rim, at lengths (n,) along the hull and heights (n,)."""
    _, ahead = rays.at(np.zeros(len(around)))
    return np.flatnonzero((ahead * on.normals(around, height)).sum(axis=1) < -_FLUSH)


def leaning(turn: Turnaround, paths: Paths, family: int) -> float:
    """Largest angle, in radians, at which fibres of a family come down to pins from further out.

    So much of their pull goes along the pins, outwards.  Fibres that come to lie on the prism below them do not count.
    """
    on, over = turn.edge, legs_over(turn, paths, family)
    ahead = Rays.of(on, paths, np.flatnonzero(paths.family == family)).at(np.zeros(len(over)))[1]
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

    __repr__ = brief


def hung(paths: Paths, angle: Floats, over: Sequence[tuple[Legs, int, int]]) -> Hung:
    """Paths as their fibres lie.

    angle (p, n): their winding angles; over: legs with the end and the family that they are of.

    The particle next to where a fibre leaves the part is moved there, those between it and the rim to the straight way
    to the prism, and the last to where that ends.
    """
    aloft, before = np.zeros(angle.shape, dtype=bool), [0.0, 0.0]
    if all(legs_.lift is None for legs_, _, _ in over):
        return Hung(paths.points, paths.normal, frozen(angle), frozen(aloft))
    points, normals, angle = np.array(paths.points), np.array(paths.normal), np.array(angle)
    fibres = Fibres(points, normals, angle, aloft)
    for legs_, end, family in over:
        if legs_.lift is None:
            continue
        leaves = np.flatnonzero(legs_.lift.aloft)
        rows, lift = np.flatnonzero(paths.family == family)[leaves], legs_.lift.chosen(leaves)
        many, off, normal, lean = (frozen(each) for each in (lift.aloft, lift.off, lift.normal, lift.angle))
        corner = frozen(legs_.points[leaves])
        hang(0, len(rows), Hanging(frozen(rows), many, off, corner, normal, lean, bool(end)), fibres)
        before[end] = max(before[end], float(lift.before.max(initial=0.0)))
    return Hung(frozen(points), frozen(normals), frozen(angle), frozen(aloft), (before[0], before[1]))


def _lifted(crossing: Legs, which: Ints, rays: Rays, found: tuple[Edge, Catch, Floats]) -> Legs:
    """Legs of which some leave the part at places."""
    on, catch, place = found
    seen = rays.looks(on, place)
    off, ahead, length, hits = (
        seen.point,
        seen.ahead,
        seen.length,
        np.isfinite(seen.length),
    )  # or grazes, but for round-off
    level = (off - on.origin) @ on.axis + np.where(hits, length, 0.0) * (ahead @ on.axis)
    held = hits & (level >= catch.height - _SAME * on.hull.perimeter)
    grazed = seen.grazed + on.hull.perimeter * np.round((crossing.around[which] - seen.grazed) / on.hull.perimeter)
    length = np.where(held, length, seen.reach)
    corner = off + length[:, None] * ahead
    turns = np.round((crossing.around[which] - seen.passed) / on.hull.perimeter)
    around = np.where(held, seen.passed + on.hull.perimeter * turns, grazed)
    height = (corner - on.origin) @ on.axis
    hoop = rays.sense[:, None] * on.tangents(around)
    # of a fibre that pins hold, the angle that it turns by on its pin is what counts
    leans = np.arccos(np.clip(ahead @ on.axis, 0.0, 1.0))
    angle = np.where(held, np.arcsin(np.clip((ahead * hoop).sum(axis=1), -1.0, 1.0)), leans)
    points = np.where(held[:, None], corner - (catch.radius * np.tan(0.25 * np.pi - 0.5 * angle))[:, None] * ahead,
                      on.points(around, height))  # fmt: skip
    last = max((rays.points.shape[1] - 1) // 2, 1)
    aloft = np.clip(np.round(place), min(_LEAST, last), last).astype(np.int64)
    index, row = place.astype(np.int64), np.arange(len(which))
    steps = np.linalg.norm(np.diff(rays.from_rim(index.max(initial=0) + 2), axis=1), axis=2)
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
