"""The pattern in which the circuits of a layer close to one filament.

A circuit is a path there, a turnaround, a path back and another turnaround.  Paths of a family that do not cross keep
their order around both rims, so that joining each to the one so many places further on turns all N circuits by the same
number of places K: the layer is gcd(K, N) filaments, and one of them after another turns by M/N on average, M being the
turns of the whole layer and K = M mod N.
"""

from dataclasses import dataclass
from math import ceil, floor, gcd, isfinite

from meshwind.core.checks import whole
from meshwind.core.errors import BadInputError

SEARCHED = 1.0
"""Turns a circuit beyond the least within which patterns are looked for."""
_ROUND_OFF = 1e-9
"""Turns a circuit that are round-off."""


@dataclass(frozen=True)
class Pattern:
    """How a layer of circuits closes.

    Attributes
    ----------
    circuits : int
        Circuits N of the layer.
    turns : int
        Turns M of the part while the layer is wound.
    dwell : float
        Turns a circuit that are added to those that it needs at least.

    Examples
    --------
    >>> from meshwind.filament.pattern import Pattern
    >>> pattern = Pattern(circuits=233, turns=277)
    >>> pattern.shift, pattern.number, pattern.leading, pattern.filaments
    (44, 90, False, 1)
    >>> print(pattern.words)
    233 circuits that turn by 277/233 each, 44 places on: pattern 90 lagging, one filament
    """

    circuits: int
    turns: int
    dwell: float = 0.0

    @property
    def shift(self) -> int:
        """Places K by which a circuit is ahead of the one before."""
        return self.turns % self.circuits

    @property
    def filaments(self) -> int:
        """Number of filaments that the layer is made of."""
        return gcd(self.turns, self.circuits)

    @property
    def number(self) -> int:
        """Circuits after which one lies beside the first: the number of zones around the part in which bands cross."""
        return self._neighbour[0]

    @property
    def leading(self) -> bool:
        """Whether that one lies ahead of the first, in the sense of turning, rather than behind it."""
        return self._neighbour[1]

    @property
    def _neighbour(self) -> tuple[int, bool]:
        places, apart = self.circuits, self.filaments
        back = (places - apart) % places
        at = 0
        for k in range(1, places + 1):
            at = (at + self.shift) % places
            if at in (apart % places, back):
                return k, at == apart % places
        raise AssertionError("every multiple of the greatest common divisor is passed")

    @property
    def words(self) -> str:
        """The pattern in a line."""
        many = "one filament" if self.filaments == 1 else f"{self.filaments} filaments"
        side = "leading" if self.leading else "lagging"
        return (
            f"{self.circuits} circuits that turn by {self.turns}/{self.circuits} each, {self.shift} places on: "
            f"pattern {self.number} {side}, {many}"
        )


def patterns(circuits: int, least: float, filaments: int = 1, within: float = SEARCHED) -> list[Pattern]:
    """Find the patterns in which a layer closes.

    Parameters
    ----------
    circuits : int
        Circuits of the layer, at least 1.
    least : float
        Turns that a circuit takes without any dwell: its two paths and its two turnarounds.
    filaments : int, default 1
        Number of filaments that the layer may be made of.
    within : float, default 1
        Turns a circuit that may be added to the least.

    Returns
    -------
    list of Pattern
        Patterns by growing dwell.

    Raises
    ------
    BadInputError
        If a number is out of range.

    Examples
    --------
    >>> from meshwind.filament.pattern import patterns
    >>> first, second, *_ = patterns(circuits=23, least=5.351978)
    >>> first.turns, first.number, first.leading, second.turns, second.number, second.leading
    (124, 5, False, 125, 7, True)
    """
    _check(circuits, least)
    first = ceil((least - _ROUND_OFF) * circuits)
    last = floor((least + within + _ROUND_OFF) * circuits)
    all_ = (Pattern(circuits, turns, max(turns / circuits - least, 0.0)) for turns in range(first, last + 1))
    return [each for each in all_ if each.filaments == filaments]


def nearest_pattern(circuits: int, wanted: float, filaments: int = 1) -> Pattern:
    """Find the pattern whose turns a circuit are nearest to those wanted.

    Parameters
    ----------
    circuits : int
        Circuits of the layer, at least 1.
    wanted : float
        Turns a circuit.
    filaments : int, default 1
        Number of filaments, a divisor of the circuits.

    Returns
    -------
    Pattern
        The pattern, with no dwell: the turns of its paths are to be changed by half the difference each.

    Raises
    ------
    BadInputError
        If a number is out of range, or the filaments cannot share out the circuits.

    Examples
    --------
    By 0.6 turns a path, and a quarter turn at either end:

    >>> from meshwind.filament.pattern import nearest_pattern
    >>> pattern = nearest_pattern(circuits=24, wanted=2 * 0.6 + 0.25 + 0.25)
    >>> round((pattern.turns / pattern.circuits - 0.25 - 0.25) / 2, 6)
    0.604167
    """
    _check(circuits, wanted)
    check_filaments(filaments, circuits)
    middle = round(wanted * circuits)
    for away in range(circuits + 1):
        near = [turns for turns in {middle - away, middle + away} if gcd(turns, circuits) == filaments]
        if near:
            return Pattern(circuits, min(near, key=lambda turns: abs(turns / circuits - wanted)))
    raise AssertionError("one of as many numbers in a row as there are circuits has any divisor of theirs")


def check_filaments(filaments: int, circuits: int) -> None:
    """Raise BadInputError where so many filaments cannot share out the circuits."""
    if filaments < 1 or circuits % filaments:
        raise BadInputError(f"{filaments} filaments cannot share out {circuits} circuits; give a divisor of these")


def _check(circuits: int, turns: float) -> None:
    circuits = whole(circuits, "circuits", 1)
    if not (isfinite(turns) and turns >= 0.0):
        raise BadInputError(f"a circuit of {turns:g} turns cannot be wound; give a number from 0 up")
