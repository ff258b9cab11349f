"""Reading of Abaqus and CalculiX decks (INP): nodes, elements, parts and their instances.

No reader at hand takes parts with numbers of their own, moved instances and nodes in cylindrical coordinates.
"""

import re
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.cells_to_triangles import CellBlock, surface_mesh
from meshwind.mesh.io.deck_elements import cell_kind, node_count
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.text import own_unit, text_of

_MAKING = ("NGEN", "NFILL", "NCOPY", "NMAP", "ELGEN", "ELCOPY", "IMPORT", "SUBSTRUCTURE GENERATE")
"""Keywords that make nodes or elements, and are not read."""


@dataclass(frozen=True)
class _Block:
    """A keyword with its parameters and its lines of data; line: its number."""

    key: str
    parameters: dict[str, str]
    line: int
    data: list[bytes] = field(default_factory=list)


@dataclass
class _Part:
    """Nodes and cells with numbers of their own."""

    name: str
    ids: list[Ints] = field(default_factory=list)
    points: list[Floats] = field(default_factory=list)
    cells: list[tuple[str, Ints]] = field(default_factory=list)

    def numbered(self, file: str) -> tuple[Floats, list[tuple[str, Ints]]]:
        """Positions (n, 3), and cells (c, nodes) of their rows; of a node that is defined twice the last one counts."""
        if not self.cells:
            return np.empty((0, 3)), []
        ids = np.concatenate(self.ids) if self.ids else np.empty(0, dtype=np.int64)
        points = np.concatenate(self.points) if self.points else np.empty((0, 3))
        known, last = np.unique(ids[::-1], return_index=True)
        points = points[::-1][last]
        tables = []
        for kind, nodes in self.cells:
            rows = np.searchsorted(known, nodes)
            found = rows < len(known)
            found[found] = known[rows[found]] == nodes[found]
            if not found.all():
                missing = int(nodes[~found].flat[0])
                raise BadInputError(f"{file}: an element refers to node {missing}, which is not defined{self._where()}")
            tables.append((kind, rows))
        return points, tables

    def _where(self) -> str:
        return f" in part {self.name}; export the deck again" if self.name else "; export the deck again"


@dataclass(frozen=True)
class _Instance:
    """A use of a part: what it adds to it, and the rotation (3, 3) and shift (3,) of its points."""

    part: str
    own: _Part
    rotation: Floats
    shift: Floats


class _Deck:
    """What has been read of a deck."""

    def __init__(self, file: str) -> None:
        self.file, self.loose = file, _Part("")
        self.parts: dict[str, _Part] = {}
        self.instances: list[_Instance] = []
        self.unknown: Counter[str] = Counter()
        self.known = 0
        self.system: tuple[Floats, Floats] | None = None

    def take(self, blocks: Iterator[_Block]) -> None:
        """Read all keywords."""
        into, instance = self.loose, None
        for block in blocks:
            key, given = block.key, block.parameters
            if key == "INCLUDE" or (key in ("NODE", "ELEMENT") and "INPUT" in given):
                raise BadInputError(
                    f"{self.file}: *{key} in line {block.line} includes another file, which is not read; "
                    "join them into one"
                )
            if key in _MAKING:
                raise BadInputError(
                    f"{self.file}: *{key} in line {block.line} is not read; "
                    "write the deck with all nodes and elements listed"
                )
            if key == "PART":
                into = self.parts.setdefault(_name(given), _Part(given.get("NAME", "")))
                self.system = None
            elif key == "INSTANCE":
                instance = self._instance(block)
                into = instance.own
                self.system = None
            elif key in ("END PART", "END INSTANCE", "END ASSEMBLY"):
                self.instances += [] if instance is None or key != "END INSTANCE" else [instance]
                into, instance, self.system = self.loose, None if key == "END INSTANCE" else instance, None
            elif key == "SYSTEM":
                self.system = _system(self._numbers(block))
            elif key == "NODE":
                self._nodes(block, into)
            elif key == "ELEMENT":
                self._elements(block, into)

    def _numbers(self, block: _Block) -> list[list[float]]:
        """Numbers of each line; a field without one is 0."""
        rows = []
        for line in block.data:
            try:
                rows.append([float(word) if word.strip() else 0.0 for word in line.rstrip(b", \t").split(b",")])
            except ValueError:
                try:
                    fixed = re.sub(rb"(?i)(\d\.?)d([+-]?\d)", rb"\1e\2", line).rstrip(b", \t").split(b",")
                    rows.append([float(word) if word.strip() else 0.0 for word in fixed])
                except ValueError:
                    text = line.decode("latin-1").strip()[:40]
                    raise BadInputError(
                        f"{self.file}: {text!r} below *{block.key} in line {block.line} is not all numbers; mend it"
                    ) from None
        return rows

    def _nodes(self, block: _Block, into: _Part) -> None:
        rows = [(row + [0.0, 0.0, 0.0])[:4] for row in self._numbers(block)]
        if not rows:
            return
        table = np.array(rows, dtype=np.float64)
        if not (np.isfinite(table[:, 0]).all() and (np.abs(table[:, 0]) < 2**53).all()):
            raise ValueError("a node's number is no number")
        system = block.parameters.get("SYSTEM", "R").upper()[:1]
        if system not in "RCS":
            raise BadInputError(f"{self.file}: *NODE in line {block.line} has an unknown SYSTEM; give R, C or S")
        points = _cartesian(table[:, 1:], system)
        if self.system is not None:
            points = points @ self.system[0].T + self.system[1]
        into.ids.append(table[:, 0].astype(np.int64))
        into.points.append(points)

    def _elements(self, block: _Block, into: _Part) -> None:
        name = block.parameters.get("TYPE", "").upper()
        kind = cell_kind(name)
        if kind == "":
            return
        if kind is None:
            self.unknown[name or "without a type"] += len(block.data)
            return
        words = [word for line in block.data for word in line.split(b",") if word.strip()]
        width = 1 + node_count(kind)
        if len(words) % width:
            raise BadInputError(
                f"{self.file}: *ELEMENT, TYPE={name} in line {block.line} needs {width - 1} nodes an element, and its "
                f"{len(words)} numbers are no whole number of them; export the deck again"
            )
        try:
            numbers = np.fromiter(map(int, words), dtype=np.int64, count=len(words)).reshape(-1, width)
        except ValueError:
            raise BadInputError(
                f"{self.file}: *ELEMENT in line {block.line} has nodes that are no whole numbers; mend it"
            ) from None
        self.known += len(numbers)
        into.cells.append((kind, numbers[:, 1:]))

    def _instance(self, block: _Block) -> _Instance:
        rows = self._numbers(block)
        shift = np.array((rows[0] + [0.0, 0.0, 0.0])[:3]) if rows else np.zeros(3)
        rotation = np.eye(3)
        if len(rows) > 1:
            if len(rows[1]) != 7:
                raise BadInputError(
                    f"{self.file}: the rotation of *INSTANCE in line {block.line} is not seven numbers; mend it"
                )
            a, b = np.array(rows[1][:3]), np.array(rows[1][3:6])
            rotation = _about(b - a, rows[1][6])
            shift = rotation @ (shift - a) + a  # first moved, then turned
        return _Instance(block.parameters.get("PART", "").upper(), _Part(_name(block.parameters)), rotation, shift)

    def surface(self, units: str) -> FileMesh:
        """The surface of all instances, and of what belongs to no part; without instances, of all parts."""
        pieces = [self.loose.numbered(self.file)]
        for instance in self.instances:
            if instance.part not in self.parts:
                raise BadInputError(f"{self.file}: an instance is of part {instance.part!r}, which is not in the deck")
            for part in (self.parts[instance.part], instance.own):
                points, tables = part.numbered(self.file)
                pieces.append((points @ instance.rotation.T + instance.shift, tables))
        used = {instance.part for instance in self.instances}
        left = [] if used else list(self.parts.values())
        pieces += [part.numbered(self.file) for part in left]
        starts = np.cumsum([0] + [len(points) for points, _ in pieces])
        blocks: list[CellBlock] = [
            (kind, (np.full(len(rows), rows.shape[1], dtype=np.int64), (rows + start).ravel()))
            for (_, tables), start in zip(pieces, starts[:-1], strict=True)
            for kind, rows in tables
        ]
        return surface_mesh(np.concatenate([points for points, _ in pieces]), blocks, units, self._warnings(used))

    def _warnings(self, used: set[str]) -> tuple[str, ...]:
        words = []
        if self.unknown:
            names = ", ".join(list(self.unknown)[:5])
            count = self.unknown.total()
            if not self.known:
                raise BadInputError(f"{self.file}: its {count} elements are of types that are not read ({names[:80]})"
                                    "; export shells or solids")  # fmt: skip
            words.append(f"{count} elements of types that are not known ({names[:80]}) are left out, of "
                         f"{count + self.known}")  # fmt: skip
        idle = [part.name for name, part in self.parts.items() if name not in used and part.cells] if used else []
        if idle:
            words.append(f"parts that no instance uses are left out: {', '.join(idle)[:80]}")
        return tuple(words)


def read_deck(path: Path) -> FileMesh:
    """Surface of a deck."""
    content = text_of(path)
    deck = _Deck(path.name)
    deck.take(_blocks(content))
    return deck.surface(own_unit(content))


def _blocks(content: bytes) -> Iterator[_Block]:
    """The keywords of a deck with their data, without comments and empty lines."""
    block: _Block | None = None
    keyword, start = b"", 0
    for number, raw in enumerate(content.split(b"\n"), 1):
        line = raw.strip()
        if not line or line.startswith(b"**"):
            continue
        if keyword:
            keyword += line
        elif line.startswith(b"*"):
            keyword, start = line, number
        else:
            if block is not None:
                block.data.append(line)
            continue
        if keyword.endswith(b","):
            continue  # the keyword's line goes on
        if block is not None:
            yield block
        block, keyword = _keyword(keyword.decode("latin-1"), start), b""
    if block is not None:
        yield block


def _keyword(line: str, number: int) -> _Block:
    words = [word.strip() for word in line.lstrip("* \t").split(",")]
    pairs = (word.partition("=") for word in words[1:] if word)
    parameters = {name.strip().upper(): value.strip().strip("\"'") for name, _, value in pairs}
    return _Block(" ".join(words[0].upper().split()), parameters, number)


def _name(parameters: dict[str, str]) -> str:
    return parameters.get("NAME", "").upper()


def _cartesian(given: Floats, system: str) -> Floats:
    """Positions from cylindrical (r, theta, z) or spherical (r, theta, phi) coordinates, angles in degrees."""
    if system == "R":
        return given
    r, theta = given[:, 0], np.radians(given[:, 1])
    if system == "C":
        return np.column_stack([r * np.cos(theta), r * np.sin(theta), given[:, 2]])
    phi = np.radians(given[:, 2])  # from the plane of x and y
    return np.column_stack([r * np.cos(theta) * np.cos(phi), r * np.sin(theta) * np.cos(phi), r * np.sin(phi)])


def _system(rows: list[list[float]]) -> tuple[Floats, Floats] | None:
    """Axes (3, 3), in columns, and origin of *SYSTEM: points a, b on the x axis, and c in the plane of x and y."""
    given = list(chain.from_iterable(rows))
    if not given:
        return None
    a, b, c = (np.array((given + [0.0] * 9)[k : k + 3]) for k in (0, 3, 6))
    if len(given) <= 3:
        return np.eye(3), a
    x = b - a
    across = c - a if len(given) > 6 else np.array([-x[1], x[0], 0.0])
    z = np.cross(x, across)
    if not (np.linalg.norm(x) > 0.0 and np.linalg.norm(z) > 0.0):
        raise ValueError("the points of *SYSTEM do not give axes")
    x, z = x / np.linalg.norm(x), z / np.linalg.norm(z)
    return np.column_stack([x, np.cross(z, x), z]), a


def _about(axis: Floats, degrees: float) -> Floats:
    """Rotation (3, 3) about an axis through the origin."""
    size = float(np.linalg.norm(axis))
    if not size > 0.0:
        raise ValueError("the axis of an instance's rotation has no length")
    x, y, z = axis / size
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    angle = np.radians(degrees)
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1.0 - np.cos(angle)) * (cross @ cross))
