"""The winding angle of fibres: from the direction along the part, which is square to the level lines of v."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.vectors import TINY, unit
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.surface import Surface


def winding_angle(paths: Paths) -> Floats:
    """Angle of each fibre from the plane square to the level line of v: on the surface, from the level line's normal.

    This is the one definition of it: maps, stations and filaments have the same.

    Parameters
    ----------
    paths : Paths
        Paths; where one is in the air, the surface is that at its foot.

    Returns
    -------
    ndarray of float, shape (p, n)
        Angles in radians, from 0, along the part, to pi/2, a hoop.
    """
    frames = _frames(paths)
    way, around = _directions(paths, frames), frames[:, SU]
    size = np.sqrt(np.einsum("ij,ij->i", way, way) * np.einsum("ij,ij->i", around, around))
    share = np.abs(np.einsum("ij,ij->i", way, around)) / np.maximum(size, TINY)
    return np.asarray(np.arcsin(np.minimum(share, 1.0)).reshape(paths.gap.shape))


def axes(surface: Surface, uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Unit vectors (k, 3) at uv (k, 2): along the part, around it, and the outward normal.

    Around is along the level line of v, towards s_u; along is square to it in the surface, towards s_v.
    """
    return _axes(surface.frames(uv))


def headings(paths: Paths) -> tuple[Floats, Floats]:
    """Components (p n,) of the fibres' directions along the part and around it, at the particles or their feet."""
    frames = _frames(paths)
    way = _directions(paths, frames)
    along, around, _ = _axes(frames)
    return (way * along).sum(axis=1), (way * around).sum(axis=1)


def _frames(paths: Paths) -> Floats:
    """The surface's frames (p n, 6, 3) at the particles or their feet."""
    return paths.surface.frames(np.ascontiguousarray(paths.uv.reshape(-1, 2)))


def _directions(paths: Paths, frames: Floats) -> Floats:
    """Directions (p n, 3) of the fibres, of any length.

    On the surface they are taken by the parameters, as chords of many turns cut their corners; in the air from the
    fibre itself.
    """
    rate, lifted = _gradient(paths.uv), ~paths.on_surface.ravel()
    way = frames[:, SU] * rate[:, :1] + frames[:, SV] * rate[:, 1:]
    if lifted.any():
        way[lifted] = _gradient(paths.points)[lifted]
    return np.asarray(way)


def _gradient(values: Floats) -> Floats:
    """Change (p n, m) of values (p, n, m) from particle to particle, as central differences."""
    rate = np.gradient(values, axis=1, edge_order=2 if values.shape[1] > 2 else 1)
    return np.asarray(rate).reshape(-1, values.shape[2])


def _axes(frames: Floats) -> tuple[Floats, Floats, Floats]:
    """The unit vectors of `axes` by frames (k, 6, 3)."""
    around, normal = unit(frames[:, SU]), unit(np.cross(frames[:, SU], frames[:, SV]))
    return np.cross(normal, around), around, normal
