"""The level lines of a surface, where v is constant: how far apart they are, and where along the part."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline, PchipInterpolator

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.vectors import TINY, unit
from meshwind.surface.evaluate import SU, S
from meshwind.surface.forms import area_elements
from meshwind.surface.grid import rings
from meshwind.surface.surface import Surface

_PER_SPAN, _LEAST = 8, 257
"""Level lines per span of the surface, and at least; the distances between them are integrals over these."""
_AROUND = 4
"""Points around a level line for each span."""


@dataclass(frozen=True)
class Levels:
    """Level lines at v (k,) of a surface that closes in u.

    Attributes
    ----------
    v : ndarray of float, shape (k,)
        From 0 to 1.
    apart : ndarray of float, shape (k, m)
        Distance between neighbouring lines over the step in v, at m even values of u, in the surface's units.
    length : ndarray of float, shape (k,)
        Length of each line.
    height : ndarray of float, shape (k,)
        Coordinate of each line's middle along the axis through the middles of both rims. The axis points the way in
        which the coordinate that it changes most grows, so that on an upright part the height is z.
    """

    v: Floats
    apart: Floats
    length: Floats
    height: Floats

    @property
    def widest(self) -> Floats:
        """Distance (k,) from v=0 to each line where lines are furthest apart, in the surface's units."""
        return _passed(self.v, self.apart.max(axis=1))

    @property
    def mean(self) -> Floats:
        """Mean distance (k,) from v=0 to each line, in the surface's units."""
        return _passed(self.v, self.apart.mean(axis=1))


def levels(surface: Surface) -> Levels:
    """The level lines of a surface; raises BadInputError if it does not close in u."""
    if not surface.periodic:
        raise BadInputError("level lines run round parts that close in u only; wind a part that does")
    v = np.linspace(0.0, 1.0, max(_PER_SPAN * surface.spans[1] + 1, _LEAST))
    many = _AROUND * surface.spans[0]
    frames = rings(surface, v, many)
    speed = np.linalg.norm(frames[:, :, SU], axis=2)
    area = area_elements(frames.reshape(-1, 6, 3)).reshape(len(v), many)
    middle = (frames[:, :, S] * speed[..., None]).sum(axis=1) / np.maximum(speed.sum(axis=1), TINY)[:, None]
    axis = unit(middle[-1] - middle[0])
    axis = axis * (1.0 if axis[np.argmax(np.abs(axis))] >= 0.0 else -1.0)
    return Levels(
        frozen(v), frozen(area / np.maximum(speed, TINY)), frozen(speed.mean(axis=1)), frozen(middle @ axis)
    )  # fmt: skip


def _passed(v: Floats, rate: Floats) -> Floats:
    """Integral (k,) of a rate (k,) from v=0."""
    return np.asarray(PchipInterpolator(v, rate).antiderivative()(v))


def level_at(distance: Floats, lines: Levels) -> CubicHermiteSpline:
    """v as a smooth growing function of a distance (k,) from v=0, which is one of the lines' properties."""
    rate = np.gradient(distance, lines.v, edge_order=2)
    return CubicHermiteSpline(distance, lines.v, 1.0 / np.maximum(rate, TINY))


def station(place: float | str, lines: Levels) -> float:
    """The v of a place along the part.

    Parameters
    ----------
    place : float or str
        v from 0 to 1 as a number or as "v=0.3"; "z=120" for a height along the axis, in the part's coordinates;
        "fraction=0.3" for a share of the mean length along the part; in capitals, too.
    lines : Levels
        The surface's level lines.

    Returns
    -------
    float
        v in [0, 1].

    Raises
    ------
    BadInputError
        If the place cannot be read or lies off the part.
    """
    name, value = _named(place)
    if name == "v":
        return _within(value, 0.0, 1.0, place)
    along = lines.height if name == "z" else lines.mean / lines.mean[-1]
    _within(value, float(along.min()), float(along.max()), place)
    beyond = np.sign(along - value)
    first = int(np.argmax(beyond != beyond[0])) if (beyond != beyond[0]).any() else 0
    if first == 0:
        return float(lines.v[0])
    a, b = along[first - 1], along[first]
    return float(np.interp((value - a) / (b - a), [0.0, 1.0], lines.v[first - 1 : first + 1]))


def stretch(first: float | str, last: float | str, lines: Levels) -> tuple[float, float]:
    """The v of two places along the part, as `station` reads them.

    Raises BadInputError where a place cannot be read, or where they are not in order from the part's start to its end.
    """
    begin, end = station(first, lines), station(last, lines)
    if begin < end:
        return begin, end
    if begin == end:
        raise BadInputError(f"it starts and ends at v={begin:g}; give two places")
    raise BadInputError(
        f"it starts at {with_v(first, begin)} and ends at {with_v(last, end)}, but v grows from the part's start to "
        "its end; give its places the other way round"
    )


def with_v(place: float | str, v: float) -> str:
    """A place as it was given, and its v if that is not it."""
    name, value = _named(place)
    return f"v={v:.4g}" if name == "v" else f"{name}={value:g} (v={v:.4g})"


def _named(place: float | str) -> tuple[str, float]:
    """The kind of a place, "v", "z" or "fraction", and its number."""
    if not isinstance(place, str):
        return "v", float(place)
    name, _, text = place.rpartition("=")
    try:
        value = float(text)
    except ValueError:
        value = np.nan
    name = name.strip().lower() or "v"
    if name not in ("v", "z", "fraction") or not np.isfinite(value):
        raise BadInputError(
            f"{shortened(repr(place))} is no place along the part; give a v from 0 to 1, z=120 or fraction=0.3; z is "
            "the height along the part's own axis, whichever way that runs"
        )
    return name, value


def _within(value: float, low: float, high: float, place: float | str) -> float:
    """The value, if it is between the bounds."""
    slack = 1e-9 * max(high - low, abs(high), abs(low))
    if not low - slack <= value <= high + slack:
        raise BadInputError(f"{place} lies off the part, which goes from {low:g} to {high:g}; give a place between")
    return min(max(value, low), high)
