"""Compiled: fibres right beside marched ones, from the same starts with another slip.

Step by step the marched fibre and the one beside it are both taken on by a method of order 4, and the difference of the
two moves the marched row: its error is a share of that difference, which is small, and not of the step.
"""

from math import floor
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit
from meshwind.march.geodesic_equation import rates, runge_kutta_4
from meshwind.march.march import RIM_END, RIM_START
from meshwind.march.step_events import WIDTH
from meshwind.surface.evaluate import Spline

ERRORS = 10.0
"""Times the error of the worst step that the errors of all come to: 7 at most on a ball and on scanned ellipsoids."""
JUMPS = 1e-2
"""Share of the distance squared that it costs to meet knot lines in another order; 2e-3 on a barrel of many spans."""


class Beside(NamedTuple):
    """Rows (n, 5) of p fibres, one after the other, those beside them, and how good these are.

    first (p + 1,): the first row of each; slip (p, 2): as it was marched and as it is to be; stop (p,): why each
    ended; most: error, over the part's size, up to which they are good (p,).
    """

    first: Ints
    rows: Floats
    slip: Floats
    stop: Ints
    size: float
    most: float
    moved: Floats
    good: Bools


class Piece(NamedTuple):
    """A polynomial piece of the surface, in coordinates of its own; where it is among spans, and how many these are."""

    spline: Spline
    corner: Ints
    spans: Ints


@njit(cache=True)
def set_piece(spline, one, other, piece):
    """Set the piece on that between two rows, about its own corner to lose no digits."""
    for c in range(2):
        piece.corner[c] = int(floor(0.5 * (one[1 + c] + other[1 + c]) * piece.spans[c]))
    piece.corner[1] = min(max(piece.corner[1], 0), piece.spans[1] - 1)
    net, window, (i, j) = spline.net, piece.spline.net, piece.corner
    i = i % piece.spans[0] if spline.periodic else i
    for a in range(4):
        for b in range(4):
            for k in range(3):
                window[a, b, k] = net[i + a, j + b, k] - net[i + 1, j + 1, k]


@njit(cache=True)
def local(piece, row, y):
    """Write the piece's own coordinates of a row, and their rates, into y (4,)."""
    for c in range(2):
        y[c], y[2 + c] = row[1 + c] * piece.spans[c] - piece.corner[c], row[3 + c] * piece.spans[c]


@njit(cache=True)
def go_on(piece, slip, row, h, y, K, at, out):
    """Write into out (4,) where a row leads in a step of order 4."""
    local(piece, row, y)
    rates(piece.spline, slip, y, at, K[0])
    runge_kutta_4(piece.spline, slip, y, h, at, K, out)


@njit(cache=True)
def to_line(piece, slip, row, base, y, K, at):
    """Move a row along its fibre, by little, to the knot line that the marched one is on, if that is on one.

    K: the stages of the step that led there, of which the last says how the fibre bends well enough to begin with.
    """
    for c in range(2):
        wall = base[1 + c] * piece.spans[c] - piece.corner[c]
        if min(abs(wall), abs(wall - 1.0)) > WIDTH:
            continue
        local(piece, row, y)
        h = (wall - y[c]) / y[2 + c]
        h -= 0.5 * K[3, 2 + c] * h * h / y[2 + c]
        for k in range(2):
            y[k] += 0.5 * h * y[2 + k]
            y[2 + k] += 0.5 * h * K[3, 2 + k]
        rates(piece.spline, slip, y, at, K[1])
        row[0] += h
        for k in range(2):
            row[1 + k] += h * K[1, k] / piece.spans[k]
            row[3 + k] += h * K[1, 2 + k] / piece.spans[k]
        row[1 + c] = base[1 + c]
        return


@njit(nogil=True, cache=True)
def go_beside(first, last, spline, beside):
    """Write the rows beside those of fibres first to last."""
    at, here, there = np.empty((7, 3)), np.empty((4, 4)), np.empty((4, 4))
    y, old, new = np.empty(4), np.empty(4), np.empty(4)
    spans = np.array([spline.net.shape[0] - 3, spline.net.shape[1] - 3])
    piece = Piece(Spline(np.empty((4, 4, 3)), False), np.empty(2, np.int64), spans)
    rows, moved = beside.rows, beside.moved
    for fibre in range(first, last):
        begin, end = beside.first[fibre], beside.first[fibre + 1]
        before, after = beside.slip[fibre]
        moved[begin] = rows[begin]
        wide = rough = 0.0
        for i in range(begin, end - 1):
            h = rows[i + 1, 0] - rows[i, 0]
            set_piece(spline, rows[i], rows[i + 1], piece)
            go_on(piece, before, rows[i], h, y, here, at, old)
            go_on(piece, after, moved[i], h, y, there, at, new)
            moved[i + 1, 0] = moved[i, 0] + h
            for c in range(4):
                size = (1.0 if c < 2 else beside.size) / spans[c % 2]
                # what a method of order 2 gives instead
                second = (moved[i, 1 + c] - rows[i, 1 + c]) * spans[c % 2] + h * (there[1, c] - here[1, c])
                rough = max(rough, abs(new[c] - old[c] - second) * size)
                wide = max(wide, abs(new[c] - old[c]) * size)
                moved[i + 1, 1 + c] = rows[i + 1, 1 + c] + (new[c] - old[c]) / spans[c % 2]
            to_line(piece, after, moved[i + 1], rows[i + 1], y, there, at)
        ended = beside.stop[fibre] in (RIM_START, RIM_END)
        # of a method of order 2 the share of the difference squared is about that of one of order 4
        error = ERRORS * rough * rough / wide + JUMPS * wide * wide if wide > 0.0 else 0.0
        beside.good[fibre] = ended and error <= beside.most
