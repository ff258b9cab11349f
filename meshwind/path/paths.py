"""Taut paths, each with its certificate."""

from dataclasses import dataclass
from enum import IntEnum
from functools import cached_property

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.path.length import fibre_lengths
from meshwind.surface.surface import Surface


class Status(IntEnum):
    """How a path ended; 0 is a taut equilibrium, anything else comes with advice."""

    CONVERGED = 0
    SLID_OFF_START = 1
    SLID_OFF_END = 2
    UNSTABLE = 3
    STALLED = 4
    LEFT_CHART = 5
    TOO_COARSE = 6

    @property
    def advice(self) -> str:
        """What the status means and what to do about it."""
        return _ADVICE[self]


_ADVICE = {
    Status.CONVERGED: "taut equilibrium",
    Status.SLID_OFF_START: "the fibre slides off the start rim (v=0): use fewer revolutions, or a wider opening there",
    Status.SLID_OFF_END: "the fibre slides off the end rim (v=1): use fewer revolutions, or a wider opening there",
    Status.UNSTABLE: "no stable path: the fibre is balanced on a ridge and falls off it (a conjugate point, or "
    "windings too long for the bulge): use fewer revolutions",
    Status.LEFT_CHART: "the fibre slides off an open edge of the surface (u=0 or u=1): move the ends away from it",
    Status.TOO_COARSE: "at rest, but the fibre turns over an edge that is sharper than its particles are far apart: "
    "use more particles (--particles)",
    Status.STALLED: "the solver stopped before the fibre was at rest: use fewer revolutions, or a smoother surface "
    "(--tolerance 1e-3)",
}


EDGE = 1.2
"""Turn of the surface within one segment, in radians, above which the segment cuts an edge."""


@dataclass(frozen=True)
class Counters:
    """What a batch cost: surface evaluations, foot points, block solves and iterations."""

    evaluations: int
    feet: int
    solves: int
    iterations: int


@dataclass(frozen=True)
class Paths:
    """A batch of p taut paths of n particles each on one surface.

    points (p, n, 3); uv (p, n, 2) parametric position of the particle or of its foot, u unwrapped;
    on_surface (p, n); gap (p, n) distance to the surface, 0 where on it; normal (p, n, 3) outward at the
    particle or its foot; slip (p, n) = |kg| / kn, NaN off the surface and at the two ends; family (p,) +1 or
    -1; status (p,) of `Status`; residual (p,) largest unbalanced tangential force over the tension, the
    certificate of equilibrium; friction: the largest coefficient; holding_turns, holding_friction (p,): the turns
    and the friction that would hold a path that is not at rest, 0 where none was found.
    """

    surface: Surface
    points: Floats
    uv: Floats
    on_surface: Bools
    gap: Floats
    normal: Floats
    slip: Floats
    family: Ints
    status: Ints
    residual: Floats
    friction: float
    counters: Counters
    holding_turns: Floats
    holding_friction: Floats

    def __len__(self) -> int:
        return len(self.points)

    @cached_property
    def length(self) -> Floats:
        """Length (p,) of each fibre, in the surface's units: fourth order in the particles' distance where it touches.

        The polyline through its particles is shorter by the chords' share, h^2 k^2 / 24 at distance h and curvature k.
        """
        return frozen(fibre_lengths(self.surface, self.points, self.uv, self.on_surface))

    @property
    def sharpest_turn(self) -> Floats:
        """Largest angle (p,), in radians, that the surface turns within one segment of a path.

        Above EDGE the segment cuts an edge, and the path is right to the particles' spacing only.
        """
        return sharpest_turn(self.normal, self.on_surface)

    def advice(self, path: int) -> str:
        """What became of a path and, where it does not hold, what would hold it."""
        status = Status(int(self.status[path]))
        ways = []
        if status in (Status.CONVERGED, Status.TOO_COARSE):
            return status.advice
        if self.holding_turns[path] > 0.0:
            ways.append(f"{self.holding_turns[path]:.2g} revolutions")
        if self.holding_friction[path] > 0.0:
            ways.append(f"friction {self.holding_friction[path]:g}")
        return status.advice + (f"; {' or '.join(ways)} would hold it" if ways else "")


def converged_or_all(status: Ints, among: Bools | None = None) -> Bools:
    """Which paths (p,) figures are taken over: those of `among` that converged, or all of them where none did."""
    mine: Bools = np.ones(len(status), dtype=bool) if among is None else among
    converged: Bools = mine & (status == Status.CONVERGED)
    return converged if converged.any() else mine


def sharpest_turn(normal: Floats, touching: Bools) -> Floats:
    """Largest angle (p,), in radians, between the normals (p, n, 3) of neighbours that touch (p, n)."""
    facing = np.einsum("pnk,pnk->pn", normal[:, :-1], normal[:, 1:])
    facing[~(touching[:, :-1] & touching[:, 1:])] = 1.0
    return np.asarray(np.arccos(np.clip(facing.min(axis=1, initial=1.0), -1.0, 1.0)))
