"""What a user waits for: the first run on a new machine, the second one, and what a peer takes, in pairs.

    python examples/first_run.py --out out/first_run
    python examples/first_run.py --out out/first_run --against OTHER/bin/python --faces 1000000 --paths 10000

The run is that of the README's first line, from the mesh to files and pictures, each in a process of its own.  A first
run finds no compiled kernel; Python's own bytecode is there, as pip leaves it.  Beside it stand the libraries FlipOut
(potpourri3d) and pygeodesic, which read the same mesh and find as many polyhedral geodesics on it, without files and
pictures, and PyVista, which reads it and draws one picture.  With --against the same runs are made with the meshwind of
another environment, by turns, as a shared machine's speed drifts.  --faces adds a mesh of so many faces, wound without
pictures, and --paths a winding of so many paths, both --large-runs times.  Writes first_run.csv, a row a run, and
first_run_medians.csv, whose ratios are medians over the pairs.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import median
from typing import Any

from benchmarks.command import Cost, run
from charts.record import Results
from comparison.parts import VASE, irregular, write_ply

DATA = Path(__file__).parents[1] / "data"
MESH = DATA / "vase.stl"
WINDING = ("--paths", "12", "--revolutions", "0.8", "--units", "mm")
PEERS = Path(__file__).parent / "comparison" / "peer_run.py"
OURS, OTHER = "meshwind", "before"


@dataclass(frozen=True)
class Place:
    """An environment's Python, and a folder for its bytecode, kernels and results."""

    who: str
    python: str
    folder: Path

    @property
    def env(self) -> dict[str, str]:
        """Its environment variables: another environment must not find the modules of this one."""
        env = {key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"}
        if self.who == OTHER:
            env.pop("PYTHONPATH", None)
        return env | {"PYTHONPYCACHEPREFIX": str(self.folder / "bytecode"), "MPLBACKEND": "Agg"}

    def wind(self, mesh: Path, kernels: str, *options: str) -> Cost:
        """Wind a mesh, with kernels that are kept in a folder of that name."""
        command = [self.python, "-m", "meshwind", "wind", str(mesh), "--out", str(self.folder / "out"), "--overwrite"]
        env = self.env | {"NUMBA_CACHE_DIR": str(self.folder / kernels)}
        return run([*command, *options], env, str(self.folder))

    def version(self) -> str:
        """The version of its meshwind."""
        command = [self.python, "-c", "import meshwind; print(meshwind.__version__)"]
        found = subprocess.run(command, env=self.env, cwd=self.folder, capture_output=True, text=True, check=True)
        return found.stdout.strip()

    def first(self, number: int) -> dict[str, Cost]:
        """A first run, and the runs after it."""
        kernels = f"kernels-{number}"
        return {
            "first run": self.wind(MESH, kernels, *WINDING),
            "second run": self.wind(MESH, kernels, *WINDING),
            "without pictures": self.wind(MESH, kernels, *WINDING, "--no-render"),
        }


def peers(place: Place) -> dict[str, Cost]:
    """A run of each peer on the same mesh."""
    names = ("flipout", "pygeodesic", "pyvista")
    return {name: run([place.python, str(PEERS), name, str(MESH), WINDING[1]], place.env) for name in names}


def large(places: Sequence[Place], work: Path, faces: int, paths: int, runs: int) -> list[dict[str, Any]]:
    """Rows of runs with many faces, without pictures, and with many paths."""
    jobs: dict[str, tuple[int, tuple[str, ...]]] = {}
    if faces:
        jobs["many faces"] = faces, ("--paths", "100", "--revolutions", "0.5", "--no-render")
    if paths:
        few = ("--paths", str(paths // 2), "--revolutions", repr(min(100.0 / paths, 0.5)))
        jobs["many paths"] = 10_000, few
        jobs["many paths without pictures"] = 10_000, (*few, "--no-render")
    rows = []
    for job, (count, options) in jobs.items():
        mesh = work / f"vase-{count}.ply"
        if not mesh.exists():
            write_ply(mesh, *irregular(VASE, count))
        for number in range(runs):
            rows += [told(job, each.who, number, each.wind(mesh, "kernels-0", *options)) for each in places]
    return rows


def told(job: str, who: str, number: int, cost: Cost) -> dict[str, Any]:
    """A row, which is printed."""
    print(f"{number}: {job}, {who}: {cost.seconds:.2f} s ({cost.processor_seconds:.2f} s of a core), "
          f"{cost.memory / 1e9:.2f} GB", flush=True)  # fmt: skip
    return {"job": job, "who": who, "run": number, **cost._asdict()}


def medians(rows: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """A row for each job and who ran it; ratios are ours over the other's of the same number."""
    out = []
    for job, who in dict.fromkeys((row["job"], row["who"]) for row in rows):
        mine = [row for row in rows if (row["job"], row["who"]) == (job, who)]
        made: dict[str, Any] = {"job": job, "who": who, "runs": len(mine)}
        for key in Cost._fields:
            values = [row[key] for row in mine]
            made |= {key: median(values), f"{key} least": min(values), f"{key} most": max(values)}
            pairs = [
                row[key] / other[key]
                for row in mine
                for other in rows
                if other["who"] == OTHER and (other["job"], other["run"]) == (job, row["run"])
            ]
            made[f"{key} ratio"] = median(pairs) if pairs and who == OURS else ""
        out.append(made)
    return out


def main() -> None:
    """Measure, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/first_run"), help="folder for the tables")
    parser.add_argument("--runs", type=int, default=7, help="times that each is run")
    parser.add_argument("--against", help="Python of another environment, whose meshwind is run in turns with this one")
    parser.add_argument("--faces", type=int, default=0, help="faces of a large mesh that is wound, too")
    parser.add_argument("--paths", type=int, default=0, help="paths in all of a large winding")
    parser.add_argument("--large-runs", type=int, default=3, help="times that the large ones are run")
    given = parser.parse_args()
    results = Results(given.out, "first_run", given.runs < 3)
    rows: list[dict[str, Any]] = []
    with tempfile.TemporaryDirectory() as folder:
        work = Path(folder)
        places = [Place(OURS, sys.executable, work / OURS)]
        if given.against:
            places.append(Place(OTHER, given.against, work / OTHER))
        for place in places:
            place.folder.mkdir()
            place.wind(MESH, "kernels-0", *WINDING)  # leaves bytecode, and kernels for the large runs
        peers(places[0])
        for number in range(1, 1 + given.runs):
            for place in places:
                rows += [told(job, place.who, number, cost) for job, cost in place.first(number).items()]
            rows += [told("first run", who, number, cost) for who, cost in peers(places[0]).items()]
        rows += large(places, work, given.faces, given.paths, given.large_runs)
        results.table("first_run_versions", [{"who": place.who, "version": place.version()} for place in places])
    results.table("first_run", rows)
    results.table("first_run_medians", medians(rows))
    for row in medians(rows):
        of = ("seconds", "processor_seconds", "memory")
        ratios = ", ".join(f"{key} {row[f'{key} ratio']:.2f}" for key in of if row[f"{key} ratio"] != "")
        print(f"{row['job']}, {row['who']}: {row['seconds']:.2f} s{', over before: ' + ratios if ratios else ''}")
    results.finish(f"{len(rows)} runs")


if __name__ == "__main__":
    main()
