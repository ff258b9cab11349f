"""The fundamental forms of a surface, from its frames."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY, unit
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV


class Form(NamedTuple):
    """A quadratic form uu du^2 + 2 uv du dv + vv dv^2 at k points, each coefficient (k,)."""

    uu: Floats
    uv: Floats
    vv: Floats


class Forms(NamedTuple):
    """At k points: normal (k, 3), outward and of unit length; area (k,) of s_u x s_v; both fundamental forms.

    The second form over the first is the normal curvature, positive where the surface bulges outward.
    """

    normal: Floats
    area: Floats
    first: Form
    second: Form


def fundamental_forms(frames: Floats) -> Forms:
    """The forms at frames (k, 6, 3); where s_u and s_v are parallel the normal and the second form are 0."""
    su, sv = frames[:, SU], frames[:, SV]
    cross = np.cross(su, sv)
    normal = unit(cross)
    first = Form(*((a * b).sum(axis=1) for a, b in ((su, su), (su, sv), (sv, sv))))
    second = Form(*(-(frames[:, k] * normal).sum(axis=1) for k in (SUU, SUV, SVV)))
    return Forms(normal, np.linalg.norm(cross, axis=1), first, second)


def components(frames: Floats, vectors: Floats) -> Floats:
    """The (du, dv) (k, 2) at frames (k, 6, 3) with which du s_u + dv s_v is the part of vectors (k, 3) in the plane."""
    su, sv = frames[:, SU], frames[:, SV]
    e, f, g = ((a * b).sum(axis=1) for a, b in ((su, su), (su, sv), (sv, sv)))
    x, y = (vectors * su).sum(axis=1), (vectors * sv).sum(axis=1)
    return np.stack([g * x - f * y, e * y - f * x], axis=1) / np.maximum(e * g - f * f, TINY)[:, None]


def area_elements(frames: Floats) -> Floats:
    """|s_u x s_v| (k,) at frames (k, 6, 3)."""
    return np.asarray(np.linalg.norm(np.cross(frames[:, SU], frames[:, SV]), axis=1))
