"""A mesh made ready for winding: read, opened at its ends, flattened and fitted with a surface."""

from __future__ import annotations

from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING

from meshwind.chart import Chart, flatten
from meshwind.core.units import ASSUMED, Unit
from meshwind.mesh import Annulus, Mesh, annulus, read
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.io.read import MeshLike, path_of
from meshwind.surface import Surface, fit
from meshwind.workflow.clock import Clock
from meshwind.workflow.option_checks import FIELD
from meshwind.workflow.options import Options

if TYPE_CHECKING:
    from meshwind.mesh.io.scalars import Scalars


@dataclass(frozen=True)
class Source:
    """A mesh as it was read, the scalars of its friction field if one is used, and its file if it came from one."""

    mesh: Mesh
    scalars: Scalars | None = None
    file: Path | None = None


@dataclass(frozen=True)
class Part:
    """A source with its chart and its surface: what all windings of it share."""

    source: Source
    chart: Chart
    surface: Surface

    def counting(self, threshold: float | None) -> Part:
        """The part, on which gaps up to a threshold count as none; None for those up to the surface's uncertainty."""
        return self if threshold is None else replace(self, surface=replace(self.surface, threshold=threshold))


def read_source(mesh: MeshLike, options: Options) -> Source:
    """Read a mesh and, where the friction is a field, its scalars; raises BadInputError where one cannot be read."""
    file = path_of(mesh) if isinstance(mesh, str | PathLike) else None
    taken = mesh if isinstance(mesh, Mesh) else read(mesh, options.component, options.units)
    taken = taken.in_units(options.units, "" if file is None else ASSUMED)
    doubt = Unit(taken.units, taken.units_from).doubt(max(taken.size))
    taken = replace(taken, warnings=(*taken.warnings, doubt)) if doubt else taken
    if not isinstance(options.friction, str):
        return Source(taken, None, file)
    name = options.friction.removeprefix(FIELD).strip()
    return Source(taken, read_field(mesh, name), file)


def read_field(mesh: MeshLike, name: str) -> Scalars:
    """Take a scalar of the mesh or of its file; raises BadInputError where there is none."""
    from meshwind.mesh.io.scalars import read_scalars  # late: few runs have a field of friction

    return read_scalars(mesh, name)


def on_wound_skin(scalars: Scalars, annulus: Annulus) -> Scalars:
    """The scalars whose points lie on the skin that is wound of a part with a wall; all of them for other parts."""
    wall = annulus.wall
    if wall is None:
        return scalars
    wound = FacetTree.of(wall.skin.vertices, wall.skin.faces).distances(scalars.points)
    near = wound <= FacetTree.of(annulus.mesh.vertices, wall.opposite).distances(scalars.points)
    return replace(scalars, points=scalars.points[near], values=scalars.values[near])


def fit_part(source: Source, options: Options, clock: Clock) -> Part:
    """Open the mesh at its ends, flatten it and fit its surface."""
    with clock.stage("ends"):
        opened = annulus(source.mesh, options.ends, options.opening, options.side, options.opening_by)
    with clock.stage("flatten"):
        chart = flatten(opened)
    with clock.stage("fit"):
        surface = fit(chart, options.tolerance)
    return Part(source, chart, surface)
