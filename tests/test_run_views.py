"""A result in PyVista, trimesh, meshio, pandas and a notebook, and read back from its folder."""

import io
import os
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pandas as pd
import pytest
import pyvista as pv
import trimesh
from PIL import Image

import meshwind as mw
from meshwind.core import table
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block
from meshwind.pictures.picture import Picture
from meshwind.results.report import plain
from meshwind.run.views import blocks

DATA = Path(__file__).parents[1] / "data"
KINDS = ["plain", "continuous", "layers"]


@pytest.fixture(scope="module", params=KINDS)
def both(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[mw.Result, mw.LoadedResult]:
    """A result, and the same read from its folder; `plain` bridges."""
    out = tmp_path_factory.mktemp("run")
    (out / "layers.toml").write_text(
        '[[layer]]\nkind = "helical"\npaths = 5\nrevolutions = 0.4\nband_width = 5.0\nband_thickness = 0.2\n'
        '[[layer]]\nkind = "hoop"\nband_width = 5.0\nband_thickness = 0.2\n'
    )
    options: dict[str, dict[str, Any]] = {
        "plain": {"mesh": DATA / "vase.stl", "paths": 4, "revolutions": 0.8, "friction": 0.1},
        "continuous": {"mesh": DATA / "tank.ply", "paths": 5, "revolutions": 0.3, "continuous": True, "friction": 0.3},
        "layers": {"mesh": DATA / "tank.ply", "layers": out / "layers.toml"},
    }
    result = mw.wind(particles=51, out=out / "out", render=False, **options[request.param])
    return result, mw.load(out / "out")


def equal(one: Any, other: Any) -> None:
    """Two records have the same arrays and values."""
    for each in fields(one):
        mine, its = getattr(one, each.name), getattr(other, each.name)
        if isinstance(mine, np.ndarray):
            assert mine.dtype == its.dtype and np.array_equal(mine, its, equal_nan=mine.dtype.kind == "f"), each.name
        elif isinstance(mine, str | int | float | tuple | None.__class__):
            assert mine == its, each.name


def test_a_folder_gives_the_result_back(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    result, loaded = both
    equal(result.paths, loaded.paths)
    equal(result.surface, loaded.surface)
    assert result.surface.error == loaded.surface.error
    for name in ("crossings", "quads", "coverage"):
        equal(getattr(result.layup, name), getattr(loaded.layup, name))
    assert len(result.filaments) == len(loaded.filaments)
    for mine, its in zip(result.filaments, loaded.filaments, strict=True):
        assert np.array_equal(mine.course.points, its.course.points)
        assert mine.course.angle == pytest.approx(its.course.angle, rel=1e-15)  # degrees in the file
        assert np.array_equal(mine.course.kind, its.course.kind)
    assert loaded.report() == plain(result.report())
    assert [str(note) for note in loaded.notes] == [str(note) for note in result.notes]
    assert loaded.options == (result.options if result.layered is None else result.layered.options)
    assert (loaded.name, loaded.units, loaded.settled) == (result.name, result.units, result.settled)
    assert loaded.revolutions == result.revolutions
    assert set(loaded.maps) == set(result.maps)
    for field, values in result.maps.items():
        assert np.array_equal(loaded.maps[field], values, equal_nan=True), field


def test_pyvista_has_all_that_is_there(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    result, loaded = both
    seen, same = result.to_pyvista(), loaded.to_pyvista()
    wanted = {"part", "fibres", "crossings", "quads"} | ({"filament"} if result.filaments else set())
    assert wanted <= set(seen.keys()) <= wanted | {"bridges"}
    assert seen.keys() == same.keys()
    assert np.array_equal(seen["fibres"].points, result.paths.points.reshape(-1, 3))
    assert seen["fibres"].n_lines == len(result.paths)
    assert np.array_equal(seen["fibres"]["family"], result.paths.family)
    assert {"coverage", "windability", "angle", "fit_error"} <= set(seen["part"].point_data)
    assert seen["part"].field_data["units"].tolist() == ["mm"]
    for name in seen.keys():  # noqa: SIM118 (a MultiBlock has no `in` over names)
        assert np.array_equal(seen[name].points, same[name].points), name
        for field in seen[name].point_data:
            exact = name != "filament" or field != "angle"  # the file has degrees
            mine, its = seen[name].point_data[field], same[name].point_data[field]
            assert np.allclose(mine, its, rtol=0.0 if exact else 1e-15, atol=0.0, equal_nan=True), field


def test_blocks_are_what_the_files_hold(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    result, loaded = both
    seen = result.to_pyvista()
    files = {"fibres": "paths.vtp", "bridges": "bridges.vtp", "crossings": "crossings.vtp", "filament": "filament.vtp",
             "quads": "quads.vtu", "part": "surface.vtu"}  # fmt: skip
    for name in seen.keys():  # noqa: SIM118
        held: Any = pv.read(loaded.folder / files[name])
        assert np.array_equal(held.points, seen[name].points), name
        assert held.n_cells == seen[name].n_cells
        assert set(held.point_data) == set(seen[name].point_data)
        assert set(held.cell_data) == set(seen[name].cell_data)
        for field in held.cell_data:
            assert np.array_equal(held.cell_data[field], seen[name].cell_data[field]), field


def test_trimesh_and_meshio_take_it(both: tuple[mw.Result, mw.LoadedResult], tmp_path: Path) -> None:
    result = both[0]
    scene = result.to_trimesh()
    part, fibres = scene.geometry["part"], scene.geometry["fibres"]
    assert isinstance(part, trimesh.Trimesh) and part.is_winding_consistent
    assert part.volume > 0.0  # outwards
    assert part.vertex_attributes["coverage"].shape == (len(part.vertices),)
    length = float(np.linalg.norm(np.diff(result.paths.points, axis=1), axis=2).sum())
    assert fibres.length == pytest.approx(length, rel=1e-12)
    meshes = result.to_meshio()
    assert set(meshes) == set(scene.geometry) == set(result.to_pyvista().keys())
    meshes["fibres"].write(tmp_path / "fibres.vtu")
    read = meshio.read(tmp_path / "fibres.vtu")
    assert np.array_equal(read.points, result.paths.points.reshape(-1, 3))
    assert np.array_equal(read.cell_data["path"][0], np.repeat(np.arange(len(result.paths)), 50))


def test_pandas_takes_it(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    result, loaded = both
    paths = result.to_dataframe()
    pd.testing.assert_frame_equal(paths, loaded.to_dataframe())
    assert paths["outcome"].tolist() == [path.status.name.lower() for path in result.paths]
    assert paths["fibre_length"].tolist() == [path.length for path in result.paths]
    points = result.to_dataframe("points")
    assert np.array_equal(points[["x", "y", "z"]].to_numpy(), result.paths.points.reshape(-1, 3))
    stations = result.to_dataframe("stations")
    assert stations["angle_median"].tolist() == [each["angle"]["median"] for each in result.report()["angle_stations"]]
    assert len(result.to_dataframe("crossings")) == len(result.layup.crossings)
    assert len(result.to_dataframe("bridges")) == len(blocks(result).get("bridges", Block(np.zeros((0, 3)))).starts) - 1
    if result.filaments:
        assert len(result.to_dataframe("filament")) == sum(len(each.course) for each in result.filaments)
    if result.layered is not None:
        assert result.to_dataframe("layers")["kind"].tolist() == ["helical", "hoop"]
    for of in (
        {"filament", "layers"}
        - ({"filament"} if result.filaments else set())
        - ({"layers"} if result.layered is not None else set())
    ):
        with pytest.raises(mw.BadInputError, match=f"continuous|no {of}"):
            result.to_dataframe(of)
    with pytest.raises(mw.BadInputError, match="of is 'path'; give paths, points"):
        result.to_dataframe("path")


def test_without_pandas_the_error_says_what_to_install(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(mw.BadInputError, match='pip install "meshwind\\[pandas\\]"'):
        table.data_frame({"a": np.zeros(3)})


def test_a_traced_fibre_goes_to_other_libraries() -> None:
    fibre = mw.trace(mw.shapes.torus(3.0, 1.0), (0.05, 0.1), 0.7, 2.0, step=0.01)
    seen = fibre.to_pyvista()
    assert seen.n_cells == 1 and np.array_equal(seen.points, fibre.points)
    assert np.array_equal(seen.point_data["geodesic_curvature"], fibre.geodesic_curvature)
    assert seen.cell_data["stop"].tolist() == [mw.Stop.LENGTH]
    assert fibre.to_trimesh().length == pytest.approx(2.0, rel=1e-4)
    assert len(fibre.to_meshio().cells_dict["line"]) == len(fibre) - 1


def test_paths_are_a_sequence(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    paths = both[0].paths
    assert [path.number for path in paths] == list(range(len(paths)))
    assert paths[-1].number == len(paths) - 1
    assert np.array_equal(paths[1].points, paths.points[1])
    assert [len(paths[1:3]), len(paths[paths.family > 0]), len(paths[np.array([0, 2])])] == [
        2, int((paths.family > 0).sum()), 2,
    ]  # fmt: skip
    assert np.array_equal(paths[1:3].points, paths.points[1:3])
    with pytest.raises(IndexError):
        _ = paths[len(paths)]
    one = paths[2].to_pyvista()
    assert one.n_lines == 1 and one["path"].tolist() == [2]


def test_a_program_is_planned_from_python(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    result, loaded = both
    if not result.filaments:
        with pytest.raises(mw.BadInputError, match="continuous=True"):
            result.program()
        return
    program, same = result.program("lathe-3", tension=2.0), loaded.program("lathe-3", tension=2.0)
    rows = program.to_dataframe()
    assert len(rows) == len(program.blocks) == program.to_pyvista().n_points
    assert rows["tension"].max() == 2.0
    assert np.allclose(rows["mandrel_deg"], same.to_dataframe()["mandrel_deg"], rtol=0.0, atol=1e-9)


@pytest.mark.usefixtures("opengl")
def test_a_notebook_shows_picture_and_figures(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    for each in both:
        shown = each._repr_html_()
        assert 'src="data:image/png;base64,' in shown and "<th" in shown
        assert f"{each.name}: " in shown and f"{len(each.paths)} at rest" in shown


def test_without_graphics_a_notebook_shows_the_figures(
    both: tuple[mw.Result, mw.LoadedResult], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("meshwind.pictures.driver.paint", lambda *_: "no picture: <no driver>")
    shown = both[1]._repr_html_()
    assert "no picture: &lt;no driver&gt;" in shown and "at rest" in shown


@pytest.mark.usefixtures("opengl")
def test_plot_gives_a_picture(both: tuple[mw.Result, mw.LoadedResult], tmp_path: Path) -> None:
    page = mw.Page(320, 240)
    seen = [each.plot("coverage", page=page, interactive=False) for each in both]
    assert seen[0] is not None and seen[1] is not None
    assert np.array_equal(np.asarray(seen[0].image), np.asarray(seen[1].image))
    assert seen[0].image.size == (320, 240)
    assert seen[0]._repr_png_()[:4] == b"\x89PNG"
    both[1].plot(page=page, file=tmp_path / "drawn.png")
    assert (tmp_path / "drawn.png").read_bytes()[:4] == b"\x89PNG"
    with pytest.raises(mw.BadInputError, match="not known; give winding"):
        both[1].plot("nothing", interactive=False)


@pytest.mark.usefixtures("opengl")
def test_a_window_shows_part_and_fibres(both: tuple[mw.Result, mw.LoadedResult]) -> None:
    """In a process of its own, off the screen, as a window would."""
    script = (
        "import sys, numpy as np, meshwind as mw\n"
        "from meshwind.pictures.screen import window\n"
        "from meshwind.run.views import blocks\n"
        "opened = window(blocks(mw.load(sys.argv[1])), 'tank', off_screen=True, window_size=[300, 300])\n"
        "image = opened.screenshot(return_img=True)\n"
        "print(sorted(opened.actors), len(np.unique(image.reshape(-1, 3), axis=0)) > 100)\n"
    )
    environment = os.environ | {"VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow"}
    done = subprocess.run(
        [sys.executable, "-c", script, str(both[1].folder)], capture_output=True, text=True, env=environment, check=True
    )
    assert "'fibres', 'part'" in done.stdout and done.stdout.endswith("True\n")


def test_a_window_opens_only_where_there_is_a_screen(
    both: tuple[mw.Result, mw.LoadedResult], monkeypatch: pytest.MonkeyPatch
) -> None:
    opened: list[str] = []
    monkeypatch.setattr("meshwind.run.views.show", lambda _blocks, title: opened.append(title))
    monkeypatch.setattr(sys, "platform", "linux")
    monkeypatch.setenv("DISPLAY", ":0")
    assert both[1].plot() is None and opened == [both[1].name]
    monkeypatch.delenv("DISPLAY")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setattr(
        "meshwind.pictures.render.render", lambda *_, **__: (_ for _ in ()).throw(mw.BadInputError("drawn"))
    )
    with pytest.raises(mw.BadInputError, match="drawn"):
        both[1].plot()


@pytest.mark.parametrize(
    ("ending", "kind"), [(".png", "PNG"), ("", "PNG"), (".JPG", "JPEG"), (".bmp", "BMP"), (".webp", "WEBP")]
)
def test_a_picture_is_saved_as_its_name_says(ending: str, kind: str, tmp_path: Path) -> None:
    held = io.BytesIO()
    Image.new("RGBA", (8, 6), (255, 0, 0, 0)).save(held, "PNG")
    Picture(held.getvalue()).save(tmp_path / f"part{ending}")
    with Image.open(tmp_path / f"part{ending}") as saved:
        assert saved.format == kind and saved.size == (8, 6)
        if ending not in (".png", ""):
            assert saved.convert("RGB").getpixel((3, 3)) == (255, 255, 255)


def test_an_ending_that_no_picture_has_is_refused(tmp_path: Path) -> None:
    for name in ("part.xyz", "part.stl"):
        with pytest.raises(BadInputError, match=f"{name}: no pictures end with .*; give a name with .png"):
            Picture(b"").save(tmp_path / name)
        assert not (tmp_path / name).exists()
