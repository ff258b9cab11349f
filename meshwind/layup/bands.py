"""Bands of fibre laid on the surface: how many lie over any point, and what stays bare."""

from dataclasses import dataclass

import numpy as np
from numba import njit

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.path.paths import Paths
from meshwind.surface.surface import Surface

_ACROSS = 6
"""Samples across a band, where they are not too many."""
_LEAST, _MOST = 64, 512
"""Fewest and most samples each way."""
_RIM = 1e-9
"""Closer to v=0 or v=1 than this a path ends on the rim."""
_MOST_PAST = 6.0
"""So many half widths at most a band goes on past a rim: its edge reaches the rim at up to 80 degrees from square."""


@dataclass(frozen=True)
class Bands:
    """Layers of band over an even grid of points of the surface.

    uv (nu nv, 2), u slowest: the middles of the grid's cells; area (nu, nv) of the cells; layers (nu, nv): bands over
    each middle; width of the band; footprint: length of the fibres on the surface, bridges at their feet, times the
    width; openings: the flat areas of the two rims, which no band covers.
    """

    uv: Floats
    area: Floats
    layers: Ints
    width: float
    footprint: float
    openings: tuple[float, float]

    def share(self, layers: int) -> float:
        """Share of the surface's area that lies under just so many layers."""
        return float(self.area[self.layers == layers].sum() / max(float(self.area.sum()), 1e-300))

    @property
    def bare(self) -> float:
        """Share of the surface without any band."""
        return self.share(0)

    def at(self, uv: Floats) -> Ints:
        """Layers at uv (n, 2): those over the middle of the cell that each is in."""
        nu, nv = self.layers.shape
        i = np.floor(np.mod(uv[:, 0], 1.0) * nu).astype(np.int64) % nu
        return np.asarray(self.layers[i, np.clip((uv[:, 1] * nv).astype(np.int64), 0, nv - 1)])

    @property
    def balance(self) -> float:
        """The integral of the layers over the footprint: 1 but for what hangs over a rim."""
        return float((self.layers * self.area).sum()) / self.footprint if self.footprint > 0.0 else 1.0

    @property
    def caps(self) -> tuple[float, float]:
        """Areas at both ends that stay bare all around: the openings, and the rings next to them without a band."""
        bare = (self.layers == 0).all(axis=0)
        ring = self.area.sum(axis=0)
        reach = [int(np.argmin(rows)) if not rows.all() else len(rows) for rows in (bare, bare[::-1])]
        start, end = float(ring[: reach[0]].sum()), float(ring[len(ring) - reach[1] :].sum())
        return self.openings[0] + start, self.openings[1] + end


def bands(paths: Paths, width: float) -> Bands:
    """Lay a band of `width`, in the mesh's units, along every path and count the layers over points of the surface.

    A path that ends on a rim goes on past it, so that its band fills the corner there.
    """
    surface = paths.surface
    p, n = paths.gap.shape
    frames = surface.frames(paths.uv.reshape(-1, 2)).reshape(p, n, 6, 3)
    feet = np.ascontiguousarray(frames[:, :, 0])
    nu, nv = _grid(surface, width)
    u, v = (np.arange(nu) + 0.5) / nu, (np.arange(nv) + 0.5) / nv
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)
    at = surface.frames(uv)
    area = np.linalg.norm(np.cross(at[:, 1], at[:, 2]), axis=1).reshape(nu, nv) / (nu * nv)
    layers = np.zeros((nu, nv), dtype=np.int64)
    points = np.ascontiguousarray(at[:, 0]).reshape(nu, nv, 3)
    reach = _reach(frames[:, :, 1], frames[:, :, 2], 0.5 * width)
    _paint(paths.uv, feet, reach, _past_rims(paths.uv, frames), points, 0.5 * width, surface.periodic, layers)
    length = float(np.linalg.norm(np.diff(feet, axis=1), axis=2).sum())
    openings = tuple(_opening(surface, end) for end in (0.0, 1.0))
    return Bands(frozen(uv), frozen(area), frozen(layers), width, width * length, (openings[0], openings[1]))


def _grid(surface: Surface, width: float) -> tuple[int, int]:
    """Samples each way so that some lie across a band everywhere."""
    t = (np.arange(32) + 0.5) / 32
    frames = surface.frames(np.stack(np.meshgrid(t, t, indexing="ij"), axis=2).reshape(-1, 2))
    around, along = np.linalg.norm(frames[:, 1:3], axis=2).mean(axis=0)
    count = np.array([around, along]) * _ACROSS / max(width, 1e-300)
    nu, nv = np.clip(np.ceil(count), _LEAST, _MOST).astype(int)
    return int(nu), int(nv)


def _reach(su: Floats, sv: Floats, half: float) -> Floats:
    """How far in u and in v (p, n, 2) a disc of radius `half` in the tangent plane goes."""
    e, f, g = ((a * b).sum(axis=2) for a, b in ((su, su), (su, sv), (sv, sv)))
    square = np.maximum(e * g - f * f, 1e-12 * e * g + 1e-300)
    return np.ascontiguousarray(np.stack([half * np.sqrt(g / square), half * np.sqrt(e / square)], axis=2))


def _past_rims(uv: Floats, frames: Floats) -> Floats:
    """Half widths (p, 2) by which a band goes on past its path's ends: the tangent of its angle to the rim's normal."""
    past = np.zeros((len(uv), 2))
    for end, step in ((0, 1), (-1, -2)):
        along, rim = frames[:, step, 0] - frames[:, end, 0], frames[:, end, 1]
        across = np.linalg.norm(np.cross(along, rim), axis=1)
        tangent = np.abs((along * rim).sum(axis=1)) / np.maximum(across, 1e-300)
        on_rim = np.abs(uv[:, end, 1] - 0.5) > 0.5 - _RIM
        past[:, end] = np.where(on_rim, np.minimum(tangent, _MOST_PAST), 0.0)
    return past


def _opening(surface: Surface, v: float) -> float:
    """Flat area that a rim encloses: the length of its vector area."""
    u = np.arange(16 * surface.spans[0]) / (16 * surface.spans[0])
    frames = surface.frames(np.stack([u, np.full_like(u, v)], axis=1))
    middle = frames[:, 0].mean(axis=0)
    return float(0.5 * np.linalg.norm(np.cross(frames[:, 0] - middle, frames[:, 1]).mean(axis=0)))


@njit(cache=True)
def _paint(uv, feet, reach, past, points, half, periodic, layers):
    """Add a layer at every point within `half` of a path's feet, once each time that the path passes it.

    The points between the planes square to the path at two neighbouring feet are those of the segment between: the
    planes part what belongs to one segment from what belongs to the next, also where the path bends.
    """
    nu, nv = layers.shape
    p, n = uv.shape[:2]
    for i in range(p):
        for k in range(n - 1):
            start, end = feet[i, k], feet[i, k + 1]
            along = end - start
            square = (along * along).sum()
            if square == 0.0:
                continue
            before = end - feet[i, max(k - 1, 0)]
            after = feet[i, min(k + 2, n - 1)] - start
            low, high = -past[i, 0] * half if k == 0 else 0.0, past[i, 1] * half if k == n - 2 else 0.0
            wide = 1.0 + max(-low, high) / half
            low, high = low * np.sqrt(square), high * np.sqrt(square)
            ru = 1.5 * wide * max(reach[i, k, 0], reach[i, k + 1, 0])
            rv = 1.5 * wide * max(reach[i, k, 1], reach[i, k + 1, 1])
            ru = min(ru, 0.5)
            u0, u1 = min(uv[i, k, 0], uv[i, k + 1, 0]) - ru, max(uv[i, k, 0], uv[i, k + 1, 0]) + ru
            v0, v1 = min(uv[i, k, 1], uv[i, k + 1, 1]) - rv, max(uv[i, k, 1], uv[i, k + 1, 1]) + rv
            first, last = int(np.ceil(u0 * nu - 0.5)), int(np.floor(u1 * nu - 0.5))
            last = min(last, first + nu - 1)
            if not periodic:
                first, last = max(first, 0), min(last, nu - 1)
            bottom, top = max(int(np.ceil(v0 * nv - 0.5)), 0), min(int(np.floor(v1 * nv - 0.5)), nv - 1)
            for a in range(first, last + 1):
                for b in range(bottom, top + 1):
                    x = points[a % nu, b, 0] - start[0]
                    y = points[a % nu, b, 1] - start[1]
                    z = points[a % nu, b, 2] - start[2]
                    if x * before[0] + y * before[1] + z * before[2] < low:
                        continue
                    ahead = (x - along[0]) * after[0] + (y - along[1]) * after[1] + (z - along[2]) * after[2]
                    if ahead >= high:
                        continue
                    t = (x * along[0] + y * along[1] + z * along[2]) / square
                    dx, dy, dz = x - t * along[0], y - t * along[1], z - t * along[2]
                    if dx * dx + dy * dy + dz * dz <= half * half:
                        layers[a % nu, b] += 1
