"""Arrays and colour maps in the page for a browser."""

import base64
from typing import Any, TypedDict

import numpy as np
from numpy.typing import NDArray

from meshwind.appearance.looks import colour_map

_STOPS = 33
"""Number of colours of a colour map in the page, which interpolates between them."""

Stops = list[list[float | str]]
"""A colour map as positions from 0 to 1, each with its colour."""


class Packed(TypedDict):
    """An array as base64 of float32 ("f4") or int32 ("i4"), rows one after the other."""

    type: str
    data: str


def packed(values: NDArray[Any]) -> Packed:
    """An array for the page."""
    kind = "<i4" if np.issubdtype(values.dtype, np.integer) else "<f4"
    return {
        "type": kind[1:],
        "data": base64.b64encode(np.ascontiguousarray(values, dtype=kind).tobytes()).decode("ascii"),
    }


def stops(name: str) -> Stops:
    """A colour map for the page, by its name."""
    at = np.linspace(0.0, 1.0, _STOPS)
    shades = colour_map(name)(at)[:, :3]
    return [
        [float(t), f"rgb({','.join(str(round(255 * part)) for part in shade)})"]
        for t, shade in zip(at, shades, strict=True)
    ]
