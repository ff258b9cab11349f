"""Sky view factors of the faces of a mesh, and the face behind each of them, through the material."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import area_vectors
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.rays import cast

_RAYS = 16
"""Directions by which the sky view factor is estimated, to about a tenth."""
_SKIN = 1e-7
"""Over the diagonal, how far a ray passes before it can meet a face: that of its start is not met."""


@dataclass(frozen=True)
class Sight:
    """Lines of sight from the middles (m, 3) of a mesh's faces, with their unit normals (m, 3).

    along (m, 3): a unit vector in each face; diagonal: of the mesh.
    """

    tree: FacetTree
    middles: Floats
    normals: Floats
    along: Floats
    diagonal: float

    @staticmethod
    def of(vertices: Floats, faces: Ints) -> "Sight":
        """Lines of sight of a mesh."""
        vectors = area_vectors(vertices, faces)
        normals = vectors / np.maximum(np.linalg.norm(vectors, axis=1), 1e-300)[:, None]
        corners = vertices[faces]
        sides = np.roll(corners, -1, axis=1) - corners
        longest = np.argmax(np.linalg.norm(sides, axis=2), axis=1)
        along = np.take_along_axis(sides, longest[:, None, None], 1)[:, 0]
        along = along / np.maximum(np.linalg.norm(along, axis=1), 1e-300)[:, None]
        diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        return Sight(FacetTree.of(vertices, faces), corners.mean(axis=1), normals, along, diagonal)

    def behind(self, faces: Ints) -> tuple[Ints, Floats]:
        """The face (k,) behind each of the given ones, straight through the material, or -1; its distance (k,)."""
        return cast(self.tree, self.middles[faces], -self.normals[faces], _SKIN * self.diagonal)

    def sky_view(self, faces: Ints) -> Floats:
        """Sky view factor (k,) of the given faces: the share of directions in which a ray from it meets no face.

        Directions are weighted by the cosine of their angle with the normal.
        """
        pattern = _hemisphere(_RAYS)
        up, side = self.normals[faces], self.along[faces]
        frame = np.stack([side, np.cross(up, side), up], axis=1)
        rays = np.einsum("rk,fki->fri", pattern, frame)
        rays /= np.linalg.norm(rays, axis=2, keepdims=True)
        start = np.repeat(self.middles[faces], _RAYS, axis=0)
        hit = cast(self.tree, start, rays.reshape(-1, 3), _SKIN * self.diagonal)[0]
        return np.asarray((hit < 0).reshape(-1, _RAYS).mean(axis=1))


def _hemisphere(count: int) -> Floats:
    """Unit vectors (count, 3) about z, spread evenly by the cosine (Malley's method on a sunflower's spiral)."""
    k = np.arange(count) + 0.5
    radius, turn = np.sqrt(k / count), np.pi * (3.0 - np.sqrt(5.0)) * k
    return np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.sqrt(1.0 - radius**2)])
