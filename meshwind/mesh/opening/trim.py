"""Trimming of a mesh to an annulus: ends are chosen, other rims filled, and poles opened."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.checks import check_type, check_word
from meshwind.core.defaults import OPENED_BY
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.spoken import called
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.geometry.fill_holes import fill_defects, fill_hole
from meshwind.mesh.geometry.mesh import Annulus, Mesh
from meshwind.mesh.geometry.topology import euler, loops, patches
from meshwind.mesh.opening.branches import OpenRims, branch_warnings
from meshwind.mesh.opening.choose_ends import End, EndsRequest, choose_ends, parse_ends, rims_by_number
from meshwind.mesh.opening.curved_facets import CurvedFacets, curved_facets, split_chords
from meshwind.mesh.opening.cut_opening import pinched
from meshwind.mesh.opening.opening_radius import Opening, open_ends
from meshwind.mesh.opening.straight import straightened
from meshwind.mesh.opening.walled import in_words, wall_of

_FLAT = 1e-6
"""Largest volume over area^(3/2) of a flat part: 0.094 for a ball, 6e-3 for a rod a thousand times as long as thick."""


def annulus(
    mesh: Mesh,
    ends: str | ArrayLike = "auto",
    opening: float | None = None,
    side: str = "outer",
    opening_by: str = "auto",
) -> Annulus:
    """Open a mesh at its two ends.

    With ends="auto" the ends are the two largest open rims, the longer one first.  Where there is only one, it comes
    first, and the pole across from it second.  A closed part gets two poles on its axis, the fuller end of the part
    first.  With an axis the start is the end with the lower coordinate, with two points it is the first one.  An end
    that is hollow like a cup is cut at its lip, and its lining is dropped.

    A part with a wall, such as a pipe or a bottle, is split into its outer and its inner skin, and one of them is
    opened.  Between the skins lie the rims: all that turns by more than 30 degrees from a skin towards the other one,
    such as the faces of the ends, chamfers of 45 degrees, and the far part of a fillet.

    Parameters
    ----------
    mesh : Mesh
        Repaired mesh of a part like a tube or a closed body.
    ends : str or array_like of float, shape (2, 3), default "auto"
        Where the ends are: "auto", a model axis "x", "y" or "z", two points in the mesh's units, as an array or as
        "x,y,z x,y,z", or two open rims "loops i j" by their numbers, 0 being the longest.
    opening : float, optional
        Radius of the hole that is cut about each pole, in the mesh's units.  By default 0.4 of the part's mean radius.
        Open rims are ends as they are.
    side : {"outer", "inner"}, default "outer"
        Skin of a part with a wall.  The inner one is oriented as the surface of a mandrel that fills the part: its
        normals point away from the axis, into the wall, so that fibres press towards the axis.
    opening_by : {"auto", "level", "plane"}, default "auto"
        How a pole is opened: along a level line of the distance to the pole, or by a plane square to the part's axis.
        A level line bites into the flanks of a blade.  "auto" takes the plane if the level line's rim is uneven by
        more than 0.3 of its radius and the plane's by less than half of that.  The unevenness of a rim is its root
        mean square distance from a plane, together with the distance of its centre from the axis.  A plane's opening
        is wider than `opening` if the end is flat.

    Returns
    -------
    Annulus
        Mesh with exactly two rims.

    Raises
    ------
    BadInputError
        If the part is flat or has handles, if an end cannot be opened, or if an argument cannot be used.

    Examples
    --------
    >>> import meshwind as mw
    >>> opened = mw.annulus(mw.read("data/tank.ply"), opening=15.0)
    >>> [len(rim) > 3 for rim in opened.rims]
    [True, True]
    """
    check_type(mesh, "mesh", Mesh, "as read('part.stl') returns it")
    request = parse_ends(ends)
    _check_opening(opening)
    _check_opening_by(opening_by)
    _check_part(mesh)
    wall = wall_of(mesh, side)
    part = mesh if wall is None else wall.skin
    rims = rims_by_number(part.vertices, loops(part.faces))
    requested = _requested(rims, request, mesh.name)
    vertices, faces, others, notes = fill_defects(part, rims, requested)
    pair, words = choose_ends(vertices, faces, requested or others, request)
    chosen = {int(end.loop[0]) for end in pair if end.loop is not None}
    spare = [loop for loop in others if int(loop[0]) not in chosen]
    if spare:
        notes.append(f"filled {len(spare)} other open {'rim' if len(spare) == 1 else 'rims'}")
    kept = [end.loop for end in pair if end.loop is not None]
    open_rims = OpenRims.of(vertices, faces, spare, kept, bool(requested))
    for loop in spare:
        vertices, faces = fill_hole(vertices, faces, loop)
    surface = curved_facets(vertices, faces, np.arange(len(vertices)) < len(part.vertices))
    if wall is not None:
        words = words.replace("open rims", f"rims of the {side} skin").replace("open rim", f"rim of the {side} skin")
        for loop in kept:
            surface = straightened(surface, vertices[loop])
    asked = opening is not None or opening_by != "auto"
    surface, openings = open_ends(surface, pair, opening, opening_by, mesh.name)
    found = _assembled(mesh, split_chords(surface), pair, [_ends_in_words(words, pair, openings, asked), *notes])
    decided = (*(in_words(wall) for wall in [wall] if wall), *(each.why for each in openings if each.why))
    return replace(found, notes=decided, wall=wall, warnings=branch_warnings(found, open_rims))


def _check_opening(opening: float | None) -> None:
    good = isinstance(opening, int | float | np.number) and not isinstance(opening, bool)
    if opening is not None and not (good and np.isfinite(opening) and opening > 0):
        raise BadInputError(
            f"opening {shortened(str(opening))}: give the radius of the hole at a pole, a number above 0"
        )


def _check_opening_by(by: str) -> None:
    check_word(by, "opening_by", OPENED_BY)


def _check_part(mesh: Mesh) -> None:
    """Refuse a surface without an inside."""
    area = float(areas(mesh.vertices, mesh.faces).sum())
    if abs(volume(mesh.vertices, mesh.faces)) < _FLAT * area**1.5:
        count = f"{len(mesh.faces)} {'triangle' if len(mesh.faces) == 1 else 'triangles'}"
        raise BadInputError(
            f"{mesh.name}: is flat ({count} without an inside): meshwind winds parts like a tube or a closed blob;"
            " give the whole surface of the part"
        )


def _requested(rims: list[Ints], request: EndsRequest, name: str) -> list[Ints]:
    """The two loops that are requested by number, if any."""
    if request.loops is None:
        return []
    if max(request.loops) >= len(rims):
        count = {0: "no open rims", 1: "1 open rim"}.get(len(rims), f"{len(rims)} open rims, 0 to {len(rims) - 1}")
        raise BadInputError(f"{name}: ends {request.text!r}: the part has {count}; {called('check')} lists them")
    return [rims[k] for k in request.loops]


def _assembled(mesh: Mesh, surface: CurvedFacets, pair: list[End], words: list[str]) -> Annulus:
    """The annulus, after a check that it is one."""
    rims = [] if pinched(surface.faces) else loops(surface.faces)
    if len(rims) != 2 or euler(surface.faces) != 0 or patches(surface.faces).any():
        raise BadInputError(
            f"{mesh.name}: trimming left {len(rims)} rims where a tube has 2; choose other ends or a smaller opening"
        )
    if not areas(surface.vertices, surface.faces).min() > 0:
        raise BadInputError(f"{mesh.name}: trimming left a face without area; remesh the part or choose other ends")
    if not surface.trusted.any():
        raise BadInputError(
            f"{mesh.name}: no vertex is left between the openings; choose a smaller opening, or give a finer mesh"
        )
    start = int(np.argmin([_offset(surface.vertices[rim], pair) for rim in rims]))
    first, second = rims[start], rims[1 - start]
    # along the orientation of the faces the surface is on the left: u increases at the start and decreases at the end
    ordered = frozen(first), frozen(np.roll(second[::-1], 1))
    vertices, faces, trusted = frozen(surface.vertices), frozen(surface.faces), frozen(surface.trusted)
    caps = pair[0].is_pole, pair[1].is_pole
    return Annulus(mesh, vertices, faces, ordered, trusted, "; ".join(words), caps=caps)


def _offset(rim: Floats, pair: list[End]) -> float:
    """How much nearer a rim lies to the first end than to the second."""
    near = [float(np.linalg.norm(rim - end.centre, axis=1).mean()) for end in pair]
    return near[0] - near[1]


def _ends_in_words(words: str, pair: list[End], openings: list[Opening], asked: bool) -> str:
    """How the ends were chosen, in a sentence; asked: whether a size or a kind of opening was wanted."""
    positions = " and ".join(end.position for end in pair)
    if any(end.lip is not None for end in pair):
        words += ", the lip where one is hollow"
    if not openings:
        unused = ", no opening cut as both are open" if asked else ""
        return f"{words}, at {positions}{unused}"
    sizes = " and ".join(dict.fromkeys(map(str, openings))).replace(" and radius ", " and ")
    return f"{words}, at {positions}, opened to {sizes}"
