"""Machines as data: their axes, feed and dialect, from a TOML file that is shipped or the user's own."""

from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from meshwind.core.brief import brief
from meshwind.core.defaults import MACHINE
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest, read_toml
from meshwind.core.shipped import Shipped

MOVES = {"mandrel": "deg", "carriage": "mm", "cross": "mm", "roll": "deg", "yaw": "deg"}
"""What an axis may move, and in which unit."""
FEEDS = "G93", "G93-seconds", "G94"
"""What F says: 1 over the block's minutes, the block's seconds, or units a minute."""
DIALECT_NAMES = "linuxcnc", "grbl", "marlin", "fanuc", "siemens", "krl"
"""Dialects that a machine may speak: those of `posts.dialects`."""
LEAST_MODULO = 30.0
"""Least modulo in degrees: an axis goes up to 10 degrees in a block, and where it turned to must be plain from it."""
_SPEEDS = 1e-3, 1e9
"""Least and largest speed and acceleration that numbers of a program can tell, in mm or degrees a second (squared)."""
_FARTHEST = 1e6
"""Largest zero and travel in mm or degrees: at more of them numbers of a program hold no hundredth of a degree."""
_DECIMALS = 3, 6
"""Fewest and most decimals: fewer hold no hundredth of a degree after many moves, more are none of a machine's."""
_SHIPPED = Shipped(__package__, "machines", "machine")
_NEEDED = "mandrel", "carriage"
"""Axes without which nothing can be wound."""
_NEEDED_OF_AXIS = "moves", "letter", "speed", "acceleration"
"""What an axis has no default for."""


@dataclass(frozen=True)
class Axis:
    """One axis: the machine's value is sign * q + zero for a value q of the program, in mm or degrees.

    Parameters
    ----------
    moves : str
        What it moves: "mandrel", "carriage", "cross", "roll" or "yaw".
    letter : str
        Its letter or name in the machine's text.
    speed, acceleration : float
        Largest speed and acceleration, in mm or degrees a second (squared).
    sign : int, default 1
        1 or -1.
    zero : float, default 0
        The machine's value where the program's is 0.
    low, high : float or None, default None
        Travel, in the machine's values; None if there is no limit.
    modulo : float or None, default None
        Degrees after which a rotary axis counts from 0 again; None if it counts on without end.
    """

    moves: str
    letter: str
    speed: float
    acceleration: float
    sign: int = 1
    zero: float = 0.0
    low: float | None = None
    high: float | None = None
    modulo: float | None = None

    @property
    def unit(self) -> str:
        """The unit of its values: mm or deg."""
        return MOVES[self.moves]


@dataclass(frozen=True)
class Eye:
    """The body of an eye: a ball, a box or a mesh, one of them, or nothing.

    Its frame has the origin where the fibre leaves it, x along the span away from the part, y along the roller over
    which the fibre runs, and z = x cross y; it is turned by the axes for roll and yaw that the machine has.  At roll
    and yaw 0 x leads round the mandrel's axis, y along it, and z from it.

    Parameters
    ----------
    ball : float, default 0
        Radius in mm of a ball about the origin.
    box : tuple of three float or None, default None
        Lengths in mm along the span, from the origin on, along the roller and across both, with the origin in their
        middle.
    mesh : str or None, default None
        File of a closed mesh in mm, in the eye's frame; its path is relative to the machine's file.
    """

    ball: float = 0.0
    box: tuple[float, ...] | None = None
    mesh: str | None = None


@dataclass(frozen=True)
class Machine:
    """A winding machine.

    Parameters
    ----------
    name, words : str
        Its name, and what it is in words.
    axes : tuple of Axis
        Its axes, 2 to 5; mandrel and carriage at least.
    dialect : str, default "linuxcnc"
        The words in which its program is written.
    feed : str, default "G93"
        What F says: "G93" 1 over the block's minutes, "G93-seconds" the block's seconds, "G94" units a minute.
    tension : str, default ""
        The command that sets the tension, with {tension} in place of the newtons; "" if there is none.
    fibre_speed : float, default 500
        Largest speed at which fibre is laid, in mm a second.
    clearance : float or None, default None
        Least distance of the eye from part and shaft in mm; None for a share of the part.
    eye_radius : float or None, default None
        Distance of an eye without a cross axis from the mandrel's axis, in mm; None for what the part needs.
    eye : Eye, default nothing
        The eye's body, which must stay clear of part and shaft.
    shaft : float, default 0
        Radius of the shaft that holds the part at both ends, in mm; 0 if there is none.
    decimals : int or None, default None
        Decimals of mm and degrees that its control takes, 3 to 6; None for those that its dialect usually has.
    """

    name: str
    words: str
    axes: tuple[Axis, ...]
    dialect: str = "linuxcnc"
    feed: str = "G93"
    tension: str = ""
    fibre_speed: float = 500.0
    clearance: float | None = None
    eye_radius: float | None = None
    eye: Eye = Eye()
    shaft: float = 0.0
    decimals: int | None = None

    __repr__ = brief

    def axis(self, moves: str) -> Axis | None:
        """The axis that moves something, None if the machine has none."""
        return next((each for each in self.axes if each.moves == moves), None)


def machine_names() -> list[str]:
    """Names of the machines that are shipped."""
    return _SHIPPED.names


def read_machine(name: str = MACHINE) -> Machine:
    """Read a machine by its name or from a TOML file; raises BadInputError where it is not one."""
    file = _SHIPPED.file(name)
    return machine_of(read_toml(file, "machine"), str(file))


def machine_of(table: dict[str, Any], source: str) -> Machine:
    """A machine from the table of its file; raises BadInputError for what is wrong there."""
    found = _record(Machine, table, f"machine {source}", {"name": Path(source).stem, "words": ""})
    rows = table.get("axes")
    if not isinstance(rows, list) or not all(isinstance(row, dict) for row in rows):
        raise BadInputError(f"machine {source} has no axes; give [[axes]] with moves, letter, speed and acceleration")
    axes = tuple(Axis(**_record(Axis, row, f"axis {k + 1} of machine {source}", {})) for k, row in enumerate(rows))
    machine = Machine(**{**found, "axes": axes, "eye": _eye(table.get("eye", {}), source)})
    _check(machine, source)
    return machine


def _eye(table: Any, source: str) -> Eye:
    """The eye's body from its table, checked."""
    where = f"the eye of machine {source}"
    if not isinstance(table, dict):
        raise BadInputError(f"{where} is {table!r}; give a table [eye] with ball, box or mesh")
    given = _record(Eye, table, where, {})
    if len(given) > 1:
        raise BadInputError(f"{where} has {' and '.join(given)}; give one of ball, box and mesh")
    if not 0.0 <= given.get("ball", 0.0) < float("inf"):
        raise BadInputError(f"ball of {where} is {given['ball']}; give a radius of at least 0")
    if "box" in given:
        lengths = given["box"]
        right = len(lengths) == 3 and all(isinstance(each, int | float) and each is not True for each in lengths)
        if not right or not all(0.0 < each < float("inf") for each in lengths):
            raise BadInputError(f"box of {where} is {lengths}; give 3 lengths above 0: along span, roller, across")
        given["box"] = tuple(float(each) for each in lengths)
    if "mesh" in given:
        given["mesh"] = str(Path(source).parent / given["mesh"])
        if not Path(given["mesh"]).is_file():
            raise BadInputError(f"mesh of {where} is {given['mesh']}, where there is no file; give its path from there")
    return Eye(**given)


def _record(kind: type, table: dict[str, Any], source: str, defaults: dict[str, Any]) -> dict[str, Any]:
    """The values of a table, checked to be those of a record."""
    known = {each.name: getattr(each.type, "__name__", str(each.type)) for each in fields(kind)}
    known |= {name: word for name, word in (("box", "list"), ("eye", "table")) if name in known}
    found = dict(defaults)
    for key, value in table.items():
        if key not in known:
            raise BadInputError(f"{source} has no {key!r}; {nearest(key, known)}")
        number = isinstance(value, int | float) and not isinstance(value, bool)
        if "float" in known[key]:
            right, wanted = number, "a number"
        elif known[key].startswith("int"):
            right, wanted = number and isinstance(value, int), "a whole number"
        elif known[key] == "list":
            right, wanted = isinstance(value, list), "a list of numbers"
        else:
            right = isinstance(value, str) or known[key] == "table" or known[key].startswith("tuple")
            wanted = "text in quotes"
        if not right:
            raise BadInputError(f"{key} of {source} is {value!r}; give {wanted}")
        found[key] = float(value) if "float" in known[key] else value
    lacking = [name for name in _NEEDED_OF_AXIS if name in known and name not in found]
    if lacking:
        raise BadInputError(f"{source} has no {lacking[0]}; give it")
    return found


def _check(machine: Machine, source: str) -> None:
    """Raise BadInputError where values of a machine cannot be."""
    if machine.feed not in FEEDS:
        raise BadInputError(f"machine {source}: feed is {machine.feed!r}; {nearest(machine.feed, FEEDS)}")
    if machine.dialect not in DIALECT_NAMES:
        raise BadInputError(
            f"machine {source}: dialect is {machine.dialect!r}; {nearest(machine.dialect, DIALECT_NAMES)}"
        )
    for name in ("clearance", "eye_radius"):
        value = getattr(machine, name)
        if value is not None and not 0.0 < value < float("inf"):
            raise BadInputError(f"machine {source}: {name} is {value}; give a number above 0")
    if not _SPEEDS[0] <= machine.fibre_speed <= _SPEEDS[1]:
        raise BadInputError(f"machine {source}: fibre_speed is {machine.fibre_speed}; {_within(_SPEEDS)}")
    if not 0.0 <= machine.shaft < float("inf"):
        raise BadInputError(f"machine {source}: shaft is {machine.shaft}; give a number of at least 0")
    _check_tension(machine.tension, source)
    if machine.decimals is not None and not _DECIMALS[0] <= machine.decimals <= _DECIMALS[1]:
        raise BadInputError(f"machine {source}: decimals is {machine.decimals}; {_within(_DECIMALS)}")
    for axis in machine.axes:
        _check_axis(axis, source)
    moves, letters = [each.moves for each in machine.axes], [each.letter for each in machine.axes]
    for what, values in (("move", moves), ("have", letters)):
        twice = next((each for each in values if values.count(each) > 1), None)
        if twice is not None:
            raise BadInputError(f"machine {source}: two axes {what} {twice!r}; give each its own")
    lacking = next((each for each in _NEEDED if machine.axis(each) is None), None)
    if lacking is not None:
        raise BadInputError(f"machine {source}: no axis moves the {lacking}; add [[axes]] with moves = {lacking!r}")


def _check_axis(axis: Axis, source: str) -> None:
    """Raise BadInputError where values of an axis cannot be."""
    where = f"machine {source}: axis {axis.letter!r}"
    if axis.moves not in MOVES:
        raise BadInputError(f"{where} moves {axis.moves!r}; {nearest(axis.moves, MOVES)}")
    if not axis.letter.strip():
        raise BadInputError(f"{where} has no letter; give one")
    for name in ("speed", "acceleration"):
        if not _SPEEDS[0] <= getattr(axis, name) <= _SPEEDS[1]:
            raise BadInputError(f"{where} has the {name} {getattr(axis, name)}; {_within(_SPEEDS)}")
    if axis.sign not in (-1, 1):
        raise BadInputError(f"{where} has the sign {axis.sign}; give 1 or -1")
    if not all(abs(each) <= _FARTHEST for each in (axis.zero, axis.low or 0.0, axis.high or 0.0)):
        raise BadInputError(
            f"{where} has a zero or a travel that is no number or too large; {_within((-_FARTHEST, _FARTHEST))}"
        )
    if axis.low is not None and axis.high is not None and not axis.low < axis.high:
        raise BadInputError(f"{where} travels from {axis.low:g} to {axis.high:g}; give low below high")
    if axis.modulo is not None and not (LEAST_MODULO <= axis.modulo <= _FARTHEST and axis.unit == "deg"):
        raise BadInputError(
            f"{where} has the modulo {axis.modulo:g}; give one of at least {LEAST_MODULO:g}, and of rotary axes only"
        )


def _check_tension(command: str, source: str) -> None:
    """Raise BadInputError where a command is not one line that says the tension."""
    try:
        lines = command.format(tension=1.5).splitlines()
    except (KeyError, IndexError, ValueError, TypeError, AttributeError) as error:
        raise BadInputError(
            f"machine {source}: tension is {command!r}; give the command with {{tension}} or {{tension:.1f}}"
        ) from error
    if command and (len(lines) != 1 or "{" not in command):
        raise BadInputError(f"machine {source}: tension is {command!r}; give one line with {{tension}} in it")


def _within(limits: tuple[float, float]) -> str:
    """What to give instead of a number out of limits."""
    return f"give a number from {limits[0]:g} to {limits[1]:g}"
