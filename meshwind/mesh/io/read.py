"""Read a triangle mesh from a file, whatever its format."""

import contextlib
import difflib
import io
import json
import struct
import zipfile
import zlib
from collections.abc import Callable
from os import PathLike
from pathlib import Path
from xml.etree.ElementTree import ParseError

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.mesh.io import formats, threemf
from meshwind.mesh.io.isolated import DAMAGED, Arrays, isolated
from meshwind.mesh.repair.repair import mesh_from

_Read = Callable[[Path], tuple[Floats, Ints]]


def _apart(work: Callable[[Path], Arrays]) -> _Read:
    def read(path: Path) -> tuple[Floats, Ints]:
        held = isolated(work, path)
        return held["vertices"], held["faces"]

    return read


_READERS: dict[str, _Read] = {
    ".stl": formats.by_trimesh,
    ".ply": formats.by_trimesh,
    ".obj": formats.by_trimesh,
    ".off": formats.by_trimesh,
    ".glb": formats.by_trimesh,
    ".gltf": formats.by_trimesh,
    ".3mf": threemf.read,
    ".vtk": _apart(formats.by_vtk),
    ".vtu": _apart(formats.by_vtk),
    ".vtp": _apart(formats.by_vtk),
    ".msh": _apart(formats.by_meshio),
    ".inp": _apart(formats.by_meshio),
}
SUFFIXES = tuple(_READERS)
"""File name endings that `read` understands."""

# What trimesh was seen to raise on cut, overwritten and foreign files; RuntimeWarning
# comes from a cast where the caller turns warnings into errors.
_GARBAGE = (
    ValueError, LookupError, NameError, ArithmeticError, TypeError, AttributeError, AssertionError, NotImplementedError,
    RuntimeError, RuntimeWarning, EOFError, MemoryError, OSError, struct.error, zlib.error, zipfile.BadZipFile,
    json.JSONDecodeError, ParseError, SystemExit,
)  # fmt: skip


def read(path: str | PathLike[str], component: int = 0) -> Mesh:
    """Read a triangle mesh from a file and repair it.

    STL, PLY, OBJ, OFF, GLB, GLTF, 3MF, VTK, VTU, VTP, MSH and INP files are read.  Polygons are cut into triangles,
    and of a volume mesh the skin is taken.

    Parameters
    ----------
    path : str or PathLike
        File to read.
    component : int, default 0
        Which piece to keep, by its rank of area: 0 is the largest.

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
    return mesh_from(*load(path), Path(path).name, component)


def load(path: str | PathLike[str]) -> tuple[Floats, Ints]:
    """Vertices (n, 3) and triangles (m, 3) of a file as they are; m is never 0.  Raises BadInputError."""
    if not isinstance(path, str | PathLike):
        raise BadInputError(f"mesh is {_type(path)}: give the path of a triangle mesh (STL, OBJ, PLY, ...)")
    file = Path(path)
    reader = _reader(file)
    try:
        # The libraries' chatter is no news to the user: the one line below is.
        with contextlib.redirect_stdout(io.StringIO()), contextlib.redirect_stderr(io.StringIO()):
            vertices, faces = reader(file)
    except BadInputError:
        raise
    except _GARBAGE as error:
        kind = file.suffix[1:].upper()
        raise BadInputError(
            f"{file.name}: cannot be read as {kind} ({_first_line(error)}); export the mesh again, or convert it to STL"
        ) from error
    if len(faces) == 0:
        raise BadInputError(f"{file.name}: holds no triangles; export the part's surface as a triangle mesh")
    return vertices, faces


def _type(value: object) -> str:
    """A value's type in words."""
    return f"of type {type(value).__name__}"


def _reader(file: Path) -> _Read:
    """Choose the reader by the file's suffix, once the file is known to be there and to hold something."""
    advice = "give the path of a triangle mesh (STL, OBJ, PLY, ...)"
    try:
        if file.is_dir():
            raise BadInputError(f"{file.name or file}: is a folder; {advice}")
        if not file.exists():
            raise BadInputError(f"{file.name}: file not found; {_near(file) or advice}")
        if file.stat().st_size == 0:
            raise BadInputError(f"{file.name}: is empty; {advice}")
    except (OSError, ValueError) as error:
        if isinstance(error, BadInputError):
            raise
        raise BadInputError(f"{file.name}: cannot be opened ({_first_line(error)}); {advice}") from error
    if file.suffix.lower() not in _READERS:
        known = ", ".join(suffix[1:].upper() for suffix in SUFFIXES)
        raise BadInputError(f"{file.name}: unknown format {file.suffix!r}; convert the mesh to one of {known}")
    return _READERS[file.suffix.lower()]


def _near(file: Path) -> str:
    """The mesh in the same folder that was meant, if one has such a name."""
    if not file.parent.is_dir():
        return f"there is no folder {file.parent}"
    names = {there.name: there.name for there in file.parent.iterdir() if there.suffix.lower() in _READERS}
    names |= {Path(name).stem: name for name in names}
    near = difflib.get_close_matches(file.name, names, 1, 0.7)
    return f"did you mean {names[near[0]]}?" if near else ""


def _first_line(error: BaseException) -> str:
    """Say what went wrong in a few words, whatever the library put in its message."""
    lines = str(error).strip().splitlines()
    words = lines[0].strip() if lines else ""
    if isinstance(error, SystemExit | KeyError) or not words:
        words = DAMAGED
    return words if len(words) <= 100 else words[:97] + "..."
