"""Layups to test with: shapes of revolution as splines with paths that are drawn, and windings that are solved."""

from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike
from scipy.interpolate import BSpline

import meshwind as mw
from meshwind.core.cast import Floats, frozen
from meshwind.path.paths import Counters, Paths
from meshwind.path.solve import solve
from meshwind.planning.families import families
from meshwind.surface.surface import Surface

HEIGHT = 4.0
DATA = Path(__file__).parents[1] / "data"


def collocation(count: int, sites: Floats, periodic: bool) -> Floats:
    """Dense matrix of the uniform cubic basis that `Surface` uses."""
    spans = count if periodic else count - 3
    full = BSpline.design_matrix(sites, np.arange(-3, spans + 4) / spans, 3).toarray()
    if periodic:
        full[:, :3] += full[:, count:]
    return np.asarray(full[:, :count])


def revolved(radius: Callable[[Floats], Floats], nu: int = 256, nv: int = 32) -> Surface:
    """Least-squares spline of a shape of revolution about z, radius(v) with z = 4 v."""
    u, v = np.arange(4 * nu) / (4 * nu), np.linspace(0.0, 1.0, 8 * nv)
    turn = 2.0 * np.pi * u[:, None]
    ring = radius(v)
    samples = np.stack([np.cos(turn) * ring, np.sin(turn) * ring, 0.0 * turn + HEIGHT * v])
    left, right = collocation(nu, u, True), collocation(nv, v, False)
    rows = np.linalg.solve(left.T @ left, left.T @ samples)
    control = np.linalg.solve(right.T @ right, right.T @ np.swapaxes(rows, 1, 2))
    return Surface(np.ascontiguousarray(control.transpose(2, 1, 0)))


@cache
def cylinder(nu: int = 256) -> Surface:
    return revolved(np.ones_like, nu, 8)


@cache
def waisted() -> Surface:
    return revolved(lambda v: 1.0 - 0.35 * np.exp(-(((v - 0.5) / 0.16) ** 2)), 64, 64)


def drawn(surface: Surface, uv: Floats, family: ArrayLike) -> Paths:
    """Paths that lie on the surface along given uv (p, n, 2)."""
    p, n = uv.shape[:2]
    flat = np.ascontiguousarray(uv.reshape(-1, 2))
    slip = np.zeros((p, n))
    slip[:, [0, -1]] = np.nan
    return Paths(
        surface=surface,
        points=frozen(surface.points(flat).reshape(p, n, 3)),
        uv=frozen(uv),
        on_surface=frozen(np.ones((p, n), dtype=bool)),
        gap=frozen(np.zeros((p, n))),
        normal=frozen(surface.normals(flat).reshape(p, n, 3)),
        slip=frozen(slip),
        family=frozen(np.asarray(family, dtype=np.int64)),
        status=frozen(np.zeros(p, dtype=np.int64)),
        residual=frozen(np.zeros(p)),
        friction=0.0,
        counters=Counters(0, 0, 0, 0),
    )


def straight_uv(count: int, revolutions: float, particles: int, offset: float = 0.0) -> tuple[Floats, Floats]:
    """Straight lines in (u, v), `count` of each family from shared rim points; and families."""
    v = np.linspace(0.0, 1.0, particles)
    start = offset + np.arange(count) / count
    family = np.repeat([1.0, -1.0], count)
    u = np.tile(start, 2)[:, None] + family[:, None] * revolutions * v
    return np.stack([u, np.broadcast_to(v, u.shape)], axis=2), family


def helices(count: int, revolutions: float, particles: int = 101, surface: Surface | None = None) -> Paths:
    """Both families of helices on a cylinder: exact geodesics."""
    return drawn(surface or cylinder(), *straight_uv(count, revolutions, particles))


def bridged(count: int = 16, revolutions: float = 0.25, particles: int = 201) -> Paths:
    """Helices on the waist, with every particle inside v in (0.3, 0.7) lifted onto the chord of that span."""
    on = drawn(waisted(), *straight_uv(count, revolutions, particles))
    v = on.uv[0, :, 1]
    span = np.flatnonzero((v > 0.3 + 1e-9) & (v < 0.7 - 1e-9))
    a, b = span[0] - 1, span[-1] + 1
    points, normal = on.points.copy(), on.normal
    t = ((v[span] - v[a]) / (v[b] - v[a]))[:, None]
    points[:, span] = points[:, a, None] * (1.0 - t) + points[:, b, None] * t
    surface_flag = np.ones(on.gap.shape, dtype=bool)
    surface_flag[:, span] = False
    gap = np.where(surface_flag, 0.0, np.linalg.norm(points - on.points, axis=2))
    slip = np.where(surface_flag, on.slip, np.nan)
    return Paths(
        on.surface,
        frozen(points),
        on.uv,
        frozen(surface_flag),
        frozen(gap),
        normal,
        frozen(slip),
        on.family,
        on.status,
        on.residual,
        0.0,
        on.counters,
    )


def wound(surface: Surface, paths: int, turns: float, particles: int = 145) -> Paths:
    """Both families, `paths` each, wound by `turns` revolutions."""
    rims = families(surface, paths, turns)
    return solve(surface, rims.start, rims.end, particles=particles, family=rims.family)


@cache
def fitted(name: str) -> Surface:
    """The surface of a part in data/."""
    return mw.fit(mw.flatten(mw.annulus(mw.read(DATA / name))))
