"""Neighbouring paths of a family, and how far apart they lie along the surface (Fig. 6.3)."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.path.apart import SEAM, both_ways, larger, measured
from meshwind.path.paths import Paths


@dataclass(frozen=True)
class Neighbours:
    """The m pairs of paths of a family that are next to each other at the start rim.

    first, second (m,): paths; family (m,); particles (k,): those of `first` that are measured from, all of them where
    there are few; distance (m, k): of each, or of its foot, to `second` along the surface, in the mesh's units, 0 where
    it lies beyond the ends; largest (m,): the larger of the largest distances from `first` to `second` and back.
    """

    first: Ints
    second: Ints
    family: Ints
    particles: Ints
    distance: Floats
    largest: Floats

    __repr__ = brief


def neighbours(paths: Paths) -> Neighbours:
    """Measure from each path to the next of its family around the start rim, and from the last to the first."""
    pairs = [_ring(paths, family) for family in (1, -1)]
    first, second = (np.concatenate(side).astype(np.int64) for side in zip(*pairs, strict=True))
    there, back = both_ways(paths, first, second)
    return Neighbours(*map(frozen, (first, second, paths.family[first], measured(paths), there, larger(there, back))))


def _ring(paths: Paths, family: int) -> tuple[Ints, Ints]:
    """Each path of a family and the next around the start rim; none where there is only one."""
    mine = np.flatnonzero(paths.family == family)
    if len(mine) < 2:
        return mine[:0], mine[:0]
    # by the start alone two paths from one pin could change places: the end decides between them
    order = np.lexsort((paths.uv[mine, -1, 0] - paths.uv[mine, 0, 0], np.mod(paths.uv[mine, 0, 0] + SEAM, 1.0)))
    mine = mine[order]
    return (mine, np.roll(mine, -1)) if paths.surface.periodic else (mine[:-1], mine[1:])
