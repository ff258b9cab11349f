"""Figures of each path: the length of its polyline, how much of it bridges, its largest gap and required friction.

The polyline through the particles is shorter than the fibre itself, whose length `Paths.length` gives.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.lists import spread
from meshwind.path.kernels.touchdown import touchdowns

if TYPE_CHECKING:
    from meshwind.path.paths import Paths


@dataclass(frozen=True)
class Lengths:
    """Of p paths of n particles: arc_length (p, n) from the start; the others (p,).

    Lengths are those of polylines, in the mesh's units.  bridged_length is that of the segments with an end off the
    surface, in resolved spans (see `Bridges`); unresolved_length that in other spans; max_gap counts the former.
    """

    arc_length: Floats
    polyline_length: Floats
    bridged_length: Floats
    unresolved_length: Floats
    max_gap: Floats
    max_slip: Floats

    __repr__ = brief


@dataclass(frozen=True)
class Bridges:
    """The b spans off the surface: of `path` (b,), from particle `first` to `last` (b,), both included.

    Both lie on the surface, unless the span reaches an end of its path.  resolved (b,): whether the fibre lies further
    off the surface somewhere than what counts as none (`tolerated`).  ends (b, 2, 3) are the points, between particles,
    where the fibre leaves the surface and comes back: tangent to it, to second order.
    """

    path: Ints
    first: Ints
    last: Ints
    length: Floats
    max_gap: Floats
    resolved: Bools
    ends: Floats

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.path)

    def where(self, chosen: Bools) -> Bridges:
        """Some of the spans (b,)."""
        return Bridges(*(frozen(getattr(self, field.name)[chosen]) for field in fields(self)))


def lengths(paths: Paths) -> Lengths:
    """Measure every path."""
    steps, arc = _steps(paths)
    off = bridging(paths)
    clear = ~(paths.on_surface[:, :-1] & paths.on_surface[:, 1:])
    bridged = clear & (off[:, :-1] | off[:, 1:])
    slip = np.fmax.reduce(paths.slip, axis=1, initial=0.0)  # fmax passes over NaN
    return Lengths(
        arc_length=frozen(arc),
        polyline_length=frozen(arc[:, -1]),
        bridged_length=frozen((steps * bridged).sum(axis=1)),
        unresolved_length=frozen((steps * (clear & ~bridged)).sum(axis=1)),
        max_gap=frozen((paths.gap * off).max(axis=1, initial=0.0)),
        max_slip=frozen(slip),
    )


def _steps(paths: Paths) -> tuple[Floats, Floats]:
    """Distances (p, n - 1) between particles, and arc length (p, n) of the polylines from their starts."""
    steps = np.linalg.norm(np.diff(paths.points, axis=1), axis=2)
    arc = np.zeros(paths.gap.shape)
    np.cumsum(steps, axis=1, out=arc[:, 1:])
    return steps, arc


def bridged_share(*counted: tuple[Lengths, Bools]) -> float:
    """Share of the polylines' length that is off the surface, over the counted paths (p,) of one or more batches."""
    return _share([(each.bridged_length[mask], each.polyline_length[mask]) for each, mask in counted])


def unresolved_share(*counted: tuple[Lengths, Bools]) -> float:
    """As `bridged_share`, in spans that the surface's uncertainty does not resolve."""
    return _share([(each.unresolved_length[mask], each.polyline_length[mask]) for each, mask in counted])


def _share(lengths: list[tuple[Floats, Floats]]) -> float:
    """Sum of parts over that of wholes, batch by batch; 0 where there is nothing."""
    total = sum(float(whole.sum()) for _, whole in lengths)
    return sum(float(part.sum()) for part, _ in lengths) / total if total > 0.0 else 0.0


class _Spans(NamedTuple):
    """Spans of particles off the surface: of path (b,), from particle start to before stop (b,)."""

    path: Ints
    start: Ints
    stop: Ints


def _spans(paths: Paths) -> _Spans:
    touching = np.pad(paths.on_surface, ((0, 0), (1, 1)), constant_values=True).astype(np.int8)
    change = np.diff(touching, axis=1)
    path, start = np.nonzero(change == -1)
    return _Spans(path, start, np.nonzero(change == 1)[1])


def _largest(values: Floats, spans: _Spans) -> Floats:
    """Largest of values (p, n) at the particles of each span."""
    count = values.shape[1] + 1
    bounds = np.stack([spans.path * count + spans.start, spans.path * count + spans.stop], axis=1).ravel()
    padded = np.pad(values, ((0, 0), (0, 1)), constant_values=-np.inf).ravel()
    # from each start to each stop; every other range is one between spans
    return np.maximum.reduceat(padded, bounds)[::2] if len(bounds) else np.zeros(0)


def tolerated(paths: Paths) -> Floats:
    """The gap of each particle (p, n) up to which it counts as lying on the surface; 0 where it touches.

    It is the surface's threshold, or how far the gap is uncertain: where a fit swings about the part, it is off one way
    under the particle and the other way at the ends of the span, between which the fibre is straight.
    """
    surface, spans = paths.surface, _spans(paths)
    limit = np.zeros(paths.gap.shape)
    size = spans.stop - spans.start
    row = np.repeat(spans.path, size)
    column = spread(spans.start, size)
    below = surface.threshold_at(paths.uv[row, column])
    if surface.threshold is None and surface.uncertainty is not None:
        before, after = (
            np.repeat(surface.uncertainty_at(paths.uv[spans.path, np.clip(end, 0, paths.gap.shape[1] - 1)]), size)
            for end in (spans.start - 1, spans.stop)
        )
        share = (column - np.repeat(spans.start, size) + 1) / np.repeat(size + 1, size)
        below = below + (1.0 - share) * before + share * after
    limit[row, column] = below
    return limit


def _resolved(paths: Paths, spans: _Spans) -> Bools:
    """Whether each span lies further off the surface somewhere than what counts as none."""
    return np.asarray(_largest(paths.gap - tolerated(paths), spans) > 0.0)


def bridging(paths: Paths) -> Bools:
    """Mask (p, n) of the particles of resolved spans."""
    spans, off = _spans(paths), np.zeros(paths.gap.shape, dtype=bool)
    _mark(off, spans, _resolved(paths, spans))
    return off


def _mark(mask: Bools, spans: _Spans, chosen: Bools) -> None:
    """Set the mask (p, n) at the particles of the chosen spans."""
    change = np.zeros((mask.shape[0], mask.shape[1] + 1), dtype=np.int64)
    change[spans.path[chosen], spans.start[chosen]] = 1
    change[spans.path[chosen], spans.stop[chosen]] = -1
    mask |= np.cumsum(change, axis=1)[:, :-1] > 0


def bridges(paths: Paths) -> Bridges:
    """Find every span of particles off the surface, path by path from the start."""
    spans = _spans(paths)
    first, last = np.maximum(spans.start - 1, 0), np.minimum(spans.stop, paths.gap.shape[1] - 1)
    _, arc = _steps(paths)
    length = arc[spans.path, last] - arc[spans.path, first]
    ends, _ = touchdowns(paths.surface, paths.points, paths.uv, spans.path, first, last)
    found = spans.path, first, last, length, _largest(paths.gap, spans), _resolved(paths, spans), ends
    return Bridges(*(frozen(each) for each in found))
