"""Every broken mesh either gives a chart and a surface or is refused in one line: no warning, no crash, no NaN."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from broken_meshes import FAULTS, MESHES, save_obj
from mesh_shapes import Part, assert_annulus, cone, pear

from meshwind.chart import flatten
from meshwind.core.errors import BadInputError
from meshwind.mesh import annulus, mesh_from, read
from meshwind.mesh.geometry.areas_and_volumes import areas, volume
from meshwind.surface import fit

REFUSED = {
    "torus", "torus with a hole", "genus 2", "Klein bottle", "Moebius strip", "triangle", "flat tube", "line",
    "one point", "empty", "no faces", "NaN", "inf", "one at 1e300", "one at 1e30", "all 1e300", "all 1e-300",
    "denormal", "very far away", "index too high", "index negative", "random soup", "random web", "tube, loose by 1e-2",
    "pear, loose by 1e-2",
}  # fmt: skip
"""Faults that no repair can turn into a part."""
HEALED = [
    "duplicated faces", "flipped faces", "one face flipped", "inside out", "unwelded", "loose by 1e-9", "loose by 1e-6",
    "loose by 1e-4", "degenerate faces", "needles", "T-junctions", "hanging nodes", "crack", "inner wall",
    "double skin", "coincident double", "two bodies", "nested bodies", "uneven",
]  # fmt: skip
"""Faults that repairs undo, so that the part is whole again."""


@pytest.mark.parametrize("name", MESHES)
def test_a_broken_mesh_is_repaired_or_refused_in_one_line(name: str, tmp_path: Path) -> None:
    save_obj(tmp_path / "part.obj", MESHES[name]())
    try:
        found = annulus(read(tmp_path / "part.obj"))
        assert_annulus(found)
        chart = flatten(found)
        surface = fit(chart)
    except BadInputError as error:
        line = str(error)
        assert "\n" not in line and len(line) < 250 and ("; " in line or ": " in line)
        assert name not in SOUND
    else:
        assert name not in REFUSED
        assert chart.flipped == 0 and np.isfinite(chart.uv).all() and np.isfinite(chart.stretch).all()
        assert np.isfinite(surface.control_points).all()
        assert surface.error is not None and np.isfinite(surface.error.relative_max)


SOUND = {f"{part}, {fault}" for part in ("tube", "pear") for fault in HEALED}


@pytest.mark.parametrize("fault", HEALED)
@pytest.mark.parametrize("part", [cone, pear])
def test_repairs_undo_the_fault(part: Callable[[], Part], fault: str) -> None:
    whole, repaired = mesh_from(*part()), mesh_from(*FAULTS[fault](part()))
    for measure in (areas, volume):
        size = float(np.sum(measure(whole.vertices, whole.faces)))
        assert np.sum(measure(repaired.vertices, repaired.faces)) == pytest.approx(size, rel=3e-3)


def test_the_corpus_is_large_and_its_meshes_differ() -> None:
    parts = [make() for make in MESHES.values()]
    assert len(parts) > 100
    assert len({(vertices.tobytes(), faces.tobytes()) for vertices, faces in parts}) == len(parts)
