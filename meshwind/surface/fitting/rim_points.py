"""Points on a rim between its vertices, where these are further apart than the net's spans.

A rim has data on one side only, so that the net swings there between vertices as it does nowhere else: by 0.09 mm on
the sample cast after an edit, of which 0.04 mm remain with these points.  They lie on a cubic spline through the rim's
vertices, of fourth order; those on curved triangles are of second order there, as their normals are one-sided.
"""

import numpy as np
from scipy.interpolate import CubicSpline

from meshwind.core.cast import Floats
from meshwind.core.vectors import unit

WEIGHT = 0.3
"""Weight of such a point, against 1 for a vertex."""
SCARCE = 1.5
"""Mean width of a rim's edges in spans, above which there are no such points.

Of a rim of 25 vertices with seven waves the triangles next to it know more than its spline, which doubles the error;
with 38 and 50 vertices the spline takes off up to half of it.
"""
FINEST = 64
"""Maximum number of pieces that an edge is divided into."""
STRAIGHT = 0.5
"""Least cosine of the turn at both ends of an edge: past a corner, a spline swings itself."""


def rim_points(uv: Floats, points: Floats, spans: int) -> tuple[Floats, Floats]:
    """Points of edges that are wider than a span: uv (k, 2) and positions (k, 3).

    uv (n, 2), points (n, 3): of a rim's vertices; spans: of the net around.  Nothing where u does not grow around it.
    """
    order = np.argsort(uv[:, 0] - np.floor(uv[:, 0]), kind="stable")
    u, at = (uv[:, 0] - np.floor(uv[:, 0]))[order], points[order]
    u, at = np.append(u, u[0] + 1.0), np.concatenate([at, at[:1]])
    width = np.diff(u) * spans
    ahead = unit(np.diff(at, axis=0))
    smooth = (ahead * np.roll(ahead, 1, axis=0)).sum(axis=1) > STRAIGHT
    wide = (width > 1.0) & smooth & np.roll(smooth, -1)
    if not wide.any() or (width <= 0.0).any() or spans > SCARCE * len(uv):
        return np.zeros((0, 2)), np.zeros((0, 3))
    pieces = np.minimum(np.ceil(width[wide]), FINEST).astype(np.int64)
    edge = np.repeat(np.flatnonzero(wide), pieces - 1)
    first = np.cumsum(pieces - 1) - (pieces - 1)
    share = (np.arange(len(edge)) - np.repeat(first, pieces - 1) + 1) / np.repeat(pieces, pieces - 1)
    between = (1.0 - share) * u[edge] + share * u[edge + 1]
    found = CubicSpline(u, at, bc_type="periodic")(between)
    return np.stack([between, np.full(len(edge), uv[0, 1])], axis=1), np.asarray(found)
