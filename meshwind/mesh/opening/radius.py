"""Open the poles of a part, each as wide as was asked for or as suits it."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths
from meshwind.mesh.opening.ends import End
from meshwind.mesh.opening.opening import opened, without_lining
from meshwind.mesh.opening.poles import Lip
from meshwind.mesh.opening.skin import Skin

_SHARE = 1.0 / 3.0  # of the area, the most that an opening may take
_DEFAULT, _LEAST, _WIDEST_BY_EDGES = 0.4, 0.02, 0.5  # radius of an opening over the mean radius of the part
_EDGES = 3.0  # that a default opening spans at least, by the faces' shortest ones: long ones tell nothing
_DEPTHS = (0.0, 0.01, 0.02, 0.03, 0.05)  # below the lip, over the part's extent
_SHRINK = 0.8  # step by which a default radius is tried


@dataclass(frozen=True)
class _Limits:
    """Default and least radius of an opening, and its largest area."""

    usual: float
    least: float
    most: float


def with_openings(surface: Skin, pair: list[End], wanted: float | None, name: str) -> tuple[Skin, list[float]]:
    """Cut the surface at each lip and open each pole; also gives the radii of the openings.

    Raises BadInputError where an opening of the radius that is wanted, or any at all, does not fit.
    """
    for end in pair:
        if end.lip is not None:
            surface = _at_lip(surface, end, end.lip, name)
    limits = _limits(surface, pair, name)
    radii = []
    for end, other in zip(pair, pair[::-1], strict=True):
        if end.is_pole:
            surface, radius = _open(surface, end, other, wanted, limits, name)
            radii.append(radius)
    return surface, radii


def _at_lip(surface: Skin, end: End, lip: Lip, name: str) -> Skin:
    """Cut the surface at a lip, a little lower where the lip is ragged."""
    extent = float(np.ptp(surface.vertices @ lip.direction))
    for depth in _DEPTHS:
        result = without_lining(surface, replace(lip, height=lip.height - depth * extent))
        if result is not None:
            return result
    raise BadInputError(f"{name}: the end at {end.place} is hollow with a ragged lip; cut the part open below the lip")


def _limits(surface: Skin, pair: list[End], name: str) -> _Limits:
    """Bounds from the part's mean radius, which is that of the tube of the same area and length, or of the ball."""
    area = float(areas(surface.vertices, surface.faces).sum())
    direction = pair[1].centre - pair[0].centre
    gap = float(np.linalg.norm(direction))
    if gap < 1e-6 * np.linalg.norm(np.ptp(surface.vertices, axis=0)):
        raise BadInputError(f"{name}: both ends fall on one place, {pair[0].place}; give ends further apart")
    length = float(np.ptp(surface.vertices @ (direction / gap)))
    mean = min(area / (2.0 * np.pi * length), float(np.sqrt(area / (4.0 * np.pi))))
    edge = float(np.median(edge_lengths(surface.vertices, surface.faces).min(axis=1)))
    usual = max(_DEFAULT * mean, min(_EDGES * edge, _WIDEST_BY_EDGES * mean))
    return _Limits(usual, _LEAST * mean, _SHARE * area)


def _open(surface: Skin, end: End, other: End, wanted: float | None, limits: _Limits, name: str) -> tuple[Skin, float]:
    """Cut one opening; a radius that the user did not give shrinks until it fits."""

    def attempt(radius: float) -> Skin | None:
        return opened(surface, end.centre, other.centre, radius, limits.most)

    radius = limits.usual if wanted is None else wanted
    result = attempt(radius) if radius >= limits.least else None
    while result is None and wanted is None and radius * _SHRINK >= limits.least:
        radius *= _SHRINK
        result = attempt(radius)
    if result is not None:
        return result, radius
    good = limits.least
    if attempt(good) is None:
        remedy = "cut the part open there, or choose other ends: x, y, z or two points"
        raise BadInputError(f"{name}: no opening fits at {end.place}; {remedy}")
    bad = float(np.linalg.norm(np.ptp(surface.vertices, axis=0)))
    while bad > 1.02 * good:
        middle = float(np.sqrt(good * bad))
        good, bad = (good, middle) if attempt(middle) is None else (middle, bad)
    size = "small" if radius < limits.least else "large"
    allowed = f"give a radius between {limits.least:.3g} and {good:.3g}"
    raise BadInputError(f"{name}: opening {radius:g} is too {size} at {end.place}; {allowed}")
