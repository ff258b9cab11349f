"""The main jobs, each small: what they cost is what a user's larger run costs more of."""

from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import meshwind as mw
from benchmarks.tally import Tally, counted
from meshwind.core.compile_ahead import table
from meshwind.program.targets import write_program

DATA = Path(__file__).parents[2] / "data"
ROUGH = 2e-3
"""Dents of a rough scan, over the size of the part, and ..."""
ACROSS = 60.0
"""... how many radians of them it is across: a few facets each."""


def rough_scan() -> mw.Mesh:
    """The foot's cast with dents all over, of sines: the same everywhere, which a random generator may not be."""
    mesh = mw.read(DATA / "cast.ply")
    points, size = mesh.vertices, max(mesh.size)
    waves = np.sin(ACROSS * points / size + np.array([0.3, 1.1, 2.5])).prod(axis=1)
    off = points - points.mean(axis=0)
    outward = off / np.linalg.norm(off, axis=1)[:, None]
    return mw.Mesh(points + (ROUGH * size * waves)[:, None] * outward, mesh.faces, mesh.units)


def wound(out: Path, part: Any, **options: Any) -> None:
    """A run of `wind` with all of its files but the pictures."""
    given: dict[str, Any] = {"paths": 4, "particles": 201} | options
    mw.wind(DATA / part if isinstance(part, str) else part, out=out, render=False, **given)


def redesigned(out: Path) -> None:
    """A run of `redesign` with its files but the pictures."""
    found = mw.redesign(str(DATA / "vase.stl"), paths=4, revolutions=0.35, particles=201)
    mw.write_redesign(found, out, render=False)


def programmed(out: Path) -> None:
    """A filament and the program of a machine that winds it, wound again by physics."""
    wound(out, "tank.ply", paths=5, revolutions=0.45, friction=0.2, continuous=True, band_width=8.0)
    write_program(out, "lathe-4", ["csv", "linuxcnc"])


JOBS: dict[str, Callable[[Path], object]] = {
    "plain": lambda out: wound(out, "vase.stl", revolutions=0.35),
    "friction": lambda out: wound(out, "tank.ply", revolutions=0.8, friction=0.2),
    "rough scan": lambda out: wound(out, rough_scan(), revolutions=0.5),
    "auto": lambda out: wound(out, "bottle.obj", particles=101, revolutions="auto"),
    "auto with friction": lambda out: wound(out, "elbow.obj", particles=101, revolutions="auto", friction=0.2),
    "advice": lambda out: wound(out, "tank.ply", paths=2, particles=101, revolutions=0.8),
    "spacing": lambda out: wound(out, "bottle.obj", revolutions=0.45, spacing=25.0),
    "redesign": redesigned,
    "program": programmed,
}
"""The main jobs, each with a folder for its files, by name."""


def counts(name: str) -> Tally:
    """What a job costs, in counts, with the bytes of its files."""
    with TemporaryDirectory() as folder:
        out = Path(folder) / "out"
        with counted() as tally:
            JOBS[name](out)
        tally["bytes"] = sum(file.stat().st_size for file in out.rglob("*") if file.is_file())
    return tally


def kernels() -> int:
    """Kernels that are compiled ahead."""
    return len(table())
