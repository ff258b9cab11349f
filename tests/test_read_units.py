"""The unit of length: as files and libraries spell it, as their format has it, and parts too small or large for it."""

import zipfile
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
import trimesh
from barrels import POINTS, QUADS, TRIANGLES, refusal, written

import meshwind as mw
from meshwind.appearance.words import size
from meshwind.core.errors import BadInputError
from meshwind.core.units import Unit, millimetres
from meshwind.workflow.options import Options
from meshwind.workflow.part import read_source

SPELLINGS = {
    "mm": ["MM", "Mm", "millimeter", "Millimetres", " mm ", "mm.", "\u339c"],
    "cm": ["CM", "centimeters", "centimetre"],
    "m": ["M", "meters", "Metre"],
    "um": ["\u00b5m", "\u03bcm", "UM", "micron", "Microns", "micrometre"],
    "in": ["IN", "in.", "inch", "Inches", '"', "\u2033"],
    "ft": ["FT", "foot", "Feet", "'", "\u2032"],
}
WORDS = [(name, word) for name, words in SPELLINGS.items() for word in words]
NAMES_NONE = ["Zoll", "furlong", "1", "km", "none"]


def labelled(unit: str) -> pv.PolyData:
    """The barrel with VTK's label of a unit."""
    made = pv.PolyData(POINTS, faces=np.insert(QUADS, 0, 4, axis=1))
    array = made.GetPoints().GetData()
    array.GetInformation().Set(array.UNITS_LABEL(), unit)
    return made


def in_units(unit: str) -> trimesh.Trimesh:
    """The barrel of trimesh in a unit."""
    made = trimesh.Trimesh(POINTS, TRIANGLES, process=False)
    made.units = unit
    return made


@pytest.mark.parametrize(("name", "word"), WORDS)
def test_usual_spellings(name: str, word: str) -> None:
    assert millimetres(word) == millimetres(name)
    assert mw.read((POINTS, np.array(TRIANGLES)), units=word).units == name
    assert mw.read(labelled(word)).units == name
    assert mw.read(in_units(word)).units == name


@pytest.mark.parametrize("word", NAMES_NONE)
def test_units_that_are_not_known_are_named(word: str, tmp_path: Path) -> None:
    labelled(word).save(tmp_path / "part.vtp")
    words = f"names the unit {word!r}, which is not known; give units"
    for mesh in (tmp_path / "part.vtp", labelled(word), in_units(word)):
        found = mw.read(mesh)
        assert (found.units, found.units_from, len(found.warnings)) == ("", "", 1)
        assert found.warnings[0].casefold() == words.casefold()  # trimesh keeps it in lower case
        assert mw.read(mesh, units="in").warnings == ()
    assert mw.check(tmp_path / "part.vtp").warnings == (words,)
    assert read_source(tmp_path / "part.vtp", Options()).mesh.warnings == (words,)
    assert read_source(tmp_path / "part.vtp", Options(units="inches")).mesh.warnings == ()


@pytest.mark.parametrize(("label", "unit"), [("meters", "m"), ("Inches", "in"), ("\u00b5m", "um"), ("MM", "mm")])
@pytest.mark.parametrize("ending", [".vtp", ".vtu"])
def test_labels_in_files(label: str, unit: str, ending: str, tmp_path: Path) -> None:
    made = labelled(label)
    grid = made.cast_to_unstructured_grid()
    grid.SetPoints(made.GetPoints())  # with its label
    (made if ending == ".vtp" else grid).save(tmp_path / f"part{ending}")
    found = mw.check(tmp_path / f"part{ending}")
    assert (found.units, found.units_from) == (unit, "file")
    assert mw.check(tmp_path / f"part{ending}", units=label).warnings == found.warnings
    assert size(found.size, found.units, found.units_from).endswith(f"; {unit} as the file says")


def packed(folder: Path, unit: str) -> Path:
    """A 3MF file of the barrel whose model has this unit, none if it is empty."""
    rows = "".join('<vertex x="{!r}" y="{!r}" z="{!r}"/>'.format(*map(float, point)) for point in POINTS)
    faces = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in TRIANGLES)
    named = f' unit="{unit}"' if unit else ""
    with zipfile.ZipFile(folder / "part.3mf", "w") as archive:
        archive.writestr(
            "3D/3dmodel.model",
            f'<model{named} xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02"><resources>'
            f'<object id="1"><mesh><vertices>{rows}</vertices><triangles>{faces}</triangles></mesh></object>'
            '</resources><build><item objectid="1"/></build></model>',
        )
    return folder / "part.3mf"


def test_who_named_the_unit_is_said(tmp_path: Path) -> None:
    trimesh.Trimesh(POINTS / 1000.0, TRIANGLES, process=False).export(tmp_path / "part.glb")
    (tmp_path / "part.stl").write_bytes(trimesh.Trimesh(POINTS, TRIANGLES, process=False).export(file_type="stl"))
    for path, words in (
        (packed(tmp_path, ""), "; mm, the default of 3MF"),
        (tmp_path / "part.glb", "; m, as glTF always is"),
        (tmp_path / "part.stl", "; mm assumed; see units"),
    ):
        found = mw.check(path)
        assert size(found.size, found.units, found.units_from).endswith(words)
        assert found.warnings == ()
    found = mw.check(packed(tmp_path, "inch"))
    assert size(found.size, found.units, found.units_from).endswith("; in as the file says")
    assert size((3.0, 2.0, 1.0), "", "unknown") == size((3.0, 2.0, 1.0), "", "") == "3 long, 2 x 1 across; unit unknown"


def test_a_unit_that_outranks_another_says_what_to_leave_out(tmp_path: Path) -> None:
    path = packed(tmp_path, "inch")
    assert mw.read(path, units="Inches").warnings == ()
    assert mw.read(path, units="mm").warnings == (
        "lengths are taken in 'mm', as given, though the file says 'in'; nothing is converted; "
        "leave units out for 'in'",
    )
    assert "in an unknown unit, as given, though the file says 'in'" in mw.read(path, units="").warnings[0]
    assert mw.read(packed(tmp_path, ""), units="cm").warnings == (
        "lengths are taken in 'cm', as given, though the file is in 'mm', the default of 3MF; nothing is converted",
    )


@pytest.mark.parametrize(("kind", "scale", "unit", "words"), [
    ("stl", 1e-3, None, "0.09 mm long, where mm is assumed; give units if"),
    ("stl", 0.99 / 90.0, None, "0.99 mm long"), ("stl", 1.01 / 90.0, None, ""),
    ("stl", 1e5 / 90.0, None, ""), ("stl", 1.1e5 / 90.0, None, "1.1e+05 mm long"),
    ("obj", 1e30, None, "9e+31 mm long"), ("stl", 1e-3, "mm", ""), ("stl", 1e-3, "m", ""),
    ("glb", 10.0, None, "900 m long, where m is the unit of glTF; give units"), ("glb", 1e-3, None, ""),
    ("glb", 1e-6, None, "9e-05 m long"), ("glb", 10.0, "mm", "though the file is in 'm', as glTF always is"),
])  # fmt: skip
def test_implausible_sizes(kind: str, scale: float, unit: str | None, words: str, tmp_path: Path) -> None:
    path = tmp_path / f"part.{kind}"
    if kind == "obj":
        rows = ["v {:.17g} {:.17g} {:.17g}".format(*(scale * point)) for point in POINTS]
        path.write_text("\n".join([*rows, *("f {} {} {}".format(*(np.array(face) + 1)) for face in TRIANGLES)]))
    else:
        trimesh.Trimesh(scale * POINTS, TRIANGLES, process=False).export(path)
    for warnings in (mw.check(path, units=unit).warnings, read_source(path, Options(units=unit)).mesh.warnings):
        assert len(warnings) == bool(words) and words in "".join(warnings)


def test_a_mesh_of_no_named_unit_is_not_doubted() -> None:
    assert Unit().doubt(1e-9) == Unit("mm", "given").doubt(1e-9) == Unit("mm", "file").doubt(1e-9) == ""
    assert mw.check(mw.read((1e-6 * POINTS, np.array(TRIANGLES)))).warnings == ()


@pytest.mark.parametrize("place", [0.0, 7.0])
def test_vertices_in_one_point(place: float, tmp_path: Path) -> None:
    content = "".join(f"v {place} {place} 0\n" for _ in range(3)) + "f 1 2 3\n"
    with pytest.raises(BadInputError, match="all its vertices are in one point"):
        mw.read(written(tmp_path, "part.obj", content.encode()))


@pytest.mark.parametrize("kept", [0.5, 0.9])
def test_a_3mf_file_that_is_cut_short(kept: float, tmp_path: Path) -> None:
    content = packed(tmp_path, "inch").read_bytes()
    path = written(tmp_path, "cut.3mf", content[: int(kept * len(content))])
    assert refusal(path) == "is cut short or damaged, as the end of its ZIP archive is missing; copy it again"


@pytest.mark.parametrize("content", [
    b'(1 "meshio 5.3.5")\n(2 3)\n', b'\n(0 "exported by a program")\n(2 3)\n', b"(2 3)\n(10 (0 1 b40 0))\n",
])  # fmt: skip
def test_meshes_of_other_programs_with_the_ending_of_gmsh(content: bytes, tmp_path: Path) -> None:
    assert refusal(written(tmp_path, "part.msh", content)).startswith(
        "is a mesh of Ansys (Fluent) by its content; write"
    )
    for other, words in ((b"MeshVersionFormatted 2\n", "a Medit"), (b"MESH dimension 3 ElemType Triangle\n", "a GiD")):
        assert refusal(written(tmp_path, "part.msh", other)).startswith(f"is {words} mesh by its content; ")


def test_the_ending_of_a_format_before_another(tmp_path: Path) -> None:
    content = trimesh.Trimesh(POINTS, TRIANGLES, process=False).export(file_type="stl")
    for name, words in (("b.STL.bak", "b.stl"), ("b.obj~", "b.stl"), ("b.v2.bak", "b.v2.stl"), ("b", "b.stl")):
        assert refusal(written(tmp_path, name, content)) == f"is an STL file by its content; rename it to {words}"


def test_the_home_of_the_user(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(tmp_path))
    monkeypatch.setenv("USERPROFILE", str(tmp_path))
    written(tmp_path, "part.stl", trimesh.Trimesh(POINTS, TRIANGLES, process=False).export(file_type="stl"))
    assert mw.read("~/part.stl").name == mw.check(Path("~/part.stl")).name == "part.stl"
    assert read_source("~/part.stl", Options()).file == tmp_path / "part.stl"
    with pytest.raises(BadInputError, match=r"^pat\.stl: file not found; did you mean part\.stl"):
        mw.read("~/pat.stl")
    with pytest.raises(BadInputError, match="file not found"):
        mw.read("~nobody-of-this-name/part.stl")
    here = tmp_path / "here"
    (here / "~").mkdir(parents=True)
    (here / "~" / "own.stl").write_bytes((tmp_path / "part.stl").read_bytes())
    monkeypatch.chdir(here)
    assert mw.read("~/own.stl").name == "own.stl"


def test_an_empty_path(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(BadInputError, match=r"^the path of the mesh is empty; give the path of a triangle mesh"):
        mw.read("")
    with pytest.raises(BadInputError, match=r"^\.: is a folder, as is an empty path; give the path"):
        mw.read(Path(""))  # as the command line gives it


@pytest.mark.parametrize("out", ["part.stl/x", "part.stl/x/y"])
def test_results_below_a_file(out: str, tmp_path: Path) -> None:
    path = written(tmp_path, "part.stl", trimesh.Trimesh(POINTS, TRIANGLES, process=False).export(file_type="stl"))
    with pytest.raises(BadInputError) as caught:
        mw.wind(path, out=tmp_path / out)
    assert str(caught.value) == f"cannot write to {tmp_path / out}: {path} is a file; give another folder"
