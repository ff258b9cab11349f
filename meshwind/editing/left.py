"""What an edit leaves: the bridges that remain, and whether the bound or what is frozen holds each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.vectors import TINY, unit
from meshwind.editing.demands import reach_at
from meshwind.path.paths import Paths

AT_BOUND = 1e-3
"""Of the bound: a control point that is no further from it is held by it."""
COUNTS = 0.1
"""Of the largest weight on a bridge: what holds it by less is not named."""


@dataclass(frozen=True)
class Left:
    """A bridge that an edit leaves.

    winding: its number; path, family: of the fibre; v: parameters between which it is off the surface; gap: the
    largest, at the point `at`; by_bound: how much lower the gap would be, to first order, with a bound larger by 1;
    by_frozen: how much with what is frozen moved by 1, by its name.
    """

    winding: int
    path: int
    family: int
    v: tuple[float, float]
    gap: float
    at: list[float]
    by_bound: float
    by_frozen: Mapping[str, float]

    @property
    def held_by(self) -> tuple[str, ...]:
        """What holds the bridge, by weight: "bound" and the names of what is frozen; empty if none of them does."""
        weights = {"bound": self.by_bound, **self.by_frozen}
        least = max(COUNTS * max(weights.values()), TINY)
        return tuple(sorted((name for name in weights if weights[name] >= least), key=lambda name: -weights[name]))


@dataclass(frozen=True)
class Held:
    """What holds the control points of an edited surface.

    moved (m, 3): their displacements; bound (m,): the largest of each, infinite without one; frozen: masks (m,) of
    those that are frozen, by the name of what freezes them.
    """

    moved: Floats
    bound: Floats
    frozen: Mapping[str, Bools]


def bridges_left(wound: Sequence[Paths], lifted: Sequence[Bools], held: Held) -> tuple[Left, ...]:
    """The bridges of all windings, where a particle is `lifted` (p, n), from the largest gap to the smallest."""
    found = [each for k, laid in enumerate(wound) for each in _of_winding(k, laid, lifted[k], held)]
    return tuple(sorted(found, key=lambda each: -each.gap))


def _of_winding(number: int, paths: Paths, lifted: Bools, held: Held) -> tuple[Left, ...]:
    off = np.zeros((len(paths), paths.gap.shape[1] + 2), dtype=np.int64)
    off[:, 1:-1] = ~paths.on_surface
    path, first = np.nonzero(np.diff(off, axis=1) == 1)
    _, last = np.nonzero(np.diff(off, axis=1) == -1)
    worst = np.array([a + np.argmax(paths.gap[k, a:b]) for k, a, b in zip(path, first, last, strict=True)], dtype=int)
    order = np.argsort(-paths.gap[path, worst], kind="stable")
    order = order[lifted[path, worst][order]]
    path, first, last, worst = path[order], first[order], last[order], worst[order]
    if not len(path):
        return ()
    rows = reach_at(paths, path, worst).matrix.toarray().reshape(len(path), -1, 3)
    at_bound = np.linalg.norm(held.moved, axis=1) >= (1.0 - AT_BOUND) * held.bound
    outward = np.maximum((rows * unit(held.moved)).sum(axis=2), 0.0)[:, at_bound].sum(axis=1)
    fixed = {name: np.linalg.norm(rows[:, mask], axis=2).sum(axis=1) for name, mask in held.frozen.items()}
    begin, end = np.maximum(first - 1, 0), np.minimum(last, paths.gap.shape[1] - 1)
    return tuple(
        Left(
            winding=number,
            path=int(path[k]),
            family=int(paths.family[path[k]]),
            v=(float(paths.uv[path[k], begin[k], 1]), float(paths.uv[path[k], end[k], 1])),
            gap=float(paths.gap[path[k], worst[k]]),
            at=paths.points[path[k], worst[k]].tolist(),
            by_bound=float(outward[k]),
            by_frozen={name: float(weight[k]) for name, weight in fixed.items()},
        )
        for k in range(len(path))
    )
