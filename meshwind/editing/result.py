"""What a redesign reports: a line of figures for every round, and how it ended."""

from dataclasses import dataclass
from enum import IntEnum


class Outcome(IntEnum):
    """How a redesign ended; 0 is a part on which nothing bridges, anything else comes with advice."""

    WINDABLE = 0
    OUT_OF_REACH = 1
    NO_GAIN = 2
    ROUNDS_SPENT = 3
    NOT_SOLVED = 4
    NOT_KEPT = 5

    @property
    def advice(self) -> str:
        """What the outcome means and what to do about it."""
        return _ADVICE[self]


_ADVICE = {
    Outcome.WINDABLE: "no fibre bridges any more",
    Outcome.OUT_OF_REACH: "the surface cannot reach the fibre within what may move: allow a larger displacement, "
    "freeze less of the part or ask for less symmetry, or change the revolutions",
    Outcome.NO_GAIN: "the bridges no longer shrink: change the revolutions, or allow a larger displacement or less to "
    "be frozen",
    Outcome.ROUNDS_SPENT: "some fibres still bridge after the last round: allow more rounds, or start from the edited "
    "mesh",
    Outcome.NOT_SOLVED: "the quadratic program was not solved to its accuracy: use fewer paths, or a coarser surface "
    "(tolerance 1e-4)",
    Outcome.NOT_KEPT: "the edited surface does not bridge, but the one fitted to the edited mesh does: give a finer "
    "mesh, or take gaps of this size for none by a larger threshold",
}


@dataclass(frozen=True)
class Round:
    """One round: bridged share of the particles before and after, largest gap before and after, and the program.

    Gaps are in the mesh's units; a particle bridges where its gap is above this round's threshold.  change is the
    largest displacement of a control point so far; objective the energy of this round's change, in the mesh's units
    squared; shortfall how far the edit, were the fibre to stay, leaves the surface below it; primal and dual are the
    KKT residuals of the scaled program.
    """

    threshold: float
    bridged_before: float
    bridged_after: float
    gap_before: float
    gap_after: float
    change: float
    objective: float
    shortfall: float
    primal: float
    dual: float
    rows: int
    iterations: int
