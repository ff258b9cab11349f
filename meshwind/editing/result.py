"""Results of a redesign: the figures of each round, and the outcome."""

from dataclasses import dataclass
from enum import IntEnum


class Outcome(IntEnum):
    """How a redesign ended: 0 is a part on which nothing bridges."""

    WINDABLE = 0
    OUT_OF_REACH = 1
    NO_GAIN = 2
    ROUNDS_SPENT = 3
    NOT_SOLVED = 4
    NOT_KEPT = 5
    WALL_PIERCED = 6

    @property
    def advice(self) -> str:
        """What the outcome means, and what to do about it."""
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
    Outcome.NOT_KEPT: "fibres do not bridge on the edited surface, but on the one fitted to the edited mesh: give a "
    "finer mesh, or ignore gaps of this size by a larger threshold",
    Outcome.WALL_PIERCED: "the edit would move the wound skin through the other skin of its wall: allow less "
    "displacement, give a part with a thicker wall, or wind the other side",
}


@dataclass(frozen=True)
class Round:
    """Figures of one round.

    threshold: a particle bridges where its gap is above this; bridged_before, bridged_after: share of the particles
    that bridge; gap_before, gap_after: largest gap, in the mesh's units; change: largest displacement of a control
    point so far; objective: energy of the whole change, in the mesh's units squared; shortfall: how far the edit
    leaves the surface below the fibre where the fibre stays; primal, dual: KKT residuals of the scaled program; rows,
    iterations: its constraints, and the steps of its solver.
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
