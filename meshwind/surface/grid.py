"""Grids of points in the parametric plane, and a surface sampled on one: for files, pictures and measurements."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.vectors import unit
from meshwind.surface.evaluate import SU, SV

if TYPE_CHECKING:
    from meshwind.surface.surface import Surface

PER_SPAN, MOST = 4, 200
"""Samples per span of the spline, and at most in each direction, of the grid that files and pictures have."""


def parameter_grid(u: Floats, v: Floats) -> Floats:
    """All pairs (nu nv, 2) of parameters u (nu,) and v (nv,), u slowest."""
    return np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)


def midpoints(count: int) -> Floats:
    """Middles (count,) of equal intervals of [0, 1]."""
    return (np.arange(count) + 0.5) / count


def composite_gauss(intervals: int, nodes: int) -> tuple[Floats, Floats]:
    """Nodes and weights (intervals nodes,) of Gauss quadrature on equal intervals of [0, 1]."""
    node, weight = np.polynomial.legendre.leggauss(nodes)
    at = (np.arange(intervals)[:, None] + 0.5 * (node + 1.0)) / intervals
    return at.ravel(), np.tile(0.5 * weight / intervals, intervals)


@dataclass(frozen=True)
class Grid:
    """Samples of a surface: uv (k, 2), points (k, 3), frames (k, 6, 3), and outward quads (q, 4).

    u varies slowest: k = nu nv, `shape` = (nu, nv).  Around a closed part the last column joins the first.
    """

    surface: Surface
    shape: tuple[int, int]
    uv: Floats
    frames: Floats
    quads: Ints

    __repr__ = brief

    @property
    def points(self) -> Floats:
        """Positions (k, 3)."""
        return np.ascontiguousarray(self.frames[:, 0])

    @property
    def normals(self) -> Floats:
        """Outward unit normals (k, 3)."""
        return unit(np.cross(self.frames[:, SU], self.frames[:, SV]))


def grid(surface: Surface, per_span: int = PER_SPAN, most: int = MOST) -> Grid:
    """Sample a surface `per_span` times per span, at most `most` x `most` times."""
    around, along = surface.spans
    nu = min(per_span * around + (not surface.periodic), most)
    nv = min(per_span * along + 1, most)
    u = np.arange(nu) / (nu if surface.periodic else nu - 1)
    v = np.linspace(0.0, 1.0, nv)
    uv = parameter_grid(u, v)
    quads = grid_quads(nu, nv, surface.periodic)
    return Grid(surface, (nu, nv), frozen(uv), frozen(surface.frames(uv)), frozen(quads))


def grid_quads(nu: int, nv: int, closed: bool) -> Ints:
    """Quads (q, 4) between the points of a grid, number i nv + j; `closed`: the last column joins the first."""
    number = np.arange(nu * nv).reshape(nu, nv)
    if closed:
        number = np.concatenate([number, number[:1]])
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    return np.stack(corners, axis=2).reshape(-1, 4)


def mean_speeds(surface: Surface, count: int) -> tuple[float, float]:
    """Mean lengths of s_u and of s_v over the middles of count x count cells: extents around and along the part."""
    frames = surface.frames(parameter_grid(midpoints(count), midpoints(count)))
    around, along = np.linalg.norm(frames[:, SU : SV + 1], axis=2).mean(axis=0)
    return float(around), float(along)


def rings(surface: Surface, v: Floats, count: int) -> Floats:
    """Frames (len(v), count, 6, 3) at `count` even values of u on the rings of constant v."""
    uv = parameter_grid(v, np.arange(count) / count)[:, ::-1]
    return surface.frames(uv).reshape(len(v), count, 6, 3)


def rim_frames(surface: Surface, v: float, per_span: int) -> Floats:
    """Frames (n, 6, 3) at even values of u on the rim v, `per_span` for each span."""
    return rings(surface, np.array([v]), per_span * surface.spans[0])[0]
