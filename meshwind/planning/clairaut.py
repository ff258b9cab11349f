"""Clairaut's bound: on a shape of revolution r sin(alpha) is constant, so no fibre can turn more than it allows."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats, frozen
from meshwind.core.vectors import TINY
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.forms import fundamental_forms
from meshwind.surface.grid import composite_gauss, parameter_grid, rim_frames, rings
from meshwind.surface.surface import Surface

_AROUND, _ALONG = 24, 96
"""Samples by which a surface is compared with the shape of revolution about its axis."""
_MERIDIAN, _WINDING = 64 * _ALONG, 8 * _ALONG
"""Samples of the meridian: for distances from it, and for the angle that it winds."""
_RIM_SAMPLES = 16
"""Samples of a rim per span, for its middle."""
_SHORTEST = 1e-3
"""Least distance between the rims' middles over the part's size: closer together they give no axis."""
_EXACT, _FITTED = 1e-6, 2.0
"""Largest deviation from a shape of revolution: over the part's size, and over the fit's largest error."""
_FLAT = 1e-3
"""Slope dr/ds at a rim below which it is as good as cylindrical: the bound is then beyond any use."""
_TWIST = 1e-3
"""Turns by which a meridian of the chart may wind from rim to rim."""
_NODES = 6
"""Gauss nodes per interval along the meridian."""
_FEWEST = 64
"""Fewest intervals."""
_ROOT = 1e-24
"""Least (r^2 - c^2) / r^2, which keeps the integrand finite where a node all but lies on the rim."""
_CONSTANTS = 64
"""Values of Clairaut's constant at which the turns are compared."""
_SAME_RIM = 1e-9
"""Relative difference of the rims' radii that is round-off."""
_HOLLOW = -1e-6
"""Least normal curvature, over the largest radius, that counts as pressing: below it lies the fit's noise."""


class Axis(NamedTuple):
    """The line through the middles of the two rims: a point (3,), and a unit vector (3,) from start to end."""

    middle: Floats
    along: Floats

    def coordinates(self, points: Floats) -> Floats:
        """Distance from the axis and height along it (k, 2) of points (k, 3)."""
        off = points - self.middle
        height = off @ self.along
        return np.stack([np.linalg.norm(off - height[:, None] * self.along, axis=1), height], axis=1)

    def across(self, points: Floats) -> Floats:
        """Vectors (k, 3) to points (k, 3) from the nearest points of the axis."""
        off = points - self.middle
        return np.asarray(off - (off @ self.along)[:, None] * self.along)


class Rings(NamedTuple):
    """Means around the part at k values of v: radius, its slope dr/ds, speed ds/dv, curvatures along and around."""

    r: Floats
    slope: Floats
    speed: Floats
    bend: Floats
    hoop: Floats


@dataclass(frozen=True)
class Profile:
    """The meridian of a shape of revolution at k Gauss nodes.

    v (k,): parameter; r (k,): radius; weight (k,) carries the arc length, so that sum(f weight) is the integral of
    f ds, also where f has an inverse square root at a rim; bend, hoop (k,): normal curvatures along and around; rims:
    the two radii; slopes: dr/ds at both; deviation: largest distance of the surface from the shape.
    """

    v: Floats
    r: Floats
    weight: Floats
    bend: Floats
    hoop: Floats
    rims: tuple[float, float]
    slopes: tuple[float, float]
    deviation: float

    def turns(self, constant: float) -> float:
        """Turns from rim to rim of the geodesic with c = r sin(alpha): the integral of c / (r sqrt(r^2 - c^2)) ds."""
        root = np.sqrt(np.maximum((self.r - constant) * (self.r + constant), _ROOT * self.r**2))
        return float((constant / (self.r * root) * self.weight).sum() / (2.0 * np.pi))

    def bound(self) -> float:
        """Largest revolutions of a fibre that does not slide off: those at c = the smaller rim's radius; or infinity.

        Infinite where the part is narrowest between the rims, or does not widen behind the narrower rim.
        """
        narrow = min(self.rims)
        inward = self.slopes[0], -self.slopes[1]
        at_narrow = [slope for rim, slope in zip(self.rims, inward, strict=True) if rim <= narrow * (1.0 + _SAME_RIM)]
        if self.r.min() < narrow or min(at_narrow) < _FLAT:
            return float("inf")
        # with a bulge the turns can decrease before c reaches the rim; past the largest no fibre is stable
        shares = np.sin(np.linspace(0.0, 0.5 * np.pi, _CONSTANTS + 1)[1:])
        return max(self.turns(narrow * share) for share in shares)

    def presses(self, constant: float) -> bool:
        """Whether the geodesic presses on the part all the way."""
        square = np.minimum((constant / self.r) ** 2, 1.0)
        return bool((self.hoop * square + self.bend * (1.0 - square) >= _HOLLOW / self.r.max()).all())


def profile(surface: Surface) -> Profile | None:
    """The meridian of a surface that is one of revolution to the fit's error, whose v runs from rim to rim; or None."""
    allowed = _EXACT * surface.size
    if surface.error is not None:
        allowed = max(allowed, _FITTED * surface.error.max)
    axis = _axis(surface)
    if axis is None:
        return None
    uv = parameter_grid(np.arange(_AROUND) / _AROUND, np.linspace(0.0, 1.0, _ALONG + 1))
    deviation = _from_line(axis.coordinates(surface.points(uv)), axis.coordinates(_meridian(surface, _MERIDIAN)))
    if deviation > allowed or abs(_twist(surface, axis)) > _TWIST:
        return None
    return _nodes(surface, axis, deviation)


def _axis(surface: Surface) -> Axis | None:
    """The axis of a surface, None where the rims' middles are too close together."""
    middles = []
    for v in (0.0, 1.0):
        frames = rim_frames(surface, v, _RIM_SAMPLES)
        speed = np.linalg.norm(frames[:, SU], axis=1)
        middles.append((frames[:, S] * speed[:, None]).sum(axis=0) / max(float(speed.sum()), TINY))
    step = middles[1] - middles[0]
    length = float(np.linalg.norm(step))
    return Axis(middles[0], step / length) if length > _SHORTEST * surface.size else None


def _meridian(surface: Surface, count: int) -> Floats:
    """Points (count + 1, 3) of the chart's meridian u = 0."""
    v = np.linspace(0.0, 1.0, count + 1)
    return surface.points(np.stack([np.zeros_like(v), v], axis=1))


def _from_line(points: Floats, line: Floats) -> float:
    """Largest distance of points (k, 2) from a fine polyline (m, 2) that is continued straight past its ends."""
    near = np.clip(cKDTree(line).query(points)[1], 1, len(line) - 2)
    chord = line[near + 1] - line[near - 1]
    off = points - line[near]
    across = chord[:, 0] * off[:, 1] - chord[:, 1] * off[:, 0]
    return float(np.abs(across / np.maximum(np.linalg.norm(chord, axis=1), TINY)).max())


def _twist(surface: Surface, axis: Axis) -> float:
    """Turns that the chart's meridian u = 0 winds about the axis from rim to rim."""
    off = axis.across(_meridian(surface, _WINDING))
    step = np.arctan2(np.cross(off[:-1], off[1:]) @ axis.along, (off[:-1] * off[1:]).sum(axis=1))
    return float(step.sum() / (2.0 * np.pi))


def _nodes(surface: Surface, axis: Axis, deviation: float) -> Profile:
    """Integrate over t in v = (1 - cos(pi t)) / 2, which takes away the inverse square roots at the rims."""
    t, weight = composite_gauss(max(2 * surface.spans[1], _FEWEST), _NODES)
    v = np.concatenate([[0.0], np.sin(0.5 * np.pi * t) ** 2, [1.0]])
    found = _mean_rings(surface, axis, v)
    stretch = 0.5 * np.pi * np.sin(np.pi * t) * weight
    return Profile(
        v=frozen(v[1:-1]),
        r=frozen(found.r[1:-1]),
        weight=frozen(found.speed[1:-1] * stretch),
        bend=frozen(found.bend[1:-1]),
        hoop=frozen(found.hoop[1:-1]),
        rims=(float(found.r[0]), float(found.r[-1])),
        slopes=(float(found.slope[0]), float(found.slope[-1])),
        deviation=deviation,
    )


def _mean_rings(surface: Surface, axis: Axis, v: Floats) -> Rings:
    """The means around the part at v (k,)."""
    frames = rings(surface, v, _AROUND).reshape(-1, 6, 3)
    out = axis.across(frames[:, S])
    r = np.linalg.norm(out, axis=1)
    speed = np.linalg.norm(frames[:, SV], axis=1)
    slope = (out * frames[:, SV]).sum(axis=1) / np.maximum(r * speed, TINY)
    forms = fundamental_forms(frames)
    bend = forms.second.vv / np.maximum(forms.first.vv, TINY)
    hoop = forms.second.uu / np.maximum(forms.first.uu, TINY)
    return Rings(*(each.reshape(len(v), _AROUND).mean(axis=1) for each in (r, slope, speed, bend, hoop)))
