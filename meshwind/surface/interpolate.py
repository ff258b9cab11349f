"""Interpolation by a B-spline surface, of formulas and of grids of points."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from scipy.interpolate import make_interp_spline
from scipy.linalg import solve_circulant

from meshwind.core.cast import Floats, floats
from meshwind.core.checks import text, whole
from meshwind.core.errors import BadInputError
from meshwind.surface.evaluate import DEGREE
from meshwind.surface.surface import Surface

Formula: TypeAlias = Callable[[Floats, Floats], Floats]
"""s(u, v) for arrays of equal shape; the result has one more axis of length 3."""


def interpolate(formula: Formula, spans: tuple[int, int] = (128, 128), periodic: bool = True) -> Surface:
    """Interpolate `formula` by a uniform bicubic surface; the error falls with the fourth power of the spans."""
    if not isinstance(spans, tuple | list) or len(spans) != 2:
        raise BadInputError(f"spans is {text(spans)}; give two whole numbers, along u and along v")
    for each, least in zip(spans, (4 if periodic else 1, 1), strict=True):
        whole(each, "spans", least)
    u = sites(spans[0], periodic)
    v = sites(spans[1], False)
    places = np.meshgrid(u, v, indexing="ij")
    return through(floats(formula(*places), "the formula's result", len(u), len(v), 3), spans, periodic)


def through(values: Floats, spans: tuple[int, int], periodic: bool = True) -> Surface:
    """The bicubic surface with so many spans that has the `values` (p, q, 3) at the `sites` in u and in v."""
    net = _control(values, sites(spans[0], periodic), spans[0], periodic)
    net = np.swapaxes(_control(np.swapaxes(net, 0, 1), sites(spans[1], False), spans[1], False), 0, 1)
    return Surface(net, periodic)


def sites(spans: int, periodic: bool) -> Floats:
    """Interpolation parameters: the knots, and at open ends the middle of the first and of the last span as well."""
    knots = np.arange(spans + (not periodic)) / spans
    return knots if periodic else np.sort(np.r_[knots, 0.5 / spans, 1 - 0.5 / spans])


def _control(values: Floats, sites: Floats, spans: int, periodic: bool) -> Floats:
    """The control points (m, ...) of splines that have the values (p, ...) at the sites."""
    if not periodic:
        knots = np.arange(-DEGREE, spans + DEGREE + 1) / spans
        return np.asarray(make_interp_spline(sites, values, DEGREE, t=knots).c)
    # SciPy solves periodic splines a column at a time; the value at knot k is (c[k] + 4 c[k + 1] + c[k + 2]) / 6
    weights = np.zeros(spans)
    np.add.at(weights, np.array([0, 1, -1]) % spans, np.array([4.0, 1.0, 1.0]) / 6.0)
    found = np.roll(solve_circulant(weights, values.reshape(spans, -1)), 1, axis=0)
    return np.asarray(found.reshape(values.shape))
