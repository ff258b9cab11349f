"""Inequalities on the control net: the surface must reach lifted fibres (6.9), and fibres must press on it elsewhere.

(6.9) takes the surface's normal at the shadow.  Over a deep hollow the normals of neighbouring shadows cross before
they reach the fibre, and a surface moved along them folds.  The move is therefore along the direction across the chord
that is nearest to the normal: the normal itself where the surface below is parallel to the fibre.

Reaching alone converges slowly: the surface then lies straight under the fibre, and every change of course lifts it
again.  Each particle therefore also demands a little normal curvature along the fibre, which is linear in the control
points as well; then the rounds converge like Newton's method.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import TINY, unit
from meshwind.editing.stencil import along, pitches, weights
from meshwind.path.paths import Paths, Status

JUMP = 0.5
"""Largest distance of neighbouring shadows, in spans; points are added where they skip the floor of a hollow."""

BEYOND = ((1.0, 0.0), (0.0, 1.0))
"""Spans by which lines begin before, and end after, the points where a bridge touches."""
CLOSE, MAX_BETWEEN = 0.5, 4
"""Neighbouring paths up to 1 + CLOSE spans apart have no curves between them; others have MAX_BETWEEN at most."""


@dataclass(frozen=True)
class Demands:
    """Inequalities matrix @ change >= least over the net's coordinates (k, 3m), in the surface's units.

    chosen (k,) marks about one per span along each path: the others nearly repeat them; short (k,) marks those of lines
    that touch further out, which matter beside the chosen ones where not all can be met.  part (k,): of a shortfall
    that is the same for all, what each may have.
    """

    matrix: sparse.csr_array
    least: Floats
    chosen: Bools
    short: Bools
    part: Floats

    def thinned(self, by: int) -> "Demands":
        """The same with only every so many-th of the chosen ones chosen."""
        few = np.zeros_like(self.chosen)
        few[np.flatnonzero(self.chosen)[::by]] = True
        return replace(self, chosen=few)


def reach(paths: Paths, at_most: float = 0.0, part: Floats | None = None) -> Demands:
    """The surface must come up to every lifted particle, (6.9) to (6.11), or as near as `at_most`; part: of each path.

    The fibre there is a straight line between two points where it touches, and moves as the surface does there: the
    row is the change of the surface below it less that of the line.  Where the surface sinks at such a point, the fibre
    touches further out; so the same is demanded of the lines from points some spans beyond, which now lie lower.
    """
    surface = paths.surface
    lifted = ~paths.on_surface & _is_usable(paths)
    path, at = np.nonzero(lifted)
    spans, run = _travel(paths)
    pieces = np.maximum(1, np.ceil(spans[path, at - 1] / JUMP)).astype(np.int64)
    which = np.repeat(np.arange(len(path)), pieces)
    step = np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces) + 1
    share = (step / pieces[which])[:, None]
    path, at = path[which], at[which]
    uv = (1 - share) * paths.uv[path, at - 1] + share * paths.uv[path, at]
    points = (1 - share) * paths.points[path, at - 1] + share * paths.points[path, at]
    chosen = _new_span(run[path, at - 1], spans[path, at - 1], step, pieces[which])
    first, last = (ends[path, at] for ends in _touching(paths))
    chord = paths.points[path, last] - paths.points[path, first]
    below = _Below(path, uv, points, _across(surface.normals(uv), unit(chord)))
    some = below.some(chosen)
    demands = [_above(paths, below, first, last, chosen)]
    for before, after in BEYOND:
        begin = _beyond(paths, run, some.path, first[chosen], -before)
        end = _beyond(paths, run, some.path, last[chosen], after)
        demands.append(_above(paths, some, begin, end))
    whole = together(demands)
    each = np.ones(len(paths)) if part is None else part
    of_rows = each[np.concatenate([path, *[some.path] * len(BEYOND)])]
    return replace(whole, least=whole.least - at_most, part=of_rows)


def together(demands: Sequence[Demands]) -> Demands:
    """All of several demands on one surface."""
    return Demands(
        sparse.csr_array(sparse.vstack([each.matrix for each in demands])),
        np.concatenate([each.least for each in demands]),
        np.concatenate([each.chosen for each in demands]),
        np.concatenate([each.short for each in demands]),
        np.concatenate([each.part for each in demands]),
    )


def reach_at(paths: Paths, path: Ints, at: Ints) -> Demands:
    """The demands of `reach` at lifted particles `at` (k,) of paths (k,) alone."""
    first, last = (ends[path, at] for ends in _touching(paths))
    chord = unit(paths.points[path, last] - paths.points[path, first])
    uv = paths.uv[path, at]
    return _above(
        paths, _Below(path, uv, paths.points[path, at], _across(paths.surface.normals(uv), chord)), first, last
    )


@dataclass(frozen=True)
class _Below:
    """Points uv (k, 2) of the surface below fibres of paths (k,) at points (k, 3), and directions up to them (k, 3)."""

    path: Ints
    uv: Floats
    points: Floats
    direction: Floats

    def some(self, which: Bools) -> "_Below":
        """Those of a mask (k,)."""
        return _Below(self.path[which], self.uv[which], self.points[which], self.direction[which])


def _above(paths: Paths, below: _Below, first: Ints, last: Ints, chosen: Bools | None = None) -> Demands:
    """The surface must come up to the lines between particles `first` and `last` (k,); without `chosen`, if short."""
    surface = paths.surface
    begin, end = paths.points[below.path, first], paths.points[below.path, last]
    chord = end - begin
    beyond = ((below.points - begin) * chord).sum(axis=1) / np.maximum((chord**2).sum(axis=1), TINY)
    line = begin + beyond[:, None] * chord
    least = ((line - surface.points(below.uv)) * below.direction).sum(axis=1)
    size, rows = surface.control_points.size // 3, []
    ends = (paths.uv[below.path, first], beyond - 1.0), (paths.uv[below.path, last], -beyond)
    for uv, weight in ((below.uv, np.ones(len(beyond))), *ends):
        found, (part,) = weights(surface, uv, ((0, 0),))
        rows.append(along(found, part * weight[:, None], below.direction, size))
    none = np.zeros(len(least), dtype=bool)
    matrix = sparse.csr_array(rows[0] + rows[1] + rows[2])
    short = ~none if chosen is None else none
    return Demands(matrix, least, none if chosen is None else chosen, short, np.ones(len(least)))


def _beyond(paths: Paths, run: Floats, path: Ints, at: Ints, by: float) -> Ints:
    """Numbers (k,) of the particles so many spans further along the paths than those at `at`, or the paths' ends."""
    wanted = run[path, at] + by
    order = np.concatenate([np.searchsorted(run[k], wanted[path == k]) for k in np.unique(path)] or [at])
    back = np.argsort(np.argsort(path, kind="stable"), kind="stable")
    return np.minimum(order[back], paths.gap.shape[1] - 1)


def press(paths: Paths, curvature: float, at_most: float = 0.0, rim: float = 1.0) -> Demands:
    """The normal curvature along every path must be at least `curvature` (1 / length), times a span's length squared.

    Below a bridge that may stay by `at_most` it may be that of an arc which sags by so much.  Within a span of a rim it
    must be `rim` times as much.

    The change of the second fundamental form is n . (D_tt - G^k D_k) for a change D of the surface, with the
    Christoffel symbols G of the fibre's direction t; the rows are in lengths, like those of `reach`.
    """
    surface = paths.surface
    uv, chord, less = _pressed(paths, at_most)
    frames = surface.frames(uv)
    normal = surface.normals(uv)
    a, b = _components(frames, chord)
    speed = np.linalg.norm(a[:, None] * frames[:, 1] + b[:, None] * frames[:, 2], axis=1)
    sound = speed > 1e-9 * np.linalg.norm(chord, axis=1)
    uv, frames, normal, less = uv[sound], frames[sound], normal[sound], less[sound]
    a, b = a[sound] / speed[sound], b[sound] / speed[sound]
    turn = (a * a)[:, None] * frames[:, 3] + (2 * a * b)[:, None] * frames[:, 4] + (b * b)[:, None] * frames[:, 5]
    along_u, along_v = _components(frames, turn)
    found, (d_u, d_v, d_uu, d_uv, d_vv) = weights(surface, uv, ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))
    change = (a * a)[:, None] * d_uu + (2 * a * b)[:, None] * d_uv + (b * b)[:, None] * d_vv
    change -= along_u[:, None] * d_u + along_v[:, None] * d_v
    length = max(pitches(surface)) ** 2
    matrix = along(found, -length * change, normal, surface.control_points.size // 3)
    from_rim = np.minimum(uv[:, 1], 1.0 - uv[:, 1]) * surface.spans[1]
    firm = np.where(from_rim < 1.0, rim, 1.0) * curvature
    least = length * (np.where(less > 0.0, -less, firm) + (turn * normal).sum(axis=1))
    every = np.ones(len(least), dtype=bool)
    return Demands(matrix, least, every, ~every, np.ones(len(least)))


def _pressed(paths: Paths, at_most: float) -> tuple[Floats, Floats, Floats]:
    """Parameters (k, 2) of the points where the fibres must press, their chords there (k, 3), and curvatures (k,) less.

    About one point per span along each path, and also between neighbours that are further apart than a span: from
    round to round paths move sideways there, and with another start one may pass between them.
    """
    uv, points = paths.uv, paths.points
    spans, run = _travel(paths)
    chosen = np.zeros(paths.gap.shape, dtype=bool)
    chosen[:, 1:] = _new_span(run[:, :-1], spans, np.ones_like(spans), np.ones_like(spans))
    chosen[:, [1, -2]] = True  # curvature is linear within a span, so its ends count, also at the rims
    chosen &= _is_usable(paths)
    chosen[:, [0, -1]] = False
    chord = np.zeros(points.shape)
    chord[:, 1:-1] = points[:, 2:] - points[:, :-2]
    first, last = _touching(paths)
    rows = np.arange(len(paths))[:, None]
    bridge = np.linalg.norm(points[rows, last] - points[rows, first], axis=2)
    less = 8.0 * at_most / np.where(paths.on_surface | (bridge == 0.0), np.inf, bridge) ** 2
    parameters, chords, lesses = [uv[chosen]], [chord[chosen]], [less[chosen]]
    left = np.arange(len(paths))
    right, turns = _neighbours(paths)
    beside = uv[right] + turns[:, None, None] * [1.0, 0.0]
    apart = np.abs((beside - uv) * np.array(paths.surface.spans)).max(axis=2)
    open_ = chosen & chosen[right].any(axis=1, keepdims=True) & (right != left)[:, None]
    for part in range(1, MAX_BETWEEN + 1):
        pieces = np.minimum(np.ceil(apart - CLOSE), MAX_BETWEEN) + 1
        here = open_ & (pieces > part)
        share = (part / np.maximum(pieces, 1))[here][:, None]
        parameters.append((1 - share) * uv[here] + share * beside[here])
        chords.append((1 - share) * chord[here] + share * chord[right][here])
        lesses.append(less[here])
    return np.concatenate(parameters), np.concatenate(chords), np.concatenate(lesses)


def _neighbours(paths: Paths) -> tuple[Ints, Floats]:
    """The next path around the part in each path's family (p,), and the turns of u to it (p,)."""
    right, turns = np.arange(len(paths)), np.zeros(len(paths))
    if paths.surface.periodic:
        for family in (1, -1):
            mine = np.flatnonzero(paths.family == family)
            order = mine[np.argsort(paths.uv[mine, 0, 0], kind="stable")]
            right[order] = np.roll(order, -1)
            turns[order[-1:]] = 1.0
    return right, turns


def _is_usable(paths: Paths) -> Bools:
    """Mask (p, 1) of the paths whose positions can be used: all but those that stalled or left the chart."""
    return ~np.isin(paths.status, (Status.STALLED, Status.LEFT_CHART))[:, None]


def _travel(paths: Paths) -> tuple[Floats, Floats]:
    """Spans crossed by each step of a path (p, n - 1), and since its start (p, n)."""
    spans = np.abs(np.diff(paths.uv, axis=1) * np.array(paths.surface.spans)).max(axis=2)
    return spans, np.concatenate([np.zeros((len(paths), 1)), np.cumsum(spans, axis=1)], axis=1)


def _new_span(start: Floats, length: Floats, step: Floats | Ints, pieces: Floats | Ints) -> Bools:
    """Whether a piece of a step is the first to cross into another span along the path."""
    start = start + 1e-6  # particles may lie on knots to round-off, which must not matter
    now, before = start + length * step / pieces, start + length * (step - 1) / pieces
    return np.asarray(np.floor(now) > np.floor(before))


def _touching(paths: Paths) -> tuple[Ints, Ints]:
    """Numbers (p, n) of the last particle before each that touches, or ends its path, and of the next one."""
    touching = paths.on_surface.copy()
    touching[:, 0] = touching[:, -1] = True
    index = np.broadcast_to(np.arange(touching.shape[1]), touching.shape)
    before = np.maximum.accumulate(np.where(touching, index, 0), axis=1)
    last = touching.shape[1] - 1
    after = np.minimum.accumulate(np.where(touching, index, last)[:, ::-1], axis=1)[:, ::-1]
    return before, after


def _across(normal: Floats, chord: Floats) -> Floats:
    """Unit vectors across the chords nearest to the normals; the normal itself where it is parallel to its chord."""
    across = normal - (normal * chord).sum(axis=1, keepdims=True) * chord
    size = np.linalg.norm(across, axis=1, keepdims=True)
    return np.where(size > 1e-3, across / np.maximum(size, 1e-3), normal)


def _components(frames: Floats, vector: Floats) -> tuple[Floats, Floats]:
    """Components (k,) by s_u and s_v of the tangential part of vectors (k, 3)."""
    s_u, s_v = frames[:, 1], frames[:, 2]
    e, f, g = (s_u * s_u).sum(axis=1), (s_u * s_v).sum(axis=1), (s_v * s_v).sum(axis=1)
    p, q = (vector * s_u).sum(axis=1), (vector * s_v).sum(axis=1)
    area = np.maximum(e * g - f * f, 1e-300)
    return (g * p - f * q) / area, (e * q - f * p) / area
