"""Analytic shapes as the one surface type: exact to about 1e-8 of their size, for tests and first trials.

Every shape has u around (one turn from 0 to 1, starting on +x), v from end to end, outward normals, and lengths
in whatever unit its arguments have.  `spans` are the polynomial pieces in u and v; the error falls with their
fourth power.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.checks import check_switch, is_number, text
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.surface.interpolate import Formula, interpolate
from meshwind.surface.surface import Surface

Spans = tuple[int, int]


def _positive(**lengths: float) -> None:
    for name, value in lengths.items():
        if not is_number(value) or value <= 0:
            raise BadInputError(f"{name} is {shortened(str(value))}; give a positive length")


def _check_function(value: object, name: str) -> None:
    if not callable(value):
        raise BadInputError(f"{name} is {text(value)}; give a function")


def parametric(formula: Formula, spans: Spans = (128, 128), periodic: bool = True) -> Surface:
    """Interpolate any smooth formula s(u, v).

    Parameters
    ----------
    formula : callable
        Called with arrays u and v of one shape, both in [0, 1]; returns positions, of that shape and a last axis of 3.
        With `periodic` it must have period 1 in u.
    spans : tuple of int, default (128, 128)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.
    periodic : bool, default True
        Whether the surface closes in u.

    Returns
    -------
    Surface
        Surface through the formula's points.  s_u x s_v must point outwards, which is not checked.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> def tube(u, v):
    ...     turn = 2 * np.pi * u
    ...     return np.stack([np.cos(turn), np.sin(turn) * (2 - v), 3 * v], axis=-1)
    >>> mw.shapes.parametric(tube, spans=(64, 16)).points([(0.25, 1.0)]).round(4) + 0.0
    array([[0., 1., 3.]])
    """
    _check_function(formula, "formula")
    check_switch(periodic, "periodic")
    return interpolate(formula, spans, periodic)


def revolution(radius: Callable[[Floats], Floats], z0: float, z1: float, spans: Spans = (128, 128)) -> Surface:
    """Turn a profile about the z axis.

    Parameters
    ----------
    radius : callable
        Called with an array z; returns the radius at each.
    z0, z1 : float
        Heights of the start rim (v=0) and of the end rim (v=1), z0 < z1.
    spans : tuple of int, default (128, 128)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface of revolution, periodic in u.

    Raises
    ------
    BadInputError
        If z0 is not below z1.

    Examples
    --------
    >>> import meshwind as mw
    >>> barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0)
    >>> barrel.points([(0.0, 0.5)]).round(6) + 0.0
    array([[1., 0., 1.]])
    """
    if not (is_number(z0) and is_number(z1) and z0 < z1):
        raise BadInputError(f"the profile runs from z0={text(z0)} to z1={text(z1)}; give z0 < z1")
    _check_function(radius, "radius")

    def formula(u: Floats, v: Floats) -> Floats:
        z = z0 + v * (z1 - z0)
        r = radius(z)
        return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), z], -1)

    return interpolate(formula, spans)


def cylinder(radius: float, length: float, spans: Spans = (128, 8)) -> Surface:
    """Make a circular cylinder about the z axis, from z=0 to z=length.

    Parameters
    ----------
    radius, length : float
        Radius and length, above 0.
    spans : tuple of int, default (128, 8)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u.

    Raises
    ------
    BadInputError
        If a length is not above 0.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.shapes.cylinder(radius=1.0, length=3.0).points([(0.0, 1.0)]).round(6) + 0.0
    array([[1., 0., 3.]])
    """
    return cone(radius, radius, length, spans)


def cone(radius0: float, radius1: float, height: float, spans: Spans = (128, 8)) -> Surface:
    """Make a truncated cone about the z axis, from z=0 to z=height.

    Parameters
    ----------
    radius0, radius1 : float
        Radii at z=0 and at z=height, above 0.
    height : float
        Height, above 0.
    spans : tuple of int, default (128, 8)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u.

    Raises
    ------
    BadInputError
        If a length is not above 0.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.shapes.cone(radius0=2.0, radius1=1.0, height=3.0).points([(0.0, 0.5)]).round(6) + 0.0
    array([[1.5, 0. , 1.5]])
    """
    _positive(radius0=radius0, radius1=radius1, height=height)
    return revolution(lambda z: radius0 + (radius1 - radius0) * z / height, 0.0, height, spans)


def ellipsoid(a: float, b: float, c: float, polar0: float, polar1: float, spans: Spans = (192, 96)) -> Surface:
    """Make a band of an ellipsoid with its axes along x, y and z.

    Parameters
    ----------
    a, b, c : float
        Semi-axes along x, y and z, above 0.
    polar0, polar1 : float
        Polar angles of the rims, in radians from the direction -z, 0 < polar0 < polar1 < pi.
    spans : tuple of int, default (192, 96)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u.

    Raises
    ------
    BadInputError
        If a semi-axis is not above 0 or the angles do not bound a band.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> egg = mw.shapes.ellipsoid(1.0, 1.0, 2.0, polar0=0.2 * np.pi, polar1=0.9 * np.pi)
    >>> egg.points([(0.25, 3 / 7)]).round(5) + 0.0
    array([[0., 1., 0.]])
    """
    _positive(a=a, b=b, c=c)
    if not (is_number(polar0) and is_number(polar1) and 0 < polar0 < polar1 < np.pi):
        raise BadInputError(
            f"polar angles {text(polar0)}, {text(polar1)} do not bound a band; give 0 < polar0 < polar1 < pi"
        )

    def formula(u: Floats, v: Floats) -> Floats:
        t, q = 2 * np.pi * u, polar0 + v * (polar1 - polar0)
        return np.stack([a * np.sin(q) * np.cos(t), b * np.sin(q) * np.sin(t), -c * np.cos(q)], -1)

    return interpolate(formula, spans)


def sphere_band(radius: float, polar0: float, polar1: float, spans: Spans = (192, 96)) -> Surface:
    """Make a band of a sphere about the z axis.

    Parameters
    ----------
    radius : float
        Radius, above 0.
    polar0, polar1 : float
        Polar angles of the rims, in radians from the direction -z, 0 < polar0 < polar1 < pi.
    spans : tuple of int, default (192, 96)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u.

    Raises
    ------
    BadInputError
        If the radius is not above 0 or the angles do not bound a band.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> band = mw.shapes.sphere_band(2.0, 0.25 * np.pi, 0.75 * np.pi)
    >>> band.points([(0.0, 0.5)]).round(5) + 0.0
    array([[2., 0., 0.]])
    """
    return ellipsoid(radius, radius, radius, polar0, polar1, spans)


def torus(major: float, minor: float, bend: float = 2 * np.pi, spans: Spans = (192, 256)) -> Surface:
    """Make a torus about the z axis, cut open: u goes around the tube and v along it.

    Parameters
    ----------
    major, minor : float
        Radius of the bend, from the z axis to the middle of the tube, and of the tube; 0 < minor < major.
    bend : float, default 2 pi
        Angle of the bend, in radians.
    spans : tuple of int, default (192, 256)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u, with u=0 on the outside of the bend.

    Raises
    ------
    BadInputError
        If a length is not above 0 or the tube is not thinner than its bend.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.shapes.torus(major=3.0, minor=1.0).points([(0.5, 0.0)]).round(5) + 0.0
    array([[2., 0., 0.]])
    """
    _positive(major=major, minor=minor, bend=bend)
    if minor >= major:
        raise BadInputError(f"the tube radius {minor} must be smaller than the bend radius {major}")

    def formula(u: Floats, v: Floats) -> Floats:
        t, b = 2 * np.pi * u, bend * v
        ring = major + minor * np.cos(t)
        return np.stack([ring * np.cos(b), ring * np.sin(b), -minor * np.sin(t)], -1)

    return interpolate(formula, spans)


def elbow(major: float, minor: float, bend: float = np.pi / 2, spans: Spans = (128, 64)) -> Surface:
    """Make a pipe elbow, a part of a torus about the z axis.

    Parameters
    ----------
    major, minor : float
        Radius of the bend and of the pipe, 0 < minor < major.
    bend : float, default pi / 2
        Angle of the bend, in radians.
    spans : tuple of int, default (128, 64)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u, with u=0 on the outside of the bend.

    Raises
    ------
    BadInputError
        If a length is not above 0 or the pipe is not thinner than its bend.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.shapes.elbow(major=3.0, minor=1.0).points([(0.0, 1.0)]).round(5) + 0.0
    array([[0., 4., 0.]])
    """
    return torus(major, minor, bend, spans)


def hyperboloid(waist: float, slope: float, half_height: float, spans: Spans = (192, 96)) -> Surface:
    """Make one sheet r^2 = waist^2 + (slope z)^2 of a hyperboloid about the z axis, for ``|z| <= half_height``.

    Parameters
    ----------
    waist : float
        Radius at z=0, above 0.
    slope : float
        Slope of the cone that the sheet approaches, above 0.
    half_height : float
        Height of either rim above or below z=0, above 0.
    spans : tuple of int, default (192, 96)
        Number of polynomial pieces in u and in v; the error falls with their fourth power.

    Returns
    -------
    Surface
        Surface, periodic in u.

    Raises
    ------
    BadInputError
        If an argument is not above 0.

    Examples
    --------
    >>> import meshwind as mw
    >>> mw.shapes.hyperboloid(waist=1.0, slope=1.0, half_height=1.5).points([(0.0, 0.5)]).round(6) + 0.0
    array([[1., 0., 0.]])
    """
    _positive(waist=waist, slope=slope, half_height=half_height)
    return revolution(lambda z: np.sqrt(waist**2 + (slope * z) ** 2), -half_height, half_height, spans)
