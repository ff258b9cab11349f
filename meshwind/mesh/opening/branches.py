"""Wide open rims beside the two ends: branches of a part, or holes in it, that are filled."""

import numpy as np
from scipy import sparse
from scipy.sparse.csgraph import dijkstra

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_centroid, perimeter
from meshwind.mesh.geometry.topology import edges
from meshwind.mesh.opening.choose_ends import position_text

_WIDE = 0.4
"""Length of a rim over that of the shorter end's from which on it may be meant for an end, or a branch's.  Nozzles and
holes for bolts are less: 0.24 for a branch pipe of a quarter of the diameter."""
_REACH = 2.0
"""Radii of the rim within which the surface tells a leg from a hole."""
_LEG = 1.4
"""Area within that reach over that of a cylinder below which a rim is the end of a leg; 2 for a hole in a plane."""

BRANCHES = "the part branches"
"""How the warning of a branch begins."""


def branch_warnings(vertices: Floats, faces: Ints, spare: list[Ints], ends: list[Ints]) -> tuple[str, ...]:
    """What to know of wide rims among those that are filled, in words; `ends` are the rims that are kept."""
    shorter = min((perimeter(vertices, loop) for loop in ends), default=np.inf)
    wide = [loop for loop in spare if perimeter(vertices, loop) >= _WIDE * shorter]
    legs = [loop for loop in wide if _is_leg(vertices, faces, loop)]
    holes = [loop for loop in wide if not any(loop is leg for leg in legs)]
    words = []
    if legs:
        words.append(
            f"{BRANCHES}: it has {_count(len(legs), 'more wide end')}, {_place(vertices, legs)}, which "
            f"{'is' if len(legs) == 1 else 'are'} closed, and fibres run over the branch; cut it where it branches and "
            "wind each leg as a part of its own, or choose its two ends with --ends 'loops i j'"
        )
    if holes:
        words.append(
            f"{_count(len(holes), 'open rim')} nearly as wide as the ends, {_place(vertices, holes)}, "
            f"{'is' if len(holes) == 1 else 'are'} filled, and fibres cross the hole; choose other ends with "
            "--ends 'loops i j' if it is to be one"
        )
    return tuple(words)


def _count(count: int, noun: str) -> str:
    return f"{count} {noun}{'' if count == 1 else 's'}"


def _place(vertices: Floats, rims: list[Ints]) -> str:
    """Length and place of the longest rim."""
    longest = max(rims, key=lambda loop: perimeter(vertices, loop))
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    where = position_text(loop_centroid(vertices, longest), diagonal)
    return f"{'' if len(rims) == 1 else 'the longest '}{perimeter(vertices, longest):.3g} round at {where}"


def _is_leg(vertices: Floats, faces: Ints, loop: Ints) -> bool:
    """Whether the surface beside a rim goes on as a tube: if so it has a cylinder's area, and more if it spreads."""
    length = perimeter(vertices, loop)
    reach = _REACH * length / (2.0 * np.pi)
    ends = edges(faces).ends
    step = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    graph = sparse.csr_array((step, (ends[:, 0], ends[:, 1])), shape=(len(vertices), len(vertices)))
    away = dijkstra(graph, directed=False, indices=loop, min_only=True, limit=2.0 * reach)
    near = away[faces].mean(axis=1) <= reach
    return float(areas(vertices, faces)[near].sum()) < _LEG * reach * length
