"""Scalars of Gmsh's MSH files: $NodeData and $ElementData (its manual, "MSH file format").

Values of the nodes of each element, $ElementNodeData, are not read: they may differ between elements at a node.
"""

import re
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.cells.kinds import SOLIDS, base_of
from meshwind.mesh.io.fields import Field, Fields, centroids, has_surface, used_points
from meshwind.mesh.io.msh.msh import MshMesh
from meshwind.mesh.io.msh.sections import Reader, Sections

_NAME = re.compile(rb'\s*(?:"([^"\n]*)"|([^\n]*?))[^\S\n]*\n')
_REAL = re.compile(rb"\s*(\S{1,60})(?=\s)")
_INTEGER = re.compile(rb"\s*([-+]?\d{1,18})(?=\s)")
_NAMED = re.compile(rb"\bnp\.float(?:32|64)\(([^()\s]{1,60})\)")
"""A number as meshio writes it in text with NumPy 2."""
_LINE_END = re.compile(rb"[^\S\n]*\n?")
_ELEMENT_NODES = "is given for the nodes of each element ($ElementNodeData), which is not read; save it as $NodeData"


@dataclass(frozen=True)
class _Part:
    """One section of a scalar: its time step, and values (n,) of nodes or elements by their numbers (n,)."""

    step: int
    numbers: Ints
    values: Floats


def msh_fields(sections: Sections, mesh: MshMesh) -> Fields:
    """Scalars of the elements and nodes of a file, whose sections of the same name are one.

    Raises ValueError if a section is damaged.
    """
    parts: dict[tuple[str, str], list[_Part]] = {}
    for where, content in sections.data:
        name, part = _part(sections, where, content)
        if part is not None and name:
            parts.setdefault((where, name), []).append(part)
    fields: Fields = {}
    for kind in ("ElementNodeData", "ElementData", "NodeData"):  # what nodes have goes before what elements have
        for (where, name), held in parts.items():
            if where == kind:
                fields[name] = _field(mesh, where, held)
    return fields


def _part(sections: Sections, where: str, content: bytes) -> tuple[str, _Part | None]:
    """Name and values of a section, None if it is no scalar."""
    names, at = _tags(content, 0, where, _NAME)
    _, at = _tags(content, at, where, _REAL)
    integers, at = _tags(content, at, where, _INTEGER)
    if len(integers) < 3:
        raise ValueError(f"its section ${where} does not tell how many values it has")
    step, components, count = (int(each[1]) for each in integers[:3])
    name = "" if not names else (names[0][1] if names[0][1] is not None else names[0][2]).decode(errors="replace")
    if components != 1:
        return name, None
    if where == "ElementNodeData":
        return name, _Part(step, np.empty(0, dtype=np.int64), np.empty(0))
    rest = content[_end_of_line(content, at) :]
    rest = rest if sections.order else _NAMED.sub(rb"\1", rest)
    reader = Reader(replace(sections, contents={where: rest}), where)
    numbers, values = reader.table(count, ("i4", 1), ("f8", 1))
    reader.end()
    return name, _Part(step, numbers[:, 0], values[:, 0])


def _end_of_line(content: bytes, at: int) -> int:
    found = _LINE_END.match(content, at)
    return found.end() if found else at


def _tags(content: bytes, at: int, where: str, form: re.Pattern[bytes]) -> tuple[list[re.Match[bytes]], int]:
    """Tags of a form from a place on, which their count precedes, and the place after them."""
    count = _INTEGER.match(content, at)
    held: list[re.Match[bytes]] = []
    while count and len(held) < int(count[1]):
        found = form.match(content, held[-1].end() if held else count.end())
        if found is None:
            break
        held.append(found)
    if count is None or len(held) != int(count[1]):
        raise ValueError(f"its section ${where} is damaged")
    return held, held[-1].end() if held else count.end()


def _field(mesh: MshMesh, where: str, parts: list[_Part]) -> Field:
    """A scalar of all its sections, such as those of several partitions."""
    if where == "ElementNodeData":
        return Field(problem=_ELEMENT_NODES)
    steps = len({part.step for part in parts})
    if steps > 1:
        return Field(problem=f"is given at {steps} time steps; save the file with one of them only")
    what = "node" if where == "NodeData" else "element"
    numbers = np.concatenate([part.numbers for part in parts])
    order = np.argsort(numbers, kind="stable")
    numbers, values = numbers[order], np.concatenate([part.values for part in parts])[order]
    twice = numbers[1:] == numbers[:-1]
    differs = twice & (values[1:] != values[:-1])
    if differs.any():
        return Field(problem=f"has two values for {what} {numbers[1:][differs][0]}; save it once")
    first = np.concatenate([[True], ~twice])[: len(numbers)]
    part = _Part(0, numbers[first], values[first])
    known = mesh.ids if what == "node" else np.concatenate([np.empty(0, dtype=np.int64), *mesh.numbers])
    lost = part.numbers[~np.isin(part.numbers, known)]
    if len(lost):
        return Field(problem=f"has a value for {what} {lost[0]}, which is not in the file; save both again")
    return _of_nodes(mesh, part) if what == "node" else _of_elements(mesh, part)


def _of_nodes(mesh: MshMesh, part: _Part) -> Field:
    """A scalar at the nodes of surface and volume elements; those of geometry only need no value."""
    used = used_points(len(mesh.ids), mesh.blocks)
    return Field(mesh.points[used], _values(part, mesh.ids[used])[0])


def _of_elements(mesh: MshMesh, part: _Part) -> Field:
    """A scalar at the centroids of the surface elements, of the volume elements, or both, if any of them has a value.

    Elements without a value among others that have one get NaN.
    """
    points, values = [], []
    for solid in (False, True):
        chosen = [(block, numbers) for block, numbers in zip(mesh.blocks, mesh.numbers, strict=True)
                  if has_surface(block[0]) and (base_of(block[0]) in SOLIDS) == solid]  # fmt: skip
        held = [_values(part, numbers) for _, numbers in chosen]
        if any(some for _, some in held):
            points += [centroids(mesh.points, block) for block, _ in chosen]
            values += [each for each, _ in held]
    if not values:
        return Field(problem="has no value on a surface or volume element")
    return Field(np.concatenate(points), np.concatenate(values))


def _values(part: _Part, numbers: Ints) -> tuple[Floats, bool]:
    """The values of these numbers (n,), NaN where there is none, and whether there are any."""
    if len(part.numbers) == 0:
        return np.full(len(numbers), np.nan), False
    at = np.minimum(np.searchsorted(part.numbers, numbers), len(part.numbers) - 1)
    found = part.numbers[at] == numbers
    return np.where(found, part.values[at], np.nan), bool(found.any())
