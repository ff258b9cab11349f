"""Notice where a surface runs through itself or lies double: no repair mends that, but the user should know."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import area_vectors
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.geometry.topology import edges

_MOST = 300_000  # faces up to which the search tree takes less than 0.5 s
_MOST_EDGES, _MOST_FACES = 20_000, 4_000
"""So many are tested, spread evenly over the list: at most 0.2 s."""
_DOUBLE = 1e-3  # two layers closer than this part of the diagonal are one wall
_FEW = 0.01  # share of faces in double walls that is not worth a word
_INNER = 0.02  # share of an edge at each end that is left out, where other faces meet it
_OFF = 1e-7  # of the diagonal, where a ray starts off its own face


def overlaps(vertices: Floats, faces: Ints) -> list[str]:
    """Sentences about self-intersections and double walls, none where there are none among those tested."""
    if len(faces) > _MOST:
        return [f"did not look for self-intersections and double walls, for there are more than {_MOST} faces"]
    tree = FacetTree.of(vertices, faces)
    notes = []
    ends = edges(faces).ends
    ends = ends[:: -(-len(ends) // _MOST_EDGES)]
    count = int(_pierced(tree, vertices, faces, ends).sum())
    if count:
        notes.append(f"noticed that the surface runs through itself: {count} of {len(ends)} edges tested pierce a face")
    tested = faces[:: -(-len(faces) // _MOST_FACES)]
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    count = int(_double(tree, vertices, faces, tested, diagonal).sum())
    if count > _FEW * len(tested):
        near = f"within {_DOUBLE * diagonal:.2g} of another layer"
        notes.append(f"noticed a double wall: {count} of {len(tested)} faces tested lie {near}")
    return notes


def _pierced(tree: FacetTree, vertices: Floats, faces: Ints, ends: Ints) -> Bools:
    """Edges (k,) that pierce a face which does not hold either of their ends."""
    start, along = vertices[ends[:, 0]], vertices[ends[:, 1]] - vertices[ends[:, 0]]
    return _hits(tree, faces, ends, start + _INNER * along, (1 - 2 * _INNER) * along)


def _double(tree: FacetTree, vertices: Floats, faces: Ints, tested: Ints, diagonal: float) -> Bools:
    """Faces (k,) above or below which another layer lies."""
    normals = unit(area_vectors(vertices, tested))
    middle, reach = vertices[tested].mean(axis=1), _DOUBLE * diagonal
    above, below = (
        _hits(tree, faces, tested, middle + sign * _OFF * diagonal * normals, sign * reach * normals)
        for sign in (1.0, -1.0)
    )
    return np.asarray(above | below)


def _hits(tree: FacetTree, faces: Ints, own: Ints, start: Floats, ray: Floats) -> Bools:
    """Whether each ray, as long as it is, first meets a face that shares no vertex with its own ones (k, any)."""
    face = tree.first_hits(start, ray)
    shared = (faces[face][:, :, None] == own[:, None, :]).any(axis=(1, 2))
    return np.asarray((face >= 0) & ~shared)
