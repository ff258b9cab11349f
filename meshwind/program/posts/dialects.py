"""The dialects that are written: LinuxCNC, GRBL, Marlin, Fanuc, Siemens 840D and KUKA KRL."""

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest
from meshwind.program.posts.dialect import ALL_INCREMENTS, INCREMENTS, ON, Dialect, Speeds

STEM = "program"
"""Name of a program's files, before their ending."""
_LATHE = (("mandrel", "A", 1), ("carriage", "X", 1), ("cross", "Y", 1), ("roll", "B", 1), ("yaw", "C", 1))
"""Usual letters of a lathe."""
_BY_KIND = tuple(Speeds(letters, "F{feed}") for letters in ("[XYZ]", "[UVW]", "[ABC]"))
"""F is the speed along X, Y, Z; where they stand still along U, V, W; and else about A, B, C."""
_TOGETHER = (Speeds(".*", "F{feed}"),)
"""F is the speed of all axes together, with a degree as long as a millimetre."""

_LINUXCNC = Dialect(
    name="linuxcnc",
    words="LinuxCNC",
    ending="ngc",
    letters="[XYZABCUVW]",
    usual=_LATHE,
    feeds=("G93", "G94"),
    speeds=_BY_KIND,
    start=("G21 G17 G40 G49 G90 G94", "G64 P0.05"),
    ready=("{mode}",),
    end=("M2",),
    turned=("{letter}{value}", "{letter}-{value}"),
    longest=255,
    notes=("an axis with a modulo is a WRAPPED_ROTARY axis",),
)
_GRBL = Dialect(
    name="grbl",
    words="GRBL 1.1",
    ending="gcode",
    letters="[XYZABC]",
    usual=(("mandrel", "Y", 1), ("carriage", "X", 1), ("cross", "Z", 1), ("roll", "A", 1), ("yaw", "B", 1)),
    feeds=("G93", "G94"),
    speeds=_TOGETHER,
    start=("G21G17G90G94",),
    ready=("{mode}",),
    end=("M2",),
    rapid="G0{axes}",
    move="G1{axes}{feed}",
    reset="G92{axes}",
    dwell="G4P{wait}",
    between="",
    decimals=4,
    longest=69,
    notes=("axes but X, Y and Z need a GRBL that has them",),
)
_MARLIN = Dialect(
    name="marlin",
    words="Marlin 2",
    ending="gcode",
    letters="[XYZABCUVW]",
    usual=_LATHE,
    feeds=("G94",),
    speeds=_BY_KIND,
    start=("G21", "G90"),
    end=("M400",),
    comment="; {text}",
    rapid="G0 {axes} F{rapid}",
    dwell="G4 P{wait}",
    dwell_unit=1e-3,
    dwell_decimals=0,
    decimals=4,
    longest=95,
    notes=("A, B and C are axes 4 to 6 of Marlin, set up as rotary ones",),
)
_FANUC = Dialect(
    name="fanuc",
    words="Fanuc",
    ending="nc",
    letters="[XYZABCUVW]",
    usual=_LATHE,
    feeds=("G94", "G93", "G93-seconds"),
    speeds=_TOGETHER,
    head=("%", "O0001"),
    start=("G21 G17 G40 G49 G80 G64 G90 G94",),
    ready=("G91 {mode}",),
    end=("M30", "%"),
    rapid="G90 G0 {axes}",
    rapid_turn="G91 G0 {axes}",
    pause="M00",
    dwell="G04 P{wait}",
    dwell_unit=1e-3,
    dwell_decimals=0,
    turning=ALL_INCREMENTS,
    decimals=4,
    numbers=1,
    highest=99_999,
    upper=True,
    plain=r"[^A-Z0-9 .,+\-=/*]",
    notes=(
        "increment system of the control: IS-C for 4 decimals, IS-B for 3, of which this text has {decimals}",
        "a coarser control rounds each increment and drifts, give its decimals in the file of the machine",
    ),
)
_SIEMENS = Dialect(
    name="siemens",
    words="Siemens 840D",
    ending="mpf",
    letters="[XYZABCUVW][0-9]*",
    usual=_LATHE,
    feeds=("G94", "G93", "G93-seconds"),
    speeds=_TOGETHER,
    head=("%_N_PROGRAM_MPF", ";$PATH=/_N_MPF_DIR"),
    start=("G17 G40 G64 G90 G94 G710", "FGROUP({letters})"),
    ready=("{mode}",),
    end=("M30",),
    comment="; {text}",
    dwell="G4 F{wait}",
    word="{letter}={value}",
    turned=("{letter}=ACP({value})", "{letter}=ACN({value})"),
    turning=INCREMENTS,
    increment="{letter}=IC({value})",
    numbers=10,
    notes=("FGREF of rotary axes as it is set at first, so that F takes a degree as 1 mm",),
)
_KRL = Dialect(
    name="krl",
    words="KUKA KRL",
    ending="src",
    letters="[XYZABC]|E[1-6]",
    usual=(("mandrel", "E1", 1), ("carriage", "X", 1), ("cross", "Y", 1), ("roll", "B", 1), ("yaw", "C", -1)),
    feeds=("G94",),
    speeds=(
        Speeds("[XYZ]", "$VEL.CP={feed}", 1.0 / 60_000.0),
        Speeds("E[1-6]", "$VEL_EXTAX[{number}]={feed}", 100.0 / 60.0, share=True),
        Speeds("[ABC]", "$VEL.ORI1={feed}", 1.0 / 60.0),
    ),
    head=("&ACCESS RVP", "&REL 1", "DEF program( )"),
    start=(
        "BAS (#INITMOV,0)", "$BASE=BASE_DATA[1]", "$TOOL=TOOL_DATA[1]",
        "$APO.CDIS=0.5", "PTP $AXIS_ACT", "$VEL.CP=0.1",
    ),
    end=("END",),
    comment="; {text}",
    rapid="LIN {{{axes}}}",
    move="{feed}\nLIN {{E6POS: {axes}}} C_DIS",
    pause="HALT",
    dwell="WAIT SEC {wait}",
    word="{letter} {value}",
    between=", ",
    turned=("{letter} {value}", "{letter} {value}"),
    turning=ON,
    decimals=4,
    fixed=tuple((letter, 0.0) for letter in "XYZABC"),
    whole=True,
    notes=(
        "base 1 has x along the axis of the mandrel, y from the axis to the eye",
        "tool 1 has z along the span, away from the part",
        "E1 is an endless axis",
    ),
)  # fmt: skip

DIALECTS = {each.name: each for each in (_LINUXCNC, _GRBL, _MARLIN, _FANUC, _SIEMENS, _KRL)}
"""The dialects by name."""


def dialect(name: str) -> Dialect:
    """The dialect of a name; raises BadInputError if there is none."""
    if name.lower() not in DIALECTS:
        raise BadInputError(f"no dialect {name!r}; {nearest(name, DIALECTS)}")
    return DIALECTS[name.lower()]


def file_names(names: list[str]) -> dict[str, str]:
    """The file of each of the dialects that are written together: no two have the same."""
    endings = [dialect(name).ending for name in names]
    return {
        name: f"{STEM}{'' if endings.count(ending) == 1 else f'_{dialect(name).name}'}.{ending}"
        for name, ending in zip(names, endings, strict=True)
    }
