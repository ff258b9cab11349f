"""The winding angle of fibres: from the direction along the part, which is square to the level lines of v."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import unit
from meshwind.path.kernels import heading
from meshwind.path.kernels.heading import ALONG, ANGLE, AROUND
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
    return np.ascontiguousarray(_headings(paths)[..., ANGLE])


def axes(surface: Surface, uv: Floats) -> tuple[Floats, Floats, Floats]:
    """Unit vectors (k, 3) at uv (k, 2): along the part, around it, and the outward normal.

    Around is along the level line of v, towards s_u; along is square to it in the surface, towards s_v.
    """
    return _axes(surface.frames(uv))


def headings(paths: Paths) -> tuple[Floats, Floats]:
    """Components (p n,) of the fibres' directions along the part and around it, at the particles or their feet."""
    made = _headings(paths).reshape(-1, 3)
    return made[:, ALONG], made[:, AROUND]


def _headings(paths: Paths) -> Floats:
    """Directions (p, n, 3) of the fibres, as the columns of `kernels.heading` have them."""
    out = np.empty_like(paths.points)
    parallel_for(heading.headings, len(paths), 1, paths.surface.spline, paths.uv, paths.points, paths.on_surface, out)
    return out


def _axes(frames: Floats) -> tuple[Floats, Floats, Floats]:
    """The unit vectors of `axes` by frames (k, 6, 3)."""
    around, normal = unit(frames[:, SU]), unit(np.cross(frames[:, SU], frames[:, SV]))
    return np.cross(normal, around), around, normal
