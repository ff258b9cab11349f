"""Half-legs of a fibre that turns on caps: from where it touches an opening to half-way along the part.

A leg leaves the opening along its tangent and is marched with constant slip to the level half-way.  The legs that
leave on the fibre's way and those that arrive, marched against it, are four kinds: two at each end.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy.interpolate import CubicSpline, PPoly

from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import unit
from meshwind.march.forward import Marched, marched, traces
from meshwind.march.traced import Stop
from meshwind.surface.evaluate import DEGREE, SU, SV
from meshwind.surface.surface import Surface

_SAMPLES = 256
"""Points of an opening at a distance from its rim: its curve is then exact to about 1e-9 turns where it is smooth."""
_LONGEST = 50.0
"""Sizes of the part that a half-leg may be long: one that is longer circles for ever, as on a prism at 90 degrees."""
FINEST = 1e-12
"""Tolerance of the marches, that of `traces`."""


@dataclass(frozen=True)
class Opening:
    """The closed curve v(u) that a fibre touches at an end: the rim itself, or a curve at a distance from it.

    end: 0 for the start rim, 1 for the end rim; level: v less that of the rim, with period 1, None for the rim itself.
    """

    end: int
    level: PPoly | None = None

    def at(self, u: Floats) -> Floats:
        """Points (n, 2) of the curve at u (n,), unwrapped."""
        more = np.zeros_like(u) if self.level is None else self.level(u)
        return np.stack([u, np.clip(self.end + more, 0.0, 1.0)], axis=1)

    def tangent(self, u: Floats) -> Floats:
        """Tangents (n, 2) at u (n,), towards growing u."""
        return np.stack([np.ones_like(u), np.zeros_like(u) if self.level is None else self.level(u, 1)], axis=1)

    def inside(self, uv: Floats) -> Floats:
        """How far in v fibres of points (..., n, 2) lie inside of the curve at the least."""
        off = uv[..., 1] if self.level is None else uv[..., 1] - self.level(uv[..., 0])
        return np.asarray(1.0 - off.max(axis=-1) if self.end else off.min(axis=-1))


def opening(surface: Surface, end: int, clearance: float = 0.0) -> Opening:
    """The curve that fibres touch at an end, at a distance `clearance` along the surface from the rim there."""
    if not surface.periodic:
        raise BadInputError("the surface does not close in u, so that it has no caps; give one that does")
    if not 0.0 <= clearance < np.inf:
        raise BadInputError(f"clearance is {clearance}; give a length from 0 up, in the surface's units")
    if clearance == 0.0:
        return Opening(end)
    rim = np.stack([np.arange(_SAMPLES) / _SAMPLES, np.full(_SAMPLES, float(end))], axis=1)
    frames = surface.frames(rim)
    su, sv = frames[:, SU], frames[:, SV]
    square, mixed = (su * su).sum(axis=1), (su * sv).sum(axis=1)
    away = np.stack([-mixed / square, np.ones(_SAMPLES)], axis=1) * (1 - 2 * end)  # square to the rim, inwards
    found = traces(surface, rim, away, clearance, press="ignore")
    if any(trace.stop != Stop.LENGTH for trace in found):
        raise BadInputError(f"clearance {clearance:g} is more than the part is long; give a smaller one")
    u, v = np.stack([trace.uv[-1] for trace in found], axis=1)
    if not (np.diff(np.append(u, u[0] + 1.0)) > 0.0).all():
        raise BadInputError(f"the curve at a clearance of {clearance:g} folds over itself; give a smaller one")
    level = CubicSpline(np.append(u, u[0] + 1.0), np.append(v, v[0]) - end, bc_type="periodic")
    return Opening(end, level)


@dataclass(frozen=True)
class Half:
    """A half of a surface, from one rim to a knot line half-way: the same spline, v' = (v - first) / (last - first)."""

    surface: Surface
    first: float
    last: float

    def into(self, uv: Floats) -> Floats:
        """Points (n, 2) of the whole surface in the half's own u and v'."""
        return np.stack([uv[:, 0], np.clip(self._own(uv[:, 1]), 0.0, 1.0)], axis=1)

    def out_of(self, uv: Floats) -> Floats:
        """Points (n, 2) of the half in u and v of the whole surface."""
        return np.stack([uv[:, 0], self.first + (self.last - self.first) * uv[:, 1]], axis=1)

    def _own(self, v: Floats) -> Floats:
        return np.asarray((v - self.first) / (self.last - self.first))


def halves(surface: Surface) -> tuple[Half, Half]:
    """The two halves of a surface, which meet at the knot line in the middle of v."""
    spans = surface.spans[1]
    if spans < 2:
        raise BadInputError("the surface has a single span along v; give one with 2 or more, to be halved")
    middle, net = spans // 2, surface.control_points
    at = middle / spans
    lower = Surface(net[:, : middle + DEGREE], surface.periodic)
    upper = Surface(net[:, middle:], surface.periodic)
    return Half(lower, 0.0, at), Half(upper, at, 1.0)


@dataclass(frozen=True)
class Legs:
    """Where n half-legs cross the level half-way: u there, unwrapped, and the angle from s_v towards +u, in radians.

    The angle is that of the fibre in the order of winding.  Where a leg did not arrive both are NaN.
    """

    u: Floats
    angle: Floats
    marched: Marched

    @property
    def arrived(self) -> Bools:
        """Which legs reach the level."""
        return np.isfinite(self.u)


@dataclass(frozen=True)
class End:
    """An end with a cap: its half of the surface, and the curve that fibres touch there."""

    half: Half
    opening: Opening

    @cached_property
    def name(self) -> str:
        """The end in words."""
        return "end" if self.opening.end else "start"

    def march(self, u: Floats, slip: Floats, leaving: bool, tolerance: float = FINEST) -> Legs:
        """March half-legs from touch points u (n,) with slips (n,), in the order of winding.

        leaving: whether the fibre leaves the opening, rather than arrives; slips are positive to the fibre's left on
        its own way, so that a leg that arrives is marched backwards with the opposite slip.
        """
        sign = 1.0 if leaving else -1.0
        scale = np.array([1.0, 1.0 / (self.half.last - self.half.first)])
        start, way = self.half.into(self.opening.at(u)), sign * self.opening.tangent(u) * scale
        surface = self.half.surface
        found = marched(
            surface, start, way, _LONGEST * surface.size, slip=sign * slip, press="ignore", tolerance=tolerance
        )
        return self.crossing(found, leaving)

    def beside(self, found: Marched, slip: Floats, leaving: bool, most: float) -> tuple[Marched, Bools]:
        """Half-legs from where those marched begin, with other slips (n,), and which are good; see `Marched.beside`."""
        return found.beside(slip if leaving else -slip, most)

    def crossing(self, found: Marched, leaving: bool) -> Legs:
        """Half-legs as they were marched, leaving or arriving, with where they cross the level half-way."""
        last = found.last
        frames = self.half.surface.frames(np.ascontiguousarray(last[:, 1:3]))
        su, sv = frames[:, SU], frames[:, SV]
        tangent = (last[:, 3:4] * su + last[:, 4:5] * sv) * (1.0 if leaving else -1.0)
        along = unit(sv)
        across = unit(np.cross(sv, np.cross(su, sv)))
        angle = np.arctan2((tangent * across).sum(axis=1), (tangent * along).sum(axis=1))
        there = found.stop == (Stop.RIM_START if self.opening.end else Stop.RIM_END)
        return Legs(np.where(there, last[:, 1], np.nan), np.where(there, angle, np.nan), found)
