"""The compiled solvers as one object: what all paths of a solve have in common, and batches brought to equilibrium."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import parallel_for
from meshwind.path.batch import Batch, fresh
from meshwind.path.friction import Friction
from meshwind.path.kernels.certificate import PULL
from meshwind.path.kernels.coulomb import RoughBody
from meshwind.path.kernels.lay import solve_without_friction
from meshwind.path.kernels.relax_with_friction import relax_all_with_friction
from meshwind.path.kernels.rest import relax_all
from meshwind.path.kernels.slide import slide_all
from meshwind.path.kernels.spaced import relax_all_as_spaced
from meshwind.path.kernels.state import NEEDS_TREE, Limits
from meshwind.surface.surface import Surface
from meshwind.surface.tree import Body

COARSE = 1e-6
"""Unbalanced force that is left on the levels below the finest."""


@dataclass(frozen=True)
class Solver:
    """What all paths of a solve have in common, and the solvers that it selects.

    final: whether answers need their certificate.  dearest: evaluations a particle above which no other way is tried
    for a path that fails.  Solved in coordinates about the surface's middle, so that a part far from the origin loses
    no digits.
    """

    surface: Surface
    friction: Friction
    bridging: bool
    tolerance: float
    iterations: int
    final: bool = True
    dearest: float = np.inf

    @property
    def _limits(self) -> Limits:
        return Limits(PULL if self.bridging else np.inf, self.tolerance, self.iterations)

    @property
    def coarse(self) -> "Solver":
        """The solver for a level below the finest: a looser balance, no certificate."""
        return replace(self, tolerance=max(self.tolerance, COARSE), final=False)

    def dear(self, batch: Batch) -> Bools:
        """Which paths (p,) have cost so much that no other way is tried for them."""
        return batch.costlier(self.dearest)

    def solve_simple(self, batch: Batch) -> None:
        """Bring the frictionless paths of a fresh batch to equilibrium, where that is simple.

        The others have a status other than CONVERGED.  A part that presses everywhere never pays for the search tree.
        """
        surface = self.surface.centred
        if "tree" in vars(surface):
            self._solve_simple(batch, surface.body)
            return
        self._solve_simple(batch, surface.body_without_tree)
        if np.count_nonzero(batch.status) and len(lifted := np.flatnonzero(batch.status == NEEDS_TREE)):
            part = fresh(batch.starts[lifted], batch.particles)  # counted as if the tree had been there
            self._solve_simple(part, surface.body)
            batch.put(lifted, part)

    def _solve_simple(self, batch: Batch, body: Body) -> None:
        parallel_for(solve_without_friction, batch.paths, 1, body, self._limits, max(self.tolerance, COARSE), batch)

    def relax(self, batch: Batch, resume: bool) -> None:
        """Bring the batch to equilibrium, from its starting curves or, with `resume`, from where it is.

        A part that presses everywhere never pays for the search tree, and a frictionless one none for friction.
        """
        aloft = ~batch.touching.all(axis=1) if resume else np.zeros(batch.paths, np.bool_)
        low = np.flatnonzero(~aloft)
        self._relax(batch, low, resume, tree=False)
        lifted = low[batch.status[low] == NEEDS_TREE]
        self._relax(batch, np.sort(np.concatenate([np.flatnonzero(aloft), lifted])), resume, tree=True)

    def relax_as_spaced(self, batch: Batch) -> None:
        """Bring a batch to equilibrium from where it is, its particles as far apart as they are.

        Friction holds it to where it is.
        """
        rough, held = RoughBody(self.surface.centred.body, self.friction.table), not self.friction.none
        parallel_for(relax_all_as_spaced, batch.paths, 1, rough, self._limits, held, batch)

    def slide(self, batch: Batch) -> tuple[Floats, Bools]:
        """Let a batch slide under friction from its starting curves to rest, in place.

        Returns the curves (p, n, 2) that friction holds the paths to from then on, with a sample for each particle, and
        for which (p,) that is the starting curve itself; anchors are in samples of that curve.
        """
        surface = self.surface.centred
        held, own = np.empty_like(batch.uv), np.zeros(batch.paths, np.bool_)
        index = np.arange(batch.paths)
        counters = batch.counters.copy()  # counted as if the tree had been there from the start
        for body in (surface.body,) if "tree" in vars(surface) else (surface.body_without_tree, surface.body):
            part = fresh(batch.starts[index], batch.particles)
            part.counters[:] = counters[index]
            curves, same = np.zeros_like(part.uv), np.zeros(part.paths, np.bool_)
            rough = RoughBody(body, self.friction.table)
            parallel_for(slide_all, part.paths, 1, rough, self._limits, part, curves, same)
            batch.put(index, part)
            held[index], own[index] = curves, same
            index = index[part.status == NEEDS_TREE]
            if not len(index):
                break
        return held, own

    def _relax(self, batch: Batch, index: Ints, resume: bool, tree: bool) -> None:
        """Relax some of the paths; those that turn out to need a tree, and have none, are left as they were."""
        if not len(index):
            return
        surface = self.surface.centred
        part = batch if len(index) == batch.paths else batch.rows(index)
        before = None if tree else part.copied()
        body = surface.body if tree else surface.body_without_tree
        if self.friction.none:
            parallel_for(relax_all, part.paths, 1, body, self._limits, resume, self.final, part)
        else:
            rough = RoughBody(body, self.friction.table)
            parallel_for(relax_all_with_friction, part.paths, 1, rough, self._limits, resume, self.final, part)
        if before is not None and (rerun := part.status == NEEDS_TREE).any():
            for name in ("X", "uv", "touching", "anchor", "mode"):
                getattr(part, name)[rerun] = getattr(before, name)[rerun]
        if part is not batch:
            batch.put(index, part)
