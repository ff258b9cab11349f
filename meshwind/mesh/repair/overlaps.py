"""Detection of self-intersections and double walls, which are not repaired but reported."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import area_vectors
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.topology import edges

_MAX_FACES = 300_000
"""Largest mesh that is tested: up to this many faces, the search tree takes less than 0.5 s."""
_TESTED_EDGES, _TESTED_FACES = 20_000, 4_000
"""Maximum numbers of edges and faces that are tested, at equal steps through the list: at most 0.2 s."""
_DOUBLE = 1e-3
"""Largest distance of two layers of a double wall, over the diagonal."""
_FEW = 0.01
"""Share of tested faces in double walls below which they are not reported."""
_INNER = 0.02
"""Share of an edge that is left out at each end, where it meets other faces."""
_OFFSET = 1e-7
"""Distance at which a ray starts from its own face, over the diagonal."""


def overlaps(vertices: Floats, faces: Ints) -> list[str]:
    """Notes on self-intersections and double walls among the tested edges and faces."""
    if len(faces) > _MAX_FACES:
        return [f"did not look for self-intersections and double walls, for there are more than {_MAX_FACES} faces"]
    tree = FacetTree.of(vertices, faces)
    notes = []
    ends = edges(faces).ends
    ends = ends[:: -(-len(ends) // _TESTED_EDGES)]
    count = int(_pierced(tree, vertices, faces, ends).sum())
    if count:
        notes.append(f"noticed that the surface runs through itself: {count} of {len(ends)} edges tested pierce a face")
    tested = faces[:: -(-len(faces) // _TESTED_FACES)]
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    count = int(_double(tree, vertices, faces, tested, diagonal).sum())
    if count > _FEW * len(tested):
        near = f"within {_DOUBLE * diagonal:.2g} of another layer"
        notes.append(f"noticed a double wall: {count} of {len(tested)} faces tested lie {near}")
    return notes


def _pierced(tree: FacetTree, vertices: Floats, faces: Ints, ends: Ints) -> Bools:
    """Whether each edge (k,) intersects a face that does not contain either of its ends."""
    start, along = vertices[ends[:, 0]], vertices[ends[:, 1]] - vertices[ends[:, 0]]
    return _hits(tree, faces, ends, start + _INNER * along, (1 - 2 * _INNER) * along)


def _double(tree: FacetTree, vertices: Floats, faces: Ints, tested: Ints, diagonal: float) -> Bools:
    """Whether each tested face (k,) has another layer above or below it."""
    normals = unit(area_vectors(vertices, tested))
    middle, reach = vertices[tested].mean(axis=1), _DOUBLE * diagonal
    above, below = (
        _hits(tree, faces, tested, middle + sign * _OFFSET * diagonal * normals, sign * reach * normals)
        for sign in (1.0, -1.0)
    )
    return np.asarray(above | below)


def _hits(tree: FacetTree, faces: Ints, own: Ints, start: Floats, ray: Floats) -> Bools:
    """Whether the first face on each ray, up to its length, has none of the vertices own (k, any)."""
    face = tree.first_hits(start, ray)
    shared = (faces[face][:, :, None] == own[:, None, :]).any(axis=(1, 2))
    return np.asarray((face >= 0) & ~shared)
