"""A level line within the part as the base of turnarounds, which lie on the part beyond it."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial import cKDTree

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.filament.edge import Edge, edge
from meshwind.filament.levels import level_at, levels
from meshwind.surface.foot import feet
from meshwind.surface.grid import parameter_grid
from meshwind.surface.surface import Surface

_SEEDS = 128
"""Places each way on the part from which the nearest to a point is taken for a start."""
_AROUND = 721
"""Places round the line between which its height is interpolated."""


@dataclass(frozen=True)
class PartEdge(Edge):
    """The edge on a level line: what is beyond it on the unrolled prism lies as far beyond it on the part.

    Attributes
    ----------
    surface : Surface
        The part.
    v : float
        Of the line.
    passed : float
        Mean distance of the line from v=0.
    along : CubicHermiteSpline
        The v at such a distance.
    room : float
        Mean distance from the line to the rim that it faces.
    rim : ndarray of float, shape (2, k)
        Parameters u of the line, growing by 1, and its height there.
    """

    surface: Surface
    v: float
    passed: float
    along: CubicHermiteSpline
    room: float
    rim: Floats

    def places(self, around: Floats, height: Floats) -> Floats:
        """Parameters (n, 2) of places on the unrolled prism."""
        u = self.turned(around)
        beyond = height - np.interp(u, self.rim[0], self.rim[1], period=1.0)
        if beyond.max(initial=0.0) > self.room:
            raise BadInputError(
                f"its turns take {beyond.max():.3g} of the part beyond v={self.v:.3g}, and there are {self.room:.3g}; "
                "let it end further inside, or give more friction"
            )
        distance = self.passed + (beyond if self.end else -beyond)
        return np.stack([u, np.clip(self.along(distance), 0.0, 1.0)], axis=1)

    def points(self, around: Floats, height: Floats) -> Floats:
        """Points (n, 3) of the part at lengths (n,) along the hull and heights (n,)."""
        return self.surface.points(self.places(around, height))

    def normals(self, around: Floats, height: Floats) -> Floats:
        """Outward unit normals (n, 3) of the part there."""
        return self.surface.normals(self.places(around, height))

    def uv(self, points: Floats) -> Floats:
        """Parameters (n, 2) of points (n, 3) of the part, with u unwrapped along them."""
        seeds = parameter_grid(np.arange(_SEEDS) / _SEEDS, np.linspace(0.0, 1.0, _SEEDS))
        _, near = cKDTree(self.surface.points(seeds)).query(points)
        at, frames = np.array(seeds[near]), np.empty((len(points), 6, 3))
        feet(0, len(at), self.surface.spline, np.ascontiguousarray(points), at, frames)
        at[:, 0] = np.unwrap(at[:, 0], period=1.0)
        return at


def part_edge(surface: Surface, v: float, end: int) -> PartEdge:
    """The edge on the level line v, beyond which is the start of the part (end 0) or its end (1).

    Raises BadInputError if the line is so uneven that no prism continues it.
    """
    plain, lines = edge(surface, v, end), levels(surface)
    mean = lines.mean
    passed = float(np.interp(v, lines.v, mean))
    u = np.arange(_AROUND) / _AROUND
    height = (surface.points(np.stack([u, np.full_like(u, v)], axis=1)) - plain.origin) @ plain.axis
    # the prism itself is not there: whether it would stand on the part is of no account
    return PartEdge(
        plain.origin, plain.axis, plain.across, plain.hull, plain.u, plain.lowest, plain.highest, hollow=0.0, end=end,
        crease=(0.0, 0.0), surface=surface, v=v, passed=passed, along=level_at(mean, lines),
        room=float(mean[-1]) - passed if end else passed, rim=frozen(np.stack([u, height])),
    )  # fmt: skip
