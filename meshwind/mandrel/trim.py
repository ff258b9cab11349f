"""Trim a mesh to an annulus: refuse what has no two ends, fill what is no end, open the poles."""

import numpy as np

from meshwind.cast import Floats, Ints, frozen
from meshwind.errors import BadInputError
from meshwind.mandrel.annulus import Annulus
from meshwind.mandrel.ends import End, choose, parse
from meshwind.mandrel.holes import filled, is_defect
from meshwind.mandrel.measure import areas, edge_lengths, volume
from meshwind.mandrel.mesh import Mesh
from meshwind.mandrel.opening import opened, without_lining
from meshwind.mandrel.skin import Skin, skin
from meshwind.mandrel.topology import euler, loops, patches

_FLAT = 1e-6  # volume over area^(3/2): 0.094 for a ball, 6e-3 for a rod a thousand times as long as thick
_SHARE = 1.0 / 3.0  # of the area, the most that an opening may take
_DEFAULT, _LEAST, _WIDEST_BY_EDGES = 0.4, 0.02, 0.5  # radius of an opening over the mean radius of the part
_EDGES = 3.0  # that a default opening spans at least, by the faces' shortest ones: long ones tell nothing


def annulus(mesh: Mesh, ends: str = "auto", opening: float | None = None) -> Annulus:
    """Choose the two ends of a repaired mesh and trim it to them.

    ends: 'auto', a model axis 'x', 'y' or 'z', or two points 'x,y,z x,y,z' in the mesh's units.  opening: the
    radius of the hole cut about each pole, in the mesh's units; by default 0.4 of the part's mean
    radius.  Open rims are ends as they are.

    With 'auto' the ends are the two largest open rims, the longer one first; where there is but one, it comes
    first and the pole across it second; a closed part gets poles on its axis, the fuller end of the part
    first.  With an axis the start is the end with the lower coordinate, with points the first one.  An end
    that is hollow like a cup is cut at its lip, and its lining dropped.

    Raises BadInputError where the part is no tube and no blob, where an end cannot be opened, or where `ends`
    or `opening` cannot be used.
    """
    wish = parse(ends)
    _check_opening(opening)
    rims = loops(mesh.faces)
    _check_part(mesh, rims)
    vertices, faces, kept, notes = _without_defects(mesh, rims)
    pair, words = choose(vertices, faces, kept, wish)
    chosen = {int(end.loop[0]) for end in pair if end.loop is not None}
    spare = [loop for loop in kept if int(loop[0]) not in chosen]
    if spare:
        notes.append(f"filled {len(spare)} other open {'rim' if len(spare) == 1 else 'rims'}")
    for loop in spare:
        vertices, faces = filled(vertices, faces, loop)
    trusted = np.arange(len(vertices)) < len(mesh.vertices)
    surface = skin(vertices, faces, trusted)
    surface, radii = _with_openings(surface, pair, opening, mesh.name)
    return _assembled(mesh, surface, pair, [_told(words, pair, radii, opening), *notes])


def _check_opening(opening: float | None) -> None:
    if opening is not None and not (np.isfinite(opening) and opening > 0):
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


def _without_defects(mesh: Mesh, rims: list[Ints]) -> tuple[Floats, Ints, list[Ints], list[str]]:
    """Fill loops that are faults of the mesh; gives vertices, faces, the other loops and notes."""
    vertices, faces = mesh.vertices, mesh.faces
    defects = [is_defect(mesh.vertices, mesh.faces, loop) for loop in rims]
    for loop, defect in zip(rims, defects, strict=True):
        if defect:
            vertices, faces = filled(vertices, faces, loop)
    count = sum(defects)
    notes = [f"filled {count} {'hole' if count == 1 else 'holes'} of missing faces or open seams"] if count else []
    return vertices, faces, [loop for loop, defect in zip(rims, defects, strict=True) if not defect], notes


def _with_openings(surface: Skin, pair: list[End], wanted: float | None, name: str) -> tuple[Skin, list[float]]:
    """Cut at each lip and open each pole; also gives the radii."""
    for end in pair:
        if end.lip is not None:
            surface = without_lining(surface, end.lip)
    area = float(areas(surface.vertices, surface.faces).sum())
    direction = pair[1].centre - pair[0].centre
    gap = float(np.linalg.norm(direction))
    if gap < 1e-6 * float(np.linalg.norm(np.ptp(surface.vertices, axis=0))):
        raise BadInputError(f"{name}: both ends fall on one place, {_point(pair[0].centre)}; give ends further apart")
    mean_radius = area / (2.0 * np.pi * float(np.ptp(surface.vertices @ (direction / gap))))
    edge = float(np.median(edge_lengths(surface.vertices, surface.faces).min(axis=1)))
    radii = []
    for end in pair:
        if end.loop is None and end.lip is None:
            usual = max(_DEFAULT * mean_radius, min(_EDGES * edge, _WIDEST_BY_EDGES * mean_radius))
            radius, least = wanted or usual, _LEAST * mean_radius
            surface, radius = _open(surface, end.centre, radius, least, _SHARE * area, wanted is None, name)
            radii.append(radius)
    return surface, radii


def _open(
    surface: Skin, pole: Floats, radius: float, least: float, most: float, may_shrink: bool, name: str
) -> tuple[Skin, float]:
    """Cut one opening; a radius that the user did not give shrinks until it fits."""
    result = opened(surface, pole, radius, most) if radius >= least else None
    while result is None and may_shrink and radius * 0.8 >= least:
        radius *= 0.8
        result = opened(surface, pole, radius, most)
    if result is not None:
        return result, radius
    largest = _largest(surface, pole, least, radius, most)
    if largest is None:
        raise BadInputError(f"{name}: no opening fits at {_point(pole)}; choose other ends: x, y, z or two points")
    size = "small" if radius < least else "large"
    allowed = f"give a radius between {least:.3g} and {largest:.3g}"
    raise BadInputError(f"{name}: opening {radius:g} is too {size} at {_point(pole)}; {allowed}")


def _largest(surface: Skin, pole: Floats, least: float, bad: float, most: float) -> float | None:
    """Largest opening that fits, to 2 percent below, or None where the least one does not."""
    size = float(np.linalg.norm(np.ptp(surface.vertices, axis=0)))
    good, bad = least, max(min(bad, size), 2.0 * least) if bad > least else size
    if opened(surface, pole, good, most) is None:
        return None
    while bad > 1.02 * good:
        middle = float(np.sqrt(good * bad))
        good, bad = (good, middle) if opened(surface, pole, middle, most) is None else (middle, bad)
    return good


def _assembled(mesh: Mesh, surface: Skin, pair: list[End], words: list[str]) -> Annulus:
    """The annulus, once it is proved to be one."""
    rims = loops(surface.faces)
    if len(rims) != 2 or euler(surface.faces) != 0 or patches(surface.faces).any():
        raise BadInputError(
            f"{mesh.name}: trimming left {len(rims)} rims where a tube has 2; choose other ends or a smaller opening"
        )
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
    places = " and ".join(_point(end.centre) for end in pair)
    if any(end.lip is not None for end in pair):
        words += ", the lip where one is hollow"
    if not radii:
        unused = "" if opening is None else ", no opening cut as both are open"
        return f"{words}, at {places}{unused}"
    sizes = " and ".join(dict.fromkeys(f"{radius:.4g}" for radius in radii))
    return f"{words}, at {places}, opened to radius {sizes}"


def _point(point: Floats) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point + 0.0) + ")"
