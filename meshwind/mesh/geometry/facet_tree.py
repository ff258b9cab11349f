"""Search tree over triangles: distances of points to the nearest one, and the first one that a segment meets.

libigl's tree takes twice the time on each thread and uses only one, and its rays miss triangles smaller than about
1e-3 in the mesh's units.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill
from meshwind.core.threads import parallel_for

LEAF = 2
"""Triangles per leaf."""
RUN = 64
"""Consecutive points that start from each other's nearest triangle, independent of the number of threads."""
GRAZE = 1e-9
"""Sine of the angle between a segment and a triangle's plane below which the segment is parallel to it."""


@dataclass(frozen=True)
class FacetTree:
    """Corners of triangles (m, 3, 3) in the order of the tree, their numbers (m,), and a heap of boxes (k, 6).

    Box 1 is the root, boxes 2 k and 2 k + 1 are the halves of box k, and the second half of the boxes are leaves.
    """

    corners: Floats
    numbers: Ints
    boxes: Floats

    __repr__ = brief

    @staticmethod
    def of(vertices: Floats, faces: Ints) -> "FacetTree":
        """Build the tree of faces (m, 3) with vertices (n, 3)."""
        corners = vertices[faces]
        order = _order(frozen(corners.sum(axis=1)))
        corners = frozen(corners[order])
        return FacetTree(corners, frozen(order), frozen(_boxes(corners)))

    def distances(self, points: Floats) -> Floats:
        """Distances (k,) of points (k, 3) to the nearest triangle."""
        out = np.empty(len(points))
        runs = -(-len(points) // RUN)
        parallel_for(_distances, runs, 16, self.corners, self.boxes, frozen(points), out)
        return out

    def first_hits(self, start: Floats, ray: Floats) -> Ints:
        """First face (k,) that each segment from `start` along `ray` (k, 3) meets, -1 if there is none."""
        out = np.empty(len(start), dtype=np.int64)
        parallel_for(
            _first_hits, len(start), 1000, self.corners, self.numbers, self.boxes, frozen(start), frozen(ray), out
        )
        return out


@njit(nogil=True, cache=True)
def _order(points: Floats) -> Ints:
    """Order (m,) of points (m, 3) in which each node's lower half along its longest axis precedes its upper half."""
    count = len(points)
    order = np.arange(count)
    leaves = 1
    while leaves * LEAF < count:
        leaves *= 2
    span = leaves * LEAF
    while span > LEAF:
        for first in range(0, count, span):
            last, middle = min(first + span, count), first + span // 2
            if middle < last:
                _halve(points, order, first, middle, last)
        span //= 2
    return order


@njit(nogil=True, cache=True)
def _halve(points: Floats, order: Ints, first: int, middle: int, last: int) -> None:
    """Partition order[first:last] at `middle` by the coordinate along the longest axis (quickselect, Hoare 1961)."""
    axis, longest = 0, -1.0
    for d in range(3):
        low, high = np.inf, -np.inf
        for k in range(first, last):
            low, high = min(low, points[order[k], d]), max(high, points[order[k], d])
        if high - low > longest:
            axis, longest = d, high - low
    low, high = first, last - 1
    while low < high:
        pivot = points[order[(low + high) // 2], axis]
        i, j = low, high
        while i <= j:
            while points[order[i], axis] < pivot:
                i += 1
            while points[order[j], axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i, j = i + 1, j - 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            break


@njit(nogil=True, cache=True)
def _boxes(corners: Floats) -> Floats:
    """Lower and upper corners of the boxes of all nodes; the box of a node without triangles is empty."""
    leaves = 1
    while leaves * LEAF < len(corners):
        leaves *= 2
    out = np.empty((2 * leaves, 6))
    for empty in out:
        fill(empty[:3], np.inf)
        fill(empty[3:], -np.inf)
    for m in range(len(corners)):
        box = leaves + m // LEAF
        for k in range(3):
            for d in range(3):
                out[box, d] = min(out[box, d], corners[m, k, d])
                out[box, 3 + d] = max(out[box, 3 + d], corners[m, k, d])
    for box in range(leaves - 1, 0, -1):
        for d in range(3):
            out[box, d] = min(out[2 * box, d], out[2 * box + 1, d])
            out[box, 3 + d] = max(out[2 * box, 3 + d], out[2 * box + 1, 3 + d])
    return out


@njit(forceinline=True, cache=True)
def _to_box(boxes: Floats, box: int, x: float, y: float, z: float) -> float:
    """Squared distance of a point to a box."""
    a = max(boxes[box, 0] - x, x - boxes[box, 3], 0.0)
    b = max(boxes[box, 1] - y, y - boxes[box, 4], 0.0)
    c = max(boxes[box, 2] - z, z - boxes[box, 5], 0.0)
    return a * a + b * b + c * c


@njit(nogil=True, cache=True)
def _to_triangle(corners: Floats, m: int, x: float, y: float, z: float) -> float:
    """Squared distance of a point to triangle m, by Voronoi regions (Ericson 2005, 5.1.5)."""
    px, py, pz = x - corners[m, 0, 0], y - corners[m, 0, 1], z - corners[m, 0, 2]
    ax, ay, az = (
        corners[m, 1, 0] - corners[m, 0, 0], corners[m, 1, 1] - corners[m, 0, 1], corners[m, 1, 2] - corners[m, 0, 2],
    )  # fmt: skip
    bx, by, bz = (
        corners[m, 2, 0] - corners[m, 0, 0], corners[m, 2, 1] - corners[m, 0, 1], corners[m, 2, 2] - corners[m, 0, 2],
    )  # fmt: skip
    aa, ab, bb = ax * ax + ay * ay + az * az, ax * bx + ay * by + az * bz, bx * bx + by * by + bz * bz
    d1, d2 = ax * px + ay * py + az * pz, bx * px + by * py + bz * pz
    d3, d4, d5, d6 = d1 - aa, d2 - ab, d1 - ab, d2 - bb
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    v = w = 0.0  # of the nearest point: corner 0 + v a + w b
    if d1 <= 0.0 and d2 <= 0.0:
        pass
    elif d3 >= 0.0 and d4 <= d3:
        v = 1.0
    elif d6 >= 0.0 and d5 <= d6:
        w = 1.0
    elif aa > 0.0 and vc <= 0.0 and d1 >= 0.0 and d3 <= 0.0:
        v = d1 / aa
    elif bb > 0.0 and vb <= 0.0 and d2 >= 0.0 and d6 <= 0.0:
        w = d2 / bb
    elif va <= 0.0 and d4 >= d3 and d5 >= d6:
        whole = (d4 - d3) + (d5 - d6)
        w = (d4 - d3) / whole if whole > 0.0 else 0.0
        v = 1.0 - w
    elif va + vb + vc > 0.0:
        v, w = vb / (va + vb + vc), vc / (va + vb + vc)
    px, py, pz = px - v * ax - w * bx, py - v * ay - w * by, pz - v * az - w * bz
    return px * px + py * py + pz * pz


@njit(nogil=True, cache=True)
def _distances(first: int, last: int, corners: Floats, boxes: Floats, points: Floats, out: Floats) -> None:
    """Distances for runs of points first to last; each point starts from the triangle nearest to the point before."""
    leaves = len(boxes) // 2
    stack, far = np.empty(64, np.int64), np.empty(64)
    for run in range(first, last):
        near = -1
        for i in range(run * RUN, min((run + 1) * RUN, len(points))):
            x, y, z = points[i, 0], points[i, 1], points[i, 2]
            least = np.inf if near < 0 else _to_triangle(corners, near, x, y, z)
            stack[0], far[0], size = 1, 0.0, 1
            while size > 0:
                size -= 1
                box = stack[size]
                if far[size] >= least:
                    continue
                if box >= leaves:
                    for m in range((box - leaves) * LEAF, min((box - leaves + 1) * LEAF, len(corners))):
                        square = _to_triangle(corners, m, x, y, z)
                        if square < least:
                            least, near = square, m
                    continue
                one, two = _to_box(boxes, 2 * box, x, y, z), _to_box(boxes, 2 * box + 1, x, y, z)
                # the nearer half is pushed last, so that it is searched first
                swap = 1 if one < two else 0
                if max(one, two) < least:
                    stack[size], far[size] = 2 * box + swap, max(one, two)
                    size += 1
                if min(one, two) < least:
                    stack[size], far[size] = 2 * box + 1 - swap, min(one, two)
                    size += 1
            out[i] = np.sqrt(least)


@njit(nogil=True, cache=True)
def meets(triangle: Floats, x: float, y: float, z: float, dx: float, dy: float, dz: float, wider: float) -> float:
    """Share of the vector d at which a line along it from a point meets a triangle (Moeller and Trumbore 1997).

    The triangle counts as wider by that share of its sides.  Infinity if the line misses it or grazes its plane.
    """
    ax, ay, az = triangle[1, 0] - triangle[0, 0], triangle[1, 1] - triangle[0, 1], triangle[1, 2] - triangle[0, 2]
    bx, by, bz = triangle[2, 0] - triangle[0, 0], triangle[2, 1] - triangle[0, 1], triangle[2, 2] - triangle[0, 2]
    nx, ny, nz = ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx
    volume = -(nx * dx + ny * dy + nz * dz)
    if volume**2 <= GRAZE**2 * (dx * dx + dy * dy + dz * dz) * (nx * nx + ny * ny + nz * nz):
        return np.inf
    tx, ty, tz = x - triangle[0, 0], y - triangle[0, 1], z - triangle[0, 2]
    qx, qy, qz = dy * tz - dz * ty, dz * tx - dx * tz, dx * ty - dy * tx
    u, v = -(bx * qx + by * qy + bz * qz) / volume, (ax * qx + ay * qy + az * qz) / volume
    if u < -wider or v < -wider or u + v > 1.0 + wider:
        return np.inf
    return (nx * tx + ny * ty + nz * tz) / volume


@njit(nogil=True, cache=True)
def _first_hits(
    first: int, last: int, corners: Floats, numbers: Ints, boxes: Floats, start: Floats, ray: Floats, out: Ints
) -> None:
    """First faces that segments first to last meet; segments are short, so their boxes are compared with the tree's."""
    leaves = len(boxes) // 2
    stack = np.empty(64, np.int64)
    for i in range(first, last):
        x, y, z, dx, dy, dz = start[i, 0], start[i, 1], start[i, 2], ray[i, 0], ray[i, 1], ray[i, 2]
        x0, y0, z0 = min(x, x + dx), min(y, y + dy), min(z, z + dz)
        x1, y1, z1 = max(x, x + dx), max(y, y + dy), max(z, z + dz)
        least, found, size = 2.0, -1, 1
        stack[0] = 1
        while size > 0:
            size -= 1
            box = stack[size]
            if boxes[box, 0] > x1 or boxes[box, 1] > y1 or boxes[box, 2] > z1:
                continue
            if boxes[box, 3] < x0 or boxes[box, 4] < y0 or boxes[box, 5] < z0:
                continue
            if box >= leaves:
                for m in range((box - leaves) * LEAF, min((box - leaves + 1) * LEAF, len(corners))):
                    t = meets(corners[m], x, y, z, dx, dy, dz, 0.0)
                    if 0.0 <= t <= 1.0 and t < least:
                        least, found = t, m
                continue
            stack[size], stack[size + 1] = 2 * box, 2 * box + 1
            size += 2
        out[i] = numbers[found] if found >= 0 else -1
