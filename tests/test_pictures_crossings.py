"""The picture of the crossings: discs that never merge, however close the crossings are."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from export_results import leave
from layup_shapes import cylinder, helices

from meshwind.core.cast import Floats
from meshwind.pictures.canvas import fitting
from meshwind.pictures.crossings_picture import discs, dots, radii
from meshwind.pictures.layup_scenes import crossings_scene, room
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import CrossingsScene
from meshwind.pictures.subject import subject_of
from meshwind.results.reading import read_results


def apart(points: Floats) -> Floats:
    off = np.linalg.norm(points[:, None] - points[None], axis=2)
    return np.asarray(off + np.diag(np.full(len(points), np.inf)))


@pytest.fixture(scope="module", params=[4, 40])
def scene(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> CrossingsScene:
    folder: Path = tmp_path_factory.mktemp("crossed")
    leave(folder, helices(request.param, 0.5, 101, cylinder(64)))
    return crossings_scene(subject_of(read_results(folder)))


def test_no_two_discs_meet_and_none_is_lost(scene: CrossingsScene) -> None:
    page = Page()
    pixel = fitting(page, scene.frame.view)
    size = radii(scene, pixel, page.unit)
    assert (size[:, None] + size[None] < apart(scene.points)).all()
    # as large as is legible where there is room, and not much smaller than there is room for where there is not
    assert (size > np.minimum(10.0 * pixel, 0.4 * apart(scene.points).min(axis=1))).all()


def test_discs_lie_on_the_part(scene: CrossingsScene) -> None:
    size = np.linspace(0.1, 0.2, len(scene.points))
    drawn = discs(scene.points, scene.normals, size)
    corners = drawn.points.reshape(len(scene.points), -1, 3)
    off = corners - corners[:, :1]
    assert np.abs((off * scene.normals[:, None]).sum(axis=2)).max() < 1e-6
    assert np.linalg.norm(off[:, 1:], axis=2) == pytest.approx(np.repeat(size[:, None], off.shape[1] - 1, axis=1))


def test_rings_leave_the_colours_free_from_both_sides(scene: CrossingsScene) -> None:
    near = replace(scene, room=np.full(len(scene.points), 8.0))
    cores, rings = dots(near, 1.0, 1.0, 0.1)
    core, ring = (each.points.reshape(len(scene.points), -1, 3) for each in (cores, rings))
    assert np.allclose(core[:, 1:], ring[:, : core.shape[1] - 1])  # where a disc ends its ring begins
    assert np.linalg.norm(ring[:, -1] - core[:, 0], axis=1) == pytest.approx(8.0)


@pytest.mark.parametrize(("pixels", "sides"), [(1.0, 6), (5.0, 20)])
def test_small_discs_have_few_sides(scene: CrossingsScene, pixels: float, sides: int) -> None:
    """There are hundreds of thousands of them: at 20 sides they would take more memory than all else of a run."""
    near = replace(scene, room=np.full(len(scene.points), pixels))
    cores, _ = dots(near, 1.0, 1.0, 0.1)
    assert cores.n_cells == sides * len(scene.points)


def test_room_of_clusters_and_of_single_crossings() -> None:
    cloud = np.random.default_rng(3).uniform(size=(300, 3)) ** 4
    free = room(cloud)
    assert (free[:, None] + free[None] < apart(cloud)).all()
    assert np.isinf(room(cloud[:1])).all() and len(room(cloud[:0])) == 0
