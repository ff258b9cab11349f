"""Runs that are killed with SIGKILL while they write; run as a script, for children are forked.

    steps DIR            at each call to the file system, into a folder with results and into one that is not there
    moments DIR COUNT    at random times while real results are written

Prints what was seen as JSON, a list of `Sight`, one a kill.
"""

import hashlib
import json
import os
import random
import shutil
import signal
import sys
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import meshwind as mw
from meshwind.results.folder import prepare, writing

FOREIGN = "notes.txt"
_CALLS = ("open", "os.mkdir", "os.rename", "os.remove", "os.rmdir", "os.listdir", "os.scandir", "shutil.rmtree")


@dataclass(frozen=True)
class Sight:
    """A folder after a kill and after the next run's start: files by name with what they hold.

    hidden: what the next run left of the killed one's hidden folders.
    """

    killed: bool
    first: dict[str, str]
    then: dict[str, str]
    hidden: list[str]


def visible(out: Path) -> dict[str, str]:
    """Of each file its text if it is short, or else its hash."""
    files = sorted(path for path in out.iterdir() if not path.name.startswith(".")) if out.is_dir() else []
    told = {path.name: path.read_bytes() for path in files}
    return {name: data.decode() if len(data) < 100 else hashlib.sha256(data).hexdigest() for name, data in told.items()}


def killed(work: Callable[[], object], out: Path, after: float | None = None) -> Sight:
    """Let a child work, kill it after so many seconds if it does not kill itself, and look."""
    child = os.fork()
    if child == 0:
        try:
            work()
        finally:
            os._exit(0)
    if after is not None:
        time.sleep(after)
        os.kill(child, signal.SIGKILL)
    _, status = os.waitpid(child, 0)
    first = visible(out)
    prepare(out, overwrite=True)
    hidden = [path.name for path in (*out.parent.glob(".*"), *out.glob(".*"))]
    return Sight(os.WIFSIGNALED(status), first, visible(out), hidden)


def write(out: Path, content: str, names: tuple[str, ...]) -> None:
    with writing(out, overwrite=True) as staging:
        for name in names:
            (staging / name).write_text(content)


def steps(folder: Path, there: bool) -> list[Sight]:
    """Kill at the first call to the file system, at the second, and so on until the run gets through."""
    seen: list[Sight] = []
    while not seen or seen[-1].killed:
        out = folder / f"{there}-{len(seen)}" / "out"
        out.parent.mkdir()
        if there:
            write(out, "old", ("paths.vtp", "winding.png", "report.json"))
            (out / FOREIGN).write_text("mine")

        def work(out: Path = out, left: int = len(seen)) -> None:
            def step(event: str, _: Any) -> None:
                nonlocal left
                if event not in _CALLS:
                    return
                left -= 1
                if left < 0:
                    os.kill(os.getpid(), signal.SIGKILL)

            sys.addaudithook(step)
            write(out, "new", ("paths.vtp", "bridges.vtp", "report.json"))
            left = 1 << 30

        seen.append(killed(work, out))
    return seen


def moments(folder: Path, count: int) -> tuple[list[dict[str, str]], list[Sight]]:
    """What two results hold, and sights of one written over the other, every other time where there is none yet."""
    tank = Path(__file__).parents[1] / "data" / "tank.ply"
    results = [mw.wind(tank, paths=paths, particles=101) for paths in (2, 3)]
    whole, took = [], 0.0
    for k, result in enumerate(results):
        result.write(folder / f"whole-{k}" / "out", render=False)  # as deep as the others: meshwind.toml tells the way
        start = time.perf_counter()
        result.write(folder / f"again-{k}" / "out", render=False)  # what is worked out once is known by now
        took = time.perf_counter() - start
        whole.append(visible(folder / f"whole-{k}" / "out"))
    seen, random_time = [], random.Random(1)
    out = folder / "killed" / "out"
    out.parent.mkdir()
    for k in range(count):
        if k % 2:
            shutil.rmtree(out)
        elif not out.exists():
            results[0].write(out, render=False)
        held = results[(k // 2 + 1) % 2]
        seen.append(
            killed(lambda held=held: held.write(out, False, True), out, random_time.uniform(0, 1.3 * took))  # type: ignore[misc]
        )
        out.mkdir(exist_ok=True)
    return whole, seen


if __name__ == "__main__":
    place = Path(sys.argv[2])
    if sys.argv[1] == "steps":
        json.dump([[asdict(sight) for sight in steps(place, there)] for there in (True, False)], sys.stdout)
    else:
        whole, seen = moments(place, int(sys.argv[3]))
        json.dump([whole, [asdict(sight) for sight in seen]], sys.stdout)
