"""Pictures of a filament: ribbons of true width, what the turnarounds stand on, and angles along the part."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import meshwind as mw
from meshwind.filament.filament import filaments_of
from meshwind.filament.levels import levels
from meshwind.pictures.angles_scene import angles_scene
from meshwind.pictures.filament_scene import bands_scene, filament_scene
from meshwind.pictures.gallery import scenes_of
from meshwind.pictures.subject import Subject, subject_of
from meshwind.results.filament_file import read_filaments
from meshwind.results.reading import read_results
from meshwind.results.schema import FILAMENT, OF_FILAMENT


@pytest.fixture(scope="module")
def wound(tmp_path_factory: pytest.TempPathFactory) -> tuple[mw.Result, Path]:
    out = tmp_path_factory.mktemp("filament") / "out"
    result = mw.wind("data/tank.ply", paths=5, particles=101, band_width=9.0, continuous=True, turn_end="shaft",
                     out=out, render=False)  # fmt: skip
    return result, out


@pytest.fixture(scope="module")
def of(wound: tuple[mw.Result, Path]) -> Subject:
    return subject_of(read_results(wound[1]))


def test_a_filament_is_read_as_it_was_written(wound: tuple[mw.Result, Path]) -> None:
    result, out = wound
    assert result.closed is not None
    (written,), (read,) = filaments_of(result.closed), read_filaments(out / FILAMENT)
    for name in written.course.__dataclass_fields__:
        ours, theirs = (getattr(each.course, name) for each in (written, read))
        assert np.allclose(ours, theirs, rtol=0.0, atol=1e-12, equal_nan=True), name
    assert (read.layer == 0).all()


def test_ribbons_are_as_wide_as_the_band(of: Subject) -> None:
    scene = filament_scene(of)
    across = np.linalg.norm(np.diff(scene.ribbons.points, axis=1), axis=2).sum(axis=1)
    assert across.max() <= 9.0 * (1.0 + 1e-9)
    assert np.quantile(across, 0.05) > 8.5  # chords of the arc, which is as wide as the band
    assert (np.diff(scene.ribbons.shares) >= 0.0).all()
    assert scene.ribbons.shares[-1] == pytest.approx(1.0)
    assert scene.gear.words == "pins and shaft"
    middle = scene.ribbons.points[:, scene.ribbons.points.shape[1] // 2]
    off = np.sqrt(((middle[:, None] - of.filaments[0].course.points[None]) ** 2).sum(axis=2)).min(axis=1)
    assert off.max() < 0.01 * of.paths.surface.size  # lifted, no more
    assert bands_scene(of).scale is None


def test_the_angles_are_those_of_the_paths(of: Subject) -> None:
    scene = angles_scene(of)
    low, median, high = scene.angles
    assert (low <= median).all() and (median <= high).all()
    # on a part of revolution the radius times the sine is the same all along, but for round-off and the mesh
    lines = levels(of.paths.surface)
    radius = np.interp(scene.stations, lines.mean, lines.length)
    constant = radius * np.sin(np.radians(median))
    assert constant == pytest.approx(float(np.median(constant)), rel=5e-3)
    assert scene.cover is not None and scene.cover.min() > 0.0


def test_only_a_filament_has_its_pictures(of: Subject) -> None:
    assert set(OF_FILAMENT) <= set(scenes_of(of))
    assert not set(OF_FILAMENT) & set(scenes_of(replace(of, filaments=())))


@pytest.mark.usefixtures("opengl")
def test_a_continuous_run_draws_its_filament(tmp_path: Path) -> None:
    mw.wind("data/elbow.obj", paths=3, particles=51, continuous=True, out=tmp_path / "out")
    for name in OF_FILAMENT:
        assert (tmp_path / "out" / f"{name}.png").stat().st_size > 10_000
