"""One model part of a 3MF file: its unit, objects and build, read from the XML in one pass."""

from dataclasses import dataclass, field
from typing import IO
from xml.parsers import expat

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.threemf.package import parse, plain_name

_PRODUCTION = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06}"
_ALTERNATIVES = "http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04}"
_SLICE = "http://schemas.microsoft.com/3dmanufacturing/slice/2015/07}"
_HARMLESS = ("vertices", "triangles", "trianglesets", "volumedata", "metadatagroup", "alternatives")
"""Elements of an object or a mesh that are read, or that say nothing of its shape."""
_CORNERS = ("v1", "v2", "v3")


@dataclass(frozen=True)
class Use:
    """That a build item, a component or an alternative uses an object: its id, its part or "", and a transform."""

    object_id: str
    part: str
    transform: str = ""
    is_printed: bool = True


@dataclass
class Solid:
    """An object: its mesh or its components.

    type: as in the core specification, chapter 4; unread: elements that may be its shape, and are not known;
    resolution: "fullres", or what kind of stand-in for another shape it is; alternatives: of full resolution.
    """

    type: str
    resolution: str
    vertices: Floats = field(default_factory=lambda: np.empty((0, 3)))
    faces: Ints = field(default_factory=lambda: np.empty((0, 3), dtype=np.int64))
    components: list[Use] = field(default_factory=list)
    alternatives: list[Use] = field(default_factory=list)
    unread: list[str] = field(default_factory=list)
    is_mesh: bool = False


@dataclass
class ModelPart:
    """What is in a model part.

    unit: as the core specification has it where the part names none; required: the namespaces of the extensions that
    the part requires.
    """

    unit: str = "millimeter"
    names_unit: bool = False
    required: list[str] = field(default_factory=list)
    objects: dict[str, Solid] = field(default_factory=dict)
    build: list[Use] = field(default_factory=list)


def read_model(part: IO[bytes], name: str) -> ModelPart:
    """Read a model part.  Raises ValueError if it is damaged."""
    reader = _Reader(name)
    parser = expat.ParserCreate(namespace_separator="}")
    parser.StartNamespaceDeclHandler = reader.space
    parser.StartElementHandler = reader.start
    parser.EndElementHandler = reader.end
    parse(parser, part, name)
    return reader.model


class _Reader:
    """Handlers of the parser; only elements of the root's own namespace are taken for those of the core."""

    def __init__(self, name: str) -> None:
        self.name, self.model, self.spaces = name, ModelPart(), dict[str, str]()
        self.path: list[str] = []
        self.core = self.vertex = self.triangle = ""
        self.solid: Solid | None = None
        self.numbers: list[str] = []
        self.corners: list[str] = []

    def space(self, prefix: str | None, uri: str | None) -> None:
        """A declaration of a namespace; those of the root come first, and only these are kept."""
        if not self.path:
            self.spaces[prefix or ""] = uri or ""

    def start(self, tag: str, attributes: dict[str, str]) -> None:
        """Start of an element; vertices and triangles come first, as there are many."""
        try:
            if tag == self.triangle and self.path[-1] == "triangles":
                self.corners.extend((attributes["v1"], attributes["v2"], attributes["v3"]))
                return
            if tag == self.vertex and self.path[-1] == "vertices":
                self.numbers.extend((attributes["x"], attributes["y"], attributes["z"]))
                return
        except KeyError as error:
            raise ValueError(f"a {self._local(tag)} of {self.name[:60]} has no {error}") from error
        if not self.path:
            self._root(tag, attributes)
        own = self._local(tag)
        self._element(own, tag, attributes)
        self.path.append(own)

    def end(self, tag: str) -> None:
        """End of an element."""
        if tag == self.triangle and self.path[-1] == "triangles":
            return
        if tag == self.vertex and self.path[-1] == "vertices":
            return
        if self.path.pop() == "mesh" and self.path[-1:] == ["object"] and self.solid is not None:
            self.solid.vertices, self.solid.faces = _arrays(self.numbers, self.corners, self.name)
            self.solid.is_mesh = True
            self.numbers, self.corners = [], []

    def _local(self, tag: str) -> str:
        """Name of an element of the core namespace, the whole tag of any other."""
        return tag.removeprefix(self.core) if tag.startswith(self.core) else tag

    def _root(self, tag: str, attributes: dict[str, str]) -> None:
        space, _, own = tag.rpartition("}")
        if own != "model":
            raise ValueError(f"{self.name[:60]} is no model but {own[:40]!r}")
        self.core = space + "}" if space else ""
        self.vertex, self.triangle = self.core + "vertex", self.core + "triangle"
        self.model.unit, self.model.names_unit = attributes.get("unit", self.model.unit), "unit" in attributes
        self.model.required = [
            self.spaces.get(prefix, prefix) for prefix in attributes.get("requiredextensions", "").split()
        ]

    def _element(self, own: str, tag: str, attributes: dict[str, str]) -> None:
        """Keep what an element says, by where it is."""
        inside = self.path[1:]
        if own == "object" and inside == ["resources"]:
            self._object(attributes)
        elif own == "item" and inside == ["build"]:
            self.model.build.append(_use(attributes))
        elif self.solid is None or inside[:2] != ["resources", "object"]:
            return
        elif own == "component" and inside[2:] == ["components"]:
            self.solid.components.append(_use(attributes))
        elif tag == _ALTERNATIVES + "alternative":
            if attributes.get("modelresolution", "fullres") == "fullres":
                self.solid.alternatives.append(_use(attributes))
        elif inside[2:] in ([], ["mesh"]):
            last = own.rpartition("}")[2]
            if last not in _HARMLESS and own not in ("mesh", "components"):
                self.solid.unread.append(last)

    def _object(self, attributes: dict[str, str]) -> None:
        key = attributes.get("id", "")
        if key in self.model.objects:
            raise ValueError(f"{self.name[:60]} has two objects of the id {key[:20]!r}")
        resolution = attributes.get(_ALTERNATIVES + "modelresolution", "fullres")
        if resolution == "fullres":
            resolution = attributes.get(_SLICE + "meshresolution", "fullres")
        self.solid = self.model.objects[key] = Solid(attributes.get("type", "model"), resolution)


def _use(attributes: dict[str, str]) -> Use:
    """What an item, a component or an alternative uses; the path of an alternative has no namespace."""
    path = attributes.get(_PRODUCTION + "path", attributes.get("path", ""))
    return Use(
        attributes.get("objectid", ""),
        plain_name(path),
        attributes.get("transform", ""),
        attributes.get("printable", "1").strip() not in ("0", "false"),
    )


def _arrays(numbers: list[str], corners: list[str], name: str) -> tuple[Floats, Ints]:
    """Vertices and triangles of a mesh.  Raises ValueError if a triangle refers to a vertex that is not there."""
    try:
        vertices = np.array(list(map(float, numbers)), dtype=np.float64).reshape(-1, 3)
        indices = list(map(int, corners))
    except ValueError as error:
        wrong = str(error).rpartition(":")[2].strip()[:20]
        raise ValueError(f"a vertex or a triangle of {name[:40]} has {wrong}, where a number is needed") from error
    least, most = min(indices, default=0), max(indices, default=-1)
    if least < 0 or most >= len(vertices):
        wrong = str(least if least < 0 else most)[:20]
        raise ValueError(f"a triangle of {name[:40]} refers to vertex {wrong} of {len(vertices)} (0 is the first)")
    return vertices, np.array(indices, dtype=np.int64).reshape(-1, 3)
