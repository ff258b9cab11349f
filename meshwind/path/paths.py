"""Taut paths, each with its certificate."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, fields, replace
from functools import cached_property
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.geometry import Block, Geometric
from meshwind.core.table import data_frame
from meshwind.path.advice import Advice, advise
from meshwind.path.asked import Asked
from meshwind.path.blocks import paths_block, paths_table
from meshwind.path.kernels.status import Status as Status
from meshwind.path.length import Laid, Measured, measured
from meshwind.path.one_path import OnePath
from meshwind.path.other_rests import OtherRests, look_for_other_rests
from meshwind.surface.surface import Surface

if TYPE_CHECKING:
    import pandas

SLID = 2e-4
"""What a length may be off by under friction, over itself, as the slide's increments decide where a fibre stops.

Against 801 particles it was off by up to 7e-5 with 101 to 385 of them, and by 1.9e-4 with 51, on three parts."""
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
class Paths(Geometric):
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
        Required friction ``|kg|/kn``, geodesic over normal curvature: the coefficient of friction that the fibre needs
        to stay where it is.  NaN off the surface and at the two ends.
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
    asked : Asked or None
        What `solve` was asked for, from which advice is tried; None for paths from elsewhere.

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
    asked: Asked | None = None

    def __repr__(self) -> str:
        at_rest = int((self.status == Status.CONVERGED).sum())
        return f"<meshwind Paths: {len(self)} paths of {self.gap.shape[1]} particles, {at_rest} at rest>"

    def __len__(self) -> int:
        return len(self.points)

    def __iter__(self) -> Iterator[OnePath]:
        return (OnePath(self, number) for number in range(len(self)))

    @overload
    def __getitem__(self, chosen: int) -> OnePath: ...
    @overload
    def __getitem__(self, chosen: slice | Bools | Ints) -> Paths: ...
    def __getitem__(self, chosen: int | slice | Bools | Ints) -> OnePath | Paths:
        if isinstance(chosen, int | np.integer):
            return OnePath(self, int(np.arange(len(self))[chosen]))
        return self.subset(np.arange(len(self))[chosen])

    @property
    def block(self) -> Block:
        """The polylines, with the fields of paths.vtp."""
        return paths_block(self)

    def to_dataframe(self, of: str = "paths") -> pandas.DataFrame:
        """Give figures to pandas.

        Parameters
        ----------
        of : {"paths", "points"}, default "paths"
            What has a row: each path, or each particle of each path.

        Returns
        -------
        pandas.DataFrame
            Columns named as the fields of paths.vtp; lengths in the surface's units.

        Raises
        ------
        BadInputError
            If `of` is another word, or pandas is not installed.

        Examples
        --------
        >>> import meshwind as mw
        >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
        >>> paths = mw.solve(tube, start=[(0.0, 0.0)], end=[(0.5, 1.0)], particles=101)
        >>> paths.to_dataframe()[["path", "outcome", "max_gap"]]
           path    outcome  max_gap
        0     0  converged      0.0
        """
        return data_frame(paths_table(self, of))

    @cached_property
    def _measured(self) -> Measured:
        return measured(self.surface, Laid(self.points, self.uv, self.on_surface, self.gap, self.normal))

    @property
    def length(self) -> Floats:
        """Length (p,) of each fibre, in the surface's units, of fourth order in the distance of the particles.

        The polyline through the particles is shorter, by h^2 k^2 / 24 of itself where particles are h apart on a fibre
        of curvature k.
        """
        return self._measured.length

    @property
    def length_error(self) -> Floats:
        """What each length (p,) may be off by, in the surface's units: for the particles, not for the fit.

        Under friction a fibre is not the shortest, so that its length takes over what its place of rest is off by for
        the increments of its slide: 2e-4 of itself is added for that.
        """
        error = self._measured.error
        return frozen(error + SLID * self.length) if self.friction > 0.0 else error

    @property
    def position_error(self) -> Floats:
        """How far each fibre (p,) may be from the polyline through its particles, in the surface's units.

        It is how far the surface stands out of a segment, or stays below it between particles that touch, or what the
        largest gap may be above those of all particles.
        """
        return self._measured.off

    def subset(self, chosen: Bools | Ints) -> Paths:
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
        asked = self.asked.rows(chosen) if self.asked is not None and len(self.asked) == len(self) else None
        return replace(self, asked=asked, **kept)

    def joined(self, other: Paths) -> Paths:
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
        asked = None if self.asked is None else self.asked.joined(other.asked)
        return replace(self, friction=max(self.friction, other.friction), counters=total, asked=asked, **both)

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

    @cached_property
    def other_rests(self) -> OtherRests:
        """Other states of rest that lie close to those of the paths, under friction.

        A little less or more friction, or a starting curve a little to the side, mostly moves a path a little; some
        leap to another state far away, or slide off.  They are looked for when first asked for, which takes one to
        two times as long as solving the paths, and more where many of them move far.

        Returns
        -------
        OtherRests
            For each path whether there is one, how far away, and what leads to it.

        Examples
        --------
        >>> import meshwind as mw
        >>> bottle = mw.fit(mw.flatten(mw.annulus(mw.read("data/bottle.obj"))))
        >>> ends = mw.families(bottle, paths=3, revolutions=0.45)
        >>> paths = mw.solve(bottle, ends.start, ends.end, family=ends.family, friction=0.12)
        >>> paths.other_rests.found
        array([False, False, False,  True, False, False])
        """
        return look_for_other_rests(self)

    @cached_property
    def holding(self) -> Advice:
        """What holds all paths, where some are not in equilibrium: numbers that were tried with all of them.

        It is looked for when it is first asked for, which takes as long as winding the paths a few times.
        """
        if self.asked is None or (self.status == Status.CONVERGED).all():
            return Advice(len(self))
        status = self.status
        if len(self.asked) != len(self):  # some were added to those asked for, of which it speaks
            status = self.asked.again(self.surface, self.asked.options, np.arange(len(self.asked))).status
        return advise(self.surface, self.asked, status)

    @property
    def holding_turns(self) -> Floats:
        """Revolutions (p,) that hold all paths, for those not in equilibrium; 0 for others, or where none are known."""
        return self._of_failing("revolutions")

    @property
    def holding_friction(self) -> Floats:
        """Friction (p,) that holds all paths, for those not in equilibrium; 0 for others, or where none is known."""
        return self._of_failing("friction")

    def _of_failing(self, name: str) -> Floats:
        failing = self.status != Status.CONVERGED
        return frozen(np.where(failing, getattr(self.holding, name) if failing.any() else 0.0, 0.0))

    def advice(self, path: int) -> str:
        """Say what became of a path and, where it is not in equilibrium, what holds all paths.

        Every number that is named was tried with all paths, with everything else as it was asked for; where none was
        found, or nothing is known of what was asked for, the line says what may help.

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
        if status == Status.CONVERGED or not self.holding.text:
            return status.advice
        return f"{status.meaning}; {self.holding.text}"


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
