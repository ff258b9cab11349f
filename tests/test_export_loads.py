"""Loads of shell decks: they balance, act in the sense that they say, and leave no rigid motion."""

import re
import subprocess
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from export_results import plain_results

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.exporting.elements import regular
from meshwind.exporting.material import read_material
from meshwind.exporting.plies import plies
from meshwind.exporting.shell_deck import Deck, thicknesses, write_decks
from meshwind.exporting.shell_loads import FORCE, Loads
from meshwind.results.schema import SHELL, SHELL_S4R

THICKNESS = 0.01


def rows(path: Path, keyword: str) -> list[list[str]]:
    """Cells of the data lines below the first card that begins with the keyword."""
    for card in re.split(r"^(?=\*[A-Z])", path.read_text(), flags=re.MULTILINE):
        if card.startswith(keyword):
            lines = card.splitlines()[1:]
            return [line.replace(" ", "").split(",") for line in lines if not line.startswith("**")]
    return []


def forces(path: Path) -> tuple[Floats, Floats]:
    """Points (m, 3) and forces (m, 3) of a deck's concentrated loads."""
    nodes = {int(row[0]): list(map(float, row[1:])) for row in rows(path, "*NODE,")}
    loads = rows(path, "*CLOAD")
    at = np.array([nodes[int(row[0])] for row in loads]).reshape(-1, 3)
    force = np.zeros((len(loads), 3))
    for each, row in zip(force, loads, strict=True):
        each[int(row[1]) - 1] = float(row[2])
    return at, force


def torque(at: Floats, force: Floats) -> float:
    return float(np.cross(at, force)[:, 2].sum())


@pytest.fixture(scope="module")
def deck(tmp_path_factory: pytest.TempPathFactory) -> Deck:
    """A cylinder of radius 1 and height 4 along z, with fibres at half a turn, start at z = 0."""
    results = plain_results(tmp_path_factory.mktemp("loads"))
    elements = regular(results.surface, 300)
    return Deck(elements, plies(results, elements, layer=THICKNESS), read_material(), results.units)


def written(deck: Deck, folder: Path, loads: Loads) -> Path:
    folder.mkdir()
    write_decks(folder, replace(deck, loads=loads))
    return folder / SHELL


@pytest.mark.parametrize("name", [SHELL, SHELL_S4R])
def test_loads_of_rims_are_what_is_asked_for(deck: Deck, tmp_path: Path, name: str) -> None:
    """On the end along z and counterclockwise seen from outside, on the start against it."""
    for held, sign, z in (("start", 1.0, 4.0), ("end", -1.0, 0.0)):
        out = tmp_path / held
        at, force = forces(written(deck, out, Loads(axial=30.0, torque=0.05, held=held)).with_name(str(name)))
        assert at[:, 2] == pytest.approx(z, abs=1e-9)
        assert force.sum(axis=0) == pytest.approx([0.0, 0.0, sign * 30.0], abs=1e-6)
        assert torque(at, force) == pytest.approx(sign * 50.0, rel=1e-7)  # N mm
        assert [row[0] for row in rows(out / name, "*BOUNDARY")] == [held.upper()]
        assert f"on {'END' if held == 'start' else 'START'}, along" in (out / name).read_text()
    at, force = forces(written(deck, tmp_path / "none", Loads(10.0, 30.0, 0.05, "none")).with_name(str(name)))
    for moments in (force, np.cross(at, force)):
        assert np.abs(moments.sum(axis=0)).max() < 1e-6 * np.abs(moments).sum()
    assert np.abs(force[at[:, 2] > 2.0].sum(axis=0))[2] == pytest.approx(30.0 + 10.0 * np.pi, rel=0.02)
    held_by = rows(tmp_path / "none" / name, "*BOUNDARY")
    nodes = {int(row[0]): np.array(list(map(float, row[1:]))) for row in rows(tmp_path / "none" / name, "*NODE,")}
    directions = [np.eye(3)[int(row[1]) - 1] for row in held_by]
    rigid = [np.concatenate([d, np.cross(nodes[int(row[0])], d)]) for row, d in zip(held_by, directions, strict=True)]
    assert len(rigid) == 6
    assert np.linalg.cond(np.array(rigid)) < 20.0


def test_decks_say_their_loads(deck: Deck, tmp_path: Path) -> None:
    text = written(deck, tmp_path / "both", Loads(pressure=10.0, held="both")).read_text()
    assert "** held: START and END are clamped" in text and "*CLOAD" not in text and "*DLOAD" in text
    text = written(deck, tmp_path / "nothing", Loads(axial=0.0)).read_text()
    assert "** load: none" in text and "*CLOAD" not in text and "*DLOAD" not in text
    assert "load to begin with" in written(deck, tmp_path / "default", Loads()).read_text()
    assert forces(tmp_path / "default" / SHELL)[1].sum(axis=0)[2] == pytest.approx(FORCE)
    for bad, message in (
        ({"torque": float("inf")}, "torque is inf"),
        ({"held": "middle"}, "give start, end, both or none"),
        ({"held": "both", "axial": 1.0}, "hold one of them"),
    ):
        with pytest.raises(BadInputError, match=message):
            Loads(**bad)  # type: ignore[arg-type]


def test_loads_are_in_the_units_of_the_part() -> None:
    """MPa, N and N m to N and metres."""
    loads = Loads(2.0, 3.0, 4.0).scaled("m")
    assert (loads.pressure, loads.axial, loads.torque) == (2e6, 3.0, 4.0)
    assert Loads(torque=4.0).scaled("mm").torque == 4000.0
    assert Loads(pressure=1.0).scaled("mm").axial == 0.0


def solved(path: Path) -> tuple[Floats, Floats, Floats]:
    """Points and displacements of all nodes, and the sum of reactions, by CalculiX.

    Its total of a clamped rim is the reaction where normals are square to the load, as on a cylinder, alone.
    """
    text, clamped = path.read_text(), [name for name in ("START", "END") if f"\n{name}, 1, 6" in path.read_text()]
    asked = "".join(f"*NODE PRINT, NSET={name}, TOTALS=ONLY\nRF\n" for name in clamped)
    path.write_text(text.replace("*NODE PRINT, NSET=NALL\n", f"{asked}*NODE PRINT, NSET=NALL\n"))
    done = subprocess.run(["ccx", path.stem], cwd=path.parent, capture_output=True, text=True, timeout=120, check=True)
    assert "*ERROR" not in done.stdout
    reactions, moved = (path.parent / f"{path.stem}.dat").read_text().split(" displacements ")
    assert reactions.count("total force") == len(clamped)
    table = (line.split() for line in moved.split(" stresses ")[0].splitlines())
    u = np.array([list(map(float, row)) for row in table if len(row) == 4 and row[0].isdigit()])
    points = np.array([list(map(float, row[1:])) for row in rows(path, "*NODE,")])
    total = [line.split() for line in reactions.splitlines() if len(line.split()) == 3]
    return points[u[:, 0].astype(int) - 1], u[:, 1:], np.array(total or np.zeros((1, 3)), dtype=float).sum(axis=0)


def grown(at: Floats, u: Floats) -> float:
    """Mean growth of the radius in the middle half."""
    middle = np.abs(at[:, 2] - 2.0) < 1.0
    return float((u[middle, :2] * at[middle, :2]).sum(axis=1).mean())


def stiffness(deck: Deck) -> Floats:
    """Stiffness (3, 3) of the wall in its plane along, around and in shear, by laminate theory: +- and -+ balanced."""
    m = deck.material
    q = np.array([[m.e1, m.nu12 * m.e2, 0.0], [m.nu12 * m.e2, m.e2, 0.0], [0.0, 0.0, 0.0]])
    q /= 1.0 - m.nu12**2 * m.e2 / m.e1
    q[2, 2] = m.g12
    a = deck.plies.families[0].angle[0]
    c, s = np.cos(a), np.sin(a)
    turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
    wall = turn.T @ q @ turn
    wall[:2, 2] = wall[2, :2] = 0.0
    return np.asarray(wall * thicknesses(deck).sum(axis=0).mean())


@pytest.mark.usefixtures("calculix")
@pytest.mark.parametrize("held", ["start", "end", "none"])
def test_a_cylinder_answers_to_each_load_as_laminate_theory_says(deck: Deck, tmp_path: Path, held: str) -> None:
    """Pressure makes it wider, by p R around and p R / 2 along, an axial force longer; a torque turns it."""
    wall = stiffness(deck)
    at, u, sum_of = solved(written(deck, tmp_path / "pressure", Loads(pressure=1.0, held=held)))
    assert grown(at, u) == pytest.approx(np.linalg.solve(wall, [0.5, 1.0, 0.0])[1], rel=0.05)
    sign = {"start": -1.0, "end": 1.0, "none": 0.0}[held]
    assert sum_of == pytest.approx([0.0, 0.0, sign * np.pi], abs=0.02)  # of what presses on the other end
    at, u, sum_of = solved(written(deck, tmp_path / "outside", Loads(pressure=-1.0, held=held)))
    assert grown(at, u) < 0.0
    at, u, sum_of = solved(written(deck, tmp_path / "axial", Loads(axial=100.0, held=held)))
    along = np.linalg.solve(wall, [100.0 / (2.0 * np.pi), 0.0, 0.0])[0]
    longer = u[at[:, 2] > 3.99, 2].mean() - u[at[:, 2] < 0.01, 2].mean()
    assert longer == pytest.approx(4.0 * along, rel=0.03)
    assert sum_of == pytest.approx([0.0, 0.0, 100.0 * sign], abs=0.05)
    at, u, sum_of = solved(written(deck, tmp_path / "torque", Loads(torque=0.1, held=held)))
    turned = (at[:, 0] * u[:, 1] - at[:, 1] * u[:, 0]) / (at[:, :2] ** 2).sum(axis=1)
    twist = turned[at[:, 2] > 3.99].mean() - turned[at[:, 2] < 0.01].mean()
    assert twist == pytest.approx(4.0 * 100.0 / (2.0 * np.pi * wall[2, 2]), rel=0.03)
    assert np.abs(sum_of).max() < 0.1
