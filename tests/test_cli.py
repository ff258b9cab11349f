"""The command line from outside: what a user types, sees and finds in the folder."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista as pv
from command import meshwind

DATA = Path(__file__).parents[1] / "data"
FILES = {
    "paths.vtp",
    "bridges.vtp",
    "crossings.vtp",
    "quads.vtu",
    "quads.obj",
    "surface.vtu",
    "surface.npz",
    "chart.png",
    "report.json",
    "meshwind.toml",
}


def from_outside(*arguments: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "meshwind", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, cwd=folder)


Typed = Callable[..., subprocess.CompletedProcess[str]]


def triangle() -> str:
    return "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def torus() -> str:
    u, v = np.meshgrid(np.arange(24) / 24 * 2 * np.pi, np.arange(12) / 12 * 2 * np.pi, indexing="ij")
    points = np.stack([(3 + np.cos(v)) * np.cos(u), (3 + np.cos(v)) * np.sin(u), np.sin(v)], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(24), np.arange(12), indexing="ij")
    corner = [((i + a) % 24 * 12 + (j + b) % 12).ravel() + 1 for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    quads = np.stack(corner, axis=1)
    return "".join(f"v {x} {y} {z}\n" for x, y, z in points) + "".join(f"f {a} {b} {c} {d}\n" for a, b, c, d in quads)


BAD = {
    "missing.stl": (None, "not found"),
    "empty.stl": ("", "empty"),
    "text.stl": ("this is a letter, not a part\n" * 40, "text.stl"),
    "nan.obj": ("v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "NaN"),
    "triangle.obj": (triangle(), "triangle.obj"),
    "torus.obj": (torus(), "genus"),
    "part.xyz": ("0 0 0\n", "xyz"),
}


@pytest.mark.parametrize(("name", "typed"), [("torus.obj", from_outside), *((name, meshwind) for name in BAD)])
def test_bad_meshes_exit_2_with_one_line_and_leave_nothing(name: str, typed: Typed, tmp_path: Path) -> None:
    text, says = BAD[name]
    if text is not None:
        (tmp_path / name).write_text(text)
    before = set(tmp_path.iterdir())
    done = typed("wind", tmp_path / name, "--out", tmp_path / "out")
    complaint = [line for line in done.stderr.splitlines() if not line.endswith("...")]
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(complaint) == 1
    assert complaint[0].startswith("meshwind: error: ")
    assert says in complaint[0]
    assert set(tmp_path.iterdir()) == before


@pytest.mark.parametrize(("arguments", "says"), [
    (["wind"], "MESH"), (["wind", "a.stl", "--paths", "none"], "paths"), (["wind", "a.stl", "--paths", "0"], "paths"),
    (["wind", "a.stl", "--revolutions", "-1"], "revolutions"), (["fly"], "fly"), ([], "command"),
    (["wind", "a.stl", "--friction", "wet"], "friction"), (["wind", "a.stl", "--wings"], "wings"),
    (["wind", "a.stl", "--revolutions", "nan"], "revolutions is nan; give a number from 0"),
    (["wind", "a.stl", "--revolutions", "5/0"], "revolutions is '5/0'; give"),
    (["wind", "a.stl", "--revolutions", "200"], "revolutions is 200; give a number from 0 to 50"),
    (["wind", "a.stl", "--ends", "foo"], "ends 'foo'"), (["wind", "a.stl", "--opening", "-3"], "opening is -3"),
    (["wind", "a.stl", "--paths", "100000"], "GB of memory"), (["wind", "a.stl", "--out", ""], "out is ''"),
])  # fmt: skip
def test_bad_usage_exits_2_with_one_line(arguments: list[str], says: str, tmp_path: Path) -> None:
    typed = from_outside if arguments in (["fly"], []) else meshwind
    done = typed(*arguments, folder=tmp_path)
    assert done.returncode == 2
    assert len(done.stderr.splitlines()) == 1
    assert says in done.stderr
    assert not list(tmp_path.iterdir())


def test_a_file_in_the_way_of_the_folder(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("mine")
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path / "out")
    assert done.returncode == 2
    assert "out is a file" in done.stderr
    assert (tmp_path / "out").read_text() == "mine"


def test_a_folder_without_write_permission() -> None:
    """/proc takes no files, not even from root, whom permission bits do not stop."""
    done = meshwind("wind", DATA / "tank.ply", "--out", "/proc/meshwind-out")
    assert done.returncode == 2
    assert "cannot write" in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_help_shows_every_option() -> None:
    done = meshwind("wind", "--help")
    assert done.returncode == 0
    for option in (
        "--out",
        "--paths",
        "--revolutions",
        "--friction",
        "--ends",
        "--opening",
        "--tolerance",
        "--worst-fit",
        "--component",
        "--units",
        "--particles",
        "--no-render",
    ):
        assert option in done.stdout
    assert "meshwind 0" in from_outside("--version").stdout


@pytest.fixture(scope="module")
def tank(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    out = tmp_path_factory.mktemp("tank") / "out"
    return out, from_outside(
        "wind", DATA / "tank.ply", "--out", out, "--paths", "12", "--revolutions", "1/2", "--units", "mm", "--no-render"
    )


def test_summary_and_progress(tank: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    out, done = tank
    assert done.returncode == 0, done.stderr
    report = json.loads((out / "report.json").read_text())
    fit = report["surface"]["fit_error"]
    for word in (
        "5000 vertices, 9996 faces",
        f"to the vertices {fit['to_surface']['max']:.2g} mm",
        f"to the facets {fit['to_mesh']['max']:.2g} mm",
        "tolerance 1e-5",
        "poles on its longest axis",
        "opened to radius",
        "24 of 24 at rest",
        f"length {float(format(report['paths']['length_total'], '.4g')):,.0f} mm, no bridges",
        "seconds",
        str(out),
    ):
        assert word in done.stdout
    assert "warning" not in done.stdout
    assert report["notes"] == []
    assert report["mesh"]["units"] == "mm"
    assert done.stderr.splitlines()[0] == "read ..."
    assert "\x1b" not in done.stdout + done.stderr


def test_every_file_of_the_contract_is_there(tank: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    assert {file.name for file in tank[0].iterdir()} == FILES


def test_paths_read_back(tank: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    poly = pv.read(tank[0] / "paths.vtp")
    assert poly.n_cells == 24
    assert {"uv", "on_surface", "gap", "normal", "slip", "arc_length"} <= set(poly.point_data)
    assert {"path", "family", "length", "bridged_length", "max_gap", "max_slip", "status"} <= set(poly.cell_data)
    assert (np.asarray(poly.cell_data["status"]) == 0).all()
    assert np.asarray(poly.points).dtype == np.float64


def test_report_agrees_with_the_files(tank: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    report = json.loads((tank[0] / "report.json").read_text())
    lengths = np.asarray(pv.read(tank[0] / "paths.vtp").cell_data["fibre_length"])
    quads = meshio.read(tank[0] / "quads.vtu")
    surface = np.load(tank[0] / "surface.npz")
    assert report["paths"]["length_total"] == pytest.approx(lengths.sum())
    assert report["crossings"]["count"] == pv.read(tank[0] / "crossings.vtp").n_points
    assert report["quads"]["quads"] == sum(len(c.data) for c in quads.cells if c.type == "quad")
    assert list(surface["control_points"].shape[:2]) == report["surface"]["control_points"]
    assert report["surface"]["flipped_triangles"] == 0
    assert report["winding"] == {"revolutions": 0.5, "paths_per_family": 12, "particles": 401, "friction": 0.0}
    assert report["command"].startswith("meshwind wind ")
    assert report["seconds"]["fit"] > 0


def test_surface_lies_on_the_mesh(tank: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    """The tank's own equation, (x^2 + y^2) / 60^2 + (z / 120)^6 = 1: the surface is closer to it than the facets."""
    P = meshio.read(tank[0] / "surface.vtu").points
    off = np.hypot(P[:, 0], P[:, 1]) - 60 * np.sqrt(np.maximum(1 - (P[:, 2] / 120) ** 6, 0))
    steep = np.abs(P[:, 2]) < 100
    assert np.abs(off[steep]).max() < 0.01


@pytest.mark.parametrize("given", [[], ["--units", ""]])
def test_lengths_are_in_millimetres_unless_the_unit_is_not_known(given: list[str], tmp_path: Path) -> None:
    done = meshwind("wind", DATA / "elbow.obj", "--out", tmp_path, "--paths", "3", "--no-render", *given)
    assert done.returncode == 0
    assert (" mm" in done.stdout) == (not given)
    assert json.loads((tmp_path / "report.json").read_text())["mesh"]["units"] == ("unknown" if given else "mm")


@pytest.mark.parametrize("arguments", [["wind", "--help"], ["wind", str(DATA / "tank.ply"), "--no-render"]])
def test_an_output_that_takes_no_more_exits_1_with_one_line(arguments: list[str], tmp_path: Path) -> None:
    with open("/dev/full", "w") as full:
        command = [sys.executable, "-m", "meshwind", *arguments]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=120, cwd=tmp_path)
    complaint = [line for line in done.stderr.splitlines() if not line.endswith("...")]
    assert done.returncode == 1
    assert complaint == ["meshwind: error: cannot write to standard output: No space left on device; send it elsewhere"]


def test_progress_that_cannot_be_shown_stops_nothing(tmp_path: Path) -> None:
    with open("/dev/full", "w") as full:
        command = [
            sys.executable,
            "-m",
            "meshwind",
            "wind",
            str(DATA / "tank.ply"),
            "--out",
            str(tmp_path),
            "--no-render",
        ]
        done = subprocess.run(command, stdout=subprocess.PIPE, stderr=full, text=True, timeout=120)
    assert done.returncode == 0
    assert "24 of 24 at rest" in done.stdout


def test_unsettled_paths_exit_3_and_are_named(tmp_path: Path) -> None:
    """Three turns do not hold on a closed part: files are written, and the report says which paths and why."""
    done = meshwind("wind", DATA / "tank.ply", "--out", tmp_path, "--paths", "3", "--revolutions", "3", "--no-render")
    assert done.returncode == 3
    report = json.loads((tmp_path / "report.json").read_text())
    status = np.asarray(pv.read(tmp_path / "paths.vtp").cell_data["status"])
    assert {f["path"] for f in report["paths"]["not_converged"]} == set(np.flatnonzero(status).tolist())
    assert all("revolutions" in f["why"] for f in report["paths"]["not_converged"])
    assert "not at rest" in done.stdout
    assert {file.name for file in tmp_path.iterdir()} == FILES


@pytest.mark.usefixtures("opengl")
def test_the_picture_is_not_blank(tmp_path: Path) -> None:
    done = from_outside("wind", DATA / "vase.stl", "--out", tmp_path, "--paths", "6", "--revolutions", "0.3")
    assert done.returncode == 0
    pixels = pv.read(tmp_path / "winding.png").active_scalars
    assert len(np.unique(np.asarray(pixels), axis=0)) > 1000
