"""Every public record prints in a few lines."""

from collections.abc import Iterator
from dataclasses import dataclass, fields, is_dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import meshwind as mw
from meshwind.core.brief import brief
from meshwind.mesh import check
from meshwind.program.targets import write_program
from meshwind.results.reading import read_results

DATA = Path(__file__).parents[1] / "data"
LINES, CHARACTERS = 7, 650
DEPTH = 6


def properties(kind: type) -> list[str]:
    """The public properties of a class, but for those that wind paths anew."""
    named = [name for name in dir(kind) if isinstance(getattr(kind, name), property | cached_property)]
    return [name for name in named if not name.startswith("_") and not name.startswith(("holding", "other_rests"))]


def records(shown: Any, depth: int = 0) -> Iterator[Any]:
    """A record and all that can be reached from it by its fields and properties."""
    if isinstance(shown, list | tuple):
        for each in shown[:2]:
            yield from records(each, depth + 1)
    if depth > DEPTH or not is_dataclass(shown) or isinstance(shown, type):
        return
    yield shown
    if type(shown).__module__.startswith("meshwind"):
        for name in [each.name for each in fields(shown)] + properties(type(shown)):
            yield from records(getattr(shown, name), depth + 1)


@pytest.fixture(scope="module")
def shown(tmp_path_factory: pytest.TempPathFactory) -> list[Any]:
    folder = tmp_path_factory.mktemp("run")
    wound = mw.wind(
        DATA / "tank.ply", paths=5, revolutions=0.3, particles=51, continuous=True, friction=0.2, band_width=4.0,
        band_thickness=0.2, out=folder / "out", render=False,
    )  # fmt: skip
    tube = mw.shapes.cylinder(1.0, 3.0)
    return [
        wound, mw.redesign(DATA / "tank.ply", revolutions=0.3, paths=3, particles=51), mw.families(tube, 3, 0.5),
        mw.trace(tube, (0.0, 0.0), 0.5, 1.0), check(DATA / "vase.stl"), write_program(folder / "out", again=False),
        read_results(folder / "out"),
    ]  # fmt: skip


def test_every_record_prints_in_a_few_lines(shown: list[Any]) -> None:
    found = {type(each): each for one in shown for each in records(one)}
    assert {"Paths", "Layup", "Program", "Filament", "Mesh", "Options"} <= {kind.__name__ for kind in found}
    long = {kind.__name__: len(repr(each)) for kind, each in found.items()
            if len(repr(each)) > CHARACTERS or len(repr(each).splitlines()) > LINES}  # fmt: skip
    assert long == {}


@dataclass(frozen=True)
class Sample:
    points: Any
    few: Any
    name: str
    path: Path
    inside: Any
    many: tuple[int, ...]
    two: tuple[float, float]
    nothing: Any = None

    __repr__ = brief


def test_a_record_says_what_is_in_it() -> None:
    sample = Sample(np.zeros((3, 2)), np.array([0.25, np.nan]), "x" * 99, Path("a"), mw.Page(), tuple(range(9)), (1, 2))
    said = " ".join(line.strip() for line in repr(sample).splitlines())
    assert said == (
        f"Sample(points=float64[3, 2], few=[0.25, nan], name='{'x' * 57}...', path='a', inside=Page(...), "
        "many=tuple of 9, two=(1, 2), nothing=None)"
    )
