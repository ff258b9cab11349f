"""Pictures of layers one on another: read back from their files, the thickness map, the curves, and the bands."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.exporting.viewer import page_data
from meshwind.filament.course import Kind
from meshwind.pictures.filament_scene import bands_scene
from meshwind.pictures.gallery import scenes_of
from meshwind.pictures.laminate_scene import laminate_scene
from meshwind.pictures.page import Page
from meshwind.pictures.render import render
from meshwind.pictures.subject import Subject, subject_of
from meshwind.results.laminate_reading import read_laminate
from meshwind.results.reading import read_results
from meshwind.results.schema import LAMINATE, LAYER_FIBRES, OF_FILAMENT, OF_LAMINATE, STATIONS
from meshwind.surface.grid import grid

LAYERS = """
[[layer]]
kind = "helical"
revolutions = 0.4
paths = 6
band_width = 18
band_thickness = 0.4

[[layer]]
kind = "hoop"
from = 0.3
to = 0.7
band_width = 10
band_thickness = 0.3
friction = 0.2
"""


@pytest.fixture(scope="module")
def wound(tmp_path_factory: pytest.TempPathFactory) -> tuple[mw.Result, Path]:
    folder = tmp_path_factory.mktemp("laminate")
    (folder / "layers.toml").write_text(LAYERS)
    result = mw.wind("data/tank.ply", particles=61, layers=folder / "layers.toml", out=folder / "out", render=False)
    return result, folder / "out"


@pytest.fixture(scope="module")
def of(wound: tuple[mw.Result, Path]) -> Subject:
    return subject_of(read_results(wound[1]))


def test_a_laminate_is_read_as_it_was_wound(wound: tuple[mw.Result, Path], of: Subject) -> None:
    result, out = wound
    assert result.layered is not None
    helical, hoop = result.layered.laminate.layers
    read = read_laminate(out, of.paths.surface)
    assert read is not None and read.layers == 2
    on = grid(result.surface)
    assert read.thickness == pytest.approx(helical.thickness.at(on.uv) + hoop.thickness.at(on.uv), abs=1e-12)
    assert helical.paths is not None and hoop.hoop is not None
    assert len(read.fibres) == len(helical.paths) + 1
    points = np.concatenate([each.course.points for each in read.fibres[:-1]])
    assert np.array_equal(points, helical.paths.points.reshape(-1, 3))
    last = read.fibres[-1]
    assert np.array_equal(last.course.points, hoop.hoop.course.points)
    assert (last.layer == 1).all() and (last.course.kind == Kind.LAID).all()
    assert of.widths == (18.0, 10.0)


def test_the_curves_are_the_layers(wound: tuple[mw.Result, Path], of: Subject) -> None:
    scene = laminate_scene(of)
    assert set(scenes_of(of)) >= set(OF_LAMINATE)
    assert "filament" in OF_FILAMENT and "filament" not in scenes_of(of)
    assert scene.names == ("layer 1 helical", "layer 2 hoop")
    v = np.linspace(0.0, 1.0, len(scene.stations))
    there = np.isfinite(scene.angles[1])
    assert (v[there] > 0.29).all() and (v[there] < 0.71).all()
    assert np.isfinite(scene.angles[0]).all()
    assert (scene.angles[1, there] > 85.0).all()
    assert (np.diff(scene.stations) > 0.0).all()
    # the length along the part and the mean thickness give the volume of the helical layer
    laminate = wound[0].layered
    assert laminate is not None
    thickness = laminate.laminate.layers[0].thickness
    ring = thickness.area.sum(axis=0)
    mean = np.interp((np.arange(len(ring)) + 0.5) / len(ring), v, scene.thickness[0])
    assert float((mean * ring).sum()) == pytest.approx(thickness.volume, rel=0.02)


def test_the_layers_have_their_own_width_and_colour(of: Subject) -> None:
    scene = bands_scene(of)
    ribbons, groups = scene.ribbons, scene.groups
    assert groups is not None and scene.scale is None
    assert groups.names == ("layer 1 helical", "layer 2 hoop")
    across = np.linalg.norm(np.diff(ribbons.points, axis=1), axis=2).sum(axis=1)
    last = np.cumsum(ribbons.sizes) - 1
    ends = np.isin(np.arange(len(across)), [last, last + 1 - ribbons.sizes])
    for layer, width in enumerate(of.widths):
        mine = (ribbons.layer == layer) & ~ends  # a band that ends at a rim is cut along it, aslant
        assert across[mine].max() <= width * (1.0 + 1e-9)
        assert np.median(across[mine]) == pytest.approx(width, rel=0.01)


def test_bands_end_as_the_part_does(of: Subject) -> None:
    """The rims are circles about z: bands 18 wide would go up to 6 beyond them, on the inside."""
    surface, points = of.paths.surface, bands_scene(of).ribbons.points
    u = np.arange(360) / 360
    radius = [np.hypot(*surface.points(np.stack([u, np.full(360, v)], axis=1)).T[:2]) for v in (0.0, 1.0)]
    for sign, rim in zip((-1.0, 1.0), radius, strict=True):
        inside = rim.min() - np.hypot(points[..., 0], points[..., 1])[sign * points[..., 2] > 0.0]
        assert inside.max() < 0.01 * rim.min()


def test_the_viewer_has_the_thickness(wound: tuple[mw.Result, Path]) -> None:
    data = page_data(read_results(wound[1]))
    assert data["surface"]["maps"][0]["title"] == "thickness of the laminate"
    assert data["filament"] is None


@pytest.mark.usefixtures("opengl")
def test_the_laminate_is_drawn(wound: tuple[mw.Result, Path], tmp_path: Path) -> None:
    render(wound[1], ["laminate", "bands"], Page(640, 480), out=tmp_path)
    with Image.open(tmp_path / "laminate.png") as image:
        drawn = np.asarray(image.convert("RGB"), dtype=float)
    for colour in ((47, 109, 168), (224, 138, 30)):  # both layers in the curves
        assert (np.abs(drawn[:, 340:] - colour).max(axis=2) < 12.0).mean() > 2e-3
    with Image.open(tmp_path / "bands.png") as image:
        drawn = np.asarray(image.convert("RGB"), dtype=float)[60:430, 20:500]
    bare = (drawn[..., 0] > 1.6 * drawn[..., 1]) & (drawn[..., 2] > 1.2 * drawn[..., 1])
    assert 0.005 < bare.mean() < 0.5


@pytest.mark.parametrize(("name", "says"), [
    (STATIONS, "no stations"), (LAYER_FIBRES, "cannot be used"), (LAMINATE, "cannot be used"),
])  # fmt: skip
def test_a_damaged_laminate_is_refused(
    wound: tuple[mw.Result, Path], of: Subject, tmp_path: Path, name: str, says: str
) -> None:
    for file in wound[1].iterdir():
        (tmp_path / file.name).write_bytes(file.read_bytes())
    (tmp_path / name).write_text("v,z\n1,2\n" if name == STATIONS else "nothing")
    with pytest.raises(BadInputError, match=says):
        read_laminate(tmp_path, of.paths.surface)
