"""The fitted surface as shell elements: a grid of quads, or the quad mesh on the crossings."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument, called
from meshwind.layup.quads import edge_counts
from meshwind.results.reading import Results
from meshwind.results.schema import QUADS, UV
from meshwind.results.vtk_reading import read_faces
from meshwind.surface.forms import area_elements, fundamental_forms
from meshwind.surface.grid import grid_quads, midpoints, parameter_grid
from meshwind.surface.principal import principal
from meshwind.surface.surface import Surface

_FEWEST = 12, 4
"""Least number of elements around and along."""
_ON_RIM = 1e-9
_SAMPLES = 4
"""Samples each way in an element: about as fine as the thickness of a laminate varies."""


@dataclass(frozen=True)
class Elements:
    """Quads (q, 4) and triangles (t, 3) between points (n, 3) on a surface at uv (n, 2); q + t = k elements.

    Corners run counterclockwise seen from outside; centre (k, 2) is each element's middle in uv, quads first.  skin is
    the inside of the part with the same parameters: the surface itself, or what a laminate lies on.
    """

    surface: Surface
    skin: Surface
    uv: Floats
    points: Floats
    quads: Ints
    triangles: Ints
    centre: Floats

    def __len__(self) -> int:
        return len(self.quads) + len(self.triangles)

    @property
    def rims(self) -> tuple[Ints, Ints]:
        """Numbers of the points on the start rim (v=0) and on the end rim (v=1)."""
        v = self.uv[:, 1]
        return np.flatnonzero(v < _ON_RIM), np.flatnonzero(v > 1.0 - _ON_RIM)

    @property
    def edges(self) -> Ints:
        """All edges (e, 2), each once with the lower number first."""
        return edge_counts(self.quads, self.triangles)[0]

    def samples(self, surface: Surface | None = None) -> tuple[Floats, Floats]:
        """Points in uv (k, m, 2) all over each element, and the area (k, m) around each, whose sum is the element's.

        With another surface of the same parameters, the area there.
        """
        corners = [self.uv[self.quads], self.uv[self.triangles[:, [0, 1, 2, 2]]]]
        unrolled = np.concatenate([_unrolled(self.surface, each) for each in corners])
        x, y = parameter_grid(midpoints(_SAMPLES), midpoints(_SAMPLES)).T
        shape = np.stack([(1 - x) * (1 - y), x * (1 - y), x * y, (1 - x) * y], axis=1)
        along_x = np.stack([y - 1, 1 - y, y, -y], axis=1)
        along_y = np.stack([x - 1, -x, x, 1 - x], axis=1)
        at, by_x, by_y = (np.einsum("mc,kcd->kmd", each, unrolled) for each in (shape, along_x, along_y))
        density = area_elements((surface or self.surface).frames(at.reshape(-1, 2))).reshape(at.shape[:2])
        cell = np.abs(by_x[..., 0] * by_y[..., 1] - by_x[..., 1] * by_y[..., 0]) / len(x)
        return at, cell * density

    @property
    def pressed(self) -> Floats:
        """Area (k,) of each element on the skin that pressure acts on, over its own."""
        if self.skin is self.surface:
            return np.ones(len(self))
        return np.asarray(self.samples(self.skin)[1].sum(axis=1) / self.samples()[1].sum(axis=1))

    def offset(self, depth: Floats) -> Floats:
        """Area (k,) of each element, moved by a depth (k,) along its inward normal, over its own."""
        frames = self.surface.frames(self.centre)
        bend = principal(frames, fundamental_forms(frames))
        return np.asarray((1.0 - depth * bend.largest) * (1.0 - depth * bend.smallest))

    def between(self, edges: Ints) -> Floats:
        """Midpoints in uv (e, 2) of edges (e, 2), by the shorter way around."""
        return middle(self.surface, self.uv[edges])


def middle(surface: Surface, corners: Floats) -> Floats:
    """Means (k, 2) of corners (k, c, 2) in uv; around a closed part by the shorter way."""
    return np.asarray(_unrolled(surface, corners).mean(axis=1))


def _unrolled(surface: Surface, corners: Floats) -> Floats:
    """The corners (k, c, 2) in uv, each at most half a turn from the first."""
    away = corners - corners[:, :1]
    if surface.periodic:
        away[..., 0] -= np.round(away[..., 0])
    return np.asarray(corners[:, :1] + away)


def regular(surface: Surface, count: int, skin: Surface | None = None) -> Elements:
    """About `count` quads, square on average; skin: the inside of the part, by default the surface."""
    t = (np.arange(16) + 0.5) / 16
    frames = surface.frames(np.stack(np.meshgrid(t, t, indexing="ij"), axis=2).reshape(-1, 2))
    around, along = np.linalg.norm(frames[:, 1:3], axis=2).mean(axis=0)
    nu = max(round(float(np.sqrt(count * around / max(along, 1e-300)))), _FEWEST[0])
    nv = max(round(count / nu), _FEWEST[1])
    columns = nu if surface.periodic else nu + 1
    u, v = np.arange(columns) / nu, np.linspace(0.0, 1.0, nv + 1)
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)
    quads = grid_quads(columns, nv + 1, surface.periodic)
    return _elements((surface, skin or surface), uv, quads, np.zeros((0, 3), dtype=np.int64))


def on_crossings(results: Results, surface: Surface | None = None) -> Elements:
    """The run's quad mesh with its points on a surface, by default that of the part, which is the skin.

    Raises BadInputError if it has no faces.
    """
    mesh = read_faces(results.folder / QUADS)
    if not len(mesh.quads) + len(mesh.triangles) or UV not in mesh.point_data:
        raise BadInputError(f"{QUADS} of {results.folder} has no faces; take the grid: {argument('shell', 'grid')}")
    used, corner = np.unique(np.concatenate([mesh.quads.ravel(), mesh.triangles.ravel()]), return_inverse=True)
    split = mesh.quads.size
    uv = mesh.point_data[UV][used].astype(np.float64)
    if uv.ndim != 2 or not (np.isfinite(uv).all() and np.abs(uv).max() < 1e6):
        raise BadInputError(f"{QUADS} of {results.folder} is damaged; run {called('wind')} again")
    both = surface or results.surface, results.surface
    return _elements(both, uv, corner[:split].reshape(-1, 4), corner[split:].reshape(-1, 3))


def _elements(both: tuple[Surface, Surface], uv: Floats, quads: Ints, triangles: Ints) -> Elements:
    """Elements on a surface, with its skin."""
    surface, skin = both
    centre = np.concatenate([middle(surface, uv[quads]), middle(surface, uv[triangles])])
    points = surface.points(uv)
    return Elements(surface, skin, *map(frozen, (uv, points, quads, triangles, centre)))
