"""Compiled: fibres that hang between the part and what they turn on, in the place of their paths."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit


class Fibres(NamedTuple):
    """Points and normals (p, n, 3) of p fibres, their winding angle (p, n), and which hang in the air (p, n)."""

    points: Floats
    normal: Floats
    angle: Floats
    aloft: Bools


class Hanging(NamedTuple):
    """Fibres (k,) of numbers `rows` that leave the part so many particles before its end, or after its start.

    off, corner (k, 3): where they leave it and where they come to lie again, with the normal (k, 3) and the angle (k,)
    there.
    """

    rows: Ints
    many: Ints
    off: Floats
    corner: Floats
    normal: Floats
    angle: Floats
    end: bool


@njit(nogil=True, cache=True)
def hang(first, last, hanging, fibres):
    """Put the particles of fibres first to last on their way through the air: evenly, the last of them where it ends.

    Normals and angles are those of both its ends in shares.
    """
    turn = np.empty(3)
    for k in range(first, last):
        row, many = hanging.rows[k], hanging.many[k]
        off, corner = hanging.off[k], hanging.corner[k]
        final = fibres.angle.shape[1] - 1
        leaves = final - many if hanging.end else many
        for left in range(many + 1):  # from the rim on, up to where it leaves the part
            at = final - left if hanging.end else left
            share = left / many
            size = 0.0
            for c in range(3):
                fibres.points[row, at, c] = share * off[c] + (1.0 - share) * corner[c]
                turn[c] = share * fibres.normal[row, leaves, c] + (1.0 - share) * hanging.normal[k, c]
                size += turn[c] * turn[c]
            size = np.sqrt(size)
            for c in range(3):
                fibres.normal[row, at, c] = turn[c] / size if size > 0.0 else 0.0
            fibres.angle[row, at] = share * fibres.angle[row, leaves] + (1.0 - share) * hanging.angle[k]
            fibres.aloft[row, at] |= left < many
