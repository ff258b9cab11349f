"""Results folders of exact layups, written by the writers of a run and read back as an export reads them."""

import json
from pathlib import Path

import numpy as np
from layup_shapes import bridged, cylinder, helices

from meshwind.core.cast import frozen
from meshwind.filament.course import Course, Kind
from meshwind.filament.filament import Filament
from meshwind.filament.hoop import HoopPlan, hoop
from meshwind.filament.laminate import Laminate, Ply, helical_layer, hoop_layer
from meshwind.filament.levels import levels
from meshwind.filament.thickness import Laying
from meshwind.layup.layup import assess
from meshwind.mesh.geometry.mesh import Mesh
from meshwind.path.paths import Paths
from meshwind.results.filament_file import write_filaments
from meshwind.results.laminate_files import laminate_figures, write_laminate
from meshwind.results.reading import Results, read_results
from meshwind.results.report import RunFacts, report, write_report
from meshwind.results.write import surface_maps, write_files
from meshwind.surface.grid import grid


def leave(folder: Path, paths: Paths, units: str = "mm") -> Results:
    """Write what a run writes, and read it."""
    layup = assess(paths)
    on = grid(paths.surface)
    part = Mesh(on.points, np.concatenate([on.quads[:, [0, 1, 2]], on.quads[:, [0, 2, 3]]]), "part.stl", units=units)
    write_files(folder, layup, surface_maps(layup), units)
    write_report(folder / "report.json", report(layup, part, None, RunFacts(0.25)))
    return read_results(folder)


def waisted_results(folder: Path, units: str = "mm") -> Results:
    """A waist of radius 1 and height 4 that every fibre bridges."""
    return leave(folder, bridged(), units)


def plain_results(folder: Path, units: str = "mm") -> Results:
    """A cylinder of radius 1 and height 4 with helices of half a turn, which are exact geodesics."""
    return leave(folder, helices(16, 0.5, 401, cylinder(64)), units)


def laminate() -> Laminate:
    """A cylinder of radius 1 and height 4: helices of half a turn, a hoop in its middle half, helices of a turn."""
    part = cylinder(64)
    wide = Laying(0.3, 0.002)
    inner = helical_layer(helices(16, 0.5, 201, part), Ply(wide), levels(part))
    ground = inner.raised.surface
    lines = levels(ground)
    middle = hoop_layer(ground, hoop(ground, HoopPlan(0.25, 0.75, 0.2)), Ply(Laying(0.2, 0.003)), lines)
    ground = middle.raised.surface
    return Laminate((inner, middle, helical_layer(helices(24, 1.0, 201, ground), Ply(wide), levels(ground))))


def layered_results(folder: Path, wound: Laminate, units: str = "mm") -> Results:
    """A run of these layers on the cylinder."""
    results = plain_results(folder, units)
    write_laminate(folder, wound, units)
    path = folder / "report.json"
    figures = json.loads(path.read_text()) | {"laminate": laminate_figures(wound, units)}
    path.write_text(json.dumps(figures))
    return read_results(results.folder)


def there_and_back() -> Filament:
    """A helix up a cylinder, a half turn round its end, and a helix down, of which the middle third is in the air.

    The way up is layer 0, the rest layer 1.
    """
    up = np.linspace(0.0, 1.0, 101)
    u = np.concatenate([0.5 * up, 0.5 + 0.5 * up[1:], 1.0 + 0.5 * up[1:]])
    z = 4.0 * np.concatenate([up, np.ones(100), 1.0 - up[1:]])
    kind = np.repeat([int(Kind.LAID), int(Kind.TURN), int(Kind.LAID)], [101, 100, 100])
    kind[234:267] = Kind.BRIDGE
    turn = 2.0 * np.pi * u
    normal = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    points = normal + z[:, None] * [0.0, 0.0, 1.0]
    passed, path = np.repeat([0, 0, 1], [101, 100, 100]), np.repeat([0, -1, 16], [101, 100, 100])
    nothing = np.zeros(len(u))
    arrays = points, normal, nothing, nothing, kind, 0 * kind, passed, path
    layer = np.repeat([0, 1], [101, 200])
    return Filament(Course(*map(frozen, arrays)), frozen(layer), frozen(nothing))


def filament_results(folder: Path, units: str = "mm") -> Results:
    """The cylinder's layers with a filament."""
    layered_results(folder, laminate(), units)
    write_filaments(folder / "filament.vtp", [there_and_back()], units)
    return read_results(folder)
