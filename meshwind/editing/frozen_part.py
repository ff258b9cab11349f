"""What must not move of a mesh: control points as they are given, or a region with its vertices."""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from meshwind.chart.chart import Chart
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.editing.feet import feet_of
from meshwind.editing.freedom import Frozen
from meshwind.editing.region import FACES, SAMPLES_PER_SPAN, Region, parse
from meshwind.editing.stencil import pitches
from meshwind.mesh import Annulus, Mesh
from meshwind.mesh.io.read import MeshLike
from meshwind.mesh.io.scalars import Scalars
from meshwind.surface.surface import Surface
from meshwind.workflow.part import on_wound_skin, read_field

_FINEST = 24
"""Most parts of an edge of a picked face between points of it that are looked at."""


@dataclass(frozen=True)
class FrozenPart:
    """What must not move: as it was given, or a region with the scalars of its field."""

    given: Frozen
    region: Region | None = None
    scalars: Scalars | None = None

    def on(self, surface: Surface, chart: Chart) -> Frozen:
        """The same for the control points of a surface: no vertex in a region moves, nor the surface there."""
        if self.region is None:
            return self.given
        return self.region.control_points(surface, self._inside(self.region, surface, chart), self.scalars)

    def vertices(self, chart: Chart) -> Bools:
        """Mask (n,) of the vertices of the mesh that must not move; none where no region is given."""
        mesh = chart.annulus.mesh
        if self.region is None:
            return np.zeros(len(mesh.vertices), dtype=bool)
        return _held(self.region, chart, self.scalars)

    def on_skin(self, annulus: Annulus) -> "FrozenPart":
        """The same with the scalars of the skin that is wound, if the part has a wall."""
        return self if self.scalars is None else replace(self, scalars=on_wound_skin(self.scalars, annulus))

    def named(self, surface: Surface, chart: Chart) -> dict[str, Bools] | None:
        """Masks of control points by each term, as they were given; None where it is no region."""
        if self.region is None:
            return None
        found = {}
        for each in self.region.parts:
            try:
                inside = self._inside(each, surface, chart)
                found[each.text] = each.control_points(surface, inside, self.scalars)
            except BadInputError:  # one of several terms may be empty
                continue
        return found

    @property
    def on_any_surface(self) -> bool:
        """Whether it means something on another control net, as a mask does not."""
        return self.region is not None or self.given is None or callable(self.given)

    def _inside(self, region: Region, surface: Surface, chart: Chart) -> Floats:
        """Parameters (k, 2) on the surface of wound vertices in a region, and of points on its picked faces."""
        annulus = chart.annulus
        held = _held(region, chart, self.scalars)
        distance, vertex = cKDTree(annulus.mesh.vertices).query(annulus.vertices)
        mine = np.flatnonzero(held[vertex] & (distance == 0.0))
        points, guess = [annulus.vertices[mine]], [chart.uv[mine]]
        if len(region.faces):
            on = _points_of(annulus.mesh, region.faces, min(pitches(surface)) / SAMPLES_PER_SPAN)
            far, near = cKDTree(annulus.vertices).query(on)
            edges = annulus.mesh.vertices[annulus.mesh.faces[region.faces]]
            reach = float(np.linalg.norm(edges - np.roll(edges, 1, axis=1), axis=2).max())
            points, guess = [*points, on[far <= reach]], [*guess, chart.uv[near[far <= reach]]]
        whole = np.concatenate(points)
        return feet_of(surface, whole, np.concatenate(guess)) if len(whole) else np.zeros((0, 2))


def _held(region: Region, chart: Chart, scalars: Scalars | None) -> Bools:
    """Mask (n,) of the vertices of the mesh that lie in a region; u and v are those of the wound ones."""
    annulus = chart.annulus
    mesh = annulus.mesh
    distance, near = cKDTree(annulus.vertices).query(mesh.vertices)
    uv = np.where(distance[:, None] == 0.0, chart.uv[near], np.nan)
    held = region.contains(uv, mesh.vertices, scalars)
    held[mesh.faces[region.faces]] = True
    return held


def _points_of(mesh: Mesh, faces: Ints, apart: float) -> Floats:
    """Points (k, 3) on faces of a mesh, at most so far apart along their edges."""
    corners = mesh.vertices[mesh.faces[faces]]
    longest = float(np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).max())
    parts = int(np.clip(np.ceil(longest / apart), 1, _FINEST))
    a, b = np.meshgrid(np.arange(parts + 1), np.arange(parts + 1), indexing="ij")
    some = a + b <= parts
    shares = np.stack([a[some], b[some], parts - a[some] - b[some]], axis=1) / parts
    return np.asarray(np.einsum("sc,fcd->fsd", shares, corners).reshape(-1, 3))


def frozen_part(frozen: Frozen | str, mesh: MeshLike, read: Mesh) -> FrozenPart:
    """Understand what must not move of a mesh that was `read`; reads its file where that is a scalar of it."""
    if not isinstance(frozen, str):
        return FrozenPart(frozen)
    region = parse(frozen)
    if len(region.faces):
        _check_faces(region.faces, read)
    if not region.field:
        return FrozenPart(None, region)
    return FrozenPart(None, region, read_field(mesh, region.field))


def _check_faces(faces: Ints, mesh: Mesh) -> None:
    """Raise BadInputError for numbers of faces that the mesh has not, or that its repair may have changed."""
    count = len(mesh.faces)
    if mesh.read_faces not in (0, count):
        raise BadInputError(
            f"{FACES} numbers the faces of the file, of which repairs left {count} of {mesh.read_faces}; save the "
            "repaired mesh first, or freeze by ranges or a field"
        )
    if faces.min() < 0 or faces.max() >= count:
        raise BadInputError(f"{FACES} names face {faces.max()}; give numbers from 0 to {count - 1}")
