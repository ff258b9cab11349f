"""Scene of angles.png: the winding angle and the cover along the part."""

import numpy as np

from meshwind.filament.levels import levels
from meshwind.filament.stations import helix_stations
from meshwind.path.paths import converged_or_all
from meshwind.pictures.scenes import AnglesScene
from meshwind.pictures.subject import Subject


def angles_scene(of: Subject) -> AnglesScene:
    """Least, median and largest winding angle of the converged paths at stations along the part."""
    paths = of.paths.subset(converged_or_all(of.paths.status))
    width, lines = of.layup.coverage.width, levels(paths.surface)
    at = helix_stations(paths, lines, width)
    here = np.isfinite(at.angle) & np.isfinite(at.cover)
    spread = np.degrees(np.stack([at.least, at.angle, at.most])[:, here])
    cover = at.cover[here] if width > 0.0 else None
    subtitle = f"{spread[0].min():.1f}° to {spread[2].max():.1f}°, median {np.median(spread[1]):.1f}°"
    if cover is not None:
        subtitle += f"  ·  a family covers {cover.min():.2f} to {cover.max():.2f} times"
    stations = np.interp(at.v[here], lines.v, lines.mean)
    return AnglesScene(of.frame(f"{of.name}: winding angle along the part", subtitle), stations, spread, cover)
