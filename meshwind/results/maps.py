"""The fitted surface as a quad grid, and the maps on it."""

from dataclasses import dataclass

import igl
import numpy as np

from meshwind.core.cast import Floats, Ints, frozen
from meshwind.layup.layup import Layup
from meshwind.layup.windability import FLAT, of_frames
from meshwind.results.winding_angle import winding_angle
from meshwind.surface.surface import Surface

_PER_SPAN = 4
_MOST = 200


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

    @property
    def points(self) -> Floats:
        """Positions (k, 3)."""
        return np.ascontiguousarray(self.frames[:, 0])


def grid(surface: Surface, per_span: int = _PER_SPAN, most: int = _MOST) -> Grid:
    """Sample a surface so many times a span, at most `most` x `most` times."""
    around, along = surface.spans
    nu = min(per_span * around + (not surface.periodic), most)
    nv = min(per_span * along + 1, most)
    u = np.arange(nu) / (nu if surface.periodic else nu - 1)
    v = np.linspace(0.0, 1.0, nv)
    uv = np.stack(np.meshgrid(u, v, indexing="ij"), axis=2).reshape(-1, 2)
    number = np.arange(nu * nv).reshape(nu, nv)
    if surface.periodic:
        number = np.concatenate([number, number[:1]])
    corners = [number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]]
    quads = np.stack(corners, axis=2).reshape(-1, 4)
    return Grid(surface, (nu, nv), frozen(uv), frozen(surface.frames(uv)), frozen(quads))


def maps(on: Grid, layup: Layup, fit_error: Floats | None = None) -> dict[str, Floats]:
    """Point data of surface.vtu; fit_error (k,) is the distance of each of the grid's points to the mesh."""
    press = of_frames(on.frames, FLAT / on.surface.size)
    data = {
        "uv": on.uv,
        "normal": press.normal,
        "gaussian_curvature": press.largest * press.smallest,
        "mean_curvature": 0.5 * (press.largest + press.smallest),
        "windability": press.share,
        "class": press.kind,
        "press_direction": press.direction,
        "press_reach": np.degrees(press.reach),
        "angle": np.degrees(winding_angle(layup.paths, *on.shape)).ravel(),
        "coverage": layup.coverage.at(on.uv),
        "layers": layup.bands.at(on.uv),
        "stretch": _stretch(on),
    }
    return data if fit_error is None else data | {"fit_error": fit_error}


def _stretch(on: Grid) -> Floats:
    """Area scale from the plane to the part at each point, over its mean: how far the chart squeezes it."""
    scale = np.linalg.norm(np.cross(on.frames[:, 1], on.frames[:, 2]), axis=1)
    return np.asarray(scale / scale.mean())


def distance_to_mesh(points: Floats, vertices: Floats, faces: Ints) -> Floats:
    """Distances (k,) of points (k, 3) to the triangles of a mesh, in its units."""
    squared = igl.point_mesh_squared_distance(np.array(points), np.array(vertices), np.array(faces))[0]
    return np.asarray(np.sqrt(squared))
