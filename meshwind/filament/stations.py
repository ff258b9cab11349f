"""Winding angle and cover of paths by station: on level lines from rim to rim."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.filament.hoop import Hoop
from meshwind.filament.levels import Levels
from meshwind.path.paths import Paths
from meshwind.path.winding_angle import winding_angle

STATIONS = 65
"""Level lines, evenly spaced in v, on which figures along the part are given."""


@dataclass(frozen=True)
class Stations:
    """Figures of a layer on level lines v (k,); NaN where the layer is not.

    Attributes
    ----------
    v : ndarray of float, shape (k,)
        Of the lines.
    height : ndarray of float, shape (k,)
        Coordinate of each along the part's axis, as `Levels.height`.
    angle : ndarray of float, shape (k,)
        Median winding angle in radians, from the normal of the level line in the surface: 0 along the part, pi/2 hoop.
    cover : ndarray of float, shape (k,)
        Cover factor: 1 where one family's bands, or the hoop's turns of one pass, lie edge to edge on average.
    """

    v: Floats
    height: Floats
    angle: Floats
    cover: Floats

    @property
    def angles(self) -> tuple[float, float, float]:
        """Least, median and largest angle over the stations where the layer is, in radians."""
        here = self.angle[np.isfinite(self.angle)]
        return float(here.min()), float(np.median(here)), float(here.max())

    @property
    def covers(self) -> tuple[float, float]:
        """Least and largest cover factor over the stations where the layer is."""
        here = self.cover[np.isfinite(self.cover)]
        return float(here.min()), float(here.max())


def angles_at(paths: Paths, v: Floats) -> Floats:
    """Winding angles (p, k) of paths where they pass level lines v (k,), in radians; NaN where one does not.

    Where a path passes a line several times it is the first time.
    """
    p, angle = len(paths), winding_angle(paths)
    height = np.maximum.accumulate(paths.uv[..., 1], axis=1)
    apart = 3.0 * np.arange(p)[:, None]  # v is in [0, 1]: one row of all paths, on which they do not meet
    found = np.interp(np.clip(v, -1.0, 2.0)[None] + apart, (height + apart).ravel(), angle.ravel())
    passed = (v[None] >= height[:, :1] - 1e-12) & (v[None] <= height[:, -1:] + 1e-12)
    return np.asarray(np.where(passed, found, np.nan))


def helix_stations(paths: Paths, lines: Levels, width: float) -> Stations:
    """Stations of a helical layer: paths of both families, with a band of a width."""
    v = np.linspace(0.0, 1.0, STATIONS)
    angle = angles_at(paths, v)
    here = np.isfinite(angle).any(axis=0)
    median, cosine = np.full(STATIONS, np.nan), np.full(STATIONS, np.nan)
    median[here] = np.nanmedian(angle[:, here], axis=0)
    cosine[here] = np.nanmean(np.cos(angle[:, here]), axis=0)
    families = max(len(np.unique(paths.family)), 1)
    square = np.interp(v, lines.v, lines.length) * cosine  # what one family has to cover
    cover = np.divide(len(paths) / families * width, square, out=np.full(STATIONS, np.inf), where=square > 0.0)
    return Stations(
        frozen(v), frozen(np.interp(v, lines.v, lines.height)), frozen(median), frozen(np.where(here, cover, np.nan))
    )  # fmt: skip


def hoop_stations(laid: Hoop, lines: Levels, width: float) -> Stations:
    """Stations of a hoop layer: between its first and last turn."""
    v = np.linspace(0.0, 1.0, STATIONS)
    along = laid.tracks.uv[0, :, 1]
    order = np.argsort(along, kind="stable")
    here = (v >= along.min()) & (v <= along.max())
    angle = np.interp(v, along[order], laid.course.angle[order])
    apart = lines.apart.mean(axis=1) / lines.apart.max(axis=1) * laid.pitch
    cover = width / np.interp(v, lines.v, apart)
    return Stations(
        frozen(v), frozen(np.interp(v, lines.v, lines.height)), frozen(np.where(here, angle, np.nan)),
        frozen(np.where(here, cover, np.nan)),
    )  # fmt: skip


def circuits_to_cover(paths: Paths, lines: Levels, width: float) -> int:
    """Paths a family that cover the part: the largest over v of (length of the level times mean cosine) over width."""
    cover = helix_stations(paths, lines, width).covers[0]
    families = max(len(np.unique(paths.family)), 1)
    return max(int(np.ceil(len(paths) / families / cover - _SLACK)), 1)


_SLACK = 1e-6
"""A band that is too narrow by less than this share of one circuit covers all the same."""
