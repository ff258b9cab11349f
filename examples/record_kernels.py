"""Write `meshwind/core/kernels.json`: the kernels that the commands compile, found by running them all in one process.

Nothing may be compiled yet: the folder of NUMBA_CACHE_DIR must be empty.  Takes some minutes, in which nothing is
compiled ahead.

    NUMBA_CACHE_DIR=$(mktemp -d) python examples/record_kernels.py
"""

import json
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import trimesh
from numba.core import event
from numba.core.dispatcher import Dispatcher

import meshwind as mw
from meshwind.core.compile_ahead import JOBS, TABLE
from meshwind.core.kernel_types import to_text

DATA = Path(__file__).parents[1] / "data"
SMALL: dict[str, Any] = {"paths": 2, "particles": 51, "render": False}


class Recorder(event.Listener):  # type: ignore[misc]
    """Each kernel that is compiled, with its own seconds and the job that it is for."""

    def __init__(self) -> None:
        self.job = ""
        self.rows: list[dict[str, Any]] = []
        self._open: list[list[Any]] = []

    def on_start(self, event: Any) -> None:
        """A kernel begins, perhaps within another one."""
        self._open.append([event.data["dispatcher"].py_func, event.data["args"], time.process_time(), 0.0])

    def on_end(self, event: Any) -> None:  # noqa: ARG002  (the name is that of the base class)
        """It is done."""
        function, args, start, within = self._open.pop()
        taken = time.process_time() - start
        if self._open:
            self._open[-1][3] += taken
        if function.__module__.startswith("meshwind."):
            self.rows.append({"function": function, "args": args, "job": self.job, "seconds": taken - within})


def called(kernel: Any) -> set[Any]:
    """The functions of the kernels that a kernel calls."""
    named = (kernel.__globals__.get(name) for name in kernel.__code__.co_names)
    return {other.py_func for other in named if isinstance(other, Dispatcher)}


def spiked(file: str) -> trimesh.Trimesh:
    """A mesh with a vertex in the middle pulled out, which no fit follows."""
    mesh = trimesh.load(file, force="mesh")
    high = mesh.vertices[:, 2]
    mesh.vertices[np.argmin(np.abs(high - high.mean())), :2] *= 1.1
    return mesh


def run(job: str, folder: Path) -> None:
    """What a job of `JOBS` compiles for."""
    vase = str(DATA / "vase.stl")
    if job == "wind":
        mw.wind(vase, out=folder / job, render=False, revolutions=0.8)
    elif job == "auto":
        mw.wind(str(DATA / "tank.ply"), out=folder / job, revolutions="auto", **SMALL)
    elif job == "coarse":
        mw.wind(str(DATA / "wing.stl"), revolutions=0.5, **SMALL)  # of few facets
        mw.wind(spiked(vase), revolutions=0.8, **SMALL)
    elif job == "friction":
        mw.wind(vase, out=folder / job, friction=0.2, revolutions=0.8, **SMALL)
    elif job == "continuous":
        mw.wind(vase, out=folder / job, continuous=True, band_width=8.0, friction=0.2, **(SMALL | {"paths": 6}))
    elif job == "program":
        sys.argv = ["meshwind", "program", str(folder / "continuous"), "--quiet"]
        from meshwind.cli import main

        try:
            main()
        except SystemExit as end:
            print(job, "ended with", end.code)
    else:
        mw.redesign(vase, paths=2, revolutions=0.8, particles=51)


def write(rows: list[dict[str, Any]]) -> None:
    """Write the table; types that several kernels share are written once."""
    kinds: list[Any] = []
    lines = []
    for number, row in enumerate(rows):
        texts = [json.loads(json.dumps(to_text(each))) for each in row["args"]]
        kinds += [text for k, text in enumerate(texts) if text not in kinds and text not in texts[:k]]
        mine = called(row["function"])
        calls = [k for k, other in enumerate(rows[:number]) if other["function"] in mine]
        lines.append(json.dumps({
            "module": row["function"].__module__, "name": row["function"].__qualname__, "job": row["job"],
            "types": [kinds.index(text) for text in texts], "calls": calls, "seconds": round(row["seconds"], 1),
        }))  # fmt: skip
    shown = ",\n  ".join(json.dumps(kind) for kind in kinds), ",\n  ".join(lines)
    TABLE.write_text(f'{{"types": [\n  {shown[0]}\n], "kernels": [\n  {shown[1]}\n]}}\n', encoding="utf-8")
    print(len(rows), "kernels,", round(sum(row["seconds"] for row in rows), 1), "s")


def main() -> None:
    """Run the jobs and write what they compile."""
    recorder = Recorder()
    event.register("numba:compile", recorder)
    write([])  # what the table lists is compiled by other processes, unseen
    with TemporaryDirectory() as folder:
        for job in JOBS:
            recorder.job = job
            start, before = time.process_time(), len(recorder.rows)
            try:
                run(job, Path(folder))
            except mw.BadInputError as error:
                print(job, error)
            print(job, len(recorder.rows) - before, "kernels", round(time.process_time() - start, 1), "s", flush=True)
            write(recorder.rows)


if __name__ == "__main__":
    main()
