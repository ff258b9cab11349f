"""Parts far from the origin, where the digits of a file no longer resolve them."""

from pathlib import Path

import meshio
import numpy as np
import pytest
import trimesh
from mesh_shapes import Part, box

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.inspection import check
from meshwind.mesh.io.read import load, read

FAR = np.array([5.4e6, 4.4e5, 312.5])
LENGTH = 120.0


def barrel(around: int = 24, along: int = 21) -> Part:
    """An open barrel, LENGTH long and at most 66.6 across."""
    t, turn = np.linspace(0.0, 1.0, along), np.arange(around) * 2.0 * np.pi / around
    radius = 25.0 + 8.3 * np.sin(np.pi * t)
    rows = [radius[:, None] * np.cos(turn), radius[:, None] * np.sin(turn), np.repeat(LENGTH * t[:, None], around, 1)]
    k = np.arange(around * (along - 1)).reshape(-1, around)
    a, b, c, d = k, np.roll(k, -1, 1), k + around, np.roll(k, -1, 1) + around
    return np.stack(rows, 2).reshape(-1, 3), np.concatenate(
        [np.stack(x, 2).reshape(-1, 3) for x in ((a, b, d), (a, d, c))]
    )


def written(path: Path, points: Floats, faces: np.ndarray, double: bool = False) -> Path:
    """Write a mesh; of the endings only VTU and OBJ hold doubles."""
    if path.suffix in (".vtu", ".ply"):
        held = points if double else points.astype(np.float32)
        meshio.write(path, meshio.Mesh(held, [("triangle", faces)]))
    elif path.suffix == ".obj":
        lines = [f"v {x:.17g} {y:.17g} {z:.17g}" for x, y, z in points]
        path.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in faces + 1]))
    else:
        trimesh.Trimesh(points, faces, process=False).export(path)
    return path


@pytest.mark.parametrize("suffix", [".stl", ".ply", ".vtu", ".glb"])
def test_a_part_that_single_precision_does_not_resolve_is_refused(suffix: str, tmp_path: Path) -> None:
    points, faces = barrel()
    path = written(tmp_path / f"part{suffix}", points / 50.0 + FAR, faces)
    with pytest.raises(BadInputError) as caught:
        read(path)
    assert str(caught.value) == (
        f"part{suffix}: lies 5.4e+06 from the origin, where single precision resolves steps of 0.5 of a part 2.4 long; "
        "move the part to the origin and export it again, or in double precision (OBJ, VTU, PLY of doubles)"
    )


@pytest.mark.parametrize("far", [[2e7, 1.8e7, 0.0], [5e8, 0.0, 0.0], [0.0, -6.4e7, 3.0], [3.3e7, 3.3e7, 3.3e7]])
@pytest.mark.parametrize("suffix", [".stl", ".ply"])
def test_a_part_of_which_few_steps_are_left_is_refused(suffix: str, far: list[float], tmp_path: Path) -> None:
    points, faces = barrel()
    with pytest.raises(BadInputError, match="from the origin, where single precision resolves steps of"):
        read(written(tmp_path / f"part{suffix}", points / 50.0 + far, faces))


@pytest.mark.parametrize("suffix", [".stl", ".ply", ".vtu"])
def test_a_part_that_it_resolves_coarsely_is_read_with_a_warning(suffix: str, tmp_path: Path) -> None:
    points, faces = barrel()
    path = written(tmp_path / f"part{suffix}", points + FAR, faces)
    (warning,) = read(path).warnings
    assert warning.startswith(
        "lies 5.4e+06 from the origin, where single precision resolves steps of 0.5 of a part 1.2e+02 long"
    )
    assert check(path).warnings[0] == warning


@pytest.mark.parametrize("shift", [0.0, 100.0, 3e3, 1.2e4])
@pytest.mark.parametrize("suffix", [".stl", ".vtu"])
def test_nothing_is_said_of_parts_that_are_resolved(suffix: str, shift: float, tmp_path: Path) -> None:
    points, faces = barrel()
    assert load(written(tmp_path / f"part{suffix}", points + shift, faces)).warnings == ()


@pytest.mark.parametrize("suffix", [".obj", ".vtu", ".ply"])
def test_double_precision_resolves_what_is_far(suffix: str, tmp_path: Path) -> None:
    points, faces = barrel()
    path = written(tmp_path / f"part{suffix}", points / 50.0 + FAR, faces, double=True)
    assert load(path).warnings == ()


@pytest.mark.parametrize(("number", "step"), [("%.6g", 10.0), ("%.7g", 1.0), ("%.5e", 10.0)])
def test_texts_of_few_digits_are_told_like_single_precision(number: str, step: float, tmp_path: Path) -> None:
    points, faces = barrel()
    path = tmp_path / "part.obj"
    lines = ["v " + " ".join(number % x for x in point) for point in points * 20.0 + FAR]
    path.write_text("\n".join(lines + [f"f {a} {b} {c}" for a, b, c in faces + 1]))
    (warning,) = load(path).warnings
    assert f"its digits resolve steps of {step:.2g} of a part 2.4e+03 long" in warning
    assert warning.endswith("export it again, or with more digits")
    small = ["v " + " ".join(number % x for x in point) for point in points + FAR]
    path.write_text("\n".join(small + [f"f {a} {b} {c}" for a, b, c in faces + 1]))
    if step / LENGTH > 0.01:
        with pytest.raises(BadInputError, match="its digits resolve steps of 10 of a part"):
            load(path)


def test_round_numbers_by_design_are_no_lack_of_digits(tmp_path: Path) -> None:
    corners, faces = box((0, 0, 0), (50, 50, 100))
    for shift in (1e5, 5.4e6, 5.4e6 + 0.5):
        assert load(written(tmp_path / "box.stl", corners + shift, faces)).warnings == ()
        assert load(written(tmp_path / "box.obj", corners + shift, faces)).warnings == ()
    points, faces = barrel()
    points = np.column_stack([points[:, :2], np.round(points[:, 2])]) + [0.0, 0.0, 1e5]  # rings at whole numbers
    assert load(written(tmp_path / "rings.obj", points, faces)).warnings == ()
    points = np.round(barrel()[0], 3)  # near the origin, three decimals are what the writer chose
    assert load(written(tmp_path / "near.obj", points + 500.0, faces)).warnings == ()


def test_a_vertex_that_no_face_uses_does_not_make_the_part_large(tmp_path: Path) -> None:
    points, faces = barrel()
    with pytest.raises(BadInputError, match="single precision resolves"):
        load(written(tmp_path / "part.ply", np.concatenate([points / 50.0 + FAR, np.zeros((1, 3))]), faces))
    near = np.concatenate([points[:3], points / 50.0 + FAR])  # a piece near the origin makes it large
    assert load(written(tmp_path / "two.ply", near, np.concatenate([[[0, 1, 2]], faces + 3]))).warnings == ()


def test_arrays_in_memory_are_looked_at_too() -> None:
    points, faces = barrel()
    with pytest.raises(BadInputError, match="mesh: lies 5"):
        load(((points / 50.0 + FAR).astype(np.float32), faces))
