"""Inspection of a mesh: its pieces, rims and faults, and how it would be wound."""

from __future__ import annotations

from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.units import ASSUMED, Unit
from meshwind.mesh.geometry.areas_and_volumes import loop_centroid, perimeter
from meshwind.mesh.geometry.mesh import Annulus, Mesh
from meshwind.mesh.geometry.topology import boundary, edges, euler, loops
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.read import MeshLike, load, read
from meshwind.mesh.opening.choose_ends import rims_by_number
from meshwind.mesh.opening.trim import annulus
from meshwind.mesh.repair.manifold import disagreements
from meshwind.mesh.repair.pieces import Pieces
from meshwind.mesh.repair.repair import chosen_piece, made_manifold
from meshwind.mesh.repair.weld import weld, without_collapsed, without_duplicates

_MAX_PIECES = 100
"""Number of pieces that are listed."""
_SAME_CENTRE = 1e-6
"""Largest distance between the centres of a rim before and after trimming, over the diagonal ..."""
_STRAIGHTENED = 0.1
"""... or over the length of the rim for that of a skin, which is cut straight where it is ragged."""

Point = tuple[float, float, float]


@dataclass(frozen=True)
class Piece:
    """A connected piece: its rank by area, 0 the largest, which `component` chooses it by."""

    number: int
    area: float
    faces: int
    closed: bool


@dataclass(frozen=True)
class Rim:
    """An open rim of the chosen piece, or of the skin that is wound of a part with a wall.

    number: what 'loops i j' names it by; place: its centre; length; vertices: their number.

    use: 'start', 'end', 'filled', or '' if the piece cannot be wound.
    """

    number: int
    place: Point
    length: float
    vertices: int
    use: str


@dataclass(frozen=True)
class Findings:
    """What a mesh is, and how it would be wound, as `check` finds it; lengths in the mesh's units.

    Attributes
    ----------
    name, format : str
        Name of the file and kind of it; "" for a mesh in memory.
    vertices, faces : int
        How many the file holds.
    size : tuple of three floats
        Extents along x, y and z of all that it holds.
    diagonal : float
        Diagonal of the same.
    crowded_edges, turned_edges : int
        Edges with more than two faces, and edges between two faces that face opposite ways.
    piece_count : int
        Number of connected pieces.
    pieces : tuple of Piece
        The 100 largest of them.
    component : int
        The chosen one, which what follows is about.
    one_sided, closed : bool
        Whether it has but one side, and no rim.
    genus : int or None
        Number of its handles, None if that is unknown.
    rims : tuple of Rim
        Its open rims, or those of its skin if it has a wall that can be wound.
    repairs : tuple of str
        What would be repaired, and what was noticed.
    ends : str
        How the ends are chosen, what is filled and how wide the openings are.
    annulus_vertices, annulus_faces : int
        Of the mesh that would be wound.
    rim_lengths : tuple of float
        Lengths of its two rims.
    wall : float
        Median thickness of a part's wall, 0 if it has none.
    side : str
        Skin that would be wound of a part with a wall, "" if it has none.
    notes : tuple of str
        What was decided in reading and opening it.
    problem : str
        Why it cannot be wound, "" if it can.
    units, units_from : str
        As in `Mesh`.
    warnings : tuple of str
        As in `Mesh`, and of the branches of the part.
    part_size : tuple of three floats
        Extents of the chosen piece.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.check("data/elbow.obj").problem
    ''
    """

    name: str
    format: str
    vertices: int
    faces: int
    size: Point
    diagonal: float
    crowded_edges: int
    turned_edges: int
    piece_count: int
    pieces: tuple[Piece, ...]
    component: int
    one_sided: bool = False
    closed: bool = False
    genus: int | None = None
    rims: tuple[Rim, ...] = ()
    repairs: tuple[str, ...] = ()
    ends: str = ""
    annulus_vertices: int = 0
    annulus_faces: int = 0
    rim_lengths: tuple[float, ...] = ()
    wall: float = 0.0
    side: str = ""
    notes: tuple[str, ...] = ()
    problem: str = ""
    units: str = ""
    units_from: str = ""
    warnings: tuple[str, ...] = ()
    part_size: Point = (0.0, 0.0, 0.0)

    __repr__ = brief


def check(
    mesh: MeshLike,
    *,
    component: int | None = None,
    ends: str | ArrayLike = "auto",
    opening: float | None = None,
    side: str = "outer",
    opening_by: str = "auto",
    units: str | None = None,
) -> Findings:
    """Look at a mesh: what it is, and how it would be wound; nothing is changed or written.

    Parameters
    ----------
    mesh : str, PathLike, Mesh, trimesh.Trimesh, pyvista.PolyData, meshio.Mesh or tuple of two arrays
        Mesh, or the path of its file; see `read` for those of other libraries.
    component : int, optional
        Piece of the mesh file to take, by decreasing area; 0 is the largest.  By default the largest.
    ends : str or array_like of float, shape (2, 3), default "auto"
        Where the ends are: "auto", "x", "y", "z", two points, also as "x,y,z x,y,z", or two open rims "loops 0 1";
        see `annulus`.
    opening : float, optional
        Radius of the opening at a closed end, in the mesh's units.  By default it follows from the part.
    side : {"outer", "inner"}, default "outer"
        Skin of a part with a wall that would be wound.
    opening_by : {"auto", "level", "plane"}, default "auto"
        How a closed end would be opened; see `annulus`.
    units : str, optional
        Unit of the mesh; nothing is converted.  By default that of the file, or "mm".

    Returns
    -------
    Findings
        Pieces, rims, faults and repairs, how it would be opened, and in `problem` why it cannot be wound.

    Raises
    ------
    BadInputError
        If there is no surface; any other reason why the mesh cannot be wound is in `problem`.

    See Also
    --------
    wind : Wind a part.

    Examples
    --------
    >>> import meshwind as mw
    >>> found = mw.check("data/tank.ply")
    >>> found.closed, found.problem, [round(length) for length in found.rim_lengths]
    (True, '', [153, 153])
    """
    mesh = mesh if isinstance(mesh, str | PathLike | Mesh) else read(mesh)
    if isinstance(mesh, Mesh):
        name, kind = mesh.name, ""
        held = FileMesh(mesh.vertices, mesh.faces, mesh.units, mesh.warnings, mesh.units_from, mesh.notes)
        unit = held.unit if units is None else Unit.of(units, Unit())
    else:
        name, kind, held = Path(mesh).name, Path(mesh).suffix[1:].upper(), load(mesh)
        unit = Unit.of(units, held.unit, ASSUMED)
    vertices, faces = held.vertices, held.faces
    pieces, notes = made_manifold(vertices, faces, name)
    used = vertices[np.unique(faces)]
    extent = np.ptp(used, axis=0)
    crowded, turned = _faults(used, np.unique(faces, return_inverse=True)[1].reshape(-1, 3))
    findings = Findings(
        name, kind, len(vertices), len(faces), _point(extent), float(np.linalg.norm(extent)), crowded, turned,
        len(pieces.areas), _listed(pieces),
        component or 0, repairs=tuple(notes), units=unit.name, units_from=unit.named_by,
        warnings=(*held.warnings, *filter(None, (unit.warning, unit.doubt(float(extent.max()))))), notes=held.notes,
    )  # fmt: skip
    try:
        chosen = pieces.chosen(component, name).faces
        findings = replace(findings, one_sided=disagreements(chosen) > 0, closed=len(boundary(chosen)) == 0)
        part = chosen_piece(pieces, notes, component, name, (len(vertices), len(faces)))
        findings = replace(
            findings, repairs=part.repairs, part_size=part.size, warnings=(*findings.warnings, *part.warnings)
        )
        findings = replace(findings, genus=_genus(part), rims=_rims(part, None))
        found = annulus(part, ends, opening, side, opening_by)
    except BadInputError as error:
        return replace(findings, problem=str(error))
    return replace(
        findings,
        rims=_rims(part, found),
        ends=found.ends,
        annulus_vertices=len(found.vertices),
        annulus_faces=len(found.faces),
        wall=0.0 if found.wall is None else found.wall.thickness,
        side="" if found.wall is None else found.wall.side,
        notes=(*held.notes, *found.notes),
        warnings=(*findings.warnings, *found.warnings),
        rim_lengths=tuple(perimeter(found.vertices, rim) for rim in found.rims),
    )


def _faults(vertices: Floats, faces: Ints) -> tuple[int, int]:
    """Edges with more than two faces, and edges whose two faces are turned opposite ways, before the repair."""
    welded = without_duplicates(without_collapsed(weld(vertices, faces)[1]))
    return int((edges(welded).count > 2).sum()), disagreements(welded)


def _listed(pieces: Pieces) -> tuple[Piece, ...]:
    """The largest pieces."""
    found = edges(pieces.faces)
    rim = (found.count[found.of_face] == 1).any(axis=1)
    count, rims = np.bincount(pieces.rank), np.bincount(pieces.rank, rim)
    return tuple(
        Piece(number, float(pieces.areas[number]), int(count[number]), not rims[number])
        for number in range(min(len(count), _MAX_PIECES))
    )


def _genus(part: Mesh) -> int:
    return (2 - len(loops(part.faces)) - euler(part.faces)) // 2


def _rims(part: Mesh, found: Annulus | None) -> tuple[Rim, ...]:
    wall = None if found is None else found.wall
    surface = part if wall is None else wall.skin
    ends = [] if found is None else [loop_centroid(found.vertices, rim) for rim in found.rims]
    rims = []
    for number, loop in enumerate(rims_by_number(surface.vertices, loops(surface.faces))):
        centre, length = loop_centroid(surface.vertices, loop), perimeter(surface.vertices, loop)
        near = _SAME_CENTRE * part.diagonal if wall is None else _STRAIGHTENED * length
        rims.append(Rim(number, _point(centre), length, len(loop), _use(centre, ends, near)))
    return tuple(rims)


def _use(centre: Floats, ends: list[Floats], near: float) -> str:
    """Use of the rim with this centre, from the centres of the rims of the annulus."""
    if not ends:
        return ""
    away = [float(np.linalg.norm(end - centre)) for end in ends]
    return ("start", "end")[int(np.argmin(away))] if min(away) < near else "filled"


def _point(values: Floats) -> Point:
    x, y, z = (float(value) for value in values)
    return x, y, z
