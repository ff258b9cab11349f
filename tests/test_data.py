"""The sample parts are what they say: clean, irregular, true to their shapes, made again by the script."""

import subprocess
import sys
from pathlib import Path

import igl
import numpy as np
import pytest
import trimesh
from numpy.typing import NDArray

ROOT = Path(__file__).parent.parent
OPEN, CLOSED = ("vase.stl", "elbow.obj", "cast.ply"), ("tank.ply", "bottle.obj", "wing.stl")
PARTS = OPEN + CLOSED

Array = NDArray[np.float64]
Indices = NDArray[np.int64]


def load(name: str, folder: Path = ROOT / "data") -> tuple[Array, Indices]:
    """Return vertices and faces, the corners of an STL file's triangles welded."""
    mesh = trimesh.load_mesh(folder / name, process=False)
    if name.endswith(".stl"):
        mesh.merge_vertices(digits_vertex=None)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def capped(vertices: Array, faces: Indices) -> tuple[Array, Indices]:
    """Return the mesh with a fan over each of its loops, so that it bounds a body."""
    for loop in igl.boundary_loop_all(faces):
        ring = np.asarray(loop)
        fan = np.column_stack([np.roll(ring, -1), ring, np.full(len(ring), len(vertices))])
        if not ((faces == ring[0]) & (np.roll(faces, -1, axis=1) == ring[1])).any():
            fan = fan[:, [1, 0, 2]]
        vertices, faces = np.vstack([vertices, vertices[ring].mean(axis=0)]), np.vstack([faces, fan])
    return vertices, faces


def diagonal(vertices: Array) -> float:
    return float(np.linalg.norm(np.ptp(vertices, axis=0)))


@pytest.mark.parametrize("name", PARTS)
def test_parts_are_manifold_and_of_genus_0(name: str) -> None:
    vertices, faces = load(name)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    uses = np.bincount(mesh.edges_unique_inverse)
    loops = 0 if name in CLOSED else 2
    assert set(np.unique(faces)) == set(range(len(vertices)))
    assert len(igl.boundary_loop_all(faces)) == loops
    assert mesh.body_count == 1
    assert mesh.is_winding_consistent
    assert uses.max() == 2 and (uses.min() == 2) == (loops == 0)
    assert igl.is_vertex_manifold(faces).all()
    assert mesh.euler_number == 2 - loops


@pytest.mark.parametrize("name", PARTS)
def test_points_just_off_the_faces_are_once_inside_and_once_outside(name: str) -> None:
    # this holds only if faces look outward and none passes through another
    vertices, faces = load(name)
    body, shell = capped(vertices, faces)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    offset = 1e-5 * diagonal(vertices) * mesh.face_normals
    centres = mesh.triangles_center
    assert np.abs(igl.winding_number(body, shell, centres - offset) - 1).max() < 1e-6
    assert np.abs(igl.winding_number(body, shell, centres + offset)).max() < 1e-6


@pytest.mark.parametrize("name", PARTS)
def test_triangles_are_good_but_irregular(name: str) -> None:
    vertices, faces = load(name)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    # the wing's are stretched along its edges
    least, usual = (3, 8) if name == "wing.stl" else (15, 30)
    angles = np.degrees(mesh.face_angles).min(axis=1)
    assert angles.min() > least and np.quantile(angles, 0.01) > usual
    valence = np.bincount(mesh.edges_unique.ravel())
    assert 0.4 < (valence == 6).mean() < 0.75
    assert min((valence == 5).mean(), (valence == 7).mean()) > 0.1


@pytest.mark.parametrize("name", PARTS)
def test_facets_stay_close_to_the_surface_they_stand_for(name: str) -> None:
    vertices, faces = load(name)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    start, end = vertices[mesh.face_adjacency_edges].transpose(1, 0, 2)
    span = mesh.area_faces[mesh.face_adjacency].sum(axis=1) / np.linalg.norm(end - start, axis=1)
    sagitta = span * mesh.face_adjacency_angles / 8 / diagonal(vertices)
    assert 5000 <= len(faces) <= 13000
    assert np.median(sagitta) < 1e-4 and np.quantile(sagitta, 0.99) < 3e-4 and sagitta.max() < 6e-4


@pytest.mark.parametrize("name", OPEN)
def test_rims_are_spaced_as_the_interior(name: str) -> None:
    vertices, faces = load(name)
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    usual = float(np.median(mesh.edges_unique_length))
    for loop in igl.boundary_loop_all(faces):
        ring = vertices[loop]
        lengths = np.linalg.norm(ring - np.roll(ring, 1, axis=0), axis=1)
        assert 0.4 * usual < lengths.min() and lengths.max() < 1.8 * usual
        assert np.linalg.svd(ring - ring.mean(axis=0))[1][2] < 1e-5 * diagonal(vertices)


def test_elbow_lies_on_its_torus() -> None:
    x, y, z = load("elbow.obj")[0].T
    assert np.abs(np.hypot(np.hypot(x, z) - 90, y) - 30).max() < 1e-6
    assert min(x.min(), z.min()) > -1e-6


def test_tank_lies_on_its_superellipsoid_and_is_convex() -> None:
    vertices, faces = load("tank.ply")
    x, y, z = vertices.T
    assert np.abs((x**2 + y**2) / 60**2 + (z / 120) ** 6 - 1).max() < 2e-6
    hull = trimesh.Trimesh(vertices, faces, process=False).convex_hull
    assert len(hull.vertices) == len(vertices)


def test_vase_and_bottle_have_hollows_to_bridge() -> None:
    for name, share in (("vase.stl", 0.75), ("bottle.obj", 0.97), ("cast.ply", 0.75)):
        body = trimesh.Trimesh(*capped(*load(name)), process=False)
        assert body.volume < share * body.convex_hull.volume


def test_files_are_small() -> None:
    files = list((ROOT / "data").iterdir())
    assert sorted(file.name for file in files) == sorted(PARTS)
    assert sum(file.stat().st_size for file in files) < 3.5e6


def test_script_makes_the_same_files(tmp_path: Path) -> None:
    command = [sys.executable, str(ROOT / "examples" / "make_data.py"), "--out", str(tmp_path)]
    subprocess.run(command, check=True, timeout=240)
    for name in PARTS:
        vertices, faces = load(name)
        again_vertices, again_faces = load(name, tmp_path)
        # vertices are picked from a dense sample: rounding moves their digits, not the choice
        np.testing.assert_array_equal(again_faces, faces)
        np.testing.assert_allclose(again_vertices, vertices, rtol=0, atol=1e-6 * diagonal(vertices))
