"""Arrays and colour maps in the page for a browser."""

import base64
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from meshwind.appearance.looks import colour_map

_STOPS = 33
"""Number of colours of a colour map in the page, which interpolates between them."""
_WHOLE = "u1", "i2", "i4"
"""Types of whole numbers, the shortest first."""

Stops = list[list[float | str]]
"""A colour map as positions from 0 to 1, each with its colour."""


class Packed(TypedDict):
    """An array as base64, rows one after the other: of whole numbers (u1, i2, i4) or of float16 or float32 (f2, f4)."""

    type: str
    data: str


def packed(values: NDArray[Any]) -> Packed:
    """An array for the page: whole numbers in the shortest type that holds them, others as float32."""
    if not np.issubdtype(values.dtype, np.integer):
        return _as("f4", values)
    low, high = (int(values.min()), int(values.max())) if values.size else (0, 0)
    fits = [name for name in _WHOLE if np.iinfo(name).min <= low and high <= np.iinfo(name).max]
    return _as(fits[0], values)


def packed_short(values: NDArray[Any]) -> Packed:
    """An array of values that are shown with three digits, as float16; what float16 cannot hold goes as float32."""
    known = np.abs(values[np.isfinite(values)])
    low, high = np.finfo(np.float16).smallest_normal, np.finfo(np.float16).max
    held = (known == 0.0) | ((known >= low) & (known <= high))
    return _as("f2" if held.all() else "f4", values)


def _as(kind: str, values: NDArray[Any]) -> Packed:
    shown = np.ascontiguousarray(values, dtype=f"<{kind}")
    return {"type": kind, "data": base64.b64encode(shown.tobytes()).decode("ascii")}


def stops(name: str) -> Stops:
    """A colour map for the page, by its name."""
    at = np.linspace(0.0, 1.0, _STOPS)
    shades = colour_map(name)(at)[:, :3]
    return [[float(t), _hexadecimal(shade)] for t, shade in zip(at, shades, strict=True)]


def _hexadecimal(shade: NDArray[Any]) -> str:
    return "#" + "".join(f"{round(255 * float(part)):02x}" for part in shade)
