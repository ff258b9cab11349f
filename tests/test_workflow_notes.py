"""What is said of the fit: nothing where it is good, a warning where the surface is another shape."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import meshwind as mw
from meshwind.appearance.words import power, quantity, ratio
from meshwind.core.cast import Floats, frozen
from meshwind.run.summary import run_lines
from meshwind.workflow.clock import Clock
from meshwind.workflow.notes import Note, about_fit, of_layers

DIAGONAL = 10.0
TIP = np.array([-4.5, 0.0, 0.0])


@pytest.fixture(scope="module")
def fitted() -> tuple[mw.Surface, mw.Chart]:
    mesh = mw.read(Path(__file__).parents[1] / "data" / "tank.ply")
    chart = mw.flatten(mw.annulus(mesh))
    return mw.fit(chart, 1e-4), chart


def with_error(surface: mw.Surface, vertices: float, facets: float) -> mw.Surface:
    """The surface with errors made up, over a diagonal of 10."""
    return replace(surface, error=mw.FitError(0.1 * vertices, vertices, 0.1 * facets, facets, DIAGONAL))


@pytest.mark.parametrize(("relative", "tolerance", "kind"), [
    (0.9e-5, 1e-5, None), (1.1e-5, 1e-5, "note"), (0.9e-4, 1e-6, "note"), (1.1e-4, 1e-5, "warning"),
    (1.1e-4, 2e-5, "note"), (9e-3, 1e-2, None), (9e-3, 1e-5, "warning"),
])  # fmt: skip
def test_a_missed_tolerance_has_a_note(
    fitted: tuple[mw.Surface, mw.Chart], relative: float, tolerance: float, kind: str | None
) -> None:
    surface = with_error(fitted[0], relative * DIAGONAL, 9e-3 * DIAGONAL)
    notes = about_fit(surface, fitted[1], tolerance, 0.1, "mm")
    assert [("note", "warning")[note.warning] for note in notes] == ([] if kind is None else [kind])
    for note in notes:
        for words in (ratio(tolerance), ratio(relative), "mm", f"tolerance={power(relative)}"):
            assert words in note.text
        assert str(note).startswith("warning: ") == note.warning


def dented(by: float) -> tuple[mw.Surface, mw.Chart, Floats]:
    """A tank's surface with one control point pulled out by a share of the part, and where that shows most."""
    mesh = mw.read(Path(__file__).parents[1] / "data" / "tank.ply")
    chart = mw.flatten(mw.annulus(mesh))
    surface = mw.fit(chart, 1e-4)
    net = surface.control_points.copy()
    i, j = 3, net.shape[1] // 2
    outward = net[i, j] * [1.0, 1.0, 0.0]
    net[i, j] += by * mesh.diagonal / (2 / 3) ** 2 * outward / np.linalg.norm(outward)
    error = mw.FitError(0.0, by * mesh.diagonal, 0.0, by * mesh.diagonal, mesh.diagonal)
    # a knot line carries 2/3 of its control point in each direction
    spans = net.shape[0], net.shape[1] - 3
    uv = np.array([[((i - 1) / spans[0]) % 1.0, (j - 1) / spans[1]]])
    bent = mw.Surface(net, True, error)
    return bent, chart, bent.points(uv)[0]


def test_an_unresolved_part_has_a_warning_with_coordinates() -> None:
    surface, chart, peak = dented(0.03)
    (note,) = about_fit(surface, chart, 1e-5, 0.1, "mm")
    assert note.warning
    assert "does not resolve the part" in note.text
    assert "3 % of the part" in note.text
    near = np.array([float(x) for x in note.text.split("near (")[1].split(")")[0].split(",")])
    assert np.linalg.norm(near - peak) < 0.02 * chart.annulus.mesh.diagonal
    assert "sharp" in note.text
    stretch = np.ones(len(chart.stretch))
    stretch[: len(stretch) // 50] = 20.0
    (note,) = about_fit(surface, replace(chart, stretch=frozen(stretch)), 1e-5, 0.1)
    assert "wind a part without them" in note.text


def test_past_a_limit_the_part_is_refused() -> None:
    surface, chart, _ = dented(0.2)
    with pytest.raises(mw.BadInputError, match=r"worst_fit, now 0\.1"):
        about_fit(surface, chart, 1e-5, 0.1)
    assert about_fit(surface, chart, 1e-5, 0.3)[0].warning
    with pytest.raises(mw.BadInputError, match=r"now 0\.001"):
        about_fit(dented(0.002)[0], chart, 1e-5, 0.001)


@pytest.mark.parametrize("name", ["cast.ply", "elbow.obj", "wing.stl", "bottle.obj", "tank.ply", "vase.stl"])
def test_the_sample_parts_are_resolved(name: str) -> None:
    chart = mw.flatten(mw.annulus(mw.read(Path(__file__).parents[1] / "data" / name)))
    assert not any("resolve" in note.text for note in about_fit(mw.fit(chart), chart, 1e-5, 0.1))


def horned() -> mw.Mesh:
    """A tube with a horn out of its side that is one vertex of the mesh: no smooth surface follows it."""
    u, v = np.meshgrid(np.arange(16) / 16 * 2 * np.pi, np.linspace(-1, 1, 21), indexing="ij")
    points = np.stack([0.5 * np.cos(u), 0.5 * np.sin(u), 1.5 * v], axis=2)
    points[8, 10] = TIP
    i, j = np.meshgrid(np.arange(16), np.arange(20), indexing="ij")
    a, b = (i * 21 + j).ravel(), ((i + 1) % 16 * 21 + j).ravel()
    faces = np.concatenate([np.stack([a, b, b + 1], axis=1), np.stack([a, b + 1, a + 1], axis=1)])
    return mw.Mesh(frozen(points.reshape(-1, 3)), frozen(faces), "horn")


def test_a_horn_is_warned_of_in_summary_and_report(tmp_path: Path) -> None:
    result = mw.wind(horned(), paths=3, revolutions=0.2, worst_fit=0.5, out=tmp_path, render=False)
    assert result.surface.error is not None
    (line,) = [line for line in run_lines(result.report()) if "does not resolve" in line]
    assert line.startswith("warning   the surface")
    assert f"({100 * result.surface.error.relative_max:.2g} % of the part)" in line
    (note,) = [
        note for note in json.loads((tmp_path / "report.json").read_text())["notes"] if note.startswith("warning")
    ]
    assert note == f"warning: {line[10:]}"
    near = np.array([float(x) for x in line.split("near (")[1].split(")")[0].split(",")])
    assert near[0] < -0.2 and np.abs(near[1:]).max() < 0.3  # at the horn, from foot to tip


def test_words() -> None:
    assert (quantity(12345.6, "mm"), quantity(0.5), quantity(0.012345, "in", 2)) == ("12,350 mm", "0.5", "0.012 in")
    assert (ratio(1e-5), ratio(2.34e-4), ratio(0.0)) == ("1e-5", "2.3e-4", "0")
    assert (power(1e-3), power(1.1e-3), power(0.99e-3)) == ("1e-3", "1e-2", "1e-3")


@pytest.mark.parametrize(("vertices", "facets", "words"), [
    (2e-3, 2e-3, ()), (3.1e-3, 2e-3, ("surface and mesh lie up to 0.031 mm (0.31 % of the part)", "sharp")),
    (2e-4, 2.5e-3, ()), (2e-4, 3.1e-3, ("coarse: its facets lie up to 0.031 mm (0.31 %", "give a finer mesh")),
])  # fmt: skip
def test_a_surface_that_follows_facets_is_warned_of_where_it_lies_off_the_mesh(
    fitted: tuple[mw.Surface, mw.Chart], vertices: float, facets: float, words: tuple[str, ...]
) -> None:
    error = mw.FitError(1e-5, vertices * DIAGONAL, 1e-5, facets * DIAGONAL, DIAGONAL, "facets", 0.02)
    why, *warnings = about_fit(replace(fitted[0], error=error), fitted[1], 1e-5, 0.1, "mm")
    assert "the vertices lie 0.02 mm off a smooth surface" in why.text and not why.warning
    assert len(warnings) == bool(words)
    for note in warnings:
        assert note.warning and all(each in note.text for each in words)


def test_the_summary_names_the_tolerance_only_where_the_vertices_are_fitted() -> None:
    report = mw.wind(horned(), paths=3, revolutions=0.2, worst_fit=0.5).report()
    report["surface"]["evidence"] = {
        "data": "vertices", "noise": 0.1, "sagitta": 0.2, "uncertainty": {"rms": 0.3, "max": 0.4}
    }  # fmt: skip
    assert ", tolerance 1e-5)" in run_lines(report)[2]
    assert run_lines(report)[3].endswith(
        "fitted to the vertices; noise of the vertices 0.1, sagitta of the facets 0.2; "
        "uncertain by 0.3 (root mean squares), at most 0.4"
    )
    report["surface"]["evidence"]["data"] = "facets"
    assert "tolerance" not in run_lines(report)[2]


def test_layers_share_a_note_of_each_kind() -> None:
    notes = [
        (1, Note("it slips at v=0.5", True)), (2, Note("it slips at v=0.5", True)),
        (3, Note("it slips at v=0.25", True)),
        (2, Note("pins need heads")), (4, Note("it slips at v=1e-3", True)),
    ]  # fmt: skip
    assert of_layers(notes) == (
        Note("layers 1, 2 (layers 3, 4 likewise): it slips at v=0.5", True), Note("layer 2: pins need heads"),
    )  # fmt: skip


def test_a_stage_that_goes_on_is_told_once() -> None:
    told: list[str] = []
    clock = Clock(told.append)
    for name in ("fit", "layers", "fit", "wind"):
        with clock.stage(name):
            pass
    assert told == ["fit", "layers", "wind"] and set(clock.seconds) == set(told)
