"""What Coulomb's law demands of a path at rest, worked out from its points alone, and the shapes to ask it on."""

from collections.abc import Callable
from functools import cache

import numpy as np
from comparison import problems

from meshwind.core.cast import Floats
from meshwind.path import Paths
from meshwind.surface import Surface, shapes

TURN = 2 * np.pi


def wavy_shape(u: Floats, v: Floats) -> Floats:
    """Three lobes and two waists."""
    t = TURN * u
    r = 1 + 0.25 * np.cos(3 * t) * np.sin(np.pi * v) ** 2 + 0.2 * np.cos(4 * np.pi * v)
    return np.stack([r * np.cos(t), r * np.sin(t), 4 * v], -1)


def bent_shape(u: Floats, v: Floats) -> Floats:
    """A twisted oval on a wavy axis: no symmetry."""
    t = TURN * u
    r = 0.5 + 0.1 * np.cos(2 * t + 6 * v)
    return np.stack([r * np.cos(t) + 0.8 * np.sin(4 * v), 0.8 * r * np.sin(t), 4 * v], -1)


@cache
def wavy() -> Surface:
    return shapes.parametric(wavy_shape, (96, 96))


@cache
def bent() -> Surface:
    return shapes.parametric(bent_shape, (96, 96))


SHAPES: dict[str, Callable[[], Surface]] = {
    "barrel": problems.barrel, "ellipsoid": problems.ellipsoid, "bottle": problems.bottle, "elbow": problems.elbow,
    "vase": problems.vase, "hyperboloid": problems.hyperboloid, "wavy": wavy, "bent": bent,
}  # fmt: skip
BRIDGED = ("elbow", "vase", "hyperboloid", "wavy", "bent", "bottle")


def forces(paths: Paths) -> tuple[Floats, Floats, Floats]:
    """Lateral force and contact force over the tension, and unevenness, at inner particles (p, n - 2).

    The forces are the turn of the polyline's unit tangent (radians) across the fibre and into the surface, by the
    surface's own normals; unevenness is the relative difference of the segments on both sides.
    """
    X = paths.points
    normal = paths.surface.normals(paths.uv.reshape(-1, 2)).reshape(X.shape)[:, 1:-1]
    step = np.diff(X, axis=1)
    size = np.linalg.norm(step, axis=2)
    unit = step / size[..., None]
    turn, middle = np.diff(unit, axis=1), unit[:, 1:] + unit[:, :-1]
    across = np.cross(normal, middle)
    across /= np.linalg.norm(across, axis=2)[..., None]
    side, press = np.einsum("pik,pik->pi", turn, across), -np.einsum("pik,pik->pi", turn, normal)
    return side, press, np.abs(np.diff(size, axis=1)) / size[:, 1:]


def lateral(paths: Paths, start: Floats, end: Floats) -> Floats:
    """Signed (u, v) distance (p, n) of each particle from its straight start, positive to the left."""
    way = end - start
    away = paths.uv - start[:, None]
    cross = way[:, None, 0] * away[..., 1] - way[:, None, 1] * away[..., 0]
    return np.asarray(cross / np.linalg.norm(way, axis=1)[:, None])
