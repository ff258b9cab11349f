"""A full disk and a read-only folder: one line, and nothing is written, moved or lost."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

DATA = Path(__file__).parents[1] / "data"
WIND = f"{sys.executable} -m meshwind wind {DATA / 'tank.ply'} --paths 2 --particles 101 --no-render"
APART = ["unshare", "--mount", *([] if os.geteuid() == 0 else ["--map-root-user"])]
"""A folder on which a test may mount a file system that ends with its process."""


def run(script: str, folder: Path, apart: bool = True) -> tuple[int, list[str], list[str]]:
    """Exit status of a shell script, its complaints and what it printed, without the stages."""
    command = [*(APART if apart else []), "bash", "-c", script]
    done = subprocess.run(command, capture_output=True, text=True, timeout=240, cwd=folder)
    complaints = [line for line in done.stderr.splitlines() if not line.endswith("...")]
    return done.returncode, complaints, done.stdout.splitlines()


def mounts() -> bool:
    """Whether this machine lets a test mount."""
    return subprocess.run([*APART, "true"], capture_output=True, timeout=60).returncode == 0


@pytest.fixture(scope="module")
def results(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder out with results and a file of someone else's, in a folder of its own."""
    folder = tmp_path_factory.mktemp("results")
    status, *lines = run(f"{WIND} --out out", folder, apart=False)
    assert status == 0, lines
    (folder / "out" / "notes.txt").write_text("mine")
    return folder


def held(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in (folder / "out").iterdir()}


@pytest.mark.parametrize("size", ["8k", "400k", "2200k"])
def test_a_full_disk_is_reported_in_one_line_and_left_as_it_was(size: str, tmp_path: Path) -> None:
    """On a small disk in memory or, where none can be mounted, with a limit on the size of files."""
    made = f"mount -t tmpfs -o size={size} tmpfs {tmp_path}" if mounts() else f"ulimit -f {int(size[:-1]) // 4}"
    script = f"{made} && cd {tmp_path} && {WIND} --out out; status=$?; find .; exit $status"
    status, complaints, found = run(script, tmp_path, mounts())
    assert status == 2
    assert len(complaints) == 1
    assert complaints[0].startswith("meshwind: error: cannot write to out: ")
    assert complaints[0].endswith("; give another folder")
    assert found == ["."]


@pytest.mark.parametrize("kilobytes", [4, 500])
def test_a_file_that_may_not_grow_leaves_the_old_results(kilobytes: int, results: Path) -> None:
    before = held(results)
    script = f"ulimit -f {kilobytes}; {WIND} --paths 3 --out out --overwrite"
    status, complaints, _ = run(script, results, apart=False)
    assert status == 2
    assert complaints == ["meshwind: error: cannot write to out: File too large; give another folder"]
    assert held(results) == before


def test_a_read_only_folder_is_refused_before_any_work(tmp_path: Path) -> None:
    """Mounted read-only, as permission bits do not stop root; without mounts it is a folder of the kernel's."""
    (tmp_path / "out").mkdir()
    (tmp_path / "out" / "notes.txt").write_text("mine")
    if mounts():
        made, out = "mount -o bind out out && mount -o remount,ro,bind out", "out"
    else:
        made, out = "true", "/proc/self"
    for target in (out, f"{out}/far/new"):
        status, complaints, printed = run(f"{made} && {WIND} --out {target}", tmp_path, mounts())
        assert (status, printed) == (2, [])
        assert len(complaints) == 1
        assert complaints[0].startswith(f"meshwind: error: cannot write to {target}: ")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["notes.txt"]


def test_results_are_replaced_only_on_demand(results: Path) -> None:
    before = held(results)
    status, complaints, printed = run(f"{WIND} --paths 3 --out out", results, apart=False)
    assert (status, printed) == (2, [])
    assert complaints == [
        "meshwind: error: out holds results already (bridges.vtp, chart.png, ...); "
        "give another folder, or --overwrite to replace them"
    ]
    assert held(results) == before
    assert run(f"{WIND} --paths 3 --out out --overwrite", results, apart=False)[0] == 0
    after = held(results)
    assert after.keys() == before.keys()
    assert after["notes.txt"] == b"mine" and after["paths.vtp"] != before["paths.vtp"]
