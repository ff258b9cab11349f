"""Scalars of VTK, VTU and VTP files stay with their cells beside lines, strips, polyhedra and hidden cells."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import pyvista as pv
from test_read_vtk import AROUND, POINTS, QUADS, cell_list, grid_of, legacy, polyhedron, rod, strips
from vtkmodules.vtkCommonCore import vtkIdList

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.io.scalars import read_scalars, scalar_names


def rises(points: Floats) -> Floats:
    return np.asarray(points @ [0.01, 0.02, 0.1])


def belongs(path: Path, count: int) -> bool:
    """Whether each value of `mu` is that of the point it is given with."""
    held = read_scalars(path, "mu")
    return len(held.values) == count and np.allclose(held.values, rises(held.points), rtol=0.0, atol=1e-9)


def cell_means(data: Any) -> Floats:
    """Means of the nodes of each cell, in VTK's own order, and for strips and polyhedra as well."""
    held = vtkIdList()
    means = []
    for k in range(data.GetNumberOfCells()):
        data.GetCellPoints(k, held)
        nodes = [held.GetId(i) for i in range(held.GetNumberOfIds())]
        means.append(np.asarray(data.points)[nodes].mean(axis=0))
    return np.array(means)


@pytest.mark.parametrize("dims", [(11, 5, 1), (11, 1, 5), (1, 11, 5)])
@pytest.mark.parametrize("binary", [False, True])
def test_structured_grids_of_one_layer(dims: tuple[int, int, int], binary: bool, tmp_path: Path) -> None:
    ring = np.concatenate([np.vstack([POINTS[k : k + AROUND], POINTS[k : k + 1]]) for k in range(0, 50, AROUND)])
    grid = pv.StructuredGrid()
    grid.points = ring
    grid.dimensions = dims
    grid.point_data["mu"] = rises(ring)
    grid.save(tmp_path / "part.vtk", binary=binary)
    assert belongs(tmp_path / "part.vtk", 55)
    del grid.point_data["mu"]
    grid.cell_data["mu"] = rises(cell_means(grid))
    grid.save(tmp_path / "part.vtk", binary=binary)
    assert belongs(tmp_path / "part.vtk", 40)


def test_structured_grids_of_several_layers_and_hidden_cells(tmp_path: Path) -> None:
    x, y, z = np.meshgrid(np.arange(3.0), np.arange(4.0), np.arange(5.0), indexing="ij")
    grid = pv.StructuredGrid(x, y, z)
    values = rises(cell_means(grid))
    grid.cell_data["mu"] = values
    grid.save(tmp_path / "part.vtk")
    assert belongs(tmp_path / "part.vtk", 24)
    values[[3, 7]] = np.nan  # hidden cells need no value
    grid.cell_data["mu"] = values
    grid.hide_cells([3, 7], inplace=True)
    grid.save(tmp_path / "part.vtk")
    assert belongs(tmp_path / "part.vtk", 22) and scalar_names(tmp_path / "part.vtk") == ("mu",)


@pytest.mark.parametrize("suffix", [".vtk", ".vtp"])
@pytest.mark.parametrize("hidden", [[], [2, 5, 22]])
def test_polygons_beside_lines_and_strips(suffix: str, hidden: list[int], tmp_path: Path) -> None:
    """The cells are a vertex, a line, 20 quadrangles and two strips in turn; hidden ones have no value."""
    surface = pv.PolyData(POINTS, verts=[1, 0], lines=[2, 0, 1], faces=np.insert(QUADS[:20], 0, 4, axis=1),
                          strips=np.concatenate([[len(row), *row] for row in strips()[2:]]))  # fmt: skip
    values = rises(cell_means(surface))
    values[[0, 1, *hidden]] = np.nan
    surface.cell_data["mu"] = values
    if hidden:
        surface.cell_data["vtkGhostType"] = np.isin(np.arange(24), hidden).astype(np.uint8) * 32
    surface.save(tmp_path / f"part{suffix}")
    assert belongs(tmp_path / f"part{suffix}", 22 - len(hidden))
    assert scalar_names(tmp_path / f"part{suffix}") == ("mu",)


@pytest.mark.parametrize("suffix", [".vtk", ".vtu"])
@pytest.mark.parametrize("hidden", [False, True])
def test_polyhedra_between_other_cells(suffix: str, hidden: bool, tmp_path: Path) -> None:
    """A hexahedron and a line between polyhedra, which VTK's kinds would sort otherwise."""
    cube = np.array([[x, y, z] for z in range(5) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    sides = np.array([[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]])
    cells = [polyhedron((sides + 4 * k).tolist()) for k in range(3)]
    grid = grid_of([cells[0], [0, 1], cells[1], list(range(12, 20)), cells[2]], [42, 3, 42, 12, 42], cube)
    values = rises(cell_means(grid))
    values[1] = np.nan
    grid.cell_data["mu"] = values
    if hidden:
        grid.cell_data["vtkGhostType"] = np.array([0, 0, 1, 0, 0], dtype=np.uint8)
    grid.save(tmp_path / f"part{suffix}")
    assert belongs(tmp_path / f"part{suffix}", 3 if hidden else 4)


def test_points_without_cells_need_no_value(tmp_path: Path) -> None:
    grid = grid_of(QUADS.tolist(), [9] * 40, np.concatenate([POINTS, [[0.0, 0.0, 0.0]]]))
    grid.point_data["mu"] = np.append(rises(POINTS), np.nan)
    grid.save(tmp_path / "part.vtu")
    assert belongs(tmp_path / "part.vtu", 50)


def test_a_sum_of_wedges_and_polyhedra(tmp_path: Path) -> None:
    grid, _ = rod(2)
    grid.cell_data["mu"] = np.arange(7.0)
    grid.save(tmp_path / "part.vtu")
    held = read_scalars(tmp_path / "part.vtu", "mu")
    assert (held.points[:, 2] < 1.0).tolist() == (held.values < 5.0).tolist() == [True] * 5 + [False] * 2


def test_an_array_of_another_length_is_refused_by_name(tmp_path: Path) -> None:
    fields = "CELL_DATA 40\nFIELD FieldData 2\nshort 1 30 double\n" + "1 " * 30 + "\nmu 1 40 double\n"
    whole = " ".join(str(value) for value in rises(POINTS[QUADS].mean(axis=1)))
    (tmp_path / "part.vtk").write_text(legacy(cell_list("POLYGONS", QUADS), fields + whole + "\n"))
    assert belongs(tmp_path / "part.vtk", 40)
    with pytest.raises(BadInputError, match="'short' has 30 values for 40 points or cells") as refusal:
        read_scalars(tmp_path / "part.vtk", "short")
    assert "\n" not in str(refusal.value)
