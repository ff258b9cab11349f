"""The shell decks, and what CalculiX makes of one."""

import re
import subprocess
from pathlib import Path

import meshio
import numpy as np
import pytest
from export_results import plain_results, waisted_results

from meshwind.core.errors import BadInputError
from meshwind.exporting.elements import Elements, on_crossings, regular
from meshwind.exporting.material import read_material
from meshwind.exporting.plies import plies
from meshwind.exporting.shell_deck import Deck, thicknesses, write_decks
from meshwind.exporting.shell_loads import FORCE
from meshwind.exporting.targets import ExportOptions, write_exports
from meshwind.results.reading import Results
from meshwind.results.schema import SHELL, SHELL_S4R


def deck_of(results: Results, elements: Elements, **given: float) -> Deck:
    return Deck(
        elements, plies(results, elements, **given), read_material(), results.units, results.name, tolerance=0.0
    )


def blocks(path: Path, keyword: str) -> list[list[str]]:
    """The data lines below each card that begins with the keyword."""
    cards = re.split(r"^(?=\*[A-Z])", path.read_text(), flags=re.MULTILINE)
    lines = [card.splitlines()[1:] for card in cards if card.startswith(keyword)]
    return [[line for line in card if not line.startswith("**")] for card in lines]


def read(path: Path) -> meshio.Mesh:
    """The mesh as another program sees it, which knows six-node triangles by Abaqus's name alone."""
    other = path.with_name("other.inp")
    other.write_text(path.read_text().replace("TYPE=S6,", "TYPE=STRI65,"))
    return meshio.abaqus.read(other)


@pytest.fixture(scope="module", params=["grid", "quads"])
def written(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[Deck, Path]:
    out = tmp_path_factory.mktemp(request.param)
    results = waisted_results(out)
    deck = deck_of(results, regular(results.surface, 300) if request.param == "grid" else on_crossings(results))
    write_decks(out, deck)
    return deck, out


@pytest.mark.parametrize(("name", "kinds"), [(SHELL, {"quad8", "triangle6"}), (SHELL_S4R, {"quad", "triangle"})])
def test_another_program_reads_the_mesh(written: tuple[Deck, Path], name: str, kinds: set[str]) -> None:
    deck, out = written
    mesh = read(out / name)
    faces = {block.type: block.data for block in mesh.cells}
    assert set(faces) <= kinds
    assert sum(map(len, faces.values())) == len(deck.elements)
    quads = next(block for kind, block in faces.items() if kind.startswith("quad"))
    assert np.array_equal(quads[:, :4], deck.elements.quads)
    assert np.allclose(mesh.points[: len(deck.elements.points)], deck.elements.points, rtol=0, atol=1e-10)


def test_nodes_amid_edges_lie_on_the_surface(written: tuple[Deck, Path]) -> None:
    """Second order: a middle node is off its chord by the sagitta, and halfway along it."""
    deck, out = written
    mesh = read(out / SHELL)
    quads = next(block.data for block in mesh.cells if block.type == "quad8")
    corners, amid = mesh.points[quads[:, :4]], mesh.points[quads[:, 4:]]
    after = np.roll(corners, -1, axis=1)
    chord = np.linalg.norm(after - corners, axis=2)
    assert (np.linalg.norm(amid - 0.5 * (after + corners), axis=2) < 0.25 * chord).all()
    radius = np.hypot(amid[..., 0], amid[..., 1])
    v = amid[..., 2] / 4.0
    expected = 1.0 - 0.35 * np.exp(-(((v - 0.5) / 0.16) ** 2))
    assert np.abs(radius - expected).max() < 1e-3


def test_rims_take_the_whole_load(written: tuple[Deck, Path]) -> None:
    deck, out = written
    for name in (SHELL, SHELL_S4R):
        loads = np.array([list(map(float, line.split(","))) for line in blocks(out / name, "*CLOAD")[0]])
        assert np.bincount(loads[:, 1].astype(int), loads[:, 2], 4)[3] == pytest.approx(FORCE, rel=1e-8)
        sets = blocks(out / name, "*NSET")
        assert len(sets) == 2
        points = read(out / name).points
        for lines, z in zip(sets, (0.0, 4.0), strict=True):
            members = [int(part) - 1 for line in lines for part in line.split(",") if part.strip()]
            assert set(members) == set(np.flatnonzero(np.abs(points[:, 2] - z) < 1e-9))


def test_orientations_are_the_fibres(written: tuple[Deck, Path]) -> None:
    deck, out = written
    cards = blocks(out / SHELL, "*ORIENTATION")
    axes = np.array([list(map(float, card[0].split(","))) for card in cards]).reshape(-1, 2, 2, 3)
    for k, ply in enumerate(deck.plies.families):
        assert np.allclose(axes[:, k, 0], ply.direction, atol=1e-8)
        assert np.allclose(np.cross(axes[:, k, 0], axes[:, k, 1]), deck.plies.normal, atol=1e-8)


def test_sections_hold_the_thickness(written: tuple[Deck, Path]) -> None:
    deck, out = written
    sections = blocks(out / SHELL, "*SHELL SECTION")
    layers = np.array([[float(line.split(",")[0]) for line in section] for section in sections])
    thick = thicknesses(deck)
    assert np.allclose(layers, np.stack([0.5 * thick[0], thick[1], 0.5 * thick[0]], axis=1), rtol=1e-8)
    assert (np.abs(thick / deck.plies.layer / np.stack([p.layers for p in deck.plies.families]) - 1.0) < 0.08).all()


def test_a_layer_is_as_thick_as_the_band_of_the_run(tmp_path: Path) -> None:
    results = plain_results(tmp_path)
    elements = regular(results.surface, 100)
    assert results.band_thickness is None
    assert plies(results, elements).layer == pytest.approx(1e-3 * results.diagonal)
    results.report["fibre"] = {**results.report["fibre"], "band_thickness": 0.02}
    assert plies(results, elements).layer == 0.02
    assert plies(results, elements, layer=0.03).layer == 0.03


def test_a_deck_needs_a_thickness(tmp_path: Path) -> None:
    """It is not guessed; a field of fibres has one for want of a better."""
    plain_results(tmp_path)
    with pytest.raises(BadInputError, match="how thick its band is; give thickness"):
        write_exports(tmp_path, ("inp",))
    assert not (tmp_path / SHELL).exists()
    write_exports(tmp_path, ("inp",), options=ExportOptions(thickness=0.02, count=100))
    assert "a layer of band is 0.02 thick" in (tmp_path / SHELL).read_text()
    write_exports(tmp_path, ("fibers",))


def test_units_scale_the_material() -> None:
    """The same part in metres: moduli in Pa, density in kg/m3."""
    assert read_material().moduli("m")[0] == pytest.approx(135e9)
    assert read_material().mass("m") == pytest.approx(1600.0)
    assert read_material().moduli("mm")[3:6] == read_material().moduli("in")[3:6] == (0.3, 0.3, 0.4)
    with pytest.raises(BadInputError, match="no known length"):
        read_material().mass("furlong")


def axial_modulus(angle: float) -> float:
    """Classical laminate theory: E_x of a balanced symmetric stack at +-angle from x, in closed form."""
    m = read_material()
    nu21 = m.nu12 * m.e2 / m.e1
    q = np.array([[m.e1, m.nu12 * m.e2, 0.0], [m.nu12 * m.e2, m.e2, 0.0], [0.0, 0.0, 0.0]]) / (1.0 - m.nu12 * nu21)
    q[2, 2] = m.g12
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
    laminate = turn.T @ q @ turn
    laminate[:2, 2] = laminate[2, :2] = 0.0  # plus and minus cancel
    return float(1.0 / np.linalg.inv(laminate)[0, 0])


@pytest.mark.usefixtures("calculix")
def test_calculix_stretches_a_cylinder_as_laminate_theory_says(tmp_path: Path) -> None:
    results = plain_results(tmp_path)
    deck = deck_of(results, regular(results.surface, 300), layer=0.01)
    write_decks(tmp_path, deck)
    ply = deck.plies.families[0]
    assert np.ptp(ply.angle) < 1e-6
    done = subprocess.run(["ccx", "shell"], cwd=tmp_path, capture_output=True, text=True, timeout=120, check=True)
    assert "*ERROR" not in done.stdout
    rows = (line.split() for line in (tmp_path / "shell.dat").read_text().splitlines())
    moved = np.array([list(map(float, row)) for row in rows if len(row) == 4 and row[0].isdigit()])
    points = np.array([list(map(float, line.split(","))) for line in blocks(tmp_path / SHELL, "*NODE,")[0]])
    moved = moved[points[moved[:, 0].astype(int) - 1, 3] > 3.99]
    expected = FORCE * 4.0 / (2.0 * np.pi * thicknesses(deck).sum(axis=0).mean() * axial_modulus(ply.angle[0]))
    assert moved[:, 3].mean() == pytest.approx(expected, rel=0.03)
    assert np.abs(moved[:, 1:3].mean(axis=0)).max() < 0.01 * expected
