"""Programs in the interpreters of others: LinuxCNC's own, and one of Siemens' words from the Python registry."""

import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from program_blocks import wound

from meshwind.program.axes import moved
from meshwind.program.blocks import Blocks
from meshwind.program.machine import Machine, read_machine
from meshwind.program.posts.dialects import DIALECTS
from meshwind.program.posts.header import Job
from meshwind.program.posts.writer import program_text

ALL = "XYZABC"
"""Axes in the order of LinuxCNC's canonical commands."""


def canonical(text: str, folder: Path, wraps: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Places (m, 6) to which LinuxCNC moves at a feed, with the offsets in force, and the feeds (m,)."""
    program, commands, tools = folder / "program.ngc", folder / "commands", folder / "tool.tbl"
    program.write_text(text, encoding="ascii")
    tools.write_text("")
    settings = folder / "machine.ini"
    settings.write_text(f"[AXIS_A]\nWRAPPED_ROTARY={int(wraps)}\n[TRAJ]\nLINEAR_UNITS=mm\n")
    order = [
        "rs274",
        "-g",
        "-i",
        str(settings),
        "-t",
        str(tools),
        "-v",
        str(folder / "numbers.var"),
        str(program),
        str(commands),
    ]
    done = subprocess.run(order, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    offset, feed, places, feeds = np.zeros(6), 0.0, [], []
    read = r"(SET_G92_OFFSET|SET_FEED_RATE|STRAIGHT_FEED)\(([-\d., ]*)\)"
    for name, values in re.findall(read, commands.read_text()):
        numbers = [float(value) for value in values.split(",")]
        if name == "SET_G92_OFFSET":
            offset = np.array(numbers)
        elif name == "SET_FEED_RATE":
            feed = numbers[0]
        elif name == "STRAIGHT_FEED":
            places.append(offset + numbers)
            feeds.append(feed)
    assert "PROGRAM_END" in commands.read_text()
    return np.array(places), np.array(feeds)


def seconds_by_feeds(places: np.ndarray, feeds: np.ndarray) -> np.ndarray:
    """Seconds of all moves but the first: feeds are of X, Y, Z, and of A, B, C where these stand still."""
    step = np.diff(places, axis=0)
    straight, turned = np.linalg.norm(step[:, :3], axis=1), np.linalg.norm(step[:, 3:], axis=1)
    return np.asarray(60.0 * np.where(straight > 0.0, straight, turned) / feeds[1:])


def wanted(blocks: Blocks, machine: Machine) -> np.ndarray:
    """Places (n - 1, 6) of the axes that a program leads to."""
    values = np.zeros((len(blocks), 6))
    for axis in machine.axes:
        values[:, ALL.index(axis.letter)] = axis.sign * moved(blocks, axis.moves, 1.0) + axis.zero
    return values[1:]


@pytest.mark.usefixtures("linuxcnc")
@pytest.mark.parametrize(("machine", "feed"), [
    ("lathe-2", "G93"), ("lathe-3", "G93"), ("lathe-4", "G93"), ("lathe-5", "G93"), ("grbl-xyz", "G93"),
    ("lathe-5", "G94"),
])  # fmt: skip
def test_linuxcnc_moves_as_the_program_says(machine: str, feed: str, tmp_path: Path) -> None:
    blocks = wound(turns=12.0, count=300, circuits=4)
    used = read_machine(machine)
    used = Machine(used.name, used.words, used.axes, "linuxcnc", feed, used.tension and "M68 E0 Q{tension:g}")
    text = program_text(blocks, used, DIALECTS["linuxcnc"], Job("part (1), MSG"))
    places, feeds = canonical(text, tmp_path)
    np.testing.assert_allclose(places, wanted(blocks, used), atol=1.2e-4)  # the commands have four decimals
    np.testing.assert_allclose(seconds_by_feeds(places, feeds), np.diff(blocks.time)[1:], rtol=2e-3)


@pytest.mark.usefixtures("linuxcnc")
@pytest.mark.parametrize("sign", [1, -1])
def test_linuxcnc_turns_a_wrapped_mandrel_on_without_end(sign: int, tmp_path: Path) -> None:
    blocks = wound(turns=12.0, count=300, circuits=4)
    lathe = read_machine("lathe-4")
    machine = replace(lathe, axes=(replace(lathe.axes[0], modulo=360.0, sign=sign), *lathe.axes[1:]))
    text = program_text(blocks, machine, DIALECTS["linuxcnc"], Job("part"))
    assert all(abs(float(angle)) < 360.0 for angle in re.findall(r" A(-?[\d.]+)", text))
    places, _ = canonical(text, tmp_path, wraps=True)
    np.testing.assert_allclose(places, wanted(blocks, machine), atol=1.2e-4)


@pytest.mark.usefixtures("linuxcnc")
def test_linuxcnc_refuses_a_program_without_feeds(tmp_path: Path) -> None:
    """That it accepts a program means something."""
    text = program_text(wound(), read_machine("lathe-4"), DIALECTS["linuxcnc"], Job("part"))
    with pytest.raises(AssertionError, match="F word"):
        canonical(re.sub(r" F[\d.]+", "", text), tmp_path)


def test_an_interpreter_of_siemens_words_moves_as_the_program_says() -> None:
    other = pytest.importorskip("nc_gcode_interpreter", reason="nc-gcode-interpreter is missing (pip install it)")
    blocks = wound(turns=3.0, count=100)
    machine = read_machine("lathe-5")
    text = program_text(blocks, machine, DIALECTS["siemens"], Job("part"))
    # the first line names the file to the control and is no part of the program
    table, _ = other.nc_to_dataframe(text.split("\n", 1)[1])
    moves = table.filter((table["gg01_motion"] == "G1") & table["F"].is_not_null() & table["M"].is_null())
    found = np.stack([moves[axis.letter].to_numpy() for axis in machine.axes], axis=1)
    meant = np.stack([moved(blocks, axis.moves, 1.0) for axis in machine.axes], axis=1)
    np.testing.assert_allclose(found, meant[1:], atol=2e-3)  # its increments have single precision
    np.testing.assert_allclose(60.0 / moves["F"].to_numpy(), np.diff(blocks.time), rtol=1e-5)
