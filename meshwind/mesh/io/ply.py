"""Reading of PLY files: polygons and strips, as text and binary in both byte orders.

No reader at hand takes faces beside strips, or lists of different length in a binary file.
"""

import re
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells_to_triangles import surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.text import own_unit

_TYPES = {
    "char": "i1", "uchar": "u1", "short": "i2", "ushort": "u2", "int": "i4", "uint": "u4", "float": "f4",
    "double": "f8", "int8": "i1", "uint8": "u1", "int16": "i2", "uint16": "u2", "int32": "i4", "uint32": "u4",
    "float32": "f4", "float64": "f8", "int64": "i8", "uint64": "u8",
}  # fmt: skip
_ORDERS = {"ascii": "", "binary_little_endian": "<", "binary_big_endian": ">"}
_CORNERS = ("vertex_indices", "vertex_index")


@dataclass(frozen=True)
class Lists:
    """A list of each row: the sizes (rows,), and the numbers of one list after the other."""

    sizes: Ints
    values: Any


@dataclass(frozen=True)
class Element:
    """Declaration of an element: name, number of rows, and by their names its properties.

    A property is the type of a number, or of a list the types of its length and of its numbers.
    """

    name: str
    rows: int
    properties: dict[str, tuple[str, ...]] = field(default_factory=dict)


@dataclass(frozen=True)
class Ply:
    """The elements of a file: by element and property the numbers (rows,) or the lists; extra: bytes after them."""

    tables: dict[str, dict[str, Any]]
    units: str = ""
    extra: int = 0
    grid: bool = False

    def points(self) -> Floats:
        """Positions (n, 3) of the vertices."""
        vertex = self.tables.get("vertex", {})
        if not all(axis in vertex for axis in "xyz"):
            raise ValueError("its vertices have no x, y and z")
        return np.column_stack([np.asarray(vertex[axis], dtype=np.float64) for axis in "xyz"])

    def corners(self) -> Lists | None:
        """Vertices of the faces."""
        face = self.tables.get("face", {})
        return next((face[name] for name in _CORNERS if isinstance(face.get(name), Lists)), None)


def read_ply(path: Path) -> FileMesh:
    """Vertices and triangles of a PLY file."""
    ply = read_tables(path)
    blocks = []
    corners = ply.corners()
    if corners is not None:
        blocks.append(("polygon", (corners.sizes, _whole(corners.values))))
    strips = ply.tables.get("tristrips", {}).values()
    blocks += [("triangle strip", _unbroken(lists)) for lists in strips if isinstance(lists, Lists)]
    warnings = [f"{ply.extra} bytes after the last element are left out"] if ply.extra else []
    for name, table in ply.tables.items():
        held = next((len(table[key].sizes) for key in _CORNERS if isinstance(table.get(key), Lists)), 0)
        if held and name not in ("face", "tristrips", "edge"):
            warnings.append(f"{held} rows of the element {name[:40]!r}, which is not known, are left out")
    if ply.grid and not blocks:
        raise BadInputError(f"{path.name}: is a range grid, which is no mesh; triangulate the scan first")
    return surface_mesh(ply.points(), blocks, ply.units, tuple(warnings))


def read_tables(path: Path) -> Ply:
    """All elements of a PLY file.  Raises ValueError, or BadInputError where the file is cut short."""
    content = path.read_bytes().removeprefix(b"\xef\xbb\xbf")
    head = re.match(rb"ply\s[\s\S]*?\bend_header[ \t]*(?:\r\n|\n|\r)", content[: 1 << 20])
    if head is None:
        raise ValueError("it has no PLY header")
    order, elements = _header(head[0].decode("latin-1"))
    body = content[head.end() :]
    if order:
        tables, used = _binary(path.name, elements, order, body)
        extra = len(body) - used
        extra = 0 if not body[used:].strip(b"\0\r\n \t") else extra
    else:
        tables, extra = _ascii(path.name, elements, body), 0
    return Ply(tables, own_unit(content), extra, b"num_cols" in head[0])


def _header(text: str) -> tuple[str, list[Element]]:
    """Byte order, "" for text, and the elements."""
    order: str | None = None
    elements: list[Element] = []
    for line in re.split(r"\r\n|\n|\r", text)[1:]:
        words = line.split()
        if not words or words[0] in ("comment", "obj_info", "end_header"):
            continue
        if words[0] == "format" and len(words) > 1 and words[1] in _ORDERS:
            order = _ORDERS[words[1]]
        elif words[0] == "element" and len(words) == 3 and words[2].isdigit():
            elements.append(Element(words[1], int(words[2])))
        elif words[0] == "property" and elements and len(words) >= 3:
            kinds = tuple(words[2:4]) if words[1] == "list" and len(words) == 5 else (words[1],)
            if not all(kind in _TYPES for kind in kinds):
                raise ValueError(f"its header has an unknown type in {line.strip()[:60]!r}")
            elements[-1].properties[words[-1]] = tuple(_TYPES[kind] for kind in kinds)
        else:
            raise ValueError(f"its header has the line {line.strip()[:60]!r}")
    if order is None:
        raise ValueError("its header names no format")
    return order, elements


def _binary(name: str, elements: list[Element], order: str, body: bytes) -> tuple[dict[str, dict[str, Any]], int]:
    """The tables of a binary file, and how many bytes they take."""
    tables: dict[str, dict[str, Any]] = {}
    at = 0
    for element in elements:
        lists = any(len(kinds) == 2 for kinds in element.properties.values())
        if not element.properties or not element.rows:
            tables[element.name] = {}
            continue
        read = _rows_of_one_length(element, order, body, at) if lists else _plain_rows(element, order, body, at)
        if read is None and lists:
            read = _rows_of_any_length(element, order, body, at)
        if read is None:
            raise _cut_short(name, element)
        tables[element.name], at = read
    return tables, at


def _cut_short(name: str, element: Element) -> BadInputError:
    return BadInputError(
        f"{name}: is cut short: it announces {element.rows} rows of {element.name[:40]!r} and holds fewer; "
        "copy or export it again"
    )


_Read = tuple[dict[str, Any], int] | None


def _plain_rows(element: Element, order: str, body: bytes, at: int) -> _Read:
    row = np.dtype([(name, order + kinds[0]) for name, kinds in element.properties.items()])
    end = at + element.rows * row.itemsize
    if end > len(body):
        return None
    rows = np.frombuffer(body, row, element.rows, at)
    return {name: rows[name] for name in element.properties}, end


def _rows_of_one_length(element: Element, order: str, body: bytes, at: int) -> _Read:
    """The rows where all lists of a property have the length that they have in the first row; None otherwise."""
    parts: list[Any] = []
    start = at
    for name, kinds in element.properties.items():
        if len(kinds) == 1:
            parts.append((name, order + kinds[0]))
            start += np.dtype(kinds[0]).itemsize
            continue
        length = np.dtype(order + kinds[0])
        if start + length.itemsize > len(body):
            return None
        size = int(np.frombuffer(body, length, 1, start)[0])
        if not 0 <= size <= len(body):
            return None
        parts += [(f"{name} length", length), (name, order + kinds[1], (size,))]
        start += length.itemsize + size * np.dtype(kinds[1]).itemsize
    row = np.dtype(parts)
    end = at + element.rows * row.itemsize
    if end > len(body):
        return None
    rows = np.frombuffer(body, row, element.rows, at)
    table: dict[str, Any] = {}
    for name, kinds in element.properties.items():
        if len(kinds) == 1:
            table[name] = rows[name]
            continue
        sizes = rows[f"{name} length"].astype(np.int64)
        if (sizes != row[name].shape[0]).any():
            return None
        table[name] = Lists(sizes, rows[name].ravel())
    return table, end


def _rows_of_any_length(element: Element, order: str, body: bytes, at: int) -> _Read:
    """The rows where lists differ in length: one after the other, as each says where the next begins."""
    if element.rows > len(body):
        return None
    kinds = {name: tuple(np.dtype(order + kind) for kind in types) for name, types in element.properties.items()}
    starts: dict[str, list[int]] = {name: [] for name in kinds}
    sizes: dict[str, list[int]] = {name: [] for name in kinds}
    byte_order = "big" if order == ">" else "little"
    for _ in range(element.rows):
        for name, types in kinds.items():
            count = 1
            if len(types) == 2:
                width = types[0].itemsize
                if at + width > len(body):
                    return None
                count = int.from_bytes(body[at : at + width], byte_order)  # type: ignore[arg-type]
                at += width
            starts[name].append(at)
            sizes[name].append(count)
            at += count * types[-1].itemsize
            if at > len(body):
                return None
    table: dict[str, Any] = {}
    for name, types in kinds.items():
        length = np.array(sizes[name], dtype=np.int64)
        values = _gathered(body, np.array(starts[name], dtype=np.int64), length, types[-1])
        table[name] = Lists(length, values) if len(types) == 2 else values
    return table, at


def _gathered(body: bytes, starts: Ints, sizes: Ints, kind: Any) -> Any:
    """Numbers that begin at some bytes, so many at each."""
    step = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes, sizes)
    first = np.repeat(starts, sizes) + step * kind.itemsize
    data = np.frombuffer(body, np.uint8)
    return np.ascontiguousarray(data[first[:, None] + np.arange(kind.itemsize)]).view(kind).ravel()


def _ascii(name: str, elements: list[Element], body: bytes) -> dict[str, dict[str, Any]]:
    """The tables of a text file; line ends count no more than blanks."""
    numbers = np.array(body.split(), dtype=object)
    tables: dict[str, dict[str, Any]] = {}
    at = 0
    for element in elements:
        if not element.properties or not element.rows:
            tables[element.name] = {}
            continue
        if element.rows > len(numbers) - at:
            raise _cut_short(name, element)
        columns: dict[str, list[Any]] = {key: [] for key in element.properties}
        if all(len(kinds) == 1 for kinds in element.properties.values()):
            end = at + element.rows * len(columns)
            if end > len(numbers):
                raise _cut_short(name, element)
            table = _numbers(numbers[at:end]).reshape(element.rows, -1)
            tables[element.name] = {key: table[:, k] for k, key in enumerate(columns)}
            at = end
            continue
        tables[element.name], at = _text_lists(name, element, numbers, at)
    return tables


def _text_lists(file: str, element: Element, numbers: Any, at: int) -> tuple[dict[str, Any], int]:
    starts: dict[str, list[int]] = {key: [] for key in element.properties}
    sizes: dict[str, list[int]] = {key: [] for key in element.properties}
    for _ in range(element.rows):
        for key, kinds in element.properties.items():
            count = 1
            if len(kinds) == 2:
                if at >= len(numbers):
                    raise _cut_short(file, element)
                count = int(float(numbers[at]))
                at += 1
            starts[key].append(at)
            sizes[key].append(count)
            at += count
            if count < 0 or at > len(numbers):
                raise _cut_short(file, element)
    table: dict[str, Any] = {}
    for key, kinds in element.properties.items():
        length = np.array(sizes[key], dtype=np.int64)
        step = np.arange(length.sum()) - np.repeat(np.cumsum(length) - length, length)
        values = _numbers(numbers[np.repeat(np.array(starts[key], dtype=np.int64), length) + step])
        table[key] = Lists(length, values) if len(kinds) == 2 else values
    return table, at


def _numbers(words: Any) -> Floats:
    return np.fromiter(map(float, words), dtype=np.float64, count=len(words))


def _whole(values: Any) -> Ints:
    """Indices as whole numbers."""
    numbers = np.asarray(values)
    if numbers.dtype.kind == "f" and not (np.isfinite(numbers) & (np.abs(numbers) < 2**53)).all():
        raise ValueError("a face refers to a vertex that does not exist")
    return numbers.astype(np.int64)


def _unbroken(lists: Lists) -> tuple[Ints, Ints]:
    """Strips without the -1 that divides them."""
    nodes = _whole(lists.values)
    ends = np.zeros(len(nodes) + 1, dtype=bool)
    ends[np.cumsum(lists.sizes)] = True  # a strip begins after each list, and after each -1
    mark = nodes < 0
    group = np.cumsum(ends[:-1] | np.concatenate([[False], mark[:-1]]) if len(nodes) else ends[:-1])
    return np.bincount(group[~mark]).astype(np.int64) if len(nodes) else lists.sizes, nodes[~mark]
