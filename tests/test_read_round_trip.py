"""One barrel, written in every format and variant by other programs and by hand, reads back with the same area."""

import base64
import json
import struct
import zipfile
from collections.abc import Iterator
from itertools import product
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista as pv
import trimesh
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter, vtkUnstructuredGridWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

from meshwind.mesh import Mesh, read
from meshwind.mesh.geometry.areas_and_volumes import areas

AROUND, ALONG = 8, 6


def barrel() -> tuple[Any, Any]:
    """Vertices (48, 3), eighths of a unit and so exact in every format, and quads (40, 4) of an open barrel."""
    turn = 2.0 * np.pi * np.arange(AROUND) / AROUND
    rows = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(AROUND, z)])
            for r, z in zip((30, 33, 35, 34, 31, 28), np.linspace(0, 120, ALONG), strict=True)]  # fmt: skip
    k, i = np.divmod(np.arange(AROUND * (ALONG - 1)), AROUND)
    a, b = k * AROUND + i, k * AROUND + (i + 1) % AROUND
    return np.round(8.0 * np.concatenate(rows)) / 8.0, np.column_stack([a, b, b + AROUND, a + AROUND])


POINTS, QUADS = barrel()
FACES = np.concatenate([QUADS[:, :3], QUADS[:, [0, 2, 3]]])
AREA = float(areas(POINTS, FACES).sum())


def lines(text: str, end: str) -> bytes:
    return text.replace("\n", end).encode()


def objs() -> Iterator[tuple[str, bytes]]:
    """OBJ files by hand."""
    vertices = [f"v {x:g} {y:g} {z:g}" for x, y, z in POINTS]
    for end, way, more in product(("\n", "\r\n", "\r"), ("plain", "tabs", "indented", "relative", "continued"),
                                  ("", "slashes", "objects")):  # fmt: skip
        tail = "/1/1" if more == "slashes" else ""
        shift = len(POINTS) if way == "relative" else -1
        faces = ["f " + " ".join(f"{n - shift}{tail}" for n in face) for face in FACES.tolist()]
        half = len(faces) // 2
        middle = ["o second", "l 1 2", "p 1"] if more == "objects" else []
        body = ["# a barrel", "vt 0 0", "vn 0 0 1", *vertices, "usemtl steel", *faces[:half], *middle, *faces[half:]]
        if way == "relative":  # another vertex below the faces, which nothing uses
            body.append("v 500 0 0")
        text = "\n".join(body) + "\n"
        text = text.replace(" ", "\t") if way == "tabs" else text
        text = "  " + text.replace("\n", "\n  ") if way == "indented" else text
        text = text.replace("f ", "f \\\n ") if way == "continued" else text
        yield f"obj {way} {more} {end!r}", lines(text, end)


def plys() -> Iterator[tuple[str, bytes]]:
    """PLY files by hand: triangles, a mixture with quads, and strips."""
    mixed = [*QUADS[:20].tolist(), *QUADS[20:, :3].tolist(), *QUADS[20:, [0, 2, 3]].tolist()]
    ribbon = [[row * AROUND + k % AROUND + up for k in range(AROUND + 1) for up in (AROUND, 0)] for row in range(5)]
    strips = [[node for ring in ribbon for node in (*ring, -1)][:-1]]
    for order, shape, kind, more in product(("ascii", "<", ">"), ("triangles", "mixed", "strips"), "fd", (False, True)):
        name = {"ascii": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}[order]
        cells = {"triangles": FACES.tolist(), "mixed": mixed, "strips": strips}[shape]
        element = "tristrips" if shape == "strips" else "face"
        head = ["ply", f"format {name} 1.0", "comment a barrel"]
        head += ["element note 1", "property list uchar int words"] if more else []
        head += ["element vertex 48", *(f"property {'float' if kind == 'f' else 'double'} {axis}" for axis in "xyz")]
        head += ["property uchar red"] if more else []
        head += [f"element {element} {len(cells)}", "property list int int vertex_indices", "end_header", ""]
        if order == "ascii":
            rows = ["2 7 7"] if more else []
            rows += [f"{x:g} {y:g} {z:g}" + " 9" * more for x, y, z in POINTS]
            body = "\n".join([*rows, *(f"{len(cell)} " + " ".join(map(str, cell)) for cell in cells)]).encode() + b"\n"
        else:
            body = struct.pack(order + "B2i", 2, 7, 7) if more else b""
            tail = b"\x09" if more else b""
            body += b"".join(struct.pack(f"{order}3{kind}", *point) + tail for point in POINTS)
            body += b"".join(struct.pack(f"{order}{len(cell) + 1}i", len(cell), *cell) for cell in cells)
        yield f"ply {name} {shape} {kind} {more}", "\n".join(head).encode() + body


def offs() -> Iterator[tuple[str, bytes]]:
    """OFF files by hand."""
    for word, end, remarks in product(("OFF\n", "COFF\n", "OFF ", ""), ("\n", "\r\n"), (False, True)):
        colour = " 255 0 0 255" if word == "COFF\n" else ""
        body = [f"{x:g} {y:g} {z:g}{colour}" for x, y, z in POINTS]
        body += [f"4 {' '.join(map(str, quad))} 0.5 0.5 0.5" for quad in QUADS.tolist()]
        text = f"{word}48 40 0\n" + "\n".join(body) + "\n"
        text = "# a barrel\n\n" + text.replace("48 40 0\n", "48 40 0 # counts\n\n") if remarks else text
        yield f"off {word!r} {end!r} {remarks}", lines(text, end)


def decks() -> Iterator[tuple[str, bytes]]:
    """INP files by hand."""
    nodes = [f"{k + 1}, {x:g}, {y:g}, {z:g}" for k, (x, y, z) in enumerate(POINTS)]
    cells = [f"{k + 1}, " + ", ".join(str(n + 1) for n in face) for k, face in enumerate(FACES.tolist())]
    one = ["*NODE", *nodes, "*ELEMENT, TYPE=S3", *cells]
    two = ["*Node, nset=a", *nodes[:20], "*NODE", *nodes[20:], "*Element, type=S3R, elset=b", *cells[:9],
           "*ELEMENT, TYPE=S3", *cells[9:]]  # fmt: skip
    moved = ["*PART, NAME=P", *one, "*END PART", "*ASSEMBLY, NAME=A", "*INSTANCE, NAME=I, PART=p", "5, 6, 7",
             "0,0,0, 0,0,1, 30", "*END INSTANCE", "*END ASSEMBLY"]  # fmt: skip
    more = [
        *one,
        "*ELEMENT, TYPE=MASS, ELSET=M",
        "900, 1",
        "*ELEMENT, TYPE=B31",
        "901, 1, 2",
        "*NODE PRINT, NSET=a",
        "U",
    ]
    wrapped = ["*NODE", *nodes, "*ELEMENT,", " TYPE=S3", *(cell.replace(", ", ",\n", 2) + "," for cell in cells)]
    kinds = {"one": one, "two": two, "moved": moved, "more": more, "wrapped": wrapped}
    for (name, rows), end in product(kinds.items(), ("\n", "\r\n")):
        yield f"inp {name} {end!r}", lines("*HEADING\n a barrel\n** remark\n" + "\n".join(rows) + "\n", end)


def stls() -> Iterator[tuple[str, bytes]]:
    """STL files by hand."""
    facets = b"".join(struct.pack("<12fH", 0, 0, 1, *POINTS[face].ravel(), 7) for face in FACES)
    for head, count in product((b"solid barrel", b"binary"), (80, 0, 79)):
        yield f"stl {head!r} {count}", head.ljust(80, b" ") + struct.pack("<I", count) + facets
    half = len(facets) // 2
    solids = (b"x".ljust(80, b" ") + struct.pack("<I", 40) + part for part in (facets[:half], facets[half:]))
    yield "stl of two solids", b"".join(solids)
    for shape, end in product(("triangles", "quads", "capitals", "tabs", "solids"), ("\n", "\r\n", "\r")):
        cells = (QUADS if shape == "quads" else FACES).tolist()
        rows = [
            "facet normal 0 0 1\nouter loop\n"
            + "".join("vertex {:g} {:g} {:g}\n".format(*POINTS[node]) for node in cell)
            + "endloop\nendfacet\n"
            for cell in cells
        ]
        middle = "endsolid\nsolid other\n" if shape == "solids" else ""
        text = f"solid barrel\n{''.join(rows[:9])}{middle}{''.join(rows[9:])}endsolid barrel\n"
        text = text.upper() if shape == "capitals" else text.replace(" ", "\t") if shape == "tabs" else text
        yield f"stl text {shape} {end!r}", lines(text, end)


def gltfs() -> Iterator[tuple[str, bytes]]:
    """GLTF files by hand, with indices of each width and strips; lengths are metres."""
    for kind, code in (("B", 5121), ("H", 5123), ("I", 5125), ("", 0)):
        corners = POINTS if kind else POINTS[FACES.ravel()]
        data = struct.pack(f"<{corners.size}f", *corners.ravel())
        index = struct.pack(f"<{FACES.size}{kind}", *FACES.ravel()) if kind else b""
        primitive: dict[str, Any] = {"attributes": {"POSITION": 0}}
        accessors = [{"bufferView": 0, "componentType": 5126, "count": len(corners), "type": "VEC3"}]
        views = [{"buffer": 0, "byteOffset": 0, "byteLength": len(data)}]
        if kind:
            primitive["indices"] = 1
            accessors.append({"bufferView": 1, "componentType": code, "count": FACES.size, "type": "SCALAR"})
            views.append({"buffer": 0, "byteOffset": len(data), "byteLength": len(index)})
        uri = "data:application/octet-stream;base64," + base64.b64encode(data + index).decode()
        scene = {"asset": {"version": "2.0"}, "buffers": [{"uri": uri, "byteLength": len(data + index)}],
                 "bufferViews": views, "accessors": accessors, "meshes": [{"primitives": [primitive]}],
                 "nodes": [{"mesh": 0, "rotation": [0, 0, 0.6, 0.8]}], "scenes": [{"nodes": [0]}],
                 "scene": 0}  # fmt: skip
        yield f"gltf {kind}", json.dumps(scene).encode()


BY_HAND = {name: content for make in (objs, plys, offs, decks, stls, gltfs) for name, content in make()}


@pytest.mark.parametrize("name", BY_HAND)
def test_by_hand(name: str, tmp_path: Path) -> None:
    suffix = name.split()[0]
    path = tmp_path / f"barrel.{suffix}"
    path.write_bytes(BY_HAND[name])
    mesh = read(path)
    check(mesh, "m" if suffix == "gltf" else "")
    wrong_count = name.startswith("stl b'") and not name.endswith("80")
    assert bool(mesh.warnings) == wrong_count


def check(mesh: Mesh, units: str = "") -> None:
    assert len(mesh.faces) == len(FACES)
    assert float(areas(mesh.vertices, mesh.faces).sum()) == pytest.approx(AREA, rel=1e-9)
    assert mesh.units == units


UNITS = {"micron": "um", "millimeter": "mm", "centimeter": "cm", "inch": "in", "foot": "ft", "meter": "m", None: "mm"}


@pytest.mark.parametrize(("unit", "own_part"), list(product(UNITS, (False, True))))
def test_3mf(unit: str | None, own_part: bool, tmp_path: Path) -> None:
    core = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02"
    production = "http://schemas.microsoft.com/3dmanufacturing/production/2015/06"
    vertices = "".join(f'<vertex x="{x:g}" y="{y:g}" z="{z:g}"/>' for x, y, z in POINTS)
    faces = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in FACES.tolist())
    held = f'<object id="1"><mesh><vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh></object>'
    head = f'<model xmlns="{core}" xmlns:p="{production}"' + (f' unit="{unit}">' if unit else ">")
    path = tmp_path / "barrel.3mf"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        use, inside = '<item objectid="1"/>', held
        if own_part:
            archive.writestr("3D/Objects/a.model", f"{head}<resources>{held}</resources></model>")
            use, inside = '<item objectid="2"/>', (
                '<object id="2"><components><component p:path="/3D/Objects/a.model" objectid="1" '
                'transform="0 1 0 -1 0 0 0 0 1 0 0 7"/></components></object>')  # fmt: skip
        support = held.replace('<object id="1"', '<object id="9" type="support"')
        root = f'{head}<resources>{inside}{support}</resources><build>{use}<item objectid="9"/></build></model>'
        archive.writestr("3D/3dmodel.model", root)
    mesh = read(path)
    check(mesh, UNITS[unit])
    assert mesh.warnings == ("objects of the build that are supports are left out: 1",)


XML = list(product(("vtp", "vtu"), (0, 1, 2), (None, "ZLib", "LZ4", "LZMA"), (0, 1)))


@pytest.mark.parametrize(("suffix", "mode", "compressor", "order"), XML)
def test_vtk_xml(suffix: str, mode: int, compressor: str | None, order: int, tmp_path: Path) -> None:
    surface = pv.make_tri_mesh(POINTS, FACES)
    surface["field"] = POINTS[:, 2]
    writer = vtkXMLPolyDataWriter() if suffix == "vtp" else vtkXMLUnstructuredGridWriter()
    writer.SetInputData(surface if suffix == "vtp" else surface.cast_to_unstructured_grid())
    writer.SetFileName(str(tmp_path / f"barrel.{suffix}"))
    writer.SetDataMode(mode)
    writer.SetByteOrder(order)
    getattr(writer, f"SetCompressorTypeTo{compressor}")()
    assert writer.Write() == 1
    check(read(tmp_path / f"barrel.{suffix}"))


LEGACY = list(product(("faces", "strips", "grid", "quads"), (42, 51), (0, 1)))


@pytest.mark.parametrize(("shape", "version", "binary"), LEGACY)
def test_vtk_legacy(shape: str, version: int, binary: int, tmp_path: Path) -> None:
    surface = pv.make_tri_mesh(POINTS, FACES)
    if shape == "strips":
        surface = surface.strip()
    if shape == "quads":
        surface = pv.PolyData(POINTS, np.insert(QUADS, 0, 4, axis=1).ravel())
    writer = vtkUnstructuredGridWriter() if shape == "grid" else vtkPolyDataWriter()
    writer.SetInputData(surface.cast_to_unstructured_grid() if shape == "grid" else surface)
    writer.SetFileVersion(version)
    writer.SetFileType(2 if binary else 1)
    path = tmp_path / "barrel.vtk"
    writer.SetFileName(str(path))
    assert writer.Write() == 1
    check(read(path))
    if not binary:
        path.write_bytes(path.read_bytes().replace(b"ASCII", b"ascii").replace(b"\n", b"\r\n"))
        check(read(path))


@pytest.mark.parametrize(("suffix", "given"), [
    ("stl", {"binary": True}), ("stl", {"binary": False}), ("ply", {"binary": True}), ("ply", {"binary": False}),
    ("obj", {}), ("off", {}), ("vtk", {"binary": True}), ("vtk", {"binary": False}), ("vtk", {"file_format": "vtk42"}),
    ("vtu", {"binary": True}), ("vtu", {"binary": False}), ("vtu", {"compression": None}),
    ("msh", {"file_format": "gmsh", "binary": True}), ("msh", {"file_format": "gmsh", "binary": False}),
    ("msh", {"file_format": "gmsh22", "binary": True}), ("msh", {"file_format": "gmsh22", "binary": False}),
    ("inp", {}),
])  # fmt: skip
def test_meshio(suffix: str, given: dict[str, Any], tmp_path: Path) -> None:
    meshio.Mesh(POINTS, [("triangle", FACES)]).write(tmp_path / f"barrel.{suffix}", **given)
    check(read(tmp_path / f"barrel.{suffix}"))


@pytest.mark.parametrize("kind", ["stl", "stl_ascii", "ply", "off", "obj", "glb"])
def test_trimesh(kind: str, tmp_path: Path) -> None:
    path = tmp_path / f"barrel.{kind.split('_')[0]}"
    trimesh.Trimesh(POINTS, FACES, process=False, vertex_colors=np.full((48, 4), 200)).export(path, file_type=kind)
    check(read(path), "m" if kind == "glb" else "")


def test_there_are_150_files() -> None:
    assert len(BY_HAND) + 2 * len(UNITS) + len(XML) + 16 + 17 + 6 >= 150
