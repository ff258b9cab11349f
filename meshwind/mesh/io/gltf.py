"""Reading of GLB and GLTF files by the glTF 2.0 specification; its section numbers are cited."""

import base64
import binascii
import json
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.gltf_accessors import Accessors

_UNDERSTOOD = ("KHR_mesh_quantization", "EXT_mesh_gpu_instancing", "KHR_materials_", "KHR_texture_", "EXT_texture_",
               "KHR_lights_", "MSFT_texture_", "KHR_node_selectability", "KHR_node_hoverability")  # fmt: skip
"""Beginnings of the extensions that are read, or that say nothing of the shape."""
_INSTANCING = "EXT_mesh_gpu_instancing"
_COMPRESSED = ("KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression")
_MAX_DEPTH, _MAX_USES = 64, 20_000
"""Levels of nodes within nodes and uses of meshes: more are taken for nodes that contain themselves."""
_JSON, _BIN = 0x4E4F534A, 0x004E4942
_STRIP, _FAN = 5, 6


def read_gltf(path: Path) -> FileMesh:
    """Vertices and triangles of the scene that the file shows, in metres (section 3.4)."""
    scene, chunk = _opened(path)
    _check(path.name, scene)
    return _Scene(path, scene, chunk).surface()


def _opened(path: Path) -> tuple[dict[str, Any], bytes]:
    """The JSON of a file, and the binary chunk of a GLB file (section 4.4)."""
    content = path.read_bytes()
    chunk = b""
    if content[:4] == b"glTF":
        version, length = struct.unpack_from("<II", content, 4)
        if version != 2:
            raise BadInputError(f"{path.name}: is glTF {version}, and glTF 2.0 is read; export it again as glTF 2.0")
        if length > len(content):
            raise BadInputError(f"{path.name}: is cut short: {len(content)} of {length} bytes; copy or export it again")
        text, at = b"", 12
        while at + 8 <= length:
            size, kind = struct.unpack_from("<II", content, at)
            if at + 8 + size > length:
                raise ValueError("a chunk is longer than the file")
            held = content[at + 8 : at + 8 + size]
            text, chunk = (held, chunk) if kind == _JSON else (text, held if kind == _BIN and not chunk else chunk)
            at += 8 + size
        content = text
    scene = json.loads(content.decode("utf-8-sig"))
    if not isinstance(scene, dict):
        raise ValueError("its JSON is no object")
    return scene, chunk


def _check(name: str, scene: dict[str, Any]) -> None:
    """Refuse other versions, and extensions that are required and not read."""
    version = str(scene.get("asset", {}).get("version", ""))
    if not version.startswith("2."):
        raise BadInputError(f"{name}: is glTF {version[:20] or 'of no version'}, not 2.0; export it again as glTF 2.0")
    for extension in scene.get("extensionsRequired", []):
        if not str(extension).startswith(_UNDERSTOOD):
            what = "compressed geometry" if extension in _COMPRESSED else "it may change the shape"
            raise BadInputError(
                f"{name}: requires the extension {str(extension)[:60]} ({what}), which is not read; export it without"
            )


class _Scene:
    """The nodes of a file with their meshes."""

    def __init__(self, path: Path, scene: dict[str, Any], chunk: bytes) -> None:
        self.scene, self.name = scene, path.name
        self.accessors = Accessors(scene, _buffers(path, scene, chunk))
        self.parts: list[tuple[Floats, Ints]] = []
        self.meshes: dict[int, tuple[Floats, Ints]] = {}
        self.posed = 0

    def surface(self) -> FileMesh:
        """All triangles of the scene that is shown: the file's own choice, or else its first."""
        nodes = self.scene.get("nodes", [])
        scenes = self.scene.get("scenes", [])
        if scenes:
            roots = scenes[self.scene.get("scene", 0)].get("nodes", [])
        else:
            inner = {child for node in nodes for child in node.get("children", [])}
            roots = [number for number in range(len(nodes)) if number not in inner]
        used: set[int] = set()
        for root in roots:
            for number, matrix in self._placed(root, np.eye(4), _MAX_DEPTH):
                used.add(number)
                self._add(nodes[number], matrix)
        warnings = []
        others = sum("mesh" in node for number, node in enumerate(nodes) if number not in used)
        if others:
            warnings.append(f"{others} of the file's nodes with a mesh are not in the scene that it shows; left out")
        if self.posed:
            warnings.append(f"the pose of a skeleton is not applied to {self.posed} of the file's meshes")
        if not self.parts:
            return FileMesh(np.empty((0, 3)), np.empty((0, 3), dtype=np.int64), "m", tuple(warnings))
        starts = np.cumsum([0] + [len(points) for points, _ in self.parts[:-1]])
        faces = [triangles + start for (_, triangles), start in zip(self.parts, starts, strict=True)]
        points = np.concatenate([points for points, _ in self.parts])
        return FileMesh(points, np.concatenate(faces), "m", tuple(warnings))

    def _placed(self, number: int, above: Floats, depth: int) -> Iterator[tuple[int, Floats]]:
        """A node and those below it, each with its matrix (4, 4) to the scene."""
        if depth == 0:
            raise ValueError("its nodes contain themselves")
        node = self.scene["nodes"][number]
        if node.get("extensions", {}).get("KHR_node_visibility", {}).get("visible", True) is False:
            return
        matrix = above @ _matrix(node)
        yield number, matrix
        for child in node.get("children", []):
            yield from self._placed(child, matrix, depth - 1)

    def _add(self, node: dict[str, Any], matrix: Floats) -> None:
        """Add a node's mesh, once for each of its instances."""
        if "mesh" not in node:
            return
        points, faces = self._mesh(node)
        if "skin" in node:
            self.posed += 1
        for instance in self._instances(node):
            if len(self.parts) >= _MAX_USES:
                raise ValueError(f"it shows meshes more than {_MAX_USES} times")
            to = matrix @ instance
            moved = points @ to[:3, :3].T + to[:3, 3]
            self.parts.append((moved, faces[:, ::-1] if np.linalg.det(to[:3, :3]) < 0.0 else faces))

    def _instances(self, node: dict[str, Any]) -> list[Floats]:
        """Matrices of the node's instances by EXT_mesh_gpu_instancing; one without it."""
        found = node.get("extensions", {}).get(_INSTANCING)
        if found is None:
            return [np.eye(4)]
        given = {key: self.accessors.values(number) for key, number in found["attributes"].items()}
        if not given:
            return [np.eye(4)]
        count = min(len(values) for values in given.values())
        names = {"TRANSLATION": "translation", "ROTATION": "rotation", "SCALE": "scale"}
        return [
            _matrix({name: given[key][k] for key, name in names.items() if key in given}) for k in range(count)
        ]  # fmt: skip

    def _mesh(self, node: dict[str, Any]) -> tuple[Floats, Ints]:
        """Vertices and triangles of a node's mesh, with its morph targets (section 3.7.2.2)."""
        number = node["mesh"]
        weights = node.get("weights")
        if weights is None and number in self.meshes:
            return self.meshes[number]
        mesh = self.scene["meshes"][number]
        morphed = mesh.get("weights", []) if weights is None else weights
        shown = [each for each in mesh["primitives"] if each.get("mode", 4) >= 4 and "POSITION" in each["attributes"]]
        parts = [self._primitive(primitive, morphed) for primitive in shown]
        if not parts:
            return np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)
        starts = np.cumsum([0] + [len(points) for points, _ in parts[:-1]])
        faces = np.concatenate([triangles + start for (_, triangles), start in zip(parts, starts, strict=True)])
        joined = np.concatenate([points for points, _ in parts]), faces
        if weights is None:
            self.meshes[number] = joined
        return joined

    def _primitive(self, primitive: dict[str, Any], weights: list[float]) -> tuple[Floats, Ints]:
        for extension in _COMPRESSED:
            held = self.scene["accessors"][primitive["attributes"]["POSITION"]]
            if extension in primitive.get("extensions", {}) and "bufferView" not in held:
                raise BadInputError(
                    f"{self.name}: holds its geometry compressed by {extension}, which is not read; export it without"
                )
        points = self.accessors.values(primitive["attributes"]["POSITION"])
        if points.shape[1:] != (3,):
            raise ValueError("positions are not in three dimensions")
        for target, weight in zip(primitive.get("targets", []), weights, strict=False):
            if weight and "POSITION" in target:
                points = points + float(weight) * self.accessors.values(target["POSITION"])
        if "indices" in primitive:
            nodes = self.accessors.values(primitive["indices"]).astype(np.int64).ravel()
        else:
            nodes = np.arange(len(points))
        if len(nodes) and nodes.max() >= len(points):
            raise ValueError("a triangle refers to a vertex that does not exist")
        return points, _triangles(nodes, primitive.get("mode", 4))


def _triangles(nodes: Ints, mode: int) -> Ints:
    """Triangles of a primitive (section 3.7.2.1)."""
    if mode == _STRIP:
        at = np.arange(max(len(nodes) - 2, 0))
        odd = at % 2
        return np.column_stack([nodes[at], nodes[at + 1 + odd], nodes[at + 2 - odd]])
    if mode == _FAN:
        return np.column_stack([nodes[1:-1], nodes[2:], np.full(max(len(nodes) - 2, 0), nodes[0] if len(nodes) else 0)])
    if len(nodes) % 3:
        raise ValueError("the number of a primitive's indices is no multiple of three")
    return nodes.reshape(-1, 3)


def _matrix(node: dict[str, Any]) -> Floats:
    """Matrix (4, 4) of a node: its columns one after the other, or translation, rotation and scale (section 3.5.3)."""
    if "matrix" in node:
        return np.array(node["matrix"], dtype=np.float64).reshape(4, 4).T
    matrix = np.eye(4)
    x, y, z, w = (float(value) for value in node.get("rotation", (0.0, 0.0, 0.0, 1.0)))
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= np.array(node.get("scale", (1.0, 1.0, 1.0)), dtype=np.float64)
    matrix[:3, 3] = node.get("translation", (0.0, 0.0, 0.0))
    return matrix


def _buffers(path: Path, scene: dict[str, Any], chunk: bytes) -> list[bytes]:
    """Contents of the buffers: the GLB chunk, data in the JSON, or files in the file's folder or below."""
    held = []
    for number, buffer in enumerate(scene.get("buffers", [])):
        uri = buffer.get("uri")
        if uri is None:
            content = chunk if number == 0 else b""
        elif uri.startswith("data:"):
            try:
                content = base64.b64decode(uri.partition(",")[2], validate=True)
            except binascii.Error as error:
                raise ValueError("a buffer is no base64") from error
        else:
            content = _beside(path, unquote(uri))
        size = buffer.get("byteLength", 0)
        if len(content) < size:
            raise BadInputError(
                f"{path.name}: buffer {number} has {len(content)} of {size} bytes; copy or export the mesh again"
            )
        held.append(content)
    return held


def _beside(path: Path, name: str) -> bytes:
    folder = path.parent.resolve()
    file = (folder / name).resolve()
    if not file.is_relative_to(folder):
        raise ValueError("it refers to a file outside its folder")
    if not file.is_file():
        raise BadInputError(f"{path.name}: its buffer {name[:80]} is not in its folder; put it there, or export as GLB")
    return file.read_bytes()
