"""Moving ends: the source's valley with a small and a large peak, and what dragging must leave alone."""

import numpy as np
import pytest

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.path import Status, drag, solve
from meshwind.surface import Surface, shapes
from meshwind.surface.interpolate import interpolate

FRAMES = 23
WAY = np.linspace(0.25, 0.8, FRAMES)
START, END = np.stack([0 * WAY, WAY], axis=1), np.stack([0 * WAY + 1, WAY], axis=1)


def valley(peak: float) -> Surface:
    """z = x^2 / 2 with sides 2 high, and a peak of the given height in the middle."""

    def formula(u: Floats, v: Floats) -> Floats:
        x, y = 4 * (u - 0.5), 6 * (v - 0.5)
        return np.stack([x, y, 0.5 * x**2 + peak * np.exp(-(x**2 + y**2) / 0.25)], axis=-1)

    return interpolate(formula, (96, 96), periodic=False)


def middles(points: Floats) -> Floats:
    """y of each frame where it crosses the middle of the valley."""
    return np.asarray(points[np.arange(len(points)), np.abs(points[:, :, 0]).argmin(axis=1), 1])


@pytest.mark.parametrize("friction", [0.0, 0.2])
@pytest.mark.parametrize(("peak", "bridging", "caught"), [(1.2, False, True), (1.2, True, False), (3.5, False, True),
                                                          (3.5, True, True)])  # fmt: skip
def test_off_the_surface_a_fibre_jumps_the_small_peak_only(
    peak: float, bridging: bool, caught: bool, friction: float
) -> None:
    paths = drag(valley(peak), START, END, bridging=bridging, friction=friction, particles=101)
    assert (paths.status == Status.CONVERGED).all()
    y = middles(paths.points)
    assert len(y) == FRAMES
    assert y[0] == pytest.approx(-1.5, abs=0.02)
    # the ends have come to y = 1.8; a fibre that is caught stays before the peak at y = 0
    assert y[-1] < -0.2 if caught else y[-1] == pytest.approx(1.8, abs=1e-3)
    assert np.all(np.diff(y) > -1e-6)
    assert np.all(paths.gap >= 0.0)
    if not bridging:
        assert paths.on_surface.all()


def test_frames_without_friction_are_the_paths_between_their_ends() -> None:
    surface = shapes.sphere_band(2.0, 0.25 * np.pi, 0.75 * np.pi, (128, 64))
    turn = np.linspace(0.0, 0.2, 9)
    start, end = np.stack([0 * turn, 0 * turn], axis=1), np.stack([turn, 0 * turn + 1], axis=1)
    dragged, laid = drag(surface, start, end, particles=101), solve(surface, start, end, particles=101)
    np.testing.assert_allclose(dragged.points, laid.points, atol=1e-8)


def test_with_friction_a_fibre_remembers_its_way() -> None:
    """Dragged out and back along a cylinder, friction keeps it behind its ends on both ways."""
    surface = shapes.cylinder(1.0, 4.0)
    way = np.concatenate([np.linspace(0.3, 0.6, 13), np.linspace(0.6, 0.3, 13)[1:]])
    start, end = np.stack([0 * way, way], axis=1), np.stack([0 * way + 0.6, way], axis=1)
    paths = drag(surface, start, end, friction=0.2, particles=101)
    assert (paths.status == Status.CONVERGED).all()
    middle = paths.uv[:, 50, 1]
    assert middle[12] < 0.6 - 1e-2
    assert middle[-1] > 0.3 + 1e-2
    assert np.nanmax(paths.slip) <= 0.2 * (1 + 1e-3)
    smooth = drag(surface, start, end, particles=101)
    np.testing.assert_allclose(smooth.uv[-1], smooth.uv[0], atol=1e-8)


def test_bad_ends_are_refused() -> None:
    with pytest.raises(BadInputError, match="give one of each a frame"):
        drag(shapes.cylinder(1.0, 4.0), START, END[:3])
