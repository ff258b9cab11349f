"""VTU and VTP files whose arrays hold more than they announce are refused; VTK reads as much as is announced."""

import re
from pathlib import Path
from typing import Any

import pytest
from test_read_vtk import BARREL, SURFACE, is_barrel, said
from vtkmodules.vtkIOXML import vtkXMLPolyDataWriter, vtkXMLUnstructuredGridWriter

from meshwind.mesh.io.read import load
from meshwind.mesh.io.vtk.arrays import held_by_xml

MODES = [("Ascii", False), ("Binary", False), ("Appended", False), ("Appended", True)]


def saved(folder: Path, data: Any, mode: tuple[str, bool], packing: str, large: bool) -> Path:
    """A file by VTK; mode: how arrays are written, and whether appended ones are in letters."""
    path = folder / ("part.vtp" if data is SURFACE else "part.vtu")
    writer = vtkXMLPolyDataWriter() if data is SURFACE else vtkXMLUnstructuredGridWriter()
    writer.SetFileName(str(path))
    writer.SetInputData(data)
    getattr(writer, f"SetDataModeTo{mode[0]}")()
    getattr(writer, f"SetCompressorTypeTo{packing}")()
    writer.SetBlockSize(64 * 8)  # several blocks
    writer.SetHeaderTypeToUInt64() if large else writer.SetHeaderTypeToUInt32()
    writer.SetByteOrderToBigEndian() if large else writer.SetByteOrderToLittleEndian()
    writer.SetEncodeAppendedData(mode[1])
    assert writer.Write() == 1
    return path


@pytest.mark.parametrize("mode", MODES)
@pytest.mark.parametrize("packing", ["None", "ZLib", "LZ4", "LZMA"])
@pytest.mark.parametrize("large", [False, True])
def test_more_than_is_announced(mode: tuple[str, bool], packing: str, large: bool, tmp_path: Path) -> None:
    for data, cells, word in ((SURFACE, "Polys", "polygons"), (BARREL, "Cells", "cells")):
        path = saved(tmp_path, data, mode, packing, large)
        content = path.read_bytes()
        assert is_barrel(load(path)) and load(path).warnings == ()
        assert held_by_xml(content) == {"points": 50, word: 40, f"nodes of {word}": 160} | (
            {"strips": 0, "nodes of strips": 0} if data is SURFACE else {})  # fmt: skip
        fewer = re.sub(rb'NumberOf%s="40"' % cells.encode(), b'NumberOf%s="38"' % cells.encode(), content)
        assert f"its arrays hold 40 {word}, of which it announces 38 only" in said(path, fewer)
        unused = re.sub(rb'NumberOfPoints="50"', b'NumberOfPoints="49"', content)
        assert "its arrays hold 50 points, of which it announces 49 only" in said(path, unused)


def test_nodes_after_the_last_offset(tmp_path: Path) -> None:
    path = saved(tmp_path, BARREL, ("Ascii", False), "None", False)
    text = path.read_text()
    more = re.sub(r'(Name="connectivity"[^>]*>)', r"\1 0 1 2 3 ", text, count=1)
    assert "its arrays hold 164 nodes of cells, of which it announces 160 only" in said(path, more)


def test_what_cannot_be_told_is_left_out() -> None:
    array = '<DataArray type="{}" format="{}" {}>AAAA</DataArray>'
    told = [("Float64", "binary", ""), ("String", "binary", ""), ("Float64", "odd", ""),
            ("Float64", "appended", 'offset="9"'), ("Float64", "ascii", 'TimeStep="1"')]  # fmt: skip
    for kind, written, more in told:
        content = f"<VTKFile><Piece><Points>{array.format(kind, written, more)}</Points></Piece></VTKFile>"
        assert held_by_xml(content.encode()) == {}
