"""Kernels are kept in files that survive whatever happens to the processes that write them."""

import ast
import os
import resource
import signal
import subprocess
import sys
import time
from importlib import import_module
from pathlib import Path
from random import Random

import numba
import pytest
from numba.core.dispatcher import Dispatcher

from meshwind.core.kernel import njit

ROOT = Path(__file__).parents[1]
SOURCE = """
from meshwind.core.kernel import njit
from meshwind.tried.inner import grown


@njit(nogil=True, cache=True)
def twice(x):
    return grown(x) + x
"""
INNER = """
from meshwind.core.kernel import njit
from meshwind.tried.numbers import STEP


@njit(cache=True)
def grown(x):
    return x + STEP
"""
NUMBERS = """
STEP = 1
"""
LONG = (
    INNER.replace("return", "x =")
    + "    "
    + "\n    ".join(f"x = x * x + {k} if x < {k} else x - {k}" for k in range(1, 60))
    + "\n    return x\n"
)
CALL = """
import sys, meshwind
meshwind.__path__.append(sys.argv[1])
from numba.core import event
compiled = []
class Seen(event.Listener):
    def on_start(self, event): compiled.append(event.data["dispatcher"].py_func.__name__)
    def on_end(self, event): pass
event.register("numba:compile", Seen())
from meshwind.tried.outer import twice
print(twice(2), twice(2.5), len(compiled))
"""


@pytest.fixture
def tried(tmp_path: Path) -> Path:
    """A folder with a package `tried` of two kernels, of which one calls the other."""
    package = tmp_path / "tried"
    package.mkdir()
    for name, text in (("__init__", ""), ("outer", SOURCE), ("inner", INNER), ("numbers", NUMBERS)):
        (package / f"{name}.py").write_text(text)
    return tmp_path


def start(tried: Path, kept: Path | None, code: str = CALL, **options: object) -> "subprocess.Popen[str]":
    environment = dict(
        os.environ, PYTHONPATH=str(ROOT), XDG_CACHE_HOME=str(tried / "user"), PYTHONDONTWRITEBYTECODE="1"
    )
    environment.pop("NUMBA_CACHE_DIR", None)
    if kept is not None:
        environment["NUMBA_CACHE_DIR"] = str(kept)
    return subprocess.Popen(
        [sys.executable, "-c", code, str(tried)],
        env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, **options,  # type: ignore[call-overload]
    )  # fmt: skip


def call(tried: Path, kept: Path | None, **options: object) -> tuple[str, str]:
    """What such a process prints: two results and the number of kernels that it compiled, and warnings."""
    out, err = start(tried, kept, **options).communicate(timeout=300)  # type: ignore[arg-type]
    return out.strip(), err


def files(kept: Path) -> list[Path]:
    return sorted(kept.rglob("*.nbc"))


def test_kernels_are_kept_and_compiled_anew_when_they_or_what_they_call_change(tried: Path) -> None:
    kept = tried / "kept"
    assert call(tried, kept) == ("5 6.0 4", "")
    assert len(files(kept)) == 4
    assert call(tried, kept) == ("5 6.0 0", "")
    inner = tried / "tried" / "inner.py"
    stamp = inner.stat().st_mtime_ns
    inner.write_text(INNER.replace("x + STEP", "STEP - x"))  # same size, same time
    assert inner.stat().st_size == len(INNER)
    os.utime(inner, ns=(stamp, stamp))
    assert call(tried, kept) == ("1 1.0 4", "")
    inner.write_text(INNER)
    (tried / "tried" / "numbers.py").write_text(NUMBERS.replace("1", "3"))  # a module without kernels
    assert call(tried, kept) == ("7 8.0 4", "")


def test_a_damaged_file_is_compiled_anew(tried: Path) -> None:
    kept = tried / "kept"
    call(tried, kept)
    rng = Random(1)
    for file in files(kept):
        whole = bytearray(file.read_bytes())
        if rng.random() < 0.5:
            whole = whole[: rng.randrange(len(whole))]
        else:
            whole[rng.randrange(len(whole))] ^= 0xFF
        file.write_bytes(whole)
    assert call(tried, kept) == ("5 6.0 4", "")
    assert call(tried, kept) == ("5 6.0 0", "")


def test_many_at_a_time_and_killed_at_any_moment(tried: Path) -> None:
    kept, rng = tried / "kept", Random(2)
    for _ in range(4):
        together = [start(tried, kept) for _ in range(2)]
        # once the first file appears, the others follow within fractions of a second
        end = time.monotonic() + 60.0
        while not files(kept) and time.monotonic() < end and together[0].poll() is None:
            time.sleep(0.005)
        time.sleep(rng.uniform(0.0, 0.2))
        together[0].send_signal(signal.SIGKILL)
        assert together[1].communicate(timeout=300)[0].startswith("5 6.0 ")
        together[0].communicate()
        assert call(tried, kept) == ("5 6.0 0", "")
        for file in files(kept):
            file.unlink()


def test_a_folder_that_takes_nothing_is_told_once_and_not_fatal(tried: Path) -> None:
    barred = tried / "barred"
    barred.write_text("a file where the folder should be")
    out, err = call(tried, barred)
    assert out == "5 6.0 4"
    assert err.count("cannot be kept") == 1 and "NUMBA_CACHE_DIR" in err


def test_a_full_disk_is_told_once_and_not_fatal(tried: Path) -> None:
    def full() -> None:
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))

    kept = tried / "kept"
    out, err = call(tried, kept, preexec_fn=full)
    assert out == "5 6.0 4"
    assert err.count("cannot be kept") == 1
    assert files(kept) == []
    assert call(tried, kept) == ("5 6.0 4", "")


def test_kernels_beside_the_sources_are_used_where_they_cannot_be_written(tried: Path) -> None:
    """As in an image whose kernels were compiled by another user."""
    assert call(tried, None) == ("5 6.0 4", "")
    beside = tried / "tried" / "__pycache__"
    assert len(files(beside)) == 4
    held = beside.rename(tried / "tried" / "held")
    beside.write_text("")  # root may write to any folder, but not into a file
    assert call(tried, None) == ("5 6.0 4", "")
    assert len(files(tried / "user")) == 4
    beside.unlink()
    held.rename(beside)
    for file in files(tried / "user"):
        file.unlink()
    assert call(tried, None) == ("5 6.0 0", "")


def test_a_long_kernel_is_compiled_once_and_found_by_those_that_call_it(tried: Path) -> None:
    """Also where its file was lost, or is of a process that named it otherwise."""
    kept, inner = tried / "kept", tried / "tried" / "inner.py"
    inner.write_text(LONG)
    first, err = call(tried, kept)
    assert first.endswith(" 4") and err == ""
    sizes = {name: [len(file.read_bytes()) for file in files(kept) if name in file.name] for name in ("outer", "inner")}
    assert max(sizes["outer"]) < 0.5 * min(sizes["inner"])
    results = first.rsplit(" ", 1)[0]
    assert call(tried, kept) == (f"{results} 0", "")
    for file in kept.rglob("inner*.nbc"):
        file.unlink()
    assert call(tried, kept) == (f"{results} 2", "")  # under the same names: those that call them are as they were
    for file in kept.rglob("inner*.nbc"):
        file.unlink()
    taken = CALL.replace(
        "compiled = []",
        """compiled = []
from meshwind.tried import inner
from meshwind.core import kernel_library
kernel_library.sources = lambda module: "others"
""",
    )
    out, err = start(tried, kept, code=taken).communicate(timeout=300)
    assert out.strip() == f"{results} 4" and err == ""


def test_kernels_of_kernels_can_be_called_by_python_and_know_no_literals() -> None:
    @njit()
    def inner(x: int, y: float) -> float:
        return x + y

    @njit(nogil=True)
    def outer(x: int) -> float:
        return inner(1, 2.0) + inner(x, 2.0)

    assert outer(1) == 6.0
    assert inner.signatures == [(numba.int64, numba.float64)]
    assert inner(3, 2.0) == 5.0 and inner(3, 2.5) == 5.5
    assert inner(y=1.0, x=2.0) == 3.0
    assert len(inner.signatures) == 2


def test_kernels_that_python_calls_are_declared_so() -> None:
    """They have `nogil`: those without it are called by a way round."""
    told = []
    for file in sorted((ROOT / "meshwind").rglob("*.py")):
        text = file.read_text(encoding="utf-8")
        if "__main__" in file.name:
            continue
        module = import_module(".".join(file.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"))
        kernels = {name: each for name, each in vars(module).items() if isinstance(each, Dispatcher)}
        for function in ast.parse(text).body:
            own = kernels.get(getattr(function, "name", ""))
            if own is not None and own.py_func.__module__ == module.__name__:
                continue
            nodes = [node for node in ast.walk(function) if isinstance(node, ast.Name)]
            names = {node.id for node in nodes} - {node.id for node in nodes if isinstance(node.ctx, ast.Store)}
            through = [node for node in ast.walk(function) if isinstance(node, ast.Attribute)]
            others = [getattr(vars(module).get(getattr(node.value, "id", "")), node.attr, None) for node in through]
            called = [each for each in others if isinstance(each, Dispatcher)]
            told += [f"{file}: {each}" for each in called if not each.targetoptions["nogil"]]
            told += [f"{file}: {n}" for n in names & set(kernels) if not kernels[n].targetoptions["nogil"]]
    assert not told
