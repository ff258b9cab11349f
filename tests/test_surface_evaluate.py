"""Spline evaluation against SciPy, and the kernels as plain Python against their compiled form."""

import os
import subprocess
import sys

import numpy as np
import pytest
from scipy.interpolate import BSpline

from meshwind.path import solve
from meshwind.surface import Surface, shapes
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.grid import parameter_grid
from meshwind.surface.interpolate import sites, through


@pytest.mark.parametrize("periodic", [True, False])
def test_frames_agree_with_scipy(periodic: bool) -> None:
    """Position and all five derivatives, for a random net, to round-off."""
    rng = np.random.default_rng(4)
    surface = Surface(rng.normal(size=(11, 9, 3)), periodic)
    uv = rng.random((200, 2))
    got = surface.frames(uv + ([3.0, 0.0] if periodic else [0.0, 0.0]))
    knots_u, knots_v = surface.knots
    orders = [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)]
    for row, (a, b) in enumerate(orders):
        left = np.array([BSpline(knots_u, surface.net, DEGREE).derivative(a)(u) for u in uv[:, 0]])
        want = np.array([BSpline(knots_v, n, DEGREE).derivative(b)(v) for n, v in zip(left, uv[:, 1], strict=True)])
        assert got[:, row] == pytest.approx(want, rel=1e-11, abs=1e-11 * np.abs(want).max())


@pytest.mark.parametrize("periodic", [True, False])
@pytest.mark.parametrize("spans", [(4, 3), (5, 7), (128, 20)])
def test_a_net_comes_back_from_its_values(spans: tuple[int, int], periodic: bool) -> None:
    """Interpolation is a projection: the values of a spline give its control points, to round-off."""
    net = np.random.default_rng(8).normal(size=(spans[0] + (0 if periodic else DEGREE), spans[1] + DEGREE, 3))
    u, v = sites(spans[0], periodic), sites(spans[1], False)
    values = Surface(net, periodic).points(parameter_grid(u, v)).reshape(len(u), len(v), 3)
    assert through(values, spans, periodic).control_points == pytest.approx(net, abs=1e-12)


PLAIN = """
import numpy as np
from meshwind.path import solve
from meshwind.surface import shapes
waist = shapes.hyperboloid(1.0, 1.0, 1.5, (24, 12))
paths = solve(waist, [(0, 0), (0, 0)], [(0.2, 1), (0.6, 1)], particles=21)
print(repr(paths.points.tolist()))
print(repr(paths.gap.tolist()))
"""


def test_plain_python_gives_the_same_paths() -> None:
    """Without compilation the kernels are ordinary code: no type or bound is hidden by the compiler."""
    said = subprocess.run(
        [sys.executable, "-W", "error", "-c", PLAIN],
        env=os.environ | {"NUMBA_DISABLE_JIT": "1"}, capture_output=True, text=True, check=True, timeout=120,
    )  # fmt: skip
    points, gap = (np.array(eval(line)) for line in said.stdout.splitlines())
    waist = shapes.hyperboloid(1.0, 1.0, 1.5, (24, 12))
    paths = solve(waist, [(0, 0), (0, 0)], [(0.2, 1), (0.6, 1)], particles=21)
    assert paths.points == pytest.approx(points, abs=1e-10)
    assert paths.gap == pytest.approx(gap, abs=1e-9)
