"""Reading of a triangle mesh from a file: chooses the reader of its format, and turns errors into one line."""

from __future__ import annotations

import contextlib
import difflib
import io
import json
import struct
import zipfile
import zlib
from collections.abc import Callable
from dataclasses import replace
from importlib import import_module
from os import PathLike, fspath
from pathlib import Path
from typing import Any, TypeAlias
from xml.etree.ElementTree import ParseError

from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import need
from meshwind.core.units import Unit
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.mesh.io.cad import CAD
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.in_subprocess import DAMAGED, Arrays, in_subprocess
from meshwind.mesh.io.precision import resolved
from meshwind.mesh.repair.repair import mesh_from

MeshLike: TypeAlias = str | PathLike[str] | Mesh | Any
"""A mesh, the path of its file, or a mesh of another library as `read` takes it."""
_Reader = Callable[[Path], FileMesh]


def _separate(work: Callable[[Path], Arrays]) -> _Reader:
    """Reader that runs in a separate process, as it can end its own."""

    def read(path: Path) -> FileMesh:
        return FileMesh.unpacked(in_subprocess(work, path))

    return read


_READERS = {
    ".stl": "stl.stl:read_stl",
    ".ply": "ply.ply:read_ply",
    ".obj": "obj:read_obj",
    ".off": "off:read_off",
    ".glb": "gltf.gltf:read_gltf",
    ".gltf": "gltf.gltf:read_gltf",
    ".3mf": "threemf.threemf:read_3mf",
    ".vtk": "vtk.vtk:read_vtk",
    ".vtu": "vtk.vtk:read_vtk",
    ".vtp": "vtk.vtk:read_vtk",
    ".msh": "msh.msh:read_msh",
    ".inp": "deck.deck:read_deck",
    **dict.fromkeys(CAD, "cad:read_cad_mesh"),
}
"""Modules beside this one and their functions, imported when a file asks for them: a run needs one of many."""
_SEPARATE = {".vtk", ".vtu", ".vtp", *CAD}
"""Those that can end their process."""


def _reader_of(suffix: str) -> _Reader:
    """The reader of one of `SUFFIXES`."""
    module, name = _READERS[suffix].split(":")
    work = getattr(import_module(f"{__package__}.{module}"), name)
    reader: _Reader = _separate(work) if suffix in _SEPARATE else work
    return reader


_FROM_CAD = {
    ".brep", ".sldprt", ".sldasm", ".catpart", ".catproduct", ".cgr", ".ipt", ".iam", ".prt", ".asm", ".par", ".psm",
    ".x_t", ".x_b", ".xmt_txt", ".sat", ".sab", ".jt", ".3dm", ".fcstd", ".f3d", ".skp", ".dwg", ".dxf", ".ifc",
}  # fmt: skip
"""Endings of files of CAD programs that no free library reads well."""
_WAYS = {
    (
        ".vtm",
        ".vtmb",
        ".pvd",
        ".pvtu",
        ".pvtp",
        ".pvts",
        ".vthb",
        ".vtkhdf",
    ): "save one block or step as VTU or VTP, or as",
    (".vts", ".vtr", ".vti"): "save the part's surface as VTP, or as",
    (".e", ".exo", ".ex2", ".g", ".cgns", ".xdmf", ".xmf", ".case"): "save the mesh as VTU, by ParaView for one, or as",
}
"""Advice on other formats of meshes and results, before the formats that are read."""
_ADVICE = "give the path of a triangle mesh (STL, OBJ, PLY, ...)"
SUFFIXES = tuple(_READERS)
"""File name endings that `read` understands."""

_READER_ERRORS = (
    ValueError, LookupError, NameError, ArithmeticError, TypeError, AttributeError, AssertionError, NotImplementedError,
    RuntimeError, RuntimeWarning, EOFError, MemoryError, OSError, struct.error, zlib.error, zipfile.BadZipFile,
    json.JSONDecodeError, ParseError, SystemExit,
)  # fmt: skip
"""Exceptions that readers were seen to raise on files that are cut short, overwritten or of another format.

RuntimeWarning comes from a cast, if the caller turns warnings into errors.
"""


def read(mesh: str | PathLike[str] | Any, component: int | None = None, units: str | None = None) -> Mesh:
    """Read a triangle mesh from a file, or take it from another library, and repair it.

    STL, PLY, OBJ, OFF, GLB, GLTF, 3MF, VTK, VTU, VTP, MSH and INP files are read, and STEP and IGES files
    with the extra ``meshwind[cad]``.  Polygons are cut into triangles, and of a volume mesh the skin is taken.

    Parameters
    ----------
    mesh : str, PathLike, trimesh.Trimesh, pyvista.PolyData, meshio.Mesh, Mesh or tuple of two arrays
        File to read, or a mesh in memory: one of trimesh, PyVista or meshio, or its vertices (n, 3) and faces (m, 3).
    component : int, optional
        Which piece to keep, by its rank of area: 0 is the largest.  By default the largest, with a warning if another
        one is large.
    units : str, optional
        Unit of the mesh, see `wind`.  By default the one that the file names, if it names one.

    Returns
    -------
    Mesh
        Repaired mesh, in the unit of the file.

    Raises
    ------
    BadInputError
        If the file cannot be read, holds no surface, or has no such piece.

    Examples
    --------
    >>> import meshwind as mw
    >>> mesh = mw.read("data/elbow.obj")
    >>> mesh.repairs
    ()
    """
    if isinstance(mesh, Mesh):  # so that what any function takes can be read again
        held = FileMesh(mesh.vertices, mesh.faces, mesh.units, mesh.warnings, mesh.units_from, mesh.notes)
    else:
        held = load(mesh)
    name = Path(mesh).name if isinstance(mesh, str | PathLike) else mesh.name if isinstance(mesh, Mesh) else "mesh"
    unit = Unit.of(units, held.unit)
    repaired = mesh_from(held.vertices, held.faces, name, component)
    warnings = (*held.warnings, *filter(None, [unit.warning]), *repaired.warnings)
    return replace(repaired, units=unit.name, units_from=unit.named_by, warnings=warnings, notes=held.notes)


def load(mesh: str | PathLike[str] | Any) -> FileMesh:
    """The surface in a file or in memory without repair; it has at least a triangle.  Raises BadInputError."""
    if not isinstance(mesh, str | PathLike):
        from meshwind.mesh.io.in_memory import surface_in_memory  # late, as the readers are

        return resolved("mesh", surface_in_memory(mesh))
    file = path_of(mesh)
    reader = _reader(file)
    try:
        # what the libraries print is replaced by the one line below
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            held = reader(file)
    except BadInputError:
        _refuse_foreign(file)
        raise
    except _READER_ERRORS as error:
        _refuse_foreign(file)
        kind = file.suffix[1:].upper()
        raise BadInputError(
            f"{file.name}: cannot be read as {kind} ({_first_line(error)}); export the mesh again, or convert it to STL"
        ) from error
    if len(held.faces) == 0:
        _refuse_foreign(file)
        raise BadInputError(f"{file.name}: holds no triangles; export the part's surface as a triangle mesh")
    return resolved(file.name, held)


def check_file(mesh: object) -> None:
    """Raise BadInputError if a mesh is the path of a file that is missing, empty or of an unknown format."""
    if isinstance(mesh, str | PathLike):
        _reader(path_of(mesh))


def path_of(file: str | PathLike[str]) -> Path:
    """Path of a file, its ~ replaced by the user's home, unless there is a file of that very name."""
    if not fspath(file):
        raise BadInputError(f"the path of the mesh is empty; {_ADVICE}")
    path = Path(file)
    try:
        return path if path.exists() else path.expanduser()
    except (RuntimeError, OSError, ValueError):
        return path  # no such home; or a name that cannot be, which is said where it is opened


def _refuse_foreign(file: Path) -> None:
    """Say what a file that could not be read is, if its content tells that it is of another kind."""
    from meshwind.mesh.io.signature import foreign  # late: most files are what they seem

    try:
        words = foreign(file)
    except OSError:
        return  # the reader's own words say that it cannot be opened
    if words:
        raise BadInputError(f"{file.name}: {words}") from None


def _reader(file: Path) -> _Reader:
    """Reader for the file's suffix.  Raises BadInputError if the file is missing, empty or of an unknown format."""
    advice = _ADVICE
    try:
        if file.is_dir():
            empty = "" if file.parts else ", as is an empty path"
            raise BadInputError(f"{file.name or file}: is a folder{empty}; {advice}")
        if not file.exists():
            raise BadInputError(f"{file.name}: file not found; {_near(file) or advice}")
        if file.stat().st_size == 0:
            raise BadInputError(f"{file.name}: is empty; {advice}")
    except (OSError, ValueError) as error:
        if isinstance(error, BadInputError):
            raise
        raise BadInputError(f"{file.name}: cannot be opened ({_first_line(error)}); {advice}") from error
    if file.suffix.lower() in _FROM_CAD:
        raise BadInputError(f"{file.name}: is a file of a CAD program, not a mesh; export it there as STEP or STL")
    if file.suffix.lower() in CAD:
        need(f"{file.name}: ")
    if file.suffix.lower() not in SUFFIXES:
        _refuse_foreign(file)
        known = ", ".join(suffix[1:].upper() for suffix in SUFFIXES if suffix not in (".stp", ".igs"))
        way = next((way for endings, way in _WAYS.items() if file.suffix.lower() in endings), "convert the mesh to")
        raise BadInputError(f"{file.name}: unknown format {file.suffix!r}; {way} one of {known}")
    return _reader_of(file.suffix.lower())


def _near(file: Path) -> str:
    """Advice on a file that is missing: a mesh in the same folder with a similar name, if there is one."""
    if not file.parent.is_dir():
        return f"there is no folder {file.parent}"
    names = {other.name: other.name for other in file.parent.iterdir() if other.suffix.lower() in SUFFIXES}
    names |= {Path(name).stem: name for name in names}
    near = difflib.get_close_matches(file.name, names, 1, 0.7)
    return f"did you mean {names[near[0]]}?" if near else ""


def _first_line(error: BaseException) -> str:
    """First line of an error's message, shortened; a standard text if it has none."""
    lines = str(error).strip().splitlines()
    words = lines[0].strip() if lines else ""
    if isinstance(error, SystemExit | KeyError) or not words:
        words = DAMAGED
    return words if len(words) <= 100 else words[:97] + "..."
