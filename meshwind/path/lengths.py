"""Figures of each path: the length of its polyline, how much of it bridges, its largest gap and required friction.

The polyline through the particles is shorter than the fibre itself, whose length `Paths.length` gives.
"""

from dataclasses import dataclass, fields

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.path.kernels.touchdown import touchdowns
from meshwind.path.paths import Paths


@dataclass(frozen=True)
class Lengths:
    """Of p paths of n particles: arc_length (p, n) from the start; the others (p,).

    Lengths are those of polylines, in the mesh's units; bridged_length is that of all segments with an end off the
    surface.
    """

    arc_length: Floats
    polyline_length: Floats
    bridged_length: Floats
    max_gap: Floats
    max_slip: Floats


@dataclass(frozen=True)
class Bridges:
    """The b spans off the surface: of `path` (b,), from particle `first` to `last` (b,), both included.

    Both lie on the surface, unless the span reaches an end of its path.  ends (b, 2, 3) are the points, between
    particles, where the fibre leaves the surface and comes back: tangent to it, to second order.
    """

    path: Ints
    first: Ints
    last: Ints
    length: Floats
    max_gap: Floats
    ends: Floats

    def __len__(self) -> int:
        return len(self.path)

    def of(self, paths: Bools) -> "Bridges":
        """The spans of some of the paths (p,)."""
        mine = paths[self.path]
        return Bridges(*(frozen(getattr(self, field.name)[mine]) for field in fields(self)))


def lengths(paths: Paths) -> Lengths:
    """Measure every path."""
    steps = np.linalg.norm(np.diff(paths.points, axis=1), axis=2)
    arc = np.zeros(paths.gap.shape)
    np.cumsum(steps, axis=1, out=arc[:, 1:])
    clear = ~(paths.on_surface[:, :-1] & paths.on_surface[:, 1:])
    slip = np.fmax.reduce(paths.slip, axis=1, initial=0.0)  # fmax passes over NaN
    return Lengths(
        arc_length=frozen(arc),
        polyline_length=frozen(arc[:, -1]),
        bridged_length=frozen((steps * clear).sum(axis=1)),
        max_gap=frozen(paths.gap.max(axis=1, initial=0.0)),
        max_slip=frozen(slip),
    )


def bridged_share(*counted: tuple[Lengths, Bools]) -> float:
    """Share of the polylines' length that is off the surface, over the counted paths (p,) of one or more batches."""
    total = bridged = 0.0
    for each, mask in counted:
        total += float(each.polyline_length[mask].sum())
        bridged += float(each.bridged_length[mask].sum())
    return bridged / total if total > 0.0 else 0.0


def lifted_share(gap: Floats, threshold: float) -> float:
    """Share of the particles (p, n) that lie further off the surface than a threshold.

    Unlike `bridged_share` it counts particles rather than length, and ignores gaps up to the threshold.
    """
    return float((gap > threshold).mean())


def bridges(paths: Paths) -> Bridges:
    """Find every span of particles off the surface, path by path from the start."""
    touching = np.pad(paths.on_surface, ((0, 0), (1, 1)), constant_values=True).astype(np.int8)
    change = np.diff(touching, axis=1)
    path, start = np.nonzero(change == -1)
    _, stop = np.nonzero(change == 1)
    first, last = np.maximum(start - 1, 0), np.minimum(stop, paths.gap.shape[1] - 1)
    arc = lengths(paths).arc_length
    # gaps from each start to each stop; every other range is one between bridges
    count = paths.gap.shape[1] + 1
    bounds = np.stack([path * count + start, path * count + stop], axis=1).ravel()
    padded = np.pad(paths.gap, ((0, 0), (0, 1)), constant_values=0.0).ravel()
    gap = np.maximum.reduceat(padded, bounds)[::2] if len(bounds) else np.zeros(0)
    length = arc[path, last] - arc[path, first]
    ends, _ = touchdowns(paths.surface, paths.points, paths.uv, path, first, last)
    return Bridges(frozen(path), frozen(first), frozen(last), frozen(length), frozen(gap), frozen(ends))
