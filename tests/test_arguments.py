"""Wrong arguments of public functions: each is refused in one line, whatever its type."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import meshwind as mw
from meshwind.core.errors import BadInputError

TUBE = mw.shapes.cylinder(radius=1.0, length=3.0, spans=(16, 8))
ENDS: dict[str, Any] = {"start": [(0.0, 0.0)], "end": [(0.5, 1.0)]}
MARCH: dict[str, Any] = {"surface": TUBE, "start": [(0.0, 0.1)], "direction": 0.3, "length": 1.0}
SOLVE: dict[str, Any] = {"surface": TUBE, "particles": 11, **ENDS}
PATHS = mw.solve(**SOLVE)
POINTS = {"surface": TUBE, "points": [(1.0, 0.0, 0.0), (1.0, 0.0, 1.0)], "values": [0.1, 0.2]}
SHAPE = {"radius": 1.0, "length": 1.0}
TURNED = {"radius": np.ones_like, "z0": 0.0, "z1": 1.0}
EGG = {"a": 1.0, "b": 1.0, "c": 1.0, "polar0": 0.5, "polar1": 2.0}
WRONG: dict[Callable[..., object], tuple[dict[str, Any], str]] = {
    mw.solve: (SOLVE, "surface start end particles family friction initial bridging accuracy tolerance iterations"),
    mw.drag: ({"surface": TUBE, **ENDS}, "surface start end particles friction initial bridging tolerance iterations"),
    mw.families: ({"surface": TUBE, "paths": 2, "revolutions": 0.5}, "surface paths revolutions phase between"),
    mw.friction_from: (POINTS, "surface points values grid"),
    mw.traces: (MARCH, "surface start direction length slip method step tolerance press"),
    mw.trace: (MARCH | {"start": (0.0, 0.1)}, "surface start direction length slip method step tolerance press"),
    mw.windability: ({"surface": TUBE}, "surface uv"),
    mw.assess: ({"paths": PATHS}, "paths width"),
    mw.choose_revolutions: ({"surface": TUBE}, "surface paths particles friction most further"),
    mw.space_out: ({"paths": PATHS, "revolutions": 0.5, "spacing": 1.0}, "paths revolutions spacing friction"),
    mw.surface_image: ({"surface": TUBE, "width": 8, "height": 8}, "surface width height"),
    mw.from_image: ({}, "image"),
    mw.read_image: ({}, "path"),
    mw.read_pins: ({"path": "pins.csv", "surface": TUBE, "revolutions": 0.5}, "path surface revolutions"),
    mw.load: ({}, "folder"),
    mw.export: ({"run": "out"}, "run to formats out shell elements pressure axial torque held"),
    mw.render: ({"folder": "out"}, "folder only animate out page"),
    mw.solve_deck: ({}, "run"),
    mw.sweep: ({}, "study"),
    mw.read: ({}, "mesh"),
    mw.shapes.cylinder: (SHAPE, "radius length spans"),
    mw.shapes.revolution: (TURNED, "radius z0 z1 spans"),
    mw.shapes.ellipsoid: (EGG, "a b c polar0 polar1 spans"),
    mw.shapes.parametric: ({"formula": lambda u, v: np.stack([u, v, u], axis=-1)}, "formula spans periodic"),
}
"""Public functions, with arguments that are right and the names of those that are given wrong."""
CASES = [(of, right, name) for of, (right, names) in WRONG.items() for name in names.split()]


@pytest.mark.parametrize(("of", "right", "name"), CASES, ids=[f"{of.__name__}-{name}" for of, _, name in CASES])
@pytest.mark.parametrize(
    "wrong", [object(), {}, [[0.0], [1.0, 2.0]], np.full((2, 2), np.nan)], ids=["object", "dict", "ragged", "nan"]
)
def test_a_wrong_argument_is_refused_in_one_line(
    of: Callable[..., object], right: dict[str, object], name: str, wrong: object
) -> None:
    with pytest.raises(BadInputError) as caught:
        of(**{**right, name: wrong})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    "wrong",
    [
        {"symmetry": "3"},
        {"mirror": 1},
        {"fairness": "high"},
        {"pressing": None},
        {"at_most": "1"},
        {"threshold": "1"},
        {"only_outward": np.array([True, False])},
        {"bound": object()},
    ],
    ids=lambda wrong: next(iter(wrong)),
)
def test_a_wrong_argument_of_redesign_is_refused_in_one_line(wrong: dict[str, object]) -> None:
    with pytest.raises(BadInputError, match="^" + next(iter(wrong))) as caught:
        mw.redesign(TUBE.to_trimesh(), revolutions=0.3, paths=2, particles=31, rounds=1, **wrong)  # type: ignore[arg-type]
    assert "\n" not in str(caught.value)


def test_the_number_of_a_kernel_may_be_whole() -> None:
    """A whole number in place of a real one must not have kernels compiled again."""
    whole = mw.solve(**{**SOLVE, "tolerance": 1})
    assert np.array_equal(whole.points, mw.solve(**{**SOLVE, "tolerance": 1.0}).points)


def test_a_mesh_that_was_read_can_be_read_again() -> None:
    mesh = mw.read((TUBE.to_trimesh().vertices, TUBE.to_trimesh().faces), units="in")
    again = mw.read(mesh)
    assert np.array_equal(again.vertices, mesh.vertices)
    assert (again.units, again.units_from, again.name) == (mesh.units, mesh.units_from, mesh.name)


def test_a_picture_says_where_it_cannot_be_written(tmp_path: Path) -> None:
    from meshwind.pictures.picture import Picture

    with pytest.raises(BadInputError, match="cannot be written"):
        Picture(b"", "nothing").save(tmp_path / "none" / "a.png")
    with pytest.raises(BadInputError, match="file is of type int"):
        Picture(b"", "nothing").save(3)  # type: ignore[arg-type]
