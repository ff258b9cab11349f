"""What a file is by its content, where that is not what its ending says: for the refusal of files that are not read."""

import codecs
import re
import zipfile
from pathlib import Path

from meshwind.core.opencascade import IGES, STEP

_START = 4096
"""Length of the part of a file that tells what it is."""
_NUMBER = rb"[ \t]+[-+]?[\d.][-+.\deE]*"
_READ: tuple[tuple[str, str, "re.Pattern[bytes]"], ...] = tuple(
    (name, suffix, re.compile(pattern))
    for name, suffix, pattern in (
        ("PLY", ".ply", rb"ply[ \t]*[\r\n]"),
        ("GLB", ".glb", rb"glTF[\1\2]\0\0\0"),
        ("glTF", ".gltf", rb"\s*\{[\s\S]*\"asset\"\s*:[\s\S]*\"version\""),
        ("VTK", ".vtk", rb"# vtk DataFile"),
        ("VTP", ".vtp", rb"\s*(?:<\?xml[^>]*>\s*)?<VTKFile[^>]*\"PolyData\""),
        ("VTU", ".vtu", rb"\s*(?:<\?xml[^>]*>\s*)?<VTKFile[^>]*\"UnstructuredGrid\""),
        ("Gmsh", ".msh", rb"\s*(?:\$Comments[\s\S]*?\$EndComments\s*)?\$MeshFormat"),
        ("OFF", ".off", rb"\s*(?:ST|C|N|4|n)*OFF[ \t]*(?:BINARY|\d[\d \t]*|#.*)?[\r\n]"),
        ("STL", ".stl", rb"(?i)\s*solid\b[\s\S]*?\bfacet\s+normal\s"),
        ("Abaqus", ".inp", rb"(?i)\s*(?:\*\*[^\n]*\n\s*)*\*(?:heading|node|part|include|element|assembly)\b"),
    )
)
"""Formats that are read: name, ending, and how their files begin."""
_OF_3MF = (b"PK\x03\x04", b"\xd0\xcf\x11\xe0")
"""Beginnings of 3MF files, plain and encrypted ones."""
_OBJ = re.compile(rb"(?:\A|[\r\n])[ \t]*v" + 3 * _NUMBER)
_OTHERS: tuple[tuple["re.Pattern[bytes]", str], ...] = tuple(
    (re.compile(pattern), words)
    for pattern, words in (
        (rb"version https://git-lfs\.github\.com/spec/",
         "is a Git LFS pointer, not the mesh; fetch it with git lfs pull"),
        (rb"/?(?:\.git)?/annex/objects/", "is a git-annex pointer, not the mesh; fetch it with git annex get"),
        (rb"\x1f\x8b", "is compressed (gzip) by its content; unpack it first"),
        (rb"BZh[1-9]1AY", "is compressed (bzip2) by its content; unpack it first"),
        (rb"\xfd7zXZ\0", "is compressed (xz) by its content; unpack it first"),
        (rb"\x28\xb5\x2f\xfd", "is compressed (zstd) by its content; unpack it first"),
        (rb"7z\xbc\xaf\x27\x1c", "is a 7z archive by its content; unpack it first"),
        (rb"Rar!\x1a\x07", "is a RAR archive by its content; unpack it first"),
        (rb"(?i)\s*(?:<!--[\s\S]*?-->\s*)?(?:<\?xml[^>]*>\s*)?<(?:!doctype\s+html|html|head|body)\b",
         "is a web page, not a mesh; download the file itself"),
        (rb"%PDF-", "is a PDF document by its content; give the mesh itself"),
        (rb"\x89PNG\r\n|\xff\xd8\xff|GIF8|BM....\0\0\0\0", "is a picture by its content; give the mesh itself"),
        (rb"\x00\x05\x16\x07", "is a Mac's companion file; give the file whose name has no ._ before it"),
        (rb"\s*ISO-10303-21\s*;", "is a STEP file by its content; rename it to {}.step, or export it as STL"),
        (rb"[^\r\n]{72}S[ 0]*1\s", "is an IGES file by its content; rename it to {}.igs, or export it as STL"),
        (rb"Kaydara FBX Binary|; FBX ", "is an FBX file by its content; export it as STL, OBJ or PLY"),
        (rb"BLENDER", "is a Blender file by its content; export it as STL, OBJ or PLY"),
        (rb"3D Geometry File Format", "is a Rhino file by its content; export its mesh as STL, OBJ or PLY"),
        (rb"#VRML|#X3D|(?:<\?xml[^>]*>\s*)?(?:<!DOCTYPE X3D[^>]*>\s*)?<X3D\b",
         "is a VRML or X3D file by its content; export it as STL, OBJ or PLY"),
        (rb"\s*(?:<\?xml[^>]*>\s*)?<COLLADA\b",
         "is a COLLADA file by its content; export it as STL, OBJ or PLY"),
        (rb"(?:<\?xml[^>]*>\s*)?<amf\b", "is an AMF file by its content; export it as STL or 3MF"),
        (rb"#usda |PXR-USDC", "is a USD file by its content; export it as STL, OBJ or PLY"),
        (rb"\s*0\s+SECTION\s|AC10\d\d\0", "is a DXF or DWG drawing by its content; export it as STL"),
        (rb"\s*\(\s*\d+\s*[\"(\d]",
         "is a mesh of Ansys (Fluent) by its content; write it as STL, VTU or Gmsh's MSH (meshio: file_format='gmsh')"),
        (rb"\s*MeshVersionFormatted\b", "is a Medit mesh by its content; convert it to STL, VTU or Gmsh's MSH"),
        (rb"(?i)\s*mesh\b[^\r\n]*\bdimension\b", "is a GiD mesh by its content; export it as STL, VTU or Gmsh's MSH"),
        (rb"\x89HDF\r\n", "is an HDF5 file by its content; convert it to VTU or STL"),
        (rb"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "is a file of a CAD or office program by its content; export it as STL"),
    )
)  # fmt: skip
"""What else a file may be: how it begins, and what to say."""


def foreign(path: Path) -> str:
    """What a file is, and what to do, if its content is of another kind than its ending; "" if that is not known."""
    with path.open("rb") as file:
        start = file.read(_START).removeprefix(codecs.BOM_UTF8)
    suffix = path.suffix.lower()
    if suffix == ".3mf" and start.startswith(_OF_3MF):
        return ""
    for pattern, words in _OTHERS:
        if pattern.match(start):
            own = (suffix in STEP and words.startswith("is a STEP")) or (suffix in IGES and "IGES" in words)
            return "" if own else words.replace("{}", _stem(path))
    if start.startswith(b"PK\x03\x04"):
        return _archive(path)
    if _is_utf16(start):
        return "is text in UTF-16; save it as UTF-8"
    if not start.strip(b"\0"):
        return "begins with nothing but zeros, as after a copy that failed; copy or export it again"
    kinds = [(name, ending) for name, ending, pattern in _READ if pattern.match(start)]
    if not kinds and len(start) >= 84 and path.stat().st_size == 84 + 50 * int.from_bytes(start[80:84], "little") > 84:
        kinds = [("STL", ".stl")]
    if not kinds and b"\0" not in start and _OBJ.search(start):
        kinds = [("OBJ", ".obj")]
    if not kinds or suffix in {ending for _, ending in kinds}:
        return ""
    name, ending = kinds[0]
    return f"is {'an' if name[0] in 'AOS' else 'a'} {name} file by its content; rename it to {_stem(path)}{ending}"


def _archive(path: Path) -> str:
    """Words on a ZIP archive, which may be a 3MF file."""
    try:
        with zipfile.ZipFile(path) as archive:
            is_3mf = any(name.lower().endswith(".model") for name in archive.namelist())
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError, RuntimeError):
        is_3mf = False
    if is_3mf:
        return f"is a 3MF file by its content; rename it to {_stem(path)}.3mf"
    return "is a ZIP archive by its content; unpack it first"


def _stem(path: Path) -> str:
    """Name of a file without its ending, and without that of a format before it, as in part.stl.bak."""
    inner = Path(path.stem)
    known = {".3mf", *STEP, *IGES, *(ending for _, ending, _ in _READ), ".obj"}
    return (inner.stem if inner.suffix.lower() in known else path.stem)[:80]


def _is_utf16(start: bytes) -> bool:
    """Whether every other byte is zero, or a byte order mark says so."""
    if start.startswith((b"\xff\xfe", b"\xfe\xff")):
        return True
    text = start[: len(start) // 2 * 2][:200]
    even, odd = text[::2], text[1::2]
    return len(text) >= 8 and (
        (not odd.strip(b"\0") and b"\0" not in even) or (not even.strip(b"\0") and b"\0" not in odd)
    )
