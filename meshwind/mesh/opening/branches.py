"""Branches of a part beside its two ends, open or closed, and wide holes in it that are filled."""

from dataclasses import dataclass

import numpy as np
from scipy.sparse.csgraph import dijkstra
from scipy.spatial import KDTree

from meshwind.core.cast import Floats, Ints
from meshwind.core.spoken import argument, called
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_centroid, perimeter
from meshwind.mesh.geometry.edge_graph import edge_graph
from meshwind.mesh.geometry.mesh import Annulus
from meshwind.mesh.opening.choose_ends import position_text
from meshwind.mesh.opening.legs import Leg, legs

_WIDE = 0.4
"""Length of a rim over that of the shorter end's from which on it may be meant for an end, or a branch's, and girth of
a closed leg over that of the part.  Nozzles and holes for bolts are less: 0.24 for a branch pipe of a quarter of the
diameter."""
_REACH = 2.0
"""Radii of the rim within which the surface tells a leg from a hole."""
_LEG = 1.4
"""Area within that reach over that of a cylinder below which a rim is the end of a leg; 2 for a hole in a plane."""
_MOSTLY = 0.5
"""Share of a rim's points above which it is on a leg."""

BRANCHES = "the part branches"
"""How the warning of a branch begins."""
CUT = (
    "cut each leg off just beside where it branches and wind it as a part of its own, and the rest with the hole that "
    "this leaves closed"
)
"""What helps: the hole of a cut, left open, is an end of the rest where the part has no other open rims."""


@dataclass(frozen=True)
class WideRim:
    """An open rim beside the ends that is wide enough to be one: its points (n, 3), its length, its centre (3,).

    tube: whether the surface goes on from it as from the end of a tube.
    """

    points: Floats
    length: float
    centre: Floats
    tube: bool


@dataclass(frozen=True)
class OpenRims:
    """Wide open rims of a part that are not its ends, before they are filled.

    shorter: length of the shorter of the ends that are open rims, infinite if none is; by_number: whether the ends
    were chosen by the numbers of their rims.
    """

    wide: tuple[WideRim, ...]
    shorter: float
    by_number: bool

    @staticmethod
    def of(vertices: Floats, faces: Ints, spare: list[Ints], ends: list[Ints], by_number: bool) -> "OpenRims":
        """Find the wide ones among the loops that are to be filled; `ends` are those that are kept."""
        shorter = min((perimeter(vertices, loop) for loop in ends), default=np.inf)
        loops = [loop for loop in spare if perimeter(vertices, loop) >= _WIDE * shorter]
        tubes = _on_tubes(vertices, faces, loops)
        wide = tuple(
            WideRim(vertices[loop], perimeter(vertices, loop), loop_centroid(vertices, loop), tube)
            for loop, tube in zip(loops, tubes, strict=True)
        )
        return OpenRims(wide, shorter, by_number)


@dataclass(frozen=True)
class _Place:
    """Where a leg ends or a hole is, and how long round."""

    centre: Floats
    length: float


def branch_warnings(opened: Annulus, rims: OpenRims) -> tuple[str, ...]:
    """What to know of the legs of a part that is opened at its ends, and of its wide rims that are filled, in words."""
    found, mean = legs(opened)
    wide = [leg for leg in found if leg.girth >= _WIDE * min(rims.shorter, mean)]
    held = [[_holds(leg, opened, rim) for rim in rims.wide] for leg in wide]
    ends, holes = list[_Place](), list[_Place]()
    for rim, of_legs in zip(rims.wide, np.array(held, dtype=bool).reshape(len(wide), len(rims.wide)).T, strict=True):
        (ends if rim.tube or of_legs.any() else holes).append(_Place(rim.centre, rim.length))
    tips = [_Place(leg.tip, leg.girth) for leg, at in zip(wide, held, strict=True) if not any(at)]
    diagonal = float(np.linalg.norm(np.ptp(opened.vertices, axis=0)))
    by_number = "'loops i j'"
    words, loops = [], f"{argument('ends', by_number)}, which {called('check')} lists"
    if ends or tips:
        choice = argument("ends", "'x,y,z x,y,z'") if tips else loops
        others = "" if rims.by_number else f", or choose other ends with {choice}"
        words.append(
            f"{BRANCHES}: it has {_count(len(ends + tips), 'more wide end')}, {_longest(ends + tips, diagonal)}, which "
            f"{_is(ends + tips)} closed, and fibres run over the branch; {CUT}{others}"
        )
    if holes:
        others = "" if rims.by_number else f"; if it is to be an end, choose it with {loops}"
        words.append(
            f"{_count(len(holes), 'open rim')} nearly as wide as the ends, {_longest(holes, diagonal)}, "
            f"{_is(holes)} filled, and fibres cross the hole{others}"
        )
    return tuple(words)


def _count(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _is(places: list[_Place]) -> str:
    return "is" if len(places) == 1 else "are"


def _longest(places: list[_Place], diagonal: float) -> str:
    """Length and place of the longest one."""
    longest = max(places, key=lambda place: place.length)
    where = position_text(longest.centre, diagonal)
    return f"{'' if len(places) == 1 else 'the longest '}{longest.length:.3g} round at {where}"


def _holds(leg: Leg, opened: Annulus, rim: WideRim) -> bool:
    """Whether a rim that was filled is that of a leg."""
    away, _ = KDTree(opened.vertices[leg.vertices]).query(rim.points)
    return bool((away == 0.0).mean() > _MOSTLY)


def _on_tubes(vertices: Floats, faces: Ints, loops: list[Ints]) -> list[bool]:
    """Whether the surface beside each rim goes on as a tube: if so it has a cylinder's area, and more if it spreads."""
    if not loops:
        return []
    graph, area = edge_graph(vertices, faces), areas(vertices, faces)
    found = []
    for loop in loops:
        length = perimeter(vertices, loop)
        reach = _REACH * length / (2.0 * np.pi)
        away = dijkstra(graph, indices=loop, min_only=True, limit=2.0 * reach)
        near = away[faces].mean(axis=1) <= reach
        found.append(float(area[near].sum()) < _LEG * reach * length)
    return found
