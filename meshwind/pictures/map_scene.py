"""Scenes of the maps: coverage, windability, distance to the mesh."""

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from meshwind.appearance.looks import MAPS
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
from meshwind.layup.windability import CONCAVE, CONVEX, SADDLE
from meshwind.pictures.scenes import Fans, MapScene
from meshwind.pictures.subject import Subject
from meshwind.results.schema import CLASS, COVERAGE, FIT_ERROR, PRESS_DIRECTION, PRESS_REACH, WINDABILITY, Field

_FANS = 26
"""Number of fans along the longer side of the picture."""
_ALL_BUT = 80.0
"""Largest reach, in degrees, of a fan; beyond, it would be nearly a full circle."""
_ASLANT = 0.25
"""Least cosine between the directions to the eye and of the normal at which a fan is legible."""


def map_scene(of: Subject, field: Field, title: str, subtitle: str) -> MapScene:
    """The surface coloured by a map."""
    values = of.maps[field].astype(np.float64)
    scale = MAPS[field].scale(values, of.units)
    return MapScene(of.frame(f"{of.name}: {title}", subtitle), of.part, scale, scale.shares(values))


def coverage_scene(of: Subject) -> MapScene:
    """Number of layers of fibre over each point."""
    bands = of.layup.bands
    shares = ("bare", bands.bare), ("once", bands.share(1)), ("twice", bands.share(2)), ("more often", bands.more)
    covered = ", ".join(f"{name} {100.0 * share:.0f} %" for name, share in shares)
    width = quantity(bands.width, of.units, 3)
    return map_scene(of, COVERAGE, "coverage", f"band {width} wide; area covered: {covered}")


def fit_map_scene(of: Subject) -> MapScene:
    """Distance of the surface to the mesh's facets, on a logarithmic scale."""
    away = of.maps[FIT_ERROR]
    figures = ("median", np.median(away)), ("99 % below", np.quantile(away, 0.99)), ("largest", away.max())
    subtitle = "  ·  ".join(f"{word} {quantity(float(value), of.units, 2)}" for word, value in figures)
    return map_scene(of, FIT_ERROR, "distance of the surface to the mesh's facets", subtitle)


def windability_scene(of: Subject) -> MapScene:
    """Share of the directions in which a taut fibre presses, with fans of those directions where not all do."""
    kind, area = of.maps[CLASS], _areas(of)
    share = {each: 100.0 * float(area[kind == each].sum() / area.sum()) for each in (CONVEX, SADDLE, CONCAVE)}
    subtitle = (
        f"a fibre presses in every direction on {share[CONVEX]:.0f} % of the area, in some on {share[SADDLE]:.0f} %, "
        f"in none on {share[CONCAVE]:.0f} %"
    )
    seen = map_scene(of, WINDABILITY, "where a taut fibre presses", subtitle)
    apart = max(of.view.width, of.view.height) / _FANS
    toward = (of.normals @ of.view.eye) / np.linalg.norm(of.normals, axis=1)
    some = (kind == SADDLE) & (of.maps[PRESS_REACH] < _ALL_BUT)
    # each side by itself: on a thin part those of one would leave no room to those of the other
    sides = [np.flatnonzero(some & (each > _ASLANT)) for each in ((toward, -toward) if of.view.both else (toward,))]
    chosen = np.concatenate([side[spread_out(of.points[side], apart)] for side in sides])
    fans = Fans(
        points=of.points[chosen],
        normals=of.normals[chosen],
        directions=of.maps[PRESS_DIRECTION][chosen],
        reach=np.radians(of.maps[PRESS_REACH][chosen]),
        size=0.26 * apart,
    )
    return replace(seen, fans=fans)


def spread_out(points: Floats, apart: float) -> Ints:
    """Numbers of a largest subset of points (n, 3) no two of which are closer than a distance."""
    if not len(points):
        return np.zeros(0, dtype=np.int64)
    tree, free, chosen = cKDTree(points), np.ones(len(points), dtype=bool), []
    for k in range(len(points)):
        if free[k]:
            chosen.append(k)
            free[tree.query_ball_point(points[k], apart)] = False
    return np.array(chosen)


def _areas(of: Subject) -> Floats:
    """Area of the surface that belongs to each of its points."""
    corner = of.points[of.quads]
    area = 0.5 * np.linalg.norm(np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1]), axis=1)
    return np.bincount(of.quads.ravel(), np.repeat(0.25 * area, 4), len(of.points)).astype(np.float64)
