"""Reading of GLB and GLTF files: numbers of every kind, nodes, instances, poses, and what is refused or said."""

import base64
import json
import struct
from copy import deepcopy
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scene_barrel import area, barrel, flow, said

from meshwind.core.cast import Floats
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.read import load

POINTS, FACES = barrel()
POINTS = (POINTS / 1000.0).astype("<f4").astype(np.float64)  # as single precision holds it
AREA = area(POINTS, FACES)
CODES = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126, "d": 5130}
Json = dict[str, Any]


class Scene:
    """A file in the making: its JSON, with one buffer that arrays are appended to."""

    def __init__(self) -> None:
        self.data = b""
        self.tree: Json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
                           "bufferViews": [], "accessors": [], "buffers": [{}]}  # fmt: skip
        where = self.accessor(POINTS, "f")
        self.tree["meshes"] = [
            {"primitives": [{"attributes": {"POSITION": where}, "indices": self.accessor(FACES, "H")}]}
        ]

    @property
    def primitive(self) -> Json:
        held: Json = self.tree["meshes"][0]["primitives"][0]
        return held

    def view(self, content: bytes, **more: object) -> int:
        self.data += b"\0" * (-len(self.data) % 4)
        self.tree["bufferViews"].append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(content)} | more)
        self.data += content
        return len(self.tree["bufferViews"]) - 1

    def accessor(self, values: Any, kind: str, shape: str = "", **more: object) -> int:
        """An accessor to an array of one row per element; indices are flat."""
        rows = np.asarray(values)
        flat = rows.ravel() if rows is FACES or (not shape and rows.dtype.kind == "i") else rows
        shape = shape or {3: "VEC3", 4: "VEC4", 1: "SCALAR"}[flat.shape[1] if flat.ndim == 2 else 1]
        where = self.view(flat.astype(f"<{kind}").tobytes())
        self.tree["accessors"].append({"bufferView": where, "componentType": CODES[kind], "count": len(flat),
                                       "type": shape} | more)  # fmt: skip
        return len(self.tree["accessors"]) - 1

    def text(self) -> bytes:
        tree = deepcopy(self.tree)
        tree["buffers"][0] = {"byteLength": len(self.data), "uri": "data:application/gltf-buffer;base64,"
                              + base64.b64encode(self.data).decode()} | tree["buffers"][0]  # fmt: skip
        return json.dumps(tree).encode()

    def save(self, folder: Path) -> Path:
        (folder / "part.gltf").write_bytes(self.text())
        return folder / "part.gltf"

    def glb(self, before: list[tuple[int, bytes]] = [], after: list[tuple[int, bytes]] = []) -> bytes:  # noqa: B006
        tree = json.dumps(self.tree | {"buffers": [{"byteLength": len(self.data)}, *self.tree["buffers"][1:]]}).encode()
        chunks = [(0x4E4F534A, tree + b" " * (-len(tree) % 4)), *before,
                  (0x004E4942, self.data + b"\0" * (-len(self.data) % 4)), *after]  # fmt: skip
        body = b"".join(struct.pack("<II", len(held), kind) + held for kind, held in chunks)
        return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def is_barrel(held: FileMesh, times: float = 1, sign: float = 1.0, scale: float = 1.0) -> bool:
    right = area(held.vertices, held.faces) == pytest.approx(times * AREA * scale**2, rel=1e-9)
    return right and len(held.faces) == times * len(FACES) and np.sign(flow(held)) == sign


def test_lengths_are_metres_as_written(tmp_path: Path) -> None:
    held = load(Scene().save(tmp_path))
    assert held.units == "m" and np.array_equal(held.vertices, POINTS) and np.array_equal(held.faces, FACES)
    assert held.warnings == ()


@pytest.mark.parametrize("kind", "bBhH")
@pytest.mark.parametrize("normalized", [True, False])
def test_quantised_positions(kind: str, normalized: bool, tmp_path: Path) -> None:
    """Rows of 4 or 8 bytes; what is meant is restored by the node's scale."""
    scene, most = Scene(), float(np.iinfo(kind).max)
    whole = np.round(POINTS / 0.06 * most + (0 if kind in "bh" else most / 2)).clip(0 if kind in "BH" else -most, most)
    rows = np.zeros((len(whole), 4))
    rows[:, :3] = whole
    where = scene.view(rows.astype(f"<{kind}").tobytes(), byteStride=4 * np.dtype(kind).itemsize)
    scene.tree["accessors"].append({"bufferView": where, "componentType": CODES[kind], "count": len(whole),
                                    "type": "VEC3", "normalized": normalized})  # fmt: skip
    scene.primitive["attributes"]["POSITION"] = 2
    scene.tree["nodes"][0]["scale"] = [0.06] * 3
    scene.tree["extensionsRequired"] = scene.tree["extensionsUsed"] = ["KHR_mesh_quantization"]
    held = load(scene.save(tmp_path))
    assert np.abs(held.vertices - 0.06 * whole / (most if normalized else 1.0)).max() < 1e-9 * max(1.0, most)


def test_normalised_integers_do_not_go_below_minus_one(tmp_path: Path) -> None:
    scene = Scene()
    rows = np.array([[-128, 0, 0, 0], [127, 0, 0, 0], [0, 127, 0, 0]])
    scene.primitive["attributes"]["POSITION"] = scene.accessor(rows[:, :3] + 0.0, "b", "VEC3", normalized=True)
    del scene.primitive["indices"]
    assert load(scene.save(tmp_path)).vertices.min() == -1.0


@pytest.mark.parametrize("kind", "BHI")
def test_indices_of_every_width(kind: str, tmp_path: Path) -> None:
    scene = Scene()
    scene.primitive["indices"] = scene.accessor(FACES, kind)
    assert is_barrel(load(scene.save(tmp_path)))
    scene.primitive["indices"] = scene.accessor(FACES + 10, kind)
    assert "refers to vertex 57 of 48" in said(scene.save(tmp_path))


@pytest.mark.parametrize("mode", [4, 5, 6])
@pytest.mark.parametrize("indexed", [True, False])
def test_strips_fans_and_plain_triangles(mode: int, indexed: bool, tmp_path: Path) -> None:
    """Each ring as a strip; a disc as a fan."""
    scene = Scene()
    if mode == 4:
        order, points, count = [FACES.ravel()], POINTS, len(FACES)
    elif mode == 5:
        pairs = [np.column_stack([np.arange(8) + 8 * k + 8, np.arange(8) + 8 * k]) for k in range(5)]
        order, points, count = [np.concatenate([p, p[:1]]).ravel() for p in pairs], POINTS, len(FACES)
    else:
        rim = np.arange(9) * 2 * np.pi / 8
        points = np.concatenate([[[0.0, 0, 0]], np.column_stack([np.cos(rim), np.sin(rim), 0 * rim])])
        order, count = [np.arange(10)], 8
    scene.tree["meshes"] = [{"primitives": []}]
    for nodes in order:
        held: Json = {
            "attributes": {"POSITION": scene.accessor(points if indexed else points[nodes], "f")},
            "mode": mode,
        }
        scene.tree["meshes"][0]["primitives"].append(
            held | ({"indices": scene.accessor(nodes, "H")} if indexed else {})
        )
    mesh = load(scene.save(tmp_path))
    assert len(mesh.faces) == count
    if mode == 6:
        corners = mesh.vertices[mesh.faces]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert normals[:, 2] == pytest.approx(np.full(8, np.sin(np.pi / 4)), rel=1e-6)
    else:
        assert is_barrel(mesh)


def test_points_and_lines_are_left_alone_and_nothing_else_is_no_mesh(tmp_path: Path) -> None:
    scene = Scene()
    lines = [deepcopy(scene.primitive) | {"mode": mode} for mode in range(4)]
    scene.tree["meshes"][0]["primitives"] += lines
    held = load(scene.save(tmp_path))
    assert is_barrel(held) and held.warnings == ()
    scene.tree["meshes"][0]["primitives"] = lines
    assert "holds no triangles in the scene" in said(scene.save(tmp_path))
    scene.tree["meshes"][0]["primitives"] = [{"attributes": {}}, lines[0] | {"mode": 4}]
    assert load(scene.save(tmp_path)).warnings == ("parts of meshes without positions are left out: 1",)
    scene.tree["meshes"][0]["primitives"] = [lines[0] | {"mode": 9}]
    assert "mode of a primitive is 9" in said(scene.save(tmp_path))


def test_rows_that_lie_apart(tmp_path: Path) -> None:
    scene = Scene()
    rows = np.concatenate([np.full((48, 3), 7.0), POINTS, np.full((48, 2), 9.0)], axis=1)
    where = scene.view(rows.astype("<f4").tobytes(), byteStride=32)
    scene.tree["accessors"].append({"bufferView": where, "byteOffset": 12, "componentType": 5126, "count": 48,
                                    "type": "VEC3"})  # fmt: skip
    scene.primitive["attributes"] = {"POSITION": 2}
    assert is_barrel(load(scene.save(tmp_path)))
    scene.tree["accessors"][2]["count"] = 49
    assert "an accessor needs 1560 bytes of a view of 1536" in said(scene.save(tmp_path))


@pytest.mark.parametrize("base", [True, False])
def test_sparse_numbers(base: bool, tmp_path: Path) -> None:
    scene = Scene()
    rows = np.arange(0, 48, 2) if base else np.arange(48)
    wrong = POINTS.copy()
    wrong[rows] = 9.0
    spot = scene.accessor(wrong, "f")
    held = scene.tree["accessors"][spot]
    if not base:
        del held["bufferView"]
    places, new = scene.view(rows.astype("<u2").tobytes()), scene.view(POINTS[rows].astype("<f4").tobytes())
    held["sparse"] = {"count": len(rows), "indices": {"bufferView": places, "componentType": 5123},
                      "values": {"bufferView": new}}  # fmt: skip
    scene.primitive["attributes"]["POSITION"] = spot
    assert np.array_equal(load(scene.save(tmp_path)).vertices, POINTS)
    held["count"] = 24
    assert "replaces number" in said(scene.save(tmp_path))


def test_numbers_that_are_not_in_the_file_are_refused(tmp_path: Path) -> None:
    scene = Scene()
    del scene.tree["accessors"][0]["bufferView"]
    assert "the numbers of mesh 0 are not in the file" in said(scene.save(tmp_path))


@pytest.mark.parametrize("name", ["part.bin", "sub/a b.bin", "Teil ä.bin"])
def test_buffers_in_files_beside(name: str, tmp_path: Path) -> None:
    from urllib.parse import quote

    scene = Scene()
    (tmp_path / name).parent.mkdir(exist_ok=True)
    (tmp_path / name).write_bytes(scene.data)
    for uri in (quote(name), name):
        scene.tree["buffers"][0] = {"uri": uri}
        assert is_barrel(load(scene.save(tmp_path)))
    (tmp_path / name).write_bytes(scene.data[:-40])
    assert f"buffer 0 has {len(scene.data) - 40} of {len(scene.data)} bytes" in said(scene.save(tmp_path))
    (tmp_path / name).unlink()
    assert "is not in its folder" in said(scene.save(tmp_path))


@pytest.mark.parametrize(("uri", "words"), [
    ("http://example.com/a.bin", "is at an address"), ("file:///etc/hostname", "is at an address"),
    ("../a.bin", "outside its folder"), ("/etc/hostname", "outside its folder"), ("%2e%2e/a.bin", "outside its folder"),
    ("data:;base64,@@@@", "is no base64"), (7, "is no text"),
])  # fmt: skip
def test_other_addresses_are_not_opened(uri: Any, words: str, tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["buffers"][0] = {"uri": uri}
    assert words in said(scene.save(tmp_path))


@pytest.mark.parametrize(
    "head", ["data:application/octet-stream;base64,", "data:;base64,", "DATA:text/plain;a=b;base64,"]
)
def test_embedded_buffers_of_any_media_type(head: str, tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["buffers"][0] = {"uri": head + base64.b64encode(scene.data).decode()}
    assert is_barrel(load(scene.save(tmp_path)))
    plain = "data:application/octet-stream," + "".join(f"%{byte:02x}" for byte in scene.data)
    scene.tree["buffers"][0] = {"uri": plain}
    assert is_barrel(load(scene.save(tmp_path)))


def test_several_buffers(tmp_path: Path) -> None:
    scene = Scene()
    (tmp_path / "more.bin").write_bytes(FACES.astype("<u4").tobytes())
    scene.tree["buffers"] += [
        {"uri": "more.bin", "byteLength": 960},
        {"uri": "textures-are-not-needed.bin", "byteLength": 4},
    ]
    scene.tree["bufferViews"].append({"buffer": 1, "byteLength": 960})
    scene.tree["accessors"].append({"bufferView": 2, "componentType": 5125, "count": 240, "type": "SCALAR"})
    scene.primitive["indices"] = 2
    assert is_barrel(load(scene.save(tmp_path)))
    path = tmp_path / "part.glb"
    path.write_bytes(scene.glb())
    assert is_barrel(load(path))


def test_glb_with_unknown_chunks_and_bytes_after_its_end(tmp_path: Path) -> None:
    path, other = tmp_path / "part.glb", (0x12345678, b"????")
    for content in (Scene().glb(), Scene().glb(after=[other]), Scene().glb(before=[other]), Scene().glb() + b"more"):
        path.write_bytes(content)
        held = load(path)
        assert is_barrel(held) and held.units == "m"
    whole = Scene().glb()
    path.write_bytes(whole[:-30])
    assert f"cut short: {len(whole) - 30} of {len(whole)} bytes" in said(path)
    path.write_bytes(b"glTF" + struct.pack("<I", 3) + whole[8:])
    assert "is glTF 3" in said(path)
    path.write_bytes(whole[:16] + struct.pack("<I", 7) + whole[20:])
    assert "first chunk is no JSON" in said(path)


def turned(x: float, y: float, z: float, angle: float) -> Floats:
    """Quaternion of a turn about an axis of unit length."""
    return np.array([*(np.array([x, y, z]) * np.sin(angle / 2)), np.cos(angle / 2)])


def test_nodes_are_placed_by_matrices_and_by_parts(tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["nodes"] = [
        {"children": [1], "matrix": [0, 2, 0, 0, -2, 0, 0, 0, 0, 0, 2, 0, 5, 6, 7, 1]},
        {"mesh": 0, "translation": [1, 0, 0], "rotation": turned(1, 0, 0, np.pi / 2).tolist(), "scale": [1, 1, 3]},
    ]
    x, y, z = POINTS.T * np.array([[1], [1], [3]])
    x, y, z = x + 1, -z, y
    held = load(scene.save(tmp_path))
    assert np.abs(held.vertices - np.column_stack([-2 * y + 5, 2 * x + 6, 2 * z + 7])).max() < 1e-12


def test_negative_scales_turn_the_triangles(tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["nodes"] = [{"children": [1, 2], "scale": [1, -1, 1]}, {"mesh": 0}, {"mesh": 0, "scale": [-1, 1, 1]}]
    held = load(scene.save(tmp_path))
    assert is_barrel(held, 2)
    for part in (held.faces[:80], held.faces[80:]):
        assert flow(FileMesh(held.vertices, part)) > 0.0


def test_the_scene_that_the_file_shows(tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["nodes"] = [{"mesh": 0, "scale": [3, 3, 3]}, {"mesh": 0}, {"mesh": 0, "translation": [9, 0, 0]}]
    scene.tree["scenes"] = [{"nodes": [0]}, {"nodes": [1]}]
    scene.tree["scene"] = 1
    left = "nodes with a mesh that are not in the scene that it shows are left out: 2"
    held = load(scene.save(tmp_path))
    assert is_barrel(held) and held.warnings == (left,)
    del scene.tree["scene"]
    held = load(scene.save(tmp_path))
    assert is_barrel(held, scale=3.0)
    assert held.warnings == ("of its 2 scenes the first is read, as it does not say which one to show", left)
    scene.tree["scenes"] = []
    assert len(load(scene.save(tmp_path)).faces) == 240
    del scene.tree["nodes"]
    assert is_barrel(load(scene.save(tmp_path)))
    scene = Scene()
    scene.tree["meshes"].append(scene.tree["meshes"][0])
    assert load(scene.save(tmp_path)).warnings == ("meshes that no node places are left out: 1",)


def test_nodes_within_themselves_are_refused(tmp_path: Path) -> None:
    scene = Scene()
    for nodes, words in (
        ([{"children": [1], "mesh": 0}, {"children": [0]}], "its scene lists node 0, which is inside node 1"),
        ([{"children": [0], "mesh": 0}], "its nodes contain themselves"),
        ([{"children": [1]}, {"children": [2]}, {"children": [1], "mesh": 0}], "its nodes contain themselves"),
        ([{"children": [5]}], "refers to number 5 of its 1 nodes"),
    ):
        scene.tree["nodes"] = nodes
        assert words in said(scene.save(tmp_path))
    deep: list[Json] = [{"children": [k + 1]} for k in range(300)]
    scene.tree["nodes"] = [*deep, {"mesh": 0}]
    assert is_barrel(load(scene.save(tmp_path)))


@pytest.mark.parametrize("kind", "fbh")
def test_instances(kind: str, tmp_path: Path) -> None:
    """Their turns may be normalised integers; the mesh itself is not shown beside them."""
    scene, most = Scene(), 1.0 if kind == "f" else float(np.iinfo(kind).max)
    turns = np.array([[0, 0, 0, 1], turned(0, 0, 1, np.pi), [0, 0, 0, 1]])
    attributes = {
        "TRANSLATION": scene.accessor(np.array([[1.0, 0, 0], [0, 2, 0], [0, 0, 3]]), "f"),
        "ROTATION": scene.accessor(np.round(turns * most) if most > 1 else turns, kind, "VEC4", normalized=most > 1),
        "SCALE": scene.accessor(np.array([[1.0, 1, 1], [1, 1, 1], [2, 2, -2]]), "f"),
        "_ID": scene.accessor(np.array([[1.0], [2], [3]]), "f"),
    }
    scene.tree["nodes"][0] |= {
        "translation": [10, 0, 0],
        "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}},
    }
    scene.tree["extensionsRequired"] = ["EXT_mesh_gpu_instancing"]
    held = load(scene.save(tmp_path))
    right = [POINTS + [11, 0, 0], POINTS * [-1, -1, 1] + [10, 2, 0], POINTS * [2, 2, -2] + [10, 0, 3]]
    assert np.abs(held.vertices - np.concatenate(right)).max() < 1e-7 and len(held.faces) == 240
    assert np.array_equal(held.faces[160:] - 96, FACES[:, ::-1]) and held.warnings == ()
    scene.tree["accessors"][attributes["SCALE"]]["count"] = 2
    assert "not equally many" in said(scene.save(tmp_path))


@pytest.mark.parametrize(("of_mesh", "of_node", "result"), [
    (None, None, 0.0), ([0.5, 0.0], None, 0.5), ([0.5, 0.0], [0.0, 1.0], -1.0), ([0.5], [0, 0], 0.0),
    (None, [1, 0.25], 0.75),
])  # fmt: skip
def test_morph_targets_with_their_weights(of_mesh: Any, of_node: Any, result: float, tmp_path: Path) -> None:
    scene = Scene()
    up = scene.accessor(np.tile([0.0, 0.0, 0.5], (48, 1)), "f")
    down = scene.accessor(np.tile([0.0, 0.0, -0.5], (48, 1)), "f")
    scene.primitive["targets"] = [{"POSITION": up}, {"POSITION": down}]
    if of_mesh is not None:
        scene.tree["meshes"][0]["weights"] = of_mesh
    if of_node is not None:
        scene.tree["nodes"][0]["weights"] = of_node
    held = load(scene.save(tmp_path))
    assert np.abs(held.vertices - POINTS - [0, 0, result / 2]).max() < 1e-12


@pytest.mark.parametrize("kind", "fBH")
@pytest.mark.parametrize("bound", [True, False])
def test_skins_pose_the_mesh_and_its_node_does_not(kind: str, bound: bool, tmp_path: Path) -> None:
    """The lower half is bound to one joint, the upper to another, their border to both."""
    scene, most = Scene(), 1.0 if kind == "f" else float(np.iinfo(kind).max)
    joints, shares = np.zeros((48, 4)), np.zeros((48, 4))
    share = np.clip((POINTS[:, 2] - 0.02) / 0.02, 0, 1)
    joints[:, 1] = 1
    shares[:, 0], shares[:, 1] = most - np.round(share * most), np.round(share * most)
    if kind == "f":
        shares *= 0.98  # as exporters that cut off small weights leave them
    scene.primitive["attributes"] |= {
        "JOINTS_0": scene.accessor(joints, "B", "VEC4"),
        "WEIGHTS_0": scene.accessor(shares, kind, "VEC4", normalized=most > 1),
    }
    scene.tree["nodes"] = [
        {"children": [1, 3], "translation": [0, 0, 1]},
        {"children": [2], "scale": [2, 2, 2]},
        {"translation": [0.25, 0, 0]},
        {"mesh": 0, "skin": 0, "translation": [50, 0, 0]},
    ]
    scene.tree["skins"] = [{"joints": [1, 2]}]
    back = [0.0, 0, 0]
    if bound:
        back = [0.0, 0.125, 0]
        columns = np.tile(np.eye(4).ravel(), (2, 1))
        columns[1, 12:15] = back
        scene.tree["skins"][0]["inverseBindMatrices"] = scene.accessor(columns, "f", "MAT4")
    lower, upper = 2 * POINTS + [0, 0, 1], 2 * (POINTS + back) + [0.5, 0, 1]
    weight = (shares[:, 1] / shares.sum(axis=1))[:, None]
    held = load(scene.save(tmp_path))
    assert np.abs(held.vertices - (1 - weight) * lower - weight * upper).max() < 1e-7 and held.warnings == ()
    scene.tree["skins"][0]["joints"] = [1]
    assert "is bound to joint 1 of 1" in said(scene.save(tmp_path))


@pytest.mark.parametrize("name", ["KHR_draco_mesh_compression", "EXT_meshopt_compression", "KHR_meshopt_compression"])
def test_compressed_geometry_is_refused_by_name(name: str, tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["extensionsUsed"] = scene.tree["extensionsRequired"] = [name]
    text = said(scene.save(tmp_path))
    assert f"needs the extension {name} (compressed geometry), which is not read; export it without compression" in text


@pytest.mark.parametrize("plain", [True, False])
def test_draco_with_plain_numbers_beside_it(plain: bool, tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["extensionsUsed"] = ["KHR_draco_mesh_compression"]
    scene.primitive["extensions"] = {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 0}}}
    if plain:
        held = load(scene.save(tmp_path))
        assert is_barrel(held) and held.warnings == ()
        return
    for accessor in scene.tree["accessors"]:
        del accessor["bufferView"]
    assert "needs the extension KHR_draco_mesh_compression" in said(scene.save(tmp_path))


@pytest.mark.parametrize("plain", [True, False])
def test_meshopt_with_plain_numbers_beside_it(plain: bool, tmp_path: Path) -> None:
    scene, name = Scene(), "EXT_meshopt_compression"
    for view in scene.tree["bufferViews"]:
        view["extensions"] = {name: {"buffer": 1, "byteLength": 9, "byteStride": 12, "count": 48, "mode": "ATTRIBUTES"}}
        view["buffer"] = 0 if plain else 2
    scene.tree["buffers"] += [
        {"byteLength": 9},
        {"byteLength": len(scene.data), "extensions": {name: {"fallback": True}}},
    ]
    if plain:
        assert is_barrel(load(scene.save(tmp_path)))
    else:
        assert f"needs the extension {name}" in said(scene.save(tmp_path))


def test_required_extensions(tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["extensionsRequired"] = ["KHR_texture_transform", "KHR_materials_unlit", "EXT_texture_webp",
                                        "KHR_node_visibility"]  # fmt: skip
    assert is_barrel(load(scene.save(tmp_path)))
    for name in ("EXT_unheard_of", "KHR_draco", "CESIUM_RTC", "khr_materials_unlit"):
        scene.tree["extensionsRequired"] = ["KHR_materials_unlit", name]
        assert f"requires the extension {name}" in said(scene.save(tmp_path))


def test_extensions_that_are_not_known_are_named_where_they_matter(tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["extensionsUsed"] = ["X_bulge", "X_colour", "KHR_xmp_json_ld"]
    scene.tree["nodes"][0]["extensions"] = {"X_bulge": {}, "KHR_xmp_json_ld": {}}
    scene.primitive["extensions"] = {"X_bulge": {}}
    scene.tree["materials"] = [{"extensions": {"X_colour": {}}}]
    held = load(scene.save(tmp_path))
    words = "the extension X_bulge is not known and not heeded; nodes and meshes that carry it: 2"
    assert is_barrel(held) and held.warnings == (words,)


def test_hidden_nodes(tmp_path: Path) -> None:
    scene = Scene()
    hide = {"KHR_node_visibility": {"visible": False}}
    scene.tree["nodes"] = [{"mesh": 0}, {"mesh": 0, "children": [2], "extensions": hide}, {"mesh": 0}]
    scene.tree["scenes"] = [{"nodes": [0, 1]}]
    held = load(scene.save(tmp_path))
    words = "nodes with a mesh that are hidden (KHR_node_visibility) are left out: 2"
    assert is_barrel(held) and held.warnings == (words,)


@pytest.mark.parametrize(("asset", "words"), [
    ({"version": "1.0"}, "is glTF 1.0, not 2.0"), ({}, "is glTF of no version"),
    ({"version": "2.1", "minVersion": "2.1"}, "needs a reader of glTF 2.1"), ({"version": "3.0"}, "is glTF 3.0"),
])  # fmt: skip
def test_other_versions_are_refused(asset: Json, words: str, tmp_path: Path) -> None:
    scene = Scene()
    scene.tree["asset"] = asset
    assert words in said(scene.save(tmp_path))
    scene.tree["asset"] = {"version": "2.1", "minVersion": "2.0"}
    assert is_barrel(load(scene.save(tmp_path)))


@pytest.mark.parametrize(("at", "value", "words"), [
    (("accessors", 0, "count"), 1e12, "bytes of a view of 576"), (("accessors", 0, "count"), 2.5, "not a whole number"),
    (("accessors", 0, "type"), "VEC2", "is VEC2, where VEC3 is needed"),
    (("meshes", 0, "primitives", 0, "indices"), 0, "accessor 0 holds decimal numbers"),
    (("bufferViews", 0, "byteLength"), 1e6, "of a buffer of"),
    (("bufferViews", 0, "buffer"), 3, "number 3 of its 1 buffers"),
    (("nodes", 0, "scale"), [1, 2], "a scale is not of 3 numbers"), (("nodes", 0, "rotation"), [0, 0, 0, 0], "is zero"),
    (("nodes", 0, "matrix"), list(range(16)), "last row"), (("scene",), 4, "number 4 of its 1 scenes"),
    (("meshes", 0, "primitives"), {}, "has no primitives"), (("nodes", 0, "mesh"), -1, "not a whole number"),
])  # fmt: skip
def test_faults_are_named(at: tuple[Any, ...], value: Any, words: str, tmp_path: Path) -> None:
    scene = Scene()
    held: Any = scene.tree
    for key in at[:-1]:
        held = held[key]
    held[at[-1]] = value
    assert words in said(scene.save(tmp_path))


def test_whole_numbers_with_a_decimal_point_and_a_byte_order_mark(tmp_path: Path) -> None:
    text = Scene().text().replace(b'"count": 48', b'"count": 48.0').replace(b'"mesh": 0', b'"mesh": 0e0')
    (tmp_path / "part.gltf").write_bytes(b"\xef\xbb\xbf" + text)
    assert is_barrel(load(tmp_path / "part.gltf"))
