"""The picture of the layers: discrete steps, whose shares are those of the area, and what is bare."""

from dataclasses import replace

import numpy as np
import pytest
from export_results import leave
from layup_shapes import HEIGHT, cylinder, helices

from meshwind.appearance.layer_steps import step_firsts, step_words
from meshwind.appearance.looks import SIGNAL
from meshwind.layup.bands import bands
from meshwind.pictures.layers_scene import layers_scene, percent
from meshwind.pictures.layup_scenes import quads_scene
from meshwind.pictures.subject import Subject, subject_of
from meshwind.results.reading import read_results

COUNT, TURNS = 8, 1.0
HALF = np.pi / COUNT * np.cos(np.arctan2(2.0 * np.pi * TURNS, HEIGHT))
"""Width at which a family covers half of the cylinder."""


@pytest.fixture(scope="module")
def of(tmp_path_factory: pytest.TempPathFactory) -> Subject:
    folder = tmp_path_factory.mktemp("half")
    leave(folder, helices(COUNT, TURNS, 201, cylinder(64)))
    return subject_of(read_results(folder))


def test_what_an_average_hides_is_bare(of: Subject) -> None:
    layup = replace(of.layup, coverage=replace(of.layup.coverage, width=HALF))
    scene = layers_scene(replace(of, layup=layup))
    # on average there is one layer, but a quarter of the part has none
    shares = np.bincount(scene.steps.ravel(), minlength=3) / scene.steps.size
    assert shares == pytest.approx([0.25, 0.5, 0.25], abs=0.01)
    assert scene.colours[0] == SIGNAL and len(set(scene.colours)) == len(scene.colours) == len(scene.words) == 3
    assert scene.words == ("bare: 25 %", "1 layer: 50 %", "2 layers: 25 %")
    assert "25 % of the part bare" in scene.frame.subtitle


def test_the_image_of_the_layers_lies_on_the_part_by_its_uv(of: Subject) -> None:
    scene = layers_scene(of)
    laid = bands(of.paths, of.layup.bands.width, 24)
    assert np.array_equal(scene.steps, laid.layers)
    # the image goes once around the part: its corners are at the surface's, and no quad spans the seam
    assert np.abs(scene.part.points - of.paths.surface.points(scene.uv)).max() < 1e-9
    assert np.ptp(scene.uv[scene.part.quads, 0], axis=1).max() < 0.5
    assert (scene.uv.min(axis=0) == 0.0).all() and (scene.uv.max(axis=0) == 1.0).all()
    # about as many cells lie across a band as are to
    assert np.sqrt(of.layup.bands.width**2 / np.median(laid.area)) == pytest.approx(24.0, rel=0.3)


def test_steps_are_few_and_leave_none_out() -> None:
    assert step_words(step_firsts(0)) == ["bare"]
    assert step_words(step_firsts(2)) == ["bare", "1 layer", "2 layers"]
    assert step_words(step_firsts(6))[-1] == "6 layers"
    assert step_words(step_firsts(9)) == ["bare", "1 layer", "2 to 3 layers", "4 to 7 layers", "8 or more layers"]
    for most in range(300):
        firsts = step_firsts(most)
        assert len(firsts) <= 7 and firsts[0] == 0 and (np.diff(firsts) > 0).all() and firsts[-1] <= max(most, 0)


def test_little_is_not_none_and_nearly_all_is_not_all() -> None:
    shares = 0.0, 2e-5, 0.031, 0.29, 0.997, 1.0
    assert [percent(share) for share in shares] == ["0.0 %", "< 0.1 %", "3.1 %", "29 %", "99.7 %", "100 %"]


def test_many_layers_are_named_in_few_words(of: Subject) -> None:
    layup = replace(of.layup, coverage=replace(of.layup.coverage, width=12.0 * HALF))
    words = layers_scene(replace(of, layup=layup)).words
    assert words[:2] == ("bare: 0.0 %", "1 layer: 0.0 %") and words[-1].startswith("8 or more: ")
    assert all(len(each) <= len("8 or more: 100.0 %") for each in words)


def test_the_words_tell_how_far_the_part_is_from_flat_quads(of: Subject) -> None:
    """Over the middle of a quad whose corners span an angle a on a cylinder of radius 1: (1 - cos(a / 2)) / 2."""
    words = quads_scene(of).frame.subtitle
    told = float(words.rpartition("the part up to ")[2].split()[0])
    assert told == pytest.approx(0.5 * (1.0 - np.cos(np.pi / COUNT)), rel=0.02)
