"""A search tree over the surface: where Newton for foot points must start.

A local foot stays on the near flank of a thin rib while the true nearest point is on the other, and may even stop
at a saddle of the distance.  The tree's leaves are the surface's polynomial pieces, each in a flat box along it that
its Bezier points fill; above them is a pyramid of such boxes, each around sixteen.  Asked for a piece that may come
nearer than the foot at hand, it answers at once where that foot is right: then no box but those about the foot itself
reaches into the ball.

"""

from typing import NamedTuple

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.surface.evaluate import S, Spline, position
from meshwind.surface.foot import foot

WIDE = 4
"""Children a side."""
FAR = 1e100
"""Centre of a child that is not there."""
DENSITY = 3
"""Samples a span: a spline piece bends little over a third of itself, so the nearest sample leads to the foot."""
ROUNDS = 4
"""Feet that are tried at most: one from the guess, then one a piece that may be nearer."""
REACH = 0.36
"""No point of a piece is further from a sample than this share of its box's half extents, with a tenth to spare."""


class SearchTree(NamedTuple):
    """A pyramid of boxes over the surface's polynomial pieces.

    boxes (k, 12, 16) are the children of every node, the pieces' parents first, as centre, unit normal, unit vector
    along u and half extents along u, across and along the normal, each for all 16 children at once so that the
    compiler takes them in vectors; levels (l, 3) as (first node, rows, columns); samples (m, 3, 16) of every piece,
    4 x 4 with its edges.
    """

    boxes: Floats
    levels: Ints
    samples: Floats


NO_TREE = SearchTree(frozen(np.empty((0, 12, 16))), frozen(np.empty((0, 3), np.int64)), frozen(np.empty((0, 3, 16))))
"""Stands for a tree that is not needed; read-only as a tree itself, so that kernels compile once."""


class Body(NamedTuple):
    """A surface that fibres touch: its spline, its search tree (`NO_TREE` where none is needed) and its size.

    size is the length that tolerances are relative to.
    """

    spline: Spline
    tree: SearchTree
    size: float


@njit(cache=True)
def build(spline):
    """The arrays of a surface's search tree: boxes, levels, samples."""
    spans_u, spans_v = spline.net.shape[0] - 3, spline.net.shape[1] - 3
    levels = shape(spans_u, spans_v)
    boxes = np.zeros((levels[-1, 0] + 1, 12, WIDE * WIDE))
    boxes[:, :3], boxes[:, 5], boxes[:, 6] = FAR, 1.0, 1.0
    samples = np.empty((spans_u * spans_v, 3, 16))
    corners, at = np.empty((16, 3)), np.empty(3)
    for i in range(spans_u):
        for j in range(spans_v):
            bezier(spline.net, i, j, corners)
            enclose(corners, boxes[parent(levels[0], i, j)], child(i, j))
            for a in range(4):
                for b in range(4):
                    place = (i + a / DENSITY) / spans_u, (j + b / DENSITY) / spans_v
                    position(spline, place[0], place[1], at)
                    for k in range(3):
                        samples[i * spans_v + j, k, 4 * a + b] = at[k]
    for level in range(1, len(levels)):
        below, rows, columns = levels[level - 1]
        for i in range(rows):
            for j in range(columns):
                around(boxes[below + i * columns + j], boxes[parent(levels[level], i, j)], child(i, j))
    return boxes, levels, samples


@njit(inline="always", cache=True)
def parent(level, i, j):
    """The node of a level that holds child (i, j)."""
    return level[0] + (i // WIDE) * level[2] + j // WIDE


@njit(inline="always", cache=True)
def child(i, j):
    """Which of its parent's children (i, j) is."""
    return (i % WIDE) * WIDE + j % WIDE


@njit(cache=True)
def shape(rows, columns):
    """Levels of nodes over rows x columns pieces, up to a single node."""
    count, m, n = 0, rows, columns
    while count == 0 or m > 1 or n > 1:
        m, n, count = -(-m // WIDE), -(-n // WIDE), count + 1
    levels = np.empty((count, 3), np.int64)
    first, m, n = 0, rows, columns
    for level in range(count):
        m, n = -(-m // WIDE), -(-n // WIDE)
        levels[level, 0], levels[level, 1], levels[level, 2] = first, m, n
        first += m * n
    return levels


@njit(cache=True)
def bezier(net, i, j, out):
    """Bezier points (16, 3) of the polynomial piece (i, j) of a uniform bicubic spline, row by row."""
    for q in range(4):
        for k in range(3):
            a, b, c, d = net[i, j + q, k], net[i + 1, j + q, k], net[i + 2, j + q, k], net[i + 3, j + q, k]
            out[q, k], out[12 + q, k] = (a + 4.0 * b + c) / 6.0, (b + 4.0 * c + d) / 6.0
            out[4 + q, k], out[8 + q, k] = (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0
    for p in range(0, 16, 4):
        for k in range(3):
            a, b, c, d = out[p, k], out[p + 1, k], out[p + 2, k], out[p + 3, k]
            out[p, k], out[p + 3, k] = (a + 4.0 * b + c) / 6.0, (b + 4.0 * c + d) / 6.0
            out[p + 1, k], out[p + 2, k] = (2.0 * b + c) / 3.0, (b + 2.0 * c) / 3.0


@njit(cache=True)
def enclose(corners, boxes, c):
    """Write the box of a piece as child c, from its Bezier points (16, 3): across its two diagonals, along u."""
    for k in range(3):
        e, f = (k + 1) % 3, (k + 2) % 3
        boxes[k, c] = 0.25 * (corners[0, k] + corners[3, k] + corners[12, k] + corners[15, k])
        boxes[3 + k, c] = (corners[15, e] - corners[0, e]) * (corners[3, f] - corners[12, f])
        boxes[3 + k, c] -= (corners[15, f] - corners[0, f]) * (corners[3, e] - corners[12, e])
        boxes[6 + k, c] = corners[15, k] + corners[12, k] - corners[3, k] - corners[0, k]
    square_up(boxes, c)
    axes, low, high = axes_of(boxes, c), np.full(3, np.inf), np.full(3, -np.inf)
    for p in range(16):
        for a in range(3):
            at = 0.0
            for k in range(3):
                at += (corners[p, k] - boxes[k, c]) * axes[a, k]
            low[a], high[a] = min(low[a], at), max(high[a], at)
    fit(boxes, c, axes, low, high)


@njit(cache=True)
def fit(boxes, c, axes, low, high):
    """Set child c's centre and half extents from how far its contents reach along its axes (3, 3)."""
    for a in range(3):
        for k in range(3):
            boxes[k, c] += 0.5 * (low[a] + high[a]) * axes[a, k]
        boxes[9 + a, c] = 0.5 * (high[a] - low[a])


@njit(cache=True)
def square_up(boxes, c):
    """Make a child's normal and its direction along u unit vectors and square; where there is none any will do."""
    n, e = boxes[3:6, c], boxes[6:9, c]
    size = np.sqrt(n[0] ** 2 + n[1] ** 2 + n[2] ** 2)
    if size > 0.0:
        for k in range(3):
            n[k] /= size
    else:
        n[2] = 1.0
    out = e[0] * n[0] + e[1] * n[1] + e[2] * n[2]
    for k in range(3):
        e[k] -= out * n[k]
    size = np.sqrt(e[0] ** 2 + e[1] ** 2 + e[2] ** 2)
    if size > 0.0:
        for k in range(3):
            e[k] /= size
        return
    k = np.abs(n).argmin()  # square to the normal, whichever way
    e[k], e[(k + 1) % 3], e[(k + 2) % 3] = 0.0, n[(k + 2) % 3], -n[(k + 1) % 3]
    size = np.sqrt((e * e).sum())
    for k in range(3):
        e[k] /= size


@njit(cache=True)
def axes_of(boxes, c):
    """A child's axes (3, 3): along u, across, along the normal."""
    axes = np.empty((3, 3))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        axes[0, k], axes[2, k] = boxes[6 + k, c], boxes[3 + k, c]
        axes[1, k] = boxes[3 + i, c] * boxes[6 + j, c] - boxes[3 + j, c] * boxes[6 + i, c]
    return axes


@njit(cache=True)
def around(node, boxes, c):
    """Write the box around all children of a node as child c of its parent."""
    for k in range(9):
        total, count = 0.0, 0
        for m in range(WIDE * WIDE):
            if node[0, m] < FAR:
                total += node[k, m]
                count += 1
        boxes[k, c] = total / count
    square_up(boxes, c)
    axes, low, high = axes_of(boxes, c), np.full(3, np.inf), np.full(3, -np.inf)
    for m in range(WIDE * WIDE):
        if node[0, m] == FAR:
            continue
        own = axes_of(node, m)
        for a in range(3):
            at = reach = 0.0
            for k in range(3):
                at += (node[k, m] - boxes[k, c]) * axes[a, k]
            for b in range(3):
                cosine = own[b, 0] * axes[a, 0] + own[b, 1] * axes[a, 1] + own[b, 2] * axes[a, 2]
                reach += node[9 + b, m] * abs(cosine)
            low[a], high[a] = min(low[a], at - reach), max(high[a], at + reach)
    fit(boxes, c, axes, low, high)


@njit(cache=True)
def to_boxes(boxes, point, out):
    """Squared distances (16,) of a point to the boxes of a node's children."""
    x, y, z = point[0], point[1], point[2]
    for c in range(WIDE * WIDE):
        a, b, d = x - boxes[0, c], y - boxes[1, c], z - boxes[2, c]
        n0, n1, n2 = boxes[3, c], boxes[4, c], boxes[5, c]
        e0, e1, e2 = boxes[6, c], boxes[7, c], boxes[8, c]
        along = abs(a * e0 + b * e1 + d * e2) - boxes[9, c]
        across = abs(a * (n1 * e2 - n2 * e1) + b * (n2 * e0 - n0 * e2) + d * (n0 * e1 - n1 * e0)) - boxes[10, c]
        above = abs(a * n0 + b * n1 + d * n2) - boxes[11, c]
        along, across, above = along + abs(along), across + abs(across), above + abs(above)
        out[c] = 0.25 * (along * along + across * across + above * above)


@njit(cache=True)
def to_samples(samples, point, out):
    """Squared distances (16,) of a point to a piece's samples."""
    x, y, z = point[0], point[1], point[2]
    for c in range(16):
        a, b, d = x - samples[0, c], y - samples[1, c], z - samples[2, c]
        out[c] = a * a + b * b + d * d


@njit(cache=True)
def rival(tree, rows, columns, periodic, point, square, u, v):
    """Piece and sample to start from where the surface may come nearer to `point` than sqrt(square); -1 if none does.

    Pieces next to (u, v), where the foot at hand is, are judged by their samples; from others a nearer foot may hide
    between samples, and these count by the nearest that it may be.  Pieces are numbered by rows of `columns`.
    """
    boxes, levels, samples = tree.boxes, tree.levels, tree.samples
    here_i = int(np.floor((u - np.floor(u)) * rows if periodic else u * rows))
    here_j = int(v * columns)
    best, piece, sample = square, -1, -1
    stack = np.empty((WIDE * WIDE * len(levels), 3), np.int64)
    away, near = np.empty(WIDE * WIDE), np.empty(16)
    stack[0, 0], stack[0, 1], stack[0, 2] = len(levels) - 1, 0, 0
    size = 1
    while size > 0:
        size -= 1
        level, i, j = stack[size, 0], WIDE * stack[size, 1], WIDE * stack[size, 2]
        to_boxes(boxes[parent(levels[level], i, j)], point, away)
        for c in range(WIDE * WIDE):
            if away[c] >= best:
                continue
            a, b = i + c // WIDE, j + c % WIDE
            if level > 0:
                stack[size, 0], stack[size, 1], stack[size, 2] = level - 1, a, b
                size += 1
                continue
            apart = abs(a - here_i)
            if periodic:
                apart = min(apart, rows - apart)
            hidden = 0.0
            if apart > 1 or abs(b - here_j) > 1:
                box = boxes[parent(levels[0], a, b)]
                hidden = REACH**2 * (box[9, c] ** 2 + box[10, c] ** 2)
            to_samples(samples[a * columns + b], point, near)
            for m in range(16):
                if near[m] - hidden < best:
                    best, piece, sample = near[m] - hidden, a * columns + b, m
    return piece, sample


@njit(cache=True)
def nearest_foot(body, point, guess, at):
    """As `foot`, but the nearest of all: where the tree knows a nearer piece, Newton starts again from there.

    u in `guess` stays within half a turn of where it was.  Returns the number of surface evaluations.
    """
    before = guess[0]
    count = foot(body.spline, point, guess, at)
    square = squared(at, point)
    rows, columns = body.spline.net.shape[0] - 3, body.spline.net.shape[1] - 3
    for _ in range(ROUNDS - 1):
        piece, sample = rival(
            body.tree, rows, columns, body.spline.periodic, point, square * (1.0 - 1e-9), guess[0], guess[1]
        )
        if piece < 0:
            break
        local_u, local_v = guess[0], guess[1]
        guess[0] = (piece // columns + sample // 4 / DENSITY) / rows
        guess[1] = (piece % columns + sample % 4 / DENSITY) / columns
        count += foot(body.spline, point, guess, at)
        found = squared(at, point)
        if found >= square * (1.0 - 1e-12):
            guess[0], guess[1] = local_u, local_v
            count += foot(body.spline, point, guess, at)
            break
        square = found
    if body.spline.periodic:
        guess[0] += np.round(before - guess[0])
    return count


@njit(inline="always", cache=True)
def squared(at, point):
    """Squared distance of a point to where a frame stands."""
    total = 0.0
    for k in range(3):
        total += (at[S, k] - point[k]) ** 2
    return total
