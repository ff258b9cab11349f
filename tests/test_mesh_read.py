"""Reading: every format gives the same part, and other files are refused in one line, silently."""

import zipfile
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista
import trimesh
from mesh_shapes import Part, pear
from vtkmodules.vtkIOLegacy import vtkPolyDataWriter

from meshwind.core.errors import BadInputError
from meshwind.mesh import SUFFIXES, Mesh, read
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.geometry.topology import euler
from meshwind.mesh.io.cad import CAD

MODEL = """<?xml version="1.0"?>
<model unit="millimeter" xmlns="http://schemas.microsoft.com/3dmanufacturing/core/2015/02">
<resources><object id="1"><mesh><vertices>{vertices}</vertices><triangles>{faces}</triangles></mesh></object>
<object id="2"><components><component objectid="1" transform="0 1 0 -1 0 0 0 0 1 0 0 7"/></components></object>
</resources>
<build><item objectid="2" transform="1 0 0 0 1 0 0 0 1 5 0 0"/></build></model>"""


def save_3mf(path: Path, part: Part) -> None:
    vertices = "".join('<vertex x="{}" y="{}" z="{}"/>'.format(*map(float, point)) for point in part[0])
    faces = "".join('<triangle v1="{}" v2="{}" v3="{}"/>'.format(*face) for face in part[1])
    with zipfile.ZipFile(path, "w") as archive:
        archive.writestr("3D/3dmodel.model", MODEL.format(vertices=vertices, faces=faces))


def save(path: Path, part: Part, kind: str) -> None:
    """Write the part in a format; `kind` may name a variant of it."""
    surface = trimesh.Trimesh(*part, process=False)
    cells = meshio.Mesh(part[0], [("triangle", part[1])])
    if kind in ("stl_ascii", "stl", "obj", "off", "glb"):
        surface.export(path, file_type=kind)
    elif kind.startswith("ply"):
        surface.export(path, encoding="ascii" if "ascii" in kind else "binary")
    elif kind == "3mf":
        save_3mf(path, part)
    elif kind.startswith("msh"):
        cells.write(path, file_format=kind.replace("msh", "gmsh"), binary=False)
    elif kind == "inp":
        cells.write(path)
    elif kind.startswith("vtu"):
        pyvista.wrap(surface).cast_to_unstructured_grid().save(path, binary="ascii" not in kind)
    elif kind == "vtk_old":
        writer = vtkPolyDataWriter()
        writer.SetFileVersion(42)
        writer.SetFileTypeToBinary()
        writer.SetInputData(pyvista.wrap(surface))
        writer.SetFileName(str(path))
        writer.Write()
    elif kind == "vtk_grid":
        pyvista.wrap(surface).cast_to_unstructured_grid().save(path)
    else:
        pyvista.wrap(surface).save(path, binary="ascii" not in kind)


KINDS = ["stl", "stl_ascii", "ply", "ply_ascii", "obj", "off", "glb", "3mf", "msh", "msh22", "inp",
         "vtk", "vtk_ascii", "vtk_grid", "vtk_old", "vtu", "vtu_ascii", "vtp", "vtp_ascii"]  # fmt: skip


@pytest.mark.parametrize("kind", KINDS)
def test_every_format_gives_the_same_part(kind: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    part = pear(2)
    path = tmp_path / f"part.{kind.split('_')[0].rstrip('2')}"
    save(path, part, kind)
    capfd.readouterr()
    mesh = read(path)
    assert capfd.readouterr() == ("", "")
    assert mesh.name == path.name and mesh.read_faces == len(part[1])
    assert (len(mesh.vertices), len(mesh.faces), euler(mesh.faces)) == (len(part[0]), len(part[1]), 2)
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(volume(*part), rel=1e-6)
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(areas(*part).sum(), rel=1e-6)


def test_all_formats_are_tried() -> None:
    by_others = {".gltf", *CAD}  # in test_hostile_files.py and test_read_cad.py
    assert {f".{kind.split('_')[0].rstrip('2')}" for kind in KINDS} | by_others == set(SUFFIXES)


def test_upper_case_and_text_paths(tmp_path: Path) -> None:
    save(tmp_path / "part.STL", pear(2), "stl")
    assert len(read(str(tmp_path / "part.STL")).faces) == len(pear(2)[1])


def test_coordinates_of_text_keep_all_digits(tmp_path: Path) -> None:
    save(tmp_path / "part.vtu", pear(2), "vtu")
    assert np.array_equal(read(tmp_path / "part.vtu").vertices, pear(2)[0])


def test_3mf_objects_are_transformed(tmp_path: Path) -> None:
    part = pear(1)
    save_3mf(tmp_path / "part.3mf", part)
    x, y, z = part[0].T
    assert np.abs(read(tmp_path / "part.3mf").vertices - np.column_stack([5 - y, x, z + 7])).max() < 1e-12


CUBE = "".join(f"v {x} {y} {z}\n" for z in (0, 1) for y in (0, 1) for x in (0, 1))


def test_obj_polygons_and_negative_indices(tmp_path: Path) -> None:
    sides = "f 1 3 4 2\nf -4 -3 -1 -2\nf 1/1/1 2/1/1 6/1/1 5/1/1\nf 3 7 8 4\nf 1 5 7 3\nf 2//1 4//1 8//1 6//1\n"
    (tmp_path / "cube.obj").write_text(CUBE + "vt 0 0\nvn 0 0 1\n" + sides)
    mesh = read(tmp_path / "cube.obj")
    assert (len(mesh.vertices), len(mesh.faces)) == (8, 12)
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(1.0, rel=1e-15)


CORNERS = np.array([[x, y, z] for z in (0.0, 1.0) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
APEX = np.concatenate([CORNERS, [[0.5, 0.5, 2.0]]])
VOLUMES: dict[str, tuple[list[tuple[str, list[list[int]]]], float, int]] = {
    "hexahedron": ([("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7]])], 1.0, 12),
    "tetra": ([("tetra", [[0, 1, 3, 4], [1, 2, 3, 6], [1, 6, 4, 5], [3, 4, 6, 7], [1, 3, 4, 6]])], 1.0, 12),
    "wedge": ([("wedge", [[0, 1, 2, 4, 5, 6], [0, 2, 3, 4, 6, 7]])], 1.0, 12),
    "house": ([("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7]]), ("pyramid", [[4, 5, 6, 7, 8]])], 4 / 3, 14),
    "with its surface": ([("quad", [[0, 3, 2, 1]]), ("hexahedron", [[0, 1, 2, 3, 4, 5, 6, 7]])], 1.0, 12),
}  # fmt: skip


# INP as meshio writes it has no pyramids
WRITABLE = [(name, suffix) for name in VOLUMES for suffix in (".vtu", ".msh", ".vtk", ".inp")]


@pytest.mark.parametrize(("name", "suffix"), [case for case in WRITABLE if case != ("house", ".inp")])
def test_volume_mesh_gives_its_skin(name: str, suffix: str, tmp_path: Path) -> None:
    cells, size, faces = VOLUMES[name]
    grid = meshio.Mesh(APEX, [(kind, np.array(nodes)) for kind, nodes in cells])
    path = tmp_path / f"part{suffix}"
    grid.write(path, **({"file_format": "gmsh22", "binary": False} if suffix == ".msh" else {}))
    mesh = read(path)
    assert len(mesh.faces) == faces and euler(mesh.faces) == 2
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(size, rel=1e-12)
    assert "turned" not in " ".join(mesh.repairs)  # the skin looks outward from the first


def refusal(path: Path) -> str:
    with pytest.raises(BadInputError) as caught:
        read(path)
    text = str(caught.value)
    assert text.startswith(f"{path.name}: ") and "\n" not in text and "; " in text
    return text.removeprefix(f"{path.name}: ")


def test_missing_folder_and_unknown(tmp_path: Path) -> None:
    advice = "give the path of a triangle mesh (STL, OBJ, PLY, ...)"
    assert refusal(tmp_path / "part.stl") == f"file not found; {advice}"
    (tmp_path / "folder.stl").mkdir()
    assert refusal(tmp_path / "folder.stl") == f"is a folder; {advice}"
    (tmp_path / "part.sldprt").write_text("any")
    assert refusal(tmp_path / "part.sldprt") == "is a file of a CAD program, not a mesh; export it there as STEP or STL"
    (tmp_path / "part.nas").write_text("BEGIN BULK")
    assert refusal(tmp_path / "part.nas").startswith("unknown format '.nas'; convert the mesh to one of STL, PLY, OBJ")
    (tmp_path / "part.dae").write_text("x")
    assert refusal(tmp_path / "part.dae").startswith("unknown format '.dae'; convert the mesh to one of STL, PLY")
    (tmp_path / "part").write_text("solid")
    assert refusal(tmp_path / "part").startswith("unknown format ''")


GARBAGE = {
    "text": b"Dear colleague,\nthis is not a mesh.\n",
    "zeros": bytes(500),
    "noise": np.random.default_rng(0).bytes(2000),
    "line": b"\n",
}


@pytest.mark.parametrize("content", GARBAGE)
@pytest.mark.parametrize("suffix", SUFFIXES)
def test_garbage_is_refused_silently(
    suffix: str, content: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / f"part{suffix}"
    path.write_bytes(GARBAGE[content])
    assert "give" in refusal(path) or "export" in refusal(path)
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_empty_file(suffix: str, tmp_path: Path) -> None:
    (tmp_path / f"part{suffix}").touch()
    assert refusal(tmp_path / f"part{suffix}").startswith("is empty; give")


def damaged(content: bytes, rng: np.random.Generator) -> bytes:
    """The file cut short, overwritten at some positions, or with a piece left out."""
    data = bytearray(content)
    at = int(rng.integers(1, len(data)))
    way = rng.integers(4)
    if way == 0:
        return bytes(data[:at])
    if way == 1:
        del data[at : at + int(rng.integers(1, 50))]
    for position in rng.integers(len(data) if way == 2 else min(300, len(data)), size=8):
        data[position] = rng.integers(256) if rng.random() < 0.5 else rng.choice(list(b"09 -eE\n"))
    return bytes(data)


@pytest.mark.parametrize("kind", KINDS)
def test_damaged_file_is_read_or_refused(kind: str, tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / f"part.{kind.split('_')[0].rstrip('2')}"
    save(path, pear(1), kind)
    content, rng = path.read_bytes(), np.random.default_rng(len(kind))
    capfd.readouterr()
    for _ in range(25):
        path.write_bytes(damaged(content, rng))
        try:
            mesh = read(path)
        except BadInputError as error:
            assert str(error).startswith(path.name) and "\n" not in str(error)
        else:
            assert isinstance(mesh, Mesh) and np.isfinite(mesh.vertices).all()
    assert capfd.readouterr() == ("", "")


def test_nan_and_no_triangles(tmp_path: Path) -> None:
    (tmp_path / "nan.obj").write_text("v 0 0 0\nv 1 0 0\nv nan 1 0\nf 1 2 3\n")
    assert refusal(tmp_path / "nan.obj").startswith("1 of 3 vertices have NaN or infinite coordinates; remove them")
    (tmp_path / "points.obj").write_text(CUBE)
    assert "export" in refusal(tmp_path / "points.obj")
    (tmp_path / "lines.vtp").write_bytes(b"")
    pyvista.Line().save(tmp_path / "lines.vtp")
    assert refusal(tmp_path / "lines.vtp").startswith("holds no triangles; export")
    meshio.Mesh(CORNERS, [("line", np.array([[0, 1]]))]).write(tmp_path / "lines.vtu")
    assert refusal(tmp_path / "lines.vtu").startswith("holds no triangles; export")
    pyvista.ImageData(dimensions=(3, 3, 3)).save(tmp_path / "image.vtk")
    assert refusal(tmp_path / "image.vtk").startswith("holds an image (structured points), no polygons or cells; save")
