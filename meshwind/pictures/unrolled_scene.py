"""What is to be seen on unrolled.png: the chart as an image with the fibres on it."""

from typing import Any

import numpy as np

from meshwind.pictures.subject import Subject
from meshwind.surface.image import surface_image

_PIXELS = 384


def unrolled_scene(of: Subject) -> dict[str, Any]:
    """The chart, 1 x 1, its red, green and blue being x, y and z, and the fibres with their feet where they bridge."""
    points = np.array(surface_image(of.paths.surface, _PIXELS, _PIXELS))
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    return of.framed("unrolled", f"{of.name}: the part unrolled", _subtitle(low, high, of.units)) | {
        "image": (points - low) / np.where(high > low, high - low, 1.0),
        "uv": of.paths.uv[:, of.kept],
        "bridging": ~of.paths.on_surface[:, of.kept],
        "family": of.paths.family,
        "taut": of.taut,
    }


def _subtitle(low: Any, high: Any, units: str) -> str:
    step = 1e-3 * float((high - low).max())  # what is less is round-off, and would be told as such
    low, high = (np.rint(end / step) * step + 0.0 for end in (low, high))
    tints = zip("xyz", low, high, ("red", "green", "blue"), strict=True)
    spans = (f"{name} {a:.4g} to {b:.4g} as {tint}" for name, a, b, tint in tints)
    return f"colour is the place in space: {', '.join(spans)}" + (f", in {units}" if units else "")
