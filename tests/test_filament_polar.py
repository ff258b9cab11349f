"""Passes over caps: geodesics known in closed form, filaments that close from every start, and the mesh pipeline."""

from functools import cache

import numpy as np
import pytest
from irregular import annulus
from scipy.integrate import quad
from vessels import Vessel, arc, line

import meshwind as mw
from meshwind.chart import flatten
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.joining import join, passes
from meshwind.filament.polar import PolarPasses, natural_turns, passes_between_caps, passes_over_a_cap
from meshwind.filament.polar_legs import FINEST, End, Legs, halves, opening
from meshwind.path.paths import Status
from meshwind.surface.interpolate import Formula, interpolate

A2, B2, C2 = 160.0**2, 100.0**2, 80.0**2
"""Semi-axes squared of a triaxial ellipsoid, wound about the longest."""
ELLIPSOIDS = [(11374.360476140, 3, 4, 2499.0825407), (10782.188011500, 7, 9, 5758.3388161),
              (10153.856745447, 5, 6, 4033.5526684)]  # fmt: skip
"""Openings along lines of curvature, circuits and turns in which their geodesics close, and the length of all."""
RADIUS, LENGTH, HOLE = 100.0, 300.0, 30.0
CAPSULE = Vessel((
    arc((0.0, 0.0), (RADIUS, RADIUS), np.arcsin(HOLE / RADIUS) - np.pi / 2, 0.0),
    line((RADIUS, 0.0), (RADIUS, LENGTH)),
    arc((0.0, LENGTH), (RADIUS, RADIUS), 0.0, np.pi / 2 - np.arcsin(HOLE / RADIUS)),
))  # fmt: skip


def ellipsoid(gamma: float) -> Formula:
    """The ellipsoid between two lines of curvature."""
    reach = np.arccos(np.sqrt((gamma - B2) / (A2 - B2)))

    def formula(u: Floats, v: Floats) -> Floats:
        t, p = 2.0 * np.pi * u, reach * (2.0 * v - 1.0)
        level, m = B2 + (A2 - B2) * np.cos(p) ** 2, B2 * np.sin(t) ** 2 + C2 * np.cos(t) ** 2
        x = np.sqrt(A2 * (A2 - m) / (A2 - C2)) * np.sin(p)
        y, z = np.sqrt(B2) * np.cos(t) * np.cos(p), np.sqrt(C2 * (level - C2) / (A2 - C2)) * np.sin(t)
        return np.stack([x, y, z], axis=-1)

    return formula


@cache
def wound(gamma: float, circuits: int) -> PolarPasses:
    surface = mw.shapes.parametric(ellipsoid(gamma), (192, 192))
    return passes_between_caps(surface, circuits, friction=0.1)


@pytest.mark.parametrize(("gamma", "circuits", "turns", "length"), ELLIPSOIDS)
def test_an_ellipsoid_closes_without_slip(gamma: float, circuits: int, turns: int, length: float) -> None:
    layer = wound(gamma, circuits)
    assert layer.pattern is not None and layer.pattern.turns == turns and layer.holds
    assert layer.natural == pytest.approx(turns / circuits, abs=1e-7)
    assert layer.worst < (1e-6 if circuits == 3 else 1e-5)
    assert layer.miss.max() < 1e-9
    assert layer.paths.length.sum() == pytest.approx(length, abs=1e-5)


def test_the_filament_is_continuous_and_joined_without_dwell() -> None:
    layer = wound(*ELLIPSOIDS[0][:2])
    n, points, uv = 3, layer.paths.points, layer.paths.uv
    assert np.abs(points[:n, -1] - points[n:, -1]).max() < 1e-10
    assert np.abs(np.roll(points[:n, 0], -1, axis=0) - points[n:, 0]).max() < 1e-10
    joining = join(passes(uv[:n, 0, 0], uv[:n, -1, 0]), passes(uv[n:, -1, 0], uv[n:, 0, 0]))
    assert joining.turns == 4 and len(joining.filaments) == 1
    assert max(joining.end_dwell.max(), joining.start_dwell.max()) < 1e-9


def test_points_keep_joachimsthal_s_constant() -> None:
    """(x^T A^2 x)(t^T A t) = gamma / (a b c)^2 all along; by chords it is off by the square of their length."""
    gamma = ELLIPSOIDS[0][0]
    squares = np.array([A2, B2, C2])
    surface = wound(gamma, 3).paths.surface
    off = []
    for particles in (201, 401):
        points = passes_between_caps(surface, 3, turns=4, particles=particles).paths.points
        middle, chord = points[:, 1:-1], points[:, 2:] - points[:, :-2]
        tangent = chord / np.linalg.norm(chord, axis=-1, keepdims=True)
        constant = (middle**2 / squares**2).sum(axis=-1) * (tangent**2 / squares).sum(axis=-1)
        off.append(np.abs(constant * squares.prod() / gamma - 1.0).max())
    assert off[1] < 2e-4 and off[0] / off[1] == pytest.approx(4.0, rel=0.1)


@pytest.mark.parametrize(("gamma", "circuits", "turns", "length"), ELLIPSOIDS)
def test_an_ellipsoid_from_a_mesh(gamma: float, circuits: int, turns: int, length: float) -> None:
    surface = mw.fit(flatten(annulus(ellipsoid(gamma), 8000, 0.6)))
    layer = passes_between_caps(surface, circuits, turns=turns, friction=0.1)
    assert layer.holds and layer.worst < 1e-3
    assert layer.paths.length.sum() == pytest.approx(length, rel=1e-5)


def test_a_capsule_from_a_mesh() -> None:
    """A circuit of geodesics turns by 468.112134 degrees; 100 of them close with a small slip."""
    shape = sum(length for length, _ in CAPSULE.pieces) / (2.0 * np.pi * RADIUS)
    surface = mw.fit(flatten(annulus(CAPSULE.formula, 8000, shape)))
    assert natural_turns(surface) == pytest.approx(1.0 + 108.112134 / 360.0, rel=1e-4)
    near = passes_between_caps(surface, 10, turns=13, friction=0.1, particles=201)
    assert near.holds and near.worst < 1e-3
    assert near.paths.length.sum() / 10 == pytest.approx(1257.289433, rel=1e-4)
    layer = passes_between_caps(surface, 100, friction=0.1, particles=101)
    assert layer.pattern is not None and layer.pattern.turns in (129, 131) and layer.holds
    assert 1e-3 < layer.worst < 0.02


def test_a_vessel_with_elliptic_caps_from_a_mesh() -> None:
    """Radius 152.74, cylinder 500 long, caps 98.4436 deep and opened to 37.21: geodesics by Clairaut's integral."""
    radius, length, depth, hole = 152.74, 500.0, 98.4436, 37.21
    last = np.arccos(hole / radius)

    def turned(x: float) -> float:  # t = last - x^2 is where r = R cos t, so that the integrand stays finite
        t = last - x * x
        r = radius * np.cos(t)
        way = np.hypot(radius * np.sin(t), depth * np.cos(t)) * 2.0 * x
        return float(hole * way / (r * np.sqrt((r - hole) * (r + hole))))

    cap = quad(turned, 1e-9, np.sqrt(last), limit=200)[0]
    tilt = np.arcsin(hole / radius)
    circuit = (4.0 * cap + 2.0 * length * np.tan(tilt) / radius) / (2.0 * np.pi)
    assert 360.0 * circuit == pytest.approx(425.96773, abs=1e-5)
    vessel = Vessel((
        arc((0.0, 0.0), (radius, depth), -last, 0.0), line((radius, 0.0), (radius, length)),
        arc((0.0, length), (radius, depth), 0.0, last),
    ))  # fmt: skip
    shape = sum(each for each, _ in vessel.pieces) / (2.0 * np.pi * radius)
    surface = mw.fit(flatten(annulus(vessel.formula, 16_000, shape)))
    assert natural_turns(surface) == pytest.approx(circuit, rel=1e-5)
    layer = passes_between_caps(surface, 233, turns=277, friction=0.1, particles=51)
    assert layer.pattern is not None and 1e-3 < layer.worst < 0.0072
    assert layer.holds  # where curvature leaps, the fit overshoots by less than it is certain
    found = layer.pattern.shift, layer.pattern.number, layer.pattern.leading, layer.pattern.filaments
    assert found == (44, 90, False, 1)
    assert layer.paths.length.sum() / 233 == pytest.approx(1820.796, rel=1e-3)


def test_slip_beyond_the_friction_is_said() -> None:
    ball = mw.shapes.sphere_band(80.0, 0.25, np.pi - 0.25, spans=(96, 48))
    layer = passes_between_caps(ball, 5, turns=6, friction=0.01, particles=51)
    assert not layer.holds and layer.worst > 0.01
    assert set(layer.paths.status.tolist()) <= {int(Status.SLID_OFF_START), int(Status.SLID_OFF_END)}
    assert "do not hold" in layer.words and "1.000000" in layer.words


def test_the_slip_is_that_of_the_points() -> None:
    """kg / kn from second differences of the points, to the left on the fibre's own way, on both half-legs."""
    ball = mw.shapes.sphere_band(1.0, 0.4, np.pi - 0.3, spans=(128, 64))
    layer = passes_between_caps(ball, 5, turns=6, particles=401)
    points, normal = layer.paths.points, layer.paths.normal[:, 1:-1]
    way = (points[:, 2:] - points[:, :-2]) * layer.paths.family[:, None, None]
    bend = points[:, 2:] - 2.0 * points[:, 1:-1] + points[:, :-2]
    left = np.cross(normal, way / np.linalg.norm(way, axis=-1, keepdims=True))
    found = -(bend * left).sum(axis=-1) / (bend * normal).sum(axis=-1)
    for leg, at in ((0, slice(10, 150)), (1, slice(250, 390))):
        assert np.abs(found[:, at] - layer.slip[:, leg, None]).max() < 1e-3 * layer.worst + 1e-4
    assert layer.worst > 0.01 and np.nanmax(layer.paths.slip) == layer.worst


def test_a_clearance_is_kept() -> None:
    """On a sphere a geodesic that passes an opening at a distance is a great circle that far from its pole."""
    ball = mw.shapes.sphere_band(1.0, 0.3, np.pi - 0.3, spans=(128, 64))
    layer = passes_between_caps(ball, 7, turns=8, clearance=(0.1, 0.1), particles=201)
    z = layer.paths.points[:, :, 2]
    assert np.abs(z[:, 0] + np.cos(0.4)).max() < 1e-6 and z.min() > -np.cos(0.4) - 1e-6


def test_over_one_cap_and_back_to_a_rim() -> None:
    """Half great circles: from the equator to the opening a quarter of a turn, and another one back."""
    for cap, polar in (("end", (0.5 * np.pi, np.pi - 0.4)), ("start", (0.4, 0.5 * np.pi))):
        bowl = mw.shapes.sphere_band(1.0, *polar, spans=(128, 64))
        layer = passes_over_a_cap(bowl, 6, cap=cap, particles=101)  # type: ignore[arg-type]
        assert layer.holds
        assert layer.paths.length == pytest.approx(np.full(12, 0.5 * np.pi), abs=1e-6)
        turn = layer.paths.uv[:, -1, 0] - layer.paths.uv[:, 0, 0]
        assert turn == pytest.approx(np.repeat([0.25, -0.25], 6), abs=1e-6)
        at = -1 if cap == "end" else 0
        assert np.abs(layer.paths.points[:6, at] - layer.paths.points[6:, at]).max() < 1e-12


def test_what_is_no_cap_is_refused() -> None:
    with pytest.raises(BadInputError, match="that end is no dome"):
        passes_between_caps(mw.shapes.hyperboloid(1.0, 1.0, 1.0), 5)
    ball = mw.shapes.sphere_band(1.0, 0.5, 2.5)
    with pytest.raises(BadInputError, match="coprime"):
        passes_between_caps(ball, 4, turns=6)
    with pytest.raises(BadInputError, match="does not reach the rim"):
        passes_over_a_cap(mw.shapes.sphere_band(1.0, 0.3, 2.0), 5, cap="end")


def test_the_annulus_knows_its_caps() -> None:
    assert mw.annulus(mw.read("data/tank.ply")).caps == (True, True)
    assert mw.annulus(mw.read("data/elbow.obj")).caps == (False, False)


def test_passes_do_not_lie_over_a_waist() -> None:
    def dumbbell(u: Floats, v: Floats) -> Floats:
        t = 0.4 + (np.pi - 0.8) * v
        r = 100.0 * np.sin(t) * (1.0 - 0.3 * np.exp(-(((t - 0.5 * np.pi) / 0.3) ** 2)))
        return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), -200.0 * np.cos(t)], axis=-1)

    layer = passes_between_caps(interpolate(dumbbell, (48, 64)), 5, friction=0.5, particles=101)
    assert not layer.holds
    assert (layer.paths.status == Status.STALLED).all()


def test_half_legs_meet_after_one_march_each(monkeypatch: pytest.MonkeyPatch) -> None:
    """800 half-legs for 200 circuits and the table's; those that were moved or run on are what a march gives."""
    asked: list[int] = []
    march = End.march

    def counted(end: End, u: Floats, slip: Floats, leaving: bool, tolerance: float = FINEST) -> Legs:
        asked.append(len(u))
        return march(end, u, slip, leaving, tolerance)

    monkeypatch.setattr(End, "march", counted)
    surface = mw.fit(flatten(annulus(ellipsoid(ELLIPSOIDS[0][0]), 8000, 0.6)))
    layer = passes_between_caps(surface, 200, friction=0.1, particles=11)
    assert sum(asked) < 800 + 4 * (128 + 2 * 32) + 160
    assert layer.holds and layer.miss.max() < 1e-10
    uv, slip = layer.paths.uv, layer.slip
    # passes back are kept from the start rim to the end rim: their last point is where they begin
    ends = [End(half, opening(surface, k)) for k, half in enumerate(halves(surface))]
    for first, rows in ((0, slice(0, 200)), (1, slice(200, 400))):
        legs = [ends[k].march(uv[rows, -k, 0], slip[rows, k], k == first, 1e-14) for k in (first, 1 - first)]
        turned = legs[0].u - legs[1].u
        assert np.abs(turned - np.round(turned)).max() < 2e-10
        assert np.abs(legs[0].angle - legs[1].angle).max() < 2e-10
