"""The connected pieces of a mesh, in order of their area."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.spoken import argument
from meshwind.mesh.geometry.areas_and_volumes import areas
from meshwind.mesh.geometry.topology import patches

_STEPS = 1e9
"""Areas and positions are rounded to this many steps, so that round-off does not decide the order of pieces."""
_LARGE = 0.05
"""Area over that of the largest piece above which a dropped piece is worth a warning: no screw, no crumb of a scan."""
_MANY_PIECES, _SMALL_SHARE = 20, 0.05
"""With more pieces than this, of which the largest has less than this share of the area, a mesh is not a surface."""


@dataclass(frozen=True)
class Chosen:
    """The piece that is kept: its faces (m, 3), notes on what was dropped, and warnings."""

    faces: Ints
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Pieces:
    """A manifold, oriented mesh in pieces.

    vertices (n, 3), faces (m, 3); rank (m,) of each face's piece, 0 the largest; areas (p,) of the pieces.
    """

    vertices: Floats
    faces: Ints
    rank: Ints
    areas: Floats

    @staticmethod
    def of(vertices: Floats, faces: Ints) -> "Pieces":
        """Find the pieces of a mesh, ordered by area; those of equal area by their centroids, x first."""
        label, area = patches(faces), areas(vertices, faces)
        size = np.bincount(label, area)
        weight = np.maximum(size, np.finfo(float).tiny)
        middle = vertices[faces].mean(axis=1) * area[:, None]
        centroids = [np.bincount(label, middle[:, k]) / weight for k in range(3)]
        extent = max(float(np.ptp(vertices, axis=0).max()), np.finfo(float).tiny)
        z, y, x = (np.round(_STEPS * (coordinate / extent)) for coordinate in centroids[::-1])
        order = np.lexsort((z, y, x, -np.round(_STEPS * (size / max(size.max(), np.finfo(float).tiny)))))
        rank = np.empty(len(order), dtype=np.int64)
        rank[order] = np.arange(len(order))
        return Pieces(vertices, faces, rank[label], size[order].astype(np.float64))

    def chosen(self, component: int | None, name: str) -> "Chosen":
        """The piece of this rank; None takes the largest, with a warning if another one is large."""
        count = len(self.areas)
        given, component = component is not None, 0 if component is None else component
        self._check(component, name)
        kept = self.faces[self.rank == component]
        if count == 1:
            return Chosen(kept)
        which = "the largest" if component == 0 else f"number {component} by area"
        dropped = f"dropped {count - 1} {'piece' if count == 2 else 'pieces'} beside {which}"
        notes = (f"{dropped} ({len(self.faces) - len(kept)} faces)",)
        share = self.areas[1] / max(self.areas[0], np.finfo(float).tiny)
        if given or share <= _LARGE:
            return Chosen(kept, notes)
        inside = ", within its bounds," if self._within(kept, self.faces[self.rank == 1]) else ""
        warning = (
            f"{count} pieces: the largest is taken; the next one{inside} has {100.0 * share:.2g} % of its area, and "
            f"{argument('component', 1)} takes that instead"
        )
        return Chosen(kept, notes, (warning,))

    def _check(self, component: int, name: str) -> None:
        count = len(self.areas)
        if isinstance(component, bool) or not isinstance(component, int | np.integer) or not 0 <= component < count:
            pieces = "1 piece; give 0" if count == 1 else f"{count} pieces; give a number from 0 to {count - 1}"
            raise BadInputError(f"{name}: component {shortened(repr(component))}: the mesh has {pieces}")
        if count > _MANY_PIECES and self.areas[0] < _SMALL_SHARE * self.areas.sum():
            raise BadInputError(
                f"{name}: falls apart into {count} pieces, for its triangles do not meet; weld their vertices and"
                " export the mesh again"
            )

    def _within(self, kept: Ints, other: Ints) -> bool:
        """Whether the bounding box of one piece contains that of another."""
        (low, high), (least, most) = (
            (points.min(axis=0), points.max(axis=0))
            for points in (self.vertices[kept.ravel()], self.vertices[other.ravel()])
        )
        return bool((low <= least).all() and (most <= high).all())
