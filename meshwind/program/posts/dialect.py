"""A dialect: how a controller wants numbers, axes, feeds and turns to be written, as data."""

import re
from dataclasses import dataclass, replace

from meshwind.core.errors import BadInputError
from meshwind.program.machine import Axis, Machine

RESET, INCREMENTS, ALL_INCREMENTS, ON = "reset", "increments", "all increments", "on"
"""How turns without end are written.

The count is reset by whole turns at each circuit; the mandrel, or every axis, moves by increments; or it counts on.
"""


@dataclass(frozen=True)
class Speeds:
    """What states the speed of a block of a given time.

    Attributes
    ----------
    letters : str
        Expression that the letters of the axes match whose common length the speed is of.
    text : str
        The word, with {feed} in place of the number and {number} for that of an external axis.
    factor : float, default 1
        Number for one mm or degree a minute.
    share : bool, default False
        Whether the number is in per cent of the axis's largest speed.
    """

    letters: str
    text: str
    factor: float = 1.0
    share: bool = False


@dataclass(frozen=True)
class Dialect:
    """The words of a controller.

    Attributes
    ----------
    name, words, ending : str
        Its name, the controller in words, and the ending of its files.
    letters : str
        Expression that the letters of its axes match.
    usual : tuple of (str, str, int)
        What each axis moves, its usual letter and its sign, for machines whose letters are not of this dialect.
    feeds : tuple of str
        The feed conventions that it knows, the usual one first.
    speeds : tuple of Speeds
        For feeds in units a minute: the first of which an axis moves states the speed.
    head, start, ready, end : tuple of str
        Lines before the header, before the approach, after it, and at the end; {letters} are those of the axes, {mode}
        is the mode of feeds.
    comment : str
        A comment with {text}.
    rapid, rapid_turn, move, reset, pause, dwell : str
        A move of the approach and that of an axis by an increment, a move of the program, a new count, a stop that
        waits for the operator, and a wait.
    word, between : str
        An axis with its value, and what separates two of them.
    turned : tuple of str or None
        An axis that counts from 0 again after some degrees, where it moves forwards and backwards; None if unknown.
    turning : str
        `RESET`, `INCREMENTS`, `ALL_INCREMENTS` or `ON`.
    increment : str
        An axis that moves by an increment.
    decimals : int
        Decimals of mm and degrees where the machine says no other.
    dwell_unit : float
        Seconds in the unit of a wait.
    dwell_decimals : int
        Decimals of a wait.
    longest : int
        Characters in a line.
    numbers : int
        Step of the numbers of lines, 0 for none.
    highest : int
        Number of a line after which they start again.
    fixed : tuple of (str, float)
        Letters that are written with a value where no axis has them.
    whole : bool
        Whether every move names every axis.
    upper, plain : bool, str
        Whether comments are in capitals, and an expression for characters that they must not hold.
    notes : tuple of str
        What the operator must know of it, with {decimals} in place of their number.
    """

    name: str
    words: str
    ending: str
    letters: str
    usual: tuple[tuple[str, str, int], ...]
    feeds: tuple[str, ...]
    speeds: tuple[Speeds, ...]
    start: tuple[str, ...]
    end: tuple[str, ...]
    head: tuple[str, ...] = ()
    ready: tuple[str, ...] = ()
    comment: str = "({text})"
    rapid: str = "G0 {axes}"
    rapid_turn: str = "G0 {axes}"
    move: str = "G1 {axes} {feed}"
    reset: str = "G92 {axes}"
    pause: str = "M0"
    dwell: str = "G4 P{wait}"
    word: str = "{letter}{value}"
    between: str = " "
    turned: tuple[str, str] | None = None
    turning: str = RESET
    increment: str = "{letter}{value}"
    decimals: int = 5
    dwell_unit: float = 1.0
    dwell_decimals: int = 3
    longest: int = 120
    numbers: int = 0
    highest: int = 99_999_999
    fixed: tuple[tuple[str, float], ...] = ()
    whole: bool = False
    upper: bool = False
    plain: str = r"[()\[\]{};%]"
    notes: tuple[str, ...] = ()


def fitted(machine: Machine, dialect: Dialect) -> Machine:
    """The machine as a dialect speaks of it: with axes that it can name, and a feed that it knows.

    A machine that is made for the dialect must fit as it is.  Any other one has the dialect's usual letters where its
    own are not among those of the dialect, the usual feed and decimals, and no command of the tension, as its own is in
    other words.  Raises BadInputError if it cannot be said.
    """
    own = machine.dialect == dialect.name
    axes, feed = machine.axes, machine.feed
    strange = next((each.letter for each in axes if not _named(each, dialect)), None)
    if strange is not None:
        if own:
            raise BadInputError(
                f"machine {machine.name} has an axis {strange!r}, which {dialect.words} does not have as that; give "
                + ", ".join(f"{letter} for {moves}" for moves, letter, _ in dialect.usual)
            )
        usual = {moves: (letter, sign) for moves, letter, sign in dialect.usual}
        axes = tuple(replace(each, letter=usual[each.moves][0], sign=each.sign * usual[each.moves][1]) for each in axes)
    if feed not in dialect.feeds:
        if own:
            raise BadInputError(
                f"feed of machine {machine.name} is {feed!r}, which {dialect.words} does not know; give "
                + " or ".join(dialect.feeds)
            )
        feed = dialect.feeds[0]
    counted = next((each for each in axes if each.modulo), None)
    if counted and dialect.turned is None and dialect.turning != ALL_INCREMENTS:
        if own:
            raise BadInputError(
                f"axis {counted.letter!r} of machine {machine.name} has a modulo, which {dialect.words} does not know; "
                "leave modulo out"
            )
        axes = tuple(replace(each, modulo=None) for each in axes)
    decimals = dialect.decimals if machine.decimals is None or not own else machine.decimals
    tension = machine.tension if own else ""
    return replace(machine, axes=axes, feed=feed, dialect=dialect.name, decimals=decimals, tension=tension)


def decimals_of(machine: Machine, dialect: Dialect) -> int:
    """Decimals of mm and degrees in the text for a machine."""
    return dialect.decimals if machine.decimals is None else machine.decimals


def _named(axis: Axis, dialect: Dialect) -> bool:
    """Whether a dialect has an axis of that letter for what it moves."""
    wanted = next(letter for moves, letter, _ in dialect.usual if moves == axis.moves)
    outside = re.compile(r"E\d")  # a robot's external axes turn the mandrel, and those of the arm do not
    same = (outside.fullmatch(axis.letter) is None) == (outside.fullmatch(wanted) is None)
    return same and re.fullmatch(dialect.letters, axis.letter) is not None
