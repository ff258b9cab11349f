"""An eye that goes into hollows: bent parts, where the fibre's line would meet the other leg."""

from functools import cache
from math import pi

import numpy as np
import pytest

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.filament.closing import close_layer
from meshwind.filament.course import Kind
from meshwind.filament.ends import LayerPlan
from meshwind.filament.filament import filaments_of
from meshwind.program.blocks import Blocks
from meshwind.program.machine import read_machine
from meshwind.program.program import Program, program
from meshwind.program.rewinding.rewind import Ground, rewind
from meshwind.program.work import Work

MAJOR, MINOR = 80.0, 20.0
FRICTION = 0.2


@cache
def bend() -> Work:
    """A tube bent by a quarter, wound with four circuits."""
    surface = mw.shapes.torus(MAJOR, MINOR, 0.5 * pi, (24, 32))
    layer = close_layer(surface, LayerPlan(4, 0.6, FRICTION, particles=101))
    return Work(tuple(filaments_of(layer)), surface, 200.0, "mm")


@cache
def wound(name: str) -> Program:
    """The program of a machine for it."""
    return program(bend(), read_machine(name))


def heights(points: Floats) -> Floats:
    """Distances (n,) of points from the tube, within the bend."""
    height = np.hypot(np.hypot(points[:, 0], points[:, 1]) - MAJOR, points[:, 2]) - MINOR
    within = (points[:, 0] >= 0.0) & (points[:, 1] >= 0.0)
    return np.asarray(height[within])


def depth(b: Blocks) -> float:
    """How deep the spans of blocks go below the tube."""
    shares = np.linspace(0.0, 1.0, 400)
    lowest = min(heights(b.point + s * b.free_length[:, None] * b.tangent).min() for s in shares)
    return -float(lowest)


def test_an_eye_with_cross_feed_clears_a_bend_that_another_cannot() -> None:
    fixed, near = wound("lathe-2"), wound("lathe-4")
    assert sum(fault.kind == "span" for fault in fixed.faults) > 20
    assert depth(fixed.blocks) > 5.0
    assert not any(words.startswith("shorter") for words in fixed.remedies)
    assert not near.faults
    assert near.remedies[-1].startswith("shorter spans in hollows: 0 of ")
    assert depth(near.blocks) < 1.3e-3 * 200.0
    assert heights(near.blocks.eye).min() > 0.9 * 2e-3 * 200.0
    assert 0.9 * 2e-3 * 200.0 < near.nearest < near.clearance == pytest.approx(10.0)


def test_an_eye_without_cross_feed_is_checked_where_it_really_is() -> None:
    """Where no slack would want the eye farther out, the machine holds it at its radius all the same."""
    made = wound("lathe-2")
    inside = made.mandrel.inside(made.eyes)
    assert made.radius is not None
    assert np.hypot(inside[:, 1], inside[:, 2]) == pytest.approx(made.radius, rel=1e-12)
    assert inside[:, 0] == pytest.approx(made.blocks.eye_x, abs=1e-9)
    assert made.losses["cross"] == pytest.approx(np.abs(made.blocks.eye_r - made.radius).max())
    assert wound("lathe-4").eyes == pytest.approx(wound("lathe-4").blocks.eye)


def test_the_fibre_comes_to_lie_where_it_was_planned_only_if_the_eye_goes_into_the_hollow() -> None:
    ground = Ground((bend().surface,), (10.0,), (FRICTION,))
    assert not rewind(wound("lathe-2"), ground).good.all()
    again = rewind(wound("lathe-4"), ground)
    assert again.good.all()
    assert again.distance.max() < 1e-3 * 200.0


def test_the_eye_moves_in_short_steps_and_the_fibre_is_never_slack() -> None:
    b = wound("lathe-4").blocks
    assert np.diff(b.arc_length + b.free_length).min() > -1e-9
    for values, most in ((b.mandrel, 5.0), (b.roll, 10.0), (b.eye_x, 10.0), (b.eye_r, 10.0)):
        assert np.abs(np.diff(values)).max() <= most * (1.0 + 1e-9)
    assert b.eye == pytest.approx(b.point + b.free_length[:, None] * b.tangent, abs=1e-9)
    # on the way out along a bridge nothing is laid, and the span swings by 0.05 at most
    in_air = b.kind == Kind.BRIDGE
    out = (np.diff(b.arc_length) == 0.0) & (np.diff(b.free_length) > 1.0)
    same = np.flatnonzero(in_air[1:] & in_air[:-1] & out) + 1
    assert len(same) > 10
    assert b.point[same] == pytest.approx(b.point[same - 1], abs=1e-12)
    turn = np.arccos(np.clip((b.tangent[same] * b.tangent[same - 1]).sum(axis=1), -1.0, 1.0))
    assert turn.max() < 0.05
