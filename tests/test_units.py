"""The unit of length: the default of the command line, and its name in every file of a run and its exports."""

import inspect
import json
import re
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista as pv
from command import meshwind
from export_results import waisted_results
from PIL import Image

from meshwind.cli.wind import wind
from meshwind.core.errors import BadInputError
from meshwind.core.units import MILLIMETRES, check_units, lengths_in, millimetres
from meshwind.exporting.targets import ExportOptions, write_exports
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.results.write import write_edited

DATA = Path(__file__).parents[1] / "data"
LENGTHS = {
    "paths.vtp": {"gap", "arc_length", "length", "fibre_length", "bridged_length", "max_gap"},
    "bridges.vtp": {"gap", "length", "max_gap"},
    "surface.vtu": set(),
    "quads.vtu": set(),
    "crossings.vtp": set(),
}


@pytest.fixture(scope="module")
def inches(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run in inches and all its exports."""
    folder = tmp_path_factory.mktemp("inches")
    waisted_results(folder, "in")
    formats = "vtu", "vtk", "xdmf", "ply", "obj", "gmsh"
    notes = write_exports(
        folder, ["inp", "fibers", "frames", "step", "viewer"], options=ExportOptions(thickness=0.01, formats=formats)
    ).notes
    assert "gmsh: no entry for the unit of length; lengths in in" in notes
    return folder


@pytest.mark.parametrize("name", LENGTHS)
def test_fields_of_vtk_files_are_labelled(inches: Path, name: str) -> None:
    read = pv.read(inches / name)
    assert label(read.GetPoints().GetData()) == "in"
    held = [*(read.point_data[key] for key in read.point_data), *(read.cell_data[key] for key in read.cell_data)]
    labels = {array.VTKObject.GetName(): label(array.VTKObject) for array in held}
    assert {key for key, unit in labels.items() if unit == "in"} == LENGTHS[name]
    curved = {"mean_curvature": "1/in", "gaussian_curvature": "1/in2", "angle": "degrees", "windability": None}
    assert all(labels[key] == unit for key, unit in curved.items() if key in labels)
    if name.endswith(".vtu"):
        assert np.array_equal(meshio.read(inches / name).points, read.points)


def label(array: object) -> object:
    return array.GetInformation().Get(array.UNITS_LABEL())  # type: ignore[attr-defined]


def test_an_edited_mesh_is_labelled_like_a_run(tmp_path: Path) -> None:
    mesh = Mesh(np.eye(3), np.array([[0, 1, 2]]))
    write_edited(tmp_path, mesh, np.full((3, 3), 0.1), "in")
    read = pv.read(tmp_path / "edited.vtu")
    arrays = [read.GetPoints().GetData(), *(read.point_data[key].VTKObject for key in ("displacement", "moved"))]
    assert [label(array) for array in arrays] == ["in", "in", "in"]
    assert b"lengths in in" in (tmp_path / "edited.ply").read_bytes()[:200]


@pytest.mark.parametrize("name", [
    "quads.obj", "fibers.vtu", "fibers.vtk", "shell.inp", "shell_s4r.inp", "formats/paths.vtu", "formats/quads.vtk",
    "formats/surface.ply", "formats/bridges.obj",
])  # fmt: skip
def test_headers_name_the_unit(inches: Path, name: str) -> None:
    assert b"lengths in in" in (inches / name).read_bytes()[:400]


def test_the_other_files_name_it_in_their_own_way(inches: Path) -> None:
    assert np.load(inches / "surface.npz")["units"] == "in"
    with Image.open(inches / "chart.png") as picture:
        assert picture.info["meshwind units"] == "in"
    assert json.loads((inches / "report.json").read_text())["mesh"]["units"] == "in"
    assert '<Information Name="units" Value="in">' in (inches / "formats" / "paths.xdmf").read_text()
    assert '"units":"in"' in (inches / "viewer.html").read_text(encoding="utf-8")


def test_what_is_in_millimetres_whatever_the_part_is_in(inches: Path) -> None:
    """The part is 4 inches long: robots and CAD get 101.6 mm."""
    frames = np.genfromtxt(inches / "frames" / "all.csv", delimiter=",", names=True)
    assert np.ptp(frames["z"]) == pytest.approx(101.6)
    step = (inches / "surface.step").read_text()
    assert re.search(r"LENGTH_UNIT\(\)\s*NAMED_UNIT\(\*\)\s*SI_UNIT\(\.MILLI\.,\.METRE\.\)", step)
    assert "101.6" in step


@pytest.mark.parametrize("name", MILLIMETRES)
def test_known_units(name: str) -> None:
    check_units(name)
    check_units(name.upper())
    assert millimetres(name.upper()) == millimetres(name) == MILLIMETRES[name]
    assert lengths_in(name) == f"lengths in {name}"


@pytest.mark.parametrize("name", ["milimeter", "m m", " ", "furlong", 3, None, "m" * 1000])
def test_unknown_units_are_refused(name: object) -> None:
    with pytest.raises(BadInputError, match="give mm, cm, m, um, in") as caught:
        check_units(name)
    assert len(str(caught.value)) < 160


def test_the_command_line_counts_in_millimetres(tmp_path: Path) -> None:
    assert inspect.signature(wind).parameters["units"].default is None
    done = meshwind("wind", DATA / "tank.ply", "--units", "milimeter", "--out", "x", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr == (
        "meshwind: error: units is 'milimeter'; give mm, cm, m, um, in, ft, or \"\" where the unit is not known\n"
    )
