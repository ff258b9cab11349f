"""Areas and edge lengths of faces, the volume that they enclose, and lengths, areas and centroids of loops."""

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.mesh.geometry.topology import boundary, components


def area_vectors(vertices: Floats, faces: Ints) -> Floats:
    """Normal of each face (m, 3), whose length is the area."""
    return np.asarray(_area_vectors(frozen(vertices), frozen(faces)))


@njit(nogil=True, cache=True)
def _area_vectors(vertices: Floats, faces: Ints) -> Floats:
    """Compiled, as are edge lengths, as it takes a tenth of the time of NumPy and is called at every step."""
    out = np.empty((len(faces), 3))
    for m in range(len(faces)):
        i, j, k = faces[m, 0], faces[m, 1], faces[m, 2]
        ax, bx = vertices[j, 0] - vertices[i, 0], vertices[k, 0] - vertices[i, 0]
        ay, by = vertices[j, 1] - vertices[i, 1], vertices[k, 1] - vertices[i, 1]
        az, bz = vertices[j, 2] - vertices[i, 2], vertices[k, 2] - vertices[i, 2]
        out[m, 0] = 0.5 * (ay * bz - az * by)
        out[m, 1] = 0.5 * (az * bx - ax * bz)
        out[m, 2] = 0.5 * (ax * by - ay * bx)
    return out


def areas(vertices: Floats, faces: Ints) -> Floats:
    """Area of each face (m,)."""
    x, y, z = area_vectors(vertices, faces).T
    return np.asarray(np.sqrt(x * x + y * y + z * z))


def edge_lengths(vertices: Floats, faces: Ints) -> Floats:
    """Length (m, 3) of the edge from each corner to the next."""
    return np.asarray(_edge_lengths(frozen(vertices), frozen(faces)))


@njit(nogil=True, cache=True)
def _edge_lengths(vertices: Floats, faces: Ints) -> Floats:
    out = np.empty((len(faces), 3))
    for m in range(len(faces)):
        for k in range(3):
            tail, head = faces[m, k], faces[m, (k + 1) % 3]
            x = vertices[head, 0] - vertices[tail, 0]
            y = vertices[head, 1] - vertices[tail, 1]
            z = vertices[head, 2] - vertices[tail, 2]
            out[m, k] = np.sqrt(x * x + y * y + z * z)
    return out


def volume(vertices: Floats, faces: Ints) -> float:
    """Signed volume, positive if faces are oriented outwards; loops are closed by fans to their mean vertices."""
    rim = boundary(faces)
    points = vertices - np.bincount(faces.ravel(), minlength=len(vertices)) @ vertices / faces.size
    solid = float(np.einsum("ij,ij->", points[faces[:, 0]], area_vectors(points, faces)) / 3.0)
    if len(rim) == 0:
        return solid
    loop = components(len(points), rim[:, 0], rim[:, 1])[rim[:, 0]]
    label = np.unique(loop, return_inverse=True)[1]
    sums = np.column_stack([np.bincount(label, points[rim[:, 0], k]) for k in range(3)])
    centres = sums / np.bincount(label)[:, None]
    caps = np.einsum("ij,ij->", points[rim[:, 1]], np.cross(points[rim[:, 0]], centres[label]))
    return solid + float(caps) / 6.0


def perimeter(vertices: Floats, loop: Ints) -> float:
    """Length of a loop."""
    points = vertices[loop]
    return float(np.linalg.norm(np.roll(points, -1, axis=0) - points, axis=1).sum())


def loop_centroid(vertices: Floats, loop: Ints) -> Floats:
    """Centroid (3,) of a loop, weighted by length, so that it does not depend on how finely an edge is divided."""
    points = vertices[loop]
    following = np.roll(points, -1, axis=0)
    length = np.linalg.norm(following - points, axis=1)
    return np.asarray((0.5 * (points + following) * length[:, None]).sum(axis=0) / length.sum())


def loop_area_vector(vertices: Floats, loop: Ints) -> Floats:
    """Area vector (3,) of a loop, by the right-hand rule."""
    points = vertices[loop] - vertices[loop].mean(axis=0)
    return np.asarray(0.5 * np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0))


def loop_area(vertices: Floats, loop: Ints) -> float:
    """Area enclosed by a loop; unlike the perimeter, it vanishes for an open seam."""
    return float(np.linalg.norm(loop_area_vector(vertices, loop)))
