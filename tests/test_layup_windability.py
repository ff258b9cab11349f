"""Which directions press, against the normal curvature in every direction and against closed forms."""

import numpy as np
import pytest
from scipy.integrate import quad

from meshwind.layup.windability import CONCAVE, CONVEX, SADDLE, of_frames, windability
from meshwind.surface import Surface, shapes


def test_reach_is_where_the_normal_curvature_presses() -> None:
    """At random frames of every kind, directions inside the reach press and those outside do not."""
    rng = np.random.default_rng(3)
    frames = rng.normal(size=(300, 6, 3))
    press = of_frames(frames, 0.0)
    turn = (np.arange(180) + 0.5) / 180 * np.pi
    tangent = _turned(press.direction, press.normal, turn)
    pressing = _normal_curvature(frames, tangent) >= 0.0
    off = np.minimum(turn, np.pi - turn)
    expected = off <= press.reach[:, None]
    expected[press.kind == CONCAVE] = False
    clear = np.abs(off - press.reach[:, None]) > 1e-9
    assert np.array_equal(pressing[clear], expected[clear])
    assert {CONVEX, SADDLE, CONCAVE} == set(press.kind.tolist())
    assert pressing[press.kind == CONVEX].all() and not pressing[press.kind == CONCAVE].any()


def _turned(direction: np.ndarray, normal: np.ndarray, turn: np.ndarray) -> np.ndarray:
    side = np.cross(normal, direction)
    return np.asarray(np.cos(turn)[:, None] * direction[:, None] + np.sin(turn)[:, None] * side[:, None])


def _normal_curvature(frames: np.ndarray, tangent: np.ndarray) -> np.ndarray:
    """Of tangents (k, t, 3) at frames (k, 6, 3), positive where pressing."""
    su, sv = frames[:, 1], frames[:, 2]
    basis = np.stack([su, sv], axis=2)
    part = np.einsum("kij,ktj->kti", np.linalg.pinv(basis), tangent)
    normal = np.cross(su, sv)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    l, m, n = (-(frames[:, k] * normal).sum(axis=1)[:, None] for k in (3, 4, 5))
    return np.asarray(l * part[..., 0] ** 2 + 2.0 * m * part[..., 0] * part[..., 1] + n * part[..., 1] ** 2)


def test_hyperboloid_presses_between_its_rulings() -> None:
    surface = shapes.hyperboloid(1.0, 1.0, 1.5, (128, 256))
    v = np.linspace(0.1, 0.9, 9)
    press = windability(surface, np.stack([np.full_like(v, 0.3), v], axis=1))
    z = -1.5 + 3.0 * v
    # a ruling has r' = z / r along it and rises by 1 while it turns by 1 / (1 + z^2) r
    slant = np.sqrt(1.0 + (z / np.sqrt(1.0 + z * z)) ** 2)
    ruling = np.arctan2(np.sqrt(1.0 + z * z) / (1.0 + z * z), slant)  # from the meridian
    assert (press.kind == SADDLE).all()
    assert np.abs(press.angle) == pytest.approx(np.full(9, 0.5 * np.pi), abs=1e-6)  # pressing hardest as a hoop
    assert 0.5 * np.pi - press.reach == pytest.approx(ruling, abs=1e-3)
    assert press.presses(ruling + 0.01).all() and press.presses(-ruling - 0.01).all()
    assert not press.presses(ruling - 0.01).any()


def test_direction_and_angle_agree() -> None:
    surface = shapes.elbow(3.0, 1.0, spans=(48, 32))
    uv = np.random.default_rng(1).uniform(size=(200, 2))
    press = windability(surface, uv)
    sv, normal = surface.frames(uv)[:, 2], surface.normals(uv)
    along = sv / np.linalg.norm(sv, axis=1, keepdims=True)
    again = np.cos(press.angle)[:, None] * along + np.sin(press.angle)[:, None] * np.cross(along, normal)
    assert np.abs((again * press.direction).sum(axis=1)) == pytest.approx(np.ones(200), abs=1e-9)
    assert np.abs((press.direction * normal).sum(axis=1)).max() < 1e-9


def test_shares_of_a_torus_are_those_of_its_outside_and_inside() -> None:
    """A torus' elbow is convex outside (area pi r b (R + 2 r / pi)), a saddle inside; nothing is concave."""
    press = windability(shapes.elbow(3.0, 1.0, np.pi / 2, (96, 32)))
    assert press.weight.sum() == pytest.approx(1.0)
    assert press.area(CONVEX) == pytest.approx(0.5 + 1.0 / (3.0 * np.pi), abs=0.01)
    assert press.untouchable == 0.0


def test_share_that_no_fibre_touches_is_that_of_a_dish() -> None:
    """A sphere band turned inside out is concave all over; a barrel with a dished end, where the dish is."""
    band = shapes.sphere_band(2.0, 0.8, 2.2, (48, 32))
    flipped = Surface(band.control_points[::-1])
    assert windability(flipped).untouchable == pytest.approx(1.0)
    assert windability(flipped).share.max() == 0.0
    assert windability(band).untouchable == 0.0
    assert windability(band).share.min() == 1.0


def test_half_a_wavy_bowl_is_concave() -> None:
    """A bowl's rim turns over: r = 1 + 0.4 sin(2 pi z), seen from within the bowl."""

    def radius(z: np.ndarray) -> np.ndarray:
        return np.asarray(1.0 + 0.1 * np.sin(2.0 * np.pi * z))

    inside = Surface(shapes.revolution(radius, 0.0, 1.0, (48, 96)).control_points[::-1])
    press = windability(inside)
    # inside out the hoop never presses; the meridian does where r'' > 0, that is on the far half

    def area(z0: float, z1: float) -> float:
        def rate(z: float) -> float:
            slope = 0.2 * np.pi * np.cos(2.0 * np.pi * z)
            return float((1.0 + 0.1 * np.sin(2.0 * np.pi * z)) * np.hypot(1.0, slope))

        return float(quad(rate, z0, z1)[0])

    assert press.untouchable == pytest.approx(area(0.0, 0.5) / area(0.0, 1.0), abs=0.015)
    assert press.area(SADDLE) == pytest.approx(1.0 - press.untouchable)
