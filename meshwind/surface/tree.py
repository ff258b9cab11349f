"""A search tree over the surface: where Newton's method for foot points must start.

A local foot stays on the near flank of a thin rib while the true nearest point is on the other, and may even stop
at a saddle of the distance.  The tree's leaves are the surface's polynomial pieces, each in a flat box along it that
its Bezier points fill; above them is a pyramid of such boxes, each around sixteen.  A query for a piece that may come
nearer than a given foot ends at once where that foot is right: then only the boxes about the foot itself reach into
the ball around the point.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill, fill_table
from meshwind.core.vectors import TINY
from meshwind.surface.boxes import ALONG, CENTRE, EXTENT, FAR, NORMAL, WIDE, bezier, enclose, enclose_children, to_boxes
from meshwind.surface.evaluate import Spline, position, spans_of
from meshwind.surface.foot import foot, squared_distance

DENSITY = 3
"""Intervals between samples per span: a piece bends little over a third of itself, so the nearest sample leads to the
foot."""
SIDE = DENSITY + 1
"""Samples of a piece in either direction, its edges included; as many as Bezier points."""
MAX_FEET = 4
"""Maximum number of feet tried: one from the guess, then one per piece that may be nearer."""
MAX_MISSED = 2
"""Maximum number of those that are not nearer after all: the first may lead back to the foot that was found."""
BOWED = 1.5
"""How much more than an even arc a piece may bow between samples."""
REACH = 0.36
"""No point of a piece is further from a sample than this share of its box's half extents, with a tenth to spare."""
CANDIDATE, NEARER = 1e-9, 1e-12
"""Shares of the squared distance by which a candidate must promise to be nearer and a foot found from it must be; below
them is round-off."""
BESIDE = 1.0
"""Intervals between samples within which a foot is that of the sample."""
FIRST, ROWS, COLUMNS = range(3)
"""Columns of a tree's levels: number of the level's first node, rows and columns of nodes."""
LEVEL, ROW, COLUMN = range(3)
"""Columns of a query's stack: where the node still to be looked at stands."""


class SearchTree(NamedTuple):
    """A pyramid of boxes over the surface's polynomial pieces.

    boxes (k, 12, 16) are the nodes, those above the pieces first, laid out as in `boxes`; levels (l, 3) as (first node,
    rows, columns); samples (m, 3, 16) of every piece, 4 x 4 including its edges.
    """

    boxes: Floats
    levels: Ints
    samples: Floats


NO_TREE = SearchTree(frozen(np.empty((0, 12, 16))), frozen(np.empty((0, 3), np.int64)), frozen(np.empty((0, 3, 16))))
"""Stands for a tree that is not needed; read-only like a built tree, so that kernels compile once."""


class Body(NamedTuple):
    """A surface that fibres touch: its spline, its search tree (`NO_TREE` where none is needed) and its size.

    size is the length that tolerances are relative to.
    """

    spline: Spline
    tree: SearchTree
    size: float


@njit(nogil=True, cache=True)
def build(spline):
    """The arrays of a surface's search tree: boxes, levels, samples."""
    spans_u, spans_v = spans_of(spline.net)
    levels = levels_over(spans_u, spans_v)
    boxes = np.zeros((levels[-1, FIRST] + 1, 12, WIDE * WIDE))
    for box in boxes:
        fill_table(box[CENTRE : CENTRE + 3], FAR)
        fill(box[NORMAL + 2], 1.0)
        fill(box[ALONG], 1.0)
    samples = np.empty((spans_u * spans_v, 3, SIDE * SIDE))
    corners, at = np.empty((16, 3)), np.empty(3)
    for i in range(spans_u):
        for j in range(spans_v):
            bezier(spline.net, i, j, corners)
            enclose(corners, boxes[parent(levels[0], i, j)], child(i, j))
            for a in range(SIDE):
                for b in range(SIDE):
                    position(spline, (i + a / DENSITY) / spans_u, (j + b / DENSITY) / spans_v, at)
                    for k in range(3):
                        samples[i * spans_v + j, k, SIDE * a + b] = at[k]
    for level in range(1, len(levels)):
        below, rows, columns = levels[level - 1]
        for i in range(rows):
            for j in range(columns):
                enclose_children(boxes[below + i * columns + j], boxes[parent(levels[level], i, j)], child(i, j))
    return boxes, levels, samples


@njit(forceinline=True, cache=True)
def parent(level, i, j):
    """The node of a level that holds child (i, j)."""
    return level[FIRST] + (i // WIDE) * level[COLUMNS] + j // WIDE


@njit(forceinline=True, cache=True)
def child(i, j):
    """Number of child (i, j) among its parent's children."""
    return (i % WIDE) * WIDE + j % WIDE


@njit(cache=True)
def levels_over(rows, columns):
    """Levels of nodes over rows x columns pieces, up to a single node, as (first node, rows, columns)."""
    count, m, n = 0, rows, columns
    while count == 0 or m > 1 or n > 1:
        m, n, count = -(-m // WIDE), -(-n // WIDE), count + 1
    levels = np.empty((count, 3), np.int64)
    first, m, n = 0, rows, columns
    for level in range(count):
        m, n = -(-m // WIDE), -(-n // WIDE)
        levels[level, FIRST], levels[level, ROWS], levels[level, COLUMNS] = first, m, n
        first += m * n
    return levels


@njit(cache=True)
def to_samples(samples, point, out):
    """Squared distances (16,) of a point to a piece's samples."""
    x, y, z = point[0], point[1], point[2]
    for c in range(SIDE * SIDE):
        a, b, d = x - samples[0, c], y - samples[1, c], z - samples[2, c]
        out[c] = a * a + b * b + d * d


@njit(cache=True)
def closer_candidate(body, point, floor, square, u, v):
    """Piece and sample to start from where the surface may come nearer to `point` than sqrt(square); -1 if none does.

    Pieces next to (u, v), the foot found so far, are judged by their samples, unless one of these is nearer than all
    about it, as beside another foot; on others a nearer foot may hide between samples.  Of those that are likely to be
    further than sqrt(floor) the nearest is taken.  Pieces are numbered row by row.  Returns its likely squared
    distance, its number and the sample.
    """
    boxes, levels, samples = body.tree.boxes, body.tree.levels, body.tree.samples
    rows, columns = spans_of(body.spline.net)
    periodic = body.spline.periodic
    here_i = int(np.floor((u - np.floor(u)) * rows if periodic else u * rows))
    here_j = int(v * columns)
    best, piece, sample = np.inf, -1, -1
    stack = np.empty((WIDE * WIDE * len(levels), 3), np.int64)
    away, near = np.empty(WIDE * WIDE), np.empty(SIDE * SIDE)
    stack[0, LEVEL], stack[0, ROW], stack[0, COLUMN] = len(levels) - 1, 0, 0
    size = 1
    while size > 0:
        size -= 1
        level, i, j = stack[size, LEVEL], WIDE * stack[size, ROW], WIDE * stack[size, COLUMN]
        to_boxes(boxes[parent(levels[level], i, j)], point, away)
        for c in range(WIDE * WIDE):
            if away[c] >= min(best, square):
                continue
            a, b = i + c // WIDE, j + c % WIDE
            if level > 0:
                stack[size, LEVEL], stack[size, ROW], stack[size, COLUMN] = level - 1, a, b
                size += 1
                continue
            apart = abs(a - here_i)
            if periodic:
                apart = min(apart, rows - apart)
            box, nodes = boxes[parent(levels[0], a, b)], samples[a * columns + b]
            to_samples(nodes, point, near)
            m = int(near.argmin())
            likely = least = near[m]
            if least - REACH**2 * (box[EXTENT, c] ** 2 + box[EXTENT + 1, c] ** 2) >= square:
                continue
            if apart > 1 or abs(b - here_j) > 1 or another_foot(body, point, u, v, a, b, m, near[m]):
                likely, least = between_samples(nodes, point, m, near[m])
                likely = max(likely, away[c])
            if least < square and floor < likely < best:
                best, piece, sample = likely, a * columns + b, m
    return best, piece, sample


@njit(cache=True)
def between_samples(samples, point, m, square):
    """Squared distance of a point to a piece that is flat about its nearest sample m, sqrt(square) away; its least.

    From sample to sample a piece bows by an eighth of their second difference.
    """
    sag = 0.0
    for way in range(2):
        here, stride = (m // SIDE, SIDE) if way == 0 else (m % SIDE, 1)
        inner = m + (min(max(here, 1), SIDE - 2) - here) * stride
        gain = bow = 0.0
        for x in range(3):
            bow += (samples[x, inner - stride] - 2.0 * samples[x, inner] + samples[x, inner + stride]) ** 2
        sag += np.sqrt(bow) / 8.0
        for k in (-1, 1):
            if not 0 <= here + k < SIDE:
                continue
            along = size = 0.0
            for x in range(3):
                d = samples[x, m + k * stride] - samples[x, m]
                along += d * (point[x] - samples[x, m])
                size += d * d
            if along > 0.0:
                share = min(along / max(size, TINY), 0.5)
                gain = max(gain, share * (2.0 * along - share * size))
        square -= gain
    square = max(square, 0.0)
    return square, max(np.sqrt(square) - BOWED * sag, 0.0) ** 2


@njit(cache=True)
def another_foot(body, point, u, v, a, b, m, square):
    """Whether sample m of piece (a, b), at a squared distance, is nearer than those about it, and not beside (u, v)."""
    samples, periodic = body.tree.samples, body.spline.periodic
    rows, columns = spans_of(body.spline.net)
    across, along = DENSITY * rows, DENSITY * columns
    i, j = DENSITY * a + m // SIDE, DENSITY * b + m % SIDE
    off = i - u * across
    if periodic:
        off -= across * np.rint(off / across)
    if abs(off) <= BESIDE and abs(j - v * along) <= BESIDE:
        return False
    for p in range(i - 1, i + 2):
        for q in range(j - 1, j + 2):
            if q < 0 or q > along or (not periodic and (p < 0 or p > across)):
                continue
            r = p % across if periodic else p
            row, column = min(r // DENSITY, rows - 1), min(q // DENSITY, columns - 1)
            at, c = samples[row * columns + column], SIDE * (r - DENSITY * row) + q - DENSITY * column
            x, y, z = point[0] - at[0, c], point[1] - at[1, c], point[2] - at[2, c]
            if x * x + y * y + z * z < square * (1.0 - NEARER):
                return False
    return True


@njit(cache=True)
def nearest_foot(body, point, guess, at):
    """As `foot`, but the nearest of all: where the tree knows a nearer piece, Newton's method starts again from there.

    u in `guess` stays within half a turn of where it was.  Returns the number of surface evaluations.
    """
    before = guess[0]
    count = foot(body.spline, point, guess, at)
    square, floor = squared_distance(at, point), -1.0
    rows, columns = spans_of(body.spline.net)
    missed = 0
    for _ in range(MAX_FEET - 1):
        likely, piece, sample = closer_candidate(body, point, floor, square * (1.0 - CANDIDATE), guess[0], guess[1])
        if piece < 0:
            break
        local_u, local_v = guess[0], guess[1]
        guess[0] = (piece // columns + sample // SIDE / DENSITY) / rows
        guess[1] = (piece % columns + sample % SIDE / DENSITY) / columns
        count += foot(body.spline, point, guess, at)
        found = squared_distance(at, point)
        if found < square * (1.0 - NEARER):
            square, floor = found, -1.0
            continue
        guess[0], guess[1] = local_u, local_v
        count += foot(body.spline, point, guess, at)
        floor = likely
        missed += 1
        if missed == MAX_MISSED:
            break
    if body.spline.periodic:
        guess[0] += np.rint(before - guess[0])
    return count
