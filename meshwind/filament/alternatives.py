"""Other patterns near the one that a layer closes in, and what each costs."""

from dataclasses import dataclass
from math import atan, ceil, degrees, gcd, radians, tan

from meshwind.filament.pattern import Pattern

_MORE = 0.05
"""Circuits more, over those of the layer, that are looked at."""
_OFFERED = 5
"""Alternatives that are offered."""
_PER_CIRCUIT = 20.0
"""Degrees of winding angle that as many circuits again are worth: a band too many costs fibre, not shape."""


@dataclass(frozen=True)
class Alternative:
    """A pattern that the layer could close in as well.

    revolutions: turns of a path; angle: about the median winding angle, in degrees; cover: over the layer's own; dwell:
    turns a circuit that are added if the revolutions stay as they are, or None where that would be less than needed.
    """

    pattern: Pattern
    revolutions: float
    angle: float
    cover: float
    dwell: float | None


def alternatives(pattern: Pattern, revolutions: float, dwells: float, angle: float) -> list[Alternative]:
    """The best alternatives to a pattern, by the change of the winding angle and of the number of circuits.

    Parameters
    ----------
    pattern : Pattern
        The layer's own.
    revolutions : float
        Turns of its paths.
    dwells : float
        Turns that its turnarounds take a circuit.
    angle : float
        Median winding angle in degrees.

    Returns
    -------
    list of Alternative
        At most five, the best one first.
    """
    found: list[tuple[float, Alternative]] = []
    whole = 2.0 * revolutions + dwells
    for circuits in range(pattern.circuits, pattern.circuits + ceil(_MORE * pattern.circuits) + 1):
        middle = round(whole * circuits)
        for turns in range(max(middle - 3, 0), middle + 4):
            if gcd(turns, circuits) != 1 or (circuits, turns) == (pattern.circuits, pattern.turns):
                continue
            turned = 0.5 * (turns / circuits - dwells)
            if turned < 0.0:
                continue
            about = degrees(atan(tan(radians(angle)) * turned / revolutions)) if revolutions > 0.0 else angle
            cover, more = circuits / pattern.circuits, turns / circuits - whole
            each = Alternative(Pattern(circuits, turns), turned, about, cover, more if more >= 0.0 else None)
            found.append((abs(about - angle) + _PER_CIRCUIT * (cover - 1.0), each))
    return [each for _, each in sorted(found, key=lambda pair: (pair[0], pair[1].pattern.circuits))][:_OFFERED]
