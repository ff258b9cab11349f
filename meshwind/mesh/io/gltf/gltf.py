"""Reading of GLB and GLTF files by the glTF 2.0 specification; its section numbers are cited.

trimesh (5.2) takes normalised integers as they are stored and sparse values for zeros, leaves out instances, and does
not heed required extensions; VTK (9.7) reads neither quantised nor sparse positions, and beyond the end of a buffer.
"""

from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.units import OF_GLTF
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.gltf.accessors import Accessors
from meshwind.mesh.io.gltf.document import DRACO, MESHOPT, Document, is_harmless, numbers, table, whole
from meshwind.mesh.io.gltf.nodes import Nodes

_MAX_TRIANGLES = 50_000_000
"""Triangles of all uses of meshes together: a small file may use one very often."""
_TRIANGLES, _STRIP, _FAN = 4, 5, 6


def read_gltf(path: Path) -> FileMesh:
    """Vertices and triangles of the scene that the file shows, in metres (clause 3.3)."""
    return _Scene(Document(path)).surface()


@dataclass(frozen=True)
class _Shape:
    """Triangles of a primitive; joints (n, k) and their weights (n, k) are None where it is not bound to a skin."""

    points: Floats
    faces: Ints
    joints: Ints | None = None
    weights: Floats | None = None

    def placed(self, matrix: Floats) -> "_Shape":
        """The same moved by a matrix (4, 4); one that mirrors turns the triangles (clause 3.7.4)."""
        mirrors = np.linalg.det(matrix[:3, :3]) < 0.0
        return _Shape(self.points @ matrix[:3, :3].T + matrix[:3, 3], self.faces[:, ::-1] if mirrors else self.faces)

    def posed(self, matrices: Floats) -> "_Shape":
        """The same moved by the joints (clause 3.7.3.3)."""
        if self.joints is None or self.weights is None:
            raise ValueError("a mesh of a skin has no joints and weights")
        if len(self.joints) and self.joints.max() >= len(matrices):
            raise ValueError(f"a vertex is bound to joint {self.joints.max()} of {len(matrices)} (0 is the first)")
        points = np.zeros_like(self.points)
        for joint, weight in zip(self.joints.T, self.weights.T, strict=True):
            moved = np.einsum("nij,nj->ni", matrices[joint, :3, :3], self.points) + matrices[joint, :3, 3]
            points += weight[:, None] * moved
        mirrors = np.linalg.det(matrices[0, :3, :3]) < 0.0
        return _Shape(points, self.faces[:, ::-1] if mirrors else self.faces)


class _Scene:
    """The scene of a file, with a count of what is not read."""

    def __init__(self, document: Document) -> None:
        self.document, self.accessors = document, Accessors(document)
        self.nodes = Nodes(document, self.accessors)
        self.parts: list[_Shape] = []
        self.triangles = 0
        self.used: set[int] = set()
        self.meshes: dict[int, list[_Shape]] = {}
        self.without_positions: set[int] = set()
        self.unknown: Counter[str] = Counter()

    def surface(self) -> FileMesh:
        """All triangles of the scene that is shown, and of all meshes if there are no nodes."""
        for node, matrix in self.nodes.shown():
            self._heed(node)
            if "mesh" in node:
                self._add(node, matrix)
        if not self.document.entries("nodes"):
            for number in range(len(self.document.entries("meshes"))):
                self._keep([shape.placed(np.eye(4)) for shape in self._mesh({"mesh": number})])
        warnings = self._warnings()
        if not self.parts:
            found = f" ({'; '.join(warnings)})"[:200] if warnings else ""
            raise BadInputError(
                f"{self.document.name}: holds no triangles in the scene that it shows{found}; export the part's mesh"
            )
        starts = np.cumsum([0] + [len(part.points) for part in self.parts[:-1]])
        faces = [part.faces + start for part, start in zip(self.parts, starts, strict=True)]
        points = np.concatenate([part.points for part in self.parts])
        return FileMesh(points, np.concatenate(faces), "m", warnings, OF_GLTF)

    def _warnings(self) -> tuple[str, ...]:
        """What of the file is not in the surface."""
        words = [self.nodes.note] if self.nodes.note else []
        with_mesh = {k for k, node in enumerate(self.document.entries("nodes")) if "mesh" in table(node, "a node")}
        others, hidden = with_mesh - self.nodes.seen, with_mesh & self.nodes.hidden
        if others:
            words.append(f"nodes with a mesh that are not in the scene that it shows are left out: {len(others)}")
        if hidden:
            words.append(f"nodes with a mesh that are hidden (KHR_node_visibility) are left out: {len(hidden)}")
        meshes = self.document.entries("meshes")
        placed = {whole(self.document.entry("nodes", k)["mesh"], "a mesh's number") for k in with_mesh} | self.used
        if len(placed) < len(meshes):
            words.append(f"meshes that no node places are left out: {len(meshes) - len(placed)}")
        if self.without_positions:
            words.append(f"parts of meshes without positions are left out: {len(self.without_positions)}")
        words += [
            f"the extension {name[:40]} is not known and not heeded; nodes and meshes that carry it: {count}"
            for name, count in sorted(self.unknown.items())
        ]
        return tuple(words)

    def _heed(self, held: dict[str, Any]) -> None:
        """Count an entry's extensions that are not known; compressed data are dealt with where they are read."""
        names = self.document.extensions(held)
        self.unknown.update(name for name in names if not (is_harmless(name) or name == DRACO or name in MESHOPT))

    def _add(self, node: dict[str, Any], matrix: Floats) -> None:
        """Add a node's mesh, once for each of its instances."""
        shapes = self._mesh(node)
        if not shapes:
            return
        if "skin" in node:  # "the transform of the skinned mesh node MUST be ignored", clause 3.7.3.2
            joints = self.nodes.joints(self.document.entry("skins", node["skin"]))
            self._keep([shape.posed(joints) for shape in shapes])
            return
        for instance in self.nodes.instances(node):
            self._keep([shape.placed(matrix @ instance) for shape in shapes])

    def _keep(self, shapes: list[_Shape]) -> None:
        self.triangles += sum(len(shape.faces) for shape in shapes)
        if self.triangles > _MAX_TRIANGLES:
            raise ValueError(f"its scene has more than {_MAX_TRIANGLES} triangles")
        self.parts += shapes

    def _mesh(self, node: dict[str, Any]) -> list[_Shape]:
        """Triangles of a node's mesh in the state of its morph targets (clause 3.7.2.2)."""
        number = whole(node["mesh"], "a mesh's number")
        mesh = self.document.entry("meshes", number)
        own = node.get("weights")
        if own is None and number in self.meshes:
            return self.meshes[number]
        if number not in self.used:
            self._heed(mesh)
        self.used.add(number)
        given = numbers(mesh.get("weights", []) if own is None else own, -1, "the weights of morph targets")
        primitives = mesh.get("primitives")
        if not isinstance(primitives, list):
            raise ValueError(f"mesh {number} has no primitives")
        shapes = [self._primitive(table(each, "a primitive"), given, number) for each in primitives]
        kept = [shape for shape in shapes if shape is not None and len(shape.faces)]
        if own is None:
            self.meshes[number] = kept
        return kept

    def _primitive(self, primitive: dict[str, Any], weights: Floats, mesh: int) -> _Shape | None:
        """Triangles of a primitive, None for points, lines and one without positions."""
        mode = whole(primitive.get("mode", _TRIANGLES), "a primitive's mode")
        if mode > _FAN:
            raise ValueError(f"the mode of a primitive is {mode}, which glTF does not know")
        if mode < _TRIANGLES:
            return None
        self._heed(primitive)
        attributes = table(primitive.get("attributes"), "the attributes of a primitive")
        if "POSITION" not in attributes:
            self.without_positions.add(id(primitive))
            return None
        self._check_data(primitive, attributes, mesh)
        points = self.accessors.values(attributes["POSITION"], "VEC3")
        targets = primitive.get("targets", [])
        if not isinstance(targets, list):
            raise ValueError("the morph targets of a primitive are no list")
        for target, weight in zip(targets, weights, strict=False):
            if weight and "POSITION" in table(target, "a morph target"):
                moves = self.accessors.values(target["POSITION"], "VEC3")
                if len(moves) != len(points):
                    raise ValueError(f"a morph target moves {len(moves)} of {len(points)} vertices")
                points = points + weight * moves
        indexed = "indices" in primitive
        nodes = self.accessors.indices(primitive["indices"]) if indexed else np.arange(len(points))
        if len(nodes) and (nodes.min() < 0 or nodes.max() >= len(points)):
            raise ValueError(f"a triangle refers to vertex {nodes.max()} of {len(points)} (0 is the first)")
        faces = _triangles(nodes, mode)
        joints, shares = self._bound(attributes, len(points))
        if len(points) <= len(nodes):
            return _Shape(points, faces, joints, shares)
        kept, inverse = np.unique(faces, return_inverse=True)  # many primitives may share one table of vertices
        return _Shape(
            points[kept], inverse.reshape(-1, 3), None if joints is None else joints[kept],
            None if shares is None else shares[kept],
        )  # fmt: skip

    def _check_data(self, primitive: dict[str, Any], attributes: dict[str, Any], mesh: int) -> None:
        """Refuse a primitive whose numbers are left to an extension; plain data may be there beside compressed."""
        needed = [attributes["POSITION"]] + ([primitive["indices"]] if "indices" in primitive else [])
        if all(self.accessors.has_data(number) for number in needed):
            return
        if DRACO in self.document.extensions(primitive):
            self.document.compressed(DRACO)
        raise BadInputError(
            f"{self.document.name}: the numbers of mesh {mesh} are not in the file (an accessor without a buffer); "
            "export it again"
        )

    def _bound(self, attributes: dict[str, Any], count: int) -> tuple[Ints | None, Floats | None]:
        """Joints (n, k) and weights (n, k) of all sets, None if there are none; the weights of a vertex add up to 1."""
        joints: list[Ints] = []
        shares: list[Floats] = []
        while f"JOINTS_{len(joints)}" in attributes and f"WEIGHTS_{len(joints)}" in attributes:
            joint = self.accessors.indices(attributes[f"JOINTS_{len(joints)}"])
            shares.append(self.accessors.values(attributes[f"WEIGHTS_{len(joints)}"], "VEC4"))
            joints.append(joint.reshape(-1, 4))
            if len(joints[-1]) != count or len(shares[-1]) != count:
                raise ValueError("joints and weights are not as many as the vertices")
        if not joints:
            return None, None
        weights = np.concatenate(shares, axis=1)
        total = weights.sum(axis=1, keepdims=True)
        if not (np.isfinite(total) & (total > 0.0)).all():
            raise ValueError("the weights of a vertex add up to nothing")
        return np.concatenate(joints, axis=1), weights / total


def _triangles(nodes: Ints, mode: int) -> Ints:
    """Triangles of a primitive (clause 3.7.2.1)."""
    if mode == _STRIP:
        at = np.arange(max(len(nodes) - 2, 0))
        odd = at % 2
        found = np.column_stack([nodes[at], nodes[at + 1 + odd], nodes[at + 2 - odd]])
        repeats = found == np.roll(found, 1, axis=1)  # strips are joined by corners that are given twice
        return found[~repeats.any(axis=1)]
    if mode == _FAN:
        first = np.broadcast_to(nodes[:1], max(len(nodes) - 2, 0))
        return np.column_stack([nodes[1:-1], nodes[2:], first])
    if len(nodes) % 3:
        raise ValueError(f"a primitive of triangles has {len(nodes)} corners, which is no multiple of three")
    return nodes.reshape(-1, 3)
