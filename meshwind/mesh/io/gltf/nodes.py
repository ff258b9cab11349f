"""Nodes of glTF files: which of them are shown, and where they place their meshes (sections 3.4, 3.5 and 3.7.3)."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from meshwind.core.cast import Floats
from meshwind.mesh.io.gltf.accessors import Accessors
from meshwind.mesh.io.gltf.document import INSTANCING, VISIBILITY, Document, numbers, table, whole

_MAX_DEPTH, _MAX_VISITS, _MAX_INSTANCES = 1000, 20_000, 200_000
"""Levels of nodes within nodes, visits beyond one of each node, and instances at a node.

The specification allows a node one parent; some programs use a node under several, but not without end.
"""
_INSTANCE = {"TRANSLATION": ("translation", "VEC3"), "ROTATION": ("rotation", "VEC4"), "SCALE": ("scale", "VEC3")}


class Nodes:
    """The nodes of the scene that a file shows.

    seen: the nodes of the scene, hidden: those of them that are not visible; note: on the choice of the scene, "" if
    the file makes it.
    """

    def __init__(self, document: Document, accessors: Accessors) -> None:
        self.document, self.accessors, self.note = document, accessors, ""
        self.seen: set[int] = set()
        self.hidden: set[int] = set()
        self.parents: dict[int, int] = {}
        for number in range(len(document.entries("nodes"))):
            for child in self._children(document.entry("nodes", number)):
                self.parents.setdefault(child, number)

    def shown(self) -> Iterator[tuple[dict[str, Any], Floats]]:
        """Every visible node with its matrix (4, 4) to the scene, those above before those below."""
        stack = [(root, np.eye(4), 0, True) for root in reversed(self._roots())]
        visits, most = 0, len(self.document.entries("nodes")) + _MAX_VISITS
        while stack:
            number, above, depth, visible = stack.pop()
            visits += 1
            if depth > _MAX_DEPTH or visits > most:
                raise ValueError("its nodes contain themselves, or each other too often or too deep")
            node = self.document.entry("nodes", number)
            held = table(self.document.extensions(node).get(VISIBILITY, {}), VISIBILITY)
            visible = visible and held.get("visible", True) is not False
            matrix = above @ node_matrix(node)
            self.seen.add(number)
            if visible:
                yield node, matrix
            else:
                self.hidden.add(number)
            stack += [(child, matrix, depth + 1, visible) for child in reversed(self._children(node))]

    def instances(self, node: dict[str, Any]) -> list[Floats]:
        """Matrices of a node's instances by EXT_mesh_gpu_instancing, which replace the mesh itself."""
        found = self.document.extensions(node).get(INSTANCING)
        if found is None:
            return [np.eye(4)]
        attributes = table(table(found, INSTANCING).get("attributes", {}), "an instance's attributes")
        given = {
            name: self.accessors.values(attributes[key], kind)
            for key, (name, kind) in _INSTANCE.items()
            if key in attributes
        }
        counts = {len(values) for values in given.values()}
        if len(counts) > 1:
            raise ValueError("attributes of instances are not equally many")
        if max(counts, default=0) > _MAX_INSTANCES:
            raise ValueError(f"a node has more than {_MAX_INSTANCES} instances")
        if not given:
            return [np.eye(4)]
        return [node_matrix({name: values[k] for name, values in given.items()}) for k in range(counts.pop())]

    def joints(self, skin: dict[str, Any]) -> Floats:
        """Matrices (joints, 4, 4) of a skin's joints: they move a vertex as it is bound to where the joint has it."""
        joints = skin.get("joints")
        if not isinstance(joints, list) or not joints:
            raise ValueError("a skin has no joints")
        matrices = np.array([self._to_scene(whole(joint, "a joint")) for joint in joints])
        if "inverseBindMatrices" not in skin:
            return matrices
        bound = self.accessors.values(skin["inverseBindMatrices"], "MAT4")
        if len(bound) < len(joints):
            raise ValueError(f"a skin has {len(bound)} matrices for {len(joints)} joints")
        return np.asarray(matrices @ bound[: len(joints)].reshape(-1, 4, 4).transpose(0, 2, 1))

    def _to_scene(self, number: int) -> Floats:
        """Matrix of a node by way of all the nodes above it."""
        matrix = node_matrix(self.document.entry("nodes", number))
        for _ in range(_MAX_DEPTH):
            if number not in self.parents:
                return matrix
            number = self.parents[number]
            matrix = node_matrix(self.document.entry("nodes", number)) @ matrix
        raise ValueError("its nodes contain themselves")

    def _children(self, node: dict[str, Any]) -> list[int]:
        children = node.get("children", [])
        if not isinstance(children, list):
            raise ValueError("the children of a node are no list")
        return [whole(child, "a child") for child in children]

    def _roots(self) -> list[int]:
        """Roots of the scene that the file shows; the first one if it names none, all nodes if it has no scenes."""
        scenes = self.document.entries("scenes")
        if not scenes:
            return [number for number in range(len(self.document.entries("nodes"))) if number not in self.parents]
        if len(scenes) > 1 and "scene" not in self.document.tree:
            self.note = f"of its {len(scenes)} scenes the first is read, as it does not say which one to show"
        scene = self.document.entry("scenes", self.document.tree.get("scene", 0))
        roots = self._children({"children": scene.get("nodes", [])})
        for root in roots:
            if root in self.parents and self.parents[root] != root:
                raise ValueError(f"its scene lists node {root}, which is inside node {self.parents[root]}")
        return roots


def node_matrix(node: dict[str, Any]) -> Floats:
    """Matrix (4, 4) of a node: its columns one after the other, or translation, rotation and scale (clause 3.5.3)."""
    if "matrix" in node:
        given = numbers(node["matrix"], 16, "a node's matrix").reshape(4, 4).T
        if not np.array_equal(given[3], [0.0, 0.0, 0.0, 1.0]):
            raise ValueError("the last row of a node's matrix is not 0 0 0 1")
        return given
    matrix = np.eye(4)
    turn = numbers(node.get("rotation", (0.0, 0.0, 0.0, 1.0)), 4, "a rotation")
    length = float(np.abs(turn).max())
    if length == 0.0:
        raise ValueError("a rotation is zero")
    turn = turn / length
    x, y, z, w = turn / np.linalg.norm(turn)
    matrix[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    matrix[:3, :3] *= numbers(node.get("scale", (1.0, 1.0, 1.0)), 3, "a scale")
    matrix[:3, 3] = numbers(node.get("translation", (0.0, 0.0, 0.0)), 3, "a translation")
    return matrix
