"""How far the rounds of an edit may go where fibres stay out of reach: as far as their programs were right.

Fibres touch further out, or move aside, when the surface below them sinks: a program knows neither beyond first order.
Where all can be met that does not matter, as a later round sees it; where the largest gap is to become the least, the
least of the rows alone would be chased from round to round, and none would gain.
"""

from dataclasses import dataclass, replace

import numpy as np

LITTLE = 1e-3
"""Of the largest gap: a gain that is expected of a round, below which the edit is at rest."""
RIGHT, WRONG = 0.7, 0.3
"""Of the gain that was expected: from the first on the next round may go further, below the second less far."""
FURTHER, NEARER = 2.0, 0.4
"""Factors of the distance then."""
FAILED = 4
"""Rounds in succession without a gain after which the edit stops."""


@dataclass(frozen=True)
class Trust:
    """Largest change of a control point in a round, infinite at first, and how many rounds have failed by now."""

    near: float = np.inf
    failed: int = 0
    at_rest: bool = False

    def after(self, change: float, share: float, gaps: tuple[float, float, float]) -> "Trust":
        """That of the next round.

        change: largest of this round's program; share: of it, what was made; gaps: largest before it, the one that the
        program expected of the whole, and the one it left.
        """
        before, expected, left = gaps
        hoped, gained = before - expected, before - left
        if hoped <= LITTLE * before:
            return replace(self, at_rest=True)
        if gained <= 0.0:
            return Trust(share * change, self.failed + 1, self.failed + 1 >= FAILED)
        if share < 1.0:
            return Trust(min(FURTHER * share, 1.0) * change)
        if gained < WRONG * hoped:
            return Trust(NEARER * change)
        return Trust(self.near * (FURTHER if gained > RIGHT * hoped else 1.0))
