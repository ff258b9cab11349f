"""Trim a mesh to an annulus: refuse what has no two ends, fill what is no end, open the poles."""

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.geometry.mesh import Annulus, Mesh
from meshwind.mesh.geometry.topology import euler, loops, patches
from meshwind.mesh.opening.chords import without_chords
from meshwind.mesh.opening.ends import End, Wish, choose, numbered, parse
from meshwind.mesh.opening.holes import filled, is_defect
from meshwind.mesh.opening.opening import pinched
from meshwind.mesh.opening.radius import with_openings
from meshwind.mesh.opening.skin import Skin, skin

_FLAT = 1e-6  # volume over area^(3/2): 0.094 for a ball, 6e-3 for a rod a thousand times as long as thick


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
    wish = parse(ends)
    _check_opening(opening)
    rims = numbered(mesh.vertices, loops(mesh.faces))
    _check_part(mesh, rims)
    wanted = _wanted(rims, wish, mesh.name)
    vertices, faces, kept, notes = _without_defects(mesh, rims, wanted)
    pair, words = choose(vertices, faces, wanted or kept, wish)
    chosen = {int(end.loop[0]) for end in pair if end.loop is not None}
    spare = [loop for loop in kept if int(loop[0]) not in chosen]
    if spare:
        notes.append(f"filled {len(spare)} other open {'rim' if len(spare) == 1 else 'rims'}")
    for loop in spare:
        vertices, faces = filled(vertices, faces, loop)
    trusted = np.arange(len(vertices)) < len(mesh.vertices)
    surface = skin(vertices, faces, trusted)
    surface, radii = with_openings(surface, pair, opening, mesh.name)
    return _assembled(mesh, without_chords(surface), pair, [_told(words, pair, radii, opening), *notes])


def _check_opening(opening: float | None) -> None:
    good = isinstance(opening, int | float | np.number) and not isinstance(opening, bool)
    if opening is not None and not (good and np.isfinite(opening) and opening > 0):
        raise BadInputError(f"opening {opening}: give the radius of the hole at a pole, a number above 0")


def _check_part(mesh: Mesh, rims: list[Ints]) -> None:
    """Refuse a surface that has no inside or that has handles."""
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


def _wanted(rims: list[Ints], wish: Wish, name: str) -> list[Ints]:
    """The two loops that the wish names by number, none where it names none."""
    if wish.loops is None:
        return []
    if max(wish.loops) >= len(rims):
        there = {0: "no open rims", 1: "1 open rim"}.get(len(rims), f"{len(rims)} open rims, 0 to {len(rims) - 1}")
        raise BadInputError(f"{name}: ends {wish.text!r}: the part has {there}; `meshwind check` lists them")
    return [rims[k] for k in wish.loops]


def _without_defects(mesh: Mesh, rims: list[Ints], wanted: list[Ints]) -> tuple[Floats, Ints, list[Ints], list[str]]:
    """Fill loops that are faults of the mesh; gives vertices, faces, the other loops and notes."""
    vertices, faces = mesh.vertices, mesh.faces
    spared = {int(loop[0]) for loop in wanted}
    defects = [int(loop[0]) not in spared and is_defect(vertices, faces, loop) for loop in rims]
    for loop in [loop for loop, defect in zip(rims, defects, strict=True) if defect]:
        vertices, faces = filled(vertices, faces, loop)
    count = sum(defects)
    notes = [f"filled {count} {'hole' if count == 1 else 'holes'} of missing faces or open seams"] if count else []
    return vertices, faces, [loop for loop, defect in zip(rims, defects, strict=True) if not defect], notes


def _assembled(mesh: Mesh, surface: Skin, pair: list[End], words: list[str]) -> Annulus:
    """The annulus, once it is proved to be one."""
    rims = [] if pinched(surface.faces) else loops(surface.faces)
    if len(rims) != 2 or euler(surface.faces) != 0 or patches(surface.faces).any():
        raise BadInputError(
            f"{mesh.name}: trimming left {len(rims)} rims where a tube has 2; choose other ends or a smaller opening"
        )
    if not areas(surface.vertices, surface.faces).min() > 0:
        raise BadInputError(f"{mesh.name}: trimming left a face without area; remesh the part or choose other ends")
    start = int(np.argmin([_offset(surface.vertices[rim], pair) for rim in rims]))
    first, second = rims[start], rims[1 - start]
    # The faces' own sense has the surface on its left: growing u at the start, falling u at the end.
    ordered = frozen(first), frozen(np.roll(second[::-1], 1))
    vertices, faces, trusted = frozen(surface.vertices), frozen(surface.faces), frozen(surface.trusted)
    return Annulus(mesh, vertices, faces, ordered, trusted, "; ".join(words))


def _offset(rim: Floats, pair: list[End]) -> float:
    """How much nearer a rim lies to the first end than to the second."""
    near = [float(np.linalg.norm(rim - end.centre, axis=1).mean()) for end in pair]
    return near[0] - near[1]


def _told(words: str, pair: list[End], radii: list[float], opening: float | None) -> str:
    """How the ends were chosen, in a sentence."""
    places = " and ".join(end.place for end in pair)
    if any(end.lip is not None for end in pair):
        words += ", the lip where one is hollow"
    if not radii:
        unused = "" if opening is None else ", no opening cut as both are open"
        return f"{words}, at {places}{unused}"
    sizes = " and ".join(dict.fromkeys(f"{radius:.4g}" for radius in radii))
    return f"{words}, at {places}, opened to radius {sizes}"
