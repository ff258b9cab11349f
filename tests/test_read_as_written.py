"""What a file says is what is read: places, units and shapes that other programs lose, and refusals by name."""

import json
import struct
import zipfile
from pathlib import Path
from typing import Any

import meshio
import numpy as np
import pytest
import pyvista as pv
import trimesh
from test_read_round_trip import AREA, BY_HAND, FACES, POINTS, QUADS

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.io.cells.polygons import cut_polygons
from meshwind.mesh.io.deck.elements import cell_kind
from meshwind.planning.pins import read_pins


def deck(folder: Path, text: str) -> Path:
    path = folder / "part.inp"
    path.write_text(text)
    return path


def refusal(path: Path) -> str:
    with pytest.raises(BadInputError) as caught:
        mw.read(path)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400
    return str(caught.value)


PART = ("*PART, NAME={name}\n*NODE\n1, 0,0,0\n2, {size},0,0\n3, 0,{size},0\n4, 0,0,{size}\n"
        "*ELEMENT, TYPE=C3D4\n1, 1,2,3,4\n*END PART\n")  # fmt: skip


def test_parts_have_numbers_of_their_own_and_are_used_more_than_once(tmp_path: Path) -> None:
    text = PART.format(name="a", size=3) + PART.format(name="b", size=1) + (
        "*ASSEMBLY, NAME=x\n*INSTANCE, NAME=i, PART=A\n*END INSTANCE\n"
        "*INSTANCE, NAME=j, PART=b\n0, 0, 300\n*END INSTANCE\n"
        "*INSTANCE, NAME=k, PART=b\n500, 0, 0\n500, 0, 0, 500, 0, 1, 90\n*END INSTANCE\n*END ASSEMBLY\n"
    )  # fmt: skip
    path = deck(tmp_path, text)
    large, *small = (mw.read(path, component).vertices for component in range(3))
    assert np.ptp(large, axis=0) == pytest.approx([3, 3, 3])
    lows = sorted((each.min(axis=0) for each in small), key=lambda low: low[0])
    assert lows[0] == pytest.approx([0, 0, 300]) and lows[1] == pytest.approx([499, 0, 0])


def test_a_part_without_an_instance_is_named(tmp_path: Path) -> None:
    text = PART.format(name="Used", size=3) + PART.format(name="Idle", size=1)
    path = deck(tmp_path, text + "*ASSEMBLY\n*INSTANCE, PART=used\n*END INSTANCE\n*END ASSEMBLY\n")
    assert mw.read(path).warnings == ("parts that no instance uses are left out: Idle",)


@pytest.mark.parametrize(("head", "nodes"), [
    ("*NODE, SYSTEM=C\n", ["2, 0, 0", "2, 90, 0", "2, 180.0, 0", "2, 0, 1"]),
    ("*NODE, NSET=n, SYSTEM=S\n", ["2, 0, 0", "2, 90, 0", "2, 180, 0", "2.2360679774997896964, 0, 26.56505117707799"]),
    ("*SYSTEM\n10,0,0, 10,1,0, 9,0,0\n*NODE\n", ["0, 8, 0", "2, 10, 0", "0, 12, 0", "0, 8, 1"]),
])  # fmt: skip
def test_nodes_in_other_coordinates(head: str, nodes: list[str], tmp_path: Path) -> None:
    rows = "".join(f"{k + 1}, {node}\n" for k, node in enumerate(nodes))
    mesh = mw.read(deck(tmp_path, head + rows + "*ELEMENT, TYPE=S3\n1, 1,2,3\n2, 1,2,4\n"))
    wanted = [[-2, 0, 0], [0, 2, 0], [2, 0, 0], [2, 0, 1]]
    assert np.array(sorted(mesh.vertices.round(9).tolist())) == pytest.approx(np.array(wanted), abs=1e-9)


@pytest.mark.parametrize("key", ["*INCLUDE, INPUT=a.inp", "*NODE, INPUT=a", "*Element, type=S3, input=a",
                                 "*NGEN\n1,9,1", "*NCOPY, CHANGE NUMBER=9"])  # fmt: skip
def test_what_a_deck_makes_or_takes_from_elsewhere_is_refused_by_name(key: str, tmp_path: Path) -> None:
    words = refusal(deck(tmp_path, f"*NODE\n1,0,0,0\n{key}\n"))
    assert key.split(",")[0].split("\n")[0].upper() in words


def test_unknown_elements_are_counted(tmp_path: Path) -> None:
    text = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n*ELEMENT, TYPE=S3\n1,1,2,3\n*ELEMENT, TYPE=U99\n2,1,2\n3,2,3\n"
    assert mw.read(deck(tmp_path, text)).warnings == (
        "2 elements of types that are not known (U99) are left out, of 3",
    )
    assert "U99" in refusal(deck(tmp_path, text.replace("S3", "U99")))
    assert "node 7" in refusal(deck(tmp_path, text.replace("1,1,2,3", "1,1,2,7")))


@pytest.mark.parametrize(("kind", "names"), {
    "triangle": "S3 S3R STRI3 M3D3 R3D3 DS3 SFM3D3", "quad": "S4 S4R S4R5 S4RS M3D4R R3D4 DS4 SFM3D4R",
    "quad8": "S8R S8R5 M3D8 DS8", "triangle6": "STRI65 M3D6 DS6", "quad9": "S9R5 M3D9",
    "tetra": "C3D4 C3D4H DC3D4 AC3D4", "tetra10": "C3D10 C3D10M C3D10MH C3D10T", "wedge": "C3D6 SC6R COH3D6",
    "hexahedron": "C3D8 C3D8R C3D8I C3D8RT SC8R COH3D8 AC3D8R", "hexahedron20": "C3D20 C3D20R C3D20RH DC3D20",
    "wedge15": "C3D15 C3D15V", "pyramid": "C3D5", "": "MASS ROTARYI SPRING1 SPRINGA B31 T3D2 PIPE31 CONN3D2 GAPUNI D",
}.items())  # fmt: skip
def test_types_of_elements(kind: str, names: str) -> None:
    assert {name: cell_kind(name) for name in names.split()} == dict.fromkeys(names.split(), kind)


def test_concave_polygons_keep_their_area(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    for count in (4, 5, 8, 30, 200):
        turn = 2.0 * np.pi * (np.arange(count) + 0.3 * rng.random(count)) / count
        radius = rng.uniform(0.2, 1.0, count)
        flat = np.column_stack([radius * np.cos(turn), radius * np.sin(turn), np.zeros(count)])
        points = flat @ np.linalg.qr(rng.normal(size=(3, 3)))[0] + rng.normal(size=3)
        faces, crossed = cut_polygons(points, np.array([count]), np.arange(count))
        x, y = flat[:, :2].T
        assert crossed == 0 and len(faces) == count - 2
        assert areas(points, faces).sum() == pytest.approx(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2.0)
        sides = {tuple(sorted(pair)) for face in faces.tolist() for pair in zip(face, np.roll(face, 1), strict=True)}
        assert {tuple(sorted((k, (k + 1) % count))) for k in range(count)} <= sides  # no side is bridged
    arrow = "v 0 0 0\nv 4 2 0\nv 0 4 0\nv 1 2 0\nf 1 2 3 4\n"
    for turned in ("1 2 3 4", "2 3 4 1", "4 3 2 1"):
        (tmp_path / "arrow.obj").write_text(arrow.replace("f 1 2 3 4", f"f {turned}"))
        mesh = mw.read(tmp_path / "arrow.obj")
        assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(6.0)
    bow = np.array([[0, 0, 0], [2, 2, 0], [2, 0, 0], [0, 2, 0], [-1, 1, 0.0]])
    assert cut_polygons(bow, np.array([5]), np.arange(5))[1] in (0, 1)


def test_shells_beside_solids(tmp_path: Path) -> None:
    cube = np.array([[x, y, z] for z in (0, 1, 2) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    far = np.array([[9, 0, 0], [12, 0, 0], [12, 3, 0], [9, 3, 0]], dtype=float)
    cells = [("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7], [4, 5, 6, 7, 8, 9, 10, 11]]),
             ("quad", [[0, 1, 2, 3], [4, 5, 6, 7], [12, 13, 14, 15]])]  # fmt: skip
    mesh = meshio.Mesh(np.concatenate([cube, far]), [(kind, np.array(nodes)) for kind, nodes in cells])
    mesh.write(tmp_path / "part.vtu")
    solid, sheet = mw.read(tmp_path / "part.vtu"), mw.read(tmp_path / "part.vtu", 1)
    assert volume(solid.vertices, solid.faces) == pytest.approx(2.0) and len(solid.faces) == 20
    assert areas(sheet.vertices, sheet.faces).sum() == pytest.approx(9.0)
    inside = "surface cells inside the solid are left out: 1"
    assert solid.warnings[0] == inside and "component=1 takes that instead" in solid.warnings[1]
    assert sheet.warnings == (inside,)


@pytest.mark.parametrize(("kind", "order", "size"), [
    ("VOXEL", [0, 1, 3, 2, 4, 5, 7, 6], 1.0), ("HEXAHEDRON", range(8), 1.0), ("PIXEL", [0, 1, 3, 2], 0.0),
])  # fmt: skip
def test_kinds_of_cells(kind: str, order: Any, size: float, tmp_path: Path) -> None:
    corners = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    grid = pv.UnstructuredGrid([len(order), *order], [getattr(pv.CellType, kind)], corners)
    grid.save(tmp_path / "part.vtu")
    mesh = mw.read(tmp_path / "part.vtu")
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(6.0 if size else 1.0)


def test_polyhedra_beside_wedges(tmp_path: Path) -> None:
    turn = 2.0 * np.pi * np.arange(6) / 6
    rows = [np.column_stack([np.cos(turn), np.sin(turn), np.full(6, z)]) for z in (0.0, 1.0, 2.0)]
    points = np.concatenate([*rows, [[0, 0, 0], [0, 0, 1]]])
    sides = [[6 + k, 6 + (k + 1) % 6, 12 + (k + 1) % 6, 12 + k] for k in range(6)]
    caps = [[6 + k for k in range(6)], [12 + k for k in range(6)]]
    faces = [*sides, *caps]
    stream = [len(faces), *(number for face in faces for number in (len(face), *face))]
    below = [[18, (k + 1) % 6, k, 19, 6 + (k + 1) % 6, 6 + k] for k in range(6)]
    cells = [len(stream), *stream, *(number for wedge in below for number in (6, *wedge))]
    grid = pv.UnstructuredGrid(cells, [42, *[13] * 6], points)
    grid.save(tmp_path / "part.vtu")
    mesh = mw.read(tmp_path / "part.vtu")
    assert np.ptp(mesh.vertices, axis=0)[2] == pytest.approx(2.0)


def changed_gltf(**more: Any) -> bytes:
    scene = json.loads(BY_HAND["gltf H"])
    return json.dumps(scene | more).encode()


@pytest.mark.parametrize(("content", "says"), [
    (changed_gltf(extensionsRequired=["KHR_draco_mesh_compression"]), "KHR_draco_mesh_compression (compr"),
    (changed_gltf(extensionsRequired=["EXT_unheard_of"]), "EXT_unheard_of"),
    (changed_gltf(asset={"version": "1.0"}), "is glTF 1.0, not 2.0"),
    (changed_gltf(buffers=[{"uri": "beside.bin", "byteLength": 4}]), "its buffer beside.bin is not in its folder"),
])  # fmt: skip
def test_what_a_gltf_needs_is_named(content: bytes, says: str, tmp_path: Path) -> None:
    (tmp_path / "part.gltf").write_bytes(content)
    assert says in refusal(tmp_path / "part.gltf")


@pytest.mark.parametrize(
    ("code", "kind", "least"), [(5122, "h", 32767), (5123, "H", 65535), (5121, "B", 255), (5120, "b", 127)]
)
def test_normalised_integers(code: int, kind: str, least: int, tmp_path: Path) -> None:
    scene = json.loads(BY_HAND["gltf "])
    grid = np.array([[0, 0, 0], [least, 0, 0], [0, least, 0]]).astype(kind)
    data = b"".join(row.tobytes().ljust(8, b"\0") for row in grid)
    uri = trimesh.util.base64.b64encode(data).decode()
    scene["buffers"] = [{"uri": f"data:;base64,{uri}", "byteLength": len(data)}]
    scene["bufferViews"] = [{"buffer": 0, "byteLength": len(data), "byteStride": 8}]
    scene["accessors"] = [{"bufferView": 0, "componentType": code, "normalized": True, "count": 3, "type": "VEC3"}]
    scene["extensionsRequired"] = ["KHR_mesh_quantization"]
    (tmp_path / "part.gltf").write_text(json.dumps(scene))
    mesh = mw.read(tmp_path / "part.gltf")
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(0.5, rel=1e-12)


def test_an_extension_that_a_3mf_requires_is_named(tmp_path: Path) -> None:
    space = "http://schemas.microsoft.com/3dmanufacturing/beamlattice/2017/02"
    with zipfile.ZipFile(tmp_path / "part.3mf", "w") as archive:
        archive.writestr("3D/3dmodel.model", f'<model xmlns:b="{space}" requiredextensions="b"><build/></model>')
    assert space in refusal(tmp_path / "part.3mf")


@pytest.mark.parametrize("far", [5.4e6, 3e5])
def test_coordinates_that_are_too_coarse(far: float, tmp_path: Path) -> None:
    scaled = POINTS / 50.0 + far
    facets = b"".join(struct.pack("<12fH", 0, 0, 1, *scaled[face].ravel(), 0) for face in FACES)
    (tmp_path / "far.stl").write_bytes(bytes(80) + struct.pack("<I", 80) + facets)
    (tmp_path / "far.obj").write_text(
        "".join("v {:.7g} {:.7g} {:.7g}\n".format(*point) for point in scaled)
        + "".join("f {} {} {}\n".format(*(face + 1)) for face in FACES)
    )
    for name in ("far.stl", "far.obj"):
        assert "steps of" in refusal(tmp_path / name) and "move the part to the origin" in refusal(tmp_path / name)
    whole = mw.read((scaled, FACES))
    assert whole.warnings == ()


def test_the_unit_of_the_file_and_of_the_user(tmp_path: Path) -> None:
    path = tmp_path / "part.gltf"
    path.write_bytes(BY_HAND["gltf H"])
    assert (mw.read(path).units, mw.read(path).units_from) == ("m", "as glTF always is")
    given = mw.read(path, units="mm")
    assert (given.units, given.units_from) == ("mm", "given")
    assert given.warnings == (
        "lengths are taken in 'mm', as given, though the file is in 'm', as glTF always is; nothing is converted",
    )
    assert mw.read(path, units="M").warnings == ()
    (tmp_path / "part.obj").write_bytes(BY_HAND["obj plain  '\\n'"])
    assert mw.read(tmp_path / "part.obj").units == ""


@pytest.mark.parametrize("kind", ["trimesh", "scene", "polydata", "grid", "meshio", "triangles", "quads"])
def test_meshes_of_other_libraries(kind: str) -> None:
    surface = trimesh.Trimesh(POINTS, FACES, process=False)
    surface.units = "inches"
    meshes: dict[str, Any] = {
        "trimesh": surface, "scene": trimesh.Scene([surface]), "polydata": pv.make_tri_mesh(POINTS, FACES),
        "grid": pv.make_tri_mesh(POINTS, FACES).cast_to_unstructured_grid(),
        "meshio": meshio.Mesh(POINTS, [("triangle", FACES)]), "triangles": (POINTS, FACES), "quads": [POINTS, QUADS],
    }  # fmt: skip
    mesh = mw.read(meshes[kind])
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(AREA, rel=1e-9)
    assert mesh.units == ("in" if kind in ("trimesh", "scene") else "")


@pytest.mark.parametrize("text", [
    "u0;v0;u1;v1\n0,0;0,0;0,25;1,0\n", "u0\tv0\tu1\tv1\n0\t0\t0.25\t1\n", "\ufeffu0,v0,u1,v1\n0,0,0.25,1\n",
    "sep=;\nu0;v0;u1;v1\n0;0;0.25;1\n",
])  # fmt: skip
@pytest.mark.parametrize("encoding", ["utf-8", "utf-16"])
def test_pins_of_other_programs(text: str, encoding: str, tmp_path: Path) -> None:
    (tmp_path / "pins.csv").write_text(text.removeprefix("\ufeff") if encoding == "utf-16" else text, encoding=encoding)
    ends = read_pins(tmp_path / "pins.csv", mw.shapes.cylinder(1.0, 3.0), 0.5)
    assert ends.start[0] == pytest.approx([0.0, 0.0]) and ends.end[0] == pytest.approx([0.25, 1.0])


RING = 12


def second_order_ring() -> Any:
    """A ring of radii 1 and 2 and height 1 of hexahedra whose mid-side nodes lie on the circles."""
    numbers: dict[tuple[int, ...], int] = {}

    def number(place: Any) -> int:
        return numbers.setdefault((int(place[0]), int(place[1]) % (2 * RING), int(place[2])), len(numbers))

    edges = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
    cells = []
    for k in range(RING):
        ring = (0, 2 * k), (2, 2 * k), (2, 2 * k + 2), (0, 2 * k + 2)
        corners = np.array([(r, t, z) for z in (0, 2) for r, t in ring])
        middle = [(corners[a] + corners[b]) // 2 for a, b in edges]
        cells.append([number(place) for place in (*corners, *middle)])
    r, t, z = np.array(list(numbers)).T / 2.0
    turn = 2.0 * np.pi * t / RING
    points = np.column_stack([(1.0 + r) * np.cos(turn), (1.0 + r) * np.sin(turn), z])
    return meshio.Mesh(points, [("hexahedron20", np.array(cells))])


@pytest.mark.parametrize("suffix", ["vtu", "vtk", "msh", "inp"])
def test_nodes_on_the_sides_of_cells_are_used(suffix: str, tmp_path: Path) -> None:
    given: dict[str, Any] = {"file_format": "gmsh", "binary": False} if suffix == "msh" else {}
    second_order_ring().write(tmp_path / f"ring.{suffix}", **given)
    mesh = mw.read(tmp_path / f"ring.{suffix}")
    exact = 3.0 * RING * np.sin(np.pi / RING)  # of the polygon through all nodes on the circles
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(exact, rel=1e-9) and mesh.warnings == ()


SECOND_ORDER = {
    "triangle6": ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [(0, 1), (1, 2), (2, 0)], 0.5),
    "quad8": ([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [(0, 1), (1, 2), (2, 3), (3, 0)], 1.0),
    "tetra10": ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
                1.5 + np.sqrt(0.75)),
    "wedge15": ([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1]],
                [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)], 3.0 + np.sqrt(2.0)),
}  # fmt: skip


@pytest.mark.parametrize("kind", SECOND_ORDER)
def test_flat_cells_of_second_order_have_the_same_area(kind: str, tmp_path: Path) -> None:
    corners, edges, area = SECOND_ORDER[kind]
    points = np.array([*corners, *((np.array(corners[a]) + corners[b]) / 2.0 for a, b in edges)], dtype=float)
    number = {"triangle6": 22, "quad8": 23, "tetra10": 24, "wedge15": 26}[kind]
    pv.UnstructuredGrid([len(points), *range(len(points))], [number], points).save(tmp_path / "part.vtu")
    mesh = mw.read(tmp_path / "part.vtu")
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(area, rel=1e-12)
    assert len(mesh.vertices) == len(points)
