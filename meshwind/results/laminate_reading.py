"""Reading the files of a laminate: its thickness over the part, its layers along the part, and their fibres."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.filament.course import Course, Kind
from meshwind.filament.filament import Filament
from meshwind.path.paths import Paths
from meshwind.results import schema
from meshwind.results.laminate_types import LayerFigures
from meshwind.results.vtk_reading import read_faces
from meshwind.results.wound_layers import read_layer_paths, spoilt
from meshwind.surface.surface import Surface

_COLUMNS = 6
"""Columns of laminate.csv."""


@dataclass(frozen=True)
class ReadLaminate:
    """What the files say of a laminate of l layers.

    thickness (k,): of all layers on the points of the surface's grid; stations (r, 6): rows of laminate.csv, with the
    columns v, z, layer, angle, thickness, cover; fibres: each path and hoop, layer by layer, as a filament of its own,
    on passes 0 for family +1 and 1 for family -1, with no angles and no slip.
    """

    thickness: Floats
    stations: Floats
    fibres: tuple[Filament, ...]

    @property
    def layers(self) -> int:
        """Number of layers."""
        return int(self.stations[:, 2].max()) + 1

    def of_layer(self, number: int) -> Floats:
        """Rows of `stations` of a layer, counted from 0, from the start rim to the end rim."""
        mine = self.stations[self.stations[:, 2] == number]
        return np.asarray(mine[np.argsort(mine[:, 0], kind="stable")])


def read_laminate(folder: Path, surface: Surface) -> ReadLaminate | None:
    """Read the laminate of a run's folder, None if it has none; surface: that of the part.

    Raises BadInputError if a file is missing or damaged.
    """
    if not (folder / schema.LAMINATE).is_file():
        return None
    thickness = read_faces(folder / schema.LAMINATE).point_data.get(schema.THICKNESS)
    if thickness is None or not np.isfinite(thickness).all():
        raise spoilt(folder / schema.LAMINATE, "no thickness in it")
    stations = _stations(folder / schema.STATIONS)
    return ReadLaminate(frozen(thickness), stations, _fibres(folder, surface))


def widths(layers: Sequence[LayerFigures], width: float) -> tuple[float, ...]:
    """Width of the band of each layer, from the report's figures; that of a run without layers is `width`."""
    return tuple(each["band_width"] for each in layers) or (width,)


def _stations(path: Path) -> Floats:
    try:
        rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    except (OSError, ValueError) as error:
        raise spoilt(path, error) from error
    if rows.shape[1:] != (_COLUMNS,) or not len(rows):
        raise spoilt(path, "no stations in it")
    return frozen(rows)


def _fibres(folder: Path, surface: Surface) -> tuple[Filament, ...]:
    layers = enumerate(read_layer_paths(folder, surface)[0])
    return tuple(fibre_of(paths, row, number) for number, paths in layers for row in range(len(paths)))


def fibre_of(paths: Paths, row: int, layer: int = 0) -> Filament:
    """One of the paths of a layer as a filament of its own, on pass 0 for family +1 and 1 for family -1."""
    count = paths.points.shape[1]
    none, zero = np.full(count, np.nan), np.zeros(count, dtype=np.int64)
    kind = np.where(paths.on_surface[row], Kind.LAID, Kind.BRIDGE)
    passed = zero + int(paths.family[row] < 0)
    course = Course(paths.points[row], paths.normal[row], none, none, frozen(kind), zero, passed, zero - 1)
    return Filament(course, zero + layer, none)
