"""Repair of a triangle mesh, with notes on what was changed."""

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Ints, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import volume
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.mesh.geometry.topology import compact, patches
from meshwind.mesh.repair import cracks, manifold
from meshwind.mesh.repair.overlaps import overlaps
from meshwind.mesh.repair.pieces import Pieces
from meshwind.mesh.repair.slivers import without_slivers
from meshwind.mesh.repair.weld import weld, without_collapsed, without_duplicates
from meshwind.mesh.walls.handles import without_small_handles

_LEAST_EXTENT = 1e-8
"""Least extent over the distance from the origin: below it, coordinates have lost half of their digits."""


def mesh_from(vertices: ArrayLike, faces: ArrayLike, name: str = "mesh", component: int | None = None) -> Mesh:
    """Make a repaired mesh from vertices (n, 3), in any unit, and triangles (m, 3) of indices from 0.

    Vertices are welded, degenerate and repeated faces dropped, cracks closed, and the rest is made manifold and
    oriented outwards.  Of several pieces one is kept: `component` is its rank by area, 0 the largest,
    which None takes too, but with a warning if another one is large.  The result's
    `repairs` lists these changes, and faults that were found but not repaired.  Raises BadInputError if no surface is
    left.
    """
    pieces, notes = made_manifold(vertices, faces, name)
    return chosen_piece(pieces, notes, component, name, (len(np.asarray(vertices)), len(np.asarray(faces))))


def made_manifold(vertices: ArrayLike, faces: ArrayLike, name: str) -> tuple[Pieces, list[str]]:
    """First half of the repair, of all pieces together; also returns notes on what was changed."""
    points, triangles = _checked(vertices, faces, name)
    notes: list[str] = []
    size = len(points)
    points, triangles = _referenced(points, triangles)
    _note(notes, size - len(points), "dropped {} that no face uses", "vertex", "vertices")
    _check_size(points, name)
    size = len(points)
    points, triangles = weld(points, triangles)
    _note(notes, size - len(points), "welded {} that lay on another", "vertex", "vertices")
    triangles = _drop_useless(triangles, notes, name)
    points, triangles = _close_cracks(points, triangles, notes)
    points, triangles = _make_manifold(points, triangles, notes)
    return Pieces.of(points, triangles), notes


def chosen_piece(pieces: Pieces, notes: list[str], component: int | None, name: str, read: tuple[int, int]) -> Mesh:
    """Second half of the repair: the mesh of one piece; `read` counts the vertices and faces of the file."""
    chosen = pieces.chosen(component, name)
    triangles, notes = chosen.faces, [*notes, *chosen.notes]
    manifold.check_orientable(triangles, name)
    points, triangles = _referenced(*_remove_slivers(pieces.vertices, triangles, notes, name))
    if volume(points, triangles) < 0:
        triangles = triangles[:, ::-1]
        notes.append("turned all faces outward")
    points, triangles = _close_handles(points, triangles, notes)
    notes += overlaps(points, triangles)
    return Mesh(frozen(points), frozen(triangles), name, tuple(notes), *read, warnings=chosen.warnings)


def _checked(vertices: ArrayLike, faces: ArrayLike, name: str) -> tuple[Floats, Ints]:
    """Arrays of the right shape, with finite coordinates and valid indices."""
    raw = np.asarray(vertices, dtype=np.float64)
    bad = 0 if raw.ndim != 2 else int((~np.isfinite(raw)).any(axis=1).sum())
    if bad:
        count = f"{bad} of {len(raw)} vertices"
        raise BadInputError(f"{name}: {count} have NaN or infinite coordinates; remove them and export the mesh again")
    points = floats(raw, f"{name}: vertices", -1, 3)
    given = np.asarray(faces)
    if given.size == 0:
        raise BadInputError(f"{name}: holds no triangles; export the part's surface as a triangle mesh")
    indices = floats(given, f"{name}: faces", -1, 3)
    if (indices != np.floor(indices)).any() or indices.min() < 0 or indices.max() >= len(points):
        raise BadInputError(
            f"{name}: faces refer to vertices that do not exist; give indices from 0 to {len(points) - 1}"
        )
    return points, indices.astype(np.int64)


def _check_size(points: Floats, name: str) -> None:
    """Refuse coordinates whose squares and cubes overflow or underflow."""
    size = float(np.abs(points).max())
    if not np.ptp(points, axis=0).any():
        raise BadInputError(
            f"{name}: all its vertices are in one point; export it with more digits, or in a smaller unit"
        )
    if not 1e-50 < size < 1e50:
        raise BadInputError(f"{name}: coordinates up to {size:g} are out of range; scale the mesh to ordinary units")
    extent = float(np.ptp(points, axis=0).max())
    if 0 < extent < _LEAST_EXTENT * size:
        raise BadInputError(
            f"{name}: lies {size:.2g} from the origin, too far for its size of {extent:.2g}; move it there"
        )


def _referenced(points: Floats, faces: Ints) -> tuple[Floats, Ints]:
    """Drop unused vertices."""
    keep, renumber = compact(faces, len(points))
    return points[keep], renumber[faces]


def _note(notes: list[str], count: int, sentence: str, one: str = "face", many: str = "faces") -> None:
    """Add a note on a repair if the count is not 0."""
    if count:
        notes.append(sentence.format(f"{count} {one if count == 1 else many}"))


def _drop_useless(faces: Ints, notes: list[str], name: str) -> Ints:
    """Drop collapsed and duplicate faces."""
    whole = without_collapsed(faces)
    _note(notes, len(faces) - len(whole), "dropped {} collapsed to a line or point")
    single = without_duplicates(whole)
    _note(notes, len(whole) - len(single), "dropped {} that repeated another")
    if len(single) == 0:
        raise BadInputError(f"{name}: no face is left, all are collapsed; check the mesh's units and export it again")
    return single


def _close_cracks(vertices: Floats, faces: Ints, notes: list[str]) -> tuple[Floats, Ints]:
    """Join boundaries that face each other across a crack, and split edges at hanging vertices."""
    points, whole, count, widest = cracks.close_cracks(vertices, faces)
    _note(notes, count, f"closed cracks up to {widest:.2g} wide at {{}}", "vertex", "vertices")
    return points, whole


def _make_manifold(vertices: Floats, faces: Ints, notes: list[str]) -> tuple[Floats, Ints]:
    """Leave at most two faces at an edge and one fan at a vertex, consistently oriented."""
    calm = manifold.without_odd_faces(vertices, manifold.without_small_patches(vertices, faces))
    _note(notes, len(faces) - len(calm), "dropped {} at edges with more than two faces")
    turned = manifold.oriented(calm)
    _note(notes, _minority(calm, turned), "turned {} to agree with the neighbours")
    used = int(np.count_nonzero(np.bincount(turned.ravel())))
    points, split = manifold.separated(vertices, turned)
    _note(notes, len(points) - used, "split the surface at {} where parts of it touch", "vertex", "vertices")
    return points, split if len(points) == used else manifold.oriented(split)


def _minority(before: Ints, after: Ints) -> int:
    """Number of faces whose orientation relative to most of their patch was changed."""
    if np.array_equal(before, after):
        return 0
    turned = np.ones(len(before), dtype=bool)
    for shift in range(3):
        turned &= (np.roll(after, shift, axis=1) != before).any(axis=1)
    label = patches(after)
    size, flipped = np.bincount(label), np.bincount(label, turned)
    return int(np.minimum(flipped, size - flipped).sum())


def _close_handles(vertices: Floats, faces: Ints, notes: list[str]) -> tuple[Floats, Ints]:
    """Close the small handles that a scan leaves."""
    points, triangles, small = without_small_handles(vertices, faces)
    if small:
        widest = max(small, key=lambda handle: handle.girth)
        where = ", ".join(f"{x:.4g}" for x in widest.centre)
        noun = "handle" if len(small) == 1 else "handles"
        notes.append(f"closed {len(small)} small {noun}, up to {widest.girth:.3g} round, at ({where})")
    return points, triangles


def _remove_slivers(vertices: Floats, faces: Ints, notes: list[str], name: str) -> tuple[Floats, Ints]:
    """Remove faces without height, and what hangs on them by a vertex only."""
    diagonal = float(np.linalg.norm(np.ptp(_referenced(vertices, faces)[0], axis=0)))
    mended, count = without_slivers(vertices, faces, diagonal)
    _note(notes, count, "flipped or dropped {} without height", "face", "faces")
    if len(mended) == 0:
        raise BadInputError(f"{name}: no face is left, none has an area; export the part's surface as a triangle mesh")
    if len(mended) < len(faces):
        vertices, mended = manifold.separated(vertices, mended)
        left = mended[Pieces.of(vertices, mended).rank == 0]
        _note(notes, len(mended) - len(left), "dropped {} that hung on these")
        mended = left
    return vertices, mended
