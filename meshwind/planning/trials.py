"""Windings with few coarse paths: whether so many revolutions hold, and how much of the fibre bridges."""

from dataclasses import dataclass

import numpy as np

from meshwind.path import Paths, Status, solve
from meshwind.path.batch import Setting, fresh
from meshwind.path.friction import Friction, friction_of
from meshwind.path.ladder import fewest, search
from meshwind.path.lengths import bridged_share, lengths
from meshwind.path.paths import converged_or_all
from meshwind.path.solve import as_paths, straight
from meshwind.planning.families import families
from meshwind.surface.surface import Surface

PATHS = 8
"""Paths a family; the part turns by an eighth from one to the next."""
_PARTICLES = 72
"""Segments of a path at least: on a barrel the bound of revolutions comes out to 1e-3."""
_FINER = (1, 2, 4)
"""Times so many segments where a path does not hold: coarse ones catch on sharp edges."""
_TOLERANCE, _ITERATIONS = 1e-6, 150
"""A path that is not all but at rest by then slides: waiting longer only costs."""
_HOPELESS = 0.5
"""Where more than this share of the paths does not settle at once, the others are not looked for either."""


@dataclass(frozen=True)
class Trial:
    """What became of a winding: shares of the paths at rest, and of their length that bridges; slid off each end."""

    revolutions: float
    at_rest: float
    bridged: float
    slid: tuple[int, int]

    @property
    def holds(self) -> bool:
        """Whether every path is at rest."""
        return self.at_rest == 1.0


def trial(surface: Surface, revolutions: float, friction: float | Friction = 0.0, paths: int = PATHS) -> Trial:
    """Wind both families with `paths` coarse paths each; those that do not hold are tried anew with more particles."""
    rims = families(surface, paths, revolutions)
    setting = Setting(surface, friction_of(surface, friction), True, _TOLERANCE, _ITERATIONS)
    curves = straight(rims.start, rims.end, 2)
    least = max(_PARTICLES, int(fewest(curves).max(initial=0)))
    left, batches = np.arange(len(curves)), []
    for finer in _FINER:
        batch = fresh(curves[left], least * finer + 1)
        setting.run(batch, resume=False)
        lost = float((batch.status != Status.CONVERGED).mean())
        if finer > 1 or 0.0 < lost <= _HOPELESS:
            search(setting, batch)
        batches.append(as_paths(setting, batch, rims.family[left]))
        left = left[batch.status != Status.CONVERGED]
        if not len(left) or (finer == 1 and lost > _HOPELESS):
            break
    return _sum_up(batches, revolutions)


def full_trial(
    surface: Surface, revolutions: float, friction: float | Friction, paths: int, particles: int | None
) -> Trial:
    """Wind both families as they are wound in earnest."""
    rims = families(surface, paths, revolutions)
    laid = solve(surface, rims.start, rims.end, particles=particles, family=rims.family, friction=friction)
    return told(laid, revolutions)


def told(laid: Paths, revolutions: float) -> Trial:
    """The figures of paths that were wound by so many revolutions."""
    return _sum_up([laid], revolutions)


def _sum_up(batches: list[Paths], revolutions: float) -> Trial:
    """The figures of paths of which those not at rest were tried again in the batch that follows."""
    converged = sum(int((laid.status == Status.CONVERGED).sum()) for laid in batches)
    counted = converged_or_all(np.concatenate([laid.status for laid in batches]))
    masks = np.split(counted, np.cumsum([len(laid) for laid in batches[:-1]]))
    bridged = bridged_share(*zip(map(lengths, batches), masks, strict=True))
    slid = tuple(int((batches[-1].status == end).sum()) for end in (Status.SLID_OFF_START, Status.SLID_OFF_END))
    return Trial(float(revolutions), converged / len(batches[0]), bridged, (slid[0], slid[1]))
