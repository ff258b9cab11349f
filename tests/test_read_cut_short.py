"""Files without announced counts that are cut short: most of what is lost are faces, and their vertices are left."""

from pathlib import Path

import numpy as np
import pytest
from mesh_shapes import Part, tube

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.mesh.inspection import check


def barrel() -> Part:
    vertices, faces = tube(lambda z: 1.0 + 0.2 * np.sin(z), 3.0, 32, 40)
    return vertices, faces[np.argsort(faces.max(axis=1), kind="stable")]


def obj(part: Part) -> list[str]:
    return [f"v {x} {y} {z}" for x, y, z in part[0]] + [f"f {a} {b} {c}" for a, b, c in part[1] + 1]


def deck(part: Part) -> list[str]:
    nodes = [f"{k}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(part[0], 1)]
    elements = [f"{k}, {a}, {b}, {c}" for k, (a, b, c) in enumerate(part[1] + 1, 1)]
    return ["*NODE", *nodes, "*ELEMENT, TYPE=S3", *elements]


def save(path: Path, lines: list[str]) -> Path:
    path.write_text("\n".join(lines) + "\n")
    return path


@pytest.mark.parametrize(("name", "lines"), [("part.obj", obj(barrel())), ("part.inp", deck(barrel()))])
def test_many_vertices_in_no_face_are_a_warning(name: str, lines: list[str], tmp_path: Path) -> None:
    whole = save(tmp_path / name, lines)
    assert mw.read(whole).warnings == ()
    cut = save(tmp_path / name, lines[: int(0.7 * len(lines))])
    (warning,) = mw.read(cut).warnings
    assert "% of the " in warning and warning.endswith(": is the file cut short?")
    assert warning in check(cut).warnings


def test_the_share_is_named(tmp_path: Path) -> None:
    vertices, faces = barrel()
    extra = np.concatenate([vertices, np.full((len(vertices), 3), 9.0)])
    (warning,) = mw.read(save(tmp_path / "part.obj", obj((extra, faces)))).warnings
    assert warning == f"50 % of the vertices ({len(vertices)} of {len(extra)}) are in no face: is the file cut short?"


def test_a_few_construction_points_and_vertices_of_lines_are_none(tmp_path: Path) -> None:
    vertices, faces = barrel()
    few = np.concatenate([vertices, np.full((len(vertices) // 12, 3), 9.0)])
    assert mw.read(save(tmp_path / "part.obj", obj((few, faces)))).warnings == ()
    many = np.concatenate([vertices, 9.0 + np.arange(3.0 * len(vertices)).reshape(-1, 3)])
    lines = [f"l {' '.join(str(k) for k in range(len(vertices) + 1, len(many) + 1))}"]
    assert mw.read(save(tmp_path / "part.obj", obj((many, faces)) + lines)).warnings == ()


def test_nodes_within_a_solid_are_in_its_elements(tmp_path: Path) -> None:
    count = 5
    nodes = np.stack(np.meshgrid(*[np.arange(count)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
    number = np.arange(count**3).reshape(count, count, count) + 1
    low, high = number[:-1], number[1:]
    corners = [
        part[a : a + count - 1, b : b + count - 1].ravel()
        for part in (np.moveaxis(low, 0, 2), np.moveaxis(high, 0, 2))
        for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))
    ]
    lines = ["*NODE", *(f"{k}, {x}, {y}, {z}" for k, (x, y, z) in enumerate(nodes, 1)), "*ELEMENT, TYPE=C3D8"]
    lines += [f"{k}, {', '.join(map(str, row))}" for k, row in enumerate(np.column_stack(corners), 1)]
    assert mw.read(save(tmp_path / "block.inp", lines)).warnings == ()


def test_a_refused_fit_says_that_the_file_may_be_cut_short(tmp_path: Path) -> None:
    lines = obj(barrel())
    cut = save(tmp_path / "part.obj", lines[: int(0.7 * len(lines))])
    with pytest.raises(BadInputError, match=r"; the file: .* in no face: is the file cut short"):
        mw.wind(cut, paths=2, particles=21, worst_fit=1e-9)
