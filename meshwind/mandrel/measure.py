"""Areas, volumes and loops in space."""

import numpy as np

from meshwind.cast import Floats, Ints
from meshwind.mandrel.topology import boundary, components


def area_vectors(vertices: Floats, faces: Ints) -> Floats:
    """Normal of each face (m, 3), as long as its area."""
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    return np.asarray(0.5 * np.cross(b - a, c - a))


def areas(vertices: Floats, faces: Ints) -> Floats:
    """Area of each face (m,)."""
    return np.asarray(np.linalg.norm(area_vectors(vertices, faces), axis=1))


def edge_lengths(vertices: Floats, faces: Ints) -> Floats:
    """Length (m, 3) of the edge from each corner to the next."""
    corners = vertices[faces]
    return np.asarray(np.linalg.norm(np.roll(corners, -1, axis=1) - corners, axis=2))


def volume(vertices: Floats, faces: Ints) -> float:
    """Signed volume, positive where faces point outward; open loops are capped by fans to their centroids."""
    points = vertices - vertices[faces].mean(axis=(0, 1))
    rim = boundary(faces)
    solid = _tetrahedra(*(points[faces[:, k]] for k in range(3)))
    if len(rim) == 0:
        return solid
    loop = components(len(points), rim[:, 0], rim[:, 1])[rim[:, 0]]
    label = np.unique(loop, return_inverse=True)[1]
    sums = np.column_stack([np.bincount(label, points[rim[:, 0], k]) for k in range(3)])
    centres = sums / np.bincount(label)[:, None]
    return solid + _tetrahedra(points[rim[:, 1]], points[rim[:, 0]], centres[label])


def _tetrahedra(a: Floats, b: Floats, c: Floats) -> float:
    """Signed volume between the origin and triangles."""
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0)


def perimeter(vertices: Floats, loop: Ints) -> float:
    """Length of a loop."""
    points = vertices[loop]
    return float(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum())


def loop_centroid(vertices: Floats, loop: Ints) -> Floats:
    """Centroid (3,) of a loop, weighted by length, so that it does not depend on how finely a side is cut."""
    points = vertices[loop]
    following = np.roll(points, -1, axis=0)
    length = np.linalg.norm(following - points, axis=1)
    return np.asarray((0.5 * (points + following) * length[:, None]).sum(axis=0) / length.sum())


def loop_area_vector(vertices: Floats, loop: Ints) -> Floats:
    """Area vector (3,) of a loop, by the right hand along its sense."""
    points = vertices[loop] - vertices[loop].mean(axis=0)
    return np.asarray(0.5 * np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0))
