"""A batch of paths at work: its arrays, and the setting in which the compiled solvers run."""

from dataclasses import dataclass, fields, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import parallel_for
from meshwind.path.friction import Friction
from meshwind.path.kernels.certificate import PULL
from meshwind.path.kernels.hold import hold_all
from meshwind.path.kernels.lay import lay_all
from meshwind.path.kernels.refine import refine_all
from meshwind.path.kernels.relax import LIFTED, relax_all
from meshwind.surface.surface import Surface
from meshwind.surface.tree import Body

COARSE = 1e-6
"""Unbalanced force that is left on the rungs below the last."""


@dataclass
class Batch:
    """Arrays of p paths of n particles; X, uv, touching and grip are both where a solver starts and its answer.

    starts (p, m, 2) are the starting curves, to which friction holds; place and mode (p, n) say where on them each
    particle belongs and how it is held (coulomb.py).
    """

    starts: Floats
    X: Floats
    uv: Floats
    normal: Floats
    touching: Bools
    gap: Floats
    slip: Floats
    place: Floats
    mode: Ints
    residual: Floats
    status: Ints
    tallies: Ints

    def __len__(self) -> int:
        return len(self.X)

    def rows(self, index: Ints) -> "Batch":
        """A copy of some of the paths."""
        return Batch(**{f.name: np.ascontiguousarray(getattr(self, f.name)[index]) for f in fields(self)})

    def put(self, index: Ints, part: "Batch") -> None:
        """Write paths solved apart back into their rows."""
        for f in fields(self):
            getattr(self, f.name)[index] = getattr(part, f.name)

    def reversed(self) -> "Batch":
        """A copy of the paths that runs from end to start."""
        back = self.rows(np.arange(len(self)))
        for name in ("starts", "X", "uv", "normal", "touching", "gap", "slip", "place", "mode"):
            getattr(back, name)[:] = getattr(self, name)[:, ::-1]
        back.place[:] = self.starts.shape[1] - 1.0 - back.place
        back.mode[np.abs(back.mode) == 1] *= -1
        return back

    def refined(self, particles: int) -> "Batch":
        """The same paths with more particles, those between on the old ones' curve; counters go on."""
        fine = fresh(self.starts, particles)
        fine.tallies[:] = self.tallies
        parallel_for(refine_all, len(self), 64, self.X, self.uv, self.touching, self.gap, self.place, self.mode,
               fine.X, fine.uv, fine.touching, fine.gap, fine.place, fine.mode)  # fmt: skip
        return fine


def fresh(starts: Floats, particles: int) -> Batch:
    """A batch that is yet to begin on its starting curves (p, m, 2)."""
    shape = len(starts), particles
    return Batch(
        starts.copy(), np.empty((*shape, 3)), np.empty((*shape, 2)), np.zeros((*shape, 3)), np.ones(shape, np.bool_),
        np.zeros(shape), np.full(shape, np.nan), np.zeros(shape), np.zeros(shape, np.int8),
        np.full(len(starts), np.inf), np.zeros(len(starts), np.int64), np.zeros((len(starts), 4), np.int64),
    )  # fmt: skip


def resampled(curves: Floats, points: int) -> Floats:
    """Curves (p, m, 2) as polylines of so many points, evenly by parameter."""
    at = np.linspace(0.0, curves.shape[1] - 1.0, points)
    k = np.minimum(at.astype(np.int64), curves.shape[1] - 2)
    x = (at - k)[:, None]
    return np.ascontiguousarray((1.0 - x) * curves[:, k] + x * curves[:, k + 1])


@dataclass(frozen=True)
class Setting:
    """What all paths of a solve have in common.

    final: whether answers need their certificate.  even: whether frictionless paths, too, are solved for equal tension,
    as those with friction are; it costs more and matters at edges alone, where the springs' own balance crowds the
    particles on one side.  Solved in coordinates about the surface's middle, so that a part far from the origin loses
    no digits.
    """

    surface: Surface
    friction: Friction
    bridging: bool
    tolerance: float
    iterations: int
    final: bool = True
    even: bool = False

    @property
    def _pull_off(self) -> float:
        return PULL if self.bridging else np.inf

    def lay(self, batch: Batch) -> None:
        """Bring the frictionless paths of a fresh batch to rest, those that need no further thought.

        The others have a status other than CONVERGED.  A part that presses everywhere never pays for the search tree.
        """
        surface = self.surface.centred
        if "tree" in vars(surface):
            self._lay(batch, surface.body)
            return
        self._lay(batch, surface.body_without_tree)
        lifted = np.flatnonzero(batch.status == LIFTED)
        if len(lifted):
            part = fresh(batch.starts[lifted], batch.X.shape[1])  # counted as if the tree had been there
            self._lay(part, surface.body)
            batch.put(lifted, part)

    def _lay(self, batch: Batch, body: Body) -> None:
        parallel_for(lay_all, len(batch), 1, body, self._pull_off,
               max(self.tolerance, COARSE), self.tolerance, self.iterations, batch.starts, batch.X, batch.uv,
               batch.normal, batch.touching, batch.gap, batch.slip, batch.residual, batch.status,
               batch.tallies)  # fmt: skip

    @property
    def rough(self) -> "Setting":
        """The setting for a rung below the last: a looser balance, no certificate."""
        return replace(self, tolerance=max(self.tolerance, COARSE), final=False)

    def run(self, batch: Batch, resume: bool) -> None:
        """Bring the batch to rest, from its starting curves or, with `resume`, from where it is.

        A part that presses everywhere never pays for the search tree, and a frictionless one none for friction.
        """
        aloft = ~batch.touching.all(axis=1) if resume else np.zeros(len(batch), np.bool_)
        low = np.flatnonzero(~aloft)
        self._run(batch, low, resume, tree=False)
        lifted = low[batch.status[low] == LIFTED]
        self._run(batch, np.sort(np.concatenate([np.flatnonzero(aloft), lifted])), resume, tree=True)

    def _run(self, batch: Batch, index: Ints, resume: bool, tree: bool) -> None:
        if not len(index):
            return
        surface = self.surface.centred
        part = batch if len(index) == len(batch) else batch.rows(index)
        before = (
            None if tree else (part.X.copy(), part.uv.copy(), part.touching.copy(), part.place.copy(), part.mode.copy())
        )
        general = (
            surface.body if tree else surface.body_without_tree,
            self._pull_off,
            self.tolerance,
            self.iterations,
            resume,
            self.final,
        )
        places = part.X, part.uv, part.normal, part.touching, part.gap, part.slip
        results = part.residual, part.status, part.tallies
        if self.friction.none and not self.even:
            parallel_for(relax_all, len(part), 1, *general, part.starts, *places, *results)
        else:
            parallel_for(hold_all, len(part), 1, *general, self.friction.table, part.starts, part.place, part.mode,
                         *places, *results)  # fmt: skip
        if before is not None and (rerun := part.status == LIFTED).any():
            for array, old in zip((part.X, part.uv, part.touching, part.place, part.mode), before, strict=True):
                array[rerun] = old[rerun]
        if part is not batch:
            batch.put(index, part)
