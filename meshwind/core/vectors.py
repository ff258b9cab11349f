"""Arithmetic on rows of vectors, component by component: sums over so short an axis cost several times as much."""

import numpy as np

from meshwind.core.cast import Floats

TINY = 1e-300
"""Keeps a quotient finite where the divisor may vanish."""


def dots(one: Floats, other: Floats) -> Floats:
    """Inner products (...) of vectors (..., d)."""
    found = one[..., 0] * other[..., 0]
    for k in range(1, one.shape[-1]):
        found = found + one[..., k] * other[..., k]
    return np.asarray(found)


def sizes(vectors: Floats) -> Floats:
    """Lengths (...) of vectors (..., d)."""
    return np.asarray(np.sqrt(dots(vectors, vectors)))


def unit(vectors: Floats) -> Floats:
    """Vectors (..., d) over their lengths; those without a length stay zero."""
    size = sizes(vectors)[..., None]
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)


def rotation(axis: Floats, angle: float) -> Floats:
    """The rotation (3, 3) about a unit axis through the origin by an angle in radians."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross))
