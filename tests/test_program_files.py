"""What `meshwind program` writes and says, machines as files, time, and spans that meet the part."""

import csv
import json
import subprocess
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from command import meshwind
from hypothesis import given, settings
from hypothesis import strategies as st
from program_parts import filament, work, write_run

import meshwind as mw
from meshwind.cli import program as command
from meshwind.core.cast import Floats
from meshwind.core.defaults import MACHINE
from meshwind.core.errors import BadInputError
from meshwind.program.axes import limits_of
from meshwind.program.machine import FEEDS, MOVES, Eye, machine_names, machine_of, read_machine
from meshwind.program.posts.dialects import DIALECTS
from meshwind.program.program import Program, program
from meshwind.program.robot import APPROACH, robot_poses
from meshwind.program.seen import SEEN
from meshwind.program.targets import TARGETS, write_program
from meshwind.program.timing import Limits, timed
from meshwind.program.work import Work

COLUMNS = (
    "index,layer,circuit,pass,path,kind,arc_length,x,y,z,tx,ty,tz,nx,ny,nz,free_length,eye_x,eye_r,mandrel_deg,roll_deg,"
    "time,tension,slip"
)
"""What readers of program.csv rely on."""

MINE = """
words = "mine"
feed = "G94"
fibre_speed = 200
axes = [
  {moves = "mandrel", letter = "C", speed = 360, acceleration = 720, sign = -1},
  {moves = "carriage", letter = "Z", speed = 1000, acceleration = 2000, low = 0.0, high = 120.0},
  {moves = "cross", letter = "X", speed = 500, acceleration = 1000},
]
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A run's folder with a filament."""
    return write_run(tmp_path_factory.mktemp("program"), 2)


def called(*arguments: object) -> subprocess.CompletedProcess[str]:
    return meshwind("program", *map(str, arguments))


def test_the_files_keep_to_their_contract(run: Path, tmp_path: Path) -> None:
    done = write_program(run, to=("poses",), out=tmp_path, tension=20.0)
    assert [file.name for file in done.files] == ["poses.csv", "program.csv", "program.json", "program_columns.csv"]
    figures = json.loads((tmp_path / "program.json").read_text())
    assert figures["files"] == [file.name for file in done.files]
    with (tmp_path / "program.csv").open() as file:
        assert file.readline().strip() == COLUMNS
        file.seek(0)
        held = list(csv.DictReader(file))
    column = {name: np.array([float(row[name]) for row in held]) for name in COLUMNS.split(",")}
    o, a, e1 = (np.array(figures["axis"][name]) for name in ("origin", "direction", "zero"))
    assert [a @ a, e1 @ e1, a @ e1] == pytest.approx([1.0, 1.0, 0.0], abs=1e-12)
    point = np.stack([column[name] for name in "xyz"], axis=1)
    tangent = np.stack([column["t" + name] for name in "xyz"], axis=1)
    phi = -np.radians(column["mandrel_deg"])[:, None]
    e_r = np.cos(phi) * e1 + np.sin(phi) * np.cross(a, e1)
    eye = o + column["eye_x"][:, None] * a + column["eye_r"][:, None] * e_r
    assert eye == pytest.approx(point + column["free_length"][:, None] * tangent, abs=1e-8)
    roll = np.degrees(np.arctan2(tangent @ a, (tangent * np.cross(a, e_r)).sum(axis=1)))
    apart = (roll - column["roll_deg"]) / 180.0
    assert apart == pytest.approx(np.round(apart), abs=1e-8)
    assert column["index"] == pytest.approx(np.arange(len(held)))
    assert (column["tension"] == 20.0).all()
    assert figures["seconds"] == pytest.approx(column["time"][-1])
    assert sum(figures["seconds_of_layers"]) == pytest.approx(figures["seconds"])
    assert column["mandrel_deg"][-1] > column["mandrel_deg"][0]
    surface = done.program.work.surface
    middles = surface.points(np.stack(np.meshgrid(np.arange(64) / 64, [0.0, 1.0]), axis=2).reshape(-1, 2))
    middles = middles.reshape(2, 64, 3).mean(axis=1)
    assert o == pytest.approx(middles[0 if a @ (middles[1] - middles[0]) > 0.0 else 1], abs=1e-9)
    # the whole filament is wound
    assert column["arc_length"][-1] == pytest.approx(done.program.work.filaments[0].course.arc_length[-1])
    assert set(column["circuit"]) == {0.0, 1.0}


def test_poses_stand_still_while_the_mandrel_turns(run: Path, tmp_path: Path) -> None:
    done = write_program(run, "robot", ("poses",), tmp_path)
    blocks, mandrel = done.program.blocks, done.program.mandrel
    found = robot_poses(blocks, mandrel)
    w, v = found.quaternion[:, 0], found.quaternion[:, 1:]

    def turned(vector: list[float]) -> np.ndarray:
        unit = np.broadcast_to(vector, v.shape)
        return np.asarray(unit + 2.0 * np.cross(v, np.cross(v, unit) + w[:, None] * unit))

    # the part, turned by the mandrel's angle about x: the eye looks from its position to the point along z
    angle = np.radians(blocks.mandrel)
    along, one, two = mandrel.inside(blocks.point).T
    point = np.stack([along, np.cos(angle) * one - np.sin(angle) * two, np.sin(angle) * one + np.cos(angle) * two], 1)
    assert found.position + blocks.free_length[:, None] * turned([0.0, 0.0, 1.0]) == pytest.approx(point, abs=1e-8)
    assert np.abs(found.position[:, 2]).max() == 0.0
    across = np.cross(blocks.normal, blocks.tangent)
    along, one, two = mandrel.turned(across / np.linalg.norm(across, axis=1)[:, None]).T
    y = np.stack([along, np.cos(angle) * one - np.sin(angle) * two, np.sin(angle) * one + np.cos(angle) * two], 1)
    assert turned([0.0, 1.0, 0.0]) == pytest.approx(y, abs=1e-8)
    assert (np.abs(np.diff(found.quaternion, axis=0)).max(axis=1) < 0.5).all()
    lines = [line for line in (tmp_path / "poses.csv").read_text().splitlines() if not line.startswith("#")]
    table = np.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
    assert len(table) == len(blocks) + 2
    assert table[0, 11] == pytest.approx(table[1, 11] + APPROACH)
    assert (table[:, 1] == [0, *len(blocks) * [1], 2]).all()
    assert np.diff(table[:, 7]).min() >= 0.0


def test_the_command_says_what_it_wrote(run: Path, tmp_path: Path) -> None:
    done = called(run, "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    assert "machine   lathe-4" in done.stdout
    assert (tmp_path / "program.csv").is_file()
    listed = called("--machines")
    assert listed.returncode == 0
    assert [line.split()[0] for line in listed.stdout.splitlines()] == machine_names()
    assert (*TARGETS, *SEEN, *DIALECTS) == command.TARGETS
    assert MACHINE in machine_names()
    assert len(machine_names()) == 6


def test_options_may_come_from_a_file(run: Path, tmp_path: Path) -> None:
    (tmp_path / "my.toml").write_text(f'folder = "{run}"\nagain = false\nto = "csv"\ntension = 20\nout = "there"\n')
    done = called("--config", tmp_path / "my.toml", "--tension", "5", "--json")
    assert done.returncode in (0, 3), done.stderr
    told = json.loads(done.stdout)
    assert told["rewound"] is None and told["folder"] == str(tmp_path / "there")
    assert (np.genfromtxt(tmp_path / "there" / "program.csv", delimiter=",", names=True)["tension"] == 5.0).all()
    assert not (tmp_path / "there" / "axes.png").exists()


def test_travel_that_is_too_short_is_a_fault(run: Path, tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE.replace("low = 0.0, high = 120.0", "low = 0.4, high = 0.5"))
    done = called(run, "--machine", file, "--out", tmp_path)
    assert done.returncode == 3, done.stderr
    assert "carriage Z goes to" in done.stdout
    figures = json.loads((tmp_path / "program.json").read_text())
    faults = [each for each in figures["faults"] if each["kind"] == "travel"]
    values = np.loadtxt(tmp_path / "program.csv", delimiter=",", skiprows=1)[:, COLUMNS.split(",").index("eye_x")]
    assert values.min() < 0.4 < 0.5 < values.max()
    farthest = [values[each["index"]] for each in faults]
    assert sorted(farthest) == pytest.approx([values.min(), values.max()], abs=1e-9)
    # moving the zero cannot help where the whole does not fit
    needed = f"it needs {np.ptp(values):.6g} mm of travel, and has 0.1: take a machine with more travel"
    assert all(needed in each["words"] for each in faults)
    file.write_text(MINE.replace("low = 0.0, high = 120.0", "low = 0.4, high = 120.0"))
    called(run, "--machine", file, "--out", tmp_path)
    (fault,) = json.loads((tmp_path / "program.json").read_text())["faults"]
    assert f"move its zero by {0.4 - values.min():.6g}, or take a machine with more travel" in fault["words"]


def test_faults_in_a_row_have_one_line() -> None:
    faults = [{"index": k, "words": words} for k, words in ((3, "a"), (4, "a"), (5, "a"), (6, "b"), (8, "b"), (9, "b"))]
    assert command.in_runs(faults) == ["blocks 3 to 5: a", "block 6: b", "blocks 8 to 9: b"]
    assert command.in_runs([]) == []


def test_a_machine_of_ones_own_needs_no_code(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    file.write_text(MINE)
    machine = read_machine(str(file))
    assert (machine.name, machine.words, machine.feed, machine.fibre_speed) == ("mine", "mine", "G94", 200.0)
    mandrel = machine.axis("mandrel")
    assert mandrel is not None
    assert (mandrel.letter, mandrel.sign, mandrel.unit) == ("C", -1, "deg")
    for name in machine_names():
        shipped = read_machine(name)
        assert shipped.name == name
        assert shipped.feed in FEEDS
        assert {axis.moves for axis in shipped.axes} <= set(MOVES)
    made = program(work(mw.shapes.cylinder(30.0, 90.0, (12, 8))), machine)
    assert set(made.losses) == {"roll", "yaw"}
    assert made.losses["yaw"] == pytest.approx(np.abs(made.blocks.yaw).max())
    two = program(work(mw.shapes.cylinder(30.0, 90.0, (12, 8))), read_machine("lathe-2"))
    assert set(two.losses) == {"cross", "roll", "yaw"}
    assert not program(work(mw.shapes.cylinder(30.0, 90.0, (12, 8))), read_machine("lathe-5")).losses


WRONG = {
    'moves = "mandrel", letter': ('moves = "spindle", letter', "moves 'spindle'"),
    '"C", speed = 360': ('"Z", speed = 360', "two axes have 'Z'; give each its own"),
    'moves = "carriage"': ('moves = "cross"', "two axes move 'cross'"),
    '{moves = "mandrel", letter = "C", speed = 360, acceleration = 720, sign = -1},': ("", "no axis moves the mandrel"),
    "sign = -1": ("sign = 2", "sign 2; give 1 or -1"),
    "speed = 360": ("speed = 0", "speed 0.0; give a number from 0.001"),
    ", acceleration = 720": ("", "has no acceleration; give it"),
    "low = 0.0": ("low = 500", "give low below high"),
    'feed = "G94"': ('feed = "G95"', "give G93, G93-seconds, G94"),
    "fibre_speed": ("fiber_speed", "has no 'fiber_speed'; did you mean 'fibre_speed'"),
    "fibre_speed = 200": ("fibre_speed = true", "is True; give a number"),
    "axes = [": ("[[axis]]\nx = [", "has no 'axis'; did you mean 'axes'"),
    'letter = "Z"': ("letter = 3", "give text in quotes"),
    "high = 120.0": ("modulo = 360", "of rotary axes only"),
    "acceleration = 720, sign": ("acceleration = 720, modulo = 5, sign", "modulo 5; give one of at least 30"),
    "acceleration = 720": ("acceleration = 1e-12", "acceleration 1e-12; give a number from 0.001"),
    "low = 0.0, ": ("zero = 1e300, low = 0.0, ", "too large; give a number from -1e+06 to 1e+06"),
    "fibre_speed = 200\n": ("fibre_speed = 1e-9\n", "fibre_speed is 1e-09; give a number from 0.001"),
    'feed = "G94"\n': ('dialect = "linuxnc"\n', "dialect is 'linuxnc'; did you mean 'linuxcnc'"),
    "words": ("clearance = -1\nwords", "clearance is -1.0; give a number above 0"),
}


@pytest.mark.parametrize("command", [
    "M68 Q{newtons}", "M68 Q{", "M68 Q{tension[0]}", "M68 Q{tension.a.b}", "M68 Q{tension:d}", "M68",
    "M68 {tension}\nG0 A0",
])  # fmt: skip
def test_a_wrong_command_of_the_tension_is_told_in_one_line(command: str) -> None:
    table = {**tomllib.loads(MINE), "tension": command}
    with pytest.raises(BadInputError, match=r"^machine mine.toml: tension is .*; give .*\{tension") as error:
        machine_of(table, "mine.toml")
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("name", ["clearance", "eye_radius", "shaft"])
def test_lengths_far_beyond_the_part_are_told(name: str) -> None:
    """They would take blocks without end: 1e9 mm is 1e8 blocks."""
    table = {**tomllib.loads(MINE), name: 1e9}
    with pytest.raises(BadInputError, match=f"{name} of mine is 1e\\+09 mm, and the diagonal of the part is only "):
        program(work(mw.shapes.cylinder(30.0, 90.0, (12, 8))), machine_of(table, "mine.toml"))


@pytest.mark.parametrize("right", list(WRONG))
def test_a_wrong_machine_is_told_in_one_line(right: str, tmp_path: Path) -> None:
    wrong, words = WRONG[right]
    assert right in MINE
    file = tmp_path / "mine.toml"
    file.write_text(MINE.replace(right, wrong))
    with pytest.raises(BadInputError) as error:
        read_machine(str(file))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_what_is_not_there_is_told_in_one_line(run: Path, tmp_path: Path) -> None:
    with pytest.raises(BadInputError, match="no machine 'lathe-6'; did you mean 'lathe-"):
        read_machine("lathe-6")
    with pytest.raises(BadInputError, match="has no axes"):
        machine_of({}, "mine.toml")
    with pytest.raises(BadInputError, match="target 'cvs' is not known; did you mean 'csv'"):
        write_program(run, to=("cvs",), out=tmp_path)
    with pytest.raises(BadInputError, match="tension is -1"):
        write_program(run, tension=-1.0, out=tmp_path)
    assert not list(tmp_path.iterdir())
    missing = called(tmp_path)
    assert missing.returncode == 2
    assert len(missing.stderr.splitlines()) == 1
    for file in ("paths.vtp", "surface.npz", "report.json"):
        (tmp_path / file).write_bytes((run / file).read_bytes())
    with pytest.raises(BadInputError, match="holds no filament; wind it with"):
        write_program(tmp_path)


@given(st.integers(3, 200), st.floats(1.0, 100.0), st.floats(1.0, 500.0))
@settings(max_examples=60, deadline=None, derandomize=True, database=None)
def test_one_axis_takes_little_longer_than_it_must(count: int, speed: float, acceleration: float) -> None:
    """From rest to rest over n steps of 1: L/v + v/a, or 2 sqrt(L/a) where the speed is not reached."""
    found = timed(np.ones((count, 1)), Limits(("x",), np.array([speed]), np.array([acceleration])))
    length = float(count)
    reached = speed**2 <= acceleration * length
    least = length / speed + speed / acceleration if reached else 2.0 * np.sqrt(length / acceleration)
    total = float(found.seconds.sum())
    assert found.over == 0.0
    # blocks end at the wrong places for the shortest time, by a step at each end
    assert total >= least * (1 - 1e-3) - 2.0 * np.sqrt(2.0 / acceleration) - 2.0 / speed
    # stretching overshoots: by up to 7 % on ramps of 50 blocks
    assert total <= 1.1 * least + 4.0 * np.sqrt(1.0 / acceleration)


def test_a_program_that_stands_still_takes_no_time() -> None:
    limits = limits_of(read_machine("lathe-4"))
    still = timed(np.zeros((5, 5)), limits)
    assert (still.seconds == 0.0).all()
    both = timed(np.array([[0.0, 10.0, 0, 0, 0], np.zeros(5), [0.0, 10.0, 0, 0, 0]]), limits)
    assert both.seconds[1] == 0.0
    assert (both.seconds[[0, 2]] > 0.0).all()


def depths(made: Program) -> Floats:
    """How deep (n,) each span to where the machine has its eye goes below the hourglass r = 20 + z^2/100."""
    share = np.linspace(0.002, 1.0, 500)[:, None]
    depth = np.zeros(len(made.blocks))
    for k, (start, end) in enumerate(zip(made.blocks.point, made.eyes, strict=True)):
        at = start + share * (end - start)
        inside = np.abs(at[:, 2]) <= 60.0
        under = 20.0 + 0.01 * at[:, 2] ** 2 - np.hypot(at[:, 0], at[:, 1])
        depth[k] = (under / np.sqrt(1.0 + (0.02 * at[:, 2]) ** 2))[inside].max(initial=0.0)
    return depth


def test_spans_that_meet_the_part_are_told() -> None:
    """An hourglass, wound steeply: lines of the tangent go through its flare, as its formula says."""
    surface = mw.shapes.revolution(lambda z: 20.0 + 0.01 * z**2, -60.0, 60.0, (48, 48))
    made = program(work(surface, 1, 0.15, 0.2, 201), replace(read_machine("lathe-2"), eye=Eye(2.0)))
    b, skin = made.blocks, 1e-3 * made.work.diagonal
    told = {fault.index for fault in made.faults if fault.kind == "span"}
    depth = depths(made)
    assert 10 < len(told) < len(b)
    assert set(np.flatnonzero(depth > 1.3 * skin)) <= told
    # where the wall flares, its skin stands a little above the lid, and lines from the rim meet it there
    rim = np.abs(b.point[:, 2]) > 60.0 - skin
    assert told <= set(np.flatnonzero((depth > 0.7 * skin) | rim))
    assert made.remedies
    assert "the other direction of travel" in made.remedies[0]
    # layers keep their order, each wound from its own end; one filament of two layers cannot be turned
    one = made.work.filaments[0]
    two = replace(one, layer=one.layer + 1)
    both = program(replace(made.work, filaments=(one, two)), made.machine)
    assert "the other direction of travel" in both.remedies[0]
    assert (np.diff(both.blocks.layer) >= 0).all()
    whole = replace(one, layer=(np.arange(len(one.course)) > 200).astype(np.int64))
    kept = program(replace(made.work, filaments=(whole,)), made.machine)
    assert not any("direction" in words for words in kept.remedies)
    # this fibre is not taut: its line goes into the surface at once, which no shorter span clears
    near = program(made.work, read_machine("lathe-4"))
    assert any(words.startswith("shorter spans in hollows") for words in near.remedies)
    assert near.faults
    assert near.nearest >= 0.0
    # a convex part is clear, and a shaft on its axis is met where spans come near it
    convex = work(mw.shapes.sphere_band(50.0, 0.3, 2.8, (24, 16)), 1, 0.9, 0.3)
    assert not program(convex, read_machine("lathe-4")).faults
    big = program(convex, replace(read_machine("lathe-4"), eye=Eye(1e3)))
    assert {fault.kind for fault in big.faults} == {"eye"}
    assert any(words.startswith("a longer span") for words in big.remedies)


def test_layers_follow_each_other_without_turning_back() -> None:
    surface = mw.shapes.cylinder(30.0, 90.0, (12, 8))
    one = filament(surface, 1, 0.7, 0.3)
    two = replace(one, layer=one.layer + 1)
    made = program(Work((one, two), surface, 110.0, "mm"), read_machine("lathe-4"))
    b = made.blocks
    change = int(np.flatnonzero(np.diff(b.layer))[0])
    assert 0.0 <= b.mandrel[change + 1] - b.mandrel[change] < 360.0
    assert b.arc_length[change + 1] == b.arc_length[change]
    assert len(made.seconds_of_layers) == 2
    assert made.seconds_of_layers[0] == pytest.approx(made.seconds_of_layers[1], rel=0.1)
