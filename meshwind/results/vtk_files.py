"""VTK's XML files from arrays, written by hand, a part of an array at a time.

VTK's own writer holds all of them once more, and as text: 1.5 GB instead of 0.8 for a run of 2,500 paths.

Points and fields carry the name of their unit as VTK's own key UNITS_LABEL; `units` is that of lengths, "" where it is
not known.
"""

from base64 import b64encode
from collections.abc import Iterator, Sequence
from html import escape
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.core.geometry import Block, Data
from meshwind.results.schema import Field, File

VERTEX, TRIANGLE, QUAD = 1, 5, 9
"""VTK's numbers of the cell types."""
_KINDS = {"f": "Float", "i": "Int", "u": "UInt"}
"""VTK's names of the kinds of numbers, without their bits."""
_FIRST, _AT_ONCE = 1, 3 << 20
"""Bytes that are encoded with their count, and at a time after these."""


class _Array(NamedTuple):
    """An array with its name and the name of its unit."""

    name: str
    values: NDArray[Any]
    unit: str = ""


_Sections = dict[str, list[_Array]]
"""Arrays of a file by the element that holds them."""


def write_lines(path: Path, fields: File, block: Block, units: str) -> None:
    """Write polylines; fields: what the file holds."""
    _write_polydata(path, fields, block, units, lines=_cells(block.starts, np.arange(len(block.points))))


def write_vertices(path: Path, fields: File, block: Block, units: str) -> None:
    """Write points, each with a vertex cell."""
    count = len(block.points)
    _write_polydata(path, fields, block, units, verts=_cells(np.arange(count + 1), np.arange(count)))


def write_faces(path: Path, fields: File, block: Block, units: str) -> None:
    """Write an unstructured grid of quads and triangles, in this order.

    Without faces the points become vertex cells: meshio cannot read a grid that has no cell.
    """
    cells = [(QUAD, block.quads), (TRIANGLE, block.triangles)]
    if not len(block.quads) + len(block.triangles):
        cells = [(VERTEX, np.arange(len(block.points))[:, None])]
    kinds = np.concatenate([np.full(len(corners), kind, dtype=np.uint8) for kind, corners in cells])
    sizes = np.concatenate([np.full(len(corners), corners.shape[1]) for _, corners in cells])
    corners = np.concatenate([corners.ravel() for _, corners in cells])
    sections = {
        "PointData": list(_data(fields.point_data, block.point_data, units)),
        "CellData": [],
        "Points": [_points(block.points, units)],
        "Cells": [*_cells(np.concatenate([[0], np.cumsum(sizes)]), corners), _Array("types", kinds)],
    }
    _write(path, "UnstructuredGrid", {"Points": len(block.points), "Cells": len(kinds)}, sections)


def _write_polydata(
    path: Path,
    fields: File,
    block: Block,
    units: str,
    verts: Sequence[_Array] = (),
    lines: Sequence[_Array] = (),
) -> None:
    none = _cells(np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64))
    cells = {"Verts": verts or none, "Lines": lines or none, "Strips": none, "Polys": none}
    sections = {
        "PointData": list(_data(fields.point_data, block.point_data, units)),
        "CellData": list(_data(fields.cell_data, block.line_data, units)),
        "Points": [_points(block.points, units)],
        **{name: list(arrays) for name, arrays in cells.items()},
    }
    counts = {"Points": len(block.points)} | {name: len(arrays[1].values) for name, arrays in cells.items()}
    _write(path, "PolyData", counts, sections)


def _write(path: Path, kind: str, counts: dict[str, int], sections: _Sections) -> None:
    """Write uncompressed: five times as fast as with zlib, which saves only a tenth on such numbers."""
    numbers = "".join(f' NumberOf{name}="{count}"' for name, count in counts.items())
    with path.open("wb") as file:
        file.write(
            '<?xml version="1.0"?>\n'
            f'<VTKFile type="{kind}" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n'
            f"  <{kind}>\n    <Piece{numbers}>\n".encode()
        )
        for section, arrays in sections.items():
            file.write(f"      <{section}>\n".encode())
            for array in arrays:
                file.writelines(_lines(array))
            file.write(f"      </{section}>\n".encode())
        file.write(f"    </Piece>\n  </{kind}>\n</VTKFile>\n".encode())


def _lines(array: _Array) -> Iterator[bytes]:
    """The element of an array: its numbers in base 64 after the count of their bytes; booleans become uint8."""
    values = array.values.astype(np.uint8) if array.values.dtype == np.bool_ else array.values
    kind = f"{_KINDS[values.dtype.kind]}{8 * values.dtype.itemsize}"
    across = f' NumberOfComponents="{values.shape[1]}"' if values.ndim > 1 else ""
    yield f'        <DataArray type="{kind}" Name="{escape(array.name)}"{across} format="binary">\n          '.encode()
    plain = np.ascontiguousarray(values, values.dtype.newbyteorder("<")).reshape(-1).view(np.uint8)
    # a part at a time, each of whole groups of three bytes: a text of millions of points would be held beside them
    yield b64encode(len(plain).to_bytes(8, "little") + plain[:_FIRST].tobytes())
    for start in range(_FIRST, len(plain), _AT_ONCE):
        yield b64encode(plain[start : start + _AT_ONCE].tobytes())
    yield b"\n"
    if array.unit:
        yield (
            '          <InformationKey name="UNITS_LABEL" location="vtkDataArray">\n'
            f"            {escape(array.unit)}\n          </InformationKey>\n"
        ).encode()
    yield b"        </DataArray>\n"


def _points(points: Floats, units: str) -> _Array:
    return _Array("Points", points.reshape(-1, 3), units)


def _cells(starts: Ints, corners: Ints) -> list[_Array]:
    """Cells that start at these places among the numbers of their corners."""
    return [
        _Array("connectivity", corners.astype(np.int64, copy=False)),
        _Array("offsets", starts[1:].astype(np.int64, copy=False)),
    ]


def _data(fields: Sequence[Field], data: Data, units: str) -> Iterator[_Array]:
    """The arrays of the fields, in this order, and then those of other fields that the data are named by."""
    others = [name for name in data if name not in fields and isinstance(name, Field)]
    for field in (*fields, *others):
        if field in data:  # a surface that is exact has no uncertainty, one without a mesh no error
            yield _Array(str(field), data[field], field.unit_in(units))
