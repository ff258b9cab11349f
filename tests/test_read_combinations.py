"""Several rules of a format at once, on a part without symmetry: a wrong turn, mirror, scale or piece shows."""

import io
import json
import struct
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from barrels import BOTTOM, POINTS, QUADS, RINGS, ROUND, TRIANGLES, Face, fan, strip, written

from meshwind.core.cast import Floats
from meshwind.mesh.io.read import load

PART = (POINTS @ np.array([[1.3, 0.1, 0.0], [0.0, 0.8, 0.0], [0.07, -0.03, 1.0]]) + [3.0, -7.0, 11.0]).round(3)
CLOSED = [*TRIANGLES, *fan(BOTTOM)]
Piece = tuple[Floats, Sequence[Face]]


def about(axis: Sequence[float], degrees: float) -> Floats:
    """Matrix of a turn, by the exponential of its cross product."""
    x, y, z = np.array(axis) / np.linalg.norm(axis)
    cross, angle = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]]), np.radians(degrees)
    return np.asarray(np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross)


def moments(points: Floats, faces: Sequence[Face]) -> Floats:
    """Area, content, centre of the area, and the box about it."""
    corners = points[np.array(faces)]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]) / 2.0
    sizes, centres = np.linalg.norm(normals, axis=1), corners.mean(axis=1)
    used = corners.reshape(-1, 3)
    content = (normals * centres).sum() / 3.0
    return np.array([sizes.sum(), content, *(sizes @ centres / sizes.sum()), *used.min(axis=0), *used.max(axis=0)])


def check(path: Path, *pieces: Piece, units: str = "", rel: float = 1e-9) -> None:
    held = load(path)
    starts = np.cumsum([0] + [len(points) for points, _ in pieces])
    faces = [tuple(int(k + start) for k in face) for (_, part), start in zip(pieces, starts, strict=False)
             for face in part]  # fmt: skip
    wanted = moments(np.concatenate([points for points, _ in pieces]), faces)
    assert moments(held.vertices, [tuple(face) for face in held.faces.tolist()]) == pytest.approx(wanted, rel=rel)
    assert (len(held.faces), held.units, held.warnings) == (len(faces), units, ())


def mirrored(faces: Sequence[Face]) -> list[Face]:
    return [face[::-1] for face in faces]


def lines(points: Floats, before: str = "", sign: str = " ") -> str:
    return "".join(before + sign.join(map(repr, row)) + "\n" for row in points.tolist())


def numbered(table: Sequence[Sequence[float]], first: int = 1) -> str:
    return "".join(", ".join(map(repr, [first + k, *row])) + "\n" for k, row in enumerate(table))


@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_objects_of_relative_faces_over_several_lines(end: str, tmp_path: Path) -> None:
    places = [PART, 0.3 * PART + [200, 0, 0], PART + [-150, 20, 0]]
    faces = "".join("\tf " + " \\\n\t ".join(f"{k - len(PART)}/{k + 1}" for k in face) + " # face\n" for face in QUADS)
    text = "".join(f"o part {k}\n{lines(place, 'v ')}{faces}" for k, place in enumerate(places))
    check(written(tmp_path, "part.obj", text.replace("\n", end)), *((place, TRIANGLES) for place in places))


@pytest.mark.parametrize("order", "<>")
def test_strips_of_several_lengths_beside_polygons_in_binary(order: str, tmp_path: Path) -> None:
    name = "binary_little_endian" if order == "<" else "binary_big_endian"
    head = (
        f"ply\nformat {name} 1.0\nelement face 2\nproperty uchar flag\nproperty list ushort uint vertex_index\n"
        f"element tristrips 2\nproperty list int int vertex_indices\nelement vertex {len(PART)}\nproperty double z\n"
        "property uchar red\nproperty double x\nproperty double y\nend_header\n"
    )
    top = tuple(range(len(PART) - ROUND, len(PART)))
    data = b"".join(struct.pack(f"{order}BH8I", 1, 8, *face) for face in (BOTTOM, top))
    for held in ([*strip(0), -1, *strip(1), -1, *strip(2)], [*strip(3), -1, *strip(4), -1]):
        data += struct.pack(f"{order}{len(held) + 1}i", len(held), *held)
    data += b"".join(struct.pack(f"{order}dBdd", z, 7, x, y) for x, y, z in PART.tolist())
    check(written(tmp_path, "part.ply", head.encode() + data), (PART, [*CLOSED, *fan(top)]))


CHAIN = [*strip(0), strip(0)[-1], strip(1)[0], *strip(1)]
ODD = [*strip(0)[:-1], strip(0)[-2], strip(1)[0], strip(1)[0], *strip(1)]
"""Two strips joined to one by corners that are given twice; the second is of an odd number of corners."""


@pytest.mark.parametrize("joined", [CHAIN, ODD])
def test_strips_that_are_joined_to_one(joined: list[int], tmp_path: Path) -> None:
    turns = [(joined[k + k % 2], joined[k + 1 - k % 2], joined[k + 2]) for k in range(len(joined) - 2)]
    faces = [turn for turn in turns if len(set(turn)) == 3]
    assert len(faces) == 4 * ROUND - (joined is ODD)
    text = f"{len(joined)} {' '.join(map(str, joined))}\n"
    head = f"# vtk DataFile Version 3.0\nx\nascii\ndataset polydata\npoints {len(PART)} double\n{lines(PART)}"
    check(written(tmp_path, "part.vtk", f"{head}triangle_strips 1 {len(joined) + 1}\n{text}"), (PART, faces))
    data = np.array(joined, dtype="<u2").tobytes() + bytes(len(joined) % 2 * 2)
    primitive = {"attributes": {"POSITION": 0}, "indices": 1, "mode": 5}
    path = glb(tmp_path, PART.astype("<f4"), data, len(joined), [{"mesh": 0}], primitive)
    check(path, (PART.astype(np.float32).astype(float), faces), units="m")


def glb(
    folder: Path, rows: np.ndarray, indices: bytes, count: int, nodes: list[dict[str, object]],
    primitive: dict[str, object], kind: int = 5126,
) -> Path:  # fmt: skip
    """A file of one mesh; rows (n, k), of which the last three columns that count are the positions."""
    held = rows.tobytes()
    positions = {"bufferView": 0, "componentType": kind, "type": "VEC3", "count": len(rows)}
    if kind != 5126:
        positions |= {"normalized": True, "byteOffset": 4}
    document = {
        "asset": {"version": "2.0"}, "meshes": [{"primitives": [primitive]}], "nodes": nodes, "scene": 0,
        "scenes": [{"nodes": [0]}], "buffers": [{"byteLength": len(held + indices)}],
        "bufferViews": [{"buffer": 0, "byteLength": len(held), "byteStride": rows.strides[0]},
                        {"buffer": 0, "byteOffset": len(held), "byteLength": len(indices)}],
        "accessors": [positions, {"bufferView": 1, "componentType": 5123, "type": "SCALAR", "count": count}],
        "extensionsUsed": ["KHR_mesh_quantization"], "extensionsRequired": ["KHR_mesh_quantization"],
    }  # fmt: skip
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    head = struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(held + indices), len(text), 0x4E4F534A)
    return written(
        folder, "part.glb", head + text + struct.pack("<II", len(held + indices), 0x004E4942) + held + indices
    )


@pytest.mark.parametrize("kind", [5122, 5123])
def test_interleaved_normalised_positions_below_a_mirror(kind: int, tmp_path: Path) -> None:
    middle, half = (PART.max(axis=0) + PART.min(axis=0)) / 2.0, float(np.ptp(PART, axis=0).max() / 2.0)
    if kind == 5122:
        stored = np.round((PART - middle) / half * 32767).astype("<i2")
        move, scale, places = middle, half, stored / 32767
    else:
        stored = np.round((PART - middle + half) / (2.0 * half) * 65535).astype("<u2")
        move, scale, places = middle - half, 2.0 * half, stored / 65535
    rows = np.full((len(PART), 6), 77, dtype=stored.dtype)
    rows[:, 2:5] = stored
    indices = np.array(CLOSED, dtype="<u2").tobytes()
    axis, half_turn = np.array([1.0, 2.0, -0.5]) / np.linalg.norm([1.0, 2.0, -0.5]), np.radians(77.0) / 2.0
    turn = [*(np.sin(half_turn) * axis).tolist(), float(np.cos(half_turn))]
    nodes = [{"children": [1], "rotation": turn, "scale": [1, -2, 1], "translation": [5, 6, 7]},
             {"mesh": 0, "translation": move.tolist(), "scale": [scale] * 3}]  # fmt: skip
    primitive = {"attributes": {"POSITION": 0}, "indices": 1}
    path = glb(tmp_path, rows, indices, 3 * len(CLOSED), nodes, primitive, kind)
    placed = (places * scale + move) * [1, -2, 1] @ about(axis.tolist(), 77.0).T + [5, 6, 7]
    check(path, (placed, mirrored(CLOSED)), units="m")


def test_components_within_components_of_another_part_in_inch(tmp_path: Path) -> None:
    core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
    moves = [(2.0 * about((1, 0, 2), 40), [1, 2, 3]), (np.diag([1.0, -1.0, 0.5]), [0, 50, 0]),
             (about((0, 1, 0), -30), [9, 8, 7])]  # fmt: skip
    texts = [" ".join(map(repr, np.vstack([turn, shift]).ravel().tolist())) for turn, shift in moves]

    def model(objects: str, build: str) -> str:
        return (
            f'<model unit="inch" xmlns="{core}" xmlns:p="{production}" requiredextensions="p"><resources>{objects}'
            f"</resources><build>{build}</build></model>"
        )

    corners = "".join(f'<vertex x="{x!r}" y="{y!r}" z="{z!r}"/>' for x, y, z in PART.tolist())
    faces = "".join(f'<triangle v1="{a}" v2="{b}" v3="{c}"/>' for a, b, c in CLOSED)
    mesh = f'<object id="1"><mesh><vertices>{corners}</vertices><triangles>{faces}</triangles></mesh></object>'
    inner = f'<object id="2"><components><component objectid="1" transform="{texts[0]}"/></components></object>'
    outer = (
        f'<object id="1"><components><component objectid="2" p:path="/3D/sub.model" transform="{texts[1]}"/>'
        '<component objectid="1" p:path="/3D/sub.model"/></components></object>'
    )
    space = "http://schemas.openxmlformats.org/package/2006/relationships"
    kind = "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel"
    held = io.BytesIO()
    with zipfile.ZipFile(held, "w") as archive:
        root = f'<Relationship Id="r" Type="{kind}" Target="/3D/a.model"/>'
        archive.writestr("_rels/.rels", f'<Relationships xmlns="{space}">{root}</Relationships>')
        archive.writestr("3D/a.model", model(outer, f'<item objectid="1" transform="{texts[2]}"/>'))
        archive.writestr("3D/sub.model", model(mesh + inner, ""))
    deep = PART
    for turn, shift in moves:
        deep = deep @ turn + shift
    flat = PART @ moves[2][0] + moves[2][1]
    path = written(tmp_path, "part.3mf", held.getvalue())
    check(path, (deep, mirrored(CLOSED)), (flat, CLOSED), units="in")


def test_a_part_in_a_system_of_its_own_with_made_nodes_and_elements_is_placed(tmp_path: Path) -> None:
    rings = [np.column_stack([np.full(ROUND, 20.0) + np.arange(ROUND) % 3, 45.0 * np.arange(ROUND), np.full(ROUND, z)])
             for z in np.linspace(0.0, 80.0, RINGS)]  # fmt: skip
    quads = [[101 + k, 101 + (k + 1) % ROUND, 201 + (k + 1) % ROUND, 201 + k] for k in range(ROUND)]
    made = "".join(f"{101 + k}, {100 * RINGS + 1 + k}, 100\n" for k in range(ROUND))
    copies = "".join(f"{k + 1}, {RINGS - 1}, 100, 100\n" for k in range(ROUND))
    part = (
        "*Part, name=P\n*System\n10., 20., 30., 10., 21., 30.\n10., 20., 31.\n"
        f"*Node, system=C\n{numbered(rings[0].tolist(), 101)}*Node, nset=top, system=C\n"
        f"{numbered(rings[-1].tolist(), 100 * RINGS + 1)}*Ngen\n{made}*Element, type=S4R\n{numbered(quads)}"
        f"*Elgen, elset=all\n{copies}*End Part\n"
    )
    uses = (
        "*Assembly, name=A\n*Instance, name=I, part=p\n1., 2., 3.\n1., 2., 3., 1., 3., 3., 30.\n*End Instance\n"
        "*Instance, name=J, part=P\n,,\n0., 0., 0., 0., 0., -1., 75.\n*End Instance\n"
        "*Node\n101, 900., 0., 0.\n*Element, type=SPRINGA\n1, I.101, J.101\n*End Assembly\n"
    )
    r, turn, z = np.concatenate(rings).T
    own = np.column_stack([r * np.cos(np.radians(turn)), r * np.sin(np.radians(turn)), z])
    own = np.column_stack([own[:, 2], own[:, 0], own[:, 1]]) + [10, 20, 30]  # its axes are y, z and x
    first = own @ about((0, 1, 0), 30).T + [1, 2, 3]
    second = own @ about((0, 0, -1), 75).T
    path = written(tmp_path, "part.inp", part + uses)
    check(path, (first, TRIANGLES), (second, TRIANGLES))


CONCAVE = np.array([(0, 0), (9, 0), (9, 7), (6, 7), (6, 2), (3, 2), (3, 5), (5, 5), (5, 8), (0, 8)], dtype=float)
"""A hook, which no fan from a corner covers."""
WALLED = np.concatenate([np.insert(CONCAVE + shift, 2, z, axis=1) for shift, z in (([0, 0], 0.0), ([3, 1], 30.0))])
WALLS = [[k, (k + 1) % 10, 10 + (k + 1) % 10, 10 + k] for k in range(10)]


def polygons(turned: int) -> list[list[int]]:
    ends = [[*range(9, -1, -1)], [*range(10, 20)]]
    return [*(end[turned:] + end[:turned] for end in ends), *WALLS]


def in_obj(faces: list[list[int]]) -> str:
    return lines(WALLED, "v ") + "".join("f " + " ".join(str(k + 1) for k in face) + "\n" for face in faces)


def listed(faces: list[list[int]]) -> str:
    return "".join(f"{len(face)} {' '.join(map(str, face))}\n" for face in faces)


def in_off(faces: list[list[int]]) -> str:
    return f"OFF\n20 {len(faces)} 0\n{lines(WALLED)}{listed(faces)}"


def in_ply(faces: list[list[int]]) -> str:
    axes = "".join(f"property double {axis}\n" for axis in "xyz")
    return (
        f"ply\nformat ascii 1.0\nelement vertex 20\n{axes}element face {len(faces)}\n"
        f"property list uchar int vertex_indices\nend_header\n{lines(WALLED)}{listed(faces)}"
    )


def in_stl(faces: list[list[int]]) -> str:
    loops = (f"facet normal 0 0 0\nouter loop\n{lines(WALLED[face], 'vertex ')}endloop\nendfacet\n" for face in faces)
    return f"solid a\n{''.join(loops)}endsolid a\n"


def in_vtk(faces: list[list[int]]) -> str:
    size = sum(len(face) + 1 for face in faces)
    head = f"# vtk DataFile Version 3.0\nx\nASCII\nDATASET POLYDATA\nPOINTS 20 double\n{lines(WALLED)}"
    return f"{head}POLYGONS {len(faces)} {size}\n{listed(faces)}"


def in_vtu(faces: list[list[int]]) -> str:
    def array(name: str, kind: str, values: object) -> str:
        return f'<DataArray Name="{name}" type="{kind}" format="ascii">{values}</DataArray>'

    cells = array("connectivity", "Int32", " ".join(str(k) for face in faces for k in face))
    cells += array("offsets", "Int32", " ".join(map(str, np.cumsum([len(face) for face in faces]))))
    cells += array("types", "UInt8", " ".join(str(9 if len(face) == 4 else 7) for face in faces))
    points = array("p", "Float64", lines(WALLED)).replace("Name", 'NumberOfComponents="3" Name')
    return (
        f'<VTKFile type="UnstructuredGrid" version="0.1"><UnstructuredGrid><Piece NumberOfPoints="20" NumberOfCells="'
        f'{len(faces)}"><Points>{points}</Points><Cells>{cells}</Cells></Piece></UnstructuredGrid></VTKFile>'
    )


@pytest.mark.parametrize("turned", [0, 3, 7])
@pytest.mark.parametrize("way", [in_obj, in_off, in_ply, in_stl, in_vtk, in_vtu])
def test_concave_ends_in_every_format_of_polygons(way: Any, turned: int, tmp_path: Path) -> None:
    held = load(written(tmp_path, f"part.{way.__name__[3:]}", way(polygons(turned))))
    x, y = CONCAVE.T
    end = float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0
    area, content = moments(held.vertices, [tuple(face) for face in held.faces.tolist()])[:2]
    sides = np.roll(CONCAVE, -1, axis=0) - CONCAVE
    walls = np.linalg.norm(np.cross(np.column_stack([sides, np.zeros(10)]), [3.0, 1.0, 30.0]), axis=1).sum()
    assert held.warnings == () and len(held.faces) == 2 * 8 + 20
    assert (area, content) == pytest.approx((2.0 * end + walls, 30.0 * end), rel=1e-9)
