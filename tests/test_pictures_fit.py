"""The picture of a fit that fails: the lost regions are found, looked at from where they show, and drawn."""

from pathlib import Path

import numpy as np
import pytest
from layup_shapes import bridged
from mesh_shapes import tube
from PIL import Image
from test_workflow_notes import horned

import meshwind as mw
from meshwind.appearance.view import around, merit_view
from meshwind.core.cast import Floats, frozen
from meshwind.layup.layup import assess
from meshwind.mesh import mesh_from
from meshwind.mesh.opening.choose_ends import position_text
from meshwind.pictures import driver
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.subject import subject
from meshwind.pictures.winding_scene import winding_scene
from meshwind.results.schema import FIT_PICTURE
from meshwind.run.summary import run_lines
from meshwind.surface import shapes
from meshwind.surface.fitting.deviation import Deviation, deviation
from meshwind.workflow.notes import Note

AROUND, ALONG, HEIGHT = 48, 40, 4.0


def row(turn: float, z: float) -> int:
    """Number of the tube's vertex at a turn and a height."""
    return round(z / HEIGHT * ALONG) * AROUND + round(turn * AROUND) % AROUND


def bumped(bumps: dict[int, float]) -> tuple[mw.Surface, mw.Annulus]:
    """A cylinder of radius 1, and a mesh of it whose numbered vertices stick out by the given amounts."""
    vertices, faces = tube(lambda z: 1.0 + 0.0 * z, HEIGHT, AROUND, ALONG)
    for vertex, out in bumps.items():
        vertices[vertex] += out * vertices[vertex] * [1.0, 1.0, 0.0]
    start = shapes.cylinder(1.0, HEIGHT, (64, 16))
    opened = mw.annulus(mesh_from(vertices, faces), ends="z")
    assert len(opened.vertices) == len(vertices)
    low = start.points([[0.0, 0.0]])[0, 2]
    return mw.Surface(start.control_points - [0.0, 0.0, low]), opened


def outward(turn: float) -> Floats:
    return np.array([np.cos(2 * np.pi * turn), np.sin(2 * np.pi * turn), 0.0])


def test_regions_are_found_from_the_worst_on_with_their_distances() -> None:
    bumps = {row(0.1, 1.0): 0.3, row(0.5, 2.0): 0.5, row(0.8, 3.0): 0.2, row(0.3, 3.0): 0.1}
    surface, opened = bumped(bumps)
    found = deviation(surface, opened)
    assert [one.distance for one in found.regions] == pytest.approx([0.5, 0.3, 0.2], abs=1e-5)
    for one, (turn, z, out) in zip(found.regions, [(0.5, 2.0, 0.5), (0.1, 1.0, 0.3), (0.8, 3.0, 0.2)], strict=True):
        axis = round(turn * AROUND) / AROUND
        assert one.on_mesh == pytest.approx((1.0 + out) * outward(axis) + [0.0, 0.0, z], abs=1e-9)
        assert one.on_surface == pytest.approx(outward(axis) + [0.0, 0.0, z], abs=1e-4)
    assert found.to_surface[row(0.3, 3.0)] == pytest.approx(0.1, abs=1e-5)
    quiet = np.ones(len(opened.vertices), dtype=bool)
    quiet[list(bumps)] = False
    assert found.to_surface[quiet].max() < 1e-5


def test_a_bulge_of_the_surface_between_vertices_is_found_too() -> None:
    surface, opened = bumped({})
    net = surface.control_points.copy()
    net[10, 9] += 0.9 * net[10, 9] * [1.0, 1.0, 0.0]
    found = deviation(mw.Surface(net), opened)
    assert len(found.regions) == 1
    spans = surface.spans
    peak = mw.Surface(net).points([[9 / spans[0], 8 / spans[1]]])[0]
    assert found.regions[0].on_surface == pytest.approx(peak, abs=0.02)
    assert np.linalg.norm(found.regions[0].on_mesh[:2]) == pytest.approx(1.0, abs=0.01)
    assert found.regions[0].distance == pytest.approx(0.9 * (2 / 3) ** 2, rel=0.02)


def test_what_trimming_made_is_no_region() -> None:
    surface, opened = bumped({row(0.1, 1.0): 0.3, row(0.5, 2.0): 0.5})
    trusted = np.ones(len(opened.vertices), dtype=bool)
    trusted[row(0.5, 2.0)] = False
    known = mw.Annulus(opened.mesh, opened.vertices, opened.faces, opened.rims, frozen(trusted), opened.ends)
    assert deviation(surface, known).regions[0].distance == pytest.approx(0.3, abs=1e-5)


def test_distances_do_not_stop_at_the_facets_of_a_sample() -> None:
    """Vertices on the surface have distances of round-off, even if the grid is coarse."""
    surface, opened = bumped({})
    assert deviation(surface, opened).to_surface.max() < 2e-6


@pytest.mark.parametrize("turn", [0.0, 0.2, 0.45, 0.7, 0.9])
def test_the_worst_place_is_in_sight(turn: float) -> None:
    surface, opened = bumped({row(turn, 2.0): 0.4})
    seen = fit_scene(surface, opened, "tube", "mm")
    view = seen.frame.view
    assert seen.seen[0].all()
    assert view.eye @ outward(turn) > 0.1
    axes = np.stack([view.right, view.up, view.eye])
    assert axes @ axes.T == pytest.approx(np.eye(3), abs=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    flat = (opened.vertices - view.centre) @ axes.T
    assert 2.0 * np.abs(flat[:, :2]).max(axis=0) == pytest.approx([view.width, view.height])
    assert seen.most == pytest.approx(0.4, abs=1e-5)
    assert "0.4 mm" in seen.frame.subtitle and "tube" in seen.frame.title


def test_a_place_on_the_far_side_is_reported_as_out_of_sight() -> None:
    surface, opened = bumped({row(0.25, 2.0): 0.5, row(0.75, 2.0): -0.45})
    seen = fit_scene(surface, opened, "tube")
    assert seen.seen.tolist() == [[True, True], [False, False]]


def test_directions_are_even_all_around() -> None:
    eyes = around(240)
    assert np.linalg.norm(eyes, axis=1) == pytest.approx(np.ones(240))
    assert eyes.mean(axis=0) == pytest.approx(np.zeros(3), abs=0.01)
    nearest = np.sort(eyes @ eyes.T, axis=1)[:, -2]
    assert np.degrees(np.arccos(nearest)).min() > 9.0


def test_merit_outweighs_the_shadow() -> None:
    vertices, faces = tube(lambda z: 1.0 + 0.0 * z)
    eyes = np.eye(3)
    assert merit_view(vertices, faces, eyes, np.array([0.0, 0.0, 3.0])).eye == pytest.approx([0, 0, 1])
    upright = merit_view(vertices, faces, eyes, np.array([0.0, 0.1, 0.0]))
    assert upright.eye == pytest.approx([0, 1, 0])
    assert upright.up == pytest.approx([0, 0, 1])
    assert (upright.width, upright.height) == pytest.approx((2.0, 3.0))


def picture(file: Path) -> Floats:
    with Image.open(file) as opened:
        return np.asarray(opened.convert("RGB"), dtype=np.float64)


@pytest.mark.usefixtures("opengl")
def test_the_picture_shows_what_is_lost(tmp_path: Path) -> None:
    surface, opened = bumped({row(0.5, 2.0): 0.5})
    assert driver.draw_fit(tmp_path / "fit_error.png", surface, opened, units="mm") == ""
    image = picture(tmp_path / "fit_error.png")
    assert image.shape == (1200, 1600, 3)
    views = image[150:1080, 60:1315]
    dark = (views[..., 2] > views[..., 1] + 20) & (views.sum(axis=2) < 330)
    assert dark.sum() > 300  # the end of the scale: the bump on the mesh
    pale = (views[..., 0] > views[..., 2] + 30) & (views.sum(axis=2) > 330)
    assert pale.sum() > 100_000  # the rest of both bodies
    driver.draw_fit(tmp_path / "none.png", *bumped({row(0.5, 2.0): 0.5, row(0.75, 1.0): 0.49}))
    assert (picture(tmp_path / "none.png") != image).any()


@pytest.mark.usefixtures("opengl")
def test_a_fit_without_any_error_can_be_drawn(tmp_path: Path) -> None:
    surface, opened = bumped({})
    assert driver.draw_fit(str(tmp_path / "fit_error.png"), surface, opened) == ""


@pytest.mark.usefixtures("opengl")
def test_one_process_draws_both_and_says_which_one_fails(tmp_path: Path) -> None:
    wound = Drawing(winding_scene(subject(assess(bridged()), "waist")))
    fit = Drawing(fit_scene(*bumped({row(0.5, 2.0): 0.5}), "tube"))
    assert driver.paint({tmp_path / "winding.png": wound, tmp_path / "fit_error.png": fit}) == ""
    assert sorted(file.name for file in tmp_path.iterdir()) == ["fit_error.png", "winding.png"]
    note = driver.paint({tmp_path / "a.png": wound, tmp_path / "nowhere" / "b.png": fit})
    assert (tmp_path / "a.png").is_file()
    assert note.startswith("no b.png: ") and "\n" not in note


def test_the_title_names_the_given_revolutions() -> None:
    layup = assess(bridged())
    assert "0.8 revolutions" in winding_scene(subject(layup, "waist", revolutions=0.8)).frame.title
    mean = float(np.abs(layup.paths.uv[:, -1, 0] - layup.paths.uv[:, 0, 0]).mean())
    assert f"{mean:.4g} revolutions" in winding_scene(subject(layup, "waist")).frame.title


def test_a_note_names_its_picture_only_where_it_is() -> None:
    note = Note("bad", True, FIT_PICTURE)
    assert note.shown(True).text == "bad; see fit_error.png"
    assert note.shown(True).shown(True) == note.shown(True)
    assert note.shown(True).shown(False) == note == note.shown(False)
    assert Note("good").shown(True) == Note("good")


def test_a_run_that_warns_of_the_fit_draws_it_and_says_so(tmp_path: Path) -> None:
    result = mw.wind(horned(), paths=3, revolutions=0.2, worst_fit=0.5, out=tmp_path)
    drawn = (tmp_path / FIT_PICTURE).is_file()
    assert drawn == (tmp_path / "winding.png").is_file()
    assert drawn != any(note.text == driver.NO_DRIVER for note in result.notes)
    (line,) = [line for line in run_lines(result.report()) if "does not resolve" in line]
    assert line.endswith("; see fit_error.png") == drawn
    assert ("see fit_error.png" in (tmp_path / "report.json").read_text()) == drawn
    worst = deviation(result.surface, result.chart.annulus).regions[0]
    assert position_text(worst.on_surface, result.mesh.diagonal) in line
    again = result.write(tmp_path, render=False, overwrite=True)
    assert not (tmp_path / FIT_PICTURE).exists()  # a picture of an earlier run does not stay
    assert not any("fit_error" in note.text for note in again.notes)


def test_a_good_fit_is_not_drawn(tmp_path: Path) -> None:
    vertices, faces = tube(lambda z: 1.0 + 0.0 * z, HEIGHT, AROUND, ALONG)
    mw.wind(mesh_from(vertices, faces), paths=2, out=tmp_path)
    assert not (tmp_path / FIT_PICTURE).exists()


def test_measures_have_the_shapes_that_they_say() -> None:
    surface, opened = bumped({row(0.5, 2.0): 0.5})
    found = deviation(surface, opened)
    assert isinstance(found, Deviation)
    assert found.to_surface.shape == (len(opened.vertices),)
    assert found.to_mesh.shape == (len(found.surface.points),) == (found.grid.shape[0] * found.grid.shape[1],)
    assert not found.to_mesh.flags.writeable


def test_without_a_driver_both_pictures_share_one_line(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    driver.stop()
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", str(tmp_path))
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    result = mw.wind(horned(), paths=3, revolutions=0.2, worst_fit=0.5, out=tmp_path / "out")
    assert [note.text for note in result.notes].count(driver.NO_DRIVER) == 1
    assert not list((tmp_path / "out").glob("[wfs]*.png"))
    assert not any("fit_error.png" in note.text for note in result.notes)
