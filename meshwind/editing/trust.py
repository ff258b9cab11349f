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

    def after(self, change: float, gaps: tuple[float, float, float]) -> "Trust":
        """That of the next round.

        change: largest of this round; gaps: largest before it, the one that its program expected, and the one it left.
        """
        before, expected, left = gaps
        hoped, gained = before - expected, before - left
        if hoped <= LITTLE * before:
            return replace(self, at_rest=True)
        failed = 0 if gained > 0.0 else self.failed + 1
        near = self.near
        if gained < WRONG * hoped:
            near = change if np.isinf(near) else NEARER * min(change, near)
        elif gained > RIGHT * hoped:
            near = FURTHER * near
        return Trust(near, failed, failed >= FAILED)
