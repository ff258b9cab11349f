"""Where two neighbouring paths part round a body, so that no path rests between them however close their ends are."""

from dataclasses import replace

import numpy as np

from meshwind.core.cast import Bools, Floats, frozen
from meshwind.core.vectors import TINY
from meshwind.layup.neighbours import Neighbours
from meshwind.path.apart import apart, sampled, to_next
from meshwind.path.paths import Paths, Status
from meshwind.path.solve import solve

_UNUSUAL, _BULGING = 2.0, 3.0
"""Neighbours are looked at that lie so many times further apart than is usual for their ends, or than at their ends:
others part by no more than they lie apart without a body."""
_FEW = 8
"""Families of no more paths have no usual distance: all of their neighbours are looked at."""
_HALVINGS = 6
"""Times that the ends are brought to half their distance ..."""
_LEFT = 1.0 / 3.0
"""... where neighbours part that still lie more than this share of their first distance apart.  Elsewhere the distance
halves with that of the ends."""
_PARTICLES = 101
"""Number of particles of a path between two neighbours, or fewer."""


def partings(paths: Paths, near: Neighbours) -> Bools:
    """Which of the m neighbours part round a body: paths between them are laid until they come together, or do not."""
    found = np.zeros(len(near.first), dtype=bool)
    shift = to_next(paths, near.first, near.second)
    which = np.flatnonzero(_far_apart(paths, near, shift))
    uv = paths.uv[:, sampled(paths, _PARTICLES)]
    left, right = uv[near.first[which]], uv[near.second[which]]
    right = right + np.stack([shift[which], np.zeros(len(which))], axis=1)[:, None]
    for _ in range(_HALVINGS):
        if not len(which):
            break
        middle = 0.5 * (left + right)
        between = solve(
            paths.surface, middle[:, 0], middle[:, -1], particles=middle.shape[1], family=near.family[which],
            friction=paths.friction if paths.asked is None else paths.asked.options.friction, initial=middle,
        )  # fmt: skip
        there, back = _distances(between, left, between.uv), _distances(between, between.uv, right)
        first = (there >= back)[:, None, None]
        left, right = np.where(first, left, between.uv), np.where(first, between.uv, right)
        rests = between.status == Status.CONVERGED
        found[which[~rests]] = True
        on = rests & (np.maximum(there, back) > _LEFT * near.largest[which])
        which, left, right = which[on], left[on], right[on]
    found[which] = True
    return frozen(found)


def _far_apart(paths: Paths, near: Neighbours, shift: Floats) -> Bools:
    """Neighbours at rest (m,) that lie further apart than others whose ends are as far apart, or than their ends do."""
    rest = paths.status == Status.CONVERGED
    rest = rest[near.first] & rest[near.second]
    step = (paths.uv[near.second, :, 0] + shift[:, None] - paths.uv[near.first, :, 0])[:, [0, -1]]
    rate = near.largest / np.maximum(np.abs(step).mean(axis=1), TINY)
    usual = np.full(len(rate), np.inf)
    for family in (1, -1):
        mine = near.family == family
        if (mine & rest).any():
            usual[mine] = np.median(rate[mine & rest]) if mine.sum() > _FEW else 0.0
    known = np.where(near.distance > 0.0, near.distance, np.nan)
    ends = np.array([each[np.isfinite(each)][[0, -1]].max() if np.isfinite(each).any() else 0.0 for each in known])
    return np.asarray(rest & ((rate > _UNUSUAL * usual) | (near.largest > _BULGING * ends)))


def _distances(paths: Paths, left: Floats, right: Floats) -> Floats:
    """Largest distance (m,) along the surface of paths' left (m, n, 2) from right (m, n, 2), either way."""
    both = replace(paths.joined(paths), uv=np.concatenate([left, right]))
    number = np.arange(len(left))
    return apart(both, number, number + len(left))
