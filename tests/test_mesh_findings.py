"""`inspect` and `meshwind check`: findings are right and agree with what winding does."""

import json
import subprocess
from dataclasses import FrozenInstanceError, asdict
from pathlib import Path

import numpy as np
import pytest
from broken_meshes import MESHES, branch, double_skin, fin, flipped, klein, save_obj, torus
from command import meshwind
from mesh_shapes import Part, cone, joined, pear

from meshwind.core.errors import BadInputError
from meshwind.mesh import Findings, annulus, check, mesh_from, read
from meshwind.mesh.geometry.areas_and_volumes import areas, perimeter

DATA = Path(__file__).parents[1] / "data"


def found(part: Part, folder: Path, ends: str = "auto", component: int = 0) -> Findings:
    save_obj(folder / "part.obj", part)
    return check(folder / "part.obj", ends=ends, component=component)


def test_a_tube_with_a_hole_in_its_side(tmp_path: Path) -> None:
    result = found(branch(), tmp_path)
    vertices, faces = branch()
    assert (result.name, result.format) == ("part.obj", "OBJ")
    assert (result.vertices, result.faces) == (len(vertices), len(faces))
    assert result.diagonal == pytest.approx(np.sqrt(17), rel=1e-12) and result.size == pytest.approx((2, 2, 3))
    assert (result.genus, result.closed, result.one_sided, result.problem) == (0, False, False, "")
    assert [piece.area for piece in result.pieces] == pytest.approx([areas(vertices, faces).sum()], rel=1e-12)
    assert [rim.use for rim in result.rims] == ["start", "end", "filled"]
    assert [rim.vertices for rim in result.rims[:2]] == [48, 48]
    assert result.rims[0].length == pytest.approx(48 * 2 * np.sin(np.pi / 48), rel=1e-12)
    assert result.rims[1].place == pytest.approx((0, 0, 3), abs=1e-12)
    assert [rim.use for rim in found(branch(), tmp_path, "loops 2 1").rims] == ["filled", "end", "start"]


@pytest.mark.parametrize("name", ["vase.stl", "tank.ply", "elbow.obj"])
def test_it_agrees_with_what_winding_does(name: str) -> None:
    result, trimmed = check(DATA / name), annulus(read(DATA / name))
    assert result.problem == "" and result.ends == trimmed.ends and result.repairs == trimmed.mesh.repairs
    assert (result.annulus_vertices, result.annulus_faces) == (len(trimmed.vertices), len(trimmed.faces))
    assert result.rim_lengths == tuple(perimeter(trimmed.vertices, rim) for rim in trimmed.rims)
    same = check(read(DATA / name))
    assert (same.ends, same.rim_lengths, same.pieces) == (result.ends, result.rim_lengths, result.pieces)


def test_faults_and_pieces_are_counted(tmp_path: Path) -> None:
    assert found(fin(pear()), tmp_path).crowded_edges == 1
    assert found(flipped(pear()), tmp_path).turned_edges > 100
    both = found(double_skin(pear()), tmp_path)
    assert both.piece_count == 2 and [piece.closed for piece in both.pieces] == [True, True]
    assert both.pieces[1].area / both.pieces[0].area == pytest.approx(0.98**2, rel=1e-9)
    mixed = joined(cone(), (pear()[0] * 0.1, pear()[1]))
    assert [(piece.closed, piece.faces) for piece in found(mixed, tmp_path).pieces] == [(False, 576), (True, 1280)]
    assert found(mixed, tmp_path, component=1).ends.startswith("poles")


def test_a_part_that_cannot_be_wound_is_described_as_far_as_possible(tmp_path: Path) -> None:
    ring = found(torus(), tmp_path)
    assert (ring.genus, ring.closed) == (1, True) and ring.problem.startswith("part.obj: genus 1 ")
    bottle = found(klein(), tmp_path)
    assert bottle.one_sided and "only one side" in bottle.problem
    crumbs = found(MESHES["pear, loose by 1e-2"](), tmp_path)
    assert crumbs.piece_count == 1280 and len(crumbs.pieces) == 100 and "falls apart" in crumbs.problem
    assert "open rims, 0 to 2" in found(branch(), tmp_path, "loops 0 9").problem
    assert "has 1 piece; give 0" in found(pear(), tmp_path, component=4).problem
    for name in ("NaN", "empty", "one point", "all 1e300"):
        with pytest.raises(BadInputError):
            found(MESHES[name](), tmp_path)


@pytest.mark.parametrize("name", [name for name in MESHES if "and" not in name])
def test_every_broken_mesh_has_the_problem_that_winding_raises(name: str, tmp_path: Path) -> None:
    save_obj(tmp_path / "part.obj", MESHES[name]())
    try:
        problem = check(tmp_path / "part.obj").problem
    except BadInputError as error:
        problem = str(error)
    try:
        annulus(read(tmp_path / "part.obj"))
    except BadInputError as error:
        assert str(error) == problem
    else:
        assert problem == ""


def test_findings_are_frozen_and_plain() -> None:
    result = check(mesh_from(*cone()))
    with pytest.raises(FrozenInstanceError):
        result.name = "other"  # type: ignore[misc]
    assert json.loads(json.dumps(asdict(result), allow_nan=False))["rims"][0]["use"] == "start"


def checked(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    return meshwind("check", *arguments)


def test_the_command_prints_the_findings_and_writes_nothing(tmp_path: Path) -> None:
    save_obj(tmp_path / "part.obj", branch())
    done = checked(tmp_path / "part.obj", "--ends", "loops 0 2")
    assert (done.returncode, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert lines[:2] == [
        "mesh      part.obj: 3 mm long, 2 x 2 mm across; mm assumed; see --units",
        "file      OBJ, 1776 vertices, 3347 faces",
    ]
    assert lines[-1] == "verdict   can be opened and wound; how well a surface fits it, only wind tests"
    assert "rim       0: at (0, 0, 0), 6.279 long, 48 vertices, start" in lines
    assert [path.name for path in tmp_path.iterdir()] == ["part.obj"]
    as_json = checked(tmp_path / "part.obj", "--ends", "loops 0 2", "--json")
    plain = asdict(check(tmp_path / "part.obj", ends="loops 0 2"))
    assert json.loads(as_json.stdout) == json.loads(json.dumps(plain))


def test_the_command_refuses_in_one_line(tmp_path: Path) -> None:
    save_obj(tmp_path / "part.obj", torus())
    for arguments, says in (
        ([tmp_path / "part.obj"], "genus 1"),
        ([tmp_path / "none.stl"], "file not found"),
        ([DATA / "tank.ply", "--opening", "-1"], "opening is -1"),
        ([DATA / "tank.ply", "--component", "1"], "1 piece; give 0"),
    ):
        done = checked(*arguments)
        assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
        assert done.stderr.startswith("meshwind: error: ") and says in done.stderr
