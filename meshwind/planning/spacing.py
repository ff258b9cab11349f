"""New paths where neighbours lie too far apart (section 6.3), until they do not, or no fibre rests between them.

Between two neighbours of a family new ends are spread evenly over both rims, and the new paths start from their
neighbours' curves.  On a part with a boss, fibres rest on either side of it but not on it: however close the ends,
the gap stays.  Such a parting is found by halving, and told rather than filled.
"""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.path import Paths, Status, solve
from meshwind.path.friction import Friction
from meshwind.path.neighbours import apart, neighbours
from meshwind.planning.families import places
from meshwind.planning.joining import chosen, joined

_ROUNDS = 24
_MOST = 4000
"""Paths at most; a smaller spacing is an error of the caller's."""
_JUMP = 4.0
"""A gap so many times what is usual for ends so far apart is a jump: its ends are halved, not divided by need."""
_PARTING = 16.0
"""A gap so many times the usual that is still too wide is a parting."""
_SPARED = 1.05
"""A path beside a parting goes if the gap grows by no more: halving left it there."""


@dataclass(frozen=True)
class Spaced:
    """Paths no two neighbours of which lie further apart than `spacing`, but at the partings.

    paths: family +1, then -1, each by growing share; share (p,): where each starts, of the start rim's length; even:
    paths a family that were there before; partings (k, 2): pairs of paths that no fibre rests between; gap: largest
    distance between all other neighbours; widest: that at the partings, 0 without one.
    """

    paths: Paths
    share: Floats
    spacing: float
    even: int
    partings: Ints
    gap: float
    widest: float

    @property
    def parted(self) -> tuple[int, int]:
        """Number of partings in family +1 and -1."""
        family = self.paths.family[self.partings[:, 0]]
        return int((family == 1).sum()), int((family == -1).sum())


@dataclass(frozen=True)
class _Ring:
    """Both families with their shares, ordered; torn (k, 2): family and share of each place where no fibre rests."""

    paths: Paths
    share: Floats
    fixed: Bools
    torn: Floats

    def pairs(self) -> tuple[Ints, Ints, Floats, Floats]:
        """Neighbours first, second (m,), how far apart their starts are in share, and how far apart they lie."""
        family = self.paths.family
        first = np.flatnonzero(np.isin(family, [f for f in (1, -1) if (family == f).sum() > 1]))
        second = np.where(np.roll(family, -1) == family, np.roll(np.arange(len(family)), -1), 0)
        opening = np.array([np.flatnonzero(family == f).min(initial=len(family)) for f in (1, -1)])
        last = np.flatnonzero(np.append(family[1:] != family[:-1], True))
        second[last] = opening[np.where(family[last] == 1, 0, 1)]
        second = second[first]
        step = np.mod(self.share[second] - self.share[first], 1.0)
        return first, second, np.where(step == 0.0, 1.0, step), apart(self.paths, first, second)

    def parted(self, first: Ints, step: Floats) -> Bools:
        """Whether one of the places where no fibre rests is between each pair."""
        off = np.mod(self.torn[None, :, 1] - self.share[first][:, None], 1.0) < step[:, None]
        same = self.torn[None, :, 0] == self.paths.family[first][:, None]
        return np.asarray((off & same).any(axis=1))


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
    if not np.isfinite(revolutions):
        raise BadInputError(f"revolutions is {revolutions}; give the number that the paths were wound by")
    if not (np.isfinite(spacing) and spacing > 0.0):
        raise BadInputError(f"spacing is {spacing}; give a length above 0 in the mesh's units")
    counts = [int((paths.family == family).sum()) for family in (1, -1)]
    share = np.concatenate([np.arange(count) / max(count, 1) for count in counts])
    ring = _Ring(paths, share, np.ones(len(paths), dtype=bool), np.zeros((0, 2)))
    for _ in range(_ROUNDS):
        ring, done = _round(ring, revolutions, spacing, friction)
        if done:
            break
        if len(ring.paths) > _MOST:
            raise BadInputError(f"spacing {spacing:g} would take more than {_MOST} paths; give a larger one")
    ring = _thinned(ring, spacing)
    first, second, step, gap = ring.pairs()
    parted = ring.parted(first, step)
    return Spaced(
        ring.paths, frozen(ring.share), spacing, max(counts), frozen(np.stack([first, second], axis=1)[parted]),
        float(gap[~parted].max(initial=0.0)), float(gap[parted].max(initial=0.0)),
    )  # fmt: skip


def _round(ring: _Ring, revolutions: float, spacing: float, friction: float | Friction) -> tuple[_Ring, bool]:
    """Put paths between all neighbours that are too far apart; True where there are none."""
    first, second, step, gap = ring.pairs()
    usual = gap / np.maximum(step * float(np.median(gap / step)), 1e-300)
    wide = (gap > spacing) & ~ring.parted(first, step)
    torn = wide & (usual > _PARTING) & (gap / np.maximum(usual, 1e-300) < spacing / _PARTING)
    middle = np.mod(ring.share[first] + 0.5 * step, 1.0)
    places_torn = np.stack([ring.paths.family[first], middle], axis=1)[torn]
    ring = _Ring(ring.paths, ring.share, ring.fixed, np.concatenate([ring.torn, places_torn]))
    wide &= ~torn
    if not wide.any():
        return ring, True
    jump = usual > _JUMP
    count = np.where(jump, 1, np.ceil(gap / spacing).astype(np.int64) - 1)[wide]
    which = np.repeat(np.flatnonzero(wide), count)
    number = np.arange(len(which)) - np.repeat(np.cumsum(count) - count, count) + 1
    weight = number / (np.repeat(count, count) + 1.0)
    blend = np.where(jump[which], np.round(weight - 0.25), weight)  # over a jump: from the first neighbour's curve
    new, share = _between(ring, first[which], second[which], step[which], weight, blend, revolutions, friction)
    return _with(ring, new, share), False


def _between(
    ring: _Ring, first: Ints, second: Ints, step: Floats, weight: Floats, blend: Floats, revolutions: float,
    friction: float | Friction,
) -> tuple[Paths, Floats]:  # fmt: skip
    """Paths that start at a weight between two neighbours, from a blend of their curves; and their shares."""
    paths = ring.paths
    share = ring.share[first] + weight * step
    family = paths.family[first]
    turned = share + family * revolutions
    start = np.stack([places(paths.surface, 0.0, share), np.zeros(len(share))], axis=1)
    end = np.stack([places(paths.surface, 1.0, turned), np.ones(len(share))], axis=1)
    other = np.array(paths.uv[second])
    other[:, :, 0] += np.floor(ring.share[first] + step + 1e-12)[:, None]  # around the seam
    curve = (1.0 - blend)[:, None, None] * paths.uv[first] + blend[:, None, None] * other
    ramp = np.linspace(0.0, 1.0, curve.shape[1])[None, :, None]
    curve += (1.0 - ramp) * (start - curve[:, 0])[:, None] + ramp * (end - curve[:, -1])[:, None]
    curve[..., 1] = np.clip(curve[..., 1], 0.0, 1.0)
    new = solve(
        paths.surface, start, end, particles=curve.shape[1], family=family, friction=friction, initial=curve
    )  # fmt: skip
    return new, np.mod(share, 1.0)


def _with(ring: _Ring, new: Paths, share: Floats) -> _Ring:
    """The ring with those of the new paths that came to rest; where one did not, no fibre rests."""
    rest = new.status == Status.CONVERGED
    torn = np.stack([new.family, share], axis=1)[~rest]
    both = joined(ring.paths, chosen(new, np.flatnonzero(rest)))
    shares = np.concatenate([ring.share, share[rest]])
    fixed = np.concatenate([ring.fixed, np.zeros(int(rest.sum()), dtype=bool)])
    order = np.lexsort((shares, -both.family))
    return _Ring(chosen(both, order), shares[order], fixed[order], np.concatenate([ring.torn, torn]))


def _thinned(ring: _Ring, spacing: float) -> _Ring:
    """Take out new paths that are not needed: where their neighbours are close enough, or lie beside a parting."""
    while True:
        first, second, step, gap = ring.pairs()
        before = np.empty(len(ring.paths), dtype=np.int64)
        before[second], after = first, np.empty(len(ring.paths), dtype=np.int64)
        after[first] = second
        mine = np.flatnonzero(~ring.fixed & np.isin(np.arange(len(ring.paths)), first))
        without = apart(ring.paths, before[mine], after[mine])
        of = np.zeros(len(ring.paths))
        of[first] = gap
        width = np.zeros(len(ring.paths))
        width[first] = step
        beside = ring.parted(before[mine], width[before[mine]] + width[mine])
        beside &= without <= _SPARED * np.maximum(of[before[mine]], of[mine])
        spare = mine[(without <= spacing) | beside]
        # not two neighbours at once: the second is judged anew
        spare = spare[~np.isin(before[spare], spare) | (np.arange(len(spare)) == 0)]
        if not len(spare):
            return ring
        left = np.setdiff1d(np.arange(len(ring.paths)), spare)
        ring = _Ring(chosen(ring.paths, left), ring.share[left], ring.fixed[left], ring.torn)


def largest_gap(paths: Paths, partings: tuple[int, int] = (0, 0)) -> float:
    """The largest distance between neighbours of `paths`, but for so many largest of each family, +1 and -1.

    For a comparison with `space_out`: as many as it found partings, wherever the fibres part in this winding.
    """
    near = neighbours(paths)
    left = []
    for family, many in zip((1, -1), partings, strict=True):
        gap = np.sort(near.largest[near.family == family])
        left.append(gap[: max(len(gap) - many, 0)])
    return float(np.concatenate(left).max(initial=0.0))
