"""README and the pages describe every file, field, code and option, and their figures hold."""

import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from documentation.documents import ROOT, documents
from layup_shapes import bridged
from typer.main import get_command

import meshwind as mw
from meshwind.cli.main import app
from meshwind.core.option import options_of
from meshwind.layup.layup import assess
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.kernels.state import NEEDS_TREE
from meshwind.results.schema import RESULTS
from meshwind.results.write import surface_maps, write_files
from meshwind.surface import shapes
from meshwind.surface.grid import grid
from meshwind.workflow.options import Options

PAGES = documents()


def rows(heading: str) -> list[list[str]]:
    """The cells of the one table whose first headings are the given ones."""
    _, table = "\n\n".join(PAGES.values()).split(f"\n| {heading} |")
    table = table.split("\n\n")[0]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table.splitlines()[2:]]


def test_every_field_is_described_and_no_other(tmp_path: Path) -> None:
    paths = bridged()
    layup = assess(replace(paths, surface=replace(paths.surface, uncertainty=np.full((2, 3), 1e-9))))
    on = grid(layup.paths.surface)
    faces = np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]])
    write_files(tmp_path, layup, surface_maps(layup, Mesh(on.points, faces)))
    held: set[tuple[str, str]] = set()
    for file in (*tmp_path.glob("*.vtp"), *tmp_path.glob("*.vtu")):
        read = pv.read(file)
        held |= {(name, file.stem) for name in (*read.point_data.keys(), *read.cell_data.keys())}
    listed = {
        (name, place.strip())
        for names, places, *_ in rows("field | in")
        for name in re.findall(r"`(\w+)`", names)
        for place in places.split(",")
    }
    assert listed == held


def test_every_status_is_described() -> None:
    listed = {
        (int(number), name)
        for numbers, names, _ in rows("`status` | name")
        for number, name in zip(numbers.split(","), re.findall(r"`(\w+)`", names), strict=True)
    }
    assert listed == {(int(status), status.name.lower()) for status in mw.Status}


def test_every_status_has_advice_and_a_number_of_its_own() -> None:
    assert all(status.advice for status in mw.Status)
    assert NEEDS_TREE not in set(mw.Status)


def test_every_file_is_described() -> None:
    assert {name for cells in rows("file | contents") for name in re.findall(r"`([\w.]+)`", cells[0])} == RESULTS


def test_every_option_is_described() -> None:
    shown = subprocess.run(
        [sys.executable, "-m", "meshwind", "wind", "--help"], capture_output=True, text=True, check=True
    ).stdout
    named = {re.findall(r"--[\w-]+", cells[0])[0] for cells in rows("option")}
    assert named == set(re.findall(r"^  (?:--render / )?(--[a-z-]+)", shown, re.MULTILINE)) - {"--help", "--render"} | {
        "--no-render"
    }


def test_every_option_of_every_command_is_named() -> None:
    """All but those that only turn off what is off unless it is turned on, and on what is on."""
    named = set(re.findall(r"(?<![\w-])--[a-z][a-z-]*", "\n".join(PAGES.values())))
    for command in get_command(app).commands.values():  # type: ignore[attr-defined]
        for parameter in command.params:
            words = {each for each in (*parameter.opts, *parameter.secondary_opts) if each.startswith("--")}
            assert words & named if parameter.secondary_opts else words <= named, (command.name, parameter.name)


def test_every_package_is_named() -> None:
    section = PAGES["examples/site/how_it_works.md"]
    rooms = {file.parent.name for file in (ROOT / "meshwind").glob("*/__init__.py")}
    assert rooms <= set(re.findall(r"`([a-z]+)`", section))


def test_options_are_described_as_in_the_help() -> None:
    def plain(text: str) -> str:
        return re.sub(r"[`\"]", "", text).lower()

    listed = {re.findall(r"--[\w-]+", cells[0])[0]: plain(cells[1]) for cells in rows("option")}
    for name, option in options_of(Options).items():
        assert plain(option.meaning) in listed[f"--{name.replace('_', '-')}"]


@pytest.mark.parametrize("turns", [1, 4])
def test_lengths_are_those_of_chords(turns: int) -> None:
    """A helix on a cylinder: relative error h^2 k^2 / 24, below 1e-5 at one turn and about 1.5e-4 at four."""
    radius, height = 1.0, 2.0
    path = mw.solve(shapes.cylinder(radius, height, (256, 16)), [(0.0, 0.0)], [(float(turns), 1.0)])
    length = float(np.linalg.norm(np.diff(path.points[0], axis=0), axis=1).sum())
    exact = float(np.hypot(2 * np.pi * radius * turns, height))
    curvature = (2 * np.pi * turns / exact) ** 2 * radius
    expected = (exact / 400 * curvature) ** 2 / 24
    assert 1.0 - length / exact == pytest.approx(expected, rel=0.02)
    assert expected < (1e-5 if turns == 1 else 1.7e-4)
