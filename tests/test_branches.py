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
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.mesh.inspection import inspect
from meshwind.surface import FitError
from meshwind.workflow.notes import about_fit, about_opening

X, Y, Z = np.eye(3)
Leg = tuple[tuple[float, float, float], float]
"""End point and radius of a leg that begins at the origin."""
Y_PIPE = (((0, 0, -60), 12.0), ((35, 0, 50), 10.0), ((-35, 0, 50), 10.0))
TEE = (((-60, 0, 0), 12.0), ((60, 0, 0), 12.0), ((0, 0, 45), 10.0))
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


def test_a_nozzle_and_a_closed_leg_are_no_branch() -> None:
    assert mw.annulus(mesh_from(*pipes(NOZZLE))).warnings == ()
    assert mw.annulus(mesh_from(*pipes(TEE, closed=1))).warnings == ()
    assert mw.annulus(mesh_from(*tube(lambda z: 1.0 + 0.0 * z))).warnings == ()


def test_a_hole_is_no_branch_however_wide() -> None:
    assert mw.annulus(drilled(0.2)).warnings == ()
    (warning,) = mw.annulus(drilled(0.7)).warnings
    assert warning.startswith("1 open rim nearly as wide as the ends, ") and "branch" not in warning


def test_the_advice_works() -> None:
    part = mesh_from(*pipes(Y_PIPE))
    chosen = mw.annulus(part, "loops 0 2")  # said by the user
    assert chosen.warnings == () and "rims number 0 and 2" in chosen.ends
    end = np.array([35.0, 0.0, 50.0])
    leg = (part.vertices @ end > 0.35 * end @ end)[part.faces].all(axis=1)  # cut where it branches
    wound = mw.wind(mesh_from(part.vertices, part.faces[leg]), paths=3, revolutions=0.3, particles=41, tolerance=1e-2)
    assert wound.settled and wound.chart.annulus.warnings == ()


def test_a_failed_fit_of_a_branch_says_that_it_branches() -> None:
    chart = mw.flatten(mw.annulus(mesh_from(*arms(6 * X, -6 * X, 5 * Y, 4 * Z))))
    size = chart.annulus.mesh.diagonal
    surface = mw.fit(chart)
    coarse = replace(surface, error=FitError(0.03 * size, 0.03 * size, 0.02 * size, 0.03 * size, size))
    (note,) = about_fit(coarse, chart, 1e-5, 0.2)
    assert note.warning and "the part branches; cut it where it branches and wind each leg" in note.text
    missed = replace(surface, error=FitError(1e-3 * size, 1e-3 * size, 1e-3 * size, 1e-3 * size, size, data="vertices"))
    (note,) = about_fit(missed, chart, 1e-5, 0.2)
    assert "the part branches; cut" in note.text and "finer" not in note.text


def test_check_warns_of_a_branch(tmp_path: Path) -> None:
    vertices, faces = pipes(TEE)
    lines = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a} {b} {c}" for a, b, c in faces + 1]
    (tmp_path / "tee.obj").write_text("\n".join(lines))
    assert inspect(tmp_path / "tee.obj").warnings[-1].startswith("the part branches")
    command = [sys.executable, "-m", "meshwind", "check", "tee.obj"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=tmp_path)
    assert done.returncode == 0 and "warning   the part branches: it has 1 more wide end" in done.stdout
