"""A batch of paths: the arrays in which the compiled solvers start and leave their answers."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import TINY
from meshwind.path.kernels.refine import refine_all
from meshwind.path.kernels.starting_curve import sample_all
from meshwind.path.kernels.state import EVALUATIONS


class Batch(NamedTuple):
    """Arrays of p paths of n particles.

    X (p, n, 3), uv (p, n, 2), touching, anchor and mode (p, n) are both where a solver starts and its answer.

    Attributes
    ----------
    starts (p, m, 2): starting curves, to which friction holds.
    X, uv, normal, touching, gap: particles, as in `meshwind.path.kernels.state.State`.
    required (p, n): friction |kg| / kn that each particle requires, NaN where it is not defined.
    anchor, mode: grip on the starting curve, as in `meshwind.path.kernels.coulomb.Grip`.
    residual, status (p,): largest unbalanced force over the tension, and how the path ended.
    counters (p, 4): what each path cost, columns as in `meshwind.path.kernels.state`.
    """

    starts: Floats
    X: Floats
    uv: Floats
    normal: Floats
    touching: Bools
    gap: Floats
    required: Floats
    anchor: Floats
    mode: Ints
    residual: Floats
    status: Ints
    counters: Ints

    @property
    def paths(self) -> int:
        """Number of paths."""
        return len(self.X)

    @property
    def particles(self) -> int:
        """Number of particles of each path."""
        return self.X.shape[1]

    def costlier(self, evaluations: float) -> Bools:
        """Which paths (p,) have cost more than so many evaluations a particle."""
        return np.asarray(self.counters[:, EVALUATIONS] > evaluations * self.particles)

    def rows(self, index: Ints) -> "Batch":
        """A copy of some of the paths."""
        return Batch._make(np.ascontiguousarray(array[index]) for array in self)

    def put(self, index: Ints, part: "Batch") -> None:
        """Write paths solved apart back into their rows."""
        for array, solved in zip(self, part, strict=True):
            array[index] = solved

    def copied(self) -> "Batch":
        """A copy of all paths."""
        return Batch._make(array.copy() for array in self)

    def reversed(self) -> "Batch":
        """A copy of the paths that runs from end to start."""
        turned = {name: np.ascontiguousarray(getattr(self, name)[:, ::-1]) for name in _ALONG_PATH}
        back = self.copied()._replace(**turned)
        back.anchor[:] = self.starts.shape[1] - 1.0 - back.anchor
        back.mode[np.abs(back.mode) == 1] *= -1
        return back

    def refined(self, particles: int) -> "Batch":
        """The same paths with more particles, those between on the old ones' curve; counters go on."""
        fine = fresh(self.starts, particles)
        fine.counters[:] = self.counters
        parallel_for(refine_all, self.paths, 64, self, fine)
        return fine

    def thinned(self, particles: int, a_radian: float) -> "Batch":
        """The same paths with fewer of their particles, so many a radian besides where they turn; counters go on."""
        index = np.array([_where_it_bends(X, particles, a_radian) for X in self.X], dtype=np.int64)
        few = fresh(self.starts, particles)
        for name in ("X", "uv", "normal", "touching", "gap", "required", "anchor", "mode"):
            getattr(few, name)[:] = getattr(self, name)[np.arange(self.paths)[:, None], index]
        few.residual[:], few.status[:], few.counters[:] = self.residual, self.status, self.counters
        return few

    def halved(self) -> "Batch":
        """The same paths and starting curves with every second of their particles, an odd number; counters go on."""
        names = [name for name in _ALONG_PATH if name != "starts"]
        return self.copied()._replace(**{name: np.ascontiguousarray(getattr(self, name)[:, ::2]) for name in names})

    def curves_sampled(self) -> "Batch":
        """The same with as many points on the starting curves as there are particles."""
        last, points = self.starts.shape[1] - 1, self.particles
        if last == points - 1:
            return self
        starts = np.empty((self.paths, points, 2))
        parallel_for(sample_all, self.paths, 64, self.starts, starts)
        return self._replace(starts=starts, anchor=self.anchor * ((points - 1) / last))


_ALONG_PATH = ("starts", "X", "uv", "normal", "touching", "gap", "required", "anchor", "mode")
"""Fields whose second axis runs along the path."""


def _where_it_bends(X: Floats, count: int, a_radian: float) -> Ints:
    """Which `count` particles of X (n, 3) share out its length, and its turning by `a_radian` particles a radian."""
    way = np.diff(X, axis=0)
    size = np.linalg.norm(way, axis=1)
    ahead = way / np.maximum(size, TINY)[:, None]
    turn = np.linalg.norm(np.diff(ahead, axis=0), axis=1)  # nearly the angle
    each = size * ((count - 1) / size.sum())
    each[:-1] += 0.5 * a_radian * turn
    each[1:] += 0.5 * a_radian * turn
    share = np.concatenate([[0.0], np.cumsum(each)])
    rank = np.arange(count)
    wanted = np.searchsorted(share, share[-1] * rank / (count - 1))
    wanted = np.maximum.accumulate(np.minimum(wanted, len(X) - count + rank) - rank) + rank  # no particle twice
    wanted[0] = 0
    return np.asarray(wanted)


def fresh(starts: Floats, particles: int) -> Batch:
    """A batch that is yet to begin on its starting curves (p, m, 2)."""
    shape = len(starts), particles
    touching, required, residual = np.empty(shape, np.bool_), np.empty(shape), np.empty(len(starts))
    touching.fill(True)
    required.fill(np.nan)
    residual.fill(np.inf)
    return Batch(
        starts=starts.copy(),
        X=np.empty((*shape, 3)),
        uv=np.empty((*shape, 2)),
        normal=np.zeros((*shape, 3)),
        touching=touching,
        gap=np.zeros(shape),
        required=required,
        anchor=np.zeros(shape),
        mode=np.zeros(shape, np.int8),
        residual=residual,
        status=np.zeros(len(starts), np.int64),
        counters=np.zeros((len(starts), 4), np.int64),
    )


def resampled(curves: Floats, points: int) -> Floats:
    """Curves (p, m, 2) as polylines of so many points, evenly by parameter."""
    at = np.linspace(0.0, curves.shape[1] - 1.0, points)
    k = np.minimum(at.astype(np.int64), curves.shape[1] - 2)
    x = (at - k)[:, None]
    return np.ascontiguousarray((1.0 - x) * curves[:, k] + x * curves[:, k + 1])
