"""The table of kernels that are compiled ahead fits the kernels that there are."""

import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from numba.core.dispatcher import Dispatcher

from meshwind.cli import main
from meshwind.core import compile_ahead
from meshwind.core.compile_ahead import JOBS, table
from meshwind.core.kernel_types import from_text, to_text

ROOT = Path(__file__).parents[1]
RECORD = "run NUMBA_CACHE_DIR=$(mktemp -d) python examples/record_kernels.py"
LOADED = """
import json, sys
from meshwind.core import kernel_files
from meshwind.core.kernel_types import to_text
used = []
load = kernel_files.KernelFiles.load_overload
def seen(self, sig, context):
    f = self._py_func
    used.append([f.__module__, f.__qualname__, [to_text(each) for each in sig]])
    return load(self, sig, context)
kernel_files.KernelFiles.load_overload = seen
import meshwind
meshwind.wind(sys.argv[1], paths=2, particles=51, revolutions=0.8, out=sys.argv[2], render=False)
print(json.dumps(used))
"""


def called(kernel: Dispatcher) -> set[tuple[str, str]]:
    """The kernels that a kernel calls."""
    named = (kernel.py_func.__globals__.get(name) for name in kernel.py_func.__code__.co_names)
    return {(each.py_func.__module__, each.py_func.__qualname__) for each in named if isinstance(each, Dispatcher)}


def test_types_come_back_as_they_were() -> None:
    for kernel in table():
        for text in kernel.types:
            assert json.loads(json.dumps(to_text(from_text(text)))) == text


def test_kernels_are_kept_by_files_of_their_own() -> None:
    for file in (ROOT / "meshwind").rglob("*.py"):
        assert "from numba import njit" not in file.read_text(encoding="utf-8"), f"{file}: take that of core.kernel"


def test_what_a_kernel_calls_comes_before_it_in_the_table() -> None:
    before: set[tuple[str, str]] = set()
    for number, kernel in enumerate(table()):
        assert isinstance(kernel.compiled, Dispatcher), f"{kernel.module} has no {kernel.name} any more: {RECORD}"
        assert kernel.job in JOBS and max(kernel.calls, default=-1) < number
        before.add((kernel.module, kernel.name))
        missing = {name for name in called(kernel.compiled) if name not in before}
        assert not missing, f"{kernel.name} calls {missing}, which are not in the table: {RECORD}"


def test_a_run_uses_no_kernel_that_is_not_in_the_table(tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", LOADED, str(ROOT / "data/vase.stl"), str(tmp_path / "out")],
        capture_output=True, text=True, check=True, env=dict(os.environ, PYTHONPATH=str(ROOT)),
    )  # fmt: skip
    known = {(kernel.module, kernel.name, json.dumps(kernel.types)) for kernel in table()}
    used = {(module, name, json.dumps(types)) for module, name, types in json.loads(done.stdout.splitlines()[-1])}
    assert len(used) > 20
    assert not used - known, RECORD


def test_processes_that_end_leave_their_kernels_to_the_run(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "executable", "/bin/false")
    told: list[str] = []
    compile_ahead._Pool([0, 1, 2], told.append).run(2)  # and does not wait for ever
    assert told[0] == "compiling kernels for this machine once, 0 of 3"


def test_the_same_number_is_not_said_twice(monkeypatch: pytest.MonkeyPatch) -> None:
    def slowly(*_: object) -> bool:
        time.sleep(0.1)
        return True

    told: list[str] = []
    monkeypatch.setattr(compile_ahead, "EVERY", 0.01)
    monkeypatch.setattr(compile_ahead._Worker, "compile", slowly)
    compile_ahead._Pool([0, 1, 2], told.append).run(1)
    assert len(told) == len(set(told)) > 1


def _ended(monkeypatch: pytest.MonkeyPatch, found: Callable[..., int]) -> int:
    """The exit status of `meshwind compile` that finds 3 kernels which could not be kept."""
    monkeypatch.setattr(compile_ahead, "compile_ahead", found)
    monkeypatch.setattr(compile_ahead, "left_out", lambda: 3)
    monkeypatch.setattr(sys, "argv", ["meshwind", "compile", "--quiet"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert isinstance(ended.value.code, int)
    return ended.value.code


def test_kernels_that_a_full_folder_does_not_take_are_an_error_of_compile(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert _ended(monkeypatch, lambda **_: 4) == 2
    assert capsys.readouterr().err.startswith("meshwind: error: 3 kernels could not be compiled or kept")


def test_too_little_memory_is_told_in_one_line(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def full(**_: object) -> int:
        raise MemoryError("Unable to allocate 42 GiB")

    assert _ended(monkeypatch, full) == 2
    assert capsys.readouterr().err.startswith("meshwind: error: out of memory: Unable to allocate 42 GiB; give fewer")


ENTRIES = """
from meshwind.core import compile_ahead
few = [k for k in range(len(compile_ahead.table())) if compile_ahead.table()[k].module.startswith("meshwind.layup")]
compile_ahead._missing = lambda jobs, missing=compile_ahead._missing: [k for k in missing(jobs) if k in few]
print(len(few), compile_ahead.compile_ahead(worth=0.0), compile_ahead.left_out())
"""


def test_two_at_a_time_and_killed_leave_what_the_next_one_ends(tmp_path: Path) -> None:
    environment = dict(os.environ, PYTHONPATH=str(ROOT), NUMBA_CACHE_DIR=str(tmp_path))

    def start() -> "subprocess.Popen[str]":
        return subprocess.Popen([sys.executable, "-c", ENTRIES], env=environment, stdout=subprocess.PIPE, text=True)

    killed, other = start(), start()
    while not list(tmp_path.rglob("*.nbc")) and killed.poll() is None:
        time.sleep(0.02)
    killed.kill()
    killed.communicate()
    few, _, left = (int(word) for word in other.communicate()[0].split())
    assert few > 2 and left == 0
    assert start().communicate()[0].split() == [str(few), "0", "0"]


def test_a_folder_that_cannot_be_written_is_an_error_of_compile_alone(tmp_path: Path) -> None:
    barred = tmp_path / "barred"
    barred.write_text("a file where the folder should be")
    environment = dict(os.environ, PYTHONPATH=str(ROOT), NUMBA_CACHE_DIR=str(barred))
    done = subprocess.run(
        [sys.executable, "-m", "meshwind", "compile", "--json"],
        env=environment, capture_output=True, text=True, check=False,
    )  # fmt: skip
    assert done.returncode == 2 and done.stdout == ""
    assert "NUMBA_CACHE_DIR" in json.loads(done.stderr)["error"]
    ahead = "from meshwind.core.compile_ahead import compile_ahead; print(compile_ahead() > 100)"
    done = subprocess.run([sys.executable, "-c", ahead], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout == "True\n"
