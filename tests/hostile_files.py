"""Malformed mesh files: every format changed at random, and files made to do harm."""

import base64
import io
import json
import re
import struct
import zipfile
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import trimesh
from mesh_shapes import pear
from test_mesh_read import KINDS, MODEL, save

EACH = 14
"""Changed files of each kind in the corpus."""
_NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
_NUMBERS = (
    b"-1 0 1e308 nan inf -inf 99999999999 9223372036854775807 18446744073709551616 2147483647 -2147483648 1e-320 "
    b"4294967295 1000000000 3.5 x"
).split() + [b""]
_BYTES = [4 * b"\xff", 4 * b"\0", b"\x7f" + 3 * b"\xff", 3 * b"\xff" + b"\x7f", b"\0\0\0\x80", 8 * b"\xff", 8 * b"\0"]
Edit = tuple[str, float, float]
"""Kind of edit, position in the file from 0 to 1, and a number from 0 to 1 that determines the new content."""


def _cut(data: bytes, at: int, _: float) -> bytes:
    return data[:at]


def _drop(data: bytes, at: int, by: float) -> bytes:
    return data[:at] + data[at + 1 + int(80 * by) :]


def _overwrite(data: bytes, at: int, by: float) -> bytes:
    new = _BYTES[int(by * len(_BYTES))]
    return data[:at] + new + data[at + len(new) :]


def _set(data: bytes, at: int, by: float) -> bytes:
    return data[:at] + bytes([int(256 * by)]) + data[at + 1 :]


def _number(data: bytes, at: int, by: float) -> bytes:
    found = _NUMBER.search(data, at)
    return data if found is None else data[: found.start()] + _NUMBERS[int(by * len(_NUMBERS))] + data[found.end() :]


def _repeat(data: bytes, at: int, by: float) -> bytes:
    return data[:at] + data[int(by * len(data)) :][:60] + data[at:]


def _lines(data: bytes, at: int, by: float) -> bytes:
    lines = data.split(b"\n")
    k = data.count(b"\n", 0, at)
    lines[k:k] = [lines[int(by * len(lines))]]
    return b"\n".join(lines)


EDITS = {"cut": _cut, "drop": _drop, "overwrite": _overwrite, "set": _set, "number": _number, "repeat": _repeat,
         "lines": _lines}  # fmt: skip


def changed(data: bytes, edits: list[Edit]) -> bytes:
    """A file after some edits; every other one is near its start, where most formats have their header."""
    for k, (what, where, by) in enumerate(edits):
        if data:
            data = EDITS[what](data, int(where * (len(data) if k % 2 else min(len(data), 1000))), by)
    return data


@cache
def sound(kind: str) -> tuple[str, bytes]:
    """Suffix and content of a small sound file."""
    suffix = "." + kind.split("_")[0].rstrip("2")
    with TemporaryDirectory() as folder:
        path = Path(folder, "part" + suffix)
        if kind == "gltf":
            path.write_text(json.dumps(embedded(), indent=1))
        else:
            save(path, pear(1), kind)
        return suffix, path.read_bytes()


def embedded() -> dict[str, object]:
    """A glTF scene that holds its buffers itself."""
    files = trimesh.Trimesh(*pear(1), process=False).scene().export(file_type="gltf")
    scene = json.loads(files["model.gltf"])
    for buffer in scene["buffers"]:
        content = base64.b64encode(files[buffer["uri"]]).decode()
        buffer["uri"] = f"data:application/octet-stream;base64,{content}"
    return dict(scene)


FORMATS = [*KINDS, "gltf"]


def corpus() -> Iterator[tuple[str, str, bytes]]:
    """Name, suffix and content of every malformed file: the same in every run."""
    for number, kind in enumerate(FORMATS):
        suffix, data = sound(kind)
        rng = np.random.default_rng(number)
        for k in range(EACH):
            edits = [(str(rng.choice(list(EDITS))), *rng.random(2).tolist()) for _ in range(rng.integers(1, 4))]
            yield f"{kind} {k}", suffix, changed(data, edits)
    yield from ((name, suffix, content) for name, (suffix, content) in MALICIOUS.items())


def _archive(model: str, name: str = "3D/3dmodel.model") -> bytes:
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, model)
    return held.getvalue()


def _nested(fan: int, depth: int) -> str:
    """Objects that each contain the next one many times: the last one is used fan ** depth times."""
    use = '<component objectid="{}"/>'
    objects = "".join(
        f'<object id="{k}"><components>{fan * use.format(k + 1)}</components></object>' for k in range(depth)
    )
    last = f'<object id="{depth}"><components/></object>'
    return f'<model><resources>{objects}{last}</resources><build><item objectid="0"/></build></model>'


def _vtk_xml(counts: str, kind: str = "PolyData") -> bytes:
    return f'<VTKFile type="{kind}" version="1.0"><{kind}><Piece {counts}/></{kind}></VTKFile>'.encode()


_LAUGHS = "".join(f'<!ENTITY a{k + 1} "{10 * f"&a{k};"}">' for k in range(9))
_CUBE = MODEL.format(vertices='<vertex x="0" y="0" z="0"/>', faces='<triangle v1="0" v2="0" v3="9"/>')
_CROWD = (
    "<model><resources><object id='1'><mesh><vertices>"
    + 10_000 * "<vertex x='0' y='0' z='0'/>"
    + "</vertices><triangles>"
    "<triangle v1='0' v2='1' v3='2'/></triangles></mesh></object></resources>"
    "<build>" + 19_000 * "<item objectid='1'/>" + "</build></model>"
)
OUTSIDE = "../secret"
"""A file that some files refer to; a test creates it and checks that it is not opened."""
MALICIOUS: dict[str, tuple[str, bytes]] = {
    "STL of four billion triangles": (".stl", bytes(80) + struct.pack("<I", 2**32 - 1) + bytes(50)),
    "STL without an end": (".stl", b"solid x\n" + b"facet normal 0 0 1\n" * 2000),
    "PLY of 10^12 vertices": (".ply", b"ply\nformat ascii 1.0\nelement vertex 999999999999\nproperty float x\n"
                                      b"property float y\nproperty float z\nend_header\n0 0 0\n"),
    "PLY of 10^12 bytes": (".ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 999999999999\n"
                                   b"property double x\nproperty double y\nproperty double z\nend_header\n0000"),
    "PLY of long lists": (".ply", b"ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
                                  b"element face 1\nproperty list uint uint vertex_indices\nend_header\n"
                                  + 4 * b"\0" + 8 * b"\xff"),
    "PLY that names a texture": (".ply", f"ply\nformat ascii 1.0\ncomment TextureFile {OUTSIDE}\n".encode()),
    "OFF of 10^12 vertices": (".off", b"OFF\n999999999999 1 0\n0 0 0\n3 0 0 0\n"),
    "OBJ that names a library": (".obj", f"mtllib {OUTSIDE}\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n".encode()),
    "OBJ of far vertices": (".obj", b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 999999999999999999999\n"),
    "OBJ of one long line": (".obj", b"v 0 0 0\nf " + b"1 " * 100_000),
    "OBJ of huge numbers": (".obj", b"v 1" + 400 * b"0" + b" 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"),
    "OBJ of bytes that are no text": (".obj", bytes(range(256)) * 40),
    "GLTF that names a file": (".gltf", json.dumps({"asset": {"version": "2.0"}, "buffers": [
        {"uri": OUTSIDE, "byteLength": 4}]}).encode()),
    "GLTF that names an address": (".gltf", json.dumps({"asset": {"version": "2.0"}, "buffers": [
        {"uri": "http://localhost/secret", "byteLength": 4}]}).encode()),
    "GLTF of deep lists": (".gltf", b"[" * 100_000),
    "GLTF whose nodes hold themselves": (".gltf", json.dumps(embedded() | {"nodes": [
        {"children": [0]}], "scenes": [{"nodes": [0]}], "scene": 0}).encode()),
    "GLTF of 10^12 zeros": (".gltf", json.dumps(embedded() | {"accessors": [
        {"componentType": 5126, "count": 10**12, "type": "VEC3", "sparse": {"count": 0}}] * 2}).encode()),
    "GLTF of 10^300 nodes": (".gltf", json.dumps(embedded() | {"nodes": [
        {"children": [k + 1] * 2} for k in range(999)] + [{}], "scenes": [{"nodes": [0]}], "scene": 0}).encode()),
    "GLB of 4 GB": (".glb", b"glTF" + struct.pack("<IIII", 2, 2**32 - 1, 2**32 - 1, 0x4E4F534A) + b"{}"),
    "3MF whose objects hold themselves": (".3mf", _archive(_nested(1, 0).replace("<components/>",
        '<components><component objectid="0"/></components>'))),
    "3MF of 10^15 objects": (".3mf", _archive(_nested(10, 15))),
    "3MF of 10^8 vertices": (".3mf", _archive(_CROWD)),
    "3MF that laughs": (".3mf", _archive(f'<!DOCTYPE m [<!ENTITY a0 "ha">{_LAUGHS}]><model>&a9;</model>')),
    "3MF that names a file": (".3mf", _archive(f'<!DOCTYPE m [<!ENTITY a SYSTEM "{OUTSIDE}">]><model>&a;</model>')),
    "3MF that unpacks to much": (".3mf", _archive("<model>" + 50_000_000 * " ")),
    "3MF in a folder above": (".3mf", _archive(_CUBE, "../../3dmodel.model")),
    "MSH of sparse nodes": (".msh", b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Nodes\n1 1 1 9000000000\n2 0 0 1\n"
                                    b"9000000000\n0 0 0\n$EndNodes\n$Elements\n1 1 1 1\n2 0 2 1\n1 1 1 1\n"
                                    b"$EndElements\n"),
    "MSH of 10^12 nodes": (".msh", b"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n999999999999\n1 0 0 0\n$EndNodes\n"),
    "INP that includes a file": (".inp", f"*HEADING\n*INCLUDE, INPUT={OUTSIDE}\n".encode()),
    "INP that includes itself": (".inp", b"*HEADING\n *Include, input=part.inp\n"),
    "INP that makes 10^12 nodes": (".inp", b"*NODE\n1, 0, 0, 0\n1000000000000, 1, 0, 0\n*NGEN\n1, 1000000000000, 1\n"),
    "INP that makes 10^12 elements": (".inp", b"*NODE\n1, 0, 0, 0\n2, 1, 0, 0\n3, 0, 1, 0\n*ELEMENT, TYPE=S3\n"
                                             b"1, 1, 2, 3\n*ELGEN\n1, 1000000, 1, 1, 1000000, 1, 1\n"),
    "VTK of 10^12 points": (".vtk", b"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\n"
                                    b"POINTS 999999999999 float\n0 0 0\n"),
    "VTK of 10^10 bytes": (".vtk", b"# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\n"
                                   b"POINTS 9999999999 double\n0 0 0\n"),
    "VTP of 10^12 points": (".vtp", _vtk_xml('NumberOfPoints="999999999999" NumberOfPolys="1"')),
    "VTP of less than no points": (".vtp", _vtk_xml('NumberOfPoints="-5" NumberOfPolys="-1"')),
    "VTU of 10^18 cells": (".vtu", _vtk_xml('NumberOfPoints="1" NumberOfCells="999999999999999999"',
                                            "UnstructuredGrid")),
    "VTU of another kind": (".vtu", _vtk_xml('NumberOfPoints="1"', "ImageData")),
    "VTP of deep elements": (".vtp", 100_000 * b"<VTKFile>"),
}  # fmt: skip
"""Files that announce more than they hold, contain themselves, unpack to a large size, or refer to other files."""
