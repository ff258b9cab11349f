"""The stages of a redesign: edit the fitted surface, move the mesh, fit and wind it, and edit again what bridges."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.chart import Chart
from meshwind.core.cast import Floats, frozen
from meshwind.core.progress import Progress
from meshwind.editing.bound import Bound
from meshwind.editing.edit import Edit, edit
from meshwind.editing.edited_mesh import displaced, displacement, within
from meshwind.editing.frozen_part import FrozenPart
from meshwind.editing.left import Left
from meshwind.editing.merit import ALIKE, SAME, is_better
from meshwind.editing.options import EditOptions
from meshwind.editing.proof import Proof, prove
from meshwind.editing.result import Outcome, Round
from meshwind.editing.symmetry import Group, planes, reflected
from meshwind.editing.wall_left import wall_left
from meshwind.editing.windings import Course
from meshwind.mesh import Mesh
from meshwind.mesh.geometry.mesh import Wall
from meshwind.surface import Surface, fit
from meshwind.workflow.options import Options

STAGES = 4
"""Largest number of surfaces that are edited: the one fitted to an edited mesh is not quite the edited one, and fibres
may bridge on it again."""
FIRMER, TIGHTER, MORE_ROUNDS = 1.5, 0.1, 2
"""Of each later stage: the factor of the pressing, the factor of the threshold, and the largest number of rounds.

On the sample cast the refit lifts fibres by 0.003 mm, within its fit error; one such stage moves the part by 1.2 mm
more, and no fibre leaves it.
"""


@dataclass(frozen=True)
class Candidate:
    """The mesh with its vertices moved by `moves` (n, 3), fitted and wound."""

    moves: Floats
    proof: Proof

    @property
    def merit(self) -> tuple[float, float]:
        """Bridged share and largest gap."""
        return self.proof.bridged, self.proof.gap


@dataclass(frozen=True)
class Run:
    """What is the same in all stages: the mesh, windings, the options as given, bounds, symmetry, wall."""

    mesh: Mesh
    winding: Options
    courses: tuple[Course, ...]
    options: EditOptions
    frozen: FrozenPart
    bound: Bound
    group: Group | None
    progress: Progress
    wall: Wall | None

    def stage(self, now: Candidate, number: int, rounds: int) -> Edit:
        """Edit the surface of a candidate; each stage after the first is tighter than the one before."""
        given = self.options
        surface, chart = self.ground(now.proof)
        options = replace(given, rounds=rounds, frozen=self.frozen.on(surface, chart),
                          bound=self.bound.left(now.moves).on(surface, chart))  # fmt: skip
        if number > 0:
            pressing, threshold = given.pressing * FIRMER**number, TIGHTER * now.proof.threshold
            options = replace(options, rounds=min(rounds, MORE_ROUNDS), pressing=pressing, threshold=threshold)
        return edit(surface, self.courses, options, self.progress, self.frozen.named(surface, chart), self.middle)

    def after(self, now: Candidate, found: Edit) -> Candidate | None:
        """Move the vertices as the surface was moved, then fit and wind the mesh; None where that pierces its wall."""
        self.progress("fit")
        surface, chart = self.ground(now.proof)
        still, group = self.frozen.vertices(chart), self.group
        more = displacement(chart, surface, found.surface, still if group is None else group.any_of(still))
        moves = now.moves + more if group is None else group.mean(now.moves + more)
        moves = within(moves, self.bound.each)
        if self.wall is not None and wall_left(self.mesh, self.wall, moves).pierced:
            return None
        return Candidate(
            moves,
            prove(
                displaced(self.mesh, moves), self.winding, self.courses, self.options.threshold, self.options.at_most
            ),
        )

    @property
    def middle(self) -> Floats:
        """The middle of the part, through which mirror planes go."""
        return np.asarray(self.mesh.vertices.mean(axis=0))

    def ground(self, proof: Proof) -> tuple[Surface, Chart]:
        """The surface that is edited and its chart: those of a proof, or with mirrors others that begin at a plane."""
        mirrors = planes(self.options.mirror)
        found = [reflected(proof.surface, plane, self.middle) for plane in mirrors]
        turn = next((each.turn for each in found if each.sign < 0), 0.0)
        if turn == 0.0:
            return proof.surface, proof.chart
        by = np.array([0.5 * turn, 0.0])
        chart = replace(proof.chart, uv=frozen(proof.chart.uv - by), corner_uv=frozen(proof.chart.corner_uv - by))
        surface = replace(fit(chart, self.winding.tolerance), threshold=proof.surface.threshold)
        return surface, chart

    def can_go_on(self, proof: Proof) -> bool:
        """Whether what must not move and the symmetry can be kept on the control net of another surface."""
        around = proof.surface.control_points.shape[0]
        return self.frozen.on_any_surface and around % self.options.symmetry == 0


@dataclass(frozen=True)
class Ended:
    """What the stages came to, and the bridges left on the surface that was edited for the best candidate."""

    best: Candidate
    stages: tuple[tuple[Round, ...], ...]
    outcome: Outcome
    left: tuple[Left, ...]


def edit_in_stages(run: Run, first: Candidate) -> Ended:
    """Edit the fitted surface, and again the one that is fitted to the edited mesh while fibres leave that."""
    best = now = first
    left = run.options.rounds
    found = run.stage(now, 0, left)
    stages, outcome, bridges = list[tuple[Round, ...]](), found.outcome, found.left
    while found.rounds:
        stages.append(found.rounds)
        left -= len(found.rounds)
        after = run.after(now, found)
        if after is None:
            outcome = Outcome.WALL_PIERCED
            break
        now = after
        same = ALIKE if outcome is Outcome.OUT_OF_REACH else SAME
        gains = is_better(now.merit, best.merit, same, SAME)  # by so much another fit may raise a gap that stays
        best, bridges = (now, found.left) if gains else (best, bridges)
        if outcome != Outcome.WINDABLE or now.proof.windable:
            break
        if len(stages) == STAGES or not (left and run.can_go_on(now.proof)):
            break
        found = run.stage(now, len(stages), left)
    if best.proof.windable:
        outcome = Outcome.WINDABLE
    elif outcome == Outcome.WINDABLE:
        outcome = Outcome.NOT_KEPT if left > 0 else Outcome.ROUNDS_SPENT
    return Ended(best, tuple(stages), outcome, () if best.proof.windable else bridges)
