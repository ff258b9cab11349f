"""Radii of the openings at the poles: the given one, or the largest suitable one that fits."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths
from meshwind.mesh.opening.choose_ends import End
from meshwind.mesh.opening.curved_facets import CurvedFacets
from meshwind.mesh.opening.cut_opening import cut_at_lip, cut_opening
from meshwind.mesh.opening.plane import FLAT, Plane, new_rim, opened_by_plane
from meshwind.mesh.opening.poles import Lip

_MAX_AREA = 1.0 / 3.0
"""Largest area of an opening, over that of the part."""
_DEFAULT, _LEAST, _WIDEST_BY_EDGES = 0.4, 0.02, 0.5
"""Default and least radius of an opening, and the largest that coarse faces give, over the mean radius of the part."""
_EDGES = 3.0
"""Least default radius, over the median of the faces' shortest edges, which is the resolution of the mesh."""
_DEPTHS = (0.0, 0.01, 0.02, 0.03, 0.05)
"""Depths below a lip at which it is cut, over the part's extent, until one is not ragged."""
_SHRINK = 0.8
"""Factor by which a default radius shrinks until the opening fits."""
_PRECISION = 1.02
"""Ratio to which the largest radius that fits is determined, for the message."""
_UNEVEN = 0.3
"""Unevenness of a level line's rim above which a plane is tried; samples: 0 to 0.25, but 0.35 to 0.55 on blades."""
_FLATTER = 0.5
"""The plane is taken if its rim's unevenness is less than this times that of the level line's."""


@dataclass(frozen=True)
class Opening:
    """An opening that was cut at a pole: its radius and how, "level" or "plane"; for a plane, that of its rim's area.

    why: reason why "auto" took the plane, or why a plane's opening is wider than wanted, in a sentence; else empty.
    """

    radius: float
    by: str
    why: str = ""

    def __str__(self) -> str:
        return f"radius {self.radius:.4g}{' by a plane' if self.by == 'plane' else ''}"


@dataclass(frozen=True)
class _Limits:
    """Default and least radius of an opening, and its largest area."""

    default: float
    least: float
    max_area: float


@dataclass(frozen=True)
class _Pole:
    """A pole to be opened: its end and the other one, the requested radius and way, and the name of the part."""

    end: End
    other: End
    given: float | None
    by: str
    name: str

    @property
    def outward(self) -> Floats:
        """Direction out of the part along its axis (3,), or along the line between the ends if it has none."""
        return unit(self.end.centre - self.other.centre) if self.end.outward is None else self.end.outward


def open_ends(
    surface: CurvedFacets, pair: list[End], given: float | None, by: str, name: str
) -> tuple[CurvedFacets, list[Opening]]:
    """Cut the surface at each lip and open each pole; also returns the openings.

    Raises BadInputError if an opening of the given radius, or any opening, does not fit.
    """
    for end in pair:
        if end.lip is not None:
            surface = _at_lip(surface, end, end.lip, name)
    limits = _limits(surface, pair, name)
    openings = []
    for end, other in zip(pair, pair[::-1], strict=True):
        if end.is_pole:
            surface, opening = _open(surface, _Pole(end, other, given, by, name), limits)
            openings.append(opening)
    return surface, openings


def _at_lip(surface: CurvedFacets, end: End, lip: Lip, name: str) -> CurvedFacets:
    """Cut the surface at a lip, or a little lower if the lip is ragged."""
    extent = float(np.ptp(surface.vertices @ lip.direction))
    for depth in _DEPTHS:
        result = cut_at_lip(surface, replace(lip, height=lip.height - depth * extent))
        if result is not None:
            return result
    raise BadInputError(
        f"{name}: the end at {end.position} is hollow with a ragged lip; cut the part open below the lip"
    )


def _limits(surface: CurvedFacets, pair: list[End], name: str) -> _Limits:
    """Bounds from the part's mean radius: that of a tube of the same area and length, or of a ball if it is smaller."""
    area = float(areas(surface.vertices, surface.faces).sum())
    direction = pair[1].centre - pair[0].centre
    gap = float(np.linalg.norm(direction))
    if gap < 1e-6 * np.linalg.norm(np.ptp(surface.vertices, axis=0)):
        raise BadInputError(f"{name}: both ends are at the same point, {pair[0].position}; give ends further apart")
    length = float(np.ptp(surface.vertices @ (direction / gap)))
    mean = min(area / (2.0 * np.pi * length), float(np.sqrt(area / (4.0 * np.pi))))
    edge = float(np.median(edge_lengths(surface.vertices, surface.faces).min(axis=1)))
    default = max(_DEFAULT * mean, min(_EDGES * edge, _WIDEST_BY_EDGES * mean))
    return _Limits(default, _LEAST * mean, _MAX_AREA * area)


def _open(surface: CurvedFacets, pole: _Pole, limits: _Limits) -> tuple[CurvedFacets, Opening]:
    """Cut one opening; "auto" takes the plane if its rim is far more even than that of the level line."""
    plane = Plane(pole.end.centre, pole.outward, pole.other.centre, limits.max_area)

    def by_plane(radius: float) -> CurvedFacets | None:
        return opened_by_plane(surface, plane, radius)

    def by_level_line(radius: float) -> CurvedFacets | None:
        return cut_opening(surface, pole.end.centre, pole.other.centre, radius, limits.max_area)

    if pole.by == "plane":
        cut, radius = _fitting(surface, pole, limits, by_plane)
        wide = new_rim(surface, cut).radius
        return cut, Opening(wide, "plane", _flatness(pole.end, radius, wide) if wide > FLAT * radius else "")
    cut, radius = _fitting(surface, pole, limits, by_level_line)
    if pole.by == "auto":
        uneven = new_rim(surface, cut).unevenness(pole.end.centre, pole.outward)
        flat = by_plane(radius) if uneven > _UNEVEN else None
        if flat is not None:
            rim = new_rim(surface, flat)
            less = rim.unevenness(pole.end.centre, pole.outward)
            if less < _FLATTER * uneven:
                return flat, Opening(rim.radius, "plane", _reason(pole.end, uneven, less))
    return cut, Opening(radius, "level")


def _flatness(end: End, wanted: float, wide: float) -> str:
    """Why the opening by a plane is wider than wanted."""
    return (
        f"the end at {end.position} is flat, so that a plane opens it to radius {wide:.4g} instead of {wanted:.4g}; "
        f"{argument('opening_by', 'level')} keeps to the radius"
    )


def _reason(end: End, level: float, plane: float) -> str:
    """Why a plane was taken, from the unevenness of both rims."""
    return (
        f"the end at {end.position} is opened by a plane, whose rim is uneven by {plane:.2g} of its radius; that of a "
        f"level line is by {level:.2g} ({argument('opening_by', 'level')} keeps it)"
    )


def _fitting(
    surface: CurvedFacets, pole: _Pole, limits: _Limits, attempt: Callable[[float], CurvedFacets | None]
) -> tuple[CurvedFacets, float]:
    """Cut an opening of the given radius, or of the default one, which shrinks until it fits; also gives the radius."""
    given = pole.given
    radius = limits.default if given is None else given
    result = attempt(radius) if radius >= limits.least else None
    while result is None and given is None and radius * _SHRINK >= limits.least:
        radius *= _SHRINK
        result = attempt(radius)
    if result is not None:
        return result, radius
    if attempt(limits.least) is None:
        remedy = "cut the part open there, or choose other ends: x, y, z or two points"
        raise BadInputError(f"{pole.name}: no opening fits at {pole.end.position}; {remedy}")
    largest = _largest(attempt, limits.least, float(np.linalg.norm(np.ptp(surface.vertices, axis=0))))
    size = "small" if radius < limits.least else "large"
    allowed = f"give a radius between {limits.least:.3g} and {largest:.3g}"
    raise BadInputError(f"{pole.name}: opening {radius:g} is too {size} at {pole.end.position}; {allowed}")


def _largest(attempt: Callable[[float], CurvedFacets | None], good: float, bad: float) -> float:
    """Largest radius that fits, by bisection between one that fits and one that does not."""
    while bad > _PRECISION * good:
        middle = float(np.sqrt(good * bad))
        good, bad = (good, middle) if attempt(middle) is None else (middle, bad)
    return good
