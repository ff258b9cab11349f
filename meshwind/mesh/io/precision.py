"""How finely a file resolves its coordinates: a part far from the origin may have lost its shape in its own file."""

import math
from dataclasses import replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.file_mesh import FileMesh

_LOST, _COARSE = 1e-2, 2e-5
"""Step of the coordinates over the part's largest extent above which its shape is lost, and above which it suffers."""
_DIGITS = (5, 6, 7)
"""Numbers of digits that programs write: fewer are taken for a part whose measures are whole numbers."""


def resolved(name: str, held: FileMesh) -> FileMesh:
    """The surface, with a warning where its coordinates are coarse; raises BadInputError where the shape is lost."""
    points = held.vertices[np.unique(held.faces)] if _indexed(held) else held.vertices
    if not len(points) or not np.isfinite(points).all():
        return held
    far, extent = float(np.abs(points).max()), float(np.ptp(points, axis=0).max())
    if not (0.0 < extent < far / 10.0 and math.isfinite(extent)):
        return held
    step, what = _step(points, far)
    if step <= _COARSE * extent:
        return held
    text = f"lies {far:.3g} from the origin, where {what} steps of {step:.2g} of a part {extent:.4g} long"
    advice = "move the part to the origin and export it again"
    if step > _LOST * extent:
        raise BadInputError(f"{name}: {text}; {advice}")
    return replace(held, warnings=(*held.warnings, f"the part {text}; {advice}"))


def _indexed(held: FileMesh) -> bool:
    return bool(held.faces.min() >= 0 and held.faces.max() < len(held.vertices)) if len(held.faces) else False


def _step(points: Floats, far: float) -> tuple[float, str]:
    """Least difference that the coordinates can have, 0 if it is that of double precision, and why."""
    if far < np.finfo(np.float32).max and (points.astype(np.float32) == points).all():
        return float(np.spacing(np.float32(far))), "single precision resolves"
    for digits in _DIGITS:
        step = 10.0 ** (math.floor(math.log10(far)) + 1 - digits)
        if np.abs(points / step - np.round(points / step)).max() < 1e-6 * 10.0 ** (digits - 5):
            return step, f"numbers of {digits} digits have"
    return 0.0, ""
