"""Scenes of a filament: its bands in the order of winding, and what they leave bare."""

from collections.abc import Sequence

import numpy as np

from meshwind.appearance.looks import SEQUENTIAL, Scale
from meshwind.appearance.view import View, framed
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.filament.course import Kind
from meshwind.filament.edge import Edge, edge
from meshwind.filament.filament import Filament
from meshwind.pictures.ribbons import ribbons
from meshwind.pictures.scenes import FilamentScene, Gear
from meshwind.pictures.subject import Subject, Turned

_AROUND = 181
"""Points round a collar or a shaft."""
_SIDES = 17
"""Points round a pin."""
_PAST = 0.15
"""Share of the reach by which a collar goes on past the fibre."""
_SHAFT_BELOW, _SHAFT_ABOVE = 1.0, 1.0
"""Lengths of a shaft on both sides of the fibre round it, over the reach."""
_STUB = 3.0
"""Length of a pin over its radius."""
_SLIM = 0.12
"""Radius of the pins before a shaft over the reach: they only turn the fibre inwards."""


def filament_scene(of: Subject) -> FilamentScene:
    """The bands, lifted and coloured by their order, on the part and its turnarounds."""
    total = sum(float(each.course.arc_length[-1]) for each in of.filaments)
    words = ("wound so far,", f"in {of.units}") if of.units else ("wound so far",)
    scale = Scale(words, SEQUENTIAL, 0.0, total)
    gear = gear_of(of)
    made = ribbons(of.filaments, of.paths, of.layup.coverage.width)
    many = "one filament" if len(of.filaments) == 1 else f"{len(of.filaments)} filaments"
    subtitle = f"{of.pattern}  ·  " if of.pattern else ""
    subtitle += f"{quantity(total, of.units)} of band {quantity(of.layup.coverage.width, of.units, 3)} wide"
    frame = of.frame(f"{of.name}: {many} in the order of winding", subtitle, _view(of, made.points, gear))
    return FilamentScene(frame, of.part, made, gear, scale)


def bands_scene(of: Subject) -> FilamentScene:
    """The bands by family, over a part whose bare places show."""
    gear = gear_of(of)
    width = of.layup.coverage.width
    made = ribbons(of.filaments, of.paths, width, order=False)
    bare = of.layup.bands.bare
    words = "nothing bare" if bare == 0.0 else f"{100.0 * bare:.2g} % of the part bare"
    subtitle = f"band {quantity(width, of.units, 3)} wide  ·  {words}"
    frame = of.frame(f"{of.name}: bands of true width", subtitle, _view(of, made.points, gear))
    return FilamentScene(frame, of.part, made, gear)


def _view(of: Subject, strips: Floats, gear: Gear) -> View:
    """The view of the part, wide enough for its turnarounds."""
    return framed(np.concatenate([of.points, strips.reshape(-1, 3), gear.points]), of.view)


def gear_of(of: Subject) -> Gear:
    """Collars, pins and shafts at both ends."""
    parts, names = [], []
    for v, turned in zip((0.0, 1.0), of.turned, strict=False):
        if turned.kind == "collar":
            parts.append(_collar(of, edge(of.paths.surface, v), v, turned.reach))
        elif turned.kind == "pins":
            parts += _pins(of, edge(of.paths.surface, v), v, turned)
        elif turned.kind == "shaft":
            parts += _shaft(of, edge(of.paths.surface, v), v, turned)
        else:
            continue
        names.append(turned.kind)
    points, quads = _together(parts)
    return Gear(points, quads, " and ".join(dict.fromkeys(names)))


def _together(parts: Sequence[tuple[Floats, Ints]]) -> tuple[Floats, Ints]:
    """Points and quads of several bodies."""
    if not parts:
        return np.zeros((0, 3)), np.zeros((0, 4), dtype=np.int64)
    begin = np.cumsum([0] + [len(points) for points, _ in parts])
    quads = [cells + first for (_, cells), first in zip(parts, begin[:-1], strict=True)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(quads)


def _tubes(rows: Floats) -> tuple[Floats, Ints]:
    """Quads between points (b, r, c, 3) of b bodies, each of r rows round it with c points."""
    b, r, c = rows.shape[:3]
    number = np.arange(b * r * c).reshape(b, r, c)
    quads = np.stack([number[:, :-1, :-1], number[:, :-1, 1:], number[:, 1:, 1:], number[:, 1:, :-1]], axis=3)
    return rows.reshape(-1, 3), quads.reshape(-1, 4)


def _collar(of: Subject, on: Edge, v: float, reach: float) -> tuple[Floats, Ints]:
    """The prism on a rim, up to a little more than the fibre's reach."""
    u = on.u[0] + np.linspace(0.0, 1.0, _AROUND)
    points = of.paths.surface.points(np.stack([u, np.full_like(u, v)], axis=1))
    base = (points - on.origin) @ on.axis
    top = np.full_like(u, on.highest + (1.0 + _PAST) * reach)
    around = on.around(u)
    return _tubes(np.stack([on.points(around, base), on.points(around, top)])[None])


def _pins(of: Subject, on: Edge, v: float, turned: Turned) -> list[tuple[Floats, Ints]]:
    """The ring that pins stand on, and each pin that a fibre turns round."""
    before, last = _dwells(of.filaments, v)
    tops, normals = _at(of.filaments, (before, last))
    return [_collar(of, on, v, turned.reach), _posts(tops - turned.radius * on.axis, normals, turned.radius)]


def _shaft(of: Subject, on: Edge, v: float, turned: Turned) -> list[tuple[Floats, Ints]]:
    """The shaft, and the pins before it, along the axis, where fibres turn inwards."""
    level = on.highest + turned.reach
    polar = np.linspace(0.0, 2.0 * np.pi, _AROUND)
    ring = turned.radius * np.stack([np.cos(polar), np.sin(polar)], axis=1) @ on.across + on.origin
    ends = on.highest * np.ones(2) + turned.reach * np.array([-_SHAFT_BELOW, 1.0 + _SHAFT_ABOVE])
    shaft = _tubes((ring[None] + ends[:, None, None] * on.axis)[None])
    before, last = _dwells(of.filaments, v)
    kinks, normals = _at(of.filaments, ([each - 1 for each in before], [each + 1 for each in last]))
    slim = _SLIM * turned.reach
    foot = kinks - (slim * normals) - ((kinks - on.origin) @ on.axis - level)[:, None] * on.axis
    length = np.broadcast_to(on.axis, kinks.shape)
    return [shaft, _posts(foot - 0.5 * _STUB * slim * on.axis, length, slim)]


def _dwells(filaments: Sequence[Filament], v: float) -> tuple[list[Ints], list[Ints]]:
    """Of each filament the numbers of the points before each dwell at one end, and of the last points of each."""
    before, last = [], []
    for each in filaments:
        course = each.course
        # the fibre turns at the end after passes 0, 2, ... and at the start after passes 1, 3, ...
        dwell = (course.kind == Kind.DWELL) & (course.passed % 2 == (0 if v else 1))
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


def _posts(feet: Floats, along: Floats, radius: float) -> tuple[Floats, Ints]:
    """Closed cylinders from feet (k, 3) along unit vectors (k, 3)."""
    helper = np.eye(3)[np.abs(along).argmin(axis=1)]
    first = unit(np.cross(along, helper))
    second = np.cross(along, first)
    polar = np.linspace(0.0, 2.0 * np.pi, _SIDES)[:, None, None]
    ring = radius * (np.cos(polar) * first + np.sin(polar) * second)
    tip = feet + _STUB * radius * along
    rows = np.stack([np.broadcast_to(feet, ring.shape), feet + ring, tip + ring, np.broadcast_to(tip, ring.shape)])
    return _tubes(rows.transpose(2, 0, 1, 3))
