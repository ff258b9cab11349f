"""Trimming of a mesh to an annulus: ends are chosen, other rims filled, and poles opened."""

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.geometry.mesh import Annulus, Mesh
from meshwind.mesh.geometry.topology import euler, loops, patches
from meshwind.mesh.opening.choose_ends import End, EndsRequest, choose_ends, parse_ends, rims_by_number
from meshwind.mesh.opening.curved_facets import CurvedFacets, curved_facets, split_chords
from meshwind.mesh.opening.cut_opening import pinched
from meshwind.mesh.opening.fill_holes import fill_defects, fill_hole
from meshwind.mesh.opening.opening_radius import open_ends

_FLAT = 1e-6
"""Largest volume over area^(3/2) of a flat part: 0.094 for a ball, 6e-3 for a rod a thousand times as long as thick."""


def annulus(mesh: Mesh, ends: str = "auto", opening: float | None = None) -> Annulus:
    """Open a mesh at its two ends.

    With ends="auto" the ends are the two largest open rims, the longer one first.  Where there is only one, it comes
    first, and the pole across from it second.  A closed part gets two poles on its axis, the fuller end of the part
    first.  With an axis the start is the end with the lower coordinate, with two points it is the first one.  An end
    that is hollow like a cup is cut at its lip, and its lining is dropped.

    Parameters
    ----------
    mesh : Mesh
        Repaired mesh of a part like a tube or a closed body.
    ends : str, default "auto"
        Where the ends are: "auto", a model axis "x", "y" or "z", two points "x,y,z x,y,z" in the mesh's units, or two
        open rims "loops i j" by their numbers, 0 being the longest.
    opening : float, optional
        Radius of the hole that is cut about each pole, in the mesh's units.  By default 0.4 of the part's mean radius.
        Open rims are ends as they are.

    Returns
    -------
    Annulus
        Mesh with exactly two rims.

    Raises
    ------
    BadInputError
        If the part is flat or has handles, if an end cannot be opened, or if `ends` or `opening` cannot be used.

    Examples
    --------
    >>> import meshwind as mw
    >>> opened = mw.annulus(mw.read("data/tank.ply"), opening=15.0)
    >>> [len(rim) > 3 for rim in opened.rims]
    [True, True]
    """
    if not isinstance(mesh, Mesh):
        raise BadInputError(f"mesh is of type {type(mesh).__name__}: give a Mesh, as read('part.stl') returns it")
    request = parse_ends(ends)
    _check_opening(opening)
    rims = rims_by_number(mesh.vertices, loops(mesh.faces))
    _check_part(mesh, rims)
    requested = _requested(rims, request, mesh.name)
    vertices, faces, others, notes = fill_defects(mesh, rims, requested)
    pair, words = choose_ends(vertices, faces, requested or others, request)
    chosen = {int(end.loop[0]) for end in pair if end.loop is not None}
    spare = [loop for loop in others if int(loop[0]) not in chosen]
    if spare:
        notes.append(f"filled {len(spare)} other open {'rim' if len(spare) == 1 else 'rims'}")
    for loop in spare:
        vertices, faces = fill_hole(vertices, faces, loop)
    trusted = np.arange(len(vertices)) < len(mesh.vertices)
    surface, radii = open_ends(curved_facets(vertices, faces, trusted), pair, opening, mesh.name)
    return _assembled(mesh, split_chords(surface), pair, [_ends_in_words(words, pair, radii, opening), *notes])


def _check_opening(opening: float | None) -> None:
    good = isinstance(opening, int | float | np.number) and not isinstance(opening, bool)
    if opening is not None and not (good and np.isfinite(opening) and opening > 0):
        raise BadInputError(f"opening {opening}: give the radius of the hole at a pole, a number above 0")


def _check_part(mesh: Mesh, rims: list[Ints]) -> None:
    """Refuse a surface without an inside or with handles."""
    area = float(areas(mesh.vertices, mesh.faces).sum())
    if abs(volume(mesh.vertices, mesh.faces)) < _FLAT * area**1.5:
        count = f"{len(mesh.faces)} {'triangle' if len(mesh.faces) == 1 else 'triangles'}"
        raise BadInputError(
            f"{mesh.name}: is flat ({count} without an inside): meshwind winds parts like a tube or a closed blob;"
            " give the whole surface of the part"
        )
    genus = (2 - len(rims) - euler(mesh.faces)) // 2
    if genus != 0:
        raise BadInputError(
            f"{mesh.name}: genus {genus} (a handle or a hole right through): meshwind winds parts like a tube or a"
            " closed blob; cut the part open or fill the hole"
        )


def _requested(rims: list[Ints], request: EndsRequest, name: str) -> list[Ints]:
    """The two loops that are requested by number, if any."""
    if request.loops is None:
        return []
    if max(request.loops) >= len(rims):
        count = {0: "no open rims", 1: "1 open rim"}.get(len(rims), f"{len(rims)} open rims, 0 to {len(rims) - 1}")
        raise BadInputError(f"{name}: ends {request.text!r}: the part has {count}; `meshwind check` lists them")
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
    start = int(np.argmin([_offset(surface.vertices[rim], pair) for rim in rims]))
    first, second = rims[start], rims[1 - start]
    # along the orientation of the faces the surface is on the left: u increases at the start and decreases at the end
    ordered = frozen(first), frozen(np.roll(second[::-1], 1))
    vertices, faces, trusted = frozen(surface.vertices), frozen(surface.faces), frozen(surface.trusted)
    return Annulus(mesh, vertices, faces, ordered, trusted, "; ".join(words))


def _offset(rim: Floats, pair: list[End]) -> float:
    """How much nearer a rim lies to the first end than to the second."""
    near = [float(np.linalg.norm(rim - end.centre, axis=1).mean()) for end in pair]
    return near[0] - near[1]


def _ends_in_words(words: str, pair: list[End], radii: list[float], opening: float | None) -> str:
    """How the ends were chosen, in a sentence."""
    positions = " and ".join(end.position for end in pair)
    if any(end.lip is not None for end in pair):
        words += ", the lip where one is hollow"
    if not radii:
        unused = "" if opening is None else ", no opening cut as both are open"
        return f"{words}, at {positions}{unused}"
    sizes = " and ".join(dict.fromkeys(f"{radius:.4g}" for radius in radii))
    return f"{words}, at {positions}, opened to radius {sizes}"
