"""Files of CAD given to `check` and `wind`: true to the CAD surface, in its unit, and the word on what to install."""

import re
from codecs import BOM_UTF8
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from command import meshwind

import meshwind as mw
from meshwind.core import opencascade
from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import occ, quiet
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.io.read import load, read
from meshwind.workflow.notes import about_file

TURNED = 0.002
"""Relative error of areas from facets that turn by up to 8 degrees."""


@pytest.fixture
def cad() -> None:
    """For tests that make CAD files."""
    pytest.importorskip("OCP", reason="OpenCASCADE is missing: pip install 'meshwind[cad]'")


def axis(z: float = 0.0) -> Any:
    gp = occ("gp")
    return gp.gp_Ax2(gp.gp_Pnt(0.0, 0.0, z), gp.gp_Dir(0.0, 0.0, 1.0))


def cylinder(radius: float = 20.0, height: float = 120.0, z: float = 0.0) -> Any:
    return occ("BRepPrimAPI").BRepPrimAPI_MakeCylinder(axis(z), radius, height).Shape()


def frustum() -> Any:
    return occ("BRepPrimAPI").BRepPrimAPI_MakeCone(axis(), 30.0, 15.0, 120.0).Shape()


def pipe() -> Any:
    return occ("BRepAlgoAPI").BRepAlgoAPI_Cut(cylinder(), cylinder(17.0, 122.0, -1.0)).Shape()


def moved(shape: Any, x: float, mirror: bool = False) -> Any:
    gp = occ("gp")
    move = gp.gp_Trsf()
    if mirror:
        move.SetMirror(axis())
    else:
        move.SetTranslation(gp.gp_Vec(x, 0.0, 0.0))
    if mirror:
        return occ("BRepBuilderAPI").BRepBuilderAPI_Transform(shape, move, True).Shape()
    return shape.Moved(occ("TopLoc").TopLoc_Location(move))


def together(*shapes: Any) -> Any:
    builder, held = occ("BRep").BRep_Builder(), occ("TopoDS").TopoDS_Compound()
    builder.MakeCompound(held)
    for shape in shapes:
        builder.Add(held, shape)
    return held


def save(path: Path, shape: Any, unit: str = "MM") -> Path:
    """Write a shape whose lengths are mm; the file may state them in another unit."""
    with quiet():
        if path.suffix in (".igs", ".iges"):
            writer = occ("IGESControl").IGESControl_Writer(unit, 0)
            writer.AddShape(shape)
            writer.Write(str(path))
        else:
            occ("Interface").Interface_Static.SetCVal_s("write.step.unit", unit)
            writer = occ("STEPControl").STEPControl_Writer()
            writer.Transfer(shape, occ("STEPControl").STEPControl_StepModelType.STEPControl_AsIs)
            writer.Write(str(path))
            occ("Interface").Interface_Static.SetCVal_s("write.step.unit", "MM")
    return path


PARTS: dict[str, tuple[Callable[[], Any], float, float]] = {
    "cylinder": (cylinder, 2 * np.pi * 20 * 120 + 2 * np.pi * 20**2, np.pi * 20**2 * 120),
    "frustum": (
        frustum,
        np.pi * 45 * np.hypot(15, 120) + np.pi * (30**2 + 15**2),
        np.pi * 120 / 3 * (30**2 + 30 * 15 + 15**2),
    ),
    "pipe": (pipe, 2 * np.pi * 37 * 120 + 2 * np.pi * (20**2 - 17**2), np.pi * (20**2 - 17**2) * 120),
    "mirrored": (
        lambda: moved(frustum(), 0.0, mirror=True),
        np.pi * 45 * np.hypot(15, 120) + np.pi * (30**2 + 15**2),
        np.pi * 120 / 3 * (30**2 + 30 * 15 + 15**2),
    ),
}
"""Shape, exact area and exact volume."""


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("suffix", [".step", ".stp", ".iges", ".igs"])
@pytest.mark.usefixtures("cad")
def test_parts_have_their_area_and_volume(name: str, suffix: str, tmp_path: Path) -> None:
    make, area, inside = PARTS[name]
    path = save(tmp_path / f"part{suffix}", make())
    held = load(path)
    assert held.units == "mm"
    assert held.warnings == ()
    assert areas(held.vertices, held.faces).sum() == pytest.approx(area, rel=TURNED)
    if suffix not in (".igs", ".iges"):  # which hold surfaces without sides
        a, b, c = (held.vertices[held.faces[:, k]] for k in range(3))
        assert (a * np.cross(b, c)).sum() / 6.0 == pytest.approx(inside, rel=3 * TURNED)
    mesh = read(path)
    assert abs(volume(mesh.vertices, mesh.faces)) == pytest.approx(inside, rel=3 * TURNED)
    assert mesh.warnings == ()


@pytest.mark.usefixtures("cad")
def test_vertices_are_on_the_surface_and_facets_near(tmp_path: Path) -> None:
    mesh = read(save(tmp_path / "part.step", cylinder()))
    radius = np.linalg.norm(mesh.vertices[:, :2], axis=1)
    assert radius == pytest.approx(20.0, abs=1e-9)
    corner = mesh.vertices[mesh.faces]
    flank = np.ptp(corner[:, :, 2], axis=1) > 1.0
    middles = np.linalg.norm(0.5 * (corner + np.roll(corner, 1, axis=1))[flank][:, :, :2], axis=2)
    assert middles.min() > 20.0 - 1.1e-4 * mesh.diagonal


NAMED = {"INCH": "in", "M": "m", "CM": "cm", "FT": "ft", "KM": "kilometre"}


@pytest.mark.parametrize("unit", NAMED)
@pytest.mark.usefixtures("cad")
def test_other_units_come_in_millimetres(unit: str, tmp_path: Path) -> None:
    path = save(tmp_path / "part.step", cylinder(), unit)
    assert ("CONVERSION_BASED_UNIT" in path.read_text()) == (unit in ("INCH", "FT"))
    held = load(path)
    assert np.ptp(held.vertices, axis=0) == pytest.approx([40.0, 40.0, 120.0], rel=1e-3)
    assert (held.units, held.units_from) == ("mm", f"converted from {NAMED[unit]}")


@pytest.mark.parametrize(("unit", "named"), [("IN", "in"), ("M", "m"), ("FT", "ft"), ("UM", "um"), ("CM", "cm")])
@pytest.mark.usefixtures("cad")
def test_the_unit_of_an_iges_file(unit: str, named: str, tmp_path: Path) -> None:
    held = load(save(tmp_path / "part.igs", cylinder(), unit))
    assert (held.units, held.units_from) == ("mm", f"converted from {named}")
    assert np.ptp(held.vertices, axis=0) == pytest.approx([40.0, 40.0, 120.0], rel=1e-3)


@pytest.mark.parametrize(("name", "unit"), [("part.step", "INCH"), ("part.igs", "M")])
@pytest.mark.usefixtures("cad")
def test_the_converted_unit_is_said_and_not_to_be_changed(name: str, unit: str, tmp_path: Path) -> None:
    path = save(tmp_path / name, cylinder(), unit)
    for mesh in (path, read(path)):
        assert mw.check(mesh).units_from == f"converted from {unit.lower()[:2]}"
    assert read(path, units="MM").warnings == ()
    for words in ("in", "meters"):
        with pytest.raises(BadInputError, match=r"but the lengths of the file are 'mm', 'converted from .*; leave un"):
            mw.check(path, units=words)
        with pytest.raises(BadInputError, match="leave units out"):
            read(path).in_units(words)


@pytest.mark.usefixtures("cad")
def test_a_file_that_names_millimetres_or_no_unit(tmp_path: Path) -> None:
    path = save(tmp_path / "part.step", cylinder())
    assert (load(path).units, load(path).units_from) == ("mm", "file")
    text = path.read_text()
    context = re.search(r"GLOBAL_UNIT_ASSIGNED_CONTEXT\s*\(\(#\d+,", text)
    assert context is not None
    path.write_text(text.replace(context[0], "GLOBAL_UNIT_ASSIGNED_CONTEXT(("))
    found = read(path)
    assert found.units == "" and found.size[2] == pytest.approx(120.0)
    assert read(path, units="in").units == "in"


@pytest.mark.usefixtures("cad")
def test_a_byte_order_mark_is_no_obstacle(tmp_path: Path) -> None:
    for name in ("part.step", "part.igs"):
        path = save(tmp_path / name, cylinder())
        before = load(path)
        path.write_bytes(BOM_UTF8 + path.read_bytes())
        assert np.array_equal(load(path).vertices, before.vertices)
        assert load(path).warnings == before.warnings == ()


@pytest.mark.parametrize("kept", [0.1, 0.5, 0.9, 0.999])
@pytest.mark.usefixtures("cad")
def test_files_that_are_cut_short_are_named_so(kept: float, tmp_path: Path) -> None:
    path = save(tmp_path / "part.step", frustum())
    path.write_bytes(path.read_bytes()[: int(kept * path.stat().st_size)])
    with pytest.raises(BadInputError, match=r"part\.step: is cut short, as its end \(END-ISO-10303-21\) is missing"):
        read(path)


@pytest.mark.usefixtures("cad")
def test_an_iges_file_without_its_last_lines(tmp_path: Path) -> None:
    path = save(tmp_path / "part.igs", frustum())
    lines = path.read_text().splitlines(keepends=True)
    for lost in (2, 10, len(lines) // 2, len(lines) - 12):
        path.write_text("".join(lines[:-lost]))
        with pytest.raises(BadInputError, match=r"part\.igs: is cut short, as \d+ of \d+ lines of its parameter sec"):
            read(path)
    path.write_text("".join(lines[:-1]))
    assert read(path).warnings == ("its last line, which counts the others, is missing; it may be cut short",)
    path.write_text("".join(lines).replace("S      1G", "S      2G"))
    assert read(path).warnings == ("1 of 2 lines of its section S are there; it may be cut short",)


@pytest.mark.usefixtures("cad")
def test_how_cad_is_cut_is_noted(tmp_path: Path) -> None:
    path = save(tmp_path / "part.step", frustum())
    note = "its 3 CAD faces are cut into triangles within 1e-4 of the diagonal of each solid"
    assert read(path).notes == mw.check(path).notes[:1] == (note,)
    assert mw.check(read(path)).notes[:1] == (note,)
    assert str(about_file(read(path))[0]) == note
    assert read(save(tmp_path / "part.igs", frustum())).notes == (note.replace("each solid", "all of them"),)


@pytest.mark.usefixtures("cad")
def test_a_part_of_an_assembly_is_cut_as_finely_as_alone(tmp_path: Path) -> None:
    round_part = occ("BRepPrimAPI").BRepPrimAPI_MakeTorus(axis(), 20.0, 6.0).Shape()
    alone = load(save(tmp_path / "part.step", round_part))
    far = occ("BRepPrimAPI").BRepPrimAPI_MakeBox(occ("gp").gp_Pnt(500.0, 0.0, 0.0), 900.0, 900.0, 900.0).Shape()
    both = load(save(tmp_path / "both.step", together(round_part, far)))
    assert len(both.faces) == len(alone.faces) + 12
    small = [moved(cylinder(1.0, 2.0 + number), 1500.0 + 10.0 * number) for number in range(20)]
    many = load(save(tmp_path / "many.step", together(far, *small, round_part)))
    part = many.faces[(np.abs(many.vertices[many.faces][:, :, 0]) < 30.0).all(axis=1)]
    assert len(part) == len(alone.faces)
    assert many.notes[0].endswith("of each of the 20 largest solids, and of all of them for the others")


@pytest.mark.usefixtures("cad")
def test_an_assembly_has_pieces_in_their_places(tmp_path: Path) -> None:
    one = cylinder(10.0, 60.0)
    path = save(tmp_path / "part.step", together(frustum(), moved(one, 200.0), moved(one, 300.0)))
    found = mw.check(path)
    assert found.piece_count == 3 and found.units == "mm"
    boss = read(path, component=2)
    centre = boss.vertices.mean(axis=0)[0]
    assert min(abs(centre - 200.0), abs(centre - 300.0)) < 0.5


@pytest.mark.usefixtures("cad")
def test_a_smooth_part_is_fitted_as_well_as_its_mesh_allows(tmp_path: Path) -> None:
    opened = mw.annulus(read(save(tmp_path / "pipe.step", pipe())))
    assert opened.wall is not None and opened.wall.thickness == pytest.approx(3.0, rel=0.02)
    error = mw.fit(mw.flatten(opened)).error
    assert error is not None and error.to_surface_max < 2e-5 * error.diagonal


@pytest.mark.parametrize(("name", "text", "says"), [
    ("bad.step", "no step", "bad.step: OpenCASCADE cannot read it; export it again from CAD"),
    ("bad.igs", "no iges", "bad.igs: holds no CAD faces"),
    ("cut.step", "ISO-10303-21; HEADER;", "cut.step: is cut short, as its end (END-ISO-10303-21) is missing"),
    ("none.igs", None, "none.igs: file not found; give the path of a triangle mesh"),
])  # fmt: skip
@pytest.mark.usefixtures("cad")
def test_bad_files_are_refused_in_one_line(name: str, text: str | None, says: str, tmp_path: Path) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(BadInputError) as caught:
        read(tmp_path / name)
    assert says in str(caught.value) and "\n" not in str(caught.value)


@pytest.mark.usefixtures("cad")
def test_a_file_without_faces_is_refused(tmp_path: Path) -> None:
    gp = occ("gp")
    line = occ("BRepBuilderAPI").BRepBuilderAPI_MakeEdge(gp.gp_Pnt(0.0, 0.0, 0.0), gp.gp_Pnt(0.0, 0.0, 9.0)).Edge()
    with pytest.raises(BadInputError, match="holds no CAD faces; export the whole part into one file"):
        read(save(tmp_path / "part.step", line))


@pytest.mark.parametrize("suffix", [".step", ".IGS"])
def test_without_opencascade_the_extra_is_named(suffix: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / f"part{suffix}").write_text("ISO-10303-21;")
    monkeypatch.setattr(opencascade, "find_spec", lambda _: None)
    with pytest.raises(BadInputError) as caught:
        read(tmp_path / f"part{suffix}")
    assert str(caught.value) == (
        f"part{suffix}: STEP and IGES need OpenCASCADE; install it with: pip install 'meshwind[cad]'"
    )


@pytest.mark.usefixtures("cad")
def test_check_takes_a_step_file(tmp_path: Path) -> None:
    save(tmp_path / "part.step", pipe(), "INCH")
    done = meshwind("check", "part.step", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
    assert "can be opened and wound" in done.stdout and "120 mm" in done.stdout
