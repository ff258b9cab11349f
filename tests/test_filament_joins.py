"""Layers as one filament: joins between them, in order of winding, and never turning back."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament import ends
from meshwind.filament.closing import close_layer
from meshwind.filament.course import Kind
from meshwind.filament.filament import Filament, filament_of_layers
from meshwind.filament.joins import strand_of_paths
from meshwind.filament.laminate import Laminate, Ply, helical_layer
from meshwind.filament.levels import levels
from meshwind.filament.part_turn import Bend
from meshwind.filament.spiral import Ground, between_hoops, from_path, to_path
from meshwind.filament.thickness import Laying
from meshwind.results.filament_file import read_filaments
from meshwind.results.pattern_figures import patterns_of_layers
from meshwind.surface.interpolate import interpolate
from meshwind.workflow.layer_plans import LayerPlan, LayersFile
from meshwind.workflow.layers import about_layers, lay_layers
from meshwind.workflow.options import Options

HELIX = LayerPlan("helical", revolutions=0.45, paths=7, band_width=12.0, band_thickness=0.4, friction=0.3)
HOOP = LayerPlan("hoop", band_width=12.0, band_thickness=0.4, friction=0.3, start=0.3, end=0.7)
LAYERS = st.lists(
    st.one_of(
        st.builds(
            lambda paths, turn: replace(
                HELIX, paths=paths, turn_start=turn, turn_end=turn, friction=0.3 if turn == "collar" else 0.0
            ),
            st.integers(3, 9),
            st.sampled_from(["pins", "collar", "shaft"]),
        ),
        st.builds(lambda paths: replace(HELIX, paths=paths, start=0.35, end=0.65, friction=0.6), st.integers(3, 9)),
        st.builds(
            lambda passes, low, high: replace(HOOP, passes=passes, start=low, end=high),
            st.integers(1, 3),
            st.floats(0.05, 0.4),
            st.floats(0.6, 0.95),
        ),
    ),
    min_size=2,
    max_size=4,
)


def _barrel(u: Floats, v: Floats) -> Floats:
    z = 300.0 * v - 150.0
    radius = 60.0 - 10.0 * (z / 150.0) ** 2
    return np.stack([radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u), z], axis=-1)


def _tube(u: Floats, v: Floats) -> Floats:
    return np.stack([50.0 * np.cos(2 * np.pi * u), 50.0 * np.sin(2 * np.pi * u), 300.0 * v], axis=-1)


BARREL = interpolate(_barrel, (24, 16))


def wound(surface: mw.Surface, plans: list[LayerPlan]) -> tuple[Filament, Laminate]:
    """The filament of a laminate, and the laminate."""
    options = Options(continuous=True, particles=51)
    layered, _ = lay_layers(surface, LayersFile(Path("none"), tuple(plans)), options, "mm")
    (one,) = filament_of_layers(layered.laminate)
    return one, layered.laminate


@settings(max_examples=6, deadline=None, derandomize=True, database=None, phases=[Phase.generate])
@given(LAYERS)
def test_any_layers_are_one_filament(plans: list[LayerPlan]) -> None:
    try:
        one, laminate = wound(BARREL, plans)
    except BadInputError as refusal:  # a thick laminate lifts the rim, so that its collar stands up
        assert "give pins or a shaft there" in str(refusal) and "collar" in repr(plans)
        return
    polylines = [1 if each.paths is None else len(each.paths) for each in laminate.layers]
    course = one.course
    assert (np.diff(one.layer) >= 0).all() and set(one.layer) == set(range(len(plans)))
    # from the layer below to the one above it is a step of its thickness, elsewhere no more than between particles
    steps = np.linalg.norm(np.diff(course.points, axis=0), axis=1)
    change = np.flatnonzero(np.diff(one.layer))
    assert steps[change].max() < 5.0
    onto_pins = course.kind[1:] == Kind.TURN
    assert steps[~onto_pins & ~np.isin(course.kind[1:], (Kind.JOIN, Kind.DWELL))].max() < 20.0
    # the part never turns back, but for what a polygon of the rim is off it
    turned = np.unwrap(np.arctan2(course.points[:, 1], course.points[:, 0]))
    assert np.diff(turned).min() > -1e-3
    # each path is wound once, and in one piece
    laid = course.path[course.path >= 0]
    pieces = laid[np.diff(laid, prepend=-1) != 0]
    helices = [k for k, plan in enumerate(plans) if plan.kind == "helical"]
    starts = np.concatenate([[0], np.cumsum(polylines)])
    assert sorted(pieces) == sorted(k for each in helices for k in range(starts[each], starts[each + 1]))
    # a layer lies as high over the part as the laminate below it, to what the surfaces below state
    assert one.thickness[one.layer == 0].max() == 0.0
    high = np.hypot(*course.points[:, :2].T) - (60.0 - 10.0 * (course.points[:, 2] / 150.0) ** 2)
    off = np.abs(high - one.thickness)
    for number in range(1, len(plans)):
        stated = sum(each.raised.off_max for each in laminate.layers[:number])
        mine = off[(one.layer == number) & (course.kind == Kind.LAID)]
        assert mine.max(initial=0.0) < 0.2 and mine.sum() < max(0.03, 0.6 * stated) * max(len(mine), 1)


def test_turns_on_a_cylinder_within_the_part() -> None:
    """They take the friction that there is, and as much of the part as a collar would: R/f (1/sin a - 1)."""
    tube = interpolate(_tube, (24, 16))
    paths = 7
    closed = close_layer(tube, ends.LayerPlan(paths, 0.4, 0.5, 101, between=(0.3, 0.7)))
    turns = [each for each in closed.turnarounds if isinstance(each, Bend)]
    angle = np.arctan(2 * np.pi * 50.0 * closed.revolutions / 120.0)
    assert len(turns) == 2
    for turn in turns:
        assert turn.slip == pytest.approx(0.5, rel=0.02)
        assert turn.reach == pytest.approx(50.0 / 0.5 * (1.0 / np.sin(angle) - 1.0), rel=2e-3)
        assert turn.line == pytest.approx((0.7 + turn.reach / 300.0) if turn.edge.end else (0.3 - turn.reach / 300.0))
    course = closed.filaments[0]
    assert np.hypot(*course.points[:, :2].T) == pytest.approx(50.0, abs=1e-3)
    # what turns on the part is in the layer's thickness
    lines = levels(tube)
    strand = strand_of_paths(closed, None, Ground(tube, lines, 8.0), 0.5)
    layer = helical_layer(closed.paths, Ply(Laying(8.0, 0.2)), lines, strand=strand)
    assert layer.fibre_length == pytest.approx(course.arc_length[-1], rel=1e-3)
    assert layer.thickness.volume == pytest.approx(8.0 * 0.2 * layer.fibre_length, rel=1e-9)
    for word, friction in (("pins", 0.5), ("auto", 0.0)):
        with pytest.raises(BadInputError, match="let it end at the rim"):
            close_layer(tube, ends.LayerPlan(paths, 0.4, friction, 101, (word, word), between=(0.3, 0.7)))
    with pytest.raises(BadInputError, match="let it end further inside"):
        close_layer(tube, ends.LayerPlan(paths, 0.4, 0.1, 101, between=(0.3, 0.7)))


def test_a_way_to_a_hoop_needs_a_constant_slip_on_a_cylinder() -> None:
    """Over a distance h it is R (1/sin a - 1/sin b) / h."""
    tube = mw.shapes.cylinder(50.0, 300.0)
    on = Ground(tube, levels(tube), 10.0)
    angle, hoop = np.radians(30.0), np.arctan(2 * np.pi * 50.0 / 10.0)
    course = np.full(len(on.lines.v), angle)
    wanted = 50.0 * (1.0 / np.sin(angle) - 1.0 / np.sin(hoop)) / 120.0
    for way in (from_path(on, 0.25, 0.0, 0.4, course), to_path(on, 0.25, 0.6, 1.0, course)):
        assert way.slip == pytest.approx(wanted, rel=0.02)
        assert np.median(way.course.slip) == pytest.approx(wanted, rel=1e-3)
        assert (way.course.kind == Kind.JOIN).all()
    assert (way.leaves, way.comes, way.v) == pytest.approx((hoop, angle, 1.0), abs=1e-9)
    level = between_hoops(on, 0.0, 0.3, 0.7, 0.2)
    assert level.slip <= 0.2 and np.degrees(level.course.angle.min()) < 80.0


def test_a_cut_begins_a_filament_of_its_own() -> None:
    plans = (HELIX, replace(HOOP, cut=True), HELIX, replace(HELIX, paths=5, cut=True))
    layered, _ = lay_layers(BARREL, LayersFile(Path("none"), plans), Options(continuous=True, particles=51), "mm")
    laminate = layered.laminate
    made = filament_of_layers(laminate)
    assert [sorted(set(each.layer.tolist())) for each in made] == [[0], [1, 2], [3]]
    for each in (made[0], made[2]):  # nothing leads on: it closes
        assert each.course.points[0] == pytest.approx(each.course.points[-1], abs=1e-6)
    joins = [float(layer.strand.join.arc_length[-1]) for layer in laminate.layers if layer.strand and layer.strand.join]
    assert len(joins) == 1
    own = [float(layer.strand.course.arc_length[-1]) for layer in laminate.layers if layer.strand]
    figures = patterns_of_layers(laminate, made, "mm")
    assert [each["fibre_length"] for each in figures] == pytest.approx(
        [own[0], own[1], joins[0] + own[2], own[3]], rel=1e-4
    )
    last = (note.text for note in about_layers(layered, (False, False), "mm"))
    assert f"joins between layers, {joins[0]:.0f} mm of fibre, are in no layer's thickness" in last
    # each path is in them, counted on; the hoop, which is the polyline after 14 paths, is none
    paths = np.concatenate([np.unique(each.course.path[each.course.path >= 0]) for each in made])
    assert paths.tolist() == [*range(14), *range(15, 15 + 14 + 10)]


def test_joins_cross_the_part_where_there_is_no_room_at_the_rim() -> None:
    """On a cylinder from a hoop up to one rim to a path, and back, over its length h: R (1/sin a - 1/sin b) / h.

    On half a band before the rim it would take a friction of 12.
    """
    plans = (
        replace(HOOP, start=0.0, end=1.0), replace(HELIX, turn_start="pins", turn_end="pins", friction=0.5),
        replace(HOOP, start=0.0, end=1.0, friction=0.01),
    )  # fmt: skip
    options = Options(continuous=True, particles=51)
    layered, notes = lay_layers(interpolate(_tube, (24, 16)), LayersFile(Path("none"), plans), options, "mm")
    _, path, hoop = (each.strand for each in layered.laminate.layers)
    assert path is not None and hoop is not None
    angle = np.arctan(2 * np.pi * 50.0 * 0.45 / 300.0)
    wanted = 50.0 * (1.0 / np.sin(angle) - 1.0) / (300.0 - 6.0)
    # the steps of the layers below at both rims take the rest
    assert 0.95 * wanted < min(path.slip, hoop.slip) <= max(path.slip, hoop.slip) < 2.0 * wanted
    warnings = [each.text.split(",")[0] for each in notes if "join" in each.text]
    assert warnings == [f"layer 3: the join that leads to it needs a friction of {hoop.slip:.3g}"]


def test_a_join_ends_where_its_layer_begins_on_parts_that_are_not_round() -> None:
    """Ways bend where that needs least friction, which differs around a lobed tube, but are planned from one place."""

    def lobed(u: Floats, v: Floats) -> Floats:
        radius = 50.0 * (1.0 + 0.06 * np.cos(6 * np.pi * u)) * (1.0 + 0.05 * np.sin(np.pi * v))
        return np.stack([radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u), 260.0 * v], axis=-1)

    plans = (
        replace(HOOP, passes=2, start=0.2, end=0.8),
        replace(HELIX, start=0.3, end=0.7, friction=0.45, revolutions=0.35, paths=13),
        replace(HOOP, start=0.2, end=0.8),
    )
    options = Options(continuous=True, particles=51)
    layered, _ = lay_layers(interpolate(lobed, (32, 16)), LayersFile(Path("none"), plans), options, "mm")
    for layer in layered.laminate.layers[1:]:
        assert layer.strand is not None and layer.strand.join is not None
        assert layer.strand.join.points[-1] == pytest.approx(layer.strand.course.points[0], abs=0.01)


def test_what_the_files_say_of_joined_layers(tmp_path: Path) -> None:
    (tmp_path / "layers.toml").write_text(
        "".join(
            f'[[layer]]\nkind = "{kind}"\n{keys}\nband_width = 15\nband_thickness = 0.3\nfriction = 0.3\n'
            for kind, keys in (
                ("helical", 'revolutions = 0.4\npaths = 6\nturn_start = "shaft"'),
                ("hoop", "from = 0.4\nto = 0.6"),
                ("helical", "revolutions = 0.3\npaths = 5"),
            )
        )
    )
    file = tmp_path / "layers.toml"
    result = mw.wind("data/tank.ply", layers=file, particles=101, continuous=True, out=tmp_path / "out", render=False)
    report = result.report()
    (one,) = read_filaments(tmp_path / "out" / "filament.vtp")
    arc = one.course.arc_length
    for number, figures in enumerate(report["pattern"]):
        mine = np.flatnonzero(one.layer == number)
        assert figures["fibre_length"] == pytest.approx(arc[mine[-1]] - arc[max(mine[0] - 1, 0)], rel=1e-9)
    assert [each["turnarounds"] for each in report["laminate"]] == [["shaft", "pins"], None, ["pins", "pins"]]
    assert report["laminate"][0]["join"] == {"length": 0.0, "slip": 0.0}
    for each in report["laminate"][1:]:
        assert each["join"] is not None and each["join"]["length"] > 10.0
    joins = [str(note) for note in result.notes if "the join that leads to it" in note.text]
    assert joins and all(line.startswith("warning: layer ") for line in joins)
    with pytest.raises(BadInputError, match="turnarounds are of a filament; set continuous"):
        mw.wind("data/tank.ply", layers=file, particles=101)
    file.write_text(file.read_text().replace('turn_start = "shaft"', "cut = true"))
    with pytest.raises(BadInputError, match="layer 1: only a filament is cut; set continuous"):
        mw.wind("data/tank.ply", layers=file, particles=101)
