"""Faces cut into triangles, those of second order through the nodes amid their sides, too."""

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.cells.faces import FaceList
from meshwind.mesh.io.cells.polygons import cut_polygons


def cut_faces(points: Floats, faces: FaceList) -> tuple[Ints, int]:
    """Triangles (m, 3) of faces, and how many faces cross themselves.

    A face with a node amid every side gives a triangle at each corner, and the polygon of those nodes; with one amid
    itself, too, triangles about that.  Where some are missing, the face is the polygon of all its nodes.
    """
    if len(faces.centres) == 0:
        return cut_polygons(points, faces.sizes, faces.corners)
    faces = _with_middles_of_neighbours(faces, len(points))
    of = np.repeat(np.arange(len(faces.sizes)), faces.sizes)
    given = np.bincount(of[faces.middles >= 0], minlength=len(faces.sizes))
    whole = given == faces.sizes
    centred = whole & (faces.centres >= 0)
    about, ring, plain = faces.where(centred), faces.where(whole & ~centred), faces.where(~whole)
    centres = np.repeat(about.centres, about.sizes)
    inner, crossed = cut_polygons(points, ring.sizes, ring.middles)
    others, more = cut_polygons(points, *_all_nodes(plain))
    found = [
        np.column_stack([about.corners, about.middles, centres]),
        np.column_stack([about.middles, about.corners[about.next()], centres]),
        np.column_stack([ring.middles, ring.corners[ring.next()], ring.middles[ring.next()]]),
        inner, others,
    ]  # fmt: skip
    return np.concatenate(found), crossed + more


def _with_middles_of_neighbours(faces: FaceList, points: int) -> FaceList:
    """The same with the node that another face has amid a side, where one is missing, so that they fit together."""
    has = faces.middles >= 0
    if has.all():
        return faces
    after = faces.corners[faces.next()]
    sides = np.minimum(faces.corners, after) * points + np.maximum(faces.corners, after)
    known, first = np.unique(sides[has], return_index=True)
    if len(known) == 0:
        return faces
    at = np.minimum(np.searchsorted(known, sides), len(known) - 1)
    found = np.where(known[at] == sides, faces.middles[has][first][at], -1)
    return FaceList(faces.sizes, faces.corners, np.where(has, faces.middles, found), faces.centres)


def _all_nodes(faces: FaceList) -> tuple[Ints, Ints]:
    """Sizes and nodes of the polygons through corners and the nodes amid sides."""
    nodes = np.column_stack([faces.corners, faces.middles]).ravel()
    of = np.repeat(np.arange(len(faces.sizes)), 2 * faces.sizes)
    return np.bincount(of[nodes >= 0], minlength=len(faces.sizes)), nodes[nodes >= 0]
