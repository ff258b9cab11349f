"""STEP there and back: the surface, the curves, and what comes from CAD."""

import sys
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from export_results import plain_results, waisted_results

from meshwind import read_cad
from meshwind.core import opencascade
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import occ
from meshwind.core.version import version
from meshwind.exporting.splines import clamped_surface
from meshwind.exporting.step import write_step
from meshwind.results.reading import Results
from meshwind.results.schema import STEP
from meshwind.surface import shapes

pytest.importorskip("OCP", reason="OpenCASCADE is missing: pip install 'meshwind[cad]'")


def shape_of(path: Path) -> Any:
    reader = occ("STEPControl").STEPControl_Reader()
    with opencascade.quiet():
        reader.ReadFile(str(path))
        reader.TransferRoots()
        return reader.OneShape()


def parts(shape: Any, kind: str) -> list[Any]:
    """The faces, or the edges that are of no face."""
    kinds = occ("TopAbs").TopAbs_ShapeEnum
    avoid = kinds.TopAbs_FACE if kind == "EDGE" else kinds.TopAbs_SHAPE
    explorer = occ("TopExp").TopExp_Explorer(shape, getattr(kinds, f"TopAbs_{kind}"), avoid)
    found = []
    while explorer.More():
        found.append(getattr(occ("TopoDS").TopoDS, kind.title())(explorer.Current()))
        explorer.Next()
    return found


@pytest.fixture(scope="module", params=["plain", "waisted"])
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Results, Any]:
    out = tmp_path_factory.mktemp(request.param)
    results = (plain_results if request.param == "plain" else waisted_results)(out)
    assert write_step(out, results) == []
    return results, shape_of(out / STEP)


def test_the_header_names_part_day_and_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    before = datetime.now(UTC)
    write_step(tmp_path, plain_results(tmp_path))
    text = (tmp_path / STEP).read_text(encoding="ascii")
    header = "".join(text.split("ENDSEC;")[0].split())
    days = {f"{day:%Y-%m-%d}T00:00:00" for day in (before, datetime.now(UTC))}
    assert any(f"FILE_NAME('part.stl','{day}'" in header for day in days)
    assert f"meshwind{version()}" in header and "CASCADE" not in header
    assert "PRODUCT('part.stl'" in text
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    write_step(tmp_path, plain_results(tmp_path))
    assert "1970-01-02T00:00:00" in (tmp_path / STEP).read_text(encoding="ascii")


def xyz(points: list[Any]) -> Floats:
    return np.array([[point.X(), point.Y(), point.Z()] for point in points])


def test_the_surface_comes_back(written: tuple[Results, Any]) -> None:
    results, shape = written
    (face,) = parts(shape, "FACE")
    surface = occ("BRep").BRep_Tool.Surface_s(face)
    assert type(surface).__name__ == "Geom_BSplineSurface"
    assert surface.IsUClosed()
    assert not surface.IsVClosed()
    assert occ("BRepCheck").BRepCheck_Analyzer(face).IsValid()
    uv = np.random.default_rng(1).random((500, 2))
    assert surface.Bounds() == pytest.approx((0.0, 1.0, 0.0, 1.0), abs=1e-12)
    read = xyz([surface.Value(u, v) for u, v in uv.tolist()])
    assert np.abs(read - results.surface.points(uv)).max() < 1e-9 * results.diagonal


def test_the_fibres_come_back(written: tuple[Results, Any]) -> None:
    results, shape = written
    edges = parts(shape, "EDGE")
    assert len(edges) == len(results.paths)
    for points, edge in zip(results.paths.points, edges, strict=True):
        curve = occ("BRep").BRep_Tool.Curve_s(edge, 0.0, 1.0)
        first, last = curve.FirstParameter(), curve.LastParameter()
        arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
        assert (first, last) == pytest.approx((0.0, arc[-1]), abs=1e-9)
        read = xyz([curve.Value(min(at, last)) for at in arc.tolist()])
        assert np.abs(read - points).max() < 1e-9 * results.diagonal


def test_clamping_changes_nothing() -> None:
    surface = shapes.elbow(3.0, 1.0)
    poles, knots_u, knots_v = clamped_surface(surface)
    assert (knots_u[:4] == knots_u[0]).all()
    assert (knots_v[-4:] == knots_v[-1]).all()
    ends = [0, -1]
    corners = surface.points(np.array([(0.0, 0.0), (0.0, 1.0)]))
    assert np.abs(poles[0, ends] - corners).max() < 1e-14 * surface.size * 10
    assert np.array_equal(poles[0], poles[-1])


def test_metres_become_millimetres(tmp_path: Path) -> None:
    results = plain_results(tmp_path, "m")
    write_step(tmp_path, results)
    (face,) = parts(shape_of(tmp_path / STEP), "FACE")
    point = occ("BRep").BRep_Tool.Surface_s(face).Value(0.3, 1.0)
    assert xyz([point])[0] == pytest.approx(1000.0 * results.surface.points([(0.3, 1.0)])[0], abs=1e-6)


def test_our_own_file_comes_in_as_the_surface(tmp_path: Path) -> None:
    results = waisted_results(tmp_path)
    write_step(tmp_path, results)
    (surface,) = read_cad(tmp_path / STEP)
    uv = np.random.default_rng(2).random((400, 2))
    x, y, z = surface.points(uv).T
    radius = 1.0 - 0.35 * np.exp(-(((z / 4.0 - 0.5) / 0.16) ** 2))
    assert np.abs(np.hypot(x, y) - radius).max() < 1e-4
    assert np.abs(surface.points([(0.0, 0.0), (0.0, 1.0)])[:, 2] - [0.0, 4.0]).max() < 1e-9
    assert surface.error is not None
    assert surface.error.relative_max < 1e-6


def cone_and_friends() -> dict[str, tuple[Any, int]]:
    """CAD's own shapes, and how many of their faces close in one direction."""
    made = occ("BRepPrimAPI")
    return {
        "cylinder": (made.BRepPrimAPI_MakeCylinder(10.0, 30.0).Shape(), 1),
        "cone": (made.BRepPrimAPI_MakeCone(10.0, 4.0, 30.0).Shape(), 1),
        "bend": (made.BRepPrimAPI_MakeTorus(30.0, 5.0, 1.5).Shape(), 1),
        "box": (made.BRepPrimAPI_MakeBox(1.0, 2.0, 3.0).Shape(), 0),
        "torus": (made.BRepPrimAPI_MakeTorus(30.0, 5.0).Shape(), 0),
        "sphere": (made.BRepPrimAPI_MakeSphere(5.0).Shape(), 0),
        "half pipe": (made.BRepPrimAPI_MakeCylinder(10.0, 30.0, 3.0).Shape(), 0),
    }


def save(path: Path, shape: Any) -> None:
    with opencascade.quiet():
        if path.suffix == ".step":
            writer = occ("STEPControl").STEPControl_Writer()
            writer.Transfer(shape, occ("STEPControl").STEPControl_StepModelType.STEPControl_AsIs)
            writer.Write(str(path))
        else:
            writer = occ("IGESControl").IGESControl_Writer("MM", 1)
            writer.AddShape(shape)
            writer.Write(str(path))


@pytest.mark.parametrize("suffix", [".step", ".igs"])
@pytest.mark.parametrize("name", ["cylinder", "cone", "bend", "box", "torus", "sphere", "half pipe"])
def test_faces_that_close_in_one_direction_come_in(tmp_path: Path, name: str, suffix: str) -> None:
    shape, count = cone_and_friends()[name]
    file = tmp_path / f"part{suffix}"
    save(file, shape)
    if not count:
        with pytest.raises(BadInputError, match="no surface that closes in one direction"):
            read_cad(file)
        return
    (surface,) = read_cad(file)
    uv = np.random.default_rng(3).random((300, 2))
    points, normals = surface.points(uv), surface.normals(uv)
    x, y, z = points.T
    if name == "bend":
        ring = np.stack([x, y, np.zeros_like(x)], 1) * (30.0 / np.hypot(x, y))[:, None]
        assert np.abs(np.linalg.norm(points - ring, axis=1) - 5.0).max() < 1e-4
        outward = points - ring
    else:
        radius = 10.0 - (0.2 * z if name == "cone" else 0.0 * z)
        assert np.abs(np.hypot(x, y) - radius).max() < 1e-5
        outward = np.stack([x, y, np.zeros_like(x)], 1)
    assert ((normals * outward).sum(axis=1) > 0.0).all()


def test_a_cut_face_is_refused(tmp_path: Path) -> None:
    """A cylinder with a hole across: its patch closes, the face does not fill it."""
    made, gp = occ("BRepPrimAPI"), occ("gp")
    axis = gp.gp_Ax2(gp.gp_Pnt(-20.0, 0.0, 15.0), gp.gp_Dir(1.0, 0.0, 0.0))
    hole = made.BRepPrimAPI_MakeCylinder(axis, 3.0, 40.0).Shape()
    cut = occ("BRepAlgoAPI").BRepAlgoAPI_Cut(made.BRepPrimAPI_MakeCylinder(10.0, 30.0).Shape(), hole).Shape()
    save(tmp_path / "part.step", cut)
    with pytest.raises(BadInputError, match="cut by more than its two rims"):
        read_cad(tmp_path / "part.step")


@pytest.mark.parametrize(("name", "text", "says"), [("part.stl", "", "neither STEP nor IGES"),
                         ("none.step", None, "not found"), ("bad.step", "no step", "cannot read")])  # fmt: skip
def test_bad_files_are_reported(tmp_path: Path, name: str, text: str | None, says: str) -> None:
    if text is not None:
        (tmp_path / name).write_text(text)
    with pytest.raises(BadInputError, match=says):
        read_cad(tmp_path / name)


def test_without_opencascade_one_line_says_what_to_install(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    results = plain_results(tmp_path)
    monkeypatch.setattr(sys, "path", [])
    for module in [name for name in sys.modules if name.split(".")[0] == "OCP"]:
        monkeypatch.delitem(sys.modules, module)
    with pytest.raises(BadInputError, match=r"pip install 'meshwind\[cad\]'"):
        write_step(tmp_path, results)
    assert not (tmp_path / STEP).exists()
