"""A search tree over the surface: where Newton for foot points must start.

A local foot stays on the near flank of a thin rib while the true nearest point is on the other, and may even stop
at a saddle of the distance.  The tree's leaves are the surface's polynomial pieces, each in a flat disc that its
Bezier points fill; above them is a pyramid of discs, each around four.  Asked for a piece that may come nearer than the
foot at hand, it answers at once where that foot is right: then no disc but those about the foot itself reaches into
the ball.  Discs lie along the surface, so that they part from the ball far sooner than boxes do (3 to 5 times fewer).

A tree is (discs, levels, samples).  discs (k, 8, 16) are the children of every node, the pieces' parents first, as
centre, unit normal, radius and half thickness, each for all 16 children at once so that the compiler takes them in
vectors; levels (l, 3) as (first node, rows, columns); samples (m, 3, 16) of every piece, 4 x 4 with its edges.
"""

import numpy as np
from numba import njit

from meshwind.surface.evaluate import S, position
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
"""No point of a piece is further than this share of its disc's radius from a sample, and a tenth."""


@njit(cache=True)
def build(net, periodic):
    """The search tree of a surface."""
    spans_u, spans_v = net.shape[0] - 3, net.shape[1] - 3
    levels = shape(spans_u, spans_v)
    discs = np.zeros((levels[-1, 0] + 1, 8, WIDE * WIDE))
    discs[:, :3] = FAR
    samples = np.empty((spans_u * spans_v, 3, 16))
    corners, at = np.empty((16, 3)), np.empty(3)
    for i in range(spans_u):
        for j in range(spans_v):
            bezier(net, i, j, corners)
            enclose(corners, discs[parent(levels[0], i, j)], child(i, j))
            for a in range(4):
                for b in range(4):
                    place = (i + a / DENSITY) / spans_u, (j + b / DENSITY) / spans_v
                    position(net, periodic, place[0], place[1], at)
                    for k in range(3):
                        samples[i * spans_v + j, k, 4 * a + b] = at[k]
    for level in range(1, len(levels)):
        below, rows, columns = levels[level - 1]
        for i in range(rows):
            for j in range(columns):
                around(discs[below + i * columns + j], discs[parent(levels[level], i, j)], child(i, j))
    return discs, levels, samples


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
def enclose(corners, discs, c):
    """Write the disc of a piece as child c, from its Bezier points (16, 3): across its two diagonals."""
    for k in range(3):
        e, f = (k + 1) % 3, (k + 2) % 3
        discs[k, c] = 0.25 * (corners[0, k] + corners[3, k] + corners[12, k] + corners[15, k])
        discs[3 + k, c] = (corners[15, e] - corners[0, e]) * (corners[3, f] - corners[12, f])
        discs[3 + k, c] -= (corners[15, f] - corners[0, f]) * (corners[3, e] - corners[12, e])
    turn_to_unit(discs, c)
    low, high = np.inf, -np.inf
    for p in range(16):
        height = 0.0
        for k in range(3):
            height += (corners[p, k] - discs[k, c]) * discs[3 + k, c]
        low, high = min(low, height), max(high, height)
    widest = 0.0
    for k in range(3):
        discs[k, c] += 0.5 * (low + high) * discs[3 + k, c]
    for p in range(16):
        square = height = 0.0
        for k in range(3):
            away = corners[p, k] - discs[k, c]
            square, height = square + away * away, height + away * discs[3 + k, c]
        widest = max(widest, square - height * height)
    discs[6, c], discs[7, c] = np.sqrt(widest), 0.5 * (high - low)


@njit(cache=True)
def turn_to_unit(discs, c):
    """Make a child's normal a unit vector; where there is none any will do."""
    size = np.sqrt(discs[3, c] ** 2 + discs[4, c] ** 2 + discs[5, c] ** 2)
    if size > 0.0:
        for k in range(3, 6):
            discs[k, c] /= size
    else:
        discs[5, c] = 1.0


@njit(cache=True)
def around(node, discs, c):
    """Write the disc around all children of a node as child c of its parent."""
    for k in range(6):
        total, count = 0.0, 0
        for m in range(WIDE * WIDE):
            if node[0, m] < FAR:
                total += node[k, m]
                count += 1
        discs[k, c] = total / count
    turn_to_unit(discs, c)
    low, high, widest = np.inf, -np.inf, 0.0
    for m in range(WIDE * WIDE):
        if node[0, m] == FAR:
            continue
        square = height = cosine = 0.0
        for k in range(3):
            away = node[k, m] - discs[k, c]
            square, height = square + away * away, height + away * discs[3 + k, c]
            cosine += node[3 + k, m] * discs[3 + k, c]
        sine = np.sqrt(max(1.0 - cosine * cosine, 0.0))
        reach = node[6, m] * sine + node[7, m] * abs(cosine)
        low, high = min(low, height - reach), max(high, height + reach)
        widest = max(widest, np.sqrt(max(square - height * height, 0.0)) + node[6, m] + node[7, m] * sine)
    for k in range(3):
        discs[k, c] += 0.5 * (low + high) * discs[3 + k, c]
    discs[6, c], discs[7, c] = widest, 0.5 * (high - low)


@njit(cache=True)
def to_discs(discs, point, out):
    """Squared distances (16,) of a point to the discs of a node's children, at most those to what is in them."""
    x, y, z = point[0], point[1], point[2]
    for c in range(WIDE * WIDE):
        a, b, d = x - discs[0, c], y - discs[1, c], z - discs[2, c]
        height = a * discs[3, c] + b * discs[4, c] + d * discs[5, c]
        aside = np.sqrt(abs(a * a + b * b + d * d - height * height)) - discs[6, c]
        above = abs(height) - discs[7, c]
        aside, above = 0.5 * (aside + abs(aside)), 0.5 * (above + abs(above))
        out[c] = aside * aside + above * above


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
    discs, levels, samples = tree
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
        to_discs(discs[parent(levels[level], i, j)], point, away)
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
                hidden = (REACH * discs[parent(levels[0], a, b), 6, c]) ** 2
            to_samples(samples[a * columns + b], point, near)
            for m in range(16):
                if near[m] - hidden < best:
                    best, piece, sample = near[m] - hidden, a * columns + b, m
    return piece, sample


@njit(cache=True)
def nearest_foot(net, periodic, tree, point, guess, at):
    """As `foot`, but the nearest of all: where the tree knows a nearer piece, Newton starts again from there.

    u in `guess` stays within half a turn of where it was.  Returns the number of surface evaluations.
    """
    before = guess[0]
    count = foot(net, periodic, point, guess, at)
    square = squared(at, point)
    rows, columns = net.shape[0] - 3, net.shape[1] - 3
    for _ in range(ROUNDS - 1):
        piece, sample = rival(tree, rows, columns, periodic, point, square * (1.0 - 1e-9), guess[0], guess[1])
        if piece < 0:
            break
        local_u, local_v = guess[0], guess[1]
        guess[0] = (piece // columns + sample // 4 / DENSITY) / rows
        guess[1] = (piece % columns + sample % 4 / DENSITY) / columns
        count += foot(net, periodic, point, guess, at)
        found = squared(at, point)
        if found >= square * (1.0 - 1e-12):
            guess[0], guess[1] = local_u, local_v
            count += foot(net, periodic, point, guess, at)
            break
        square = found
    if periodic:
        guess[0] += np.round(before - guess[0])
    return count


@njit(inline="always", cache=True)
def squared(at, point):
    """Squared distance of a point to where a frame stands."""
    total = 0.0
    for k in range(3):
        total += (at[S, k] - point[k]) ** 2
    return total
