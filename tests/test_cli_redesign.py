"""`meshwind redesign` from outside."""

import json
import subprocess
import sys
from pathlib import Path

import meshio
import numpy as np
import pytest
from coarse_parts import coarse_vase, saved
from command import meshwind
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.mesh.geometry.facet_tree import FacetTree

DATA = Path(__file__).parents[1] / "data"
FILES = {"edited.ply", "edited.vtu", "report.json", "meshwind.toml"}
PICTURES = {"before.png", "after.png", "redesign.png", "slice.png", "rounds.png"}
BY_CAD = {"edited.step"}


def from_outside(*arguments: str | Path) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "meshwind", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=300)


@pytest.fixture(scope="module")
def vase(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, str]:
    folder = tmp_path_factory.mktemp("redesign")
    done = from_outside("redesign", DATA / "vase.stl", "--revolutions", "0.8", "--paths", "6", "--units", "mm",
                        "--out", folder)  # fmt: skip
    assert done.returncode == 0, done.stderr
    return folder, done.stdout


def test_the_folder_holds_the_edited_mesh_and_a_report(vase: tuple[Path, str]) -> None:
    folder, printed = vase
    assert {path.name for path in folder.iterdir()} - PICTURES - BY_CAD == FILES
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert report["redesign"]["windable"] and report["redesign"]["bridged"]["after"] == 0.0
    assert report["redesign"]["bridged"]["before"] > 0.0
    for each in report["rounds"]:
        assert each["kkt_residual"] <= 1e-6
        assert each["bridged"]["before"] >= each["bridged"]["after"]
    assert report["mesh"]["units"] == "mm" and "mm" in printed
    assert "no fibre bridges any more" in printed


@pytest.mark.usefixtures("opengl")
def test_the_folder_holds_pictures(vase: tuple[Path, str]) -> None:
    assert {path.name for path in vase[0].iterdir()} - FILES - BY_CAD == PICTURES


def test_the_edited_mesh_is_the_one_that_was_read_moved(vase: tuple[Path, str]) -> None:
    folder, _ = vase
    read = mw.read(DATA / "vase.stl")
    ply, vtu = meshio.read(folder / "edited.ply"), meshio.read(folder / "edited.vtu")
    for mesh in (ply, vtu):
        np.testing.assert_array_equal(mesh.cells_dict["triangle"], read.faces)
    moves = vtu.point_data["displacement"]
    np.testing.assert_array_equal(np.stack([ply.point_data[name] for name in ("dx", "dy", "dz")], axis=1), moves)
    np.testing.assert_allclose(ply.points - moves, read.vertices, atol=1e-12 * read.diagonal)
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    assert np.linalg.norm(moves, axis=1).max() == pytest.approx(report["redesign"]["displacement"]["max"])


def test_the_edited_mesh_wound_from_its_file_does_not_bridge(vase: tuple[Path, str]) -> None:
    folder, _ = vase
    threshold = json.loads((folder / "report.json").read_text(encoding="utf-8"))["redesign"]["threshold"]
    before, after = (mw.wind(mesh, paths=6, revolutions=0.8) for mesh in (DATA / "vase.stl", folder / "edited.ply"))
    assert before.paths.gap.max() > threshold
    assert after.settled and after.paths.gap.max() <= threshold


def test_the_edited_surface_is_in_the_step_file(vase: tuple[Path, str]) -> None:
    pytest.importorskip("OCP.collections")
    folder, _ = vase
    part, edited = mw.read(folder / "edited.step"), mw.read(folder / "edited.ply")
    assert part.units == "mm"
    far = cKDTree(part.vertices).query(edited.vertices[np.abs(edited.vertices[:, 2] - 100.0) < 60.0])[0]
    assert far.max() < 0.05 * edited.diagonal  # its facets are coarse
    # the surface itself: vertices of its facets lie on the facets of the edited mesh
    tree = FacetTree.of(edited.vertices, edited.faces)
    assert tree.distances(part.vertices).max() < 0.3


@pytest.mark.usefixtures("opengl")
def test_render_draws_the_folder_again(vase: tuple[Path, str], tmp_path: Path) -> None:
    folder, _ = vase
    done = meshwind("render", folder, "--only", "redesign", "--size", "400x300", "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert {path.name for path in tmp_path.iterdir()} == {"redesign.png"}


def test_what_must_not_move_does_not_and_an_impossible_demand_exits_3(tmp_path: Path) -> None:
    done = meshwind("redesign", saved(coarse_vase(), tmp_path / "vase.ply"), "--revolutions", "0.3", "--paths", "4",
                    "--particles", "101", "--bound", "0.01", "--freeze", "v<0.1", "--rounds", "1", "--no-render",
                    "--out", tmp_path / "out")  # fmt: skip
    assert done.returncode == 3, done.stderr
    assert "cannot reach the fibre" in done.stdout
    report = json.loads((tmp_path / "out" / "report.json").read_text(encoding="utf-8"))
    assert not report["redesign"]["windable"] and report["redesign"]["bridged"]["after"] > 0.0
    vtu = meshio.read(tmp_path / "out" / "edited.vtu")
    size = np.linalg.norm(vtu.point_data["displacement"], axis=1)
    assert size.max() <= 0.01 * (1 + 1e-9)


@pytest.mark.parametrize(
    ("wrong", "says"),
    [
        (("--freeze", "w<3"), "ranges of u, v, x, y or z"),
        (("--freeze", "x>1e9"), "contains no point of the part"),
        (("--rounds", "-1"), "rounds"),
        (("--bound", "0"), "bound"),
        (("--symmetry", "7"), "symmetry"),
        (("--revolutions", "many"), "revolutions"),
    ],
)
def test_bad_options_exit_2_with_one_line(wrong: tuple[str, str], says: str, tmp_path: Path) -> None:
    done = meshwind("redesign", DATA / "vase.stl", "--revolutions", "0.8", *wrong, "--out", tmp_path / "out")
    assert done.returncode == 2
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith("meshwind: error:") and says in last
    assert not (tmp_path / "out").exists()


def test_a_laminate_that_is_wound_as_one_filament_is_held_as_it_is(tmp_path: Path) -> None:
    """Turnarounds and cuts of a filament mean nothing to a redesign, which has no --continuous to be told to set."""
    file = tmp_path / "laminate.toml"
    file.write_text('[[layer]]\nkind = "helical"\nrevolutions = 0.8\npaths = 3\nturn_end = "pins"\ncut = true\n')
    done = from_outside("redesign", DATA / "vase.stl", "--layers", file, "--particles", "101", "--units", "mm",
                        "--no-render", "--out", tmp_path / "out")  # fmt: skip
    assert done.returncode == 0, done.stderr
    assert "winding   layer 1, helical, 0.8 revolutions; 3 paths per family" in done.stdout
