"""Lists of different length, one after the other in an array."""

import numpy as np

from meshwind.core.cast import Ints


def spread(begins: Ints, sizes: Ints, width: int = 1) -> Ints:
    """Positions of all numbers of lists that begin at some positions (n,), each number `width` after the last."""
    step = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    return np.repeat(begins, sizes) + step * width
