"""Arithmetic on rows of vectors."""

import numpy as np

from meshwind.core.cast import Floats

TINY = 1e-300
"""Keeps a quotient finite where the divisor may vanish."""


def unit(vectors: Floats) -> Floats:
    """Vectors (..., d) over their lengths; those without a length stay zero."""
    size = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, size, out=np.zeros_like(vectors), where=size > 0.0)
