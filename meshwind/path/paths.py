"""Taut paths, each with its certificate."""

import math
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import Any

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.path.kernels.status import Status as Status
from meshwind.path.length import fibre_lengths
from meshwind.surface.surface import Surface

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
    """Taut paths on one surface: p paths of n particles each.

    Attributes
    ----------
    surface : Surface
        Surface that the paths lie on.
    points : ndarray of float, shape (p, n, 3)
        Positions of the particles, in the surface's units.
    uv : ndarray of float, shape (p, n, 2)
        Parametric positions of the particles or of their feet, u in turns and unwrapped.
    on_surface : ndarray of bool, shape (p, n)
        Whether a particle touches the surface.
    gap : ndarray of float, shape (p, n)
        Distance from the surface, 0 where the particle touches it.
    normal : ndarray of float, shape (p, n, 3)
        Outward unit normal at the particle or its foot.
    slip : ndarray of float, shape (p, n)
        Required friction |kg|/kn, geodesic over normal curvature: the coefficient of friction that the fibre needs to
        stay where it is.  NaN off the surface and at the two ends.
    family : ndarray of int, shape (p,)
        +1 or -1, the sense of turning.
    status : ndarray of int, shape (p,)
        How each path ended, as `Status`.
    residual : ndarray of float, shape (p,)
        Largest unbalanced tangential force over the tension, beyond what friction holds: an angle in radians.
    friction : float
        Largest coefficient of friction on the surface.
    counters : Counters
        Surface evaluations, foot points, block solves and iterations of the whole batch.
    holding_turns : ndarray of float, shape (p,)
        For a path that is not in equilibrium: revolutions at which it would be, 0 where none were found.
    holding_friction : ndarray of float, shape (p,)
        For a path that is not in equilibrium: friction with which it would be, 0 where none was found.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> cylinder = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> paths = mw.solve(cylinder, start=[(0.0, 0.0)], end=[(0.5, 1.0)], particles=101)
    >>> paths.points.shape
    (1, 101, 3)
    >>> np.allclose(paths.length, np.hypot(np.pi, 3.0))  # a helix
    True
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
        """Length (p,) of each fibre, in the surface's units, of fourth order in the distance of the particles.

        The polyline through the particles is shorter, by h^2 k^2 / 24 of itself where particles are h apart on a fibre
        of curvature k.
        """
        return frozen(fibre_lengths(self.surface, self.points, self.uv, self.on_surface))

    def subset(self, chosen: Bools | Ints) -> "Paths":
        """Select paths.

        Parameters
        ----------
        chosen : ndarray of bool, shape (p,), or ndarray of int, shape (k,)
            Which paths to keep, or their numbers.

        Returns
        -------
        Paths
            The chosen paths, by a mask in their order; counters are those of the whole batch.

        Examples
        --------
        >>> import meshwind as mw
        >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
        >>> ends = mw.families(tube, paths=3, revolutions=0.5)
        >>> paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51)
        >>> len(paths.subset(paths.family == 1))
        3
        """
        kept: dict[str, Any] = {name: frozen(getattr(self, name)[chosen]) for name in self._arrays}
        return replace(self, **kept)

    def joined(self, other: "Paths") -> "Paths":
        """Join two batches on one surface.

        Parameters
        ----------
        other : Paths
            Paths with as many particles each.

        Returns
        -------
        Paths
            These paths, then the others; counters are those of both batches together.

        Examples
        --------
        >>> import meshwind as mw
        >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
        >>> ends = mw.families(tube, paths=3, revolutions=0.5)
        >>> paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51)
        >>> len(paths.subset(paths.family == 1).joined(paths))
        9
        """
        both: dict[str, Any] = {
            name: frozen(np.concatenate([getattr(self, name), getattr(other, name)])) for name in self._arrays
        }
        a, b = self.counters, other.counters
        total = Counters(*(getattr(a, field.name) + getattr(b, field.name) for field in fields(Counters)))
        return replace(self, friction=max(self.friction, other.friction), counters=total, **both)

    @property
    def _arrays(self) -> list[str]:
        """Names of the fields that have a row for each path."""
        return [field.name for field in fields(self) if isinstance(getattr(self, field.name), np.ndarray)]

    @property
    def sharpest_turn(self) -> Floats:
        """Largest angle (p,), in radians, by which the surface turns within one segment of each path.

        Above 1.2 the segment cuts an edge, and the path is right to the distance of its particles only.
        """
        return sharpest_turn(self.normal, self.on_surface)

    def advice(self, path: int) -> str:
        """Say what became of a path and, where it is not in equilibrium, what may help.

        The revolutions and the friction that are named held the path when it was tried with them, on a part with a
        rough surface with fewer particles than its own: wind it again to see.

        Parameters
        ----------
        path : int
            Number of the path, counted from 0.

        Returns
        -------
        str
            One line.

        Examples
        --------
        >>> import meshwind as mw
        >>> barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0)
        >>> mw.solve(barrel, start=[(0.0, 0.0)], end=[(0.3, 1.0)], particles=51).advice(0)
        'taut equilibrium'
        """
        status = Status(int(self.status[path]))
        ways = []
        if status in (Status.CONVERGED, Status.TOO_COARSE):
            return status.advice
        if self.holding_turns[path] > 0.0:
            ways.append(f"{_below(self.holding_turns[path])} revolutions")
        if self.holding_friction[path] > 0.0:
            ways.append(f"friction {self.holding_friction[path]:g}")
        return status.advice + (f"; {' or '.join(ways)} may hold it" if ways else "")


def _below(turns: float) -> str:
    """Revolutions to two digits, rounded down: more might not hold."""
    step = 10.0 ** (math.floor(math.log10(turns)) - 1)
    return f"{step * math.floor(turns / step + 1e-9):.2g}"


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
