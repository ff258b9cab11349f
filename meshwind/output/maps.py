"""The fitted surface as a quad grid, and the maps on it."""

from dataclasses import dataclass

import igl
import numpy as np

from meshwind.cast import Floats, Ints, frozen
from meshwind.layup.layup import Layup
from meshwind.output.winding_angle import winding_angle
from meshwind.surface.surface import Surface

_PER_SPAN = 4
_MOST = 200
_FLAT = 1e-3
"""Curvature times the part's size below which a direction counts as flat: a sag of 1e-4 of the part."""


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


def principal_curvatures(frames: Floats) -> tuple[Floats, Floats, Floats]:
    """Outward unit normals (k, 3) and the larger and smaller principal curvature (k,) of frames (k, 6, 3).

    Positive where the surface bulges outward, so that a taut fibre presses.
    """
    _, su, sv, suu, suv, svv = np.moveaxis(frames, 1, 0)
    normal = np.cross(su, sv)
    size = np.linalg.norm(normal, axis=1, keepdims=True)
    normal = np.divide(normal, size, out=np.zeros_like(normal), where=size > 0.0)
    e, f, g = ((a * b).sum(axis=1) for a, b in ((su, su), (su, sv), (sv, sv)))
    l, m, n = (-(second * normal).sum(axis=1) for second in (suu, suv, svv))
    area = size[:, 0] ** 2
    safe = np.where(area > 0.0, area, np.inf)  # a collapsed point counts as flat
    mean = 0.5 * (e * n - 2.0 * f * m + g * l) / safe
    gauss = (l * n - m * m) / safe
    root = np.sqrt(np.maximum(mean * mean - gauss, 0.0))
    return normal, mean + root, mean - root


def windability(k1: Floats, k2: Floats, flat: float) -> Floats:
    """Share of the tangent directions in which a taut fibre presses, from principal curvatures k1 >= k2.

    1 where convex, 0 where concave; curvatures down to -flat count as convex.
    """
    pressing = 2.0 / np.pi * np.arctan2(np.sqrt(np.maximum(k1, 0.0)), np.sqrt(np.maximum(-k2, 0.0)))
    return np.where(k2 >= -flat, 1.0, pressing)


def maps(on: Grid, layup: Layup, fit_error: Floats | None = None) -> dict[str, Floats]:
    """Point data of surface.vtu; fit_error (k,) is the distance of each of the grid's points to the mesh."""
    normal, k1, k2 = principal_curvatures(on.frames)
    flat = _FLAT / on.surface.size
    kind = np.where(k2 >= -flat, 1, np.where(k1 <= flat, -1, 0))
    data = {
        "uv": on.uv,
        "normal": normal,
        "gaussian_curvature": k1 * k2,
        "mean_curvature": 0.5 * (k1 + k2),
        "windability": windability(k1, k2, flat),
        "class": kind,
        "angle": np.degrees(winding_angle(layup.paths, *on.shape)).ravel(),
        "coverage": layup.coverage.at(on.uv),
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
