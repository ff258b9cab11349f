"""Every file read back by the libraries that users read them with."""

import json
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
import pyvista as pv
from layup_shapes import bridged, cylinder, helices
from scipy.interpolate import BSpline

from meshwind.layup.layup import Layup, assess
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.lengths import bridges, lengths
from meshwind.results import schema
from meshwind.results.report import RunFacts, plain, report, write_report
from meshwind.results.write import surface_maps, write_files
from meshwind.surface.grid import grid

DOUBTED = bridged()
LAID = {
    "bridged": assess(
        replace(DOUBTED, surface=replace(DOUBTED.surface, uncertainty=np.full((2, 3), 1e-9), threshold=1e-9))
    ),
    "plain": assess(helices(8, 1.0, 101, cylinder())),
    "uncrossed": assess(helices(6, 0.0, 31, cylinder())),
}


def part_of(layup: Layup) -> Mesh:
    """The surface's own samples as a triangle mesh."""
    on = grid(layup.paths.surface)
    return Mesh(on.points, np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]]), repairs=("none",))


@pytest.fixture(scope="module", params=sorted(LAID))
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Layup, Path]:
    layup = LAID[request.param]
    out = tmp_path_factory.mktemp(request.param)
    write_files(out, layup, surface_maps(layup, part_of(layup)))
    return layup, out


def held(layup: Layup, fields: tuple[schema.Field, ...]) -> list[schema.Field]:
    """Those of a file's fields that a surface with or without uncertainty and threshold gives it."""
    surface = layup.paths.surface
    known = {schema.UNCERTAINTY: surface.uncertainty, schema.THRESHOLD: surface.threshold}
    return [field for field in fields if known.get(field, True) is not None]


def test_all_files_are_there(written: tuple[Layup, Path]) -> None:
    assert sorted(file.name for file in written[1].iterdir()) == [
        "bridges.vtp",
        "chart.png",
        "crossings.vtp",
        "paths.vtp",
        "quads.obj",
        "quads.vtu",
        "surface.npz",
        "surface.vtu",
    ]


@pytest.mark.parametrize("file", [schema.PATHS, schema.BRIDGES, schema.CROSSINGS, schema.QUADS, schema.SURFACE])
def test_fields_are_those_of_the_schema(written: tuple[Layup, Path], file: schema.File) -> None:
    """Names in their order, types, and how many values each has."""
    read = pv.read(written[1] / file)
    for fields, data in ((file.point_data, read.point_data), (file.cell_data, read.cell_data)):
        assert data.keys() == held(written[0], fields)
        for field in held(written[0], fields):
            values = data[field]
            assert str(values.dtype) == field.dtype
            assert values.size == field.columns * len(values)


def test_the_spline_has_the_arrays_of_the_schema(written: tuple[Layup, Path]) -> None:
    with np.load(written[1] / schema.SPLINE) as arrays:
        assert list(arrays) == held(written[0], schema.SPLINE.point_data)


def test_paths(written: tuple[Layup, Path]) -> None:
    paths = written[0].paths
    poly = pv.read(written[1] / "paths.vtp")
    p, n = paths.gap.shape
    assert poly.points.dtype == np.float64
    assert np.array_equal(poly.points.reshape(p, n, 3), paths.points)
    assert poly.n_lines == poly.n_cells == p
    cells = poly.lines.reshape(p, n + 1)
    assert np.array_equal(cells, np.column_stack([np.full(p, n), np.arange(p * n).reshape(p, n)]))
    figures = lengths(paths)
    for name, values in {
        "uv": paths.uv,
        "gap": paths.gap,
        "normal": paths.normal,
        "slip": paths.slip,
        "arc_length": figures.arc_length,
    }.items():
        assert np.array_equal(poly.point_data[name].ravel(), values.ravel(), equal_nan=True), name
        assert poly.point_data[name].dtype == np.float64, name
    assert poly.point_data["on_surface"].dtype == np.uint8
    assert np.array_equal(poly.point_data["on_surface"], paths.on_surface.ravel())
    names = {"path", "family", "length", "fibre_length", "bridged_length", "max_gap", "max_slip", "status", "residual"}
    assert set(poly.cell_data.keys()) == names
    steps = np.linalg.norm(np.diff(poly.points.reshape(p, n, 3), axis=1), axis=2)
    assert np.allclose(poly.cell_data["length"], steps.sum(axis=1), rtol=1e-12)
    assert np.array_equal(poly.cell_data["fibre_length"], paths.length)
    assert np.array_equal(poly.cell_data["path"], np.arange(p))
    assert set(poly.cell_data["family"]) == {1, -1}
    assert all(np.isfinite(values).all() for values in poly.cell_data.values())


def test_bridges(written: tuple[Layup, Path]) -> None:
    paths = written[0].paths
    poly = pv.read(written[1] / "bridges.vtp")
    wanted = sum(int((np.diff(np.pad(on.astype(int), 1, constant_values=1)) == -1).sum()) for on in paths.on_surface)
    assert poly.n_lines == poly.n_cells == wanted
    if not wanted:
        assert poly.n_points == 0
        return
    assert poly.points.dtype == np.float64
    cells = np.asarray(poly.lines)
    at = 0
    for k in range(wanted):
        line = cells[at + 1 : at + 1 + cells[at]]
        at += cells[at] + 1
        gap = poly.point_data["gap"][line]
        assert gap[[0, -1]].tolist() == [0.0, 0.0]
        assert (gap[1:-1] > 0.0).all()
        assert poly.cell_data["max_gap"][k] == gap.max()
        chord = np.linalg.norm(poly.points[line[-1]] - poly.points[line[0]])
        assert poly.cell_data["length"][k] == pytest.approx(chord, rel=1e-12)
        owner = poly.cell_data["path"][k]
        assert (np.abs(paths.points[owner] - poly.points[line[0]]).max(axis=1) == 0.0).any()
    assert poly.cell_data["length"].sum() == pytest.approx(lengths(paths).bridged_length.sum(), rel=1e-12)


def test_crossings(written: tuple[Layup, Path]) -> None:
    met = written[0].crossings
    poly = pv.read(written[1] / "crossings.vtp")
    assert poly.n_points == poly.n_verts == len(met)
    assert poly.points.dtype == np.float64
    assert np.array_equal(poly.points, met.points)
    if len(met):
        assert np.allclose(np.abs(np.cos(np.radians(poly.point_data["angle"]))), poly.point_data["quality"])
        assert poly.point_data["angle"].max() <= 90.0
        assert np.array_equal(poly.point_data["path_a"], met.path_a)
        assert np.array_equal(poly.point_data["path_b"], met.path_b)
        assert np.array_equal(poly.point_data["uv"], met.uv)


def test_quads(written: tuple[Layup, Path]) -> None:
    mesh = written[0].quads
    read = meshio.read(written[1] / "quads.vtu")
    assert np.array_equal(read.points, mesh.points)
    assert read.points.dtype == np.float64
    cells = {block.type: block.data for block in read.cells}
    assert set(cells) <= ({"vertex"} if mesh.note else {"quad", "triangle"})
    assert np.array_equal(cells.get("quad", np.zeros((0, 4))), mesh.quads)
    assert np.array_equal(cells.get("triangle", np.zeros((0, 3))), mesh.triangles)
    faces = pv.read(written[1] / "quads.vtu").celltypes != 1
    assert faces.sum() == len(mesh.quads) + len(mesh.triangles)


def test_quads_as_obj(written: tuple[Layup, Path]) -> None:
    mesh = written[0].quads
    rows = [line.split() for line in (written[1] / "quads.obj").read_text().splitlines() if line[0] in "vf"]
    points = [list(map(float, row[1:])) for row in rows if row[0] == "v"]
    faces = [[int(item) - 1 for item in row[1:]] for row in rows if row[0] == "f"]
    assert np.array_equal(np.reshape(points, (-1, 3)), mesh.points)
    assert faces == mesh.quads.tolist() + mesh.triangles.tolist()


def test_surface_grid_and_maps(written: tuple[Layup, Path]) -> None:
    surface = written[0].paths.surface
    read = meshio.read(written[1] / "surface.vtu")
    assert read.points.dtype == np.float64
    (block,) = read.cells
    assert block.type == "quad"
    names = {
        "uv",
        "normal",
        "gaussian_curvature",
        "mean_curvature",
        "windability",
        "press_direction",
        "press_reach",
        "class",
        "angle",
        "coverage",
        "layers",
        "fit_error",
        "stretch",
    }
    assert set(read.point_data) == names | ({"uncertainty"} if surface.uncertainty is not None else set())
    assert all(np.isfinite(values).all() for values in read.point_data.values())
    assert np.allclose(read.points, surface.points(read.point_data["uv"]), atol=1e-14)
    edges = np.stack([block.data, np.roll(block.data, -1, axis=1)], axis=2).reshape(-1, 2)
    assert len(np.unique(edges, axis=0)) == len(edges)  # one orientation
    undirected, counts = np.unique(np.sort(edges, axis=1), axis=0, return_counts=True)
    assert len(read.points) - len(undirected) + len(block.data) == 0  # closed in u, open in v
    assert counts.max() == 2
    corner = read.points[block.data]
    normal = np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    assert ((normal * read.point_data["normal"][block.data].mean(axis=1)).sum(axis=1) > 0).all()
    assert read.point_data["fit_error"].max() < 1e-12


def test_surface_itself_comes_back_from_the_npz(written: tuple[Layup, Path]) -> None:
    surface = written[0].paths.surface
    with np.load(written[1] / "surface.npz") as held:
        assert int(held["degree"]) == 3
        assert bool(held["periodic_u"])
        net = held["control_points"]
        net = np.concatenate([net, net[:3]])
        in_u = BSpline(held["knots_u"], net, 3)
        in_v = BSpline(held["knots_v"], in_u(0.3), 3)
    assert np.abs(in_v(0.7) - surface.points([[0.3, 0.7]])[0]).max() < 1e-13


def test_a_bridge_from_the_fixed_end_includes_it() -> None:
    paths = LAID["bridged"].paths
    flags = np.ones((len(paths), paths.gap.shape[1]), dtype=bool)
    flags[0, :4] = False
    flags[2, -3:] = False
    flags[2, 10] = False
    spans = bridges(replace(paths, on_surface=flags, gap=np.where(flags, 0.0, 0.5)))
    last = paths.gap.shape[1] - 1
    assert np.column_stack([spans.path, spans.first, spans.last]).tolist() == [
        [0, 0, 4],
        [2, 9, 11],
        [2, last - 3, last],
    ]
    assert spans.max_gap.tolist() == [0.5, 0.5, 0.5]


def test_report_agrees_with_the_files(written: tuple[Layup, Path]) -> None:
    layup, out = written
    write_report(out / "report.json", report(layup, part_of(layup), None, RunFacts(1.0, seconds={"fit": 0.1})))

    def refuse(constant: str) -> None:
        raise AssertionError(f"{constant} is not JSON")

    figures = json.loads((out / "report.json").read_text(), parse_constant=refuse)
    (out / "report.json").unlink()
    wanted = {
        "meshwind": None,
        "command": None,
        "mesh": {"vertices", "faces", "units", "repairs"},
        "surface": {"control_points", "fit_error", "flipped_triangles"},
        "winding": {"revolutions", "paths_per_family", "particles", "friction"},
        "paths": {"converged", "not_converged", "length_total", "length_error", "position_error", "max_gap"},
        "crossings": {"count", "angle"},
        "coverage": {"min", "median", "max"},
        "quads": {"faces", "quads", "triangles"},
        "model": {"lifting", "friction", "surface_evaluations"},
        "seconds": {"fit"},
    }
    assert set(figures) >= set(wanted)
    for section, keys in wanted.items():
        assert keys is None or set(figures[section]) >= keys, section
    poly = pv.read(out / "paths.vtp")
    assert figures["paths"]["length_total"] == pytest.approx(poly.cell_data["fibre_length"].sum(), rel=1e-12)
    assert figures["paths"]["length_error"] == pytest.approx(layup.paths.length_error.sum(), rel=1e-12)
    assert figures["paths"]["position_error"] == layup.paths.position_error.max()
    assert figures["paths"]["max_gap"] == poly.cell_data["max_gap"].max()
    assert figures["crossings"]["count"] == pv.read(out / "crossings.vtp").n_points
    assert figures["quads"]["faces"] == (pv.read(out / "quads.vtu").celltypes != 1).sum()
    assert figures["model"]["lifting"] == bool(pv.read(out / "bridges.vtp").n_cells)
    if figures["crossings"]["count"] == 0:
        assert figures["crossings"]["angle"] == {"min": None, "median": None, "max": None}
        assert "more revolutions" in figures["quads"]["note"]


def test_report_names_every_path_that_failed() -> None:
    layup = LAID["plain"]
    status = np.zeros(16, dtype=np.int64)
    status[[3, 7]] = [2, 4]
    paths = replace(layup.paths, status=status)
    failed = report(assess(paths), part_of(layup), None, RunFacts(1.0))["paths"]["not_converged"]
    assert [(item["path"], item["status"], item["name"]) for item in failed] == [
        (3, 2, "slid_off_end"),
        (7, 4, "stalled"),
    ]
    assert all(item["why"].startswith(item["meaning"]) and "may" in item["why"] for item in failed)


def test_what_is_not_finite_becomes_null() -> None:
    odd = {"a": float("nan"), "b": [np.float64("inf"), np.int64(3)], "c": np.array([1.0, np.nan]), 4: (True, None)}
    assert plain(odd) == {"a": None, "b": [None, 3], "c": [1.0, None], "4": [True, None]}
