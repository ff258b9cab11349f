"""The picture: drawn where there is a driver, explained where there is none."""

import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from layup_shapes import bridged, cylinder, helices, waisted
from PIL import Image

from meshwind.appearance.view import best_view
from meshwind.appearance.words import quantity
from meshwind.layup.layup import assess
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.lengths import bridges
from meshwind.pictures import driver
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.page import Page
from meshwind.pictures.painter import painter
from meshwind.pictures.subject import subject
from meshwind.pictures.winding_scene import lifts, winding_scene
from meshwind.results.report import RunFacts, report
from meshwind.surface import shapes
from meshwind.surface.grid import grid


def share(image: np.ndarray, colour: tuple[int, int, int], reach: float) -> float:
    """Share of pixels whose hue lies close to a colour's, in any light."""
    pixel = image / np.maximum(np.linalg.norm(image, axis=2, keepdims=True), 1.0)
    wanted = np.array(colour) / np.linalg.norm(colour)
    return float((pixel @ wanted > np.cos(reach)).mean())


@pytest.mark.usefixtures("opengl")
def test_the_picture_shows_both_families_and_the_bridges(tmp_path: Path) -> None:
    driver.start_probe()
    assert driver.draw(tmp_path / "winding.png", assess(bridged()), "waist") == ""
    with Image.open(tmp_path / "winding.png") as opened:
        image = np.asarray(opened.convert("RGB"), dtype=float)
    assert image.shape == (1200, 1600, 3)
    assert (image[0, :, :] == 255.0).all()  # light paper, nothing cut off at the top
    body = image[140:1080, 60:1315]
    assert share(body, (0, 114, 178), 0.06) > 0.003
    assert share(body, (230, 159, 0), 0.06) > 0.003
    assert share(body, (220, 50, 152), 0.15) > 0.001  # the magenta of wide gaps
    assert (body[:, 0] == 255.0).all()
    assert (body[:, -1] == 255.0).all()


def test_without_a_driver_the_run_goes_on(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    driver.stop()
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", str(tmp_path))
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    note = driver.draw(tmp_path / "winding.png", assess(helices(4, 0.5, 21, cylinder())), "cylinder")
    assert "libegl1" in note
    assert "libgl1-mesa-dri" in note
    assert not list(tmp_path.iterdir())


@pytest.mark.usefixtures("opengl")
def test_a_picture_that_cannot_be_saved_is_reported(tmp_path: Path) -> None:
    note = driver.draw(tmp_path / "nowhere" / "winding.png", assess(helices(4, 0.5, 21, cylinder())), "cylinder")
    assert note.startswith("no winding.png: ")
    assert "\n" not in note


def test_a_renderer_that_is_not_needed_ends() -> None:
    driver.start_probe()
    driver.start_probe()
    driver.stop()
    driver.stop()


@pytest.mark.usefixtures("opengl")
def test_a_renderer_is_kept_and_one_that_has_ended_is_replaced(tmp_path: Path) -> None:
    driver.stop()
    scene = Drawing(winding_scene(subject(assess(helices(4, 0.5, 21, cylinder())), "cylinder")), Page(400, 300))
    files = [tmp_path / f"{number}.png" for number in range(3)]
    assert driver.paint({files[0]: scene}) == ""
    with painter() as first:
        process = first.process
        first.send(files[1], scene)
        assert first.finish() == ""
    process.kill()
    process.wait()
    assert driver.paint({files[2]: scene}) == ""
    with painter() as last:
        assert last.process.pid != process.pid
        assert last.finish() == ""
    driver.stop()
    assert files[0].read_bytes() == files[1].read_bytes() == files[2].read_bytes()


@pytest.mark.usefixtures("opengl")
def test_a_renderer_is_not_left_at_work_by_an_error(tmp_path: Path) -> None:
    scene = Drawing(winding_scene(subject(assess(helices(4, 0.5, 21, cylinder())), "cylinder")))
    with pytest.raises(KeyboardInterrupt), painter() as one:
        one.send(tmp_path / "a.png", scene)
        raise KeyboardInterrupt
    assert one.process.returncode is not None
    assert driver.can_draw() == ""


def test_writing_alone_does_not_load_vtk() -> None:
    done = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys, meshwind.results, meshwind.pictures.driver, meshwind.results.folder\n"
            "print(sorted({name.split('.')[0] for name in sys.modules} & {'vtkmodules', 'vtk', 'pyvista', 'meshio'}))",
        ],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[1],
    )
    assert done.stdout.strip() == "[]"


def test_the_view_is_square_on_and_holds_everything() -> None:
    on = grid(waisted())
    for turned in np.eye(3), np.eye(3)[[2, 0, 1]], np.eye(3)[[1, 2, 0]]:
        points = on.points @ turned.T
        none = np.zeros((0, 3))
        view = best_view(points, on.quads, points.reshape(*on.shape, 3).mean(axis=0), none, none, np.zeros(0))
        axes = np.stack([view.right, view.up, view.eye])
        assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
        assert np.linalg.det(axes) == pytest.approx(1.0)
        seen = (points - view.centre) @ axes.T
        assert np.abs(seen[:, 0]).max() == pytest.approx(0.5 * view.width)
        assert np.abs(seen[:, 1]).max() == pytest.approx(0.5 * view.height)
        long = turned @ np.array([0.0, 0.0, 1.0])
        assert abs(long @ view.eye) == pytest.approx(np.sin(np.radians(14.0)))
        upright = abs(long[2]) > 0.7
        assert (view.height > view.width) == upright
        assert view.up[2] >= 0.0


def test_the_view_turns_to_where_the_bridges_are() -> None:
    on = grid(cylinder())
    for side in np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]]):
        axis = on.points.reshape(*on.shape, 3).mean(axis=0)
        view = best_view(on.points, on.quads, axis, side[None] + [[0.0, 0.0, 2.0]], side[None], np.ones(1))
        assert view.eye @ side > 0.9


@pytest.mark.parametrize("inside", [1.0, -1.0])
def test_a_bend_is_seen_from_its_side(inside: float) -> None:
    """A quarter bend is seen perpendicular to its plane, on either side of which the bridges may be."""
    on = grid(shapes.elbow(3.0, 1.0))
    axis = on.points.reshape(*on.shape, 3).mean(axis=0)
    plane = np.linalg.svd(axis - axis.mean(axis=0))[2][2]
    marks = axis[[len(axis) // 2]]
    view = best_view(on.points, on.quads, axis, marks, inside * plane[None], np.ones(1))
    assert view.eye @ (inside * plane) > np.cos(np.radians(25.0))


def test_bridges_are_drawn_straight() -> None:
    """Lifted by any radius, all particles of a bridge stay on the line between its lifted ends."""
    paths = bridged()
    lift = lifts(paths, np.arange(paths.gap.shape[1]))
    points = paths.points + 0.05 * lift
    spans = bridges(paths)
    assert len(spans) > 5
    for path, first, last in zip(spans.path, spans.first, spans.last, strict=True):
        chord = points[path, first : last + 1]
        direction = (chord[-1] - chord[0]) / np.linalg.norm(chord[-1] - chord[0])
        off = np.cross(chord - chord[0], direction)
        assert np.abs(off).max() < 1e-12
        assert chord[0] == pytest.approx(paths.points[path, first] + 0.05 * paths.normal[path, first])
    touching = paths.on_surface
    assert np.array_equal(lift[touching], paths.normal[touching])
    kept = np.arange(3, paths.gap.shape[1], 7)
    assert np.array_equal(lifts(paths, kept), lift[:, kept])


@pytest.mark.parametrize("failed", [[], [0, 5], list(range(8))])
def test_picture_and_report_have_the_same_figures(failed: list[int]) -> None:
    paths = bridged()
    status = np.zeros(len(paths), dtype=np.int64)
    status[np.array(failed, dtype=int)] = 2
    if len(failed) == 8:
        status[:] = 2
    layup = assess(replace(paths, status=status))
    figures = report(layup, Mesh(np.eye(3), np.array([[0, 1, 2]])), None, RunFacts(0.5))
    seen = winding_scene(subject(layup, "waist", "in"))
    reported = figures["paths"]
    assert f"bridged {100 * reported['bridged_fraction']:.1f} %" in seen.frame.subtitle
    assert f"length {quantity(reported['length_total'], 'in')}" in seen.frame.subtitle
    assert f"{figures['crossings']['count']} crossings" in seen.frame.subtitle
    assert (f"{reported['converged']} of {len(paths)} at rest" in seen.frame.subtitle) == bool(failed)
    assert seen.max_gap == reported["max_gap"] == seen.bridges.gap.max()
    assert len(seen.bridges.sizes) == reported["bridges"]


@pytest.mark.usefixtures("opengl")
def test_a_picture_without_a_unit_names_none(tmp_path: Path) -> None:
    layup = assess(bridged())
    assert "in" not in winding_scene(subject(layup, "waist")).frame.subtitle.split()
    images = []
    for units in ("", "in"):
        driver.start_probe()
        assert driver.draw(tmp_path / "winding.png", layup, "waist", units) == ""
        with Image.open(tmp_path / "winding.png") as opened:
            images.append(np.asarray(opened.convert("RGB"), dtype=int))
    changed = (images[0] != images[1]).any(axis=2)
    assert changed.any(axis=1)[1100:].any()  # the ruler
    assert changed[300:460].any()  # the colour scale


def test_thinning_keeps_the_ends_of_paths_and_bridges() -> None:
    layup = assess(bridged(particles=801))
    seen = winding_scene(subject(layup, "waist"))
    assert seen.fibres.points.shape[1] <= 252
    assert np.array_equal(seen.fibres.points[:, [0, -1]], layup.paths.points[:, [0, -1]])
    ends = np.cumsum(seen.bridges.sizes)
    assert ends[-1] == len(seen.bridges.points)
    assert (seen.bridges.gap[ends - 1] == 0.0).all()
    assert (seen.bridges.gap[ends - seen.bridges.sizes] == 0.0).all()
    assert seen.bridges.gap.max() == pytest.approx(seen.max_gap, rel=1e-3)
