"""fibers.vtu and fibers.vtk: directions, angles and thickness against exact helices."""

from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista as pv
from export_results import leave, plain_results, waisted_results
from layup_shapes import cylinder, drawn, straight_uv

from meshwind.core.errors import BadInputError
from meshwind.exporting.elements import on_crossings, regular
from meshwind.exporting.fibers import FILES, write_fibers
from meshwind.exporting.plies import plies
from meshwind.layup.coverage import coverage
from meshwind.layup.direction import winding_angle
from meshwind.surface.grid import grid


@pytest.mark.parametrize("name", FILES)
def test_helices_are_exact_in_both_files(tmp_path: Path, name: str) -> None:
    results = plain_results(tmp_path)
    elements = regular(results.surface, 500)
    write_fibers(tmp_path, elements, plies(results, elements))
    read = meshio.read(tmp_path / name)
    data = {key: values[0] for key, values in read.cell_data.items()}
    centre = read.points[read.cells[0].data].mean(axis=1)
    turn = np.arctan2(centre[:, 1], centre[:, 0])
    for number, sense in ((1, 1.0), (2, -1.0)):
        exact = np.stack([-np.sin(turn) * sense * np.pi, np.cos(turn) * sense * np.pi, np.full_like(turn, 4.0)], 1)
        exact /= np.hypot(np.pi, 4.0)
        assert np.abs(data[f"fibre_{number}"] - exact).max() < 1e-4
        assert np.array_equal(data[f"fibre_{number}"], data[f"FIB_DIR{number}"])
        assert np.abs(data[f"angle_{number}"] - sense * np.degrees(np.arctan2(np.pi, 4.0))).max() < 1e-3
    assert np.allclose(data["thickness"], data["thickness_1"] + data["thickness_2"])
    assert np.abs((data["normal"] * data["fibre_1"]).sum(axis=1)).max() < 1e-12


def test_other_readers_see_the_cells(tmp_path: Path) -> None:
    results = waisted_results(tmp_path)
    elements = on_crossings(results)
    laid = plies(results, elements)
    write_fibers(tmp_path, elements, laid)
    for name in FILES:
        read = pv.read(tmp_path / name)
        assert read.n_cells == len(elements) == len(elements.quads) + len(elements.triangles)
        assert np.allclose(read.cell_data["FIB_DIR2"], laid.families[1].direction)
        assert np.linalg.norm(read.cell_data["FIB_DIR1"], axis=1) == pytest.approx(1.0)


def test_volume_of_fibre_is_that_of_the_bands(tmp_path: Path) -> None:
    """Thickness over the area adds up to length x width x thickness of a layer, family by family."""
    results = plain_results(tmp_path)
    elements = regular(results.surface, 2000)
    laid = plies(results, elements, layer=0.01, width=0.2)
    corners = elements.points[elements.quads]
    area = 0.5 * np.linalg.norm(np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1]), axis=1)
    for ply in laid.families:
        mine = results.paths.points[results.paths.family == ply.family]
        length = np.linalg.norm(np.diff(mine, axis=1), axis=2).sum()
        assert (ply.thickness * area).sum() == pytest.approx(0.01 * 0.2 * length, rel=0.01)


def test_angles_are_those_of_the_map(tmp_path: Path) -> None:
    results = waisted_results(tmp_path)
    on = grid(results.surface, 2)
    elements = regular(results.surface, 300)
    laid = plies(results, elements)
    cell = np.round(elements.centre * [on.shape[0], on.shape[1] - 1]).astype(int)
    mapped = winding_angle(results.paths, *on.shape)[cell[:, 0] % on.shape[0], cell[:, 1]]
    assert np.abs(np.abs(laid.families[0].angle) - mapped).max() < np.radians(2.0)


def test_a_family_that_is_not_there_has_no_field(tmp_path: Path) -> None:
    uv, _ = straight_uv(6, 0.25, 101)
    results = leave(tmp_path, drawn(cylinder(64), uv[:6], np.ones(6)))
    elements = regular(results.surface, 200)
    laid = plies(results, elements)
    assert [ply.family for ply in laid.families] == [1]
    assert np.allclose(laid.families[0].layers.mean(), coverage(results.paths, results.band_width).layers.mean())
    write_fibers(tmp_path, elements, laid)
    assert not {"FIB_DIR2", "angle_2"} & set(meshio.read(tmp_path / "fibers.vtu").cell_data)


@pytest.mark.parametrize(("given", "says"), [({"layer": 0.0}, "thickness is 0"), ({"width": -1.0}, "band width is -1")])
def test_lengths_that_are_none_are_refused(tmp_path: Path, given: dict[str, float], says: str) -> None:
    results = plain_results(tmp_path)
    with pytest.raises(BadInputError, match=says):
        plies(results, regular(results.surface, 100), **given)
