"""Winding angle and cover of paths by station: on level lines from rim to rim."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import PchipInterpolator

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.filament.hoop import Hoop
from meshwind.filament.levels import Levels
from meshwind.path.paths import Paths
from meshwind.path.winding_angle import winding_angle
from meshwind.surface.evaluate import SU
from meshwind.surface.grid import rings
from meshwind.surface.rims import rim

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
        Cover factor: 1 where the bands of the family that covers less, or the hoop's turns of one pass, lie edge to
        edge on average.
    least, most : ndarray of float, shape (k,)
        Smallest and largest winding angle over the paths, in radians.
    """

    v: Floats
    height: Floats
    angle: Floats
    cover: Floats
    least: Floats
    most: Floats

    __repr__ = brief

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
    return _passing(paths, winding_angle(paths), v)


def _passing(paths: Paths, values: Floats, v: Floats) -> Floats:
    """Values (p, k) of paths, known at particles (p, n), where they first pass level lines v (k,); NaN where not."""
    height = np.maximum.accumulate(paths.uv[..., 1], axis=1)
    apart = 3.0 * np.arange(len(paths))[:, None]  # v is in [0, 1]: one row of all paths, on which they do not meet
    found = np.interp(np.clip(v, -1.0, 2.0)[None] + apart, (height + apart).ravel(), values.ravel())
    passed = (v[None] >= height[:, :1] - 1e-12) & (v[None] <= height[:, -1:] + 1e-12)
    return np.asarray(np.where(passed, found, np.nan))


def wound_angle(paths: Paths, v: float) -> float:
    """Median winding angle in radians, on the level line v, of the paths that pass it; NaN where none does."""
    found = angles_at(paths, np.array([v]))
    return float(np.nanmedian(found)) if np.isfinite(found).any() else np.nan


def median_angle(paths: Paths, v: float, count: int, phase: float = 0.0) -> float:
    """Median winding angle in radians, on the level line v, of `count` paths a family, spread and ahead as `families`.

    It is that of a smooth function of where paths start through those that are known: with the revolutions it changes
    evenly, where the median of a few leaps from one path to the next.  NaN where none passes.
    """
    found, start = angles_at(paths, np.array([v]))[:, 0], paths.uv[:, 0]
    shares, line, medians = np.arange(count) / count, rim(paths.surface, float(start[0, 1])), []
    for family, ahead in ((1, 0.0), (-1, phase)):
        mine = (paths.family == family) & np.isfinite(found)
        if mine.any():
            medians.append(_around(start[mine, 0], found[mine], np.mod(line.parameters(shares + ahead), 1.0)))
    return float(np.median(np.concatenate(medians))) if medians else np.nan


def to_cover(paths: Paths, v: Floats) -> tuple[Floats, Ints]:
    """What each of f families has to cover (f, k) on level lines v (k,), and its number of paths (f,).

    It is the integral of the cosine of the winding angle along the line, a smooth function through its values at the
    paths; NaN where none passes.
    """
    surface, families = paths.surface, np.unique(paths.family)
    angle, u = angles_at(paths, v), _passing(paths, paths.uv[..., 0], v)
    many = _AROUND * surface.spans[0]
    around = np.arange(many) / many
    speed = np.linalg.norm(rings(surface, v, many)[:, :, SU], axis=2)
    needed = np.full((len(families), len(v)), np.nan)
    for row, family in enumerate(families):
        mine = paths.family == family
        passed = np.isfinite(angle[mine])
        here = np.flatnonzero(passed.any(axis=0))
        of, line = np.nonzero(passed[:, here])
        cosine = np.cos(angle[mine][:, here][of, line])
        found = _around(u[mine][:, here][of, line], cosine, around, line).reshape(len(here), many)
        needed[row, here] = (found * speed[here]).mean(axis=1)
    return needed, np.array([(paths.family == family).sum() for family in families], dtype=np.int64)


def _around(u: Floats, values: Floats, at: Floats, line: Ints | None = None) -> Floats:
    """Values (m,) at `at`, from values (p,) at u in turns, smooth without overshoot and with the period 1.

    line: the numbers (p,) of lines that the values belong to, for values (k m,) on all k of them, one after another.
    """
    line = np.zeros(len(u), dtype=np.int64) if line is None else line
    place = np.mod(u, 1.0)
    order = np.lexsort([place, line])
    place, line, values = place[order], line[order], values[order]
    first = np.append(True, (np.diff(place) != 0.0) | (np.diff(line) != 0))
    place, line, values = place[first], line[first], values[first]
    # one row of all lines, each with two periods more on either side, so that they do not feel one another
    start = (len(_PERIODS) + 1.0) * line
    row = (start + place + np.array(_PERIODS)[:, None]).ravel()
    order = np.argsort(row)
    wanted = ((len(_PERIODS) + 1.0) * np.unique(line)[:, None] + at).ravel()
    return np.asarray(PchipInterpolator(row[order], np.tile(values, len(_PERIODS))[order])(wanted))


def covers(paths: Paths, v: Floats, width: float) -> Floats:
    """Cover factors (k,) on level lines v (k,) of the family that covers less; NaN where no path passes."""
    needed, many = to_cover(paths, v)
    laid = width * many[:, None]
    cover = np.divide(laid, needed, out=np.full(needed.shape, np.inf), where=needed > 0.0)
    return np.asarray(np.where(np.isnan(needed), np.nan, cover).min(axis=0))


def helix_stations(paths: Paths, lines: Levels, width: float) -> Stations:
    """Stations of a helical layer: paths of both families, with a band of a width."""
    v = np.linspace(0.0, 1.0, STATIONS)
    angle = angles_at(paths, v)
    here = np.isfinite(angle).any(axis=0)
    spread = np.full((3, STATIONS), np.nan)
    spread[:, here] = np.nanquantile(angle[:, here], [0.0, 0.5, 1.0], axis=0)
    height = np.interp(v, lines.v, lines.height)
    least, median, most = spread
    return Stations(*map(frozen, (v, height, median, covers(paths, v, width), least, most)))


def hoop_stations(laid: Hoop, lines: Levels, width: float) -> Stations:
    """Stations of a hoop layer: between its first and last turn."""
    v = np.linspace(0.0, 1.0, STATIONS)
    along = laid.tracks.uv[0, :, 1]
    order = np.argsort(along, kind="stable")
    here = (v >= along.min()) & (v <= along.max())
    angle = np.interp(v, along[order], laid.course.angle[order])
    apart = lines.apart.mean(axis=1) / lines.apart.max(axis=1) * laid.pitch
    cover = width / np.interp(v, lines.v, apart)
    height = np.interp(v, lines.v, lines.height)
    angle, cover = np.where(here, angle, np.nan), np.where(here, cover, np.nan)
    return Stations(*map(frozen, (v, height, angle, cover, angle, angle)))


def circuits_to_cover(paths: Paths, lines: Levels, width: float) -> int:
    """Paths of each family with which the bands of both cover the part on every level line, at the angles of these."""
    needed, _ = to_cover(paths, lines.v)
    return max(int(np.ceil(np.nanmax(needed) / width * (1.0 - COVERED))), 1)


COVERED = 1e-6
"""Bands that are too narrow by less than this share cover all the same."""
_PERIODS = (-2.0, -1.0, 0.0, 1.0, 2.0)
"""Turns by which values around a line are repeated."""
_AROUND = 4
"""Points around a level line for each span of the surface, between which the integral is a sum."""
