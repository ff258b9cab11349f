"""VTK, VTU and VTP files: every kind of list and grid, in every version and encoding, is read whole or refused."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from vtkmodules.vtkIOLegacy import vtkDataSetWriter
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.read import load
from meshwind.mesh.io.vtk.announced import check_counts

AROUND = 10


def barrel() -> tuple[Floats, Ints]:
    """Points of an open barrel of five rings, and its 40 quadrangles."""
    turn = 2.0 * np.pi * np.arange(AROUND) / AROUND
    rings = [np.column_stack([r * np.cos(turn), r * np.sin(turn), np.full(AROUND, z)])
             for r, z in ((20, 0), (23, 25), (25, 50), (23, 75), (21, 100))]  # fmt: skip
    k, i = np.divmod(np.arange(4 * AROUND), AROUND)
    a, b = k * AROUND + i, k * AROUND + (i + 1) % AROUND
    return np.round(np.concatenate(rings) * 64.0) / 64.0, np.column_stack([a, b, b + AROUND, a + AROUND])


POINTS, QUADS = barrel()
FACES = np.concatenate([QUADS[:, :3], QUADS[:, [0, 2, 3]]])
AREA = float(areas(POINTS, FACES).sum())


def text(points: Floats) -> str:
    return "\n".join("{} {} {}".format(*point) for point in points.tolist())


def rows(table: Any) -> str:
    return "\n".join(f"{len(row)} " + " ".join(map(str, row)) for row in table)


def strips() -> list[list[int]]:
    """The quadrangles of a ring as one strip."""
    return [[n for i in range(AROUND + 1) for n in (k * AROUND + i % AROUND, (k + 1) * AROUND + i % AROUND)]
            for k in range(4)]  # fmt: skip


def cell_list(keyword: str, table: Any, version: str = "4.2") -> str:
    table = [list(map(int, row)) for row in table]
    size = sum(map(len, table))
    if version != "5.1":
        return f"{keyword} {len(table)} {size + len(table)}\n{rows(table)}\n"
    offsets = np.concatenate([[0], np.cumsum([len(row) for row in table])]).tolist()
    nodes = " ".join(str(n) for row in table for n in row)
    offset_words = " ".join(map(str, offsets))
    return (
        f"{keyword} {len(offsets)} {size}\nOFFSETS vtktypeint64\n{offset_words}\nCONNECTIVITY vtktypeint64\n{nodes}\n"
    )


def legacy(*lists: str, version: str = "4.2", data_set: str = "POLYDATA", title: str = "barrel") -> str:
    head = f"# vtk DataFile Version {version}\n{title}\nASCII\nDATASET {data_set}\n"
    return head + f"POINTS {len(POINTS)} double\n{text(POINTS)}\n" + "".join(lists)


def is_barrel(held: FileMesh) -> bool:
    return len(held.faces) == 80 and areas(held.vertices, held.faces).sum() == pytest.approx(AREA, rel=1e-12)


def refusal(path: Path) -> str:
    with pytest.raises(BadInputError) as caught:
        load(path)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400
    return str(caught.value)


def said(path: Path, content: str | bytes) -> str:
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return refusal(path)


@pytest.mark.parametrize("version", ["1.0", "2.0", "3.0", "4.2", "5.1"])
@pytest.mark.parametrize("end", ["\n", "\r\n", "\r"])
def test_lists_of_polygons_and_strips(version: str, end: str, tmp_path: Path) -> None:
    halves = [cell_list("POLYGONS", QUADS[:20], version), cell_list("TRIANGLE_STRIPS", strips()[2:], version)]
    variants = {
        "both": halves, "strips": [cell_list("TRIANGLE_STRIPS", strips(), version)],
        "strips first": halves[::-1], "triangles": [cell_list("POLYGONS", FACES, version)],
        "lines": [cell_list("VERTICES", [[0]], version), cell_list("LINES", [[0, 1, 2]], version), *halves],
        "data": [*halves, f"POINT_DATA {len(POINTS)}\nSCALARS s float 1\nLOOKUP_TABLE default\n" + "1 " * len(POINTS),
                 "\nFIELD FieldData 1\nname 1 2 int\n3 4\n"],
    }  # fmt: skip
    for lists in variants.values():
        path = tmp_path / "part.vtk"
        path.write_bytes(legacy(*lists, version=version).replace("\n", end).encode())
        held = load(path)
        assert is_barrel(held) and held.warnings == () and held.units == ""


@pytest.mark.parametrize("change", [str.lower, str.title, lambda line: f"  {line}"])
def test_keywords_in_any_case(change: Callable[[str], str], tmp_path: Path) -> None:
    content = legacy(cell_list("POLYGONS", QUADS))
    head, rest = content.split("\n", 1)
    lines = [change(line) if line and line[0].isalpha() else line for line in rest.split("\n")]
    path = tmp_path / "part.vtk"
    path.write_text("\n".join([head, *lines]))
    assert is_barrel(load(path))
    grid = legacy(cell_list("CELLS", QUADS), "CELL_TYPES 40\n" + "9 " * 40, data_set="UNSTRUCTURED_GRID")
    head, rest = grid.split("\n", 1)
    path.write_text(
        "\n".join([head, *(change(line) if line and line[0].isalpha() else line for line in rest.split("\n"))])
    )
    assert is_barrel(load(path))


LISTS = legacy(cell_list("POLYGONS", QUADS))


@pytest.mark.parametrize(("content", "says"), [
    (LISTS.replace("POLYGONS 40 200", "POLYGONS 41 205"), "its list POLYGONS has 200 numbers, where it announces 205"),
    (LISTS.replace("POLYGONS 40 200", "POLYGONS 39 195"), "its list POLYGONS has 200 numbers, where it announces 195"),
    (LISTS.replace("POINTS 50", "POINTS 49"), "its list POINTS has 150 numbers, where it announces 147"),
    (LISTS[: len(LISTS) * 9 // 10], "where it announces 200"),
    (LISTS.replace("POLYGONS 40", "SPLINES 3 4\nPOLYGONS 40"), "it announces 40 polygons, of which 0 can be read"),
    (legacy(cell_list("POLYGONS", QUADS[:20]), cell_list("POLYGONS", QUADS[20:])),
     "it announces 40 polygons, of which 20 can be read"),
    (LISTS.replace("double", "sextuple"), "it announces 50 points, of which 0 can be read"),
])  # fmt: skip
def test_what_a_legacy_file_announces_is_compared(content: str, says: str, tmp_path: Path) -> None:
    assert says in said(tmp_path / "part.vtk", content)


def test_a_keyword_over_two_lines_and_a_byte_order_mark(tmp_path: Path) -> None:
    (tmp_path / "part.vtk").write_text("\ufeff" + LISTS.replace("POLYGONS 40", "POLYGONS\n40"), encoding="utf-8")
    assert is_barrel(load(tmp_path / "part.vtk"))


@pytest.mark.parametrize(("old", "new", "says"), [
    ('Polys="40"', 'Polys="41"', "damaged"), ('Points="50"', 'Points="51"', "damaged"),
    ("vtkZLibDataCompressor", "vtkBrotliDataCompressor", "is compressed by vtkBrotliDataCompressor"),
])  # fmt: skip
def test_what_an_xml_file_announces_is_compared(old: str, new: str, says: str, tmp_path: Path) -> None:
    SURFACE.save(tmp_path / "part.vtp", binary=False)
    content = (tmp_path / "part.vtp").read_text()
    assert old in content and says in said(tmp_path / "part.vtp", content.replace(old, new))


def test_counts_are_compared() -> None:
    check_counts({"points": 3, "cells": 2}, {"points": 3, "cells": 2})
    with pytest.raises(ValueError, match="it announces 3 cells, of which 2 can be read"):
        check_counts({"points": 3, "cells": 3}, {"points": 3, "cells": 2})


def grid_of(cells: list[list[int]], kinds: list[int], points: Floats) -> Any:
    return pv.UnstructuredGrid(np.concatenate([[len(row), *row] for row in cells]), kinds, points)


BARREL = grid_of(QUADS.tolist(), [9] * 40, POINTS)
SURFACE = pv.PolyData(POINTS, faces=np.insert(QUADS, 0, 4, axis=1))


@pytest.mark.parametrize("mode", ["Ascii", "Binary", "Appended"])
@pytest.mark.parametrize("packing", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("large", [False, True])
def test_xml_in_every_encoding(mode: str, packing: str, large: bool, tmp_path: Path) -> None:
    for data, writer in ((BARREL, vtkXMLUnstructuredGridWriter()), (SURFACE, vtkXMLPolyDataWriter())):
        path = tmp_path / ("part.vtu" if data is BARREL else "part.vtp")
        writer.SetFileName(str(path))
        writer.SetInputData(data)
        getattr(writer, f"SetDataModeTo{mode}")()
        getattr(writer, f"SetCompressorTypeTo{packing}")()
        writer.SetHeaderTypeToUInt64() if large else writer.SetHeaderTypeToUInt32()
        writer.SetByteOrderToBigEndian() if large else writer.SetByteOrderToLittleEndian()
        writer.SetEncodeAppendedData(large)
        assert writer.Write() == 1
        assert is_barrel(load(path)) and load(path).warnings == ()


@pytest.mark.parametrize("version", [42, 51])
@pytest.mark.parametrize("binary", [False, True])
def test_legacy_by_vtk(version: int, binary: bool, tmp_path: Path) -> None:
    for data in (BARREL, SURFACE, SURFACE.strip()):
        writer = vtkDataSetWriter()
        writer.SetFileName(str(tmp_path / "part.vtk"))
        writer.SetInputData(data)
        writer.SetFileVersion(version)
        writer.SetFileType(2 if binary else 1)
        assert writer.Write() == 1
        assert is_barrel(load(tmp_path / "part.vtk"))


def test_files_are_known_by_their_content(tmp_path: Path) -> None:
    SURFACE.save(tmp_path / "part.vtp")
    (tmp_path / "part.vtp").rename(tmp_path / "part.vtk")
    assert is_barrel(load(tmp_path / "part.vtk"))
    assert "damaged" in said(tmp_path / "part.vtu", "solid part\nendsolid part\n")


def prism_rows(count: int) -> Floats:
    turn = 2.0 * np.pi * np.arange(count) / count
    return np.concatenate([np.column_stack([np.cos(turn), np.sin(turn), np.full(count, z)]) for z in (0.0, 1.0, 2.0)])


def polyhedron(faces: list[list[int]]) -> list[int]:
    return [len(faces), *(number for face in faces for number in (len(face), *face))]


def rod(times: int = 1) -> tuple[Any, float]:
    """A rod of five sides: wedges below, a polyhedron above that is given once or several times, and its area."""
    points = np.concatenate([prism_rows(5), [[0, 0, 0], [0, 0, 1.0]]])
    around = [[(k + 1) % 5, k] for k in range(5)]
    wedges = [[15, b, a, 16, 5 + b, 5 + a] for b, a in around]
    faces = [*([5 + a, 5 + b, 10 + b, 10 + a] for b, a in around), list(range(10, 15)), [9, 8, 7, 6, 5]]
    grid = grid_of([*wedges, *[polyhedron(faces)] * times], [13] * 5 + [42] * times, points)
    side = 2.0 * np.sin(np.pi / 5)
    return grid, 10.0 * side + 5.0 * np.sin(2.0 * np.pi / 5)


@pytest.mark.parametrize("name", ["part.vtu", "ascii.vtu", "part.vtk"])
@pytest.mark.parametrize("times", [1, 2, 3])
def test_polyhedra_beside_wedges(name: str, times: int, tmp_path: Path) -> None:
    grid, area = rod(times)
    grid.save(tmp_path / name, binary=name != "ascii.vtu")
    mesh = mw.read(tmp_path / name)
    assert np.ptp(mesh.vertices[:, 2]) == pytest.approx(2.0)
    assert areas(mesh.vertices, mesh.faces).sum() == pytest.approx(area, rel=1e-12)


def test_polyhedra_of_older_files(tmp_path: Path) -> None:
    """The arrays `faces` and `faceoffsets`, which VTK wrote before version 9.4."""
    points = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))])
    faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    stream = polyhedron(faces)

    def array(name: str, kind: str, values: Any) -> str:
        return f'<DataArray type="{kind}" Name="{name}" format="ascii">{" ".join(map(str, values))}</DataArray>'

    (tmp_path / "part.vtu").write_text(
        '<?xml version="1.0"?><VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian">'
        '<UnstructuredGrid><Piece NumberOfPoints="8" NumberOfCells="1"><Points>'
        f'<DataArray type="Float64" NumberOfComponents="3" format="ascii">{text(points)}</DataArray></Points><Cells>'
        + array("connectivity", "Int64", range(8)) + array("offsets", "Int64", [8]) + array("types", "UInt8", [42])
        + array("faces", "Int64", stream) + array("faceoffsets", "Int64", [len(stream)])
        + "</Cells></Piece></UnstructuredGrid></VTKFile>"
    )  # fmt: skip
    mesh = mw.read(tmp_path / "part.vtu")
    assert len(mesh.faces) == 12 and volume(mesh.vertices, mesh.faces) == pytest.approx(1.0)


def test_pieces_of_a_solid_share_no_wall(tmp_path: Path) -> None:
    """Each piece has points of its own, also where two of them meet."""
    piece = '<Piece NumberOfPoints="8" NumberOfCells="1"><Points><DataArray type="Float64" NumberOfComponents="3">{}' \
        '</DataArray></Points><Cells><DataArray type="Int32" Name="connectivity">0 1 2 3 4 5 6 7</DataArray>' \
        '<DataArray type="Int32" Name="offsets">8</DataArray><DataArray type="UInt8" Name="types">12</DataArray>' \
        "</Cells></Piece>"  # fmt: skip
    points = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    body = "".join(piece.format(text(points + [0, 0, z])) for z in (0, 1))
    (tmp_path / "part.vtu").write_text(
        '<VTKFile type="UnstructuredGrid" version="0.1" byte_order="LittleEndian"><UnstructuredGrid>'
        f"{body}</UnstructuredGrid></VTKFile>"
    )
    mesh = mw.read(tmp_path / "part.vtu")
    assert len(load(tmp_path / "part.vtu").faces) == 20
    assert len(mesh.faces) == 20 and volume(mesh.vertices, mesh.faces) == pytest.approx(2.0)


@pytest.mark.parametrize("suffix", [".vtu", ".vtk"])
def test_ghost_cells_are_left_out(suffix: str, tmp_path: Path) -> None:
    extra = np.array([[0, 1, 12, 11], [2, 3, 14, 13], [4, 5, 16, 15]])
    grid = grid_of([*QUADS.tolist(), *extra.tolist()], [9] * 43, POINTS)
    grid.cell_data["vtkGhostType"] = np.array([0] * 40 + [1, 32, 8], dtype=np.uint8)
    grid.save(tmp_path / f"part{suffix}")
    held = load(tmp_path / f"part{suffix}")
    words = "cells that are marked as hidden or as copies (vtkGhostType) are left out: 3 of 43"
    assert is_barrel(held) and held.warnings == (words,)


def test_ghosts_among_polygons_and_polyhedra(tmp_path: Path) -> None:
    surface = pv.PolyData(POINTS, faces=np.insert(QUADS, 0, 4, axis=1), lines=[2, 0, 1])
    surface.cell_data["vtkGhostType"] = np.array([1, 32] + [0] * 39, dtype=np.uint8)
    surface.save(tmp_path / "part.vtp")
    assert len(load(tmp_path / "part.vtp").faces) == 78
    grid, _ = rod()
    grid.cell_data["vtkGhostType"] = np.array([0] * 5 + [1], dtype=np.uint8)
    grid.save(tmp_path / "part.vtu")
    assert np.ptp(mw.read(tmp_path / "part.vtu").vertices[:, 2]) == pytest.approx(1.0)


@pytest.mark.parametrize("dims", [(11, 5, 1), (11, 1, 5), (1, 11, 5)])
def test_a_structured_grid_of_one_layer_is_a_surface(dims: tuple[int, int, int], tmp_path: Path) -> None:
    ring = np.concatenate([np.vstack([POINTS[k : k + AROUND], POINTS[k : k + 1]]) for k in range(0, 50, AROUND)])
    head = f"# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_GRID\nDIMENSIONS {dims[0]} {dims[1]} {dims[2]}\n"
    (tmp_path / "part.vtk").write_text(head + f"POINTS {len(ring)} double\n{text(ring)}\n")
    assert is_barrel(load(tmp_path / "part.vtk"))


def test_a_structured_grid_of_several_layers_is_a_solid(tmp_path: Path) -> None:
    x, y, z = np.meshgrid(np.arange(3.0), np.arange(4.0), np.arange(5.0), indexing="ij")
    grid = pv.StructuredGrid(x, y, z)
    grid.save(tmp_path / "part.vtk")
    mesh = mw.read(tmp_path / "part.vtk")
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(24.0) and mesh.warnings == ()
    grid.hide_cells([0], inplace=True)
    grid.save(tmp_path / "part.vtk")
    mesh = mw.read(tmp_path / "part.vtk")
    assert volume(mesh.vertices, mesh.faces) == pytest.approx(23.0) and "1 of 24" in mesh.warnings[0]


@pytest.mark.parametrize(("body", "says"), [
    ("DATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 1\nX_COORDINATES 2 float\n0 1\nY_COORDINATES 2 float\n0 1\n"
     "Z_COORDINATES 1 float\n0\n", "holds a rectilinear grid, no polygons or cells"),
    ("DATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n", "holds an image"),
    ("DATASET MULTIBLOCK\nCHILD 10\n", "holds several blocks"),
    ("FIELD FieldData 1\na 1 1 int\n3\n", "holds a field without a mesh"),
    ("DATASET SPLINES\n", "holds a data set of the kind SPLINES"),
])  # fmt: skip
def test_other_data_is_refused_by_name(body: str, says: str, tmp_path: Path) -> None:
    words = said(tmp_path / "part.vtk", f"# vtk DataFile Version 4.2\nx\nASCII\n{body}")
    assert says in words and "save the part's surface as VTP, PLY or STL" in words
    other = '<VTKFile type="vtkMultiBlockDataSet"><vtkMultiBlockDataSet/></VTKFile>'
    assert "holds VTK's vtkMultiBlockDataSet" in said(tmp_path / "part.vtu", other)


def test_cells_of_any_order(tmp_path: Path) -> None:
    """Lagrange cells of second order have the nodes of quadratic ones; others are flat between corners, in words."""
    points = np.array([[0, 0, 0], [2, 0, 0], [0, 2, 0], [1, 0, 1], [1, 1, 1], [0, 1, 1], [0, 0, 1], [0, 0, 2]],
                      dtype=float)  # fmt: skip
    grid_of([[0, 1, 2, 3, 4, 5]], [69], points).save(tmp_path / "part.vtu")
    held = load(tmp_path / "part.vtu")
    assert len(held.faces) == 4 and held.warnings == ()
    grid_of([[0, 1, 2, 3, 4, 5], [0, 1, 7]], [76, 69], points).save(tmp_path / "part.vtu")
    held = load(tmp_path / "part.vtu")
    words = "1 Bezier cells of 6 nodes (VTK's kind 76) are taken flat between their corners"
    assert len(held.faces) == 2 and held.warnings == (words,)


def test_kinds_that_are_not_known(tmp_path: Path) -> None:
    content = legacy(cell_list("CELLS", [*QUADS, [0, 1, 2], [0]]), "CELL_TYPES 42\n" + "9 " * 40 + "51 1\n",
                     data_set="UNSTRUCTURED_GRID")  # fmt: skip
    (tmp_path / "part.vtk").write_text(content)
    held = load(tmp_path / "part.vtk")
    assert is_barrel(held) and held.warnings == ("1 of 41 cells are of the kind 'VTK 51', which is not read; left out",)
    content = legacy(cell_list("CELLS", [[0, 1, 2]]), "CELL_TYPES 1\n51\n", data_set="UNSTRUCTURED_GRID")
    assert "its 1 cells are of kinds that are not read: VTK 51" in said(tmp_path / "part.vtk", content)


def test_the_unit_in_files_of_meshwind(tmp_path: Path) -> None:
    title = "meshwind, paths of a winding, lengths in cm"
    (tmp_path / "part.vtk").write_text(legacy(cell_list("POLYGONS", QUADS), title=title))
    assert load(tmp_path / "part.vtk").units == "cm"
    for unit, found in (("in", "in"), ("furlong", "furlong")):
        labelled = pv.PolyData(POINTS, faces=np.insert(QUADS, 0, 4, axis=1))
        array = labelled.GetPoints().GetData()
        array.GetInformation().Set(array.UNITS_LABEL(), unit)
        labelled.save(tmp_path / "part.vtp")
        assert load(tmp_path / "part.vtp").units == found


@pytest.mark.parametrize(("name", "advice"), [
    ("part.vtm", "save one block or step as VTU or VTP, or as one of STL"), ("part.pvtu", "save one block or step"),
    ("part.vti", "save the part's surface as VTP"), ("part.e", "save the mesh as VTU"),
])  # fmt: skip
def test_advice_on_kindred_formats(name: str, advice: str, tmp_path: Path) -> None:
    assert f"unknown format '.{name.split('.')[1]}'; {advice}" in said(tmp_path / name, "x")
