"""The picture: drawn where there is a driver, explained where there is none."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from layup_shapes import bridged, cylinder, helices, waisted
from PIL import Image

from meshwind.layup.layup import assess
from meshwind.output import driver
from meshwind.output.maps import grid
from meshwind.output.scene import scene
from meshwind.output.view import best_view


def share(image: np.ndarray, colour: tuple[int, int, int], reach: float) -> float:
    """Share of pixels whose hue lies close to a colour's, whatever the light."""
    pixel = image / np.maximum(np.linalg.norm(image, axis=2, keepdims=True), 1.0)
    wanted = np.array(colour) / np.linalg.norm(colour)
    return float((pixel @ wanted > np.cos(reach)).mean())


def test_the_picture_shows_both_families_and_the_bridges(tmp_path: Path) -> None:
    driver.start_probe()
    note = driver.draw(tmp_path / "winding.png", assess(bridged()), "waist")
    if note:  # a machine without a driver: then it must say so and leave nothing
        assert note == driver.NO_DRIVER
        assert not list(tmp_path.iterdir())
        return
    with Image.open(tmp_path / "winding.png") as opened:
        image = np.asarray(opened.convert("RGB"), dtype=float)
    assert image.shape == (1200, 1600, 3)
    assert (image[0, :, :] == 255.0).all()  # light paper, nothing cut off at the top
    body = image[140:1080, 60:1315]
    assert share(body, (0, 114, 178), 0.06) > 0.003
    assert share(body, (230, 159, 0), 0.06) > 0.003
    assert share(body, (33, 145, 140), 0.06) > 0.001  # the middle of viridis
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


def test_a_picture_that_cannot_be_saved_is_told(tmp_path: Path) -> None:
    note = driver.draw(tmp_path / "nowhere" / "winding.png", assess(helices(4, 0.5, 21, cylinder())), "cylinder")
    assert note.startswith("no picture: ")
    assert "\n" not in note


def test_a_renderer_that_is_not_needed_ends() -> None:
    driver.start_probe()
    driver.start_probe()
    driver.stop()
    driver.stop()


def test_writing_alone_does_not_load_vtk() -> None:
    told = subprocess.run(
        [
            sys.executable,
            "-c",
            "import sys, meshwind.output, meshwind.output.driver, meshwind.output.folder\n"
            "print(sorted({name.split('.')[0] for name in sys.modules} & {'vtkmodules', 'vtk', 'pyvista', 'meshio'}))",
        ],
        capture_output=True,
        text=True,
        check=True,
        cwd=Path(__file__).parents[1],
    )
    assert told.stdout.strip() == "[]"


def test_the_view_is_square_on_and_holds_everything() -> None:
    on = grid(waisted())
    for turned in np.eye(3), np.eye(3)[[2, 0, 1]], np.eye(3)[[1, 2, 0]]:
        points = on.points @ turned.T
        none = np.zeros((0, 3))
        view = best_view(points, on.quads, none, none, np.zeros(0))
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
        view = best_view(on.points, on.quads, side[None] + [[0.0, 0.0, 2.0]], side[None], np.ones(1))
        assert view.eye @ side > 0.9


def test_thinning_keeps_the_ends_of_paths_and_bridges() -> None:
    layup = assess(bridged(particles=801))
    seen = scene(layup, "waist")
    assert seen["paths"].shape[1] <= 252
    assert np.array_equal(seen["paths"][:, [0, -1]], layup.paths.points[:, [0, -1]])
    ends = np.cumsum(seen["bridge_sizes"])
    assert ends[-1] == len(seen["bridges"])
    assert (seen["bridge_gap"][ends - 1] == 0.0).all()
    assert (seen["bridge_gap"][ends - seen["bridge_sizes"]] == 0.0).all()
    assert seen["bridge_gap"].max() == pytest.approx(seen["max_gap"], rel=1e-3)
