"""Scalars of MSH files of all versions, as text and binary, on nodes and elements, are read whole or refused."""

import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from test_read_msh import BARREL, POINTS, QUADS, TRIANGLES, WAYS, Elements, msh

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.scalars import Scalars, read_scalars, scalar_names

NODES = [(1 + k, 0.1 + 0.01 * k) for k in range(len(POINTS))]
FIRST = 4
"""Number of the first surface element of BARREL: a point and two lines come before."""
CELLS = TRIANGLES + QUADS[6:]
ON_CELLS = [(FIRST + k, 0.5 + 0.01 * k) for k in range(len(CELLS))]
MIDDLES = np.array([POINTS[cell].mean(axis=0) for cell in CELLS])


def data(where: str, rows: Any, order: str = "", name: str = "mu", step: int = 0, components: int = 1,
         head: str = "") -> bytes:  # fmt: skip
    """A section of values; head: the tags, instead of those of name, step and components."""
    head = head or f'1\n"{name}"\n1\n0.25\n3\n{step}\n{components}\n{len(rows)}\n'
    if order:
        body = b"".join(struct.pack(f"{order}i{len(row) - 1}d", *row) for row in rows) + b"\n"
    else:
        body = "".join(" ".join(map(str, row)) + "\n" for row in rows).encode()
    return f"${where}\n{head}".encode() + body + f"$End{where}\n".encode()


def scalars(folder: Path, content: bytes, name: str = "mu") -> Scalars:
    (folder / "part.msh").write_bytes(content)
    return read_scalars(folder / "part.msh", name)


def refusal(folder: Path, content: bytes, name: str = "mu") -> str:
    with pytest.raises(BadInputError) as caught:
        scalars(folder, content, name)
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 400
    return str(caught.value)


@pytest.mark.parametrize(("version", "order"), WAYS)
@pytest.mark.parametrize("parametric", [False, True])
def test_every_version(version: str, order: str, parametric: bool, tmp_path: Path) -> None:
    """Beside sections of vectors, of another scalar, and in any order."""
    mesh = msh(version, order, parametric=parametric)
    vectors = [(k, 1.0, 2.0, 3.0) for k, _ in NODES]
    content = mesh + data("NodeData", vectors, order, "velocity", components=3) + data("NodeData", NODES[::-1], order)
    content += data("ElementData", ON_CELLS[::-1], order, "nu of cells")
    held = scalars(tmp_path, content)
    assert held.points == pytest.approx(POINTS) and held.values == pytest.approx([value for _, value in NODES])
    held = scalars(tmp_path, content, "nu of cells")
    at = np.lexsort(held.points.T), np.lexsort(MIDDLES.T)
    assert held.points[at[0]] == pytest.approx(MIDDLES[at[1]])
    assert held.values[at[0]] == pytest.approx(np.array([value for _, value in ON_CELLS])[at[1]])
    assert scalar_names(tmp_path / "part.msh") == ("mu", "nu of cells")
    assert "it holds: mu, nu of cells" in refusal(tmp_path, content, "velocity")


@pytest.mark.parametrize(("version", "order"), WAYS)
def test_names_of_the_scalars(version: str, order: str, tmp_path: Path) -> None:
    for more, named in ((b"", ()), (data("NodeData", NODES, order), ("mu",))):
        (tmp_path / "part.msh").write_bytes(msh(version, order, parametric=version != "1") + more)
        assert scalar_names(tmp_path / "part.msh") == named


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize("version", ["2.2", "4.0", "4.1"])
def test_sparse_numbers_and_sections_of_several_partitions(version: str, order: str, tmp_path: Path) -> None:
    rows = [(1000 + 7000 * k, value) for k, (_, value) in enumerate(NODES)]
    parts = [rows[:16], rows[14:]]  # nodes between partitions are in both
    head = '1\n"mu"\n1\n0.0\n4\n0\n1\n{}\n{}\n'
    mesh = msh(version, order, first=1000, step=7000)
    sections = [data("NodeData", part, order, head=head.format(len(part), k)) for k, part in enumerate(parts)]
    assert scalars(tmp_path, mesh + b"".join(sections)).values == pytest.approx([value for _, value in NODES])


def test_other_forms_of_tags(tmp_path: Path) -> None:
    values = pytest.approx([value for _, value in NODES])
    for head in ('2\n"mu"\n"scheme"\n0\n3\n0\n1\n30\n', "1\nmu\n2\n0.0 1e-3\n3\n0 1 30\n",
                 '1\n "mu" \n1\n0\n4 0\n1\n30\n0\n'):  # fmt: skip
        content = data("NodeData", NODES, head=head)
        assert scalars(tmp_path, msh("2.2") + content).values == values
        assert scalars(tmp_path, (msh("4.1") + content).replace(b"\n", b"\r\n")).values == values
        assert scalars(tmp_path, msh("4.1", ">") + data("NodeData", NODES, ">", head=head)).values == values


def test_nodes_and_elements_of_the_geometry_need_no_value(tmp_path: Path) -> None:
    """A centre of a circle, and the lines; an element in two groups is there twice."""
    points = np.concatenate([POINTS, [[0.0, 0.0, 0.0]]])
    elements: Elements = [(15, [[30]]), *BARREL[1:]]
    assert scalars(tmp_path, msh("4.1", "", elements, points) + data("NodeData", NODES)).points == pytest.approx(POINTS)
    lines = data("ElementData", [(2, 1.0), *ON_CELLS])
    assert len(scalars(tmp_path, msh("4.1") + lines).values) == len(CELLS)
    cube = np.array([[x, y, z] for z in (0, 1) for x, y in ((0, 0), (1, 0), (1, 1), (0, 1))], dtype=float)
    elements = [(3, [[0, 1, 2, 3], [4, 5, 6, 7]]), (5, [list(range(8))])]
    held = scalars(tmp_path, msh("2.2", "", elements, cube) + data("ElementData", [(3, 7.0)]))
    assert held.points.tolist() == [[0.5, 0.5, 0.5]] and held.values.tolist() == [7.0]
    held = scalars(tmp_path, msh("2.2", "", elements, cube) + data("ElementData", [(1, 5.0), (2, 6.0)]))
    assert held.points[:, 2].tolist() == [0.0, 1.0] and held.values.tolist() == [5.0, 6.0]


def test_text_of_meshio(tmp_path: Path) -> None:
    """It writes numbers by their repr, which names their type since NumPy 2."""
    for kind in ("{}", "np.float64({})", "np.float32({})"):
        rows = [(number, kind.format(value)) for number, value in NODES]
        assert scalars(tmp_path, msh("2.2") + data("NodeData", rows)).values == pytest.approx([v for _, v in NODES])
    wrong = data("NodeData", [(number, f"np.int8({value})") for number, value in NODES])
    assert "its section $NodeData holds something else than numbers" in refusal(tmp_path, msh("2.2") + wrong)


@pytest.mark.parametrize("order", ["", "<"])
@pytest.mark.parametrize(("where", "rows"), [("NodeData", NODES), ("ElementData", ON_CELLS)])
def test_what_is_not_one_number_each_is_refused(where: str, rows: Any, order: str, tmp_path: Path) -> None:
    mesh = msh("4.1", order)
    for wrong in (rows[:-1], [*rows[:-1], (rows[-1][0], np.nan)], [(rows[0][0], np.inf), *rows[1:]]):
        assert "not one finite number per vertex or cell" in refusal(tmp_path, mesh + data(where, wrong, order))
    what = "node" if where == "NodeData" else "element"
    lost = mesh + data(where, [*rows, (99, 1.0)], order)
    assert f"has a value for {what} 99, which is not in the file" in refusal(tmp_path, lost)
    twice = mesh + data(where, rows, order) + data(where, [(rows[3][0], 9.0)], order)
    assert f"has two values for {what} {rows[3][0]}" in refusal(tmp_path, twice)
    steps = mesh + data(where, rows, order) + data(where, rows, order, step=1)
    assert "is given at 2 time steps; save the file with one of them" in refusal(tmp_path, steps)
    assert scalar_names(tmp_path / "part.msh") == ("mu",)
    corners = data("ElementNodeData", [(4, 3.0, 1.0, 2.0, 3.0)], order)
    assert "($ElementNodeData), which is not read" in refusal(tmp_path, mesh + corners)
    assert scalars(tmp_path, mesh + corners + data(where, rows, order)).values == pytest.approx([v for _, v in rows])


def test_values_of_lines_only_are_refused(tmp_path: Path) -> None:
    content = msh("4.1") + data("ElementData", [(2, 1.0), (3, 2.0)])
    assert "has no value on a surface or volume element" in refusal(tmp_path, content)


@pytest.mark.parametrize("order", ["", "<", ">"])
@pytest.mark.parametrize(("change", "says"), [
    ((b"\n1\n30\n", b"\n1\n31\n"), "its section $NodeData ends before all that it announces"),
    ((b"\n1\n30\n", b"\n1\n29\n"), "its section $NodeData goes on after all that it announces"),
    ((b"\n1\n30\n", b"\n1\n-1\n"), "its section $NodeData is damaged"),
    ((b"\n3\n0\n1\n30\n", b"\n2\n0\n1\n"), "its section $NodeData does not tell how many values it has"),
    ((b"NodeData\n1\n", b"NodeData\n999999999\n"), "its section $NodeData is damaged"),
    ((b"$EndNodeData", b""), "its section $NodeData does not end"),
])  # fmt: skip
def test_damaged_sections(change: tuple[bytes, bytes], says: str, order: str, tmp_path: Path) -> None:
    mesh, section = msh("2.2", order), data("NodeData", NODES, order)
    assert change[0] in section and says in refusal(tmp_path, mesh + section.replace(*change, 1))
