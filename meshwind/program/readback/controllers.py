"""What controllers do with a text, by their manuals: comments, feeds, waits, and what they hold."""

import math
from dataclasses import dataclass

from meshwind.program.machine import Machine


@dataclass(frozen=True)
class Controller:
    """How a controller reads.

    Attributes
    ----------
    comment : str
        Expression of comments and of lines that move nothing.
    longest : int
        Characters that a line may have.
    digit : float
        The least step of an axis that the controller's numbers hold, in mm and degrees, if the machine says no other.
    wait : str
        The letter of a wait's time.
    wait_unit : float
        Its unit in seconds.
    kinds : tuple of str
        F in units a minute is the speed of the first of these groups of letters that moves.
    inverse : bool
        Whether it knows G93.
    ends : tuple of str
        Words of which one ends a program.
    rounds : bool, default False
        Whether it rounds what an axis is given to its least step, so that longer numbers are not what they say.
    """

    comment: str
    longest: int
    digit: float
    wait: str
    wait_unit: float
    kinds: tuple[str, ...]
    inverse: bool
    ends: tuple[str, ...]
    rounds: bool = False

    def decimals(self, machine: Machine) -> int:
        """Decimals that the control of a machine takes."""
        return -round(math.log10(self.digit)) if machine.decimals is None else machine.decimals


_NIST = ("XYZ", "UVW", "ABC")
_ALL = ("XYZUVWABC",)
CONTROLLERS = {
    "linuxcnc": Controller(r"\([^()]*\)|;.*", 255, 1e-5, "P", 1.0, _NIST, True, ("M2", "M30")),
    "grbl": Controller(r"\([^()]*\)|;.*", 69, 1e-4, "P", 1.0, _ALL, True, ("M2", "M30")),
    "marlin": Controller(r";.*", 95, 1e-4, "P", 1e-3, _NIST, False, ("M400",)),
    "fanuc": Controller(r"\([^()]*\)|^%$|^O\d+$|^N\d+ ", 120, 1e-4, "P", 1e-3, _ALL, True, ("M30", "M2"), True),
    "siemens": Controller(r";.*|^%_N_\w+$|^N\d+ (?:FGROUP\([^()]*\))?", 120, 1e-5, "F", 1.0, _ALL, True, ("M30", "M2")),
    "krl": Controller(r";.*|^&.*", 120, 1e-4, "", 1.0, ("XYZ", "E", "ABC"), False, ("END",)),
}
"""Controllers by the name of their dialect."""
