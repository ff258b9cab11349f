"""Results folders of exact layups, written by the writers of a run and read back as an export reads them."""

from pathlib import Path

import numpy as np
from layup_shapes import bridged, cylinder, helices

from meshwind.layup.layup import assess
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.paths import Paths
from meshwind.results.reading import Results, read_results
from meshwind.results.report import RunFacts, report, write_report
from meshwind.results.write import write_files
from meshwind.surface.grid import grid


def leave(folder: Path, paths: Paths, units: str = "mm") -> Results:
    """Write what a run writes, and read it."""
    layup = assess(paths)
    on = grid(paths.surface)
    part = Mesh(on.points, np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]]), "part.stl", units=units)
    write_files(folder, layup, units=units)
    write_report(folder / "report.json", report(layup, part, None, RunFacts(0.25)))
    return read_results(folder)


def waisted_results(folder: Path, units: str = "mm") -> Results:
    """A waist of radius 1 and height 4 that every fibre bridges."""
    return leave(folder, bridged(), units)


def plain_results(folder: Path, units: str = "mm") -> Results:
    """A cylinder of radius 1 and height 4 with helices of half a turn, which are exact geodesics."""
    return leave(folder, helices(16, 0.5, 401, cylinder(64)), units)
