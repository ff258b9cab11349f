"""New paths where neighbours lie too far apart (section 6.3), until they do not, or no fibre rests between them.

Between two neighbours of a family new ends are spread evenly over both rims, and the new paths start from their
neighbours' curves.  On a part with a boss, fibres rest on either side of it but not on it: however close the ends,
the gap stays.  Such a parting is found by bisection, and reported rather than filled.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.checks import check_type, is_number, text
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import TINY
from meshwind.path import Paths, Status, solve
from meshwind.path.apart import apart
from meshwind.path.friction import Friction, friction_of
from meshwind.surface.rims import rim_parameters
from meshwind.surface.surface import Surface

_MAX_ROUNDS = 24
"""Rounds of new paths at most: each divides what is too wide, so that a parting is narrowed to 1e-7 of the rim."""
_MAX_PATHS = 4000
"""Paths at most; a smaller spacing is an error of the caller's."""
_JUMP = 4.0
"""A gap so many times what is usual for ends so far apart is a jump: its ends are halved, not divided by need."""
_PARTING = 16.0
"""A gap so many times the usual that is still too wide is a parting."""
_SPARED = 1.05
"""A path beside a parting is taken out if the gap grows by no more than this factor: bisection left it there."""
_SEAM = 1e-12
"""Shares of the rim closer to a whole turn than this lie on it, but for round-off."""


@dataclass(frozen=True)
class Spaced:
    """Paths no two neighbours of which lie further apart than `spacing`, but at the partings.

    Attributes
    ----------
    paths : Paths
        Family +1, then -1, each by growing share.
    share : ndarray of float, shape (p,)
        Where each path starts, of the start rim's length.
    spacing : float
        Largest distance that was asked for, in the surface's units.
    even : int
        Number of paths per family that were there before.
    partings : ndarray of int, shape (k, 2)
        Pairs of paths that no fibre rests between.
    gap : float
        Largest distance between all other neighbours, in the surface's units.
    widest : float
        That at the partings, 0 without one.
    """

    paths: Paths
    share: Floats
    spacing: float
    even: int
    partings: Ints
    gap: float
    widest: float

    __repr__ = brief

    @property
    def parted(self) -> tuple[int, int]:
        """Number of partings in family +1 and -1."""
        family = self.paths.family[self.partings[:, 0]]
        return int((family == 1).sum()), int((family == -1).sum())


class _Pairs(NamedTuple):
    """Neighbours first, second (m,): step (m,) from start to start as a share of the rim, and gap (m,) between them."""

    first: Ints
    second: Ints
    step: Floats
    gap: Floats

    def chosen(self, index: Ints) -> _Pairs:
        """Some of the pairs, by their numbers."""
        return _Pairs(self.first[index], self.second[index], self.step[index], self.gap[index])


@dataclass(frozen=True)
class _Ring:
    """Both families with their shares, in order around the rim; fixed (p,): the paths that were there before.

    torn (k, 2): family and share of each start at which no fibre rests.
    """

    paths: Paths
    share: Floats
    fixed: Bools
    torn: Floats

    def pairs(self) -> _Pairs:
        """All neighbours of a family, around the rim."""
        family = self.paths.family
        first = np.flatnonzero(np.isin(family, [f for f in (1, -1) if (family == f).sum() > 1]))
        second = np.where(np.roll(family, -1) == family, np.roll(np.arange(len(family)), -1), 0)
        opening = np.array([np.flatnonzero(family == f).min(initial=len(family)) for f in (1, -1)])
        last = np.flatnonzero(np.append(family[1:] != family[:-1], True))
        second[last] = opening[np.where(family[last] == 1, 0, 1)]
        second = second[first]
        step = np.mod(self.share[second] - self.share[first], 1.0)
        return _Pairs(first, second, np.where(step == 0.0, 1.0, step), apart(self.paths, first, second))

    def parted(self, first: Ints, step: Floats) -> Bools:
        """Whether no fibre rests at some start within each step (m,) from paths `first` (m,)."""
        off = np.mod(self.torn[None, :, 1] - self.share[first][:, None], 1.0) < step[:, None]
        same = self.torn[None, :, 0] == self.paths.family[first][:, None]
        return np.asarray((off & same).any(axis=1))


@dataclass(frozen=True)
class _Winding:
    """How new paths are wound: by how many revolutions, and with which friction."""

    surface: Surface
    revolutions: float
    friction: float | Friction

    def ends(self, family: Ints, share: Floats) -> tuple[Floats, Floats]:
        """Parametric ends (p, 2) of paths that start at shares of the start rim."""
        start = rim_parameters(self.surface, 0.0, share)
        end = rim_parameters(self.surface, 1.0, share + family * self.revolutions)
        return np.stack([start, np.zeros(len(share))], axis=1), np.stack([end, np.ones(len(share))], axis=1)


def space_out(paths: Paths, revolutions: float, spacing: float, friction: float | Friction = 0.0) -> Spaced:
    """Add paths until neighbours of a family lie no further apart than a given distance.

    Where no fibre rests between two neighbours, because they part around a boss, the gap stays and is reported.

    Parameters
    ----------
    paths : Paths
        Paths whose ends are spread evenly over the rims, as by `families`.
    revolutions : float
        Revolutions that they were wound by.
    spacing : float
        Largest distance between neighbours, in the mesh's units.
    friction : float or Friction, default 0
        Coefficient of friction, as for `solve`.

    Returns
    -------
    Spaced
        All paths as `paths`, and the pairs of neighbours between which the gap stays as `partings`.

    Raises
    ------
    BadInputError
        If `revolutions` or `spacing` is out of range, or the spacing would take more than 4000 paths.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> ends = mw.families(tube, paths=3, revolutions=0.5)
    >>> paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51)
    >>> spaced = mw.space_out(paths, revolutions=0.5, spacing=1.0)
    >>> len(spaced.paths) > len(paths), spaced.gap <= 1.0
    (True, True)
    """
    check_type(paths, "paths", Paths, "as solve returns them")
    if not is_number(revolutions):
        raise BadInputError(f"revolutions is {text(revolutions)}; give the number that the paths were wound by")
    if not is_number(spacing) or spacing <= 0.0:
        raise BadInputError(f"spacing is {text(spacing)}; give a length above 0 in the mesh's units")
    counts = [int((paths.family == family).sum()) for family in (1, -1)]
    share = np.concatenate([np.arange(count) / max(count, 1) for count in counts])
    ring = _Ring(paths, share, np.ones(len(paths), dtype=bool), np.zeros((0, 2)))
    winding = _Winding(paths.surface, revolutions, friction_of(paths.surface, friction))
    for _ in range(_MAX_ROUNDS):
        ring, done = _fill(ring, spacing, winding)
        if done:
            break
    ring = _thinned(ring, spacing)
    pairs = ring.pairs()
    parted = ring.parted(pairs.first, pairs.step)
    spaced = replace(ring.paths, asked=paths.asked)  # those added are at rest, and are found anew in another run
    return Spaced(
        spaced, frozen(ring.share), spacing, max(counts),
        frozen(np.stack([pairs.first, pairs.second], axis=1)[parted]),
        float(pairs.gap[~parted].max(initial=0.0)), float(pairs.gap[parted].max(initial=0.0)),
    )  # fmt: skip


def _fill(ring: _Ring, spacing: float, winding: _Winding) -> tuple[_Ring, bool]:
    """Put paths between all neighbours that are too far apart; True where there are none."""
    pairs = ring.pairs()
    gap, step = pairs.gap, pairs.step
    usual = gap / np.maximum(step * float(np.median(gap / step)), TINY)
    wide = (gap > spacing) & ~ring.parted(pairs.first, step)
    torn = wide & (usual > _PARTING) & (gap / np.maximum(usual, TINY) < spacing / _PARTING)
    middle = np.mod(ring.share[pairs.first] + 0.5 * step, 1.0)
    starts = np.stack([ring.paths.family[pairs.first], middle], axis=1)[torn]
    ring = _Ring(ring.paths, ring.share, ring.fixed, np.concatenate([ring.torn, starts]))
    wide &= ~torn
    if not wide.any():
        return ring, True
    jump = usual > _JUMP
    needed = np.where(jump, 1.0, np.ceil(gap / spacing) - 1.0)[wide]
    if not len(ring.paths) + needed.sum() <= _MAX_PATHS:  # before they are solved, for which memory may not do
        raise BadInputError(f"spacing {spacing:g} would take more than {_MAX_PATHS} paths; give a larger one")
    count = needed.astype(np.int64)
    which = np.repeat(np.flatnonzero(wide), count)
    number = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count) + 1
    weight = number / (np.repeat(count, count) + 1.0)
    blend = np.where(jump[which], np.round(weight - 0.25), weight)  # over a jump: from the first neighbour's curve
    new, share = _between(ring, pairs.chosen(which), weight, blend, winding)
    return _with(ring, new, share), False


def _between(ring: _Ring, pairs: _Pairs, weight: Floats, blend: Floats, winding: _Winding) -> tuple[Paths, Floats]:
    """Paths that start at a weight (m,) between two neighbours, from a blend (m,) of their curves; and their shares."""
    paths, first, second = ring.paths, pairs.first, pairs.second
    share = ring.share[first] + weight * pairs.step
    family = paths.family[first]
    start, end = winding.ends(family, share)
    other = np.array(paths.uv[second])
    other[:, :, 0] += np.floor(ring.share[first] + pairs.step + _SEAM)[:, None]  # around the seam
    curve = (1.0 - blend)[:, None, None] * paths.uv[first] + blend[:, None, None] * other
    ramp = np.linspace(0.0, 1.0, curve.shape[1])[None, :, None]
    curve += (1.0 - ramp) * (start - curve[:, 0])[:, None] + ramp * (end - curve[:, -1])[:, None]
    curve[..., 1] = np.clip(curve[..., 1], 0.0, 1.0)
    particles = curve.shape[1]
    friction = winding.friction
    new = solve(paths.surface, start, end, particles=particles, family=family, friction=friction, initial=curve)
    return new, np.mod(share, 1.0)


def _with(ring: _Ring, new: Paths, share: Floats) -> _Ring:
    """The ring with those of the new paths that converged; where one did not, no fibre rests."""
    rest = new.status == Status.CONVERGED
    torn = np.stack([new.family, share], axis=1)[~rest]
    both = ring.paths.joined(new.subset(rest))
    shares = np.concatenate([ring.share, share[rest]])
    fixed = np.concatenate([ring.fixed, np.zeros(int(rest.sum()), dtype=bool)])
    order = np.lexsort((shares, -both.family))
    return _Ring(both.subset(order), shares[order], fixed[order], np.concatenate([ring.torn, torn]))


def _thinned(ring: _Ring, spacing: float) -> _Ring:
    """Take out new paths that are not needed: where their neighbours are close enough, or lie beside a parting."""
    while True:
        pairs = ring.pairs()
        before = np.empty(len(ring.paths), dtype=np.int64)
        before[pairs.second], after = pairs.first, np.empty(len(ring.paths), dtype=np.int64)
        after[pairs.first] = pairs.second
        mine = np.flatnonzero(~ring.fixed & np.isin(np.arange(len(ring.paths)), pairs.first))
        without = apart(ring.paths, before[mine], after[mine])
        gap = np.zeros(len(ring.paths))
        gap[pairs.first] = pairs.gap
        step = np.zeros(len(ring.paths))
        step[pairs.first] = pairs.step
        beside = ring.parted(before[mine], step[before[mine]] + step[mine])
        beside &= without <= _SPARED * np.maximum(gap[before[mine]], gap[mine])
        spare = mine[(without <= spacing) | beside]
        # not two neighbours at once: the second is looked at again without the first
        spare = spare[~np.isin(before[spare], spare) | (np.arange(len(spare)) == 0)]
        if not len(spare):
            return ring
        left = np.setdiff1d(np.arange(len(ring.paths)), spare)
        ring = _Ring(ring.paths.subset(left), ring.share[left], ring.fixed[left], ring.torn)
