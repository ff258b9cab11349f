"""Words of the summary on paths that are not at rest, and on coarse meshes and flat ends."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from mesh_shapes import tube

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.mesh import mesh_from
from meshwind.mesh.geometry.fill_holes import fill_hole
from meshwind.mesh.geometry.topology import loops
from meshwind.mesh.opening.flat_ends import has_flat_ends
from meshwind.results.report_types import Failure
from meshwind.run.layer_table import _covered
from meshwind.run.summary import _edit, _not_converged
from meshwind.surface import FitError
from meshwind.workflow.notes import about_fit


def capped(rings: int = 20) -> mw.Mesh:
    vertices, faces = tube(lambda z: 1.0 + 0.0 * z, 5.0, 48, rings)
    for loop in loops(faces):
        vertices, faces = fill_hole(vertices, faces, loop)
    return mesh_from(vertices, faces)


def failure(path: int, name: str = "stalled") -> Failure:
    return {"path": path, "status": 4, "name": name, "meaning": "stopped", "why": "stopped: fewer may help"}


def test_paths_that_are_not_at_rest_are_told_in_one_line_for_each_kind() -> None:
    many = [failure(k) for k in range(13)]
    (line,) = _not_converged(many, "")
    assert line == "warning   13 paths not at rest, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, ...: stopped: fewer may help"
    assert len(_not_converged([*many, failure(13, "slid_off_end")], "")) == 2
    lines = _not_converged([failure(2), failure(5)], "0.3 revolutions hold all 24 paths")
    assert lines == ["warning   2 paths not at rest, 2, 5: stopped; 0.3 revolutions hold all 24 paths"]
    lines = _not_converged([failure(2), failure(5, "slid_off_end")], "0.3 revolutions hold all 24 paths")
    assert lines == [
        "warning   1 path not at rest, 2: stopped",
        "warning   1 path not at rest, 5: stopped",
        "advice    0.3 revolutions hold all 24 paths",
    ]


def test_a_gap_that_counts_as_none_is_not_called_less_than_what_does() -> None:
    """The limit follows the surface's uncertainty from place to place; the report has a usual one."""

    def told(after: float, bridged: float) -> str:
        both: Any = {"bridged": {"before": 0.04, "after": bridged}, "max_gap": {"before": 2.0, "after": after}}
        rest: Any = {"displacement": {"max": 1.0, "mean": 0.1}, "volume": {"relative": None}, "threshold": 0.0051}
        return _edit(both | rest, "mm")[0]

    assert "(gaps below 0.0051 mm are ignored)" in told(0.004, 0.0) and "below" in told(0.0068, 0.01)
    assert "(gaps within the surface's uncertainty, usually 0.0051 mm, are ignored)" in told(0.0068, 0.0)


def test_a_cover_beyond_all_bounds_is_told_as_such() -> None:
    assert _covered({"min": 0.806, "max": 21688.1}) == "0.806 to over 99"
    assert _covered({"min": 1.01, "max": 4.59}) == "1.010 to 4.590"
    assert _covered(None) == "-"


def test_flat_ends_are_named_as_the_cause_and_domes_are_not() -> None:
    chart = mw.flatten(mw.annulus(capped()))
    assert has_flat_ends(chart.annulus)
    assert not has_flat_ends(mw.annulus(mesh_from(*tube(lambda z: 1.0 + 0.0 * z, 5.0))))
    dome = tube(lambda z: np.sqrt(np.maximum(1.0 - z**2, 1e-4)), 0.9999, 48, 60)
    vertices, faces = dome
    for loop in loops(faces):
        vertices, faces = fill_hole(vertices, faces, loop)
    half = mw.annulus(mesh_from(vertices, faces))
    assert has_flat_ends(half)  # its base is flat, its top is not
    (top,) = [rim for rim in half.rims if half.vertices[rim, 2].mean() > 0.5]
    assert not has_flat_ends(replace(half, rims=(top, top)))
    surface = mw.fit(chart)
    size = chart.annulus.mesh.diagonal
    for data in ("vertices", "facets"):
        error = FitError(0.02 * size, 0.02 * size, 0.02 * size, 0.02 * size, size, data)
        (note, *_) = about_fit(replace(surface, error=error), chart, 1e-5, 0.1)
        assert "its flat ends meet the flank at sharp edges; leave the flat ends off the mesh" in note.text
    error = FitError(1e-3 * size, 1e-3 * size, 1e-3 * size, 1e-3 * size, size, "facets")
    assert "for its flat ends meet" in about_fit(replace(surface, error=error), chart, 1e-5, 0.1)[0].text


def test_facets_off_a_surface_through_the_vertices_are_those_of_a_coarse_mesh() -> None:
    chart = mw.flatten(mw.annulus(capped()))
    size = chart.annulus.mesh.diagonal
    surface = mw.fit(chart)
    coarse = replace(surface, error=FitError(1e-4 * size, 1e-4 * size, 0.02 * size, 0.02 * size, size))
    (note,) = about_fit(coarse, chart, 1e-5, 0.1, "mm")
    assert note.warning and note.text.startswith("the mesh is coarse: its facets lie up to ")
    assert "where it is flat, give a finer mesh" in note.text and "does not resolve" not in note.text
    # vertices far off the surface are no chords, however far the facets are
    off = replace(surface, error=FitError(0.01 * size, 0.01 * size, 0.09 * size, 0.09 * size, size))
    (note,) = about_fit(off, chart, 1e-5, 0.1, "mm")
    assert note.text.startswith("the surface does not resolve the part: ")


def test_openings_that_leave_no_vertex_of_the_mesh_are_refused() -> None:
    with pytest.raises(BadInputError, match="no vertex is left between the openings; choose a smaller opening"):
        mw.annulus(capped(1), opening=1.2)
