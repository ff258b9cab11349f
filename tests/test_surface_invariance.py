"""Where a mesh lies, how large it is and in which order it lists its parts leave the fitted surface alone."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from
from meshwind.surface.foot import feet

DATA = Path(__file__).parents[1] / "data"
PARTS = ["vase.stl", "tank.ply", "bottle.obj", "wing.stl"]
LIMIT = 1e-6
"""Largest distance between the two surfaces, over the diagonal; measured: 1e-11, and 2e-9 far from the origin."""
UV = np.random.default_rng(7).random((3000, 2))


@dataclass(frozen=True)
class Change:
    """Another description of the same part: vertices @ matrix.T + shift * diagonal; or another order."""

    matrix: Floats
    shift: Floats
    shuffled: bool = False

    def apply(self, vertices: Floats, faces: Ints, diagonal: float) -> tuple[Floats, Ints]:
        if self.shuffled:
            rng = np.random.default_rng(3)
            order = rng.permutation(len(vertices))
            faces = np.argsort(order)[rng.permutation(faces)]
            faces = np.take_along_axis(faces, (np.arange(3) + rng.integers(0, 3, (len(faces), 1))) % 3, axis=1)
            vertices = vertices[order]
        if np.linalg.det(self.matrix) < 0:
            faces = faces[:, ::-1]
        return vertices @ self.matrix.T + self.shift * diagonal, faces

    def undo(self, points: Floats, diagonal: float) -> Floats:
        return np.asarray(np.linalg.solve(self.matrix, (points - self.shift * diagonal).T).T)


def rotation(seed: int) -> Floats:
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return np.asarray(q * np.linalg.det(q))


NONE, ZERO = np.eye(3), np.zeros(3)
FAR = 1e6 * np.array([0.6, -0.64, 0.48])
CHANGES = {
    "moved": Change(NONE, np.array([3.1, -2.0, 1.0])),
    "rotated": Change(rotation(0), ZERO),
    "upside-down": Change(np.diag([1.0, -1.0, -1.0]), ZERO),
    "tiny": Change(1e-6 * NONE, ZERO),
    "huge": Change(1e6 * NONE, ZERO),
    "far": Change(NONE, FAR),
    "mirrored": Change(np.diag([-1.0, 1.0, 1.0]), ZERO),
    "shuffled": Change(NONE, ZERO, shuffled=True),
    "all-at-once": Change(-1e6 * rotation(1), 1e6 * np.array([4.0, 5.0, -6.0]), shuffled=True),
}


@cache
def original(name: str) -> tuple[mw.Mesh, mw.Surface]:
    mesh = mw.read(DATA / name)
    return mesh, fitted(mesh)


def fitted(mesh: mw.Mesh) -> mw.Surface:
    return mw.fit(mw.flatten(mw.annulus(mesh)))


def distances(points: Floats, surface: mw.Surface) -> Floats:
    """Of points to a surface: the nearest of a lattice of 256 x 257 and its foot from there."""
    u, v = np.meshgrid(np.arange(256) / 256, np.linspace(0, 1, 257))
    lattice = np.stack([u.ravel(), v.ravel()], axis=1)
    guess = lattice[cKDTree(surface.points(lattice)).query(points)[1]]
    frames = np.empty((len(points), 6, 3))
    feet(0, len(points), surface.spline, points, guess, frames)
    return np.asarray(np.linalg.norm(points - frames[:, 0], axis=1))


def apart(surface: mw.Surface, other: mw.Surface, back: Callable[[Floats], Floats], diagonal: float) -> float:
    """Largest distance between two surfaces, sampled both ways, over the diagonal."""
    again = mw.Surface(back(other.control_points.reshape(-1, 3)).reshape(other.control_points.shape))
    there, here = distances(again.points(UV), surface), distances(surface.points(UV), again)
    return float(max(there.max(), here.max())) / diagonal


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("name", PARTS)
def test_the_surface_stays_the_same(name: str, change: str) -> None:
    mesh, surface = original(name)
    how, diagonal = CHANGES[change], mesh.diagonal
    other = fitted(mesh_from(*how.apply(mesh.vertices, mesh.faces, diagonal)))
    assert apart(surface, other, lambda points: how.undo(points, diagonal), diagonal) < LIMIT
    assert other.spans == surface.spans


@pytest.mark.parametrize("change", ["tiny", "far", "mirrored", "shuffled"])
@pytest.mark.parametrize("name", PARTS)
def test_from_a_file_too(name: str, change: str, tmp_path: Path) -> None:
    mesh, surface = original(name)
    how, diagonal = CHANGES[change], mesh.diagonal
    vertices, faces = how.apply(mesh.vertices, mesh.faces, diagonal)
    with (tmp_path / "part.obj").open("w") as file:
        np.savetxt(file, vertices, "v %.17g %.17g %.17g")
        np.savetxt(file, faces + 1, "f %d %d %d")
    other = fitted(mw.read(tmp_path / "part.obj"))
    assert apart(surface, other, lambda points: how.undo(points, diagonal), diagonal) < LIMIT


def test_a_change_of_shape_is_noticed() -> None:
    """The measure itself: one vertex in a thousand moved by a thousandth of the diagonal shows."""
    mesh, surface = original("vase.stl")
    vertices = mesh.vertices.copy()
    vertices[::1000, 0] += 1e-3 * mesh.diagonal
    assert apart(surface, fitted(mesh_from(vertices, mesh.faces)), lambda points: points, mesh.diagonal) > LIMIT
