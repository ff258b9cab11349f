"""The edge of a part as the base of a turnaround: its rim, continued as a prism over the rim's convex hull.

A fibre that crosses the rim goes on in the plane that the prism unrolls to, at the same angle from the rim: positions
there are the length along the hull, in the sense of turning, and the height over the rim's middle, away from the part.
"""

from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import unit
from meshwind.filament.section import Section, section
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.surface import Surface

_SAMPLES = 1440
"""Points of the rim, a quarter of a degree apart: chords between them are shorter than the arc by 8e-7."""
_SLANTED = 0.98
"""Sine of the largest slope of a rim against the plane square to its axis that still unrolls, ..."""
_STEEP = 0.05
"""... and the share of a rim that may be steeper: a scan's rim has notches."""
_ONE_SIDED = np.array([11.0, -18.0, 9.0, -2.0]) / 6.0
"""Derivative at the end of a row of even steps, of third order."""


@dataclass(frozen=True)
class Edge:
    """The prism on a rim.

    Attributes
    ----------
    origin, axis : ndarray of float, shape (3,)
        Middle of the rim, and the unit vector away from the part.
    across : ndarray of float, shape (2, 3)
        Unit vectors square to the axis, in which the section is passed in the sense of turning.
    hull : Section
        Convex hull of the rim, seen along the axis.
    u : ndarray of float, shape (n,)
        Parameters of the hull's points on the rim, growing by less than 1.
    lowest, highest : float
        Least and largest height of the rim.
    hollow : float
        Largest distance of the rim from its hull.
    end : int
        0 at the start of the part, 1 at its end.
    crease : tuple of float
        Least and largest angle, in radians, by which the prism turns from the part at the rim, towards the axis:
        negative where it stands up from the part, so that the fibre would lift off there.
    """

    origin: Floats
    axis: Floats
    across: Floats
    hull: Section
    u: Floats
    lowest: float
    highest: float
    hollow: float
    end: int
    crease: tuple[float, float]

    __repr__ = brief

    def around(self, u: Floats) -> Floats:
        """Lengths (n,) along the hull at parameters u (n,) of the rim, both unwrapped."""
        whole, rest = np.divmod(np.asarray(u) - self.u[0], 1.0)
        at = np.interp(rest, np.append(self.u - self.u[0], 1.0), np.append(self.hull.passed, self.hull.perimeter))
        return np.asarray(whole * self.hull.perimeter + at)

    def turned(self, around: Floats) -> Floats:
        """Parameters u (n,) of the rim at lengths (n,) along the hull, both unwrapped."""
        whole, rest = np.divmod(np.asarray(around), self.hull.perimeter)
        at = np.interp(rest, np.append(self.hull.passed, self.hull.perimeter), np.append(self.u, self.u[0] + 1.0))
        return np.asarray(whole + at)

    def points(self, around: Floats, height: Floats) -> Floats:
        """Points (n, 3) of the prism at lengths (n,) along the hull and heights (n,)."""
        return np.asarray(self.origin + self.hull.at(around) @ self.across + height[:, None] * self.axis)

    def normals(self, around: Floats, height: Floats) -> Floats:
        """Outward unit normals (n, 3) of the prism at lengths (n,) along the hull and heights (n,)."""
        del height  # a prism is the same at all of them
        angle = self.hull.normal_angle(around)
        return np.asarray(np.stack([np.cos(angle), np.sin(angle)], axis=1) @ self.across)

    def tangents(self, around: Floats) -> Floats:
        """Unit tangents (n, 3) of the hull, in the sense of turning, at lengths (n,) along it."""
        angle = self.hull.normal_angle(around)
        return np.asarray(np.stack([-np.sin(angle), np.cos(angle)], axis=1) @ self.across)


@dataclass(frozen=True)
class Lift:
    """How legs leave the part.

    Attributes
    ----------
    aloft : ndarray of int, shape (n,)
        Particles of each path that hang between part and prism, from the rim on; 0 where it does not leave before it.
    off : ndarray of float, shape (n, 3)
        Where they leave the part.
    corner : ndarray of float, shape (n, 3)
        Where they meet the prism.
    ahead : ndarray of float, shape (n, 3)
        Unit vectors from the one to the other.
    held : ndarray of bool, shape (n,)
        Which meet it at the pins.
    before : ndarray of float, shape (n,)
        Length of the path from where they leave the part to the rim.
    normal : ndarray of float, shape (n, 3)
        Unit normals of the prism where they meet it.
    angle : ndarray of float, shape (n,)
        Their angle from the prism's axis on the way, in radians.
    """

    aloft: Ints
    off: Floats
    corner: Floats
    ahead: Floats
    held: Bools
    before: Floats
    normal: Floats
    angle: Floats

    def chosen(self, index: Ints | Bools) -> "Lift":
        """That of some of the legs."""
        return Lift(*(values[index] for values in vars(self).values()))


@dataclass(frozen=True)
class Legs:
    """Fibres that come over a rim outwards, continued on its prism.

    around, height (n,): where they come to lie on it; angle (n,): from the axis, in radians; points (n, 3) where the
    turnaround begins; sense: +1 for fibres that arrive, in the sense of turning, and -1 for those that leave, followed
    backwards; lift: how some leave the part before its rim, None where all lie on it up to there.
    """

    around: Floats
    height: Floats
    angle: Floats
    points: Floats
    sense: int
    lift: Lift | None = None

    def __len__(self) -> int:
        return len(self.around)

    def chosen(self, index: Ints | Bools) -> "Legs":
        """Some of the legs."""
        lift = None if self.lift is None else self.lift.chosen(index)
        return Legs(self.around[index], self.height[index], self.angle[index], self.points[index], self.sense, lift)


def edge(surface: Surface, v: float, end: int | None = None) -> Edge:
    """The prism on a rim, or another level line, of a surface that closes in u.

    Parameters
    ----------
    surface : Surface
        Surface of the part.
    v : float
        0 for the start rim, 1 for the end rim, or that of a line between.
    end : int, optional
        0 if the prism goes on beyond the line towards the start, 1 if it goes on towards the end; by default that of
        the rim.

    Returns
    -------
    Edge
        The prism.

    Raises
    ------
    BadInputError
        If the rim is so uneven that no prism continues it.
    """
    u = np.arange(_SAMPLES) / _SAMPLES
    end = round(v) if end is None else end
    frames = surface.frames(np.stack([u, np.full_like(u, v)], axis=1))
    rim, along = frames[:, S], frames[:, SV] if end else -frames[:, SV]
    middle = rim.mean(axis=0)
    area = np.cross(rim - middle, np.roll(rim, -1, axis=0) - middle).sum(axis=0)
    if not np.linalg.norm(area) > 0.0:
        raise BadInputError("a rim without an area has no turnaround; open the part further inside")
    # by the sense of u, as a flat end meets its rim square to the axis
    axis = unit(area[None])[0] * (1.0 if end else -1.0)
    first = unit(np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])[None])[0]
    second = np.cross(axis, first)
    second = second if end else -second  # u turns against the clock as seen in these two
    across = np.stack([first, second])
    flat = (rim - middle) @ across.T
    corners = np.sort(ConvexHull(flat).vertices)
    height = (rim - middle) @ axis
    hull = section(flat[corners])
    slope = unit(frames[:, SU]) @ axis
    if (np.abs(slope) > _SLANTED).mean() > _STEEP:
        raise BadInputError("a rim that runs along its own axis has no turnaround; open the part by a plane")
    made = Edge(
        frozen(middle), frozen(axis), frozen(across), hull, frozen(u[corners]), float(height.min()),
        float(height.max()), 0.0, end, (0.0, 0.0),
    )  # fmt: skip
    around = made.around(u)
    hollow = np.linalg.norm(flat - hull.at(around), axis=1).max() if len(corners) < _SAMPLES else 0.0
    outward = unit(np.cross(frames[:, SU], frames[:, SV]))
    su, normal = frames[:, SU], made.normals(around, height)
    normal = unit(normal - ((normal * su).sum(axis=1) / (su**2).sum(axis=1))[:, None] * su)
    turn = np.arcsin(np.clip((np.cross(outward, normal) * unit(np.cross(outward, along))).sum(axis=1), -1.0, 1.0))
    return replace(made, hollow=float(hollow), crease=(float(turn.min()), float(turn.max())))


def legs(on: Edge, paths: Paths, family: int) -> Legs:
    """The fibres of a family where they cross the edge: those of +1 arrive at the part's end and leave its start."""
    surface, rows = paths.surface, np.flatnonzero(paths.family == family)
    last = np.arange(-1, -5, -1) if on.end else np.arange(4)
    points = paths.points[rows[:, None], last]
    touching: Bools = np.all(paths.on_surface[rows[:, None], last], axis=1, keepdims=True)
    uv = paths.uv[rows, -1 if on.end else 0]
    # outwards: from the part over the rim
    ahead = np.where(touching, np.einsum("k,nkc->nc", _ONE_SIDED, points), points[:, 0] - points[:, 1])
    sense = family if on.end else -family
    rim = sense * unit(surface.frames(np.ascontiguousarray(uv))[:, SU])
    from_rim = np.arccos(np.clip((unit(ahead) * rim).sum(axis=1), -1.0, 1.0))
    slope = np.arcsin(np.clip(rim @ on.axis, -1.0, 1.0))
    angle = np.clip(0.5 * np.pi - slope - from_rim, 0.0, 0.5 * np.pi)
    height = (points[:, 0] - on.origin) @ on.axis
    return Legs(frozen(on.around(uv[:, 0])), frozen(height), frozen(angle), frozen(points[:, 0]), sense)
