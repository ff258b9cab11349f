"""Crossings on a cylinder, where straight lines in (u, v) are geodesics and every answer is known."""

from time import perf_counter

import numpy as np
import pytest
from layup_shapes import HEIGHT, bridged, cylinder, drawn, helices, straight_uv, wound

from meshwind.core.cast import Floats
from meshwind.layup.crossings import cell_sides, counts, crossings, own_crossings
from meshwind.path.paths import Paths
from meshwind.surface import shapes

CYLINDER = cylinder()
CASES = [  # paths per family, revolutions, particles
    (8, 1.0, 101),  # crossings fall on particles
    (16, 1.0, 100),
    (12, 2.5, 401),  # several turns
    (8, 0.97, 101),  # 2 R N is no whole number
    (5, 3.03, 77),
    (12, 0.5, 2),  # one segment a path
    (1, 3.0, 51),
]


def expected_uv(count: int, revolutions: float) -> Floats:
    """Path i of +1 and j of -1 meet where 2 R v = (j - i) / N modulo 1; sorted by v, then u."""
    steps = np.arange(1, int(np.ceil(2 * revolutions * count - 1e-9)))
    v = steps / (2 * revolutions * count)
    u = np.arange(count)[:, None] / count + revolutions * v
    uv = np.stack([np.mod(u, 1.0), np.broadcast_to(v, u.shape)], axis=2).reshape(-1, 2)
    return np.asarray(uv)


def matched(found: Floats, wanted: Floats) -> float:
    """Largest distance from a wanted point to the nearest found one, u modulo 1."""
    offset = found[:, None] - wanted[None]
    offset[..., 0] -= np.round(offset[..., 0])
    return float(np.abs(offset).max(axis=2).min(axis=0).max())


@pytest.mark.parametrize(("count", "revolutions", "particles"), CASES)
def test_count_position_and_angle(count: int, revolutions: float, particles: int) -> None:
    found = crossings(helices(count, revolutions, particles, CYLINDER))
    wanted = expected_uv(count, revolutions)
    assert len(found) == len(wanted)
    assert matched(found.uv, wanted) < 1e-12
    exact = np.column_stack(
        [np.cos(2 * np.pi * found.uv[:, 0]), np.sin(2 * np.pi * found.uv[:, 0]), HEIGHT * found.uv[:, 1]]
    )
    assert np.abs(found.points - exact).max() < 1e-9
    between = 2.0 * np.arctan2(2.0 * np.pi * revolutions, HEIGHT)
    assert np.abs(found.angle - min(between, np.pi - between)).max() < 1e-8
    assert found.on_surface.all()


def test_positions_along_the_paths_lead_back_to_the_crossing() -> None:
    paths = helices(7, 1.3, 61, CYLINDER)
    found = crossings(paths)
    for path, t in ((found.path_a, found.t_a), (found.path_b, found.t_b)):
        k = np.minimum(t.astype(int), 59)
        uv = paths.uv[path, k] + (t - k)[:, None] * (paths.uv[path, k + 1] - paths.uv[path, k])
        off = uv - found.uv
        assert np.abs(off[:, 0] - np.round(off[:, 0])).max() < 1e-12
        assert np.abs(off[:, 1]).max() < 1e-12
    assert (paths.family[found.path_a] == 1).all()
    assert (paths.family[found.path_b] == -1).all()
    assert (found.sense == 1).all()


def test_zero_revolutions_never_cross() -> None:
    assert len(crossings(helices(8, 0.0, 31, CYLINDER))) == 0
    solved = wound(shapes.cylinder(1.0, 3.0, (64, 8)), 12, 0.0, 201)  # families on each other but for round-off
    assert np.array_equal(np.sort(solved.family), np.repeat([-1, 1], 12))
    assert len(crossings(solved)) == 0 and len(own_crossings(solved)) == 0


@pytest.mark.parametrize("offset", [0.0, 1e-13, 0.5, 0.123])
def test_where_the_seam_lies_changes_nothing(offset: float) -> None:
    uv, family = straight_uv(6, 1.5, 41, offset)
    turned = crossings(drawn(CYLINDER, uv + np.array([3.0, 0.0]), family))
    assert len(turned) == 6 * 17
    assert matched(turned.uv - [offset, 0.0], expected_uv(6, 1.5)) < 1e-12


def test_only_paths_that_are_asked_for_take_part() -> None:
    paths = helices(8, 1.0, 101, CYLINDER)
    whole = crossings(paths)
    among = np.ones(16, dtype=bool)
    among[[3, 12]] = False
    part = crossings(paths, among)
    assert len(part) == (np.isin(whole.path_a, [3, 12]) | np.isin(whole.path_b, [3, 12])).__invert__().sum()
    assert not np.isin(part.path_a, [3, 12]).any()


def test_bridges_cross_off_the_surface_between_their_fibres() -> None:
    paths = bridged()
    found = crossings(paths)
    lifted = (found.uv[:, 1] > 0.31) & (found.uv[:, 1] < 0.69)
    assert lifted.any()
    assert not found.on_surface[lifted].any()
    assert found.on_surface[~lifted].all()
    radius = np.linalg.norm(found.points[:, :2], axis=1)
    body = np.linalg.norm(paths.surface.points(found.uv)[:, :2], axis=1)
    assert (radius[lifted] > body[lifted] + 1e-3).all()
    assert np.abs(radius[~lifted] - body[~lifted]).max() < 1e-12


def test_a_pair_that_crosses_back_counts_each_time() -> None:
    v = np.linspace(0.0, 1.0, 301)
    wave = 0.1 * np.sin(3.0 * np.pi * v)  # crosses u = 0 at v = 1/3 and 2/3
    uv = np.stack([np.column_stack([wave, v]), np.column_stack([0.0 * v, v])])
    found = crossings(drawn(CYLINDER, uv, np.array([1.0, -1.0])))
    assert np.allclose(found.uv[:, 1], [1 / 3, 2 / 3], atol=1e-4)
    assert found.sense.tolist() == [-1, 1]


def test_long_steps_of_a_foot_are_followed_around() -> None:
    """A step of more than half a turn is compared with every turn that it passes."""
    uv = np.array([[[0.0, 0.0], [2.2, 1.0]], [[0.5, 0.0], [0.5, 1.0]]])
    found = crossings(drawn(CYLINDER, uv, np.array([1.0, -1.0])))
    assert np.allclose(found.uv, [[0.5, 0.5 / 2.2], [0.5, 1.5 / 2.2]], atol=1e-12)


def test_results_are_read_only() -> None:
    found = crossings(helices(4, 1.0, 21, CYLINDER))
    with pytest.raises(ValueError, match="read-only"):
        found.uv[0, 0] = 1.0


def test_order_of_the_paths_does_not_matter() -> None:
    paths = helices(6, 1.2, 41, CYLINDER)
    order = np.random.default_rng(1).permutation(12)
    shuffled = drawn(CYLINDER, np.asarray(paths.uv[order]), paths.family[order])
    assert matched(crossings(shuffled).uv, crossings(paths).uv) < 1e-12
    assert len(crossings(shuffled)) == len(crossings(paths))


def cone_geodesics(count: int, twist: float, particles: int) -> tuple[Paths, float, float]:
    """Both families of geodesics on the cone r = 1 - z / 6, z in [0, 3], which unrolls to a sector: straight there.

    Returns the drawn paths, the sine of the cone's half angle and the geodesic's distance from the apex.
    """
    surface = shapes.cone(1.0, 0.5, 3.0, (512, 8))
    slant = np.hypot(3.0, 0.5)
    sine = 0.5 / slant
    far, near = 1.0 / sine, 0.5 / sine
    ends = far * np.array([1.0, 0.0]), near * np.array([np.cos(twist * sine), np.sin(twist * sine)])
    t = np.linspace(0.0, 1.0, particles)[:, None]
    line = (1.0 - t) * ends[0] + t * ends[1]
    u = np.arctan2(line[:, 1], line[:, 0]) / sine / (2.0 * np.pi)
    v = (far - np.linalg.norm(line, axis=1)) / slant
    start = np.tile(np.arange(count) / count, 2)[:, None]
    family = np.repeat([1.0, -1.0], count)
    uv = np.stack([start + family[:, None] * u, np.broadcast_to(v, (2 * count, particles))], axis=2)
    along = ends[1] - ends[0]
    square = float(abs(ends[0][0] * along[1] - ends[0][1] * along[0]) / np.linalg.norm(along))
    return drawn(surface, np.ascontiguousarray(uv), family), sine, square


@pytest.mark.parametrize(("count", "twist"), [(8, 2.0), (12, 5.0)])
def test_crossings_on_a_cone(count: int, twist: float) -> None:
    paths, sine, square = cone_geodesics(count, twist, 801)
    found = crossings(paths)
    # path i of +1 meets path j of -1 half way between their starts: at a turn of (j - i) / 2 N from its own
    half = np.mod(found.path_b - count - found.path_a, count) / (2.0 * count)
    turned = half + 0.5 * np.round((np.mod(found.uv[:, 0] - found.path_a / count, 1.0) - half) * 2.0)
    off = found.uv[:, 0] - found.path_a / count - turned
    assert np.abs(off - np.round(2.0 * off) / 2.0).max() < 1e-9
    angle = turned * 2.0 * np.pi * sine  # in the sector, from the start
    far = 1.0 / sine
    lean = np.arcsin(square / far)  # of the line against the radius at its start
    radius = square / np.sin(np.pi - lean - angle)
    assert np.abs(found.uv[:, 1] - (far - radius) / np.hypot(3.0, 0.5)).max() < 1e-9
    exact = np.stack([np.cos(2 * np.pi * found.uv[:, 0]), np.sin(2 * np.pi * found.uv[:, 0])], axis=1)
    assert np.abs(found.points[:, :2] - (radius * sine)[:, None] * exact).max() < 1e-9
    # Clairaut: the angle to the meridian has sine square / radius; the families cross at twice that
    between = 2.0 * np.arcsin(square / radius)
    assert np.abs(found.angle - np.minimum(between, np.pi - between)).max() < 1e-7
    reach = int(np.ceil(2.0 * count * twist / (2.0 * np.pi) - 1e-9)) - 1
    assert len(found) == count * reach


def test_fibres_that_cross_their_own_family_are_noticed() -> None:
    uv, family = straight_uv(8, 1.0, 201)
    assert len(own_crossings(drawn(CYLINDER, uv, family))) == 0
    uv[2, :, 0] += 0.3 * np.sin(np.pi * uv[2, :, 1])  # over its two neighbours and back
    pairs = own_crossings(drawn(CYLINDER, uv, family))
    assert sorted(map(tuple, pairs.tolist())) == [(2, 3), (2, 3), (2, 4), (2, 4)]
    uv, family = straight_uv(8, 1.0, 201)
    turn = np.linspace(0.0, 2.0 * np.pi, 21)
    uv[5, 90:111] = uv[5, 100] + 0.02 * np.column_stack([np.sin(turn), 1.0 - np.cos(turn)]) + [0.0, -0.001]
    looped = own_crossings(drawn(CYLINDER, uv, family))
    assert (looped == 5).all() and len(looped) >= 1
    assert len(own_crossings(drawn(CYLINDER, uv, family), np.arange(16) != 5)) == 0


def test_counts_a_region_add_up() -> None:
    found = crossings(helices(8, 1.0, 101, CYLINDER))
    held = counts(found, 4, 5)
    assert held.shape == (4, 5)
    assert held.sum() == len(found)
    assert (held.sum(axis=1) == len(found) // 4).all()
    assert counts(found, 1, 2).tolist() == [[56, 64]]  # the row half way up counts above


def test_cost_grows_with_crossings_not_with_pairs() -> None:
    """As many crossings of four times the paths: comparing pairs of segments would take 16 times as long."""

    def seconds(count: int) -> float:
        paths = helices(count, 8000.0 / count**2, 201, CYLINDER)
        assert 14000 < len(crossings(paths)) < 17000
        best = np.inf
        for _ in range(3):
            start = perf_counter()
            crossings(paths)
            best = min(best, perf_counter() - start)
        return float(best)

    assert seconds(1600) < 9.0 * seconds(400) + 0.05


@pytest.mark.parametrize(("count", "turns"), [(8, 1.0), (5, 1.3)])
def test_sides_of_the_cells_of_helices(count: int, turns: float) -> None:
    paths = helices(count, turns, 401, CYLINDER)
    sides = cell_sides(paths, crossings(paths))
    # a path crosses the other family every 1 / (2 R N) of its length
    whole = np.hypot(2.0 * np.pi * turns, HEIGHT)
    assert sides.d1 == pytest.approx(np.full(len(sides.d1), whole / (2 * turns * count)), rel=1e-3)
    assert sides.d2 == pytest.approx(np.full(len(sides.d2), whole / (2 * turns * count)), rel=1e-3)
    met = len(crossings(paths))
    assert len(sides.d1) == met - count
