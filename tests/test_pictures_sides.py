"""Views of a part: square to what bends, and from both sides, as one hides half."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from export_results import leave
from layup_shapes import cylinder, helices

from meshwind.appearance.view import View, best_view, framed, named_view
from meshwind.core.cast import Floats
from meshwind.pictures.animation_scene import animation_scene
from meshwind.pictures.canvas import Box, fitting, room, rooms
from meshwind.pictures.gallery import placed, scenes_of
from meshwind.pictures.page import Page
from meshwind.pictures.subject import subject_of
from meshwind.pictures.winding_scene import winding_scene
from meshwind.results.reading import read_results
from meshwind.surface.grid import grid_quads


def seen(points: Floats, view: View) -> Floats:
    return np.asarray((points - view.centre) @ np.stack([view.right, view.up, view.eye], axis=1))


def duct(bend: float, turn: float) -> tuple[Floats, Floats]:
    """A tube along z whose middle is an S in a plane at an angle to x: its points (32 65, 3) and its middle (65, 3)."""
    t, u = np.linspace(0.0, 1.0, 65), 2.0 * np.pi * np.arange(32) / 32
    off = bend * np.sin(2.0 * np.pi * t)
    axis = np.stack([off * np.cos(turn), off * np.sin(turn), 6.0 * t], axis=1)
    ring = 0.5 * np.stack([np.cos(u), np.sin(u), 0.0 * u], axis=1)
    return (axis[None] + ring[:, None]).reshape(-1, 3), axis


@pytest.mark.parametrize("turn", np.radians([0.0, 50.0, 90.0, 160.0]))
@pytest.mark.parametrize("bend", [0.5, 1.5])
def test_an_s_is_seen_as_an_s(bend: float, turn: float) -> None:
    points, axis = duct(bend, turn)
    none = np.zeros((0, 3))
    view = best_view(points, grid_quads(32, 65, True), axis, none, none, np.zeros(0))
    across = seen(axis, view) @ np.array([1.0, 0.0, 0.0])
    assert np.ptp(across) > 0.9 * 2.0 * bend


def test_the_other_side_is_what_is_hidden() -> None:
    points = np.random.default_rng(2).normal(size=(200, 3)) * [1.0, 2.0, 5.0]
    for name in ("x", "-y", "z", "iso"):
        view = named_view(points, name)
        before, behind = seen(points, view), seen(points, view.other)
        assert behind[:, 2] == pytest.approx(-before[:, 2])
        assert np.linalg.det(np.stack([view.other.right, view.other.up, view.other.eye])) == pytest.approx(1.0)
        along = 1 if view.upright else 0
        assert behind[:, along] == pytest.approx(before[:, along])  # so that places are next to each other
        again = framed(points, view.other)
        assert (again.width, again.height) == pytest.approx((view.width, view.height))


def inside(inner: Box, outer: Box) -> bool:
    ends = [(inner[k], inner[k] + inner[k + 2], outer[k], outer[k] + outer[k + 2]) for k in (0, 1)]
    return all(low >= least - 1e-9 and high <= most + 1e-9 for low, high, least, most in ends)


@pytest.mark.parametrize(("size", "count"), [((1.0, 3.0), 2), ((6.0, 1.0), 2), ((1.0, 1.0), 1), ((1.4, 1.0), 1)])
def test_two_views_where_the_part_stays_large(size: tuple[float, float], count: int) -> None:
    view = View(np.eye(3)[0], np.eye(3)[1], np.eye(3)[2], np.zeros(3), size[0], size[1], both=True)
    page = Page()
    boxes, whole = rooms(page, view), room(page)
    assert len(boxes) == count and all(inside(box, whole) for box in boxes)
    scale = fitting(page, view)
    assert all(size[0] / scale <= box[2] + 1e-9 and size[1] / scale <= box[3] + 1e-9 for box in boxes)
    assert scale <= 1.25 * fitting(page, replace(view, both=False))
    if count == 2:
        first, second = boxes
        assert first[0] + first[2] < second[0] or first[1] + first[3] < second[1]
    assert len(rooms(page, replace(view, both=False))) == len(rooms(replace(page, perspective=True), view)) == 1


def test_pictures_show_both_sides_unless_one_is_asked_for_or_they_move(tmp_path: Path) -> None:
    leave(tmp_path, helices(4, 0.5, 41, cylinder(64)))
    results = read_results(tmp_path)
    of = subject_of(results)
    assert len(rooms(Page(), winding_scene(of).frame.view)) == 2
    assert len(rooms(Page(), animation_scene(of, 1.0, [tmp_path / "w.gif"]).winding.frame.view)) == 1
    assert len(rooms(Page(), subject_of(results, "x").frame("", "").view)) == 1


def test_what_is_drawn_for_a_sheet_alone_shows_one_side(tmp_path: Path) -> None:
    leave(tmp_path, helices(4, 0.5, 41, cylinder(64)))
    scenes = scenes_of(subject_of(read_results(tmp_path)))
    drawings = placed(scenes, ("winding", "sheet"), Page(), tmp_path, tmp_path / "cells")
    assert len(drawings) == len(scenes)
    for file, drawing in drawings.items():
        scene: Any = drawing.scene
        assert scene.frame.view.both == (file.name == "winding.png")
