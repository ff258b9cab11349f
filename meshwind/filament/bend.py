"""How a curve v(u) lies on a surface: its angle, and the friction that holds it there."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S
from meshwind.surface.surface import Surface

_ON_SURFACE = 1e-12
"""Least normal curvature, times the part's size, that presses the fibre on the surface: less is round-off."""


@dataclass(frozen=True)
class Bend:
    """Points and normals (n, 3) of a curve, its angle from the levels' conormal and the friction it needs, (n,).

    steps (n - 1,): its length between the points.
    """

    points: Floats
    normal: Floats
    angle: Floats
    slip: Floats
    steps: Floats


def bend(surface: Surface, uv: Floats, rate: Floats, second: Floats) -> Bend:
    """The curve v(u) with its derivatives (n,) by u; the slip is infinite where it does not press on the surface."""
    at = surface.frames(uv)
    su, sv = at[:, SU], at[:, SV]
    cross = np.cross(su, sv)
    area = np.linalg.norm(cross, axis=1)
    normal = cross / np.maximum(area, TINY)[:, None]
    tangent = su + rate[:, None] * sv
    turned_by = at[:, SUU] + (2.0 * rate)[:, None] * at[:, SUV] + (rate**2)[:, None] * at[:, SVV] + second[:, None] * sv
    square = np.maximum((tangent * tangent).sum(axis=1), TINY)
    press = -(turned_by * normal).sum(axis=1) / square
    side = (turned_by * np.cross(normal, tangent)).sum(axis=1) / square**1.5
    pressing = press > _ON_SURFACE / surface.size
    slip = np.divide(np.abs(side), press, out=np.full(len(uv), np.inf), where=pressing)
    along = np.abs((tangent * su).sum(axis=1)) / np.sqrt((su * su).sum(axis=1) * square)
    ahead = tangent / np.sqrt(square)[:, None]
    turned = np.minimum(np.linalg.norm(np.diff(ahead, axis=0), axis=1), 1.0)  # a half turn has kinks at both ends
    steps = np.linalg.norm(np.diff(at[:, S], axis=0), axis=1) * (1.0 + turned**2 / 24.0)  # of the arc over a chord
    return Bend(at[:, S], normal, np.arcsin(np.clip(along, 0.0, 1.0)), slip, steps)
