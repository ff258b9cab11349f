"""Several filaments in a program: the fibre is cut, the eye travels clear of the part, and the next one is tied on."""

import json
import re
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from program_parts import filament, work, write_run

from meshwind import shapes
from meshwind.program.blocks import TRAVEL, Blocks
from meshwind.program.head import frames
from meshwind.program.machine import Machine, read_machine
from meshwind.program.posts.dialect import fitted
from meshwind.program.posts.dialects import DIALECTS
from meshwind.program.posts.header import Job
from meshwind.program.posts.writer import program_text
from meshwind.program.program import Program, program
from meshwind.program.readback.compare import Part, read_back
from meshwind.program.targets import write_program
from meshwind.results.filament_file import read_filaments, write_filaments


def three(machine: Machine, tension: float = 20.0) -> Program:
    """A program of three filaments on a barrel, of which the second starts within a pass."""
    surface = shapes.revolution(lambda z: 1.0 - 0.2 * (z - 1.0) ** 2, 0.0, 2.0)
    first, second, third = (filament(surface, count, 0.6, 0.2, 41) for count in (1, 2, 1))
    other = replace(second, course=second.course.chosen(slice(60, None)), layer=second.layer[60:] + 1,
                    thickness=second.thickness[60:])  # fmt: skip
    last = replace(third, layer=third.layer + 1)
    return program(replace(work(surface), filaments=(first, other, last)), machine, tension)


@pytest.fixture(scope="module")
def made() -> Program:
    return three(read_machine("lathe-5"))


def legs(blocks: Blocks) -> list[Blocks]:
    return [blocks.chosen(slice(cut, tied + 1)) for cut, tied in blocks.travels]


def test_the_eye_travels_clear_of_the_part(made: Program) -> None:
    blocks, body = made.blocks, made.body
    assert [each.course.arc_length[-1] for each in made.work.filaments] == pytest.approx(
        np.diff([0.0, *blocks.arc_length[blocks.travels[:, 0]], blocks.arc_length[-1]])
    )
    for leg in legs(blocks):
        assert leg.arc_length == pytest.approx(leg.arc_length[0])
        # out, then along and round, then in: where the eye moves along it is outside of the body at its widest
        moves = np.abs(np.diff([leg.eye_x, leg.mandrel], axis=1)).max(axis=0) > 1e-9
        low, high = sorted((leg.eye_x[0], leg.eye_x[-1]))
        widest = np.interp(np.linspace(low, high, 999), body.x, body.r).max()
        assert moves.any() and leg.eye_r[0] < 0.99 * widest
        assert (leg.eye_r[:-1][moves] >= widest * (1 - 1e-9)).all()
        assert (leg.eye_r[1:][moves] >= widest * (1 - 1e-9)).all()
        assert (np.diff(leg.mandrel) >= 0.0).all() and np.ptp(leg.mandrel) < 360.0
        assert np.diff(leg.mandrel).max() <= 5.0 and np.abs(np.diff(leg.roll)).max() <= 10.0
        assert np.ptp(leg.roll) <= 180.0
        for name in ("eye_x", "eye_r", "mandrel", "roll", "yaw"):  # it ends where the filament starts
            assert getattr(leg, name)[-1] == getattr(leg, name)[-2]
    assert not [fault for fault in made.faults if blocks.kind[fault.index] == TRAVEL]


@pytest.mark.parametrize("name", ["lathe-5", "lathe-3", "lathe-2", "robot"])
def test_all_blocks_keep_the_contract(name: str) -> None:
    made = three(read_machine(name))
    blocks, mandrel = made.blocks, made.mandrel
    assert len(blocks.travels) == 2
    assert mandrel.eye(blocks.eye_x, blocks.eye_r, blocks.mandrel) == pytest.approx(blocks.eye, abs=1e-9)
    ahead = frames(blocks, mandrel, read_machine("lathe-5"))[:, :, 0]
    # the roll is of the fibre, whichever way that goes; on either side of a travel the same way
    out = mandrel.towards(blocks.mandrel)
    flat = blocks.tangent - (blocks.tangent * out).sum(axis=1, keepdims=True) * out
    size = np.linalg.norm(flat, axis=1)
    side = (ahead * flat).sum(axis=1) / np.maximum(size, 1e-12)
    sure = size > 1e-6
    assert np.abs(np.abs(side[sure]) - np.cos(np.radians(blocks.yaw[sure]))).max() < 1e-9
    assert len(set(np.sign(side[sure]))) == 1
    assert np.linalg.norm(blocks.tangent, axis=1) == pytest.approx(1.0)
    assert np.linalg.norm(blocks.normal, axis=1) == pytest.approx(1.0)
    cut = blocks.kind == TRAVEL
    assert (blocks.free_length[cut] == 0.0).all() and (blocks.tension[cut] == 0.0).all()
    assert (blocks.tension[~cut] == 20.0).all()


def test_the_machine_rests_where_the_fibre_is_cut_and_tied_on(made: Program) -> None:
    blocks, times = made.blocks, made.blocks.time
    step = np.diff(times)
    # the travels take the time that their axes need, and no filament another one than alone
    for axis, values in (("mandrel", blocks.mandrel), ("carriage", blocks.eye_x)):
        limits = made.machine.axis(axis)
        assert limits is not None
        speed = np.divide(np.diff(values), step, out=np.zeros(len(step)), where=step > 0.0)
        assert np.abs(speed).max() <= limits.speed * (1 + 1e-9)
        for block in blocks.travels.ravel():
            before, after = (
                ((step > 0.0) & (np.arange(len(step)) < block)).nonzero()[0][-1],
                ((step > 0.0) & (np.arange(len(step)) >= block)).nonzero()[0][0],
            )
            for k in (before, after):  # from rest within the first half of a step
                assert abs(speed[k]) <= 0.5 * step[k] * limits.acceleration * 1.002
    assert all(leg.time[-1] > leg.time[0] for leg in legs(blocks))
    assert np.nanmax(blocks.drawn / np.where(step > 0.0, step, np.nan)) <= made.machine.fibre_speed * (1 + 1e-9)


@pytest.mark.parametrize("name", sorted(DIALECTS))
def test_texts_stop_to_cut_and_to_tie_on(name: str) -> None:
    spoken = DIALECTS[name]
    shipped = read_machine("robot" if name == "krl" else "lathe-5")
    made = three(replace(shipped, tension="M68 E0 Q{tension:g}"))
    machine = replace(fitted(made.machine, spoken), tension=made.machine.tension)  # one whose tension is set like that
    part = Part(made.mandrel, 1.0, made.work.diagonal)
    text = program_text(made.blocks, machine, spoken, Job("tube"))
    found = read_back(text, made.blocks, fitted(machine, spoken), part)
    assert found.same, found.faults
    lines = [re.sub(r"^N\d+ ", "", line) for line in text.splitlines()]
    stops = [k for k, line in enumerate(lines) if line == spoken.pause]
    assert len(stops) == 5
    said = [" ".join(lines[k - 3 : k]).lower() for k in stops[1:]]
    for words, wanted in zip(said, 2 * ["cut the fibre", "tie on the fibre"], strict=True):
        assert wanted in words
    # no pull while the fibre is cut: off before the stop, on after it
    pulls = [line.split("Q")[1] for line in lines if line.startswith("M68")]
    assert pulls == ["20", "0", "20", "0", "20"]
    for cut, tied in (stops[1:3], stops[3:5]):
        off = max(k for k in range(cut) if lines[k] == "M68 E0 Q0")
        assert all(not re.match(r"G0?1|G0\d?X|LIN", line) for line in lines[off:cut])
        assert lines[tied + 1] == "M68 E0 Q20" or lines[tied + 2] == "M68 E0 Q20"
    wrong = text.splitlines()
    here = [k for k, line in enumerate(wrong) if re.sub(r"^N\d+ ", "", line) == spoken.pause]
    for changed in (
        [line for k, line in enumerate(wrong) if k != here[2]],  # left out
        [*wrong[: here[1]], *wrong[here[1] + 1 : here[1] + 9], wrong[here[1]], *wrong[here[1] + 9 :]],  # too late
        [*wrong[: here[2] - 9], wrong[here[2]], *wrong[here[2] - 9 : here[2]], *wrong[here[2] + 1 :]],  # too early
    ):
        again = read_back("\n".join(changed) + "\n", made.blocks, fitted(machine, spoken), part)
        assert any("stops" in words for _, words in again.faults), again.faults


def test_cuts_are_told(tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    run = write_run(tmp_path / "run", 2)
    held = read_filaments(run / "filament.vtp")
    write_filaments(run / "filament.vtp", [*held, *held])
    done = write_program(run, "robot", ("poses", "viewer", "axes", "krl"), tmp_path / "out", 10.0)
    assert done.sound
    (cut,) = json.loads((tmp_path / "out" / "program.json").read_text())["cuts"]
    blocks = done.program.blocks
    assert [cut["index"], cut["tied"]] == blocks.travels[0].tolist()
    assert cut["seconds"] == pytest.approx(blocks.time[cut["tied"]] - blocks.time[cut["index"]])
    lines = [line for line in (tmp_path / "out" / "poses.csv").read_text().splitlines() if line[0] != "#"]
    table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    assert (table[1:-1, 1] == np.where(blocks.kind == TRAVEL, 3, 1)).all()
    assert table[cut["index"] + 2 : cut["tied"] + 2, 8] == pytest.approx(0.0)  # no fibre goes through the eye
    turns = [abs(one @ other) for one, other in pairwise(table[:, 13:17])]
    assert min(turns) > 0.9
    assert "cut: on the way to the next filament" in (tmp_path / "out" / "program.html").read_text()
