"""Making a mesh manifold: no edge with more than two faces, no vertex shared by separate fans of faces."""

import igl
import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.geometry.subdivide import subdivide
from meshwind.mesh.geometry.topology import Edges, components, edges, patches


def without_small_patches(vertices: Floats, faces: Ints) -> Ints:
    """Drop the smallest patch at each edge where several patches meet: inner walls, fins, touching bodies."""
    while True:
        found = edges(faces)
        if not (found.count > 2).any():
            return faces
        label = patches(faces, found)
        size: Floats = np.bincount(label, areas(vertices, faces)).astype(np.float64)
        smallest = _smallest_at_edges(found, label, size)
        if len(smallest) == 0:
            return faces
        faces = faces[~np.isin(label, smallest)]


def _smallest_at_edges(found: Edges, label: Ints, size: Floats) -> Ints:
    """Patches that are the smallest at every edge with more than two faces where they meet another patch."""
    at = found.of_face.ravel()
    crowded = np.flatnonzero(found.count[at] > 2)
    edge, patch = at[crowded], label[crowded // 3]
    rank = np.empty(len(size), dtype=np.int64)
    rank[np.lexsort((np.arange(len(size)), size))] = np.arange(len(size))
    lowest = np.full(len(found.count), len(size))
    highest = np.full(len(found.count), -1)
    np.minimum.at(lowest, edge, rank[patch])
    np.maximum.at(highest, edge, rank[patch])
    contested = lowest[edge] < highest[edge]
    larger = np.bincount(patch[contested & (rank[patch] != lowest[edge])], minlength=len(size))
    smaller = np.bincount(patch[contested & (rank[patch] == lowest[edge])], minlength=len(size))
    return np.flatnonzero((smaller > 0) & (larger == 0))


def without_odd_faces(vertices: Floats, faces: Ints) -> Ints:
    """Drop the smallest face at each edge where one patch meets itself with an odd number of faces above two."""
    while True:
        count = edges(faces).count
        odd = (count > 2) & (count % 2 == 1)
        if not odd.any():
            return faces
        faces = _without_smallest(vertices, faces, odd)


def _without_smallest(vertices: Floats, faces: Ints, chosen: Bools) -> Ints:
    """Drop the smallest face at each of the chosen edges (e,)."""
    at, size = edges(faces).of_face.ravel(), areas(vertices, faces)
    half = np.flatnonzero(chosen[at])
    half = half[np.lexsort((half, size[half // 3], at[half]))]
    first = np.unique(at[half], return_index=True)[1]
    return np.delete(faces, half[first] // 3, axis=0)


def oriented(faces: Ints) -> Ints:
    """Give the faces of each patch one orientation."""
    if not disagreements(faces):
        return faces
    return np.asarray(igl.bfs_orient(faces)[0], dtype=np.int64)


def disagreements(faces: Ints) -> int:
    """Number of edges whose two faces have opposite orientations."""
    first, second = edges(faces).pairs()
    return int((faces.ravel()[first] == faces.ravel()[second]).sum())


def check_orientable(faces: Ints, name: str) -> None:
    """Refuse an oriented manifold mesh that is not orientable."""
    if disagreements(faces):
        raise BadInputError(f"{name}: has only one side, like a Moebius strip; give a part with an inside")


def separated(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Split edges with four or more oriented faces, and vertices shared by separate fans.

    At an edge, faces that bound the same solid wedge are paired, which separates bodies that touch.  An edge whose
    wedges are connected at both ends is halved, so that its midpoint can be split.
    """
    points, split = _separated(vertices, faces)
    found = edges(split)
    double = found.ends[found.count > 2]
    if len(double) == 0:
        return points, split
    points = np.concatenate([points, points[double].mean(axis=1)])
    points, split = _separated(points, subdivide(points, split, double, len(points) - len(double)))
    while edges(split).count.max() > 2:  # faces that bound no wedge in any pairing
        split = without_odd_faces(points, _without_smallest(points, split, edges(split).count > 2))
        points, split = _separated(points, split)
    return points, split


def _separated(vertices: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Give each fan of faces that are paired across edges a vertex of its own."""
    found = edges(faces)
    first, second = found.pairs()
    if (found.count > 2).any():
        crowded = _wedges(vertices, faces, found)
        first, second = (np.concatenate(both) for both in zip((first, second), crowded, strict=True))
    # two corners are one vertex if their faces are paired across an edge with this vertex
    tail, head = first, _next(first)
    same = faces.ravel()[first] == faces.ravel()[second]
    other_tail, other_head = np.where(same, second, _next(second)), np.where(same, _next(second), second)
    label = components(3 * len(faces), np.concatenate([tail, head]), np.concatenate([other_tail, other_head]))
    corner = np.empty(label.max(initial=-1) + 1, dtype=np.int64)
    corner[label[::-1]] = np.arange(len(label))[::-1]  # the first of each fan is written last
    order = np.argsort(faces.ravel()[corner], kind="stable")
    renumber = np.empty(len(corner), dtype=np.int64)
    renumber[order] = np.arange(len(corner))
    return vertices[faces.ravel()[corner[order]]], renumber[label].reshape(-1, 3)


def _next(half_edges: Ints) -> Ints:
    """The next half-edge of the same face; its index is also that of the corner at which it starts."""
    return np.where(half_edges % 3 == 2, half_edges - 2, half_edges + 1)


def _wedges(vertices: Floats, faces: Ints, found: Edges) -> tuple[Ints, Ints]:
    """Pairs of half-edges that bound a solid wedge at each edge with four or more faces."""
    half = np.flatnonzero(found.count[found.of_face.ravel()] > 2)
    edge = found.of_face.ravel()[half]
    low, high = (vertices[found.ends[edge, k]] for k in range(2))
    along = (faces.ravel()[half] == found.ends[edge, 0]) == (volume(vertices, faces) >= 0)
    axis = high - low
    apex = vertices[faces.ravel()[_next(_next(half))]] - low
    across = np.eye(3)[np.argmin(np.abs(axis), axis=1)]
    side = np.cross(axis, across)
    up = np.cross(axis, side) / np.linalg.norm(axis, axis=1, keepdims=True)
    angle = np.arctan2(np.einsum("ij,ij->i", apex, up), np.einsum("ij,ij->i", apex, side))
    order = np.lexsort((angle, edge))
    half, edge, along = half[order], edge[order], along[order]
    starts = np.flatnonzero(np.r_[True, edge[1:] != edge[:-1]]) if len(edge) else np.empty(0, dtype=np.int64)
    size = np.diff(np.r_[starts, len(edge)])
    first, many = np.repeat(starts, size), np.repeat(size, size)
    position = np.arange(len(edge)) - first
    following = first + (position + 1) % many
    # faces that bound a wedge have opposite directions along the edge; if both pairings satisfy this, the solid is
    # before an outward face along the edge, and behind one against it
    alike = np.where(position % 2 == 0, 1, -1) * (along == along[following])
    balance = np.add.reduceat(alike, starts) if len(starts) else np.empty(0, dtype=np.int64)
    shift = np.where(balance == 0, along[starts], balance > 0).astype(np.int64)
    ring = half[first + (position + np.repeat(shift, size)) % many]
    return ring[::2], ring[1::2]
