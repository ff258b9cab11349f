"""The eye as a body: a ball, a box or a mesh, where its axes turn it, and whether it meets the part."""

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.rays import cast
from meshwind.mesh.geometry.topology import boundary
from meshwind.program.blocks import Blocks
from meshwind.program.machine import Machine
from meshwind.program.mandrel import Mandrel

_BOX_FACES = np.array([
    [0, 1, 2], [1, 3, 2], [4, 6, 5], [5, 6, 7], [0, 4, 1], [1, 4, 5],
    [2, 3, 6], [3, 7, 6], [0, 2, 4], [2, 6, 4], [1, 5, 3], [3, 5, 7],
])  # fmt: skip
"""Triangles of a box whose corner 4 i + 2 j + k is at end i, j, k of its lengths, seen from outside."""
_LONG = 4.0
"""Length of an edge of the part over the median above which it is near to every block: few are, such as the shaft's."""
_CHUNK = 64
"""Blocks whose eye is compared with the part at once: edges of the part near to all of them are held."""


@dataclass(frozen=True)
class Head:
    """The eye as a body in its own frame, in the mesh's units: a ball about the eye, or a closed mesh.

    The frame has its origin at the eye, x along the span away from the part, y along the roller, and z = x cross y.

    radius: of the ball, or about the middle of the mesh; vertices (n, 3), faces (m, 3): of the mesh, empty for a ball.
    """

    radius: float
    vertices: Floats
    faces: Ints

    @property
    def ball(self) -> bool:
        """Whether it is a ball."""
        return not len(self.faces)

    @cached_property
    def middle(self) -> Floats:
        """The middle (3,) of the ball about it."""
        if self.ball:
            return np.zeros(3)
        return np.asarray(0.5 * (self.vertices.min(axis=0) + self.vertices.max(axis=0)))

    @cached_property
    def tree(self) -> FacetTree:
        """The tree of its triangles."""
        return FacetTree.of(frozen(self.vertices), frozen(self.faces))

    @cached_property
    def edges(self) -> tuple[Floats, Floats]:
        """Starts and vectors (e, 3) of its edges."""
        return _edges(self.vertices[self.faces])


def head_of(machine: Machine, scale: float) -> Head | None:
    """The body of a machine's eye, None if it has none; scale: mm in the mesh's unit.

    Raises BadInputError if its mesh cannot be read or is not closed.
    """
    eye = machine.eye
    if eye.mesh is not None:
        vertices, faces = _read(eye.mesh)
        vertices = vertices / scale
    elif eye.box is not None:
        along, roller, across = np.array(eye.box) / scale
        ends = np.stack(np.meshgrid([0.0, along], [-0.5, 0.5], [-0.5, 0.5], indexing="ij"), axis=-1).reshape(-1, 3)
        vertices, faces = ends * [1.0, roller, across], _BOX_FACES
    elif eye.ball > 0.0:
        return Head(eye.ball / scale, np.empty((0, 3)), np.empty((0, 3), dtype=np.int64))
    else:
        return None
    middle = 0.5 * (vertices.min(axis=0) + vertices.max(axis=0))
    return Head(float(np.linalg.norm(vertices - middle, axis=1).max()), vertices, faces)


def _read(file: str) -> tuple[Floats, Ints]:
    """Vertices and faces of a closed mesh in mm."""
    from meshwind.mesh.io.read import read

    mesh = read(Path(file))
    if mesh.warnings:
        raise BadInputError(f"the eye's mesh {file}: {mesh.warnings[0]}; give one closed piece")
    if len(boundary(mesh.faces)):
        raise BadInputError(f"the eye's mesh {file} has open edges; give a closed one")
    return mesh.vertices, mesh.faces.astype(np.int64)


def frames(blocks: Blocks, mandrel: Mandrel, machine: Machine) -> Floats:
    """Axes (n, 3, 3) of the eye's frame as columns, in the mesh's coordinates, as far as the machine turns it.

    At roll and yaw 0 x leads round the axis, y along it, and z from it.  The roll turns x to the axis, the yaw from it.
    """
    roll, yaw = (getattr(blocks, moves) * (machine.axis(moves) is not None) for moves in ("roll", "yaw"))
    return frames_at(mandrel, blocks.mandrel, roll, yaw)


def frames_at(mandrel: Mandrel, turned: Floats, roll: Floats, yaw: Floats) -> Floats:
    """The same at angles (n,) of mandrel, roll and yaw in degrees."""
    out = mandrel.towards(turned)
    along = np.broadcast_to(mandrel.direction, out.shape)
    round_ = np.cross(along, out)
    roll, yaw = np.radians(roll)[:, None], np.radians(yaw)[:, None]
    ahead = np.cos(roll) * round_ + np.sin(roll) * along
    roller = np.cos(roll) * along - np.sin(roll) * round_
    x = np.cos(yaw) * ahead + np.sin(yaw) * out
    return np.stack([x, roller, np.cos(yaw) * out - np.sin(yaw) * ahead], axis=2)


def meets(head: Head, surface: FacetTree, eyes: Floats, turned: Floats) -> Bools:
    """Whether a body at eyes (n, 3), turned by frames (n, 3, 3), meets a closed surface or holds one or is within it.

    Only where the ball about the body reaches the surface its triangles are looked at.  Two triangles meet where an
    edge of one goes through the other; so edges of each are cast at the tree of the other.
    """
    middles = eyes + turned @ head.middle
    near = surface.distances(middles) < head.radius
    if head.ball:
        return np.asarray(near)
    found = within(surface, eyes + turned @ head.vertices[head.faces[0, 0]], turned[:, :, 2])
    close = np.flatnonzero(near & ~found)
    start, vector = _edges(surface.corners)
    half = 0.5 * np.linalg.norm(vector, axis=1)
    short = np.flatnonzero(half <= _LONG * np.median(half))
    long = np.flatnonzero(half > _LONG * np.median(half))
    search = cKDTree(start[short] + 0.5 * vector[short])
    reach = head.radius + float(half[short].max())
    for first in range(0, len(close), _CHUNK):
        chosen = close[first : first + _CHUNK]
        found[chosen] = _cross(head, surface, eyes[chosen], turned[chosen])
        chosen = chosen[~found[chosen]]
        lists = search.query_ball_point(middles[chosen], reach)
        owner = np.concatenate([np.repeat(chosen, [len(each) for each in lists]), np.repeat(chosen, len(long))])
        which = np.concatenate([short[np.concatenate([*lists, []]).astype(np.int64)], np.tile(long, len(chosen))])
        own = np.einsum("nji,nj->ni", turned[owner], start[which] - eyes[owner])
        ray = np.einsum("nji,nj->ni", turned[owner], vector[which])
        hit = head.tree.first_hits(own, ray) >= 0
        inside = within(head.tree, own, np.broadcast_to([0.0, 0.0, 1.0], own.shape))
        found[owner[hit | inside]] = True
    return found


def _cross(head: Head, surface: FacetTree, eyes: Floats, turned: Floats) -> Bools:
    """Whether edges of a body go through a surface."""
    start, vector = head.edges
    starts = eyes[:, None] + start @ np.swapaxes(turned, 1, 2)
    vectors = np.broadcast_to(vector @ np.swapaxes(turned, 1, 2), starts.shape)
    hit = surface.first_hits(starts.reshape(-1, 3), vectors.reshape(-1, 3)) >= 0
    return np.asarray(hit.reshape(len(eyes), -1).any(axis=1))


def within(tree: FacetTree, points: Floats, rays: Floats) -> Bools:
    """Whether points (n, 3) are within a closed surface: the first triangle along a ray is seen from its back."""
    if not len(points):
        return np.zeros(0, dtype=bool)
    face = cast(tree, frozen(np.ascontiguousarray(points)), frozen(np.ascontiguousarray(rays)), 0.0)[0]
    order = np.empty(len(tree.numbers), dtype=np.int64)
    order[tree.numbers] = np.arange(len(order))
    corner = tree.corners[order[np.maximum(face, 0)]]
    normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
    return np.asarray((face >= 0) & ((normal * rays).sum(axis=1) > 0.0))


def _edges(corners: Floats) -> tuple[Floats, Floats]:
    """Starts and vectors (3 m, 3) of the edges of triangles (m, 3, 3)."""
    start = corners.reshape(-1, 3)
    return start, np.roll(corners, -1, axis=1).reshape(-1, 3) - start
