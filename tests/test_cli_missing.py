"""What a machine lacks stops only what needs it, and one line says what to install."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from command import meshwind
from export_results import waisted_results

DATA = Path(__file__).parents[1] / "data"
WITHOUT = """
import sys
sys.modules.update({{name: None for name in {names!r}}})
from meshwind.cli import main
main()
"""
"""Python takes a module that is None for one that is not installed."""


def blind(*arguments: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run where EGL finds no driver."""
    command = [sys.executable, "-m", "meshwind", *map(str, arguments)]
    environment = os.environ | {
        "__EGL_VENDOR_LIBRARY_DIRS": str(folder / "none"), "VTK_DEFAULT_OPENGL_WINDOW": "vtkEGLRenderWindow",
    }  # fmt: skip
    return subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment)


NO_DRIVER = (
    "no picture: VTK found no OpenGL driver on this machine; install one "
    "(Debian: apt-get install libegl1 libgl1-mesa-dri)"
)


def test_without_a_driver_everything_but_pictures_is_written(tmp_path: Path) -> None:
    out = tmp_path / "run"
    done = blind("wind", DATA / "tank.ply", "--paths", "2", "--out", out, "--quiet", folder=tmp_path)
    assert (done.returncode, done.stdout) == (0, "")
    assert done.stderr == f"meshwind: warning: {NO_DRIVER}\n"
    assert len(list(out.iterdir())) == 10
    assert {file.name for file in out.glob("*.png")} == {"chart.png"}


def test_without_a_driver_render_says_what_to_install(tmp_path: Path) -> None:
    waisted_results(tmp_path)
    done = blind("render", tmp_path, "--quiet", folder=tmp_path)
    assert done.returncode == 2
    assert done.stderr == f"meshwind: error: {NO_DRIVER}\n"
    assert {file.name for file in tmp_path.glob("*.png")} == {"chart.png"}


def lacking(names: tuple[str, ...], *arguments: str | Path) -> subprocess.CompletedProcess[str]:
    """Run where Python modules, and all other programs, are missing."""
    command = [sys.executable, "-c", WITHOUT.format(names=names), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, timeout=120, env=os.environ | {"PATH": ""})


@pytest.mark.parametrize(("module", "arguments", "remedy"), [
    ("OCP", ["export", "--to", "inp,step", "--thickness", "0.01"], "pip install 'meshwind[cad]'"),
    ("imageio_ffmpeg", ["render", "--animate", "mp4", "--quiet"], 'ffmpeg; or: pip install "meshwind[movie]"'),
])  # fmt: skip
def test_what_is_not_installed_is_named_with_its_remedy(
    module: str, arguments: list[str], remedy: str, tmp_path: Path
) -> None:
    waisted_results(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    done = lacking((module,), *arguments, tmp_path)
    assert done.returncode == 2
    assert done.stdout == ""
    assert len(done.stderr.splitlines()) == 1
    assert remedy in done.stderr
    assert sorted(tmp_path.rglob("*")) == before


def test_info_lists_what_is_missing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("__EGL_VENDOR_LIBRARY_DIRS", str(tmp_path))
    monkeypatch.setenv("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
    done = lacking(("OCP", "imageio_ffmpeg"), "info")
    assert done.returncode == 0
    assert f"pictures  {NO_DRIVER}" in done.stdout
    for remedy in ("meshwind[cad]", "meshwind[movie]"):
        assert f'pip install "{remedy}"' in done.stdout


@pytest.mark.parametrize("arguments", [
    ["wind", "none.stl"], ["redesign", "none.stl"], ["redesign", "part.ply", "--layers", "none.toml"],
    ["wind", "part.ply", "--pins", "none.csv"], ["wind", "part.ply", "--layers", "none.toml"], ["sweep", "none.toml"],
])  # fmt: skip
def test_a_file_that_does_not_exist_is_told_before_the_folder_that_does(arguments: list[str], tmp_path: Path) -> None:
    shutil.copy(DATA / "tank.ply", tmp_path / "part.ply")
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "report.json").write_text("{}")
    done = meshwind(*arguments, "--out", "out", folder=tmp_path)
    assert done.returncode == 2 and "none." in done.stderr and "holds results" not in done.stderr
