"""The rims of a part with a wall: what lies between its outer and its inner skin, and belongs to neither."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.geometry.facet_tree import FacetTree
from meshwind.mesh.walls.face_graph import FaceGraph
from meshwind.mesh.walls.sides import INNER, OUTER, RIM
from meshwind.mesh.walls.sight import Sight

_TURN = np.cos(np.radians(30.0))
"""A skin ends where it turns by more than this towards the other: a face of an end, a chamfer of 45 degrees."""
_FAR, _THROUGH = 2.0, 3.0
"""A face is not across the wall that is more than this times as far off as usual, and as the other side is."""
_STEPS = 4
"""Steps from face to face, over which a face of the skin counts: two rows of pairs of triangles."""


def across(sight: Sight, side: Ints, corners: Floats) -> tuple[Bools, float]:
    """Mask (m,) of the faces with the other side across the wall, facing away; and the wall's median thickness.

    side (m,) as from `sides`; corners (m, 3, 3) of the faces.
    """
    everyone = np.arange(len(side))
    behind, distance = sight.behind(everyone)
    facing = -np.einsum("ij,ij->i", sight.normals, sight.normals[behind])
    found = (behind >= 0) & (side[behind] != side) & (facing > _TURN)
    if not found.any():
        return found, 0.0
    usual = float(np.median(distance[found]))
    far = np.flatnonzero(found & (distance > _FAR * usual))
    for label in (OUTER, INNER):
        # the face of an end looks along the wall at that of the other end, and the other side is right beside it
        chosen = far[side[far] == label]
        if len(chosen):
            others = corners[side == -label]
            tree = FacetTree.of(others.reshape(-1, 3), np.arange(3 * len(others)).reshape(-1, 3))
            found[chosen[distance[chosen] > _THROUGH * tree.distances(sight.middles[chosen])]] = False
    return found, float(np.median(distance[found & (side == OUTER)])) if (found & (side == OUTER)).any() else 0.0


def without_rims(sight: Sight, graph: FaceGraph, side: Ints, found: Bools) -> Ints:
    """OUTER, RIM or INNER (m,) for each face; found (m,) as from `across`.

    About the border between the sides, faces that are not across a wall belong to the skin whose normals, continued
    from its faces that are, they share; those that share neither are the rim.
    """
    zone = graph.linked(~found, graph.borders(side))
    if not zone.any():
        return side
    alike = np.stack([_alike(sight, graph, found & (side == label), zone) for label in (OUTER, INNER)])
    label, turned = side.copy(), np.zeros(len(side), dtype=bool)
    label[zone] = np.where(alike[0] > _TURN, OUTER, np.where(alike[1] > _TURN, INNER, side[zone]))
    turned[zone] = (alike <= _TURN).all(axis=0)
    label[graph.linked(turned, graph.borders(label))] = RIM
    for one in (OUTER, INNER):
        mask = label == one
        label[mask & ~graph.largest(mask)] = RIM
    return label


def _alike(sight: Sight, graph: FaceGraph, skin: Bools, zone: Bools) -> Floats:
    """Cosine (k,) between the normal of each face of the zone and those of the skin, continued into it.

    Normals continued over an edge that runs along the part, as of a duct, are those of neither side: there the face of
    the skin counts from which a few steps lead to the face over others that are like it.
    """
    normals = graph.extended(sight.normals, skin, zone)
    size = np.maximum(np.linalg.norm(normals, axis=1), np.finfo(float).tiny)
    best = np.zeros(len(skin))
    best[zone] = np.einsum("ij,ij->i", normals, sight.normals[zone]) / size
    seed = np.where(skin, np.arange(len(skin)), -1)
    tail, head = np.concatenate([graph.first, graph.second]), np.concatenate([graph.second, graph.first])
    tail, head = tail[zone[head]], head[zone[head]]
    for _ in range(_STEPS):
        led = seed[tail] >= 0
        source, target = seed[tail[led]], head[led]
        like = np.einsum("ij,ij->i", sight.normals[source], sight.normals[target])
        order = np.argsort(like, kind="stable")
        order = order[like[order] > _TURN]
        seed[target[order]] = source[order]  # the most alike comes last, and stays
        np.maximum.at(best, target, like)
    return best[zone]
