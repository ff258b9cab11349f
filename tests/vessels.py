"""Pressure vessels and stepped parts of revolution whose profiles are lines and arcs, and what is known of them."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from irregular import annulus

import meshwind as mw
from meshwind.chart import flatten
from meshwind.core.cast import Bools, Floats
from meshwind.path import Paths

Piece = tuple[float, Callable[[Floats], Floats]]
"""Length of a piece of a profile, and its points (k, 2), radius and height, by the length along it (k,)."""


def line(start: tuple[float, float], end: tuple[float, float]) -> Piece:
    a, b = np.array(start), np.array(end)
    length = float(np.linalg.norm(b - a))
    return length, lambda s: a + (b - a) * (s / length)[:, None]


def arc(middle: tuple[float, float], radii: tuple[float, float], first: float, last: float) -> Piece:
    """Of an ellipse, between two of its eccentric angles."""
    angle = np.linspace(first, last, 4001)
    points = np.array(middle) + np.array(radii) * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])

    def at(s: Floats) -> Floats:
        t = np.interp(s, length, angle)
        return np.asarray(np.array(middle) + np.array(radii) * np.stack([np.cos(t), np.sin(t)], axis=1))

    return float(length[-1]), at


@dataclass(frozen=True)
class Vessel:
    """A part of revolution by the pieces of its profile, from end to end."""

    pieces: tuple[Piece, ...]

    def profile(self, v: Floats) -> Floats:
        """Radius and height (..., 2) by the share of the profile's length."""
        lengths = np.array([length for length, _ in self.pieces])
        ends = np.concatenate([[0.0], np.cumsum(lengths)])
        s = np.clip(v, 0.0, 1.0).ravel() * ends[-1]
        which = np.clip(np.searchsorted(ends, s, side="right") - 1, 0, len(lengths) - 1)
        out = np.empty((len(s), 2))
        for k, (length, at) in enumerate(self.pieces):
            mine = which == k
            out[mine] = at(np.clip(s[mine] - ends[k], 0.0, length))
        return out.reshape(*np.shape(v), 2)

    def formula(self, u: Floats, v: Floats) -> Floats:
        radius, height = np.moveaxis(self.profile(v), -1, 0)
        return np.stack([radius * np.cos(2 * np.pi * u), radius * np.sin(2 * np.pi * u), height], axis=-1)

    def fitted(self, vertices: int, seed: int = 0) -> mw.Surface:
        """The surface of an irregular mesh with vertices on the part."""
        radius = self.profile(np.linspace(0.0, 1.0, 1001))[:, 0].mean()
        aspect = sum(length for length, _ in self.pieces) / (2 * np.pi * radius)
        return mw.fit(flatten(annulus(self.formula, vertices, aspect, seed)))

    @cached_property
    def exact(self) -> mw.Surface:
        """The part itself, on a net so fine that it is off by less than 1e-5 of its size where no edge is."""
        return mw.shapes.parametric(self.formula, (32, 1200))

    @cached_property
    def hollow_heights(self) -> Floats:
        """Heights (k,) of a fine sample of the profile that lies inside the convex hull of the part."""
        points = self.profile(np.linspace(0.0, 1.0, 4001))
        hull = [points[0]]
        for point in points[1:]:  # outer chain: every turn is to the left, seen from outside
            while len(hull) > 1 and _turn(hull[-2], hull[-1], point) <= 0.0:
                hull.pop()
            hull.append(point)
        chain = np.array(hull)
        edge = np.clip(np.searchsorted(chain[:, 1], points[:, 1]), 1, len(chain) - 1)
        a, b = chain[edge - 1], chain[edge]
        (r, z), (x, y) = (b - a).T, (points - a).T
        away = (r * y - z * x) / np.hypot(r, z)
        return np.asarray(points[np.abs(away) > 1e-3, 1])

    @cached_property
    def convex_share(self) -> float:
        """Share of the part's area where no direction bends inwards."""
        points = self.profile((np.arange(20_000) + 0.5) / 20_000)
        (r, z), (x, y) = np.diff(points[:-1], axis=0).T, np.diff(points[1:], axis=0).T
        radius = points[1:-1, 0]
        bulges = (r * y - z * x) / (np.hypot(r, z) * np.hypot(x, y)) > -1e-4
        return float(radius[bulges].sum() / radius.sum())

    def exact_paths(self, laid: Paths, friction: float) -> Paths:
        """Paths between the same ends on the part itself."""
        ends = laid.points[:, [0, -1]]
        u = np.arctan2(ends[..., 1], ends[..., 0]) / (2 * np.pi)
        turns = laid.uv[:, -1, 0] - laid.uv[:, 0, 0]
        last = u[:, 0] + turns + (u[:, 1] - u[:, 0] - turns + 0.5) % 1.0 - 0.5
        up = ends[0, 1, 2] > ends[0, 0, 2]
        v = np.zeros(len(u)), np.ones(len(u))
        start, end = (np.stack([a, b], axis=1) for a, b in zip((u[:, 0], last), v if up else v[::-1], strict=True))
        return mw.solve(self.exact, start, end, family=laid.family, friction=friction, particles=laid.gap.shape[1])


def _turn(a: Floats, b: Floats, c: Floats) -> float:
    return float((b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]))


def domed(depth: float) -> Vessel:
    """A cylinder of radius 50 and length 200 between elliptical domes that are opened to radius 12."""
    opening = float(np.arccos(12.0 / 50.0))
    below = arc((0.0, 0.0), (50.0, depth), -opening, 0.0)
    return Vessel((below, line((50.0, 0.0), (50.0, 200.0)), arc((0.0, 200.0), (50.0, depth), 0.0, opening)))


def coned() -> Vessel:
    """A cone between two cylinders, with edges."""
    return Vessel((line((30, 0), (30, 80)), line((30, 80), (50, 140)), line((50, 140), (50, 220))))


def stepped(low: float, high: float, fillet: float = 2.0) -> Vessel:
    """Two cylinders of length 100 with a plane shoulder between them, rounded by fillets on both sides."""
    round_in = arc((low + fillet, 100 - fillet), (fillet, fillet), np.pi, 0.5 * np.pi)
    round_out = arc((high - fillet, 100 + fillet), (fillet, fillet), -0.5 * np.pi, 0.0)
    shoulder = line((low + fillet, 100), (high - fillet, 100))
    return Vessel(
        (line((low, 0), (low, 100 - fillet)), round_in, shoulder, round_out, line((high, 100 + fillet), (high, 200)))
    )


CONVEX = {"hemispheres": domed(50.0), "flat domes": domed(30.0), "long domes": domed(75.0)}
HOLLOW = {"cone": coned(), "step": stepped(30.0, 50.0)}


def inside(heights: Floats, ranges: Floats) -> Bools:
    """Whether each of ranges (k, 2) of heights holds one of the heights."""
    ordered = np.sort(heights)
    return np.asarray(np.searchsorted(ordered, ranges[:, 0]) < np.searchsorted(ordered, ranges[:, 1], side="right"))
