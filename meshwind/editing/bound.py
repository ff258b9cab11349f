"""How far an edit may move a part: one length, or a field of them over the mesh."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.spatial import cKDTree

from meshwind.chart.chart import Chart
from meshwind.core.cast import Floats, numbers
from meshwind.core.errors import BadInputError
from meshwind.editing.feet import feet_of
from meshwind.editing.region import SAMPLES_PER_SPAN
from meshwind.editing.stencil import lattice, weights
from meshwind.editing.symmetry import Group
from meshwind.mesh import Annulus, Mesh
from meshwind.mesh.io.read import MeshLike
from meshwind.surface.surface import Surface
from meshwind.workflow.option_checks import FIELD
from meshwind.workflow.part import on_wound_skin, read_field

LEAST_LEFT = 0.02
"""Of the bound: what a later stage may always move, as the sum is cut down to the bound afterwards."""
STILL = 1e-9
"""Over the part's size: a bound up to this lets nothing move."""


@dataclass(frozen=True)
class Bound:
    """Largest displacement: `each` is one for all vertices, one for each of them (n,), or None without any."""

    each: float | Floats | None

    def kept(self, group: Group) -> "Bound":
        """The same for all vertices that motions map to each other."""
        return self if self.each is None or isinstance(self.each, float) else Bound(group.least_of(self.each))

    def left(self, moves: Floats) -> "Bound":
        """What is left of it after the moves (n, 3) so far."""
        if self.each is None:
            return self
        size = np.linalg.norm(moves, axis=1)
        if isinstance(self.each, float):
            return Bound(max(self.each - float(size.max()), LEAST_LEFT * self.each))
        return Bound(np.maximum(self.each - size, LEAST_LEFT * self.each))

    def on(self, surface: Surface, chart: Chart) -> float | Floats | None:
        """The same for the control points (m,) of a surface: none moves a vertex further than that vertex may.

        A vertex moves by a mean of the moves of control points, each of which has the least bound of the vertices and
        samples of the surface that depend on it.
        """
        if self.each is None or isinstance(self.each, float):
            return self.each
        annulus = chart.annulus
        _, vertex = cKDTree(annulus.mesh.vertices).query(annulus.vertices)
        values = self.each[vertex]
        samples = lattice(surface, SAMPLES_PER_SPAN)
        _, near = cKDTree(annulus.vertices).query(surface.points(samples))
        uv = np.concatenate([samples, chart.uv, feet_of(surface, annulus.vertices, chart.uv)])
        which, _ = weights(surface, uv, ((0, 0),))
        least = np.full(surface.control_points.size // 3, np.inf)
        np.minimum.at(least, which, np.concatenate([values[near], values, values])[:, None])
        return np.where(least <= STILL * surface.size, 0.0, least)


def bound_of(given: float | str | ArrayLike | None, mesh: MeshLike, read: Mesh, annulus: Annulus) -> Bound:
    """Understand a bound: a number, the name of a field of the mesh's file, or a value for each vertex of `read`."""
    if given is None or isinstance(given, int | float):
        return Bound(None if given is None else float(given))
    if isinstance(given, str):
        scalars = on_wound_skin(read_field(mesh, given.removeprefix(FIELD).strip()), annulus)
        values = scalars.values[cKDTree(scalars.points).query(read.vertices)[1]]
    else:
        values = numbers(given, "bound", "a length, or one for each vertex")
        if values.shape != (len(read.vertices),):
            raise BadInputError(
                f"bound has shape {values.shape}; give one number, or one for each of {len(read.vertices)} vertices"
            )
    if not (values >= 0.0).all():
        raise BadInputError("bound is negative or NaN at a vertex; give lengths from 0 up, 0 where nothing may move")
    if not (values > 0.0).any():
        raise BadInputError("bound is 0 everywhere; give lengths above 0 where the part may move")
    return Bound(values)
