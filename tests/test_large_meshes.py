"""What large meshes and many paths cost: counts of work and bytes held, which no machine's load changes."""

import tracemalloc
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from irregular import annulus

import meshwind as mw
from meshwind.chart import flatten
from meshwind.core import memory
from meshwind.core.cast import Floats, Ints
from meshwind.core.geometry import Block
from meshwind.layup import bands, coverage
from meshwind.mesh.geometry import halfedges
from meshwind.mesh.geometry.topology import edges
from meshwind.results import schema
from meshwind.results.vtk_files import write_lines
from meshwind.surface.fitting import thinning
from meshwind.surface.fitting.evidence import rms_away_from_creases
from meshwind.surface.fitting.quadrature import facet_points
from meshwind.surface.fitting.samples import Facets, Samples
from meshwind.surface.fitting.thinning import PER_SPAN, thinned
from meshwind.workflow import option_checks
from meshwind.workflow.options import Options


def vase(u: Floats, v: Floats) -> Floats:
    r = 1.0 + 0.2 * np.sin(2 * np.pi * v) + 0.1 * np.cos(4 * np.pi * u)
    return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), 4 * v], -1)


def peak(work: Callable[[], object]) -> int:
    """Most bytes that work holds beside what there is before."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


@pytest.fixture(scope="module")
def samples() -> Samples:
    return Samples.of(flatten(annulus(vase, 12_000, 0.4)))


def test_a_table_of_edges_is_made_once(monkeypatch: pytest.MonkeyPatch) -> None:
    """Reading and opening ask for the edges of the same faces a dozen times."""
    made: list[int] = []
    table = halfedges.edge_table

    def counted(faces: Ints, size: int) -> object:
        made.append(len(faces))
        return table(faces, size)

    monkeypatch.setattr(halfedges, "edge_table", counted)
    opened = mw.annulus(mw.read(Path(__file__).parents[1] / "data" / "elbow.obj"))
    assert made.count(len(opened.faces)) <= 2


def test_edges_are_those_of_the_faces_as_they_are() -> None:
    faces = np.array([[0, 1, 2], [0, 2, 3]])
    first = edges(faces)
    assert edges(faces.copy()) is first
    faces[1] = [0, 3, 1]
    assert {tuple(pair) for pair in edges(faces).ends.tolist()} == {(0, 1), (0, 2), (1, 2), (0, 3), (1, 3)}


def test_few_vertices_stand_for_all(samples: Samples, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(thinning, "LEAST", 0)
    few = thinned(samples, (8, 6))
    assert len(few.points) <= (PER_SPAN * 8) * (PER_SPAN * 6 + 2)
    assert few.weight.sum() == pytest.approx(samples.weight.sum())
    assert few.trusted.all() and few.rim.any()
    assert not len(few.between((8, 6))[0])
    i, j = np.floor(few.uv * (8, 6)).astype(int).T
    assert np.bincount(i % 8 * 6 + np.clip(j, 0, 5), minlength=48).min() >= 0.6 * PER_SPAN**2


def test_the_choice_of_vertices_depends_on_no_numbering(samples: Samples, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(thinning, "LEAST", 0)
    order = np.random.default_rng(0).permutation(len(samples.points))
    names = ("points", "uv", "weight", "rim", "trusted")
    facets = Facets(samples.points[order], np.argsort(order)[samples.facets.faces])
    shuffled = replace(samples, facets=facets, **{name: getattr(samples, name)[order] for name in names})
    kept = [{tuple(point) for point in thinned(each, (8, 6)).points.tolist()} for each in (samples, shuffled)]
    assert kept[0] == kept[1]


def test_fine_nets_get_all_vertices(samples: Samples, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(thinning, "LEAST", 0)
    assert thinned(samples, (32, 24)) is samples  # too few a span
    monkeypatch.setattr(Samples, "across", lambda *_: np.array([2], dtype=np.int8))
    assert thinned(samples, (8, 6)) is samples  # a triangle is wider than a span


def test_a_fit_that_tries_few_vertices_is_as_close(monkeypatch: pytest.MonkeyPatch) -> None:
    chart = flatten(annulus(vase, 12_000, 0.4))
    whole = mw.fit(chart)
    monkeypatch.setattr(thinning, "LEAST", 0)
    thin = mw.fit(chart)
    assert thin.spans == whole.spans
    assert whole.error is not None and thin.error is not None
    assert thin.error.to_surface_rms < 1.25 * whole.error.to_surface_rms
    assert thin.error.to_surface_max < 1e-5 * thin.error.diagonal


def test_points_on_some_facets_are_those_of_all(samples: Samples) -> None:
    every, chosen = facet_points(samples, (8, 6)), np.arange(0, len(samples.facets.faces), 7)
    some, same = facet_points(samples, (8, 6), chosen), np.isin(every.facet, chosen)
    assert np.array_equal(some.facet, every.facet[same])
    assert np.array_equal(some.places(samples.uv), every.places(samples.uv)[same])
    fresh = Samples.of(samples.chart)
    height = np.sin(np.arange(same.sum()))
    few = rms_away_from_creases(height, some, fresh)
    assert "_tangent" not in fresh.facets.__dict__  # normals of a few corners only
    assert few == pytest.approx(rms_away_from_creases(height, every.where(same), samples))


def test_areas_of_many_cells_are_found_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = mw.shapes.cylinder(1.0, 4.0)
    area = coverage.cell_areas(surface, 400, 100)
    assert area.sum() == pytest.approx(8 * np.pi)
    # their frames would take 144 bytes at each of 16 nodes
    assert peak(lambda: coverage.cell_areas(surface, 2000, 256)) < 2000 * 256 * 16 * 144 / 8
    monkeypatch.setattr(coverage, "_AT_ONCE", 1)
    assert np.array_equal(coverage.cell_areas(surface, 400, 100), area)


def test_bands_are_laid_in_blocks(monkeypatch: pytest.MonkeyPatch) -> None:
    surface = mw.shapes.cylinder(1.0, 3.0)
    ends = mw.families(surface, 6, 0.3)
    paths = mw.solve(surface, ends.start, ends.end, family=ends.family, particles=51)
    whole = bands(paths, 0.1)
    monkeypatch.setitem(bands.__globals__, "_AT_ONCE", 60)
    parts = bands(paths, 0.1)
    assert np.array_equal(parts.layers, whole.layers)
    assert parts.footprint == pytest.approx(whole.footprint, rel=1e-12)


def test_lines_are_written_a_part_at_a_time(tmp_path: Path) -> None:
    points = np.random.default_rng(0).random((1_000_000, 3))
    block = Block(points, np.array([0, 400_000, 1_000_000]))
    assert peak(lambda: write_lines(tmp_path / "lines.vtp", schema.PATHS, block, "mm")) < 1.5 * points.nbytes


@pytest.mark.parametrize("limit", [1e9, 64e9])
def test_the_machine_says_how_much_a_run_may_take(limit: float, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(option_checks, "machine_memory", lambda: limit)
    if limit > 16e9:
        assert Options(paths=5000, particles=1001, revolutions=0.01).paths == 5000
    else:
        with pytest.raises(mw.BadInputError, match=r"and this machine has 0\.8 for a run; give fewer paths"):
            Options(paths=5000, particles=1001, revolutions=0.01)


def test_memory_is_the_least_of_what_is_told(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    group = tmp_path / "memory.max"
    monkeypatch.setattr(memory, "_GROUPS", (str(tmp_path / "none"), str(group)))
    told = []
    for text in ("max\n", "123456789\n"):
        group.write_text(text)
        memory.machine_memory.cache_clear()
        told.append(memory.machine_memory())
    memory.machine_memory.cache_clear()
    assert told[0] > 1e9 and told[1] == 123456789
