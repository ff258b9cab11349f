"""Boxes of a search tree: each around one polynomial piece of a spline, or around the boxes of a node's children.

A node holds its children's boxes in an array (12, 16), one a column: centre, unit normal, unit vector along u, and
half extents along u, across and along the normal, all 16 at once so that the compiler can use vector instructions.
"""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import inner

WIDE = 4
"""Children of a node in either direction."""
FAR = 1e100
"""Centre of a child that does not exist."""
CENTRE, NORMAL, ALONG, EXTENT = 0, 3, 6, 9
"""First of the three rows that hold the children's centres, normals, directions along u, and half extents."""


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
        boxes[CENTRE + k, c] = 0.25 * (corners[0, k] + corners[3, k] + corners[12, k] + corners[15, k])
        boxes[NORMAL + k, c] = (corners[15, e] - corners[0, e]) * (corners[3, f] - corners[12, f])
        boxes[NORMAL + k, c] -= (corners[15, f] - corners[0, f]) * (corners[3, e] - corners[12, e])
        boxes[ALONG + k, c] = corners[15, k] + corners[12, k] - corners[3, k] - corners[0, k]
    orthonormalise(boxes, c)
    axes, low, high = axes_of(boxes, c), np.full(3, np.inf), np.full(3, -np.inf)
    for p in range(16):
        for a in range(3):
            at = 0.0
            for k in range(3):
                at += (corners[p, k] - boxes[CENTRE + k, c]) * axes[a, k]
            low[a], high[a] = min(low[a], at), max(high[a], at)
    set_extents(boxes, c, axes, low, high)


@njit(cache=True)
def set_extents(boxes, c, axes, low, high):
    """Set child c's centre and half extents from its content's bounds `low` and `high` along its axes (3, 3)."""
    for a in range(3):
        for k in range(3):
            boxes[CENTRE + k, c] += 0.5 * (low[a] + high[a]) * axes[a, k]
        boxes[EXTENT + a, c] = 0.5 * (high[a] - low[a])


@njit(cache=True)
def orthonormalise(boxes, c):
    """Make a child's normal and its direction along u unit vectors at right angles; where one vanishes any will do."""
    n, e = boxes[NORMAL : NORMAL + 3, c], boxes[ALONG : ALONG + 3, c]
    size = np.sqrt(inner(n, n))
    if size > 0.0:
        for k in range(3):
            n[k] /= size
    else:
        n[2] = 1.0
    out = inner(e, n)
    for k in range(3):
        e[k] -= out * n[k]
    size = np.sqrt(inner(e, e))
    if size > 0.0:
        for k in range(3):
            e[k] /= size
        return
    k = 0  # any direction at right angles to the normal
    for d in range(1, 3):
        if abs(n[d]) < abs(n[k]):
            k = d
    e[k], e[(k + 1) % 3], e[(k + 2) % 3] = 0.0, n[(k + 2) % 3], -n[(k + 1) % 3]
    size = np.sqrt(inner(e, e))
    for k in range(3):
        e[k] /= size


@njit(cache=True)
def axes_of(boxes, c):
    """A child's axes (3, 3): along u, across, along the normal."""
    axes = np.empty((3, 3))
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        axes[0, k], axes[2, k] = boxes[ALONG + k, c], boxes[NORMAL + k, c]
        axes[1, k] = boxes[NORMAL + i, c] * boxes[ALONG + j, c] - boxes[NORMAL + j, c] * boxes[ALONG + i, c]
    return axes


@njit(cache=True)
def enclose_children(node, boxes, c):
    """Write the box around all children of a node as child c of its parent."""
    for k in range(EXTENT):
        total, count = 0.0, 0
        for m in range(WIDE * WIDE):
            if node[CENTRE, m] < FAR:
                total += node[k, m]
                count += 1
        boxes[k, c] = total / count
    orthonormalise(boxes, c)
    axes, low, high = axes_of(boxes, c), np.full(3, np.inf), np.full(3, -np.inf)
    for m in range(WIDE * WIDE):
        if node[CENTRE, m] == FAR:
            continue
        own = axes_of(node, m)
        for a in range(3):
            at = reach = 0.0
            for k in range(3):
                at += (node[CENTRE + k, m] - boxes[CENTRE + k, c]) * axes[a, k]
            for b in range(3):
                cosine = own[b, 0] * axes[a, 0] + own[b, 1] * axes[a, 1] + own[b, 2] * axes[a, 2]
                reach += node[EXTENT + b, m] * abs(cosine)
            low[a], high[a] = min(low[a], at - reach), max(high[a], at + reach)
    set_extents(boxes, c, axes, low, high)


@njit(cache=True)
def to_boxes(boxes, point, out):
    """Squared distances (16,) of a point to the boxes of a node's children."""
    x, y, z = point[0], point[1], point[2]
    for c in range(WIDE * WIDE):
        a, b, d = x - boxes[CENTRE, c], y - boxes[CENTRE + 1, c], z - boxes[CENTRE + 2, c]
        n0, n1, n2 = boxes[NORMAL, c], boxes[NORMAL + 1, c], boxes[NORMAL + 2, c]
        e0, e1, e2 = boxes[ALONG, c], boxes[ALONG + 1, c], boxes[ALONG + 2, c]
        along = abs(a * e0 + b * e1 + d * e2) - boxes[EXTENT, c]
        across = abs(a * (n1 * e2 - n2 * e1) + b * (n2 * e0 - n0 * e2) + d * (n0 * e1 - n1 * e0)) - boxes[EXTENT + 1, c]
        above = abs(a * n0 + b * n1 + d * n2) - boxes[EXTENT + 2, c]
        along, across, above = along + abs(along), across + abs(across), above + abs(above)
        out[c] = 0.25 * (along * along + across * across + above * above)
