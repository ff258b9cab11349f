"""Results in other formats: read back by meshio, with a note of what is lost."""

import subprocess
import sys
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista as pv
import trimesh
from export_results import plain_results, waisted_results

from meshwind.exporting.formats import FORMATS, write_formats
from meshwind.results.vtk_reading import read_faces, read_lines

ENDING = {name: name for name in FORMATS} | {"gmsh": "msh"}
PARTS = "surface", "quads", "paths", "bridges", "crossings"


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, list[str]]:
    out = tmp_path_factory.mktemp("formats")
    return out, write_formats(out, waisted_results(out), tuple(FORMATS))


def test_every_part_is_in_every_format(written: tuple[Path, list[str]]) -> None:
    found = {file.name for file in (written[0] / "formats").iterdir()}
    assert found == {f"{part}.{ending}" for part in PARTS for ending in (*ENDING.values(), "h5")}


@pytest.mark.parametrize("name", ["vtu", "vtk", "xdmf", "gmsh"])
def test_lines_carry_their_data(written: tuple[Path, list[str]], name: str, capsys: pytest.CaptureFixture[str]) -> None:
    lines = read_lines(written[0] / "paths.vtp")
    read = meshio.read(written[0] / "formats" / f"paths.{ENDING[name]}")
    assert [block.type for block in read.cells] == ["line"]
    segments = read.cells[0].data
    count, each = len(lines.starts) - 1, int(lines.starts[1])
    assert len(segments) == count * (each - 1)
    assert np.array_equal(read.points, lines.points)
    path = read.cell_data["path"][0].ravel()
    assert np.array_equal(path, np.repeat(np.arange(count), each - 1))
    assert np.array_equal(segments // each, np.stack([path, path], axis=1).astype(int))
    steps = np.linalg.norm(np.diff(read.points[segments], axis=1)[:, 0], axis=1)
    assert np.bincount(path.astype(int), steps) == pytest.approx(lines.line_data["length"])
    assert np.array_equal(read.point_data["slip"].ravel(), lines.point_data["slip"], equal_nan=True)
    assert np.array_equal(read.point_data["normal"], lines.point_data["normal"])
    assert np.array_equal(read.point_data["uv_0"].ravel(), lines.point_data["uv"][:, 0])
    assert capsys.readouterr().err == ""


@pytest.mark.parametrize("name", FORMATS)
def test_faces_come_back(written: tuple[Path, list[str]], name: str) -> None:
    faces = read_faces(written[0] / "quads.vtu")
    read = meshio.read(written[0] / "formats" / f"quads.{ENDING[name]}")
    held = {block.type: block.data for block in read.cells}
    assert np.array_equal(held["quad"], faces.quads)
    assert np.array_equal(held["triangle"], faces.triangles)
    assert np.array_equal(read.points, faces.points)


@pytest.mark.parametrize("part", ["surface", "quads"])
@pytest.mark.parametrize("name", ["ply", "obj"])
def test_trimesh_opens_the_faces(written: tuple[Path, list[str]], part: str, name: str) -> None:
    faces = read_faces(written[0] / f"{part}.vtu")
    read: Any = trimesh.load(written[0] / "formats" / f"{part}.{name}", process=False)
    assert np.array_equal(read.vertices, faces.points)
    assert len(read.faces) == 2 * len(faces.quads) + len(faces.triangles)


@pytest.mark.parametrize("part", PARTS)
def test_pyvista_opens_the_xdmf(written: tuple[Path, list[str]], part: str) -> None:
    formats = written[0] / "formats"
    read: Any = pv.read(formats / f"{part}.xdmf")
    same: Any = pv.read(formats / f"{part}.vtu")
    assert np.array_equal(read.points, same.points)
    assert np.array_equal(read.cells, same.cells)
    assert set(read.point_data) == set(same.point_data) and set(read.cell_data) == set(same.cell_data)
    for name in same.point_data:
        assert np.array_equal(read.point_data[name], same.point_data[name], equal_nan=True), name
    for name in same.cell_data:
        assert np.array_equal(read.cell_data[name], same.cell_data[name], equal_nan=True), name


@pytest.mark.parametrize("part", PARTS)
def test_so_does_meshio(written: tuple[Path, list[str]], part: str) -> None:
    formats = written[0] / "formats"
    read, same = meshio.read(formats / f"{part}.xdmf"), meshio.read(formats / f"{part}.vtu")
    assert np.array_equal(read.points, same.points)
    assert set(read.point_data) == set(same.point_data)
    for name, values in same.point_data.items():
        assert np.array_equal(read.point_data[name], values, equal_nan=True), name
    for kind, block in same.cells_dict.items():
        assert np.array_equal(read.cells_dict[kind], block)
    for name, values in same.cell_data_dict.items():
        for kind, held in values.items():
            assert np.array_equal(read.cell_data_dict[name][kind], held, equal_nan=True), name


@pytest.mark.parametrize("part", PARTS)
@pytest.mark.parametrize("name", ["vtk", "ply"])
def test_vtk_reads_what_meshio_wrote(written: tuple[Path, list[str]], name: str, part: str) -> None:
    """Without a word to standard error, where VTK says what it leaves out, and with every field."""
    file = written[0] / "formats" / f"{part}.{name}"
    code = "import sys; import pyvista as pv; pv.vtk_verbosity('info'); print(*pv.read(sys.argv[1]).array_names)"
    ran = subprocess.run([sys.executable, "-c", code, str(file)], capture_output=True, text=True, check=True)
    assert ran.stderr == ""
    if name == "vtk":
        same: Any = pv.read(file.with_suffix(".vtu"))
        assert set(ran.stdout.split()) == set(same.array_names)


def test_ply_holds_vectors_by_component(written: tuple[Path, list[str]]) -> None:
    lines = read_lines(written[0] / "paths.vtp")
    read = meshio.read(written[0] / "formats" / "paths.ply")
    assert np.array_equal(read.point_data["normal_2"], lines.point_data["normal"][:, 2])
    assert np.array_equal(read.point_data["uv_1"], lines.point_data["uv"][:, 1])


def test_obj_holds_lines_and_points(written: tuple[Path, list[str]]) -> None:
    for part, letter, file in (("bridges", "l", "bridges.vtp"), ("crossings", "p", "")):
        rows = [line.split() for line in (written[0] / "formats" / f"{part}.obj").read_text().splitlines()]
        points = np.array([row[1:] for row in rows if row[0] == "v"], dtype=float)
        cells = [row for row in rows if row[0] == letter]
        if file:
            lines = read_lines(written[0] / file)
            assert np.array_equal(points, lines.points)
            assert len(cells) == len(points) - (len(lines.starts) - 1)
        else:
            assert len(cells) == len(points) > 0


def test_what_is_lost_is_reported_once(written: tuple[Path, list[str]]) -> None:
    notes = written[1]
    assert len(notes) == len(set(notes)) == 5
    assert any(note.startswith("gmsh: no entry for the unit") for note in notes)
    assert any(note.startswith("ply: no lines") for note in notes)
    assert any(note.startswith("ply: no data of cells; of paths it lacks path, family") for note in notes)
    assert any(note.startswith("obj: no fields") for note in notes)


def test_a_part_without_bridges_has_no_file_of_them(tmp_path: Path) -> None:
    results = plain_results(tmp_path)
    assert write_formats(tmp_path, results, ("vtu",)) == ["bridges: there are none, so no format has a file of them"]
    assert not (tmp_path / "formats" / "bridges.vtu").exists()
