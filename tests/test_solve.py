"""Decks that CalculiX solves, against laminate theory written down here once more, and what goes wrong."""

import json
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
import pytest
from export_results import laminate, layered_results, leave, waisted_results
from layup_shapes import cylinder, helices

import meshwind as mw
from meshwind.core.cast import Bools, Floats
from meshwind.exporting.material import Material, read_material
from meshwind.exporting.shell_about import Strengths, read_about
from meshwind.results.schema import SHELL, SHELL_ABOUT, SOLVED, SOLVED_FIGURES
from meshwind.solving.deck import ReadDeck, read_deck
from meshwind.solving.figures import SolvedFigures
from meshwind.solving.tsai_wu import index

BAND = 0.02
"""Thickness of a layer of band; a family has about two."""
TURN = 4.0 * np.tan(np.radians(54.7356)) / (2.0 * np.pi)
"""Turns of helices on a cylinder of radius 1 and height 4 at the angle of a tube under pressure."""

pytestmark = pytest.mark.usefixtures("calculix")


@dataclass
class Tube:
    """A solved tube of radius 1: its deck, the fields of its cells, and which cells are far from the rims."""

    deck: ReadDeck
    data: dict[str, Floats]
    figures: SolvedFigures
    inside: Bools

    def mean(self, name: str) -> Floats:
        return np.asarray(self.data[name][self.inside].mean(axis=0))

    @property
    def thickness(self) -> float:
        return float(self.mean("thickness"))

    @property
    def angle(self) -> float:
        """Angle of family +1 from the axis, towards growing u."""
        fibre = self.data["fibre_1_1"][self.inside]
        around = np.cross([0.0, 0.0, 1.0], self.data["normal"][self.inside])
        return float(np.arctan2((fibre * around).sum(axis=1), fibre[:, 2]).mean())


def tube(folder: Path, turns: float, material: str, loads: dict[str, float]) -> Tube:
    leave(folder, helices(16, turns, 401, cylinder(64)))
    asked = {"thickness": BAND, "elements": 300, "material": material, "held": "none", **loads}
    mw.export(folder, "inp", **asked)  # type: ignore[arg-type]
    done = mw.solve_deck(folder, render=False)
    assert [file.name for file in done.files] == [SOLVED_FIGURES, SOLVED]
    deck = read_deck(folder / SHELL)
    data = {name: values[0] for name, values in meshio.read(folder / SOLVED).cell_data.items()}
    return Tube(deck, data, done.figures, np.abs(deck.centre[:, 2] - 2.0) < 0.8)


def reduced(m: Material) -> Floats:
    """Stiffness (3, 3) of a ply in plane stress, in its own axes."""
    q = np.array([[m.e1, m.nu12 * m.e2, 0.0], [m.nu12 * m.e2, m.e2, 0.0], [0.0, 0.0, 0.0]])
    q /= 1.0 - m.nu12**2 * m.e2 / m.e1
    q[2, 2] = m.g12
    return q


def turn(angle: float) -> Floats:
    """Strain along z, around and in shear to strain in the axes of a ply at an angle from z towards around."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])


def plies_of(tube: Tube, m: Material, forces: Floats) -> dict[int, tuple[Floats, Floats]]:
    """Strain and stress (3,) of each family in its own axes under forces along, around and in shear per length."""
    q, angle = reduced(m), tube.angle
    wall = sum(0.5 * tube.thickness * turn(a).T @ q @ turn(a) for a in (angle, -angle))
    strain = np.linalg.solve(wall, forces)
    # from z to around is a turn about the inward normal, while axis 2 of a ply is square to 1 about the outward one
    own = {family: np.array([1.0, 1.0, -1.0]) * (turn(family * angle) @ strain) for family in (1, -1)}
    return {family: (each, q @ each) for family, each in own.items()}


@pytest.mark.parametrize(
    ("loads", "forces"),
    [
        ({"pressure": 0.8}, (0.4, 0.8, 0.0)),
        ({"axial": 2.0}, (2.0 / (2.0 * np.pi), 0.0, 0.0)),
        ({"torque": 0.002}, (0.0, 0.0, 2.0 / (2.0 * np.pi))),
    ],
)
def test_plies_have_the_stresses_of_laminate_theory(
    tmp_path: Path, loads: dict[str, float], forces: tuple[float, float, float]
) -> None:
    """A tube of +-54.7 degrees, radius 1: under p the forces are p / 2 along and p around, with their signs."""
    found = tube(tmp_path, TURN, "e-glass-epoxy", loads)
    assert np.degrees(abs(found.angle)) == pytest.approx(54.7356, abs=0.3)
    m = read_material("e-glass-epoxy")
    for family, (strain, stress) in plies_of(found, m, np.array(forces)).items():
        name = f"1_{1 if family > 0 else 2}"
        scale = np.abs(stress).max()
        mean = found.mean(f"stress_{name}")
        assert mean == pytest.approx(stress, abs=0.015 * scale), family
        assert (
            np.sign(mean[np.abs(stress) > 0.05 * scale]).tolist()
            == np.sign(stress[np.abs(stress) > 0.05 * scale]).tolist()
        )
        assert found.mean(f"strain_{name}") == pytest.approx(strain, abs=0.02 * np.abs(strain).max())
        assert found.data["exposure"][found.inside].min() > 0.0
    stresses = np.array([stress for _, stress in plies_of(found, m, np.array(forces)).values()])
    expected = index(stresses, Strengths(dict(m.strengths), -0.5)).exposure.max()
    assert np.median(found.data["exposure"][found.inside]) == pytest.approx(expected, rel=0.06)


def test_a_tube_of_dry_tow_is_a_net(tmp_path: Path) -> None:
    """At 54.7 degrees fibres alone bear 2 to 1: p R = t s sin^2, p R / 2 = t s cos^2; without strengths no index."""
    found = tube(tmp_path, TURN, "dry-tow", {"pressure": 0.8})
    assert found.mean("stress_1_1")[0] == pytest.approx(1.5 * 0.8 / found.thickness, rel=0.02)
    assert "exposure" not in found.data and "largest" not in found.figures
    assert any("no strengths are known" in note for note in found.figures["notes"])


def test_an_isotropic_tube_has_the_stresses_of_boiler_formula(tmp_path: Path) -> None:
    """Around p r / t and along p r / 2 t, also where t is a tenth of r; half the load gives half the index."""
    leave(tmp_path, helices(16, 0.5, 401, cylinder(64)))
    exposures = []
    for share in (1.0, 0.5):
        mw.export(tmp_path, "inp", thickness=0.05, elements=300, material="epoxy", held="none", pressure=2.0 * share)
        exposures.append(mw.solve_deck(tmp_path, render=False).figures["largest"]["exposure"])
        if share < 1.0:
            continue
        data = {name: values[0] for name, values in meshio.read(tmp_path / SOLVED).cell_data.items()}
        deck = read_deck(tmp_path / SHELL)
        inside = np.abs(deck.centre[:, 2] - 2.0) < 0.8
        thick = data["thickness"][inside].mean()
        assert 0.08 < thick < 0.25
        for ply in ("1_1", "1_2"):
            s1, s2, t = data[f"stress_{ply}"][inside].mean(axis=0)
            fibre = data[f"fibre_{ply}"][inside]
            c2 = float((fibre[:, 2] ** 2).mean())
            cs = np.sqrt(c2 * (1.0 - c2))
            # by Mohr's circle from the axes of the fibre to those of the tube; the sign of shear is that of the family
            bend = 2.0 * cs * abs(t)
            along, around = s1 * c2 + s2 * (1.0 - c2) - bend, s1 * (1.0 - c2) + s2 * c2 + bend
            assert around == pytest.approx(2.0 / thick, rel=0.01)
            assert along == pytest.approx(1.0 / thick, rel=0.01)
    assert exposures[1] == pytest.approx(0.5 * exposures[0], rel=1e-4)


def test_what_keeps_a_part_in_place_bears_nothing(tmp_path: Path) -> None:
    """Other six displacements that are 0 give the same stresses, on a duct that bends and whose ends are apart."""
    mw.wind("data/elbow.obj", paths=8, particles=101, out=tmp_path, render=False)
    mw.export(tmp_path, "inp", thickness=1.0, elements=300, held="none", pressure=1.0)
    first = mw.solve_deck(tmp_path, out=tmp_path / "a", render=False)
    text = (tmp_path / SHELL).read_text()
    before, _, rest = text.partition("*BOUNDARY\n")
    held, card, rest = rest.partition("*CLOAD")
    assert len(held.splitlines()) == 6
    deck = read_deck(tmp_path / SHELL)
    a, b, c = (int(np.abs(deck.points - place).sum(axis=1).argmin()) + 1 for place in _spread(deck))
    other = [f"{a}, 1, 3", f"{b}, 2, 3", f"{c}, 1, 1"]
    (tmp_path / SHELL).write_text(before + "*BOUNDARY\n" + "\n".join(other) + "\n" + card + rest)
    second = mw.solve_deck(tmp_path, out=tmp_path / "b", render=False)
    assert any("was changed after its export" in note for note in second.notes) and not first.notes
    exposures = [meshio.read(tmp_path / name / SOLVED).cell_data["exposure"][0] for name in ("a", "b")]
    assert np.abs(exposures[1] - exposures[0]).max() < 0.01 * exposures[0].max()


def _spread(deck: ReadDeck) -> list[Floats]:
    """Places on the start rim and on the end rim that no axis joins."""
    start, end = (deck.points[rim] for rim in deck.rims)
    return [start[start[:, 1].argmax()], end[end[:, 1].argmax()], start[start[:, 1].argmin()]]


def test_layers_and_triangles_are_solved(tmp_path: Path) -> None:
    """A laminate of three layers has five plies, the hoop one; a quad mesh on crossings has triangles."""
    (tmp_path / "a").mkdir()
    layered_results(tmp_path / "a", laminate())
    mw.export(tmp_path / "a", "inp", elements=200, pressure=0.01, held="none")
    done = mw.solve_deck(tmp_path / "a", render=False)
    assert done.figures["plies"] == 5
    mesh = meshio.read(tmp_path / "a" / SOLVED)
    hoop = mesh.cell_data["stress_2_1"][0]
    middle = np.abs(read_deck(tmp_path / "a" / SHELL).centre[:, 2] - 2.0)
    assert np.isfinite(hoop[middle < 0.7]).all() and np.isnan(hoop[middle > 1.5]).all()
    assert hoop[middle < 0.7, 0].min() > 0.0 and "stress_2_2" not in mesh.cell_data
    (tmp_path / "b").mkdir()
    waisted_results(tmp_path / "b")
    mw.export(tmp_path / "b", "inp", thickness=0.02, shell="quads", axial=1.0)
    mw.solve_deck(tmp_path / "b", render=False)
    mesh = meshio.read(tmp_path / "b" / SOLVED)
    assert {block.type for block in mesh.cells} == {"quad8", "triangle6"}
    assert all(np.isfinite(values).all() for values in mesh.cell_data["exposure"])
    assert np.linalg.norm(mesh.point_data["displacement"], axis=1).max() > 0.0
    assert json.loads((tmp_path / "b" / SOLVED_FIGURES).read_text())["largest"]["load_factor"] > 0.0
    about = read_about(tmp_path / "b" / SHELL_ABOUT)
    assert about.strengths.of == dict(read_material().strengths) and about.units == "mm"
