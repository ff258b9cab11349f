"""Find handles, close the small ones that a scan leaves, and say where a large one is."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas, loop_centroid
from meshwind.mesh.geometry.fill_holes import fill_hole
from meshwind.mesh.geometry.topology import boundary, components, edges, euler, loops
from meshwind.mesh.walls.homology import Handles, Links, shortest
from meshwind.mesh.walls.skins import skins

SMALL = 0.05
"""Girth of a handle below which it is a fault, over the part's diagonal or the root of its area, whichever is less."""
_ROUNDS = 50
"""Most rounds of closing; each closes all small handles that lie clear of one another."""
_LOOKS = 8
"""Vertices from which the girth of a large handle is measured, spread over where every loop round it must pass."""


@dataclass(frozen=True)
class Handle:
    """A handle: the shortest loop round it that was found, as long as `girth`, about the point `centre` (3,)."""

    girth: float
    centre: Floats
    loop: Ints


def genus(faces: Ints) -> int:
    """Number of handles of a connected, oriented surface."""
    return (2 - len(loops(faces)) - euler(faces)) // 2


def large(vertices: Floats, faces: Ints) -> Handle | None:
    """The handle of least girth, nearly, of a connected surface with any."""
    handles = Handles.of(vertices, faces)
    sources = handles.sources()
    if handles.genus == 0 or len(sources) == 0:
        return None
    sources = sources[np.unique(np.linspace(0, len(sources) - 1, _LOOKS).astype(np.int64))]
    girth, rounds = shortest(Links.of(vertices, handles), sources, np.inf, False)
    best = int(np.argmin(girth))
    if not np.isfinite(girth[best]):
        return None
    return Handle(float(girth[best]), loop_centroid(vertices, rounds[best]), rounds[best])


def without_small_handles(vertices: Floats, faces: Ints) -> tuple[Floats, Ints, list[Handle]]:
    """Cut a connected mesh along short loops round handles and cap both sides; also gives the handles closed.

    A part with a wall is a handle itself, however slim it is: there, only those of each skin are closed.
    """
    if genus(faces) == 0:
        return vertices, faces, []
    found, side = skins(vertices, faces, hardly=True)
    if found is not None:
        return vertices, faces, []
    diagonal = float(np.linalg.norm(np.ptp(vertices[np.unique(faces)], axis=0)))
    limit = SMALL * min(diagonal, float(np.sqrt(areas(vertices, faces).sum())))
    label = np.zeros(len(faces), dtype=np.int64) if side is None else side
    done: list[Handle] = []
    for one in np.unique(label):
        for _ in range(_ROUNDS):
            small = _small(vertices, faces[label == one], limit)
            if not small:
                break
            vertices, faces, label = _cut(vertices, faces, label, small)
            done += small
    return vertices, faces, done


def _small(vertices: Floats, faces: Ints, limit: float) -> list[Handle]:
    """Short loops that have no vertex in common and that together leave the surface in one piece, shortest first."""
    handles = Handles.of(vertices, faces)
    if handles.genus == 0:
        return []
    links = Links.of(vertices, handles)
    girth, rounds = shortest(links, handles.sources(), limit, True)
    span = int(handles.found.ends.max()) + 1
    keys = handles.found.ends @ [span, 1]
    rim = np.zeros(len(vertices), dtype=bool)
    rim[boundary(faces)] = True
    taken, basis, chosen = set[int](), list[int](), list[Handle]()
    for k in np.argsort(girth, kind="stable"):
        loop = rounds[k]
        if not np.isfinite(girth[k]) or rim[loop].any() or not taken.isdisjoint(loop.tolist()):
            continue
        ends = np.sort(np.column_stack([loop, np.roll(loop, -1)]), axis=1)
        left = _reduced(int(np.bitwise_xor.reduce(handles.words[np.searchsorted(keys, ends @ [span, 1])])), basis)
        if left:
            basis.append(left)
            taken.update(loop.tolist())
            chosen.append(Handle(float(girth[k]), loop_centroid(vertices, loop), loop))
    return chosen


def _reduced(word: int, basis: list[int]) -> int:
    """What is left of a word after those of the basis, each of which has a highest bit of its own."""
    for other in sorted(basis, reverse=True):
        word = min(word, word ^ other)
    return word


def _cut(vertices: Floats, faces: Ints, label: Ints, small: list[Handle]) -> tuple[Floats, Ints, Ints]:
    """The mesh cut along disjoint loops, each side closed by a fan, and the labels (m,) with those of the fans."""
    found = edges(faces)
    span = int(faces.max()) + 1
    cut = np.concatenate([np.column_stack([each.loop, np.roll(each.loop, -1)]) for each in small])
    cut = np.sort(cut, axis=1) @ [span, 1]
    whole = (found.count == 2) & ~np.isin(found.ends @ [span, 1], cut)
    first, second = found.halves[whole].T
    after = lambda half: np.where(half % 3 == 2, half - 2, half + 1)  # noqa: E731
    # the corners at both ends of an edge that stays are those of its other face
    fans = components(3 * len(faces), np.concatenate([first, after(first)]), np.concatenate([after(second), second]))
    corner = np.empty(int(fans.max()) + 1, dtype=np.int64)
    corner[fans] = faces.ravel()
    # the first fan of each vertex keeps its number
    fresh = np.ones(len(corner), dtype=bool)
    fresh[np.unique(corner, return_index=True)[1]] = False
    number = corner.copy()
    number[fresh] = len(vertices) + np.arange(int(fresh.sum()))
    parted = number[fans].reshape(-1, 3)
    points = np.concatenate([vertices, vertices[corner[fresh]]])
    sides = {int(v) for each in small for v in each.loop} | set(number[fresh].tolist())
    of = np.zeros(len(points), dtype=np.int64)
    of[parted] = label[:, None]
    for rim in loops(parted):
        if sides.issuperset(rim.tolist()):
            points, parted = fill_hole(points, parted, rim)
            label = np.concatenate([label, np.full(len(parted) - len(label), of[rim[0]])])
    return points, parted, label
