"""Reading of Gmsh's MSH files of the versions 1, 2.x, 4.0 and 4.1, as text and binary (its manual, "MSH file format").

meshio reads neither version 1 nor parametric coordinates, partitions or some binary files of Gmsh's own.
"""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.cells.surface import CellBlock, surface_mesh
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.msh.elements import element_type
from meshwind.mesh.io.msh.sections import Reader, Sections, sections_of, whole

_DENSE = 4
"""Largest number of a node, by their count, up to which nodes are looked up in a table of all numbers."""
_Elements = dict[int, list[Ints]]
"""Tables of the number and the nodes (e, 1 + nodes) by the type of elements."""


@dataclass(frozen=True)
class MshMesh:
    """Points (n, 3) with their numbers (n,), and blocks of cells on them with the numbers of the elements of each."""

    ids: Ints
    points: Floats
    blocks: list[CellBlock]
    numbers: list[Ints]


def read_msh(path: Path) -> FileMesh:
    """Surface of a file: all its elements, whatever groups and partitions they are in."""
    mesh = mesh_of(sections_of(path.read_bytes()))
    return surface_mesh(mesh.points, mesh.blocks)


def mesh_of(sections: Sections) -> MshMesh:
    """Nodes and elements of a file.  Raises ValueError if an element refers to a node that does not exist."""
    if sections.version >= 4.0:
        ids, points = _nodes_by_entity(sections)
        elements = _elements_by_entity(sections)
    else:
        ids, points = _nodes_in_a_list(sections)
        elements = _elements_in_binary_list(sections) if sections.order else _elements_in_a_list(sections)
    find = _finder(ids)
    blocks: list[CellBlock] = []
    numbers = []
    for number in sorted(elements):
        kind = element_type(number)
        table = find(np.concatenate([part[:, 1:] for part in elements[number]]))[:, kind.order]
        blocks.append((kind.kind, (np.full(len(table), kind.nodes, dtype=np.int64), table.ravel())))
        numbers.append(np.concatenate([part[:, 0] for part in elements[number]]))
    return MshMesh(ids, points, blocks, numbers)


def _nodes_by_entity(sections: Sections) -> tuple[Ints, Floats]:
    """Numbers (n,) and points (n, 3) of version 4, in blocks by the entity that the nodes are on."""
    reader, old = Reader(sections, "Nodes"), sections.version < 4.1
    blocks, total = reader.table(1, ("size", 2 if old else 4))[0][0, :2].tolist()
    ids, points = [np.empty(0, dtype=np.int64)], [np.empty((0, 3))]
    for _ in range(blocks):
        entity, size = reader.table(1, ("i4", 3), ("size", 1))
        dimension, count = int(entity[0, 1 if old else 0]), int(size[0, 0])
        width = 3 + (max(0, min(dimension, 3)) if entity[0, 2] else 0)  # coordinates on the entity follow
        if old:
            tags, coordinates = reader.table(count, ("i4", 1), ("f8", width))
        else:
            tags, coordinates = reader.table(count, ("size", 1))[0], reader.table(count, ("f8", width))[0]
        ids.append(tags[:, 0])
        points.append(coordinates[:, :3])
    reader.end()
    return _counted(np.concatenate(ids), total, "nodes"), np.concatenate(points)


def _elements_by_entity(sections: Sections) -> _Elements:
    """Elements of version 4, in blocks by the entity that they are on."""
    reader, old = Reader(sections, "Elements"), sections.version < 4.1
    blocks, total = reader.table(1, ("size", 2 if old else 4))[0][0, :2].tolist()
    elements: _Elements = {}
    number = "i4" if old else "size"
    for _ in range(blocks):
        entity, size = reader.table(1, ("i4", 3), ("size", 1))
        kind = int(entity[0, 2])
        table = reader.table(int(size[0, 0]), (number, 1 + element_type(kind).nodes))[0]
        elements.setdefault(kind, []).append(table)
    reader.end()
    _counted(np.concatenate([np.empty(0), *(part[:, 0] for parts in elements.values() for part in parts)]), total)
    return elements


def _nodes_in_a_list(sections: Sections) -> tuple[Ints, Floats]:
    """Numbers (n,) and points (n, 3) of versions 1 and 2."""
    if "ParametricNodes" in sections.contents:
        return _parametric_nodes(sections)
    reader = Reader(sections, "NOD" if sections.version < 2.0 else "Nodes")
    tags, points = reader.table(reader.line(), ("i4", 1), ("f8", 3))
    reader.end()
    return tags[:, 0], points


def _parametric_nodes(sections: Sections) -> tuple[Ints, Floats]:
    """Nodes of version 2 with the dimension and number of their entity, and as many coordinates on it."""
    reader = Reader(sections, "ParametricNodes")
    ids, points = [], []
    for _ in range(reader.line()):
        tag, point, entity = reader.table(1, ("i4", 1), ("f8", 3), ("i4", 2))
        dimension = int(entity[0, 0])
        reader.table(1, ("f8", dimension if dimension in (1, 2) else 0))
        ids.append(int(tag[0, 0]))
        points.append(point[0])
    reader.end()
    return np.array(ids, dtype=np.int64), np.array(points).reshape(-1, 3)


def _elements_in_a_list(sections: Sections) -> _Elements:
    """Elements of versions 1 and 2 as text: number, type, groups, nodes."""
    first = sections.version < 2.0
    reader = Reader(sections, "ELM" if first else "Elements")
    total = reader.line()
    values = whole(reader.content)
    held = values.tolist()
    starts: dict[tuple[int, int], list[tuple[int, int]]] = {}
    at, read = 1, 0
    while at + 4 < len(held) and read < total:
        kind = held[at + 1]
        begin = at + (5 if first else 3 + held[at + 2])
        if begin <= at:
            raise ValueError("an element has fewer than no tags")
        starts.setdefault((kind, held[at + 4] if first else element_type(kind).nodes), []).append((at, begin))
        at = begin + (held[at + 4] if first else element_type(kind).nodes)
        read += 1
    if read < total or at != len(held):
        raise ValueError(f"its elements do not fill their section: it announces {total}, and {read} can be read")
    elements: _Elements = {}
    for (kind, count), places in starts.items():
        if count != element_type(kind).nodes:
            raise ValueError(f"an element of the type {kind} has {count} nodes")
        number, begin = np.array(places).T
        nodes = values[begin[:, None] + np.arange(count)]
        elements.setdefault(kind, []).append(np.column_stack([values[number], nodes]))
    return elements


def _elements_in_binary_list(sections: Sections) -> _Elements:
    """Elements of version 2 as bytes, in blocks of the same type."""
    reader = Reader(sections, "Elements")
    total, read = reader.line(), 0
    elements: _Elements = {}
    while read < total:
        kind, count, tags = reader.table(1, ("i4", 3))[0][0].tolist()
        if count < 1 or tags < 0:
            raise ValueError("its section $Elements is damaged")
        table = reader.table(count, ("i4", 1 + tags + element_type(kind).nodes))[0]
        elements.setdefault(kind, []).append(np.delete(table, np.s_[1 : 1 + tags], axis=1))
        read += count
    reader.end()
    return elements


def _counted(values: Ints, total: int, what: str = "elements") -> Ints:
    if len(values) != total:
        raise ValueError(f"it announces {total} {what}, and has {len(values)}")
    return values


def _finder(ids: Ints) -> Callable[[Ints], Ints]:
    """Function from numbers of nodes to their places; it raises ValueError for a number that no node has."""
    least, most = int(ids.min(initial=0)), int(ids.max(initial=0))
    order = np.argsort(ids, kind="stable")
    if (ids[order][1:] == ids[order][:-1]).any():
        raise ValueError("two of its nodes have the same number")

    def look_up(tags: Ints) -> Ints:
        if len(ids) == 0 or len(tags) == 0:
            found = np.full(tags.shape, -1, dtype=np.int64)
        elif least >= 0 and most <= _DENSE * len(ids):
            table = np.full(most + 2, -1, dtype=np.int64)
            table[ids] = np.arange(len(ids))
            found = table[np.where((tags < 0) | (tags > most), most + 1, tags)]
        else:
            found = order[np.minimum(np.searchsorted(ids, tags, sorter=order), len(ids) - 1)]
            found = np.where(ids[found] == tags, found, -1)
        if (found < 0).any():
            raise ValueError(f"an element refers to node {int(tags[found < 0][0])}, which is not in the file")
        return found

    return look_up
