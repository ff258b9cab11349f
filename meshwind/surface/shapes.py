"""Analytic shapes as the one surface type: exact to about 1e-8 of their size, for tests and first trials.

Every shape has u around (one turn from 0 to 1, starting on +x), v from end to end, outward normals, and lengths
in whatever unit its arguments have.  `spans` are the polynomial pieces in u and v; the error falls with their
fourth power.
"""

from collections.abc import Callable

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.surface.interpolate import Formula, interpolate
from meshwind.surface.surface import Surface

Spans = tuple[int, int]


def _positive(**lengths: float) -> None:
    for name, value in lengths.items():
        if not isinstance(value, int | float | np.number) or not (np.isfinite(value) and value > 0):
            raise BadInputError(f"{name} is {value}; give a positive length")


def parametric(formula: Formula, spans: Spans = (128, 128), periodic: bool = True) -> Surface:
    """Any smooth formula s(u, v), u and v in [0, 1]; with `periodic` it must have period 1 in u."""
    return interpolate(formula, spans, periodic)


def revolution(radius: Callable[[Floats], Floats], z0: float, z1: float, spans: Spans = (128, 128)) -> Surface:
    """The profile r = radius(z), z from z0 (v=0) to z1 (v=1), turned about the z axis."""
    if not z0 < z1:
        raise BadInputError(f"the profile runs from z0={z0} to z1={z1}; give z0 < z1")

    def formula(u: Floats, v: Floats) -> Floats:
        z = z0 + v * (z1 - z0)
        r = radius(z)
        return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), z], -1)

    return interpolate(formula, spans)


def cylinder(radius: float, length: float, spans: Spans = (128, 8)) -> Surface:
    """A circular cylinder about z from z=0 to z=length."""
    return cone(radius, radius, length, spans)


def cone(radius0: float, radius1: float, height: float, spans: Spans = (128, 8)) -> Surface:
    """A truncated cone about z, radius0 at z=0 and radius1 at z=height."""
    _positive(radius0=radius0, radius1=radius1, height=height)
    return revolution(lambda z: radius0 + (radius1 - radius0) * z / height, 0.0, height, spans)


def ellipsoid(a: float, b: float, c: float, polar0: float, polar1: float, spans: Spans = (192, 96)) -> Surface:
    """A band of the ellipsoid with semi-axes a, b, c, from polar angle polar0 to polar1 (radians from -z)."""
    _positive(a=a, b=b, c=c)
    if not 0 < polar0 < polar1 < np.pi:
        raise BadInputError(f"polar angles {polar0}, {polar1} do not bound a band; give 0 < polar0 < polar1 < pi")

    def formula(u: Floats, v: Floats) -> Floats:
        t, q = 2 * np.pi * u, polar0 + v * (polar1 - polar0)
        return np.stack([a * np.sin(q) * np.cos(t), b * np.sin(q) * np.sin(t), -c * np.cos(q)], -1)

    return interpolate(formula, spans)


def sphere_band(radius: float, polar0: float, polar1: float, spans: Spans = (192, 96)) -> Surface:
    """A band of a sphere about z, from polar angle polar0 to polar1 (radians from -z)."""
    return ellipsoid(radius, radius, radius, polar0, polar1, spans)


def torus(major: float, minor: float, bend: float = 2 * np.pi, spans: Spans = (192, 256)) -> Surface:
    """A torus about z cut open: u around the tube (0 on the outside), v along the bend of `bend` radians."""
    _positive(major=major, minor=minor, bend=bend)
    if minor >= major:
        raise BadInputError(f"the tube radius {minor} must be smaller than the bend radius {major}")

    def formula(u: Floats, v: Floats) -> Floats:
        t, b = 2 * np.pi * u, bend * v
        ring = major + minor * np.cos(t)
        return np.stack([ring * np.cos(b), ring * np.sin(b), -minor * np.sin(t)], -1)

    return interpolate(formula, spans)


def elbow(major: float, minor: float, bend: float = np.pi / 2, spans: Spans = (128, 64)) -> Surface:
    """A pipe elbow: the part of a torus over `bend` radians."""
    return torus(major, minor, bend, spans)


def hyperboloid(waist: float, slope: float, half_height: float, spans: Spans = (192, 96)) -> Surface:
    """One sheet r = sqrt(waist^2 + (slope z)^2) about z, |z| <= half_height."""
    _positive(waist=waist, slope=slope, half_height=half_height)
    return revolution(lambda z: np.sqrt(waist**2 + (slope * z) ** 2), -half_height, half_height, spans)
