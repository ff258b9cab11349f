"""Reading of 3MF files, zip archives of XML for 3D printers: the core specification with the production extension."""

import zipfile
from pathlib import Path
from xml.etree import ElementTree
from xml.etree.ElementTree import Element

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.file_mesh import FileMesh

_Parts = list[tuple[Floats, Ints]]
_UNITS = {"micron": "um", "millimeter": "mm", "centimeter": "cm", "inch": "in", "foot": "ft", "meter": "m"}
"""Units of the core specification, section 3.4.1; millimeter is its default."""
_CORE = "http://schemas.microsoft.com/3dmanufacturing/core/"
_READ = ("/production/", "/material/", "/trianglesets/")
"""Extensions that are read, or that say nothing of the shape, by a part of their namespace."""
_SUPPORTS = ("support", "solidsupport")
"""Types of objects that are not the part."""
_PATH = "{http://schemas.microsoft.com/3dmanufacturing/production/2015/06}path"
_MAX_DEPTH = 16
"""Levels of objects within objects: if there are more, an object contains itself."""
_MAX_USES = 20_000
"""Uses of objects by others: a few objects that contain each other many times would take forever."""
_MAX_BYTES = 1 << 30
"""Largest unpacked size of the XML."""


def read_3mf(path: Path) -> FileMesh:
    """Vertices and triangles of all objects in the build but supports, in the file's unit."""
    with zipfile.ZipFile(path) as archive:
        package = _Package(path.name, archive)
        parts = package.built()
    units = package.units
    if not parts:
        return FileMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64), units, package.warnings)
    starts = np.cumsum([0] + [len(points) for points, _ in parts[:-1]])
    faces = [triangles + start for (_, triangles), start in zip(parts, starts, strict=True)]
    return FileMesh(np.concatenate([points for points, _ in parts]), np.concatenate(faces), units, package.warnings)


class _Package:
    """An archive with its model parts; the root one has the build."""

    def __init__(self, name: str, archive: zipfile.ZipFile) -> None:
        self.name, self.archive, self.uses, self.supports, self.empty = name, archive, 0, 0, 0
        self.members = {_plain(member.filename): member for member in archive.infolist()}
        self.models: dict[str, Element] = {}
        self.objects: dict[tuple[str, str | None], Element] = {}
        self.root = self._root()
        unit = self.model(self.root).get("unit", "millimeter")
        if unit not in _UNITS:
            raise BadInputError(f"{name}: its unit is {unit[:40]!r}, which 3MF does not know; export it in millimeters")
        self.units = _UNITS[unit]

    @property
    def warnings(self) -> tuple[str, ...]:
        """What is left out."""
        words = []
        if self.supports:
            words.append(f"objects of the build that are supports are left out: {self.supports}")
        if self.empty:
            words.append(f"objects without triangles are left out: {self.empty}")
        return tuple(words)

    def _root(self) -> str:
        """Name of the root model part, which the package's relationships name."""
        if "_rels/.rels" in self.members:
            for relation in self._xml("_rels/.rels").iterfind("{*}Relationship"):
                if relation.get("Type", "").endswith("/3dmodel"):
                    return _plain(relation.get("Target", ""))
        names = [name for name in self.members if name.endswith(".model")]
        if not names:
            raise ValueError("it holds no 3D model")
        return "3d/3dmodel.model" if "3d/3dmodel.model" in names else names[0]

    def _xml(self, name: str) -> Element:
        member = self.members.get(name)
        if member is None:
            raise ValueError(f"it refers to {name[:60]}, which it does not hold")
        if member.file_size > _MAX_BYTES:
            raise ValueError(f"it unpacks to more than {_MAX_BYTES >> 30} GB")
        return ElementTree.fromstring(self.archive.read(member))

    def model(self, name: str) -> Element:
        """A model part, checked for what it requires."""
        if name not in self.models:
            root = self._xml(name)
            self._check_required(root, name)
            self.models[name] = root
            self.objects |= {(name, item.get("id")): item for item in root.iterfind("{*}resources/{*}object")}
        return self.models[name]

    def _check_required(self, root: Element, name: str) -> None:
        """Refuse extensions that are required and not read; prefixes are looked up in the text of the part."""
        prefixes = root.get("requiredextensions", "").split()
        if not prefixes:
            return
        with self.archive.open(self.members[name]) as stream:
            spaces = {
                prefix: space for _, (prefix, space) in ElementTree.iterparse(stream, ("start-ns",))
            }  # the root's come first, and no other part of a model may change them
        for prefix in prefixes:
            space = spaces.get(prefix, prefix)
            if not (space.startswith(_CORE) or any(part in space for part in _READ)):
                raise BadInputError(
                    f"{self.name}: requires the extension {space[:80]}, which is not read; export it as a plain mesh"
                )

    def built(self) -> _Parts:
        """Meshes of all items of the build."""
        items = self.model(self.root).iterfind("{*}build/{*}item")
        return [part for item in items for part in self._used(item, self.root, _MAX_DEPTH)]

    def _used(self, use: Element, model: str, depth: int) -> _Parts:
        """Meshes of the object that a build item or component uses, moved by that use's transform."""
        model = _plain(use.get(_PATH, "")) or model
        self.model(model)
        item = self.objects.get((model, use.get("objectid")))
        if item is None or depth == 0:
            raise ValueError("an object is missing or contains itself")
        self.uses += 1
        if self.uses > _MAX_USES:
            raise ValueError(f"it uses objects more than {_MAX_USES} times")
        if item.get("type") in _SUPPORTS:
            self.supports += 1
            return []
        mesh, inner = item.find("{*}mesh"), item.find("{*}components")
        if mesh is not None:
            parts = [_mesh(mesh)]
        else:
            parts = [] if inner is None else [part for each in inner for part in self._used(each, model, depth - 1)]
            self.empty += inner is None
        text = use.get("transform")
        return parts if text is None else [_moved(part, text) for part in parts]


def _plain(name: str) -> str:
    """A member's name without its first slash, in lower case: names of parts do not tell cases apart."""
    return name.lstrip("/").lower()


def _moved(part: tuple[Floats, Ints], transform: str) -> tuple[Floats, Ints]:
    """A mesh moved by a transform of twelve numbers; one that mirrors turns the triangles."""
    matrix = np.array(transform.split(), dtype=np.float64).reshape(4, 3)
    points, faces = part
    return points @ matrix[:3] + matrix[3], faces[:, ::-1] if np.linalg.det(matrix[:3]) < 0.0 else faces


def _mesh(mesh: Element) -> tuple[Floats, Ints]:
    """Arrays of one mesh element."""
    points = [[vertex.get(axis) for axis in "xyz"] for vertex in mesh.iterfind("{*}vertices/{*}vertex")]
    faces = [[face.get(corner) for corner in ("v1", "v2", "v3")] for face in mesh.iterfind("{*}triangles/{*}triangle")]
    triangles = np.array(faces, dtype=np.float64).reshape(-1, 3).astype(np.int64)
    if len(triangles) and (triangles.min() < 0 or triangles.max() >= len(points)):
        raise ValueError("a triangle refers to a vertex that does not exist")
    return np.array(points, dtype=np.float64).reshape(-1, 3), triangles
