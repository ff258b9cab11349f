"""Scalars of mesh files: every format that holds them, of points and of cells, and refusals in one line."""

from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
import trimesh

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.scalars import read_scalars

ROUND, ALONG = 24, 9
FORMATS = ("ply", "vtk", "vtu", "vtp", "msh")


def tube() -> tuple[Floats, Ints]:
    """An open tube of radius 1 and height 2, triangles outwards."""
    turn, z = np.arange(ROUND) / ROUND * 2 * np.pi, np.linspace(0.0, 2.0, ALONG)
    points = np.array([(np.cos(t), np.sin(t), h) for h in z for t in turn])
    i, j = np.meshgrid(np.arange(ROUND), np.arange(ALONG - 1))
    a, b = (j * ROUND + i).ravel(), (j * ROUND + (i + 1) % ROUND).ravel()
    faces = np.concatenate([np.stack([a, b, b + ROUND], 1), np.stack([a, b + ROUND, a + ROUND], 1)])
    return points, faces


def rough(points: Floats) -> Floats:
    """The scalar: rises along the tube and around it."""
    return np.asarray(0.1 + 0.05 * points[:, 2] + 0.02 * points[:, 0])


def save(folder: Path, kind: str, on_cells: bool) -> Path:
    """The tube in a format, with the scalar `mu` on points or cells, and an array that is no scalar."""
    points, faces = tube()
    faces = faces.astype(np.int32)
    file = folder / f"part.{kind}"
    middles = points[faces].mean(axis=1)
    values = rough(middles if on_cells else points)
    if kind in ("vtk", "vtu", "vtp"):
        cells = np.column_stack([np.full(len(faces), 3), faces])
        data = pyvista.PolyData(points, cells.ravel())
        if kind == "vtu":
            data = data.cast_to_unstructured_grid()
        (data.cell_data if on_cells else data.point_data)["mu"] = values
        data.point_data["velocity"] = points
        data.save(file)
        return file
    if kind == "ply" and on_cells:  # meshio writes none of these, but others do
        head = f"""ply
format ascii 1.0
element vertex {len(points)}
property double x
property double y
property double z
element face {len(faces)}
property list uchar int vertex_indices
property double mu
end_header
"""
        with file.open("w") as out:
            out.write(head)
            np.savetxt(out, points, "%.17g")
            np.savetxt(out, np.column_stack([np.full(len(faces), 3), faces, values]), ["%d"] * 4 + ["%.17g"])
        return file
    fields = {"cell_data": {"mu": [values]}} if on_cells else {"point_data": {"mu": values}}
    mesh = meshio.Mesh(points, [("triangle", faces)], **fields)
    meshio.write(file, mesh, **({"file_format": "gmsh"} if kind == "msh" else {}))
    return file


@pytest.mark.parametrize("on_cells", [False, True], ids=["points", "cells"])
@pytest.mark.parametrize("kind", FORMATS)
def test_scalars_are_read_with_their_points(kind: str, on_cells: bool, tmp_path: Path) -> None:
    file = save(tmp_path, kind, on_cells)
    scalars = read_scalars(file, "mu")
    points, faces = tube()
    positions = points[faces].mean(axis=1) if on_cells else points
    assert scalars.points == pytest.approx(positions, abs=1e-6)
    assert scalars.values == pytest.approx(rough(positions), abs=1e-6)
    assert not scalars.values.flags.writeable
    assert not scalars.points.flags.writeable


def in_memory(library: str, on_cells: bool) -> object:
    points, faces = tube()
    positions = points[faces].mean(axis=1) if on_cells else points
    if library == "trimesh":
        made = trimesh.Trimesh(points, faces, process=False)
        (made.face_attributes if on_cells else made.vertex_attributes)["mu"] = rough(positions)
        return made
    cells = [("vertex", np.array([[0]])), ("triangle", faces)]  # a cell that is no face has a value, too
    data = {"cell_data": {"mu": [[9.0], rough(positions)]}} if on_cells else {"point_data": {"mu": rough(positions)}}
    mesh = meshio.Mesh(points, cells, **data)
    return mesh if library == "meshio" else pyvista.from_meshio(mesh)


@pytest.mark.parametrize("on_cells", [False, True], ids=["points", "cells"])
@pytest.mark.parametrize("library", ["pyvista", "meshio", "trimesh"])
def test_meshes_in_memory_have_them_as_well(library: str, on_cells: bool) -> None:
    mesh = in_memory(library, on_cells)
    scalars = read_scalars(mesh, "mu")
    points, faces = tube()
    positions = points[faces].mean(axis=1) if on_cells else points
    assert scalars.points == pytest.approx(positions)
    assert scalars.values == pytest.approx(rough(positions))
    with pytest.raises(BadInputError, match="the mesh in memory: has no scalar 'nu'; it holds: mu"):
        read_scalars(mesh, "nu")


def test_a_run_takes_the_friction_of_a_mesh_in_memory() -> None:
    mesh = in_memory("pyvista", False)
    found = mw.wind(mesh, friction="field:mu", paths=2, particles=41, render=False)
    held = found.paths.slip[np.isfinite(found.paths.slip)]
    assert held.max() <= rough(tube()[0]).max() + 1e-6
    for bare in (tube(), mw.read(mesh)):
        with pytest.raises(BadInputError, match=r"a mesh of type \w+ holds no scalar 'mu'; give its file"):
            mw.wind(bare, friction="field:mu")


@pytest.mark.parametrize("kind", FORMATS)
def test_a_missing_scalar_is_refused_with_what_there_is(kind: str, tmp_path: Path) -> None:
    file = save(tmp_path, kind, False)
    with pytest.raises(BadInputError, match="has no scalar 'nu'") as refusal:
        read_scalars(file, "nu")
    text = str(refusal.value)
    assert "\n" not in text
    assert file.name in text
    assert "mu" in text.partition("it holds:")[2]


@pytest.mark.parametrize("name", ["part.stl", "part.obj", "part.off", "part.3mf", "part.xyz"])
def test_formats_without_scalars_say_where_to_put_them(name: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text("")
    with pytest.raises(BadInputError, match="holds no scalars; save the part with 'mu' as VTK") as refusal:
        read_scalars(tmp_path / name, "mu")
    assert "\n" not in str(refusal.value)


def test_vectors_are_not_scalars(tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="has no scalar 'velocity'; it holds: mu"):
        read_scalars(save(tmp_path, "vtp", False), "velocity")


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_a_scalar_that_is_not_finite_is_refused(bad: float, tmp_path: Path) -> None:
    points, faces = tube()
    values = rough(points)
    values[7] = bad
    data = pyvista.PolyData(points, np.column_stack([np.full(len(faces), 3), faces]).ravel())
    data.point_data["mu"] = values
    data.save(tmp_path / "part.vtp")
    with pytest.raises(BadInputError, match="not one finite number") as refusal:
        read_scalars(tmp_path / "part.vtp", "mu")
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("kind", FORMATS)
def test_files_that_cannot_be_read_are_refused_in_one_line(kind: str, tmp_path: Path) -> None:
    missing = tmp_path / f"none.{kind}"
    with pytest.raises(BadInputError, match="none") as refusal:
        read_scalars(missing, "mu")
    assert "\n" not in str(refusal.value)
    broken = tmp_path / f"broken.{kind}"
    broken.write_bytes(b"\x00\x01 nonsense \xff\n" * 20)
    with pytest.raises(BadInputError, match="broken") as refusal:
        read_scalars(broken, "mu")
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("kind", ["ply", "vtp", "vtu"])
def test_a_field_of_the_file_winds(kind: str, tmp_path: Path) -> None:
    """From file to path: the same answer as with the friction given as a function."""
    result = mw.wind(save(tmp_path, kind, False), paths=2, revolutions=0.4, friction="field:mu", particles=101)
    assert result.settled
    table = result.paths.friction
    assert table == pytest.approx(float(rough(tube()[0]).max()), rel=2e-2)
