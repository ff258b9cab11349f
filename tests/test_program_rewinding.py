"""A program wound again by physics: exact cases, what goes wrong on purpose, bridges, friction, and what is said."""

from dataclasses import replace
from math import exp, pi, radians
from types import SimpleNamespace

import numpy as np
import pytest
from program_parts import work

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.filament.closing import close_layer
from meshwind.filament.course import Kind
from meshwind.filament.ends import LayerPlan
from meshwind.filament.filament import filaments_of
from meshwind.program.faults import LIES
from meshwind.program.machine import read_machine
from meshwind.program.program import Program, program
from meshwind.program.rewinding.rewind import Ground, rewind
from meshwind.program.work import Work
from meshwind.surface import Surface

LATHE = read_machine("lathe-4")
R, LENGTH, TURNS = 50.0, 400.0, 0.8
ANGLE = np.arctan2(2.0 * pi * R * TURNS, LENGTH)


def tube() -> tuple[Program, Ground]:
    surface = mw.shapes.cylinder(R, LENGTH)
    return program(work(surface, turns=TURNS, count=401), LATHE), Ground((surface,), (4.0,), (0.0,))


def wound(surface: Surface, plan: LayerPlan, diagonal: float, friction: float = 0.0) -> tuple[Program, Ground]:
    layer = close_layer(surface, plan)
    made = program(Work(tuple(filaments_of(layer)), surface, diagonal, "mm"), LATHE)
    return made, Ground((surface,), (4.0,), (friction,))


def turned(made: Program, degrees: Floats) -> Program:
    """The program with its mandrel turned by angles (n,)."""
    return replace(made, blocks=replace(made.blocks, mandrel=made.blocks.mandrel + degrees))


def test_helices_on_a_cylinder_lie_where_they_were_planned() -> None:
    made, ground = tube()
    found = rewind(made, ground)
    assert len(found.distance) == 4 and found.good.all() and not found.slid.any()
    # blocks are 5 degrees apart, and the eye cuts the corners between them
    assert found.distance.max() < 3e-4 * made.work.diagonal
    assert found.slip.max() < 0.02
    assert not found.faults(made.blocks)


def test_a_mandrel_that_is_off_shifts_the_fibre_as_a_curve_of_pursuit() -> None:
    made, ground = tube()
    off = 0.2
    found = rewind(turned(made, np.full(len(made.blocks), off)), ground)
    b = made.blocks
    one = (b.passed == 0) & (b.kind == Kind.LAID)
    span, laid = float(np.median(b.free_length[one])), float(np.ptp(b.arc_length[one]))
    # the eye's offset is R off square to the axis; the fibre closes on it by a share of 1/e in the length of a span
    shift = R * radians(off) * np.cos(ANGLE)
    # where it crosses the rim it is a little farther from the plan, which ends there
    assert found.distance.max() == pytest.approx(shift * (1.0 - exp(-laid / span)), rel=0.15)
    assert found.good.all()


def test_a_program_that_is_wrong_is_told(capsys: pytest.CaptureFixture[str]) -> None:
    del capsys
    made, ground = tube()
    b = made.blocks
    wrong = np.where((b.circuit == 1) & (b.passed == 2), 6.0 * np.sin(np.arange(len(b)) / 5.0), 0.0)
    found = rewind(turned(made, wrong), ground)
    assert not found.good.all()
    bad = found.stretches.first[~found.good]
    assert set(b.passed[bad]) == {2}
    (fault, *_) = found.faults(b, "mm")
    assert fault.kind == LIES and "in layer 1, circuit 2, pass out" in fault.words
    assert f"lies {found.distance[~found.good][0]:,.3g} mm from where" in fault.words
    assert b.passed[fault.index] == 2
    backwards = rewind(replace(made, blocks=replace(b, eye_x=b.eye_x + 40.0)), ground)
    assert not backwards.good.any()


def test_bridges_come_down_where_they_should_and_friction_is_measured() -> None:
    surface = mw.shapes.hyperboloid(40.0, 0.5, 100.0)
    made, ground = wound(surface, LayerPlan(8, 0.1, 0.0, particles=201), 250.0)
    assert (made.blocks.kind == Kind.BRIDGE).any()
    found = rewind(made, ground)
    assert found.good.all() and found.distance.max() < 1e-3 * 250.0
    steered = mw.shapes.cone(60.0, 40.0, 200.0)
    made, ground = wound(steered, LayerPlan(8, 0.7, 0.2, particles=201), 230.0, 0.2)
    found = rewind(made, ground)
    assert found.good.all() and found.distance.max() < 1e-3 * 230.0
    laid = made.blocks.kind == Kind.LAID
    assert found.slip.max() == pytest.approx(np.nanmax(made.blocks.slip[laid]), abs=0.03)
    # what friction does not hold slides to the geodesic
    held = rewind(made, replace(ground, frictions=(0.2,)))
    smooth = rewind(made, replace(ground, frictions=(0.0,)))
    assert not held.slid.any()
    if found.slip.max() > 0.1:
        assert smooth.slid.any() and smooth.distance.max() > held.distance.max()


def test_where_the_fibre_lies_does_not_depend_on_where_the_part_is() -> None:
    surface = mw.shapes.hyperboloid(40.0, 0.5, 100.0)
    axis = np.linalg.qr(np.array([[1.0, 2.0, 0.5], [0.3, 1.0, 2.0], [1.0, -1.0, 1.0]]))[0]
    axis = axis * np.sign(np.linalg.det(axis))
    plain = wound(surface, LayerPlan(4, 0.3, 0.0, particles=101), 250.0)
    moved = wound(
        Surface(surface.control_points @ axis.T + [30.0, -20.0, 500.0]), LayerPlan(4, 0.3, 0.0, particles=101), 250.0
    )
    one, other = (rewind(*each) for each in (plain, moved))
    assert other.distance == pytest.approx(one.distance, abs=1e-3)


def test_a_program_that_lays_nothing_on_the_part_has_nothing_to_tell() -> None:
    made, ground = tube()
    aside = replace(made, blocks=replace(made.blocks, point=made.blocks.point + made.blocks.normal))
    found = rewind(aside, ground)
    assert not len(found.distance) and not found.faults(aside.blocks)
    assert found.figures["passes"] == 0 and found.figures["distance"] is None
    two = Ground((*ground.surfaces, ground.surfaces[0]), (4.0, 4.0), (0.0, 0.0))  # no block is of the second layer
    assert np.array_equal(rewind(made, two).distance, rewind(made, ground).distance)


def test_each_layer_is_wound_again_with_its_own_friction() -> None:
    """That of the run is only for a part without layers: a laminate's file gives it layer by layer."""
    surface = mw.shapes.cylinder(R, LENGTH)
    layers = [SimpleNamespace(paths=SimpleNamespace(surface=surface), figures={"friction": mu}) for mu in (0.1, 0.3)]
    results = SimpleNamespace(
        surface=surface, band_widths=(4.0, 5.0), paths=SimpleNamespace(friction=0.0),
        wound_layers=SimpleNamespace(layers=layers),
    )  # fmt: skip
    assert [(on.width, on.friction) for on in Ground.of(results).layers] == [(4.0, 0.1), (5.0, 0.3)]  # type: ignore[arg-type]
    results.wound_layers, results.band_widths = None, (4.0,)
    assert [on.friction for on in Ground.of(results).layers] == [0.0]  # type: ignore[arg-type]
