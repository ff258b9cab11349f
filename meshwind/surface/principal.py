"""The principal curvatures of a surface and their directions, from its frames."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY, unit
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.forms import Forms

_ALIKE = 1e-12
"""Size of a row of II - k1 I, relative, down to which both principal curvatures are the same to round-off."""


class Principal(NamedTuple):
    """At k points: larger and smaller principal curvature (k,), and the unit tangent (k, 3) of the larger one."""

    largest: Floats
    smallest: Floats
    direction: Floats


def principal(frames: Floats, forms: Forms) -> Principal:
    """Principal curvatures at frames (k, 6, 3); `direction` is along s_u where all directions are alike."""
    (e, f, g), (l, m, n) = forms.first, forms.second
    safe = np.where(forms.area > 0.0, forms.area * forms.area, np.inf)  # a collapsed point counts as flat
    mean = 0.5 * (e * n - 2.0 * f * m + g * l) / safe
    root = np.sqrt(np.maximum(mean * mean - (l * n - m * m) / safe, 0.0))
    direction = _direction(forms, mean + root, frames[:, SU], frames[:, SV])
    return Principal(mean + root, mean - root, direction)


def _direction(forms: Forms, k1: Floats, su: Floats, sv: Floats) -> Floats:
    """The unit tangent (k, 3) of the larger principal curvature; along s_u where all directions are alike."""
    (e, f, g), (l, m, n) = forms.first, forms.second
    rows = [(m - k1 * f, k1 * e - l), (n - k1 * g, k1 * f - m)]  # either row of (II - k1 I) x = 0
    either = [a[:, None] * su + b[:, None] * sv for a, b in rows]
    size = [np.linalg.norm(tangent, axis=1) for tangent in either]
    best = np.where((size[0] >= size[1])[:, None], either[0], either[1])
    scale = (np.abs(k1) + TINY) * np.maximum(e, g) * np.sqrt(np.maximum(e, g))
    alike = np.maximum(*size) <= _ALIKE * scale
    return unit(np.where(alike[:, None], su, best))
