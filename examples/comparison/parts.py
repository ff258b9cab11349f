"""Parts of revolution with known surfaces, as irregular meshes: what a mesh costs, and how well a fit follows it."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import igl
import numpy as np
from scipy.spatial import Delaunay

from comparison.problem import TURN
from comparison.problems import barrel_radius, vase_radius
from meshwind.core.cast import Floats, Ints
from meshwind.surface import Surface

JITTER = 1 / 3
"""Of the points, over their pitch."""
WRAP = 4.0
"""Pitches on either side of the seam that are repeated beyond the other, for triangles across it."""
FLAT = 1e-6
"""Area of a triangle, over about the mean, below which it is a sliver of the hull."""
SAMPLES = 20_000
"""Points of a fitted surface at which its error is measured."""


@dataclass(frozen=True)
class Revolved:
    """A part of revolution about z, from z = 0 to its height."""

    radius: Callable[[Floats], Floats]
    height: float

    def points(self, u: Floats, v: Floats) -> Floats:
        """Points (n, 3) at turns u and shares v of the height."""
        z = self.height * v
        r = self.radius(z)
        return np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), z], axis=-1)

    def distance(self, points: Floats) -> float:
        """Rms radial distance of points (n, 3) from the part."""
        off = np.hypot(points[:, 0], points[:, 1]) - self.radius(points[:, 2])
        return float(np.sqrt(np.mean(off**2)))

    def error(self, surface: Surface) -> float:
        """Rms radial distance of a fitted surface from the part, over its diagonal."""
        return self.distance(surface.points(np.random.default_rng(5).random((SAMPLES, 2)))) / surface.size


VASE = Revolved(vase_radius, 4.0)
PARTS = {
    "barrel": Revolved(barrel_radius, 2.0),
    "vase": VASE,
    "hyperboloid": Revolved(lambda z: np.hypot(1.0, z - 1.5), 3.0),
}
"""All parts by name."""


def irregular(part: Revolved, faces: int, seed: int = 0) -> tuple[Floats, Ints]:
    """Vertices on the part and about `faces` triangles: jittered points of a periodic rectangle, by Delaunay."""
    rng = np.random.default_rng(seed)
    turns = part.height / TURN
    around = round(np.sqrt(faces / 2 / turns))
    along = round(faces / 2 / around)
    i, j = np.meshgrid(np.arange(around), np.arange(along + 1), indexing="ij")
    jitter = rng.uniform(-JITTER, JITTER, (2, around, along + 1))
    jitter[1, :, [0, -1]] = 0.0
    # every other row is off by half a pitch, so that triangles are near equilateral
    u, v = (i + 0.5 * (j % 2) + jitter[0]).ravel() / around % 1.0, (j + jitter[1]).ravel() / along
    wrap = WRAP / around
    left, right = np.flatnonzero(u > 1 - wrap), np.flatnonzero(u < wrap)
    vertex = np.concatenate([np.arange(len(u)), left, right])
    plane = np.stack([np.concatenate([u, u[left] - 1, u[right] + 1]), v[vertex] * turns], axis=1)
    found = Delaunay(plane).simplices
    a, b = (plane[found[:, k]] - plane[found[:, 0]] for k in (1, 2))
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    middle = plane[found, 0].mean(axis=1)  # a face across the seam is there twice: once with its middle inside
    kept = (middle >= 0) & (middle < 1) & (np.abs(area) > FLAT / len(u))
    found = np.where(area[:, None] < 0, found[:, ::-1], found)[kept]
    return part.points(u, v), vertex[found].astype(np.int64)


def decimated(vertices: Floats, faces: Ints, kept: float) -> tuple[Floats, Ints]:
    """The mesh with a share of its faces, by quadric error."""
    found = igl.qslim(vertices, faces.astype(np.int32), int(kept * len(faces)))
    points, corners = found[1:3] if isinstance(found[0], bool | np.bool_) else found[:2]
    return np.asarray(points), np.asarray(corners, np.int64)


def write_ply(path: Path, vertices: Floats, faces: Ints) -> None:
    """Write a mesh as binary PLY in double precision."""
    face = np.zeros(len(faces), dtype=[("count", "u1"), ("corners", "<i4", 3)])
    face["count"], face["corners"] = 3, faces
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n"
    head += "".join(f"property double {x}\n" for x in "xyz")
    head += f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    path.write_bytes(head.encode() + vertices.astype("<f8").tobytes() + face.tobytes())
