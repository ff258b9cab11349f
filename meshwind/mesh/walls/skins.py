"""Split a part with a wall into its outer and its inner skin."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_area_vector, perimeter, volume
from meshwind.mesh.geometry.topology import boundary, euler, loops
from meshwind.mesh.walls.face_graph import FaceGraph
from meshwind.mesh.walls.rims import across, without_rims
from meshwind.mesh.walls.sides import INNER, OUTER, RIM, hollow, sides
from meshwind.mesh.walls.sight import Sight

_ACROSS, _BORED = 0.5, 0.8
"""Share of the surface that must have the other skin across the wall, or of the inside alone where that is looked for
closely: wide flanges have nothing across, and a bore with a thick wall is little of the surface."""
_SLENDER = 2.0
"""Length of a skin from rim to rim over the wall's thickness, at least: a torus of round wire has 1.3 and 1.8."""
_DEEP = 0.5
"""Area of the one opening over that of the skin inside, at most: that of half a ball; flatter dishes have no inside."""
_ROUNDS = 10
"""Most rounds in which touching rims are parted."""


@dataclass(frozen=True)
class Skins:
    """A part with a wall: label (m,) of each face, OUTER, RIM or INNER, and the wall's median thickness.

    Each skin is one surface without handles, with one rim or more.  left_out: share of the surface that is RIM.
    """

    label: Ints
    thickness: float
    left_out: float

    def faces(self, faces: Ints, inner: bool) -> Ints:
        """The faces (k, 3) of one skin, oriented away from the part's axis, as those of a mandrel."""
        return faces[self.label == INNER][:, ::-1] if inner else faces[self.label == OUTER]


def skins(vertices: Floats, faces: Ints, hardly: bool = False) -> tuple[Skins | None, Ints | None]:
    """The skins of a part that has a wall; None where it has none, or they cannot be told apart.

    Also gives the side (m,) of each face, OUTER or INNER, where the part is hollow at all.
    hardly: look closely where little of the surface is inside, too.
    """
    sight, area = Sight.of(vertices, faces), areas(vertices, faces)
    if not hollow(sight, area, hardly):
        return None, None
    graph = FaceGraph.of(vertices, faces)
    side = sides(sight, graph)
    if (side == OUTER).all() or (side == INNER).all():
        return None, None
    found, thickness = across(sight, side, vertices[faces])
    inside = side == INNER
    bored = hardly and area[found & inside].sum() > _BORED * area[inside].sum()
    if not bored and area[found].sum() < _ACROSS * area.sum():
        return None, None
    label = _mended(faces, graph, without_rims(sight, graph, side, found))
    outer, inner = faces[label == OUTER], faces[label == INNER]
    if not (len(outer) and len(inner) and _turned_apart(vertices, outer, inner)):
        return None, None
    if not all(_long(vertices, skin, area[label == one], thickness)
               for one, skin in ((OUTER, outer), (INNER, inner))):  # fmt: skip
        return None, None
    if not _is_deep(vertices, inner, float(area[label == INNER].sum())):
        return None, None
    plain = all(_pieces_of_a_ball(skin) for skin in (outer, inner))
    left_out = float(area[label == RIM].sum() / area.sum())
    return (Skins(label, thickness, left_out) if plain else None), side


def _mended(faces: Ints, graph: FaceGraph, label: Ints) -> Ints:
    """The labels (m,) with each skin free of vertices where its rims touch: their faces go to the rim."""
    label = label.copy()
    for one in (OUTER, INNER):
        for _ in range(_ROUNDS):
            tails = boundary(faces[label == one])[:, 0]
            touching = np.flatnonzero(np.bincount(tails, minlength=1) > 1)
            if len(touching) == 0:
                break
            label[(label == one) & np.isin(faces, touching).any(axis=1)] = RIM
            mask = label == one
            label[mask & ~graph.largest(mask)] = RIM
    return label


def _turned_apart(vertices: Floats, outer: Ints, inner: Ints) -> bool:
    """Whether the outer skin faces out of what it encloses, and the inner one into what it does, which is less."""
    without, within = volume(vertices, outer), volume(vertices, inner)
    return 0.0 < -within < without


def _long(vertices: Floats, skin: Ints, area: Floats, thickness: float) -> bool:
    """Whether a skin has rims, and is long from rim to rim for the thickness of the wall."""
    rims = loops(skin)
    if not rims or thickness <= 0.0:
        return False
    return float(area.sum()) > _SLENDER * thickness * float(np.mean([perimeter(vertices, rim) for rim in rims]))


def _is_deep(vertices: Floats, inner: Ints, area: float) -> bool:
    """Whether the inner skin is no flat dish, if it has but one rim."""
    rims = loops(inner)
    return len(rims) > 1 or float(np.linalg.norm(loop_area_vector(vertices, rims[0]))) < _DEEP * area


def _pieces_of_a_ball(skin: Ints) -> bool:
    """Whether a connected surface has no handles."""
    return euler(skin) == 2 - len(loops(skin))
