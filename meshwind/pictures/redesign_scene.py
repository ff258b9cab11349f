"""Scene of redesign.png: a part before and after the redesign."""

from __future__ import annotations

from os import PathLike
from pathlib import Path

import igl
import numpy as np

from meshwind.appearance.looks import DIVERGING, Look, both_ways, round_below
from meshwind.appearance.view import around, merit_view, named_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints, floats, ints
from meshwind.core.checks import path_given
from meshwind.pictures import driver
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import Frame, RedesignScene
from meshwind.results.reading import read_edited
from meshwind.results.schema import LENGTHS

_MOVES = Look("displacement", "moved outward\n(red) or\ninward (blue)", LENGTHS, DIVERGING, both_ways)
_EYES = 240
_LONGEST, _SHORTEST, _APART = 0.08, 0.08, 0.055
"""Over the part's size the longest arrow, where displacements are smaller, and the distance of arrows; over the largest
displacement that of the shortest arrow."""
_MOVED = 0.01
"""Displacement over the largest above which a vertex counts as moved."""


def draw_redesign(
    picture: str | PathLike[str],
    before: Floats,
    moves: Floats,
    faces: Ints,
    name: str,
    units: str = "",
    page: Page | None = None,
) -> str:
    """Draw a mesh before and after a redesign.

    Parameters
    ----------
    picture : str or PathLike
        PNG file to write.
    before : ndarray of float, shape (n, 3)
        Vertices before the redesign, in the mesh's units.
    moves : ndarray of float, shape (n, 3)
        Displacements of the vertices.
    faces : ndarray of int, shape (m, 3)
        Vertices of each triangle, oriented outwards.
    name : str
        Name of the part, for the title.
    units : str, default ""
        Unit of the mesh, for the legend.
    page : Page, optional
        Size and style.

    Returns
    -------
    str
        Empty, or one line that says why there is no picture.

    Raises
    ------
    BadInputError
        If the arrays do not belong together.

    See Also
    --------
    write_redesign : Write all files of a redesign.

    Examples
    --------
    >>> import meshwind as mw
    >>> mesh = mw.read("data/elbow.obj")
    >>> moves = 0.02 * mesh.vertices
    >>> mw.draw_redesign("moved.png", mesh.vertices, moves, mesh.faces, "elbow", page=mw.Page(400, 300))
    ''
    """
    file = path_given(picture, "picture", "file for the picture")
    scene = redesign_scene(before, moves, faces, name, units)
    return driver.paint({file: Drawing(scene, page or Page())})


def redesign_in(folder: Path, name: str, units: str = "", seen_from: str = "auto") -> RedesignScene:
    """The scene of a redesign's folder; raises BadInputError if its edited mesh cannot be used."""
    return redesign_scene(*read_edited(folder), name, units, seen_from)


def redesign_scene(
    before: Floats, moves: Floats, faces: Ints, name: str, units: str = "", seen_from: str = "auto"
) -> RedesignScene:
    """The mesh before and after, seen from where most of the change is visible, coloured by its outward component."""
    vertices, moved = floats(before, "before", -1, 3), floats(moves, "moves", len(before), 3)
    corners = ints(faces, "faces", -1, 3)
    normals = np.asarray(igl.per_vertex_normals(np.array(vertices), np.array(corners)))
    outward = (moved * normals).sum(axis=1)
    size = np.linalg.norm(moved, axis=1)
    scale = _MOVES.scale(outward, units)
    eyes = around(_EYES)
    shown = np.maximum(eyes @ normals.T, 0.0) @ size
    merit = 2.0 * shown / max(float(shown.max()), 1e-300) - 1e-3 * eyes[:, 1]
    after = vertices + moved
    view = (
        merit_view(vertices, corners, eyes, merit)
        if seen_from == "auto"
        else named_view(np.concatenate([vertices, after]), seen_from)
    )
    changed = 100.0 * float((size > _MOVED * max(float(size.max()), 1e-300)).mean())
    title = f"{name}: before and after the redesign"
    subtitle = f"vertices move by up to {quantity(float(size.max()), units, 3)}; {changed:.0f} % of them move"
    frame = Frame(title, subtitle, units, view)
    longest = float(size.max())
    longer = (
        1.0 if longest == 0.0 else max(1.0, round_below(_LONGEST * float(np.ptp(vertices, axis=0).max()) / longest))
    )
    arrows = _spread(vertices, np.flatnonzero(size > _SHORTEST * longest), size)
    return RedesignScene(
        frame, scale, scale.shares(outward), vertices, after, corners, arrows, longer, outward[arrows] >= 0.0
    )


def _spread(points: Floats, some: Ints, size: Floats) -> Ints:
    """Of some points (k,) the one with the largest size in each cell of a grid."""
    if not len(some):
        return some
    cell = np.floor(points[some] / (_APART * float(np.ptp(points, axis=0).max()))).astype(np.int64)
    order = np.lexsort((-size[some], *cell.T))
    first = np.append(True, (np.diff(cell[order], axis=0) != 0).any(axis=1))
    return np.asarray(some[order[first]])
