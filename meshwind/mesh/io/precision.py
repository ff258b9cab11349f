"""How finely the coordinates of a file resolve its part: coarsely, if it lies far from the origin."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.file_mesh import FileMesh

_COARSE = 2e-5
"""Steps of the coordinates over the part's extent from which on rounding alone moves vertices of a smooth part off the
fitted surface by more than the default tolerance: by about 0.6 of a step, as measured on a barrel."""
_USELESS = 1e-2
"""Steps from which on the surface is off by half a per cent of the part and more."""
_HUGE = 1e50
_FAR = 10.0
"""Least distance from the origin, over the extent, at which a lack of digits is looked for."""
_DIGITS = 7
"""Significant decimal digits up to which a text is taken for rounded, as by "%g" or of single precision; one that has
more on any axis holds round numbers on the others by design."""
_MANY, _FILLED = 12, 0.5
"""Different coordinates on an axis, or share of all possible ones, that show that steps limit them; a box has two."""


@dataclass(frozen=True)
class _Steps:
    """The step between possible coordinates, 0 if none was found, and the words for what limits them."""

    size: float
    limit: str = "single precision resolves steps of"
    instead: str = "in double precision (OBJ, VTU, PLY of doubles)"


def resolved(name: str, held: FileMesh) -> FileMesh:
    """The surface, with a warning if its coordinates are coarse; raises BadInputError if they hold no shape."""
    points = _used(held)
    size = float(np.abs(points).max(initial=0.0))
    if not 0.0 < size < _HUGE:
        return held  # refused by the repair
    extent = float(np.ptp(points, axis=0).max())
    if not size > _FAR * extent > 0.0:
        return held
    steps = _single(points, extent)
    if not steps.size:
        steps = _decimal(points, extent)
    if not steps.size:
        return held
    text = (
        f"lies {size:.2g} from the origin, where {steps.limit} {steps.size:.2g} of a part {extent:.2g} long; move the "
        f"part to the origin and export it again, or {steps.instead}"
    )
    if steps.size > _USELESS * extent:
        raise BadInputError(f"{name}: {text}")
    return replace(held, warnings=(*held.warnings, text))


def _used(held: FileMesh) -> Floats:
    """Vertices that faces use; none if faces and vertices are not what the repair accepts."""
    points, faces = np.asarray(held.vertices, dtype=np.float64), np.asarray(held.faces)
    usual = points.ndim == 2 and faces.dtype.kind in "iu" and faces.size > 0
    if not usual or faces.min() < 0 or faces.max() >= len(points):
        return np.empty((0, 3))
    used = np.zeros(len(points), dtype=bool)
    used[faces] = True
    return points[used]


def _single(points: Floats, extent: float) -> _Steps:
    """Steps of single precision, if all coordinates are such numbers and some use its last digit, or steps are few."""
    with np.errstate(over="ignore"):
        held = points.astype(np.float32)
    if (held != points).any():
        return _Steps(0.0)
    size = np.abs(held).max(axis=0)
    found = [
        step
        for axis, step in enumerate(np.spacing(size).astype(np.float64))
        if step > _COARSE * extent
        and _limits(points[:, axis], step)
        # few steps may all be even ones
        and (step > _USELESS * extent or (points[:, axis] / step % 2.0 == 1.0).any())
    ]
    return _Steps(max(found, default=0.0))


def _decimal(points: Floats, extent: float) -> _Steps:
    """Steps of a text of few digits: the largest power of ten that all coordinates of an axis are multiples of."""
    found = [0.0]
    for axis in points.T:
        size = float(np.abs(axis).max())
        if not size:
            continue
        leading = int(np.floor(np.log10(size)))
        steps = [10.0 ** (leading - digits + 1) for digits in range(6, _DIGITS + 1)]
        step = next((step for step in steps if _multiples(axis, step, size)), 0.0)
        if not step:
            return _Steps(0.0)  # this axis has more digits, and so the file has
        if step > _COARSE * extent and _limits(axis, step):
            found.append(step)
    return _Steps(max(found), "its digits resolve steps of", "with more digits")


def _multiples(values: Floats, step: float, size: float) -> bool:
    return bool((np.abs(values - np.round(values / step) * step) <= 4.0 * np.spacing(size)).all())


def _limits(values: Floats, step: float) -> bool:
    """Whether there are so many different values that they do not lie on these steps by design."""
    levels = np.unique(np.round(values / step))
    return len(levels) >= min(_MANY, _FILLED * (levels[-1] - levels[0] + 1.0))
