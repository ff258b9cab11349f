"""Ribs, ridges and hollows between particles: right within the error that is stated, or told to be too coarse."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from meshwind.core.cast import Floats
from meshwind.path import Paths, Status, solve
from meshwind.surface import Surface, shapes
from meshwind.surface.tree import nearest_foot

LENGTH, RADIUS = 300.0, 50.0
COUNTS = (51, 101, 201, 801, None)


def revolved(profile: Callable[[Floats], Floats], spans: int = 1024) -> Surface:
    return shapes.revolution(profile, 0.0, LENGTH, (16, spans))


def bumps(at: Floats, width: Floats, height: Floats) -> Callable[[Floats], Floats]:
    """A cylinder's radius with bumps of these widths at half their heights."""

    def radius(z: Floats) -> Floats:
        narrow = width / np.sqrt(4.0 * np.log(2.0))
        steps = [h * np.exp(-(((z - a) / w) ** 2)) for a, w, h in zip(at, narrow, height, strict=True)]
        return np.asarray(RADIUS + np.sum(steps, axis=0))

    return radius


def hull(surface: Surface) -> tuple[float, float]:
    """Length of a taut meridian, the upper hull of its profile, and its largest height over the profile."""
    v = np.linspace(0.0, 1.0, 200001)
    points = surface.points(np.stack([np.full_like(v, 0.1), v], axis=1))
    z, r = points[:, 2], np.hypot(points[:, 0], points[:, 1])
    ends = [[z[0], -1e4], [z[-1], -1e4]]
    corners = np.sort(ConvexHull(np.concatenate([np.stack([z, r], axis=1), ends])).vertices)
    corners = corners[corners < len(z)]
    height = np.interp(z, z[corners], r[corners]) - r
    return float(np.hypot(np.diff(z[corners]), np.diff(r[corners])).sum()), float(height.max())


def meridian(surface: Surface, particles: int | None) -> Paths:
    return solve(surface, [(0.1, 0.0)], [(0.1, 1.0)], particles=particles)


def check(surface: Surface, particles: int | None) -> None:
    """Right to what it states, or too coarse, or not at rest: never converged and wrong."""
    paths = meridian(surface, particles)
    if paths.status[0] != Status.CONVERGED:
        return
    length, height = hull(surface)
    assert abs(paths.length[0] - length) <= paths.length_error[0] + 1e-7 * length
    assert paths.gap.max() <= height + paths.position_error[0] + 1e-5 * LENGTH  # the gap is no larger than the height


@pytest.mark.parametrize(("width", "height"), [(0.6, 3.0), (1.0, 8.0), (2.0, 1.5)])
def test_a_rib_between_particles_is_met(width: float, height: float) -> None:
    surface = revolved(bumps(np.array([77.1]), np.array([width]), np.array([height])))
    length, deep = hull(surface)
    for particles in COUNTS:
        paths = meridian(surface, particles)
        assert paths.status[0] == Status.CONVERGED
        assert abs(paths.length[0] - length) <= paths.length_error[0] + 1e-7 * length
        assert paths.length_error[0] <= 1e-5 * length
        assert paths.gap.max() == pytest.approx(deep, rel=0.1)


def test_a_thin_rib_between_the_feet_of_a_segment_is_met() -> None:
    """The nearest feet of both of its ends lie on the rib, one on either flank, few spans apart."""
    surface = revolved(bumps(np.array([95.593, 177.027]), np.array([0.314, 2.591]), np.array([5.94, 9.161])), 4096)
    for particles in COUNTS[:3]:
        assert meridian(surface, particles).on_surface.sum() >= 4
        check(surface, particles)


@pytest.mark.parametrize(("waves", "height"), [(60, 0.2), (25, 1.0)])
def test_contacts_shorter_than_a_spacing(waves: int, height: float) -> None:
    def profile(z: Floats) -> Floats:
        return np.asarray(
            100.0 - 40.0 * (2.0 * z / LENGTH - 1.0) ** 2 + height * np.cos(2 * np.pi * waves * z / LENGTH)
        )

    surface = revolved(profile)
    for particles in COUNTS[1:]:
        check(surface, particles)
        assert meridian(surface, particles).status[0] == Status.CONVERGED


def test_a_groove_between_particles_is_within_the_stated_error() -> None:
    surface = revolved(bumps(np.array([148.6]), np.array([1.2]), np.array([-4.0])))
    paths = meridian(surface, 101)
    _, deep = hull(surface)
    assert paths.gap.max() < 0.5 * deep  # no particle is over its middle
    assert paths.gap.max() + paths.position_error[0] >= 0.6 * min(deep, 0.6)  # half its width away from its walls


def test_a_bridge_over_a_shallow_groove_is_as_long_as_it_states() -> None:
    """At its edge the curvature changes within a spacing, so that no step leads to where the bridge lands."""
    groove = bumps(np.array([110.609, 265.56]), np.array([1.95, 1.235]), np.array([-0.183, 3.624]))
    surface = revolved(lambda z: groove(z) + 5.758 * np.sin(np.pi * z / LENGTH), 1457)
    for particles in (97, 193, 385, None):
        check(surface, particles)


def test_a_low_rib_that_the_end_of_a_bridge_passes_through_is_in_the_stated_error() -> None:
    """It stands between the last particle in the air and the first that touches, lower than what wants a particle."""
    at, width = [18.902468, 104.017018, 113.805672], [0.316508, 0.585361, 1.841977]
    surface = revolved(bumps(np.array(at), np.array(width), np.array([-6.850251, 0.110686, -6.084607])), 4096)
    check(surface, 51)
    assert meridian(surface, 51).length_error[0] < 1e-4 * LENGTH


def test_a_low_rib_ahead_of_where_a_bridge_leaves_too_late_is_in_the_stated_error() -> None:
    """The fibre leaves the body before the particle: what stands out behind that is not the arc it lands on."""
    at, width = [192.60528612, 20.5926557, 246.42028667], [0.94651481, 0.76710333, 1.97800364]
    ribs = bumps(np.array(at), np.array(width), np.array([0.07535749, 1.40644149, 2.49528211]))
    surface = revolved(lambda z: ribs(z) + 14.583766740586679 * np.sin(np.pi * z / LENGTH), 2346)
    check(surface, 51)
    assert meridian(surface, 51).length_error[0] < 2e-5 * LENGTH


@pytest.mark.parametrize(("at", "width", "depth", "bulge"), [
    ((204.2071047, 205.8788391, 208.1354425), (2.622439, 0.965718, 1.35558), (0.1783152, 0.554968, 0.0707793), 18.6),
    ((196.1610451, 198.1087861, 201.1411364), (1.13974, 0.710658, 1.122648), (0.0545946, 0.0536874, 0.0601672), 20.9),
])  # fmt: skip
def test_three_hollows_within_a_spacing_are_in_the_stated_errors(
    at: tuple[float, ...], width: tuple[float, ...], depth: tuple[float, ...], bulge: float
) -> None:
    hollows = bumps(np.array(at), np.array(width), -np.array(depth))
    surface = revolved(lambda z: hollows(z) + bulge * (1.0 - (2.0 * z / LENGTH - 1.0) ** 2), 2033)
    check(surface, 51)
    paths, (_, height) = meridian(surface, 51), hull(surface)
    assert 0.9 * height <= paths.gap.max() + paths.position_error[0]  # as much of it as is the distance from the walls


def test_a_bridge_that_lands_where_the_surface_bends_otherwise_is_in_the_stated_error() -> None:
    """Its last particle lies in a shallow hollow next to the edge that the fibre goes over."""
    at, width = [83.74440854, 87.88979307, 91.43531052], [3.2028006, 2.9744933, 0.6671162]
    hollows = bumps(np.array(at), np.array(width), np.array([-2.9667266, -0.0821388, -0.0998739]))
    surface = revolved(lambda z: hollows(z) + 10.0 + 21.56973 * (1.0 - (2.0 * z / LENGTH - 1.0) ** 2), 3539)
    check(surface, 201)
    assert meridian(surface, 201).length_error[0] < 1e-6 * LENGTH


def test_the_top_of_a_rib_between_samples_is_in_the_stated_error() -> None:
    surface = revolved(bumps(np.array([77.1]), np.array([0.25]), np.array([3.0])), 2048)
    v = np.linspace(0.0, 1.0, 200001)
    x, y, z = surface.points(np.stack([np.full_like(v, 0.1), v], axis=1)).T
    for particles in (26, 27, 31):
        paths = meridian(surface, particles)
        along = paths.points[0, :, 2]
        fibre = np.interp(z, along, np.hypot(paths.points[0, :, 0], paths.points[0, :, 1]))
        assert (np.hypot(x, y) - fibre).max() <= paths.position_error[0] + 1e-5 * LENGTH


def test_the_foot_behind_a_rib_is_the_nearest_where_spans_are_long_across() -> None:
    """Spans are 20 mm round and 0.07 mm along: the first piece that may be nearer leads back to the foot found."""
    at, width = [164.44678205, 90.21942658, 38.84729737], [1.88818817, 0.37034881, 0.55195644]
    surface = revolved(bumps(np.array(at), np.array(width), np.array([2.35661269, -1.7342726, 0.05121439])), 4096)
    point, uv = np.array([42.32044161, 30.74712561, 161.45682635]), np.array([0.09999904, 0.54492055])
    at_foot = np.empty((6, 3))
    nearest_foot(surface.centred.body, point - surface.middle, uv, at_foot)
    v = np.linspace(0.5, 0.6, 20001)
    near = np.linalg.norm(surface.points(np.stack([np.full_like(v, 0.1), v], axis=1)) - point, axis=1).min()
    assert np.linalg.norm(at_foot[0] + surface.middle - point) <= near + 1e-6


def test_particles_that_coincide_are_measured() -> None:
    surface = revolved(bumps(np.array([77.1]), np.array([2.0]), np.array([1.5])))
    paths = meridian(surface, 51)
    points, uv = paths.points.copy(), paths.uv.copy()
    points[0, 30], uv[0, 30] = points[0, 31], uv[0, 31]
    again = replace(paths, points=points, uv=uv)
    assert np.isfinite(again.length[0])
    assert np.isfinite(again.position_error[0])


@settings(max_examples=12, deadline=None, derandomize=True, database=None)
@given(
    st.lists(st.tuples(st.floats(15.0, 285.0), st.floats(-0.2, 1.2), st.floats(-1.3, 0.7)), min_size=1, max_size=5),
    st.sampled_from([51, 101, 201]),
)
def test_never_converged_and_wrong(ribs: list[tuple[float, float, float]], particles: int) -> None:
    at, width, share = np.array(ribs).T
    width = 10.0**width
    check(revolved(bumps(at, width, np.minimum(width * 10.0**share, 10.0))), particles)
