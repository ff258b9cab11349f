"""Bands of fibre laid on the surface: how many lie over any point, and what stays bare."""

from dataclasses import dataclass
from math import ceil, floor
from typing import NamedTuple

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import inner
from meshwind.core.vectors import TINY
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SV, S
from meshwind.surface.forms import area_elements
from meshwind.surface.grid import mean_speeds, midpoints, parameter_grid, rim_frames
from meshwind.surface.surface import Surface

_AT_ONCE = 500_000
"""Particles whose bands are laid at a time."""
_ACROSS = 6
"""Samples across a band, where they are not too many."""
_LEAST, _MOST = 64, 512
"""Fewest and most samples each way."""
_SPEED_SAMPLES = 32
"""Points each way from which the number of samples is chosen."""
_RIM_SAMPLES = 16
"""Samples of a rim per span, for the area that it encloses."""
_MARGIN = 1.5
"""Times the extent of a disc in u and v that is searched, as the metric changes within it."""
_SINGULAR = 1e-12
"""Least determinant of the metric over the product of its diagonal: s_u and s_v are parallel where it is less."""
_RIM = 1e-9
"""Closer to v=0 or v=1 than this a path ends on the rim."""
_MOST_PAST = 6.0
"""Half widths by which a band goes on past a rim at most: its edge reaches the rim at up to 80 degrees from square."""


@dataclass(frozen=True)
class Bands:
    """Layers of band over an even grid of points on the surface.

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

    __repr__ = brief

    def share(self, layers: int) -> float:
        """Share of the surface's area that lies under exactly `layers` layers."""
        return float(self.area[self.layers == layers].sum() / max(float(self.area.sum()), TINY))

    @property
    def bare(self) -> float:
        """Share of the surface without any band."""
        return self.share(0)

    @property
    def more(self) -> float:
        """Share of the surface under three bands or more."""
        return max(1.0 - sum((self.bare, self.share(1), self.share(2))), 0.0)

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
        """Areas at both ends that stay bare all around: each opening, with the bare rings next to it."""
        bare = (self.layers == 0).all(axis=0)
        ring = self.area.sum(axis=0)
        reach = [int(np.argmin(rows)) if not rows.all() else len(rows) for rows in (bare, bare[::-1])]
        start, end = float(ring[: reach[0]].sum()), float(ring[len(ring) - reach[1] :].sum())
        return self.openings[0] + start, self.openings[1] + end


def bands(paths: Paths, width: float, across: int = _ACROSS) -> Bands:
    """Lay a band of `width`, in the mesh's units, along every path and count the layers over points of the surface.

    A path that ends on a rim goes on past it, so that its band fills the corner there.  across: points across a band.
    """
    surface = paths.surface
    p, n = paths.gap.shape
    nu, nv = cells_for(surface, width, across)
    uv = parameter_grid(midpoints(nu), midpoints(nv))
    at = surface.frames(uv)
    area = area_elements(at).reshape(nu, nv) / (nu * nv)
    layers = np.zeros((nu, nv), dtype=np.int64)
    cells = Cells(np.ascontiguousarray(at[:, S]).reshape(nu, nv, 3), surface.periodic)
    many, length = max(1, _AT_ONCE // n), 0.0
    for first in range(0, p, many):  # the frames of all particles at once would take more than the paths themselves
        some = frozen(paths.uv[first : first + many])
        frames = surface.frames(some.reshape(-1, 2)).reshape(-1, n, 6, 3)
        feet = np.ascontiguousarray(frames[:, :, S])
        reach = _reach(frames[:, :, SU], frames[:, :, SV], 0.5 * width)
        _paint(Strips(some, feet, reach, _past_rims(some, frames), 0.5 * width), cells, layers)
        length += float(np.linalg.norm(np.diff(feet, axis=1), axis=2).sum())
    openings = tuple(_opening(surface, end) for end in (0.0, 1.0))
    return Bands(frozen(uv), frozen(area), frozen(layers), width, width * length, (openings[0], openings[1]))


def cells_for(surface: Surface, width: float, across: int = _ACROSS) -> tuple[int, int]:
    """Samples each way so that some lie across a band everywhere."""
    count = np.array(mean_speeds(surface, _SPEED_SAMPLES)) * across / max(width, TINY)
    nu, nv = np.clip(np.ceil(count), _LEAST, _MOST).astype(int)
    return int(nu), int(nv)


def _reach(su: Floats, sv: Floats, half: float) -> Floats:
    """How far in u and in v (p, n, 2) a disc of radius `half` in the tangent plane goes."""
    e, f, g = ((a * b).sum(axis=2) for a, b in ((su, su), (su, sv), (sv, sv)))
    square = np.maximum(e * g - f * f, _SINGULAR * e * g + TINY)
    return np.ascontiguousarray(np.stack([half * np.sqrt(g / square), half * np.sqrt(e / square)], axis=2))


def _past_rims(uv: Floats, frames: Floats) -> Floats:
    """Half widths (p, 2) by which a band goes on past its path's ends: the tangent of its angle to the rim's normal."""
    past = np.zeros((len(uv), 2))
    for end, step in ((0, 1), (-1, -2)):
        along, rim = frames[:, step, S] - frames[:, end, S], frames[:, end, SU]
        across = np.linalg.norm(np.cross(along, rim), axis=1)
        tangent = np.abs((along * rim).sum(axis=1)) / np.maximum(across, TINY)
        on_rim = np.abs(uv[:, end, 1] - 0.5) > 0.5 - _RIM
        past[:, end] = np.where(on_rim, np.minimum(tangent, _MOST_PAST), 0.0)
    return past


def _opening(surface: Surface, v: float) -> float:
    """Flat area that a rim encloses: the length of its vector area."""
    frames = rim_frames(surface, v, _RIM_SAMPLES)
    middle = frames[:, S].mean(axis=0)
    return float(0.5 * np.linalg.norm(np.cross(frames[:, S] - middle, frames[:, SU]).mean(axis=0)))


class Strips(NamedTuple):
    """Bands along p paths of n particles: uv (p, n, 2) and feet (p, n, 3) of the particles; half their width.

    reach (p, n, 2): extent in u and v of a disc of that radius; past (p, 2): half widths by which a band goes on past
    its ends.
    """

    uv: Floats
    feet: Floats
    reach: Floats
    past: Floats
    half: float


class Cells(NamedTuple):
    """The grid that is painted: the middles (nu, nv, 3) of its cells, and whether it closes in u."""

    points: Floats
    periodic: bool


class Segment(NamedTuple):
    """A band between two neighbouring feet, of the same half width all along.

    It goes from the plane through `start` square to `before` to that through start + along square to `after`, each
    moved outward by what the band goes on past a rim: a point x from `start` belongs to it if x . before >= low and
    (x - along) . after < high.  square = along . along.
    """

    start: Floats
    along: Floats
    before: Floats
    after: Floats
    square: float
    low: float
    high: float


class Window(NamedTuple):
    """Ranges of cells, each with its last: columns, which may be counted past a turn, and rows."""

    first: int
    last: int
    bottom: int
    top: int


@njit(nogil=True, cache=True)
def _paint(strips, cells, layers):
    """Add a layer at every point within half a width of a path's feet, once each time that the path passes it.

    The points between the planes square to the path at two neighbouring feet are those of the segment between: the
    planes part what belongs to one segment from what belongs to the next, also where the path bends.
    """
    p, n = strips.uv.shape[:2]
    for i in range(p):
        for k in range(n - 1):
            segment = _segment(strips, i, k)
            if segment.square > 0.0:
                _paint_segment(segment, _window(strips, i, k, cells), cells, strips.half, layers)


@njit(cache=True)
def _past(strips, i, k):
    """Half widths by which segment k of path i goes on before its first and after its last foot."""
    last = strips.uv.shape[1] - 2
    return strips.past[i, 0] if k == 0 else 0.0, strips.past[i, 1] if k == last else 0.0


@njit(cache=True)
def _segment(strips, i, k):
    """Segment k of path i."""
    feet, n = strips.feet[i], strips.feet.shape[1]
    start, end = feet[k], feet[k + 1]
    along, before, after = np.empty(3), np.empty(3), np.empty(3)
    for d in range(3):
        along[d], before[d] = end[d] - start[d], end[d] - feet[max(k - 1, 0), d]
        after[d] = feet[min(k + 2, n - 1), d] - start[d]
    square = inner(along, along)
    low, high = _past(strips, i, k)
    length = np.sqrt(square)
    return Segment(start, along, before, after, square, -low * strips.half * length, high * strips.half * length)


@njit(cache=True)
def _window(strips, i, k, cells):
    """The cells that segment k of path i can reach."""
    nu, nv = cells.points.shape[:2]
    low, high = _past(strips, i, k)
    wide = _MARGIN * (1.0 + max(low, high))
    uv, reach = strips.uv[i], strips.reach[i]
    ru = min(wide * max(reach[k, 0], reach[k + 1, 0]), 0.5)
    rv = wide * max(reach[k, 1], reach[k + 1, 1])
    first = ceil((min(uv[k, 0], uv[k + 1, 0]) - ru) * nu - 0.5)
    last = floor((max(uv[k, 0], uv[k + 1, 0]) + ru) * nu - 0.5)
    bottom = ceil((min(uv[k, 1], uv[k + 1, 1]) - rv) * nv - 0.5)
    top = floor((max(uv[k, 1], uv[k + 1, 1]) + rv) * nv - 0.5)
    last = min(last, first + nu - 1)
    if not cells.periodic:
        first, last = max(first, 0), min(last, nu - 1)
    return Window(first, last, max(bottom, 0), min(top, nv - 1))


@njit(cache=True)
def _paint_segment(segment, window, cells, half, layers):
    """Add a layer at every point of a window that a segment covers."""
    nu = len(layers)
    start, along, before, after = segment.start, segment.along, segment.before, segment.after
    for a in range(window.first, window.last + 1):
        for b in range(window.bottom, window.top + 1):
            point = cells.points[a % nu, b]
            x, y, z = point[0] - start[0], point[1] - start[1], point[2] - start[2]
            if x * before[0] + y * before[1] + z * before[2] < segment.low:
                continue
            ahead = (x - along[0]) * after[0] + (y - along[1]) * after[1] + (z - along[2]) * after[2]
            if ahead >= segment.high:
                continue
            t = (x * along[0] + y * along[1] + z * along[2]) / segment.square
            dx, dy, dz = x - t * along[0], y - t * along[1], z - t * along[2]
            if dx * dx + dy * dy + dz * dz <= half * half:
                layers[a % nu, b] += 1
