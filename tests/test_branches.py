"""Parts with more than two wide ends: they are said to branch, with advice that works; holes and nozzles are not."""

import re
import subprocess
import sys
from dataclasses import replace
from functools import cache
from pathlib import Path

import igl
import numpy as np
import pytest
from mesh_shapes import Part, tube
from test_mesh_ends_choice import arms

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.mesh import mesh_from
from meshwind.mesh.geometry.fill_holes import fill_hole
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.mesh.geometry.topology import loops
from meshwind.mesh.inspection import check
from meshwind.surface import FitError
from meshwind.workflow.notes import about_fit, about_opening

X, Y, Z = np.eye(3)
DATA = Path(__file__).parent.parent / "data"
Leg = tuple[tuple[float, float, float], float]
"""End point and radius of a leg that begins at the origin."""
Y_PIPE = (((0, 0, -60), 12.0), ((35, 0, 50), 10.0), ((-35, 0, 50), 10.0))
TEE = (((-60, 0, 0), 12.0), ((60, 0, 0), 12.0), ((0, 0, 45), 10.0))
BOSS = (((-60, 0, 0), 12.0), ((60, 0, 0), 12.0), ((0, 0, 10), 10.0))
BEND = (((-60, 0, 0), 12.0), ((0, 0, 60), 12.0))
NOZZLE = (((-60, 0, 0), 12.0), ((60, 0, 0), 12.0), ((0, 0, 27), 3.5))


def off_leg(points: Floats, end: Floats) -> Floats:
    """Distances of points from the line from the origin to an end."""
    along = np.clip(points @ end / (end @ end), 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - along[:, None] * end, axis=1))


@cache
def pipes(legs: tuple[Leg, ...], closed: int = 0, count: int = 44) -> Part:
    """Smooth union of legs, which are open at their ends except for the last `closed` ones."""
    ends = np.array([end for end, _ in legs], dtype=float)
    low, high = ends.min(axis=0) - 20.0, ends.max(axis=0) + 20.0
    step = float((high - low).max()) / count
    sizes = np.ceil((high - low) / step).astype(int) + 1
    z, y, x = np.meshgrid(*[low[k] + step * np.arange(sizes[k]) for k in (2, 1, 0)], indexing="ij")
    points = np.column_stack([x.ravel(), y.ravel(), z.ravel()])
    off = np.stack([off_leg(points, end) - radius for end, (_, radius) in zip(ends, legs, strict=True)])
    union = -np.log(np.exp(-0.6 * off).sum(axis=0)) / 0.6
    vertices, faces = igl.marching_cubes(union, points, *map(int, sizes), 0.0)[:2]
    for end in ends[: len(ends) - closed]:
        faces = faces[(vertices @ end < 0.9 * end @ end)[faces].all(axis=1)]
    return vertices, faces


def drilled(radius: float) -> Mesh:
    """An open tube, 1 in radius and 6 long, with a round hole in its flank."""
    vertices, faces = tube(lambda z: 1.0 + 0.0 * z, 6.0, 72, 80)
    far = np.linalg.norm(vertices - [1.0, 0.0, 3.0], axis=1) > radius
    return mesh_from(vertices, faces[far[faces].all(axis=1)])


@pytest.mark.parametrize(("legs", "place"), [(Y_PIPE, (31, 0, 44)), (TEE, (0, 0, 40))], ids=["Y", "tee"])
def test_a_part_with_three_wide_ends_branches(legs: tuple[Leg, ...], place: tuple[float, ...]) -> None:
    opened = mw.annulus(mesh_from(*pipes(legs)))
    (warning,) = opened.warnings
    found = re.match(
        r"the part branches: it has 1 more wide end, (\S+) round at \((\S+), (\S+), (\S+)\), which", warning
    )
    assert found is not None
    assert 55.0 < float(found[1]) < 95.0
    assert np.abs(np.abs([float(found[k]) for k in (2, 3, 4)]) - place).max() < 5.0
    (note,) = about_opening(opened)
    assert note.warning and note.text == warning


def test_a_cross_has_more_wide_ends_than_one() -> None:
    opened = mw.annulus(mesh_from(*arms(6 * X, -6 * X, 5 * Y, 4 * Z)))
    assert opened.warnings[0].startswith("the part branches: it has 2 more wide ends, the longest 8 round at")


@pytest.mark.parametrize("legs", [Y_PIPE, TEE], ids=["Y", "tee"])
@pytest.mark.parametrize("closed", [1, 3])
def test_a_closed_leg_is_told_as_an_open_one_is(legs: tuple[Leg, ...], closed: int) -> None:
    (warning,) = mw.annulus(mesh_from(*pipes(legs, closed))).warnings
    found = re.match(r"the part branches: it has 1 more wide end, (\S+) round at \((\S+), (\S+), (\S+)\)", warning)
    assert found is not None and "loops" not in warning
    assert 50.0 < float(found[1]) < 90.0
    tip = np.array([float(found[k]) for k in (2, 3, 4)])
    away = [np.linalg.norm(tip - end) for end, _ in legs]
    assert min(away) < 16.0  # on the cap of a leg, which may be any of them


def test_four_closed_legs_and_a_cross_of_bars() -> None:
    legs = (((-60, 0, 0), 12.0), ((60, 0, 0), 12.0), ((0, 0, 45), 10.0), ((0, -45, 0), 10.0))
    (warning,) = mw.annulus(mesh_from(*pipes(legs, 4))).warnings
    assert warning.startswith("the part branches: it has 2 more wide ends, the longest ")
    vertices, faces = arms(6 * X, -6 * X, 5 * Y)
    for loop in loops(faces):
        vertices, faces = fill_hole(vertices, faces, loop)
    (warning,) = mw.annulus(mesh_from(vertices, faces)).warnings
    assert warning.startswith("the part branches: it has 1 more wide end, ")


def test_a_nozzle_a_boss_and_a_bend_are_no_branch() -> None:
    for closed in (0, 1, 3):
        assert mw.annulus(mesh_from(*pipes(NOZZLE, closed))).warnings == ()
        assert mw.annulus(mesh_from(*pipes(BOSS, closed))).warnings == ()
    assert mw.annulus(mesh_from(*pipes(BEND))).warnings == ()
    assert mw.annulus(mesh_from(*pipes(BEND, 2))).warnings == ()
    assert mw.annulus(mesh_from(*tube(lambda z: 1.0 + 0.0 * z))).warnings == ()


def test_an_end_at_the_knee_of_a_bend_leaves_a_leg() -> None:
    part = mesh_from(*pipes(BEND, 1))
    (warning,) = mw.annulus(part).warnings  # the pole across the open rim is at the knee
    assert warning.startswith("the part branches: it has 1 more wide end, ")
    assert warning.endswith("choose other ends with ends='x,y,z x,y,z'")
    assert mw.annulus(part, "-60,0,0 0,0,70").warnings == ()


@pytest.mark.parametrize(
    "file", sorted(path.name for path in DATA.iterdir() if path.suffix in {".obj", ".stl", ".ply"})
)
def test_the_parts_of_the_examples_do_not_branch(file: str) -> None:
    assert mw.annulus(mw.read(DATA / file)).warnings == ()


def test_a_hole_is_no_branch_however_wide() -> None:
    assert mw.annulus(drilled(0.2)).warnings == ()
    (warning,) = mw.annulus(drilled(0.7)).warnings
    assert warning.startswith("1 open rim nearly as wide as the ends, ") and "branch" not in warning


def test_a_branch_is_told_where_the_ends_are_chosen_too() -> None:
    (warning,) = mw.annulus(mesh_from(*pipes(Y_PIPE)), "loops 0 2").warnings
    assert warning.startswith("the part branches: it has 1 more wide end, ") and "--ends" not in warning
    (warning,) = mw.annulus(drilled(0.7), "loops 0 1").warnings
    assert warning.startswith("1 open rim nearly as wide") and "--ends" not in warning
    assert "`meshwind.check` lists" in mw.annulus(drilled(0.7)).warnings[0]


def cut_at(part: Mesh, place: float, closed: bool) -> tuple[Mesh, Mesh]:
    """The leg of the tee above a height, and the rest below it with the hole of the cut closed or open."""
    above = (part.vertices[:, 2] > place)[part.faces].all(axis=1)
    vertices, rest = part.vertices, mesh_from(part.vertices, part.faces[~above])
    hole = min(loops(rest.faces), key=lambda loop: abs(float(rest.vertices[loop, 2].mean()) - place))
    filled = fill_hole(rest.vertices, rest.faces, hole) if closed else (rest.vertices, rest.faces)
    return mesh_from(vertices, part.faces[above]), mesh_from(*filled)


@pytest.mark.parametrize("closed", [0, 3], ids=["open", "closed"])
def test_the_advice_works(closed: int) -> None:
    part = mesh_from(*pipes(TEE, closed))
    (warning,) = mw.annulus(part).warnings
    assert "cut each leg off just beside where it branches" in warning
    assert "the rest with the hole that this leaves closed" in warning
    for each in cut_at(part, 17.0, closed=True):
        wound = mw.wind(each, paths=3, revolutions=0.3, particles=41, tolerance=1e-2)
        assert wound.settled and wound.chart.annulus.warnings == ()
    length = mw.annulus(cut_at(part, 17.0, closed=True)[1]).rims
    assert len(length) == 2


def test_a_failed_fit_of_a_branch_says_that_it_branches() -> None:
    chart = mw.flatten(mw.annulus(mesh_from(*arms(6 * X, -6 * X, 5 * Y, 4 * Z))))
    size = chart.annulus.mesh.diagonal
    surface = mw.fit(chart)
    coarse = replace(surface, error=FitError(0.03 * size, 0.03 * size, 0.02 * size, 0.03 * size, size))
    (note,) = about_fit(coarse, chart, 1e-5, 0.2)
    assert note.warning and "the part branches; cut each leg off just beside where it branches" in note.text
    missed = replace(surface, error=FitError(1e-3 * size, 1e-3 * size, 1e-3 * size, 1e-3 * size, size, data="vertices"))
    (note,) = about_fit(missed, chart, 1e-5, 0.2)
    assert "the part branches; cut" in note.text and "finer" not in note.text


def test_check_warns_of_a_branch(tmp_path: Path) -> None:
    vertices, faces = pipes(TEE)
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
    (tmp_path / "tee.obj").write_text("\n".join(lines))
    assert check(tmp_path / "tee.obj").warnings[-1].startswith("the part branches")
    command = [sys.executable, "-m", "meshwind", "check", "tee.obj"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=tmp_path)
    assert done.returncode == 0 and "warning   the part branches: it has 1 more wide end" in done.stdout
