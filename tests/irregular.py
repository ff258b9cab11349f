"""Irregular meshes of tubes with known surfaces, as a mesher would leave them."""

import numpy as np
from scipy.spatial import Delaunay, cKDTree

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.mesh import Annulus, Mesh
from meshwind.surface.interpolate import Formula


def tube(vertices: int, aspect: float, seed: int = 0, sparse: float = 1.0) -> tuple[Floats, Ints, tuple[Ints, Ints]]:
    """Blue-noise points on a periodic rectangle as long as `aspect` turns: uv, Delaunay faces, ordered rims.

    sparse: how much further apart the vertices of the rims are than the others.
    """
    rng = np.random.default_rng(seed)
    pitch = np.sqrt(aspect / vertices)
    count = round(1 / (sparse * pitch))
    rims = [np.sort((np.arange(count) + rng.uniform(-0.2, 0.2, count)) / count % 1.0) for _ in range(2)]
    edge = np.concatenate(
        [np.stack([rim, np.full(count, end)], axis=1) for rim, end in zip(rims, (0, aspect), strict=True)]
    )
    inner = rng.uniform([0, 0.6 * pitch], [1, aspect - 0.6 * pitch], (vertices - 2 * count, 2))
    for _ in range(30):  # neighbours push each other apart
        ring = _ring(np.concatenate([inner, edge]))
        distance, near = cKDTree(ring).query(inner, k=8)
        away = inner[:, None] - ring[near[:, 1:]]
        push = np.exp(-1.5 * (distance[:, 1:, None] / pitch) ** 2) / distance[:, 1:, None]
        inner = inner + 0.25 * pitch * (push * away).sum(axis=1)
        inner = np.stack([inner[:, 0] % 1, np.clip(inner[:, 1], 0.5 * pitch, aspect - 0.5 * pitch)], axis=1)
    uv = np.concatenate([inner, edge])
    ring = _ring(uv)
    faces = Delaunay(ring).simplices
    a, b = ring[faces[:, 1]] - ring[faces[:, 0]], ring[faces[:, 2]] - ring[faces[:, 0]]
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    faces[area < 0] = faces[area < 0][:, ::-1]
    middle = ring[faces][:, :, 0].mean(axis=1)
    faces = faces[(middle >= 0) & (middle < 1) & (np.abs(area) > 1e-9)] % len(uv)
    _, first = np.unique(np.sort(faces, axis=1), axis=0, return_index=True)
    start = len(inner) + np.arange(count)
    return uv / [1, aspect], faces[np.sort(first)].astype(np.int64), (start, start + count)


def _ring(uv: Floats) -> Floats:
    """Three copies side by side; index modulo the count gives the point."""
    return np.concatenate([uv - [1, 0], uv, uv + [1, 0]])


def annulus(formula: Formula, vertices: int, aspect: float, seed: int = 0, sparse: float = 1.0) -> Annulus:
    """An irregular mesh whose vertices lie on s(u, v), as an annulus."""
    uv, faces, rims = tube(vertices, aspect, seed, sparse)
    points = frozen(formula(uv[:, 0], uv[:, 1]))
    mesh = Mesh(points, frozen(faces), "tube")
    return Annulus(mesh, points, mesh.faces, rims, frozen(np.ones(len(points), dtype=bool)), "given")
