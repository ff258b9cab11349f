"""Exports of a run with layers: shell decks, fibre fields and robot frames have each layer."""

import csv
import re
import subprocess
from dataclasses import replace
from pathlib import Path

import meshio
import numpy as np
import pytest
from export_results import filament_results, laminate, layered_results

import meshwind as mw
from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.exporting.elements import on_crossings, regular
from meshwind.exporting.material import read_material
from meshwind.exporting.plies import laid_on, plies
from meshwind.exporting.shell_deck import Deck, thicknesses
from meshwind.exporting.shell_loads import Loads
from meshwind.exporting.targets import ExportOptions, write_exports
from meshwind.filament.laminate import Laminate
from meshwind.results.reading import Results, read_results

PRESSURE = 10.0
LOADS = Loads(pressure=PRESSURE)
TANK = """
[[layer]]
kind = "helical"
revolutions = 0.7
band_width = 16
band_thickness = 0.3
friction = 0.3
[[layer]]
kind = "hoop"
band_width = 16
band_thickness = 0.6
from = 0.15
to = 0.85
friction = 0.3
[[layer]]
kind = "helical"
revolutions = 0.8
band_width = 16
band_thickness = 0.3
friction = 0.3
"""
Section = list[tuple[float, str]]


@pytest.fixture(scope="module")
def wound() -> Laminate:
    return laminate()


@pytest.fixture(scope="module")
def written(wound: Laminate, tmp_path_factory: pytest.TempPathFactory) -> Results:
    out = tmp_path_factory.mktemp("layers")
    results = layered_results(out, wound)
    write_exports(out, ("inp", "fibers", "frames"), options=ExportOptions(count=400, loads=LOADS, tolerance=0.0))
    return results


def cards(path: Path, keyword: str) -> list[list[str]]:
    """The data lines below each card that begins with the keyword."""
    found = re.split(r"^(?=\*[A-Z])", path.read_text(), flags=re.MULTILINE)
    lines = [card.splitlines()[1:] for card in found if card.startswith(keyword)]
    return [[line for line in card if not line.startswith("**")] for card in lines]


def sections(path: Path) -> list[Section]:
    """Thickness and name of the axes of each ply of each element, from the inside out."""
    rows = [[line.split(", ") for line in card] for card in cards(path, "*SHELL SECTION")]
    return [[(float(row[0]), re.sub(r"\d+$", "", row[-1])) for row in section] for section in rows]


def deck_of(results: Results, count: int = 400) -> Deck:
    elements = regular(laid_on(results), count, results.surface)
    return Deck(elements, plies(results, elements), read_material(), results.units, results.name, LOADS)


@pytest.mark.parametrize("name", ["shell.inp", "shell_s4r.inp"])
def test_an_element_has_its_layers_from_the_inside_out(written: Results, name: str) -> None:
    deck, found = deck_of(written), sections(written.folder / name)
    outer, hoop = ["L3P", "L3M", "L3P"], ["L2P"]
    z = deck.elements.surface.points(deck.elements.centre)[:, 2]
    thick = thicknesses(deck)
    for k, section in enumerate(found):
        inside = ["P", "M", "P"]
        assert [axes for _, axes in section] == inside + (hoop if thick[2, k] > 0.0 else []) + outer
        assert section[0][0] == section[2][0] == pytest.approx(0.5 * section[1][0])
        assert sum(t for t, _ in section) == pytest.approx(thick[:, k].sum(), rel=1e-7)
        if not 0.6 < z[k] < 3.4:  # a band and half an element from the hoop
            assert thick[2, k] == 0.0
        if 1.3 < z[k] < 2.7:
            assert thick[2, k] > 0.0


def test_the_thickness_is_that_of_the_maps(written: Results, wound: Laminate) -> None:
    """Per element the volume over its area; before rounding within what the radius makes of the area, after it 7 %."""
    deck = deck_of(written)
    area = deck.elements.samples()[1].sum(axis=1)
    at = deck.elements.samples()[0]
    z = deck.elements.surface.points(deck.elements.centre)[:, 2]
    whole = 0.0
    for number, stack in enumerate(deck.plies.stacks):
        over = sum((deck.plies.families[k].thickness for k in stack), np.zeros(len(area)))
        layer = wound.layers[number]
        volume = layer.thickness.volume
        assert (over * area).sum() == pytest.approx(volume, rel=5e-3)
        mapped = layer.thickness.at(at.reshape(-1, 2)).reshape(at.shape[:2]).mean(axis=1)
        even = (np.abs(np.abs(z - 2.0) - 1.0) > 0.4) | (layer.hoop is None)  # off the hoop's edges
        assert over[even] == pytest.approx(mapped[even], rel=0.02, abs=0.05 * layer.laying.thickness)
        whole += volume
    total = thicknesses(deck).sum(axis=0)
    assert (total * area).sum() == pytest.approx(whole, rel=3e-3)
    assert np.abs(total / deck.plies.thickness - 1.0).max() < 0.07
    assert len(np.unique(total.round(12))) < 12
    share = thicknesses(deck) / total
    assert share == pytest.approx(np.stack([p.thickness for p in deck.plies.families]) / deck.plies.thickness)


def test_thickness_that_varies_much_has_coarser_steps(written: Results) -> None:
    """CalculiX has no room for a knot in every node."""
    deck = deck_of(written)
    ply = deck.plies.families[0]
    rough = np.exp(np.random.default_rng(5).normal(0.0, 0.1, len(deck.elements)))
    wild = replace(deck, plies=replace(deck.plies, families=(replace(ply, thickness=rough),)))
    fine, coarse = (thicknesses(each).sum(axis=0) for each in (deck, wild))
    assert len(np.unique(coarse.round(12))) <= 4
    area = deck.elements.samples()[1].sum(axis=1)
    assert (coarse * area).sum() == pytest.approx((rough * area).sum(), rel=1e-12)
    assert np.abs(fine / deck.plies.thickness - 1.0).max() < 0.07


@pytest.mark.parametrize("kind", ["grid", "quads"])
def test_directions_are_those_of_the_layers(written: Results, wound: Laminate, kind: str) -> None:
    """Helices on cylinders of radii 1 and r, and a hoop of a known pitch."""
    middle = laid_on(written)
    elements = regular(middle, 400) if kind == "grid" else on_crossings(written, middle)
    laid = plies(written, elements)
    outer = wound.layers[2].surface
    radius = np.hypot(*outer.points([(0.3, 0.5)])[0, :2])
    hoop = wound.layers[1].hoop
    assert hoop is not None
    z = middle.points(elements.centre)[:, 2]
    inside = (z > 1.3) & (z < 2.7)
    exact = np.arctan2(np.pi, 4.0), np.arctan2(2 * np.pi * (1.0 + wound.layers[0].thickness.median), hoop.pitch)
    for ply in laid.families:
        angle = (*exact, np.arctan2(2.0 * np.pi * radius, 4.0))[ply.layer - 1]
        assert np.degrees(np.abs(ply.angle[inside] - ply.family * angle)).max() < (0.1 if ply.layer == 1 else 0.5)
        across = np.stack(
            [-elements.surface.points(elements.centre)[:, 1], elements.surface.points(elements.centre)[:, 0]]
        )
        across /= np.hypot(*across)
        found = np.arctan2((ply.direction[:, :2].T * across).sum(axis=0), ply.direction[:, 2])
        assert np.degrees(np.abs(found[inside] - ply.family * angle)).max() < 0.7


def test_pressure_is_in_balance(written: Results) -> None:
    """On the skin of radius 1: the end is pulled by p pi, and so much presses on every unit of the inside.

    CalculiX presses on what lies half the thickness inside of the elements.
    """
    deck = deck_of(written)
    elements, thick = deck.elements, thicknesses(deck).sum(axis=0)
    for name in ("shell.inp", "shell_s4r.inp"):
        loads = np.array([list(map(float, line.split(","))) for line in cards(written.folder / name, "*CLOAD")[0]])
        force = np.bincount(loads[:, 1].astype(int), loads[:, 2], 4)[1:]
        members = "".join(cards(written.folder / name, "*NSET, NSET=END")[0]).split(",")
        corners = len([each for each in members if each.strip()])
        opening = 0.5 * corners * np.sin(2.0 * np.pi / corners)  # of the polygon of nodes
        assert force[2] == pytest.approx(PRESSURE * opening, rel=1e-3)
        assert np.abs(force[:2]).max() < 1e-3 * force[2]
        each = np.array([float(line.split(",")[2]) for line in cards(written.folder / name, "*DLOAD")[0]])
        radius = np.linalg.norm(elements.surface.points(elements.centre)[:, :2], axis=1)
        inner = 1.0 - 0.5 * thick / radius if name == "shell.inp" else 1.0
        area = elements.samples()[1].sum(axis=1) * inner
        assert (each * area).sum() == pytest.approx(PRESSURE * 2.0 * np.pi * 4.0, rel=1e-3)
    with pytest.raises(BadInputError, match="pressure is"):
        Loads(pressure=float("nan"))
    with pytest.raises(BadInputError, match="the layers of this run have their own"):
        plies(written, elements, layer=0.1)


def test_fibre_fields_have_each_layer(written: Results) -> None:
    for name in ("fibers.vtu", "fibers.vtk"):
        data = {key: values[0] for key, values in meshio.read(written.folder / name).cell_data.items()}
        thick = [data[f"thickness_{k}"] for k in (1, 2, 3)]
        assert np.allclose(np.sum(thick, axis=0), data["thickness"])
        fields = {"fibre_1_1", "fibre_1_2", "fibre_2_1", "fibre_3_1", "fibre_3_2"}
        assert {key for key in data if key.startswith("fibre")} == fields
        assert (data["angle_1_1"] > 0.0).all() and (data["angle_1_2"] < 0.0).all()
        for key in fields:
            assert np.linalg.norm(data[key], axis=1) == pytest.approx(1.0)
            assert np.abs((data[key] * data["normal"]).sum(axis=1)).max() < 1e-9


def rows(path: Path) -> dict[str, Floats]:
    names = path.read_text().splitlines()[0].split(",")
    return dict(zip(names, np.loadtxt(path, delimiter=",", skiprows=1).T, strict=True))


def test_layers_have_frames(written: Results, wound: Laminate) -> None:
    folder = written.folder / "frames"
    assert not (folder / "filament.csv").exists()
    first = 0
    for number, layer in enumerate(wound.layers):
        read = rows(folder / f"layer_{number:03d}.csv")
        count = 1 if layer.paths is None else len(layer.paths)
        assert set(read["path"]) == set(range(first, first + count))
        first += count
        assert set(read["layer"]) == {number} and set(read["bridge"]) == {0.0}
        assert set(read["width"]) == {layer.laying.width}
        begins = np.flatnonzero(read["index"] == 0)
        assert len(begins) == count
        lengths = read["arc_length"][np.append(begins[1:] - 1, -1)]
        assert lengths.sum() == pytest.approx(layer.fibre_length, rel=2e-3)
        apart = np.hypot(read["x"], read["y"])
        radius = np.hypot(*layer.surface.points([(0.3, 0.5)])[0, :2])
        assert apart == pytest.approx(radius, abs=0.03)


def test_a_filament_has_frames_in_order(tmp_path: Path) -> None:
    results = filament_results(tmp_path)
    write_exports(tmp_path, ("frames",), options=ExportOptions(step=0.1))
    assert not (tmp_path / "frames" / "layer_000.csv").exists()
    read = rows(tmp_path / "frames" / "filament.csv")
    course = results.filaments[0].course
    assert (np.diff(read["arc_length"]) >= 0.0).all()
    assert read["arc_length"][-1] == pytest.approx(course.arc_length[-1])
    assert np.array_equal(read["index"], np.arange(len(read["index"])))
    assert read["z"].max() < 4.0 + 1e-9  # a spline would swing past the end where the fibre turns round it
    # an angle that grows by three half turns, up, round, and down again
    turn = np.unwrap(np.arctan2(read["y"], read["x"])) / (2.0 * np.pi)
    assert turn[-1] == pytest.approx(1.5, abs=1e-6)

    def inside(low: float, high: float) -> Bools:
        return np.asarray((turn > low + 1e-6) & (turn < high - 1e-6))

    for low, high, layer, kind, path, passed in (
        (0.0, 0.5, 0, 0, 0, 0), (0.5, 1.0, 1, 2, -1, 0), (1.0, 1.165, 1, 0, 16, 1), (1.335, 1.5, 1, 0, 16, 1)
    ):  # fmt: skip
        here = inside(low, high)
        for name, value in (("layer", layer), ("kind", kind), ("path", path), ("pass", passed), ("bridge", kind == 1)):
            assert set(read[name][here]) == {float(value)}, name
    air = inside(1.165, 1.335)
    assert set(read["bridge"][air]) == set(read["kind"][air]) == {1.0}
    widths = np.array([layer["band_width"] for layer in results.layers])
    assert read["width"] == pytest.approx(widths[read["layer"].astype(int)])
    edges = np.stack([read[f"left_{axis}"] - read[f"right_{axis}"] for axis in "xyz"])
    assert np.linalg.norm(edges, axis=0) == pytest.approx(read["width"])
    write_exports(tmp_path, ("frames",), tmp_path / "wider", ExportOptions(width=0.7))
    assert set(rows(tmp_path / "wider" / "frames" / "filament.csv")["width"]) == {0.7}


def stiffness(angle: float) -> Floats:
    """Reduced stiffness (3, 3) along z, around and in shear, of fibres at an angle from z."""
    m = read_material()
    q = np.array([[m.e1, m.nu12 * m.e2, 0.0], [m.nu12 * m.e2, m.e2, 0.0], [0.0, 0.0, 0.0]])
    q /= 1.0 - m.nu12**2 * m.e2 / m.e1
    q[2, 2] = m.g12
    c, s = np.cos(angle), np.sin(angle)
    turn = np.array([[c * c, s * s, c * s], [s * s, c * c, -c * s], [-2 * c * s, 2 * c * s, c * c - s * s]])
    return np.asarray(turn.T @ q @ turn)


@pytest.mark.usefixtures("calculix")
def test_a_tank_of_three_layers_strains_as_laminate_theory_says(tmp_path: Path) -> None:
    """Internal pressure: N = p R around and p R / 2 along, in the middle of the cylinder of radius 60."""
    (tmp_path / "layers.toml").write_text(TANK)
    out = tmp_path / "out"
    mw.wind("data/tank.ply", layers=tmp_path / "layers.toml", out=out, render=False)
    write_exports(out, ("inp",), options=ExportOptions(count=1000, loads=LOADS))
    done = subprocess.run(["ccx", "shell"], cwd=out, capture_output=True, text=True, timeout=240, check=True)
    assert "*ERROR" not in done.stdout
    nodes = np.array([list(map(float, line.split(","))) for line in cards(out / "shell.inp", "*NODE,")[0]])
    table = (line.split() for line in (out / "shell.dat").read_text().splitlines())
    moved = np.array([list(map(float, row)) for row in table if len(row) == 4 and row[0].isdigit()])
    at, u = nodes[moved[:, 0].astype(int) - 1, 1:], moved[:, 1:]
    middle = np.abs(at[:, 2]) < 25.0
    at, u = at[middle], u[middle]
    around = (u[:, :2] * at[:, :2]).sum(axis=1) / (at[:, :2] ** 2).sum(axis=1)
    along = np.polyfit(at[:, 2], u[:, 2], 1)[0]
    with (out / "laminate.csv").open() as file:
        stations = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
    inplane = np.zeros((3, 3))
    for layer in range(3):
        here = [row for row in stations if row["layer"] == layer and abs(row["z"]) < 25.0]
        thick, angle = (float(np.mean([row[name] for row in here])) for name in ("thickness", "angle"))
        signs = (1.0,) if layer == 1 else (1.0, -1.0)
        inplane += sum(thick / len(signs) * stiffness(sign * np.radians(angle)) for sign in signs)
    strain = np.linalg.solve(inplane, [0.5 * PRESSURE * 60.0, PRESSURE * 60.0, 0.0])
    assert (along, around.mean()) == pytest.approx(strain[:2], rel=0.05)
    results = read_results(out)
    deck = deck_of(results, 1000)
    mass = (thicknesses(deck).sum(axis=0) * deck.elements.samples()[1].sum(axis=1)).sum()
    assert mass == pytest.approx(sum(layer["volume"] for layer in results.layers), rel=0.01)
