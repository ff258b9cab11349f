"""The skin of a part with a wall that is to be wound, and the refusal of parts that have handles."""

from dataclasses import replace

from meshwind.core.cast import Ints, frozen
from meshwind.core.checks import check_word
from meshwind.core.defaults import SIDES
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.mesh.geometry.mesh import Mesh, Wall
from meshwind.mesh.geometry.topology import compact
from meshwind.mesh.opening.choose_ends import position_text
from meshwind.mesh.walls.handles import genus, large
from meshwind.mesh.walls.sides import INNER, OUTER
from meshwind.mesh.walls.skins import skins

_ADVERB = {"outer": "outside", "inner": "inside"}


def in_words(wall: Wall) -> str:
    """Which skin of a part with a wall is wound, in a sentence."""
    return (
        f"walled part: wound on its {_ADVERB[wall.side]} ({argument('side')}), the wall is {wall.thickness:.3g} thick "
        f"at the median; the rims between the skins, {100.0 * wall.left_out:.2g} % of the surface, are left out"
    )


def wall_of(mesh: Mesh, side: str) -> Wall | None:
    """The wall of a part with its skin of the given side; None for a part without a wall.

    Raises BadInputError where the part has handles, or no inner skin where that is wanted.
    """
    check_word(side, "side", SIDES)
    count = genus(mesh.faces)
    found, sides = skins(mesh.vertices, mesh.faces, hardly=count > 0 or side == "inner")
    if found is None:
        if count > 0:
            raise BadInputError(_handle(mesh, count, sides))
        if side == "inner":
            raise BadInputError(
                f"{mesh.name}: has no wall, and so no inner skin; side outer winds it as it is, and of two shells in "
                "one file component chooses the inner one"
            )
        return None
    inner = side == "inner"
    faces = found.faces(mesh.faces, inner)
    keep, renumber = compact(faces, len(mesh.vertices))
    skin = replace(mesh, vertices=frozen(mesh.vertices[keep]), faces=frozen(renumber[faces]))
    return Wall(side, found.thickness, found.left_out, skin, frozen(found.faces(mesh.faces, not inner)))


def _handle(mesh: Mesh, count: int, sides: Ints | None) -> str:
    """Why a part with handles cannot be wound, and where the thinnest is."""
    where, faces = "", mesh.faces
    if sides is not None:
        of = {label: mesh.faces[sides == label] for label in (OUTER, INNER)}
        on = next((label for label in of if genus(of[label]) > 0), None)
        if on is not None:
            where, faces = f" on its {'outer' if on == OUTER else 'inner'} skin", of[on]
    handle = large(mesh.vertices, faces)
    size = "" if handle is None else (
        f": {handle.girth:.3g} round at {position_text(handle.centre, mesh.diagonal)}{where}"
    )  # fmt: skip
    return (
        f"{mesh.name}: genus {count} (a handle or a hole right through){size}: meshwind winds parts like a tube or a"
        " closed blob; cut the part open or fill the hole"
    )
