"""Programs in the words of machines, and read back from them by an interpreter of its own."""

import re
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st
from program_blocks import MANDREL, PART, blocks_of, wound

from meshwind.core.errors import BadInputError
from meshwind.program.blocks import Blocks
from meshwind.program.machine import DIALECT_NAMES, Axis, Machine, machine_names, read_machine
from meshwind.program.posts.dialect import ALL_INCREMENTS, fitted
from meshwind.program.posts.dialects import DIALECTS, dialect, file_names
from meshwind.program.posts.header import Job
from meshwind.program.posts.writer import program_text
from meshwind.program.readback.compare import Part, ReadBack, read_back, read_text

JOB = Job("vase")
LATHE = read_machine("lathe-4")
LIMITS = {"speed": 100.0, "acceleration": 100.0}
ALL = sorted(DIALECTS)


def text_of(name: str, blocks: Blocks, machine: Machine = LATHE, job: Job = JOB) -> str:
    return program_text(blocks, machine, DIALECTS[name], job)


def back(name: str, text: str, blocks: Blocks, machine: Machine = LATHE, part: Part = PART) -> ReadBack:
    return read_back(text, blocks, fitted(machine, DIALECTS[name]), part)


def body(text: str) -> list[str]:
    """The lines of a text that are no comments."""
    return [line for line in text.splitlines() if not re.match(r"\(|; |;\$", line)]


SMALL = blocks_of(
    np.array([
        [350.0, 10.0, 50.0, 0.0, 0.0], [365.5, 12.0, 50.0, -3.25, 0.0], [365.5, 12.0, 50.0, -3.25, 0.0],
        [370.0, 12.0, 50.0, -3.25, 0.0], [371.0, 12.00004, 55.0, -3.25, 0.0],
    ]),
    np.array([0.0, 0.5, 0.75, 1.25, 1.5]), np.array([0, 0, 0, 1, 1]), tension=20.0,
)  # fmt: skip
"""Two circuits: a move of all axes, one in which nothing moves, one of the mandrel alone, and one with a tiny part."""
GOLDEN = {
    "linuxcnc": """G21 G17 G40 G49 G90 G94
        G64 P0.05
        G92 A0.0
        G0 Y55.0
        G0 A350.0 X10.0 B0.0
        G0 Y50.0
        M0
        G93
        M68 E0 Q20
        G1 A365.5 X12.0 B-3.25 F120.0
        G92 A5.5
        G4 P0.25
        G1 A10.0 F120.0
        G1 A11.0 X12.00004 Y55.0 F240.0
        M2""",
    "grbl": """G21G17G90G94
        G92A0.0
        G0Y55.0
        G0A350.0X10.0B0.0
        G0Y50.0
        M0
        G93
        G1A365.5X12.0B-3.25F120.0
        G92A5.5
        G4P0.25
        G1A10.0F120.0
        G1A11.0Y55.0F240.0
        M2""",
    "marlin": """G21
        G90
        G92 A0.0
        G0 Y55.0 F2160.0
        G0 A350.0 X10.0 B0.0 F2160.0
        G0 Y50.0 F2160.0
        M0
        G1 A365.5 X12.0 B-3.25 F240.0
        G92 A5.5
        G4 P250
        G1 A10.0 F540.0
        G1 A11.0 Y55.0 F1200.0
        M400""",
    "fanuc": """%
        O0001
        N1 G21 G17 G40 G49 G80 G64 G90 G94
        N2 G90 G0 Y55.0
        N3 G90 G0 X10.0 B0.0
        N4 G90 G0 Y50.0
        N5 G91 G0 A350.0
        N6 M00
        N7 G91 G93
        N8 G1 A15.5 X2.0 B-3.25 F120.0
        N9 G04 P250
        N10 G1 A4.5 F120.0
        N11 G1 A1.0 Y5.0 F240.0
        N12 M30
        %""",
    "siemens": """%_N_PROGRAM_MPF
        N10 G17 G40 G64 G90 G94 G710
        N20 FGROUP(A,X,Y,B)
        N30 G0 Y=55.0
        N40 G0 X=10.0 B=0.0
        N50 G0 Y=50.0
        N60 G0 A=IC(350.0)
        N70 M0
        N80 G93
        N90 G1 A=IC(15.5) X=12.0 B=-3.25 F120.0
        N100 G4 F0.25
        N110 G1 A=IC(4.5) F120.0
        N120 G1 A=IC(1.0) X=12.00004 Y=55.0 F240.0
        N130 M30""",
    "krl": """&ACCESS RVP
        &REL 1
        DEF program( )
        BAS (#INITMOV,0)
        $BASE=BASE_DATA[1]
        $TOOL=TOOL_DATA[1]
        $APO.CDIS=0.5
        PTP $AXIS_ACT
        $VEL.CP=0.1
        LIN {X 10.0, Y 55.0, Z 0.0, A 0.0, B 0.0, C 0.0, E1 350.0}
        LIN {X 10.0, Y 50.0, Z 0.0, A 0.0, B 0.0, C 0.0, E1 350.0}
        HALT
        $VEL.CP=0.004
        LIN {E6POS: X 12.0, Y 50.0, Z 0.0, A 0.0, B -3.25, C 0.0, E1 365.5} C_DIS
        WAIT SEC 0.25
        $VEL_EXTAX[1]=2.5
        LIN {E6POS: X 12.0, Y 50.0, Z 0.0, A 0.0, B -3.25, C 0.0, E1 370.0} C_DIS
        $VEL.CP=0.02
        LIN {E6POS: X 12.0, Y 55.0, Z 0.0, A 0.0, B -3.25, C 0.0, E1 371.0} C_DIS
        END""",
}


@pytest.mark.parametrize("name", ALL)
def test_the_text_of_a_small_program(name: str) -> None:
    text = text_of(name, SMALL)
    assert body(text) == [line.strip() for line in GOLDEN[name].splitlines()]
    assert back(name, text, SMALL).same


@st.composite
def programs(draw: st.DrawFn) -> tuple[Blocks, Machine, str, Part]:
    """Blocks of any steps and times, and a machine with any of the axes, signs and zeros, in a dialect."""
    name = draw(st.sampled_from(ALL))
    said = DIALECTS[name]
    n = draw(st.integers(2, 25))
    size = draw(st.sampled_from([0.3, 40.0, 3000.0]))
    sizes = st.sampled_from([0.0, 0.0, 1e-6, 1e-4, 0.01, 1.0])
    steps = np.array(draw(st.lists(st.tuples(*5 * [st.builds(
        lambda scale, share: scale * share, sizes, st.floats(-1.0, 1.0))]), min_size=n, max_size=n)))  # fmt: skip
    forwards = np.abs(steps[:, 0]) * draw(st.sampled_from([5.0, 170.0]))
    start = draw(st.floats(-2000.0, 2000.0))
    columns = np.stack([
        start + np.cumsum(forwards), *(np.cumsum(steps[:, 1:3], axis=0).T * size),
        *(np.cumsum(steps[:, 3:], axis=0).T * 40.0),
    ], axis=1)  # fmt: skip
    columns[:, 2] += size * n
    # a block in which something moves takes time, one in which nothing does may take none
    moving = (np.abs(np.diff(columns, axis=0)) > 0.0).any(axis=1)
    least, rest = 2e-5, st.sampled_from([0.0, 0.0, 1e-4, 0.02, 0.5])
    time = np.array(draw(st.lists(rest, min_size=n - 1, max_size=n - 1))) + least * moving
    circuit = np.sort(draw(st.lists(st.integers(0, 3), min_size=n, max_size=n)))
    tension = draw(st.sampled_from([0.0, 12.5]))
    millimetres = draw(st.sampled_from([1.0, 25.4]))
    part = Part(MANDREL, millimetres, 4.0 * size)
    blocks = blocks_of(columns, np.concatenate([[0.0], np.cumsum(time)]), circuit, part, tension)
    held = draw(st.sampled_from([2, 3, 4, 5]))
    moves = [moves for moves, *_ in said.usual][:held]
    counts = said.turned is not None or said.turning == ALL_INCREMENTS
    modulo = [moves for moves in ("mandrel", "roll", "yaw") if counts and draw(st.booleans())]
    axes = tuple(
        Axis(each, letter, **LIMITS, sign=draw(st.sampled_from([-1, 1])),
             zero=draw(st.sampled_from([0.0, -7.5, 100.25])), modulo=360.0 if each in modulo else None)
        for each, letter, _ in said.usual if each in moves
    )  # fmt: skip
    feed = draw(st.sampled_from(said.feeds))
    return blocks, Machine("any", "", axes, name, feed, "M68 E0 Q{tension:g}"), name, part


@settings(max_examples=200, deadline=None, phases=[Phase.reuse, Phase.generate])
@given(programs())
def test_every_program_is_read_back_as_it_was_meant(case: tuple[Blocks, Machine, str, Part]) -> None:
    blocks, machine, name, part = case
    text = text_of(name, blocks, machine, Job("any", part.millimetres))
    found = back(name, text, blocks, machine, part)
    assert found.same, (found.faults, text)
    digit = 10.0 ** -DIALECTS[name].decimals
    assert found.angle <= 1.1 * digit
    assert found.axis <= 1.1 * digit
    assert abs(found.seconds) * blocks.time[-1] <= 1e-3 * blocks.time[-1] + 1e-3
    assert text.isascii()
    assert max(map(len, text.splitlines())) <= DIALECTS[name].longest
    # no number is written with an exponent, and none without a point or sign that a controller may misread
    assert not re.search(r"\d[eE][-+]?\d|nan|inf", "\n".join(body(text)).replace("M68 E0", ""))


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("machine", machine_names())
def test_all_machines_speak_all_dialects(name: str, machine: str) -> None:
    blocks = wound()
    used = read_machine(machine)
    found = back(name, text_of(name, blocks, used), blocks, used)
    assert found.same
    assert found.rows == len(blocks) - 1
    assert found.touch < 1e-6
    assert found.seconds < 1e-6


@pytest.mark.parametrize("name", ALL)
def test_many_turns_are_never_rewound(name: str) -> None:
    """80 turns in 20 circuits: no word of the mandrel is larger than a circuit, but where it counts on without end."""
    blocks = wound(turns=80.0, count=2000, circuits=20)
    text = text_of(name, blocks)
    letter = "E1" if name == "krl" else "A"
    values = [float(value) for value in re.findall(rf"{letter}(?:=IC\(| )?(-?[\d.]+)", "\n".join(body(text)))]
    assert max(values) < (20.0 + 80.0 * 360.0 + 1.0 if name == "krl" else 360.0 * (80.0 / 20.0 + 1.0) + 1.0)
    assert back(name, text, blocks).same
    reading = read_text(text, fitted(LATHE, DIALECTS[name]))
    turned = np.diff(reading.values[:, 0])
    assert turned.min() > 0.0
    assert float(turned.sum()) == pytest.approx(80.0 * 360.0 * (1998 / 1999), abs=1e-3)


def broken(text: str, pattern: str, change: str, place: int = 20) -> tuple[str, int]:
    """A text with the match of a pattern on one of its moves changed, and the number of that line."""
    lines = text.splitlines()
    found = [k for k, line in enumerate(lines) if re.search(pattern, line)]
    where = found[min(place, len(found) - 1)]
    lines[where] = re.sub(pattern, change, lines[where], count=1)
    return "\n".join(lines) + "\n", where + 1


MENDED = {
    "an angle is off by 0.02 degrees": (r"(?<![A-Z])A(=IC\()?(\d+)\.(\d)\d*", r"A\1\2.\g<3>99"),
    "a carriage is off by 1 mm": (r"X=?(\d+)\.", r"X=9\1."),
    "a feed is 1 % off": (r"F(\d)(\d)(\d)", r"F\g<1>9\g<3>"),
    "a move is missing": (r"^.*G1.*$", ""),
    "a feed is missing": (r" ?F[\d.]+$", ""),
    "an axis is named twice": (r"(X=?[-\d.]+)", r"\1 \1"),
    "a rapid rewind": (r"G1( ?)", r"G0\1"),
    "a word that is not known": (r"G1( ?)", r"G68\1"),
    "a letter that no axis has": (r"X", "U"),
    "a comma for a point": (r"(\d)\.(\d)", r"\1,\2"),
    "lengths in inches": (r"G1( ?)", r"G20 G1\1"),
    "a character that is not ASCII": (r"G1( ?)", "G1\\1\u00a0"),
}


@pytest.mark.parametrize("name", sorted(set(ALL) - {"krl"}))
@pytest.mark.parametrize("fault", MENDED)
def test_a_text_that_says_something_else_is_caught_at_its_line(name: str, fault: str) -> None:
    blocks = wound()
    pattern, change = MENDED[fault]
    if name != "siemens":
        change = change.replace("=", "")
    text, line = broken(text_of(name, blocks), pattern, change)
    found = back(name, text, blocks)
    assert found.faults, (name, fault)
    if fault == "a move is missing":
        line += 1  # found where the next one leads elsewhere
    assert found.faults[0][0] == line


@pytest.mark.parametrize(("pattern", "change", "later"), [
    (r"E1 (\d+)\.(\d)\d*", r"E1 \1.\g<2>99", 0), (r"LIN .*C_DIS", "", 2), (r"X (\d)", r"X 1\1", 0),
    (r"VEL.CP=0.0(\d)", r"VEL.CP=0.00\1", 1), (r"A 0.0", "A 5.0", 0), (r"LIN", "PTP", 0), (r"C_DIS", "C_PTP", 0),
    (r", Z 0.0", "", 0),
])  # fmt: skip
def test_a_text_for_a_robot_that_says_something_else_is_caught_at_its_line(
    pattern: str, change: str, later: int
) -> None:
    blocks = wound()
    text, line = broken(text_of("krl", blocks), pattern, change)
    assert back("krl", text, blocks).faults[0][0] == line + later


@pytest.mark.parametrize("name", ALL)
def test_the_frame_of_a_program_is_read_too(name: str) -> None:
    blocks = wound()
    text = text_of(name, blocks)
    stop, end = DIALECTS[name].pause, DIALECTS[name].end[0]
    without_stop = "\n".join(line for line in text.splitlines() if not re.search(rf"(^|\s){stop}$", line))
    assert any("no stop" in words for _, words in back(name, without_stop, blocks).faults)
    cut = text[: text.rindex(end)]
    assert any("ends the program" in words for _, words in back(name, cut, blocks).faults)
    lines = text.splitlines()
    last = max(k for k, line in enumerate(lines) if re.search(r"G1\b|G1[A-Z]|LIN", line))
    assert any("the text ends" in words for _, words in back(name, "\n".join(lines[:last]), blocks).faults)
    assert any("comes after the end" in words for _, words in back(name, f"{text}G4 X1\n", blocks).faults)


def test_a_robots_orientation_is_that_of_the_fibre() -> None:
    """A, B, C turn tool z into the fibre's direction, seen from the axis: along it, to the eye, and square to both."""
    columns = np.array([[10.0, 5.0, 40.0, 25.0, -15.0], [12.0, 6.0, 41.0, 70.0, 30.0]])
    blocks = blocks_of(columns, np.array([0.0, 1.0]), np.array([0, 0]))
    for machine in (read_machine("robot"), read_machine("lathe-5")):
        line = body(text_of("krl", blocks, machine))[-2]
        a, b, c = (np.radians(float(re.findall(rf"\b{letter} (-?[\d.]+)", line)[0])) for letter in "ABC")
        z = np.array([0.0, 0.0, 1.0])
        z = np.array([[1, 0, 0], [0, np.cos(c), -np.sin(c)], [0, np.sin(c), np.cos(c)]]) @ z
        z = np.array([[np.cos(b), 0, np.sin(b)], [0, 1, 0], [-np.sin(b), 0, np.cos(b)]]) @ z
        z = np.array([[np.cos(a), -np.sin(a), 0], [np.sin(a), np.cos(a), 0], [0, 0, 1]]) @ z
        roll, yaw = np.radians([70.0, 30.0])
        along, outward, square = np.cos(yaw) * np.sin(roll), np.sin(yaw), np.cos(yaw) * np.cos(roll)
        assert z == pytest.approx([along, outward, square], abs=1e-6)


def test_feeds_are_units_a_minute_of_what_each_controller_measures() -> None:
    """3 mm and 4 mm in a second with 12 degrees: 300 mm a minute along X and Y, 13 units a second over all axes."""
    blocks = blocks_of(
        np.array([[0.0, 0.0, 10.0, 0.0, 0.0], [12.0, 3.0, 14.0, 0.0, 0.0]]), np.array([0.0, 1.0]), np.array([0, 0])
    )
    machine = replace(LATHE, feed="G94")
    wanted = {"linuxcnc": "300.0", "marlin": "300.0", "grbl": "780.0", "fanuc": "780.0", "siemens": "780.0"}
    for name, feed in wanted.items():
        text = text_of(name, blocks, machine)
        assert re.findall(r"G1.*F([\d.]+)", text) == [feed]
        assert back(name, text, blocks, machine).same
    assert "$VEL.CP=0.005\n" in text_of("krl", blocks, machine)
    seconds = replace(LATHE, feed="G93-seconds", dialect="siemens")
    assert re.findall(r"G1.*F([\d.]+)", text_of("siemens", blocks, seconds)) == ["1.0"]


def test_the_header_says_what_an_operator_needs() -> None:
    axes = (*LATHE.axes[:2], replace(LATHE.axes[2], low=0.0, high=400.0, sign=-1, zero=7.5))
    machine = replace(LATHE, axes=axes, words="in the hall")
    blocks = wound()
    for name, said in DIALECTS.items():
        text = text_of(name, replace(blocks, tension=np.full(len(blocks), 20.0)), machine, Job("Vas\u00e9 (2); %1"))
        head = " ".join(line.strip("(;) ") for line in text.splitlines() if line.startswith(said.comment[0])).lower()
        for words in (said.words.lower(), "lathe-4, in the hall", "mm and degrees", "20.4 s", "circuits", "20 n",
                      "reversed, 0 at 7.5, travel 0 to 400", "turns the mandrel", "mark", "never rewound"):  # fmt: skip
            assert words.replace(":", "") in head.replace(":", ""), (name, words)
        assert "vas" in head
        assert not re.search(r"vas\S* \(2", head)


def test_decimals_are_those_of_the_control() -> None:
    """Fanuc's IS-B holds three decimals and IS-C four: a control rounds longer ones, so that they must not be given."""
    blocks = wound()
    coarse = replace(LATHE, dialect="fanuc", decimals=3)
    texts = {each.decimals: text_of("fanuc", blocks, each) for each in (replace(coarse, decimals=None), coarse)}
    assert "OF WHICH THIS TEXT HAS 4" in texts[None].replace("\n", " ").replace(")(", "")
    for decimals, text in texts.items():
        assert max(len(each) for each in re.findall(r"G1 A\d+\.(\d+)", text)) == (decimals or 4)
    assert back("fanuc", texts[3], blocks, coarse).same
    assert 1e-6 < back("fanuc", texts[3], blocks, coarse).touch < 3e-6
    refused = back("fanuc", texts[None], blocks, coarse).faults
    assert any(words == "more than the 3 decimals that the control takes" for _, words in refused)
    assert not back("linuxcnc", text_of("linuxcnc", blocks, coarse), blocks, coarse).faults


def test_the_command_of_a_tension_is_said_in_its_own_dialect_alone() -> None:
    blocks = replace(wound(), tension=np.full(60, 20.0))
    for name in ALL:
        text = text_of(name, blocks)
        assert ("M68 E0 Q20" in text) == (name == "linuxcnc")
        assert ("set it by hand" in text.lower()) == (name != "linuxcnc")
        assert back(name, text, blocks).same


def test_a_line_of_many_numbers_that_is_no_program_is_refused_at_once() -> None:
    """Were its words tried in all ways in which their digits can be split, 30 of them would take ages."""
    text = f"{30 * 'A123456 '}?\n"
    faults = read_text(text, fitted(LATHE, DIALECTS["linuxcnc"])).faults
    assert any("is not understood" in words for _, words in faults)


def test_files_have_names_of_their_own() -> None:
    names = file_names(ALL)
    assert len(set(names.values())) == len(ALL)
    assert names["linuxcnc"] == "program.ngc"
    assert names["grbl"] == "program_grbl.gcode"
    assert file_names(["grbl"]) == {"grbl": "program.gcode"}


def test_the_last_decimal_of_a_feed_does_not_add_up() -> None:
    """What a feed's figures leave out, the next block makes up: the time is right at every block."""
    blocks = wound(turns=50.0, count=20_000, circuits=50)
    reading = read_text(text_of("linuxcnc", blocks), fitted(LATHE, DIALECTS["linuxcnc"]))
    assert np.abs(np.cumsum(reading.seconds) - blocks.time[1:]).max() < 1e-8


@pytest.mark.parametrize(("machine", "name", "says"), [
    (replace(LATHE, dialect="grbl", axes=tuple(replace(each, letter=each.letter + "1") for each in LATHE.axes)), "grbl",
     "machine lathe-4 has an axis 'A1', which GRBL 1.1 does not have as that; give Y for mandrel"),
    (replace(LATHE, dialect="marlin"), "marlin",
     "feed of machine lathe-4 is 'G93', which Marlin 2 does not know; give G94"),
    (replace(LATHE, dialect="grbl", axes=(replace(LATHE.axes[0], modulo=360.0), *LATHE.axes[1:])), "grbl",
     "axis 'A' of machine lathe-4 has a modulo, which GRBL 1.1 does not know; leave modulo out"),
    (replace(LATHE, dialect="krl", feed="G94"), "krl",
     "has an axis 'A', which KUKA KRL does not have as that; give E1"),
])  # fmt: skip
def test_a_machine_that_its_own_dialect_cannot_name_is_refused(machine: Machine, name: str, says: str) -> None:
    with pytest.raises(BadInputError, match=re.escape(says)):
        text_of(name, wound(), machine)


def test_machines_may_speak_all_dialects() -> None:
    assert tuple(DIALECTS) == DIALECT_NAMES


def test_wrong_input_is_one_line() -> None:
    blocks = wound()
    with pytest.raises(BadInputError, match="no dialect 'gbrl'; did you mean 'grbl'"):
        dialect("gbrl")
    long = replace(LATHE, dialect="grbl", tension=f"M3{' ' * 70}S{{tension:g}}")
    with pytest.raises(BadInputError, match="over 69 characters"):
        text_of("grbl", replace(blocks, tension=blocks.time), long)
    with pytest.raises(BadInputError, match="not finite"):
        text_of("linuxcnc", replace(blocks, roll=np.full(len(blocks), np.nan)))
