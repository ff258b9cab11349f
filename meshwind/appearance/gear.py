"""Bodies of what the turnarounds stand on: collars, pins and shafts."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from meshwind.appearance.strips import Gear, Turned
from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.filament.course import Kind
from meshwind.filament.edge import Edge, edge
from meshwind.filament.filament import Filament
from meshwind.surface.surface import Surface

_AROUND = 181
"""Points round a collar or a shaft."""
_SIDES = 17
"""Points round a pin."""
_PAST = 0.15
"""Share of the reach by which a collar goes on past the fibre."""
_INTO, _BEYOND = 3.0, 2.5
"""Lengths of a shaft from the fibre round it into the part and out to the machine, over its radius."""
_STUB = 4.0
"""Length of a pin over its radius: it stands clear of the bands that it holds."""

_Body = tuple[Floats, Ints]
"""Points and quads."""


@dataclass(frozen=True)
class _End:
    """One end of the part: its prism, what turns the fibre there, and the filaments."""

    v: float
    on: Edge
    turned: Turned
    filaments: Sequence[Filament]


def gear(surface: Surface, filaments: Sequence[Filament], turned: Sequence[Turned]) -> Gear:
    """Collars, pins and shafts at both ends; turned: what turns the fibre at the start and at the end."""
    base, held = [], []
    names: tuple[list[str], list[str]] = ([], [])
    for v, one in zip((0.0, 1.0), turned, strict=False):
        if one.kind not in ("collar", "pins", "shaft"):
            continue
        end = _End(v, edge(surface, v), one, filaments)
        if one.kind == "shaft":
            held += [_shaft(end), _slim_pins(end)]
            names[1].extend(("pins", "shaft"))
            continue
        base.append(_collar(surface, end))
        names[0].append("collar" if one.kind == "collar" else "ring of the pins")
        if one.kind == "pins":
            held.append(_pins(end))
            names[1].append("pins")
    points, quads = _together([*base, *held])
    many = sum(len(cells) for _, cells in base)
    words = [" and ".join(dict.fromkeys(each)) for each in names]
    return Gear(points, quads[:many], quads[many:], *words)


def _together(parts: Sequence[_Body]) -> _Body:
    """Points and quads of several bodies."""
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 4), dtype=np.int64)
    begin = np.cumsum([0] + [len(points) for points, _ in parts])
    quads = [cells + first for (_, cells), first in zip(parts, begin[:-1], strict=True)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(quads)


def _tubes(rows: Floats) -> _Body:
    """Quads between points (b, r, c, 3) of b bodies, each of r rows round it with c points."""
    b, r, c = rows.shape[:3]
    number = np.arange(b * r * c).reshape(b, r, c)
    quads = np.stack([number[:, :-1, :-1], number[:, :-1, 1:], number[:, 1:, 1:], number[:, 1:, :-1]], axis=3)
    return rows.reshape(-1, 3), quads.reshape(-1, 4)


def _collar(surface: Surface, end: _End) -> _Body:
    """The prism on a rim, up to a little more than the fibre's reach."""
    on = end.on
    u = on.u[0] + np.linspace(0.0, 1.0, _AROUND)
    points = surface.points(np.stack([u, np.full_like(u, end.v)], axis=1))
    base = (points - on.origin) @ on.axis
    top = np.full_like(u, on.highest + (1.0 + _PAST) * end.turned.reach + end.turned.pin)
    around = on.around(u)
    return _tubes(np.stack([on.points(around, base), on.points(around, top)])[None])


def _pins(end: _End) -> _Body:
    """Each pin that a fibre turns round, square to the prism."""
    before, last = _dwells(end)
    tops, normals = _at(end.filaments, (before, last))
    return _rods(tops - end.turned.radius * end.on.axis, normals, end.turned.radius, _STUB * end.turned.radius)


def _shaft(end: _End) -> _Body:
    """The shaft on the axis, from inside the part to well beyond the fibre."""
    on, radius = end.on, end.turned.radius
    level = on.highest + end.turned.reach
    low = min(level - _INTO * radius, on.lowest)
    high = level + _BEYOND * radius
    return _rods((on.origin + low * on.axis)[None], on.axis[None], radius, high - low, _AROUND)


def _slim_pins(end: _End) -> _Body:
    """The pins before a shaft, along the axis, where fibres turn inwards."""
    on, slim = end.on, end.turned.pin
    level = on.highest + end.turned.reach
    before, last = _dwells(end)
    kinks, normals = _at(end.filaments, ([each - 1 for each in before], [each + 1 for each in last]))
    foot = kinks - slim * normals - ((kinks - on.origin) @ on.axis - level)[:, None] * on.axis
    return _rods(foot - 0.5 * _STUB * slim * on.axis, np.broadcast_to(on.axis, kinks.shape), slim, _STUB * slim)


def _dwells(end: _End) -> tuple[list[Ints], list[Ints]]:
    """Of each filament the numbers of the points before each dwell at one end, and of the last points of each."""
    before, last = [], []
    for each in end.filaments:
        dwell = (each.course.kind == Kind.DWELL) & ((each.course.points - end.on.origin) @ end.on.axis > end.on.lowest)
        before.append(np.flatnonzero(dwell[1:] & ~dwell[:-1]))
        last.append(np.flatnonzero(dwell[:-1] & ~dwell[1:]))
    return before, last


def _at(filaments: Sequence[Filament], numbers: tuple[list[Ints], list[Ints]]) -> tuple[Floats, Floats]:
    """Points (k, 3) and unit normals (k, 3) of filaments at numbers of each."""
    at = [(each.course, one) for row in numbers for each, one in zip(filaments, row, strict=True)]
    points, normals = (
        np.concatenate([getattr(course, name)[one] for course, one in at]) for name in ("points", "normal")
    )
    return points, normals


def _rods(feet: Floats, along: Floats, radius: float, length: float, sides: int = _SIDES) -> _Body:
    """Closed cylinders from feet (k, 3) along unit vectors (k, 3)."""
    helper = np.eye(3)[np.abs(along).argmin(axis=1)]
    first = unit(np.cross(along, helper))
    second = np.cross(along, first)
    polar = np.linspace(0.0, 2.0 * np.pi, sides)[:, None, None]
    ring = radius * (np.cos(polar) * first + np.sin(polar) * second)
    tip = feet + length * along
    rows = np.stack([np.broadcast_to(feet, ring.shape), feet + ring, tip + ring, np.broadcast_to(tip, ring.shape)])
    return _tubes(rows.transpose(2, 0, 1, 3))
