"""Radii of the openings at the poles: the given one, or the largest suitable one that fits."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths
from meshwind.mesh.opening.choose_ends import End
from meshwind.mesh.opening.curved_facets import CurvedFacets
from meshwind.mesh.opening.cut_opening import cut_at_lip, cut_opening
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


@dataclass(frozen=True)
class _Limits:
    """Default and least radius of an opening, and its largest area."""

    default: float
    least: float
    max_area: float


def open_ends(
    surface: CurvedFacets, pair: list[End], given: float | None, name: str
) -> tuple[CurvedFacets, list[float]]:
    """Cut the surface at each lip and open each pole; also returns the radii of the openings.

    Raises BadInputError if an opening of the given radius, or any opening, does not fit.
    """
    for end in pair:
        if end.lip is not None:
            surface = _at_lip(surface, end, end.lip, name)
    limits = _limits(surface, pair, name)
    radii = []
    for end, other in zip(pair, pair[::-1], strict=True):
        if end.is_pole:
            surface, radius = _open(surface, (end, other), given, limits, name)
            radii.append(radius)
    return surface, radii


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


def _open(
    surface: CurvedFacets, pair: tuple[End, End], given: float | None, limits: _Limits, name: str
) -> tuple[CurvedFacets, float]:
    """Cut the opening at the first of two ends; also returns its radius.  A default radius shrinks until it fits."""
    end, other = pair

    def attempt(radius: float) -> CurvedFacets | None:
        return cut_opening(surface, end.centre, other.centre, radius, limits.max_area)

    radius = limits.default if given is None else given
    result = attempt(radius) if radius >= limits.least else None
    while result is None and given is None and radius * _SHRINK >= limits.least:
        radius *= _SHRINK
        result = attempt(radius)
    if result is not None:
        return result, radius
    if attempt(limits.least) is None:
        remedy = "cut the part open there, or choose other ends: x, y, z or two points"
        raise BadInputError(f"{name}: no opening fits at {end.position}; {remedy}")
    largest = _largest(attempt, limits.least, float(np.linalg.norm(np.ptp(surface.vertices, axis=0))))
    size = "small" if radius < limits.least else "large"
    allowed = f"give a radius between {limits.least:.3g} and {largest:.3g}"
    raise BadInputError(f"{name}: opening {radius:g} is too {size} at {end.position}; {allowed}")


def _largest(attempt: Callable[[float], CurvedFacets | None], good: float, bad: float) -> float:
    """Largest radius that fits, by bisection between one that fits and one that does not."""
    while bad > _PRECISION * good:
        middle = float(np.sqrt(good * bad))
        good, bad = (good, middle) if attempt(middle) is None else (middle, bad)
    return good
