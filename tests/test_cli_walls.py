"""Parts with a wall from outside: wound on either skin, described, refused, and redesigned on the wound skin."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from command import meshwind
from walled_shapes import GRID, INNER, OUTER, Walled, bent, blob, bottle, chamfered, pipe, tunnelled

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.editing.notes import about_wall
from meshwind.editing.wall_left import wall_left
from meshwind.mesh import mesh_from
from meshwind.mesh.geometry.areas_and_volumes import volume
from meshwind.mesh.io.scalars import Scalars
from meshwind.workflow.part import on_wound_skin


def saved(part: Walled, file: Path) -> Path:
    """The part in an OBJ file."""
    rows = [f"v {x:.12g} {y:.12g} {z:.12g}\n" for x, y, z in part.vertices]
    rows += [f"f {a} {b} {c}\n" for a, b, c in part.faces + 1]
    file.write_text("".join(rows), encoding="utf-8")
    return file


def wound(part: Walled, folder: Path, *options: str) -> tuple[str, list[str], Path]:
    """What winding a part prints, the notes of its report, and its folder; the report has its wall."""
    out = folder / "wound"
    done = meshwind("wind", saved(part, folder / "part.obj"), "--paths", "4", "--no-render", "--out", out, *options)
    assert done.returncode == 0, done.stderr
    report = json.loads((out / "report.json").read_text(encoding="utf-8"))
    assert report["mesh"]["wall"]["side"] in report["mesh"]["ends"]
    assert f"the wall is {report['mesh']['wall']['thickness']:.3g} thick" in report["notes"][0]
    return done.stdout, report["notes"], out


def test_a_chamfered_elbow_is_wound_on_its_outside(tmp_path: Path) -> None:
    printed, notes, out = wound(chamfered().moved(bent(80.0)), tmp_path)
    assert notes[0].startswith("walled part: wound on its outside (--side), the wall is 3.99 thick")
    assert f"note      {notes[0]}" in printed and "the two largest rims of the outer skin" in printed

    def from_axis(points: Floats) -> Floats:
        x, y, z = points.T
        return np.asarray(np.hypot(np.hypot(80.0 - x, z) - 80.0, y))

    surface = pv.read(out / "surface.vtu")
    assert from_axis(surface.points) == pytest.approx(30.0, abs=0.2)
    assert from_axis(pv.read(out / "paths.vtp").points).min() > 29.8  # on it or outside it
    assert surface.point_data["fit_error"].max() < 0.2


def test_a_bottle_is_wound_on_its_inside(tmp_path: Path) -> None:
    _, notes, out = wound(bottle(), tmp_path, "--side", "inner", "--opening", "8", "--opening-by", "level")
    assert notes[0].startswith("walled part: wound on its inside (--side), the wall is 2 thick")
    assert 'side = "inner"' in (out / "meshwind.toml").read_text(encoding="utf-8")
    surface = pv.read(out / "surface.vtu")
    x, y, z = surface.points.T
    body, neck = (z > 15.0) & (z < 70.0), z > 115.0
    assert np.hypot(x, y)[body] == pytest.approx(33.0, abs=0.3) and np.hypot(x, y)[neck] == pytest.approx(10.0, abs=0.3)
    assert z.min() > 1.8 and np.hypot(x, y)[z < 2.2].min() == pytest.approx(8.0, rel=0.05)


def test_check_describes_a_walled_part_and_refuses_a_large_handle(tmp_path: Path) -> None:
    done = meshwind("check", saved(pipe(), tmp_path / "pipe.obj"), "--side", "inner")
    assert done.returncode == 0 and "verdict   can be opened and wound" in done.stdout
    assert "rim       0 of the inner skin: at (0, 0, " in done.stdout and "wound on its inside" in done.stdout
    done = meshwind("check", saved(tunnelled(blob(), 60.0, 12.0), tmp_path / "handle.obj"))
    assert done.returncode == 2 and "genus 1" in done.stderr and "round at (" in done.stderr


def waisted(wall: float = 4.0, cut: float = 1.5) -> Walled:
    """A chamfered pipe with a waist, which fibres along it bridge."""

    def place(points: Floats) -> Floats:
        slim = 1.0 - 0.2 * np.sin(np.pi * points[:, 2] / 120.0) ** 2
        return points * np.column_stack([slim, slim, np.ones(len(points))])

    return chamfered(wall=wall, cut=cut).moved(place)


@pytest.fixture(scope="module")
def edited() -> mw.Redesign:
    part = waisted()
    return mw.redesign(mesh_from(part.vertices, part.faces), revolutions=0.1, paths=4, particles=101)


def test_a_redesign_moves_the_wound_skin_only(edited: mw.Redesign, tmp_path: Path) -> None:
    part = waisted()
    on = {one: np.unique(part.faces[part.skin == one]) for one in (OUTER, INNER)}
    moved = np.linalg.norm(edited.displacement, axis=1)
    assert edited.windable and moved[on[OUTER]].max() > 3.0
    assert (moved[np.setdiff1d(on[INNER], on[OUTER])] == 0.0).all()
    moving = edited.part.faces[part.skin != INNER]  # the chamfers follow their rims
    gained = volume(edited.mesh.vertices, moving) - volume(edited.part.vertices, moving)
    assert edited.volume_change == pytest.approx(gained, rel=1e-9)
    assert edited.turned_over == 0
    notes = mw.write_redesign(edited, tmp_path / "out", units="mm", render=False)["notes"]
    assert notes[0].startswith("walled part: wound on its outside")
    assert notes[1].startswith("only the outer skin is moved; the wall is ") and "mm thick below it" in notes[1]


@pytest.mark.parametrize(("side", "skin"), [("outer", OUTER), ("inner", INNER)])
def test_what_is_left_of_a_wall(side: str, skin: int) -> None:
    part = pipe()
    mesh = mesh_from(part.vertices, part.faces)
    wall = mw.annulus(mesh, side=side).wall
    assert wall is not None
    radial = part.vertices * [1.0, 1.0, 0.0]
    radial /= np.linalg.norm(radial, axis=1, keepdims=True)
    radial[np.setdiff1d(np.arange(len(radial)), part.faces[part.skin == skin])] = 0.0
    left = wall_left(mesh, wall, 1.25 * radial)
    assert left.before == pytest.approx(3.0, rel=3e-3)
    assert left.after == pytest.approx(4.25 if side == "outer" else 1.75, rel=3e-3)


def test_a_wall_that_becomes_thin_or_is_pierced_has_a_warning(edited: mw.Redesign) -> None:
    inward = -edited.part.vertices * [1.0, 1.0, 0.0]
    inward /= np.linalg.norm(inward, axis=1, keepdims=True)
    for depth, says in ((1.0, None), (2.5, "of the wall near"), (6.0, "through the other one near")):
        notes = about_wall(replace(edited, displacement=depth * inward), "mm")
        assert [note.warning for note in notes] == ([False] if says is None else [False, True])
        assert says is None or (says in notes[1].text and "give a bound" in notes[1].text)


def test_an_edit_that_would_pierce_the_wall_ends_with_advice() -> None:
    """The inside is filled to straight lines from rim to rim, by 3 mm in the middle and so through the wall."""
    part = waisted(wall=2.0, cut=0.6)
    mesh = mesh_from(part.vertices, part.faces)
    edited = mw.redesign(mesh, revolutions=0.1, paths=4, particles=101, side="inner")
    assert not edited.windable and "through the other skin of its wall" in edited.outcome.advice
    assert (edited.displacement == 0.0).all() and len(edited.rounds) > 0


@pytest.mark.parametrize(("side", "value"), [("outer", 0.1), ("inner", 0.9)])
def test_scalars_are_those_of_the_wound_skin(side: str, value: float) -> None:
    part = pipe(wall=0.5, grid=GRID)
    mesh = mesh_from(part.vertices, part.faces)
    radius = np.linalg.norm(part.vertices[:, :2], axis=1)
    scalars = Scalars(part.vertices, np.where(radius > 29.75, 0.1, 0.9))
    chosen = on_wound_skin(scalars, mw.annulus(mesh, side=side))
    assert 0 < len(chosen.points) < len(radius) and (chosen.values == value).all()
