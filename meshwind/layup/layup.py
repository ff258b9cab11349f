"""The assessment of a batch of paths: crossings, coverage, the quad mesh, and all that follows from them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import unit
from meshwind.layup.bands import Bands, bands
from meshwind.layup.coverage import Coverage, coverage
from meshwind.layup.crossings import CellSides, Crossings, cell_sides, crossings
from meshwind.layup.neighbours import Neighbours, neighbours
from meshwind.layup.partings import partings
from meshwind.layup.quads import QuadMesh, QuadQuality, quad_quality, quads
from meshwind.layup.windability import Windability, windability
from meshwind.path.paths import Paths, Status
from meshwind.path.solve import straight
from meshwind.surface.evaluate import SU, SV, S

_FEWEST = 3
"""Paths of each family below which no mesh can close around the part."""


@dataclass(frozen=True)
class Layup:
    """Paths with their crossings, the quad mesh on these and the coverage of the surface.

    Further figures are worked out when they are first asked for.

    Attributes
    ----------
    paths : Paths
        All paths.
    crossings : Crossings
        Crossings of paths of one family with those of the other.
    quads : QuadMesh
        Quad mesh whose vertices are the crossings and the ends on the rims.
    coverage : Coverage
        Layers of fibre over the surface.
    crossed : Paths
        Paths that crossings and quads are of: those in equilibrium or, where too few are for a mesh, the initial
        paths.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> ends = mw.families(tube, paths=4, revolutions=0.5)
    >>> layup = mw.assess(mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51))
    >>> len(layup.crossings)
    12
    """

    paths: Paths
    crossings: Crossings
    quads: QuadMesh
    coverage: Coverage
    crossed: Paths

    __repr__ = brief

    @property
    def initial(self) -> bool:
        """Whether crossings and quads are of the initial paths, as too few converge for a mesh."""
        return self.crossed is not self.paths

    @cached_property
    def bands(self) -> Bands:
        """Bands of the coverage's width, laid on the surface along all paths."""
        return bands(self.paths, self.coverage.width)

    @cached_property
    def neighbours(self) -> Neighbours:
        """Distances between neighbouring paths of a family, in the mesh's units."""
        return neighbours(self.paths)

    @cached_property
    def partings(self) -> Bools:
        """Which of the neighbours part round a body, so that no path rests between them."""
        return partings(self.paths, self.neighbours)

    @cached_property
    def sides(self) -> CellSides:
        """Lengths of fibre between neighbouring crossings, in the mesh's units."""
        return cell_sides(self.crossed, self.crossings)

    @property
    def own_crossings(self) -> Ints:
        """Pairs (k, 2) of paths of one family that cross."""
        return self.crossings.own

    @cached_property
    def quality(self) -> QuadQuality:
        """Shape of the quads: scaled Jacobian, aspect and planarity."""
        return quad_quality(self.quads)

    @cached_property
    def windability(self) -> Windability:
        """Where and in which directions a taut fibre presses on the surface."""
        return windability(self.paths.surface)


def assess(paths: Paths, width: float | None = None) -> Layup:
    """Find the crossings of paths, the quad mesh on them, and the coverage of the surface.

    Crossings and quads are those of the converged paths, or of all where a family has fewer than three of these; and
    where they give no mesh, because paths have slid off, of the initial paths.

    Parameters
    ----------
    paths : Paths
        Paths of two families.
    width : float, optional
        Width of the band of fibre, in the mesh's units.  By default the width that gives one layer per family on
        average.

    Returns
    -------
    Layup
        Crossings, quads and coverage.

    Raises
    ------
    BadInputError
        If `paths` is not Paths or the width is not above 0.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> ends = mw.families(tube, paths=4, revolutions=0.5)
    >>> layup = mw.assess(mw.solve(tube, ends.start, ends.end, family=ends.family, particles=51))
    >>> len(layup.crossings), len(layup.quads.quads) > 0, round(layup.coverage.median, 2)
    (12, True, 2.0)
    """
    if not isinstance(paths, Paths):
        raise BadInputError(f"assess takes Paths, not {type(paths).__name__}; make them with solve(...)")
    cover = coverage(paths, width)
    met = crossings(paths, _worth_crossing(paths))
    mesh = quads(paths, met)
    if not len(mesh.quads) and (paths.status != Status.CONVERGED).any():
        initial = initial_paths(paths)
        planned = crossings(initial)
        if len((drawn := quads(initial, planned)).quads):
            return Layup(paths, planned, drawn, cover, initial)
    return Layup(paths, met, mesh, cover, paths)


def _worth_crossing(paths: Paths) -> Bools | None:
    """The converged paths (p,), or None for all where a family has too few of them for a mesh."""
    taut: Bools = paths.status == Status.CONVERGED
    enough = all((taut & (paths.family == family)).sum() >= _FEWEST for family in (1, -1))
    return taut if enough else None


def initial_paths(paths: Paths) -> Paths:
    """The same paths before they slip, slide or bridge: straight in (u, v) from end to end (6.2), on the surface.

    Statuses stay what they are.
    """
    p, n = paths.gap.shape
    uv = straight(paths.uv[:, 0], paths.uv[:, -1], n)
    frames = paths.surface.frames(uv.reshape(-1, 2))
    normal = unit(np.cross(frames[:, SU], frames[:, SV]))
    return replace(
        paths,
        points=frozen(frames[:, S].reshape(p, n, 3)),
        uv=frozen(uv),
        on_surface=frozen(np.ones((p, n), dtype=bool)),
        gap=frozen(np.zeros((p, n))),
        normal=frozen(normal.reshape(p, n, 3)),
        slip=frozen(np.full((p, n), np.nan)),
    )
