"""What a VTK, VTU or VTP file announces of its content, as VTK's readers drop what they cannot follow in silence."""

import re

import numpy as np

from meshwind.core.cast import Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.in_subprocess import DAMAGED
from meshwind.mesh.io.vtk.arrays import words_in

_HEAD = re.compile(rb"# vtk DataFile Version (\d{1,3})\.(\d{1,3})[^\n]*\n[^\n]*\n\s*(ASCII|BINARY)\b", re.IGNORECASE)
_SET = re.compile(rb"^[ \t]*DATASET[ \t]+(\w+)", re.MULTILINE | re.IGNORECASE)
_FIELD = re.compile(rb"^[ \t]*FIELD[ \t]", re.MULTILINE | re.IGNORECASE)
_LISTS = re.compile(
    rb"^[ \t]*(VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS|CELLS)\s+(\d{1,10})\s+(\d{1,10})[ \t\r]*\n",
    re.MULTILINE | re.IGNORECASE,
)
_POINTS = re.compile(rb"^[ \t]*POINTS\s+(\d{1,10})\s+\w+[ \t\r]*\n", re.MULTILINE | re.IGNORECASE)
_OFFSETS = re.compile(rb"^[ \t]*OFFSETS[ \t]", re.MULTILINE | re.IGNORECASE)
_PIECE = re.compile(rb"<Piece\b[^>]*>")
_ATTRIBUTE = re.compile(rb"\b(Number[A-Za-z]{2,20})\s*=\s*[\"']\s*(\d{1,12})\s*[\"']")
_COMPRESSOR = re.compile(rb"<VTKFile\b[^>]*\bcompressor\s*=\s*[\"'](\w{1,60})[\"']")
_COMPRESSORS = (b"vtkZLibDataCompressor", b"vtkLZ4DataCompressor", b"vtkLZMADataCompressor")
_WORD = re.compile(rb"[A-Za-z_]{3}")
"""Start of a keyword; numbers hold no three letters in turn but nan and inf."""
_TYPE = re.compile(rb"<VTKFile\b[^>]*\btype\s*=\s*[\"'](\w{1,40})[\"']")
_XML = {b"NumberOfPoints": "points", b"NumberOfCells": "cells", b"NumberOfPolys": "polygons",
        b"NumberOfStrips": "strips"}  # fmt: skip
_LEGACY = {b"POLYGONS": "polygons", b"TRIANGLE_STRIPS": "strips", b"CELLS": "cells"}
_LEGACY_HEAD = (b"# vtk DataFile", b"\xef\xbb\xbf# vtk DataFile")
_READ = (b"POLYDATA", b"UNSTRUCTURED_GRID", b"STRUCTURED_GRID")
_OTHER = {
    b"RECTILINEAR_GRID": "a rectilinear grid", b"STRUCTURED_POINTS": "an image (structured points)",
    b"FIELD": "a field without a mesh",
    b"TABLE": "a table", b"DIRECTED_GRAPH": "a graph", b"UNDIRECTED_GRAPH": "a graph", b"TREE": "a tree",
    b"MULTIBLOCK": "several blocks", b"HIERARCHICAL_BOX": "several blocks", b"OVERLAPPING_AMR": "several blocks",
}  # fmt: skip
LEGACY, POLYGONS, GRID = "legacy", "PolyData", "UnstructuredGrid"
_MOST = 4096
"""Length of the part of a file in which VTK's XML names its type."""
ADVICE = "save the part's surface as VTP, PLY or STL"


def form_of(content: bytes, name: str) -> str:
    """What a file is by its content: LEGACY, or the type of data in VTK's XML.

    Raises BadInputError if the type is none of POLYGONS and GRID, and ValueError if the file is none of VTK's.
    """
    if content.startswith(_LEGACY_HEAD):
        return LEGACY
    held = _TYPE.search(content[:_MOST])
    if held is None:
        raise ValueError(DAMAGED)
    form = held[1].decode()
    if form not in (POLYGONS, GRID):
        raise BadInputError(f"{name}: holds VTK's {form}, not polygons or an unstructured grid; {ADVICE}")
    packed = _COMPRESSOR.search(content[:_MOST])
    if packed and packed[1] not in _COMPRESSORS:
        shown = packed[1].decode(errors="replace")
        raise BadInputError(f"{name}: is compressed by {shown}, which is not read; save it without compression")
    return form


def announced_by_xml(content: bytes) -> tuple[dict[str, int], int]:
    """Numbers of points and cells that the pieces of a VTU or VTP file announce, and the number of pieces."""
    text = content.partition(b"<AppendedData")[0]
    pieces = _PIECE.findall(text)
    found = dict.fromkeys(_XML.values(), 0)
    for key, count in (pair for piece in pieces for pair in _ATTRIBUTE.findall(piece)):
        if key in _XML:
            found[_XML[key]] += int(count)
    return found, len(pieces)


def announced_by_legacy(content: bytes, name: str) -> dict[str, int]:
    """Numbers of points and cells that a legacy file announces.

    Raises ValueError if version and cells disagree, or if a list of cells has the wrong size: such files end VTK's
    process; BadInputError if the file holds no cells by its kind.
    """
    version = _HEAD.match(content)
    if version is None:
        raise ValueError(DAMAGED)
    kind = _SET.search(content, version.end())
    held = kind[1].upper() if kind else b"FIELD" if _FIELD.search(content, version.end()) else b""
    if held not in _READ:
        words = _OTHER.get(held, f"a data set of the kind {held.decode(errors='replace')[:40]}" if held else "")
        if words:
            raise BadInputError(f"{name}: holds {words}, no polygons or cells; {ADVICE}")
        raise ValueError(DAMAGED)
    lists = list(_LISTS.finditer(content))
    split = _OFFSETS.search(content) is not None  # since version 5
    if lists and split != (int(version[1]) >= 5):
        raise ValueError(DAMAGED)
    found = {"polygons": 0, "strips": 0, "cells": 0}
    text = version[3].upper() == b"ASCII"
    for each in lists:
        count, size = int(each[2]), int(each[3])
        key = _LEGACY.get(each[1].upper())
        if key:
            found[key] += max(count - 1, 0) if split else count
        if text and not split:
            _check_length(content, each.end(), size, each[1].decode())
        elif not split:
            if each.end() + 4 * size > len(content):
                raise ValueError(DAMAGED)
            if not _adds_up(np.frombuffer(content, ">i4", size, each.end()).astype(np.int64), count):
                raise ValueError(DAMAGED)
    points = list(_POINTS.finditer(content))
    for each in points if text else ():
        _check_length(content, each.end(), 3 * int(each[1]), "POINTS")
    return found | {"points": sum(int(each[1]) for each in points)}


def _check_length(content: bytes, start: int, count: int, keyword: str) -> None:
    """Raise ValueError if a list of a text file, up to the next keyword, does not have so many numbers."""
    end = start
    while (found := _WORD.search(content, end)) and found[0].lower() in (b"nan", b"inf"):
        end = found.end()
    stop = found.start() if found else len(content)
    held = words_in(content, start, stop)
    if held != count:
        raise ValueError(f"its list {keyword} has {held} numbers, where it announces {count}")


def check_counts(announced: dict[str, int], read: dict[str, int]) -> None:
    """Raise ValueError if less was read than announced."""
    for key, count in read.items():
        if count != announced.get(key, count):
            raise ValueError(f"it announces {announced[key]} {key}, of which {count} can be read")


def _adds_up(numbers: Ints, count: int) -> bool:
    """Whether `count` cells, each its size followed by its nodes, fill the numbers exactly.

    The chain from cell to cell is followed by repeated doubling, without a loop over cells.
    """
    size = len(numbers)
    step = np.minimum(np.arange(size) + 1 + np.maximum(numbers, 0), size + 1)
    step = np.concatenate([step, [size + 1, size + 1]])  # the end, and beyond it
    position = 0
    while count:
        if count & 1:
            position = int(step[position])
        step = step[step]
        count >>= 1
    return position == size
