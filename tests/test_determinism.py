"""The same input gives the same bytes in every data file for every run, number of threads and seed of hashes."""

import hashlib
import os
import subprocess
import sys
from pathlib import Path

import numba
import pytest

import meshwind as mw
from meshwind.exporting.formats import FORMATS
from meshwind.exporting.targets import TARGETS, ExportOptions, write_exports

DATA = Path(__file__).parents[1] / "data"
RUNS: dict[str, dict[str, float | str | None]] = {
    "vase.stl": {"revolutions": 0.8},
    "elbow.obj": {"revolutions": 0.3, "friction": 0.2},
    "tank.ply": {"particles": None},
}
"""Bridges; friction; particles that are chosen."""
THREADS = 1, 4


def leave(folder: Path) -> None:
    """Wind each of the parts once a number of threads, and export one."""
    for threads in THREADS:
        numba.set_num_threads(threads)
        for name, options in RUNS.items():
            out = folder / f"{name}-{threads}"
            mw.wind(DATA / name, out=out, render=False, paths=2, **{"particles": 51, **options})  # type: ignore[arg-type]
    write_exports(
        folder / "vase.stl-1", tuple(TARGETS), folder / "exports", ExportOptions(thickness=0.01, formats=tuple(FORMATS))
    )


def hashes(folder: Path) -> dict[str, str]:
    """Of every data file below a folder; only the report depends on the run, by its times and its command."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "report.json")
    return {str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() for path in files}


@pytest.fixture(scope="module")
def left(tmp_path_factory: pytest.TempPathFactory) -> list[Path]:
    """What two processes left that have nothing in common but their input."""
    folders = []
    for blas in (1, 4):
        folders.append(tmp_path_factory.mktemp("left"))
        variables = {"NUMBA_NUM_THREADS": "4", "OPENBLAS_NUM_THREADS": f"{blas}", "PYTHONHASHSEED": f"{blas}"}
        variables |= {"SOURCE_DATE_EPOCH": "1700000000"}  # STEP has the day
        command = [sys.executable, __file__, str(folders[-1])]
        subprocess.run(command, env=os.environ | variables, check=True, timeout=240)
    return folders


def test_two_runs_leave_the_same_bytes(left: list[Path]) -> None:
    one, other = map(hashes, left)
    assert one == other
    assert len(one) > 8 * len(RUNS) * len(THREADS) + 20


@pytest.mark.parametrize("name", RUNS)
def test_threads_change_no_byte(name: str, left: list[Path]) -> None:
    first, *others = (hashes(left[0] / f"{name}-{threads}") for threads in THREADS)
    assert len(first) == 9
    for other in others:
        assert other == first


if __name__ == "__main__":
    leave(Path(sys.argv[1]))
