"""A coarse search tree over the surface: where Newton for foot points must start.

A local foot stays on the near flank of a thin rib while the true nearest point is on the other, and may even stop
at a saddle of the distance.  The tree is a pyramid of boxes over an even grid of samples; asked for a sample nearer
than the foot at hand, it answers at once where that foot is right, because then no box reaches into the ball.
"""

import numpy as np
from numba import njit

from meshwind.surface.evaluate import S, position
from meshwind.surface.foot import foot

DENSITY = 3
"""Samples a span: a spline piece bends little over a third of itself, so the nearest sample leads to the foot."""


@njit(cache=True)
def build(net, periodic, density):
    """Boxes (k, 6) of all levels, samples first, and the levels (l, 3) as (first box, rows, columns)."""
    spans_u = net.shape[0] - 3
    rows, columns = density * spans_u + (0 if periodic else 1), density * (net.shape[1] - 3) + 1
    total, count, m, n = 0, 0, rows, columns
    while True:
        total += m * n
        count += 1
        if m == 1 and n == 1:
            break
        m, n = (m + 1) // 2, (n + 1) // 2
    boxes, levels = np.empty((total, 6)), np.empty((count, 3), np.int64)
    levels[0, 0], levels[0, 1], levels[0, 2] = 0, rows, columns
    at = np.empty(3)
    for i in range(rows):
        for j in range(columns):
            position(net, periodic, i / (density * spans_u), j / (columns - 1), at)
            for k in range(3):
                boxes[i * columns + j, k] = at[k]
                boxes[i * columns + j, 3 + k] = at[k]
    for level in range(1, count):
        below, m0, n0 = levels[level - 1, 0], levels[level - 1, 1], levels[level - 1, 2]
        first, m, n = below + m0 * n0, (m0 + 1) // 2, (n0 + 1) // 2
        levels[level, 0], levels[level, 1], levels[level, 2] = first, m, n
        for i in range(m):
            for j in range(n):
                box = first + i * n + j
                for k in range(3):
                    boxes[box, k], boxes[box, 3 + k] = np.inf, -np.inf
                for a in range(2 * i, min(2 * i + 2, m0)):
                    for b in range(2 * j, min(2 * j + 2, n0)):
                        child = below + a * n0 + b
                        for k in range(3):
                            boxes[box, k] = min(boxes[box, k], boxes[child, k])
                            boxes[box, 3 + k] = max(boxes[box, 3 + k], boxes[child, 3 + k])
    return boxes, levels


@njit(cache=True)
def nearer(boxes, levels, point, square):
    """The sample nearest to `point` whose squared distance is below `square`, as an index, or -1."""
    depth = len(levels)
    stack = np.empty((4 * depth + 4, 3), np.int64)
    stack[0, 0], stack[0, 1], stack[0, 2] = depth - 1, 0, 0
    size = 1
    found = -1
    while size > 0:
        size -= 1
        level, i, j = stack[size, 0], stack[size, 1], stack[size, 2]
        box = levels[level, 0] + i * levels[level, 2] + j
        d = 0.0
        for k in range(3):
            away = max(boxes[box, k] - point[k], point[k] - boxes[box, 3 + k])
            if away > 0.0:
                d += away * away
        if d >= square:
            continue
        if level == 0:
            square = d
            found = box
            continue
        m, n = levels[level - 1, 1], levels[level - 1, 2]
        for a in range(2 * i, min(2 * i + 2, m)):
            for b in range(2 * j, min(2 * j + 2, n)):
                stack[size, 0], stack[size, 1], stack[size, 2] = level - 1, a, b
                size += 1
    return found


@njit(cache=True)
def nearest_foot(net, periodic, boxes, levels, point, guess, at):
    """As `foot`, but the nearest of all: where the tree knows a nearer sample, Newton starts again from there.

    u in `guess` stays within half a turn of where it was.  Returns the number of surface evaluations.
    """
    before = guess[0]
    count = foot(net, periodic, point, guess, at)
    square = 0.0
    for k in range(3):
        square += (at[S, k] - point[k]) ** 2
    sample = nearer(boxes, levels, point, square * (1.0 - 1e-9))
    if sample < 0:
        return count
    rows, columns = levels[0, 1], levels[0, 2]
    local_u, local_v = guess[0], guess[1]
    guess[0] = (sample // columns) / (rows if periodic else rows - 1)
    guess[1] = (sample % columns) / (columns - 1)
    count += foot(net, periodic, point, guess, at)
    found = 0.0
    for k in range(3):
        found += (at[S, k] - point[k]) ** 2
    if found >= square:
        guess[0], guess[1] = local_u, local_v
        count += foot(net, periodic, point, guess, at)
    elif periodic:
        guess[0] += np.round(before - guess[0])
    return count
