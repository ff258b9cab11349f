"""Reading the files of a laminate: its thickness over the part, its layers along the part, and their fibres."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.filament.course import Course, Kind
from meshwind.filament.filament import Filament
from meshwind.results import schema
from meshwind.results.laminate_types import LayerFigures
from meshwind.results.vtk_reading import Lines, read_faces, read_lines
from meshwind.surface.surface import Surface

_OFF = 1e-5
"""Largest distance, over the part's size, of a fibre that lies on what is below it."""
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
        raise _spoilt(folder / schema.LAMINATE, "no thickness in it")
    stations = _stations(folder / schema.STATIONS)
    return ReadLaminate(frozen(thickness), stations, _fibres(folder, surface))


def widths(layers: Sequence[LayerFigures], width: float) -> tuple[float, ...]:
    """Width of the band of each layer, from the report's figures; that of a run without layers is `width`."""
    return tuple(each["band_width"] for each in layers) or (width,)


def _stations(path: Path) -> Floats:
    try:
        rows = np.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)
    except (OSError, ValueError) as error:
        raise _spoilt(path, error) from error
    if rows.shape[1:] != (_COLUMNS,) or not len(rows):
        raise _spoilt(path, "no stations in it")
    return frozen(rows)


def _fibres(folder: Path, surface: Surface) -> tuple[Filament, ...]:
    lines = read_lines(folder / schema.LAYER_FIBRES)
    nets = _nets(folder / schema.LAYER_SURFACES)
    lacking = [str(name) for name in schema.LAYER_FIBRES.point_data if name not in lines.point_data]
    lacking += [str(name) for name in schema.LAYER_FIBRES.cell_data if name not in lines.cell_data]
    layers = lines.cell_data.get(schema.LAYER, np.zeros(0)).astype(np.int64)
    if lacking or not len(layers) or not 0 <= layers.min() <= layers.max() < len(nets):
        raise _spoilt(folder / schema.LAYER_FIBRES, f"no {' or '.join(lacking)} in it" if lacking else "no layers")
    off = np.zeros(len(lines.points))
    sizes = np.diff(lines.starts)
    layer_of = np.repeat(layers, sizes)
    for number in np.unique(layers):
        mine = layer_of == number
        below = Surface(nets[number], surface.periodic)
        uv = np.ascontiguousarray(lines.point_data[schema.UV][mine])
        off[mine] = np.linalg.norm(lines.points[mine] - below.points(uv), axis=1)
    kind = np.where(off > _OFF * surface.size, Kind.BRIDGE, Kind.LAID)
    return tuple(_fibre(lines, kind, row, int(layers[row])) for row in range(len(layers)))


def _nets(path: Path) -> Floats:
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
            nets = np.asarray(held[schema.CONTROL_POINTS], dtype=np.float64)
    except (OSError, EOFError, ValueError, LookupError) as error:
        raise _spoilt(path, error) from error
    if nets.ndim != 4 or not np.isfinite(nets).all():
        raise _spoilt(path, "no surfaces in it")
    return nets


def _fibre(lines: Lines, kind: Floats, row: int, layer: int) -> Filament:
    one = slice(int(lines.starts[row]), int(lines.starts[row + 1]))
    count = one.stop - one.start
    none, zero = np.full(count, np.nan), np.zeros(count, dtype=np.int64)
    passed = zero + int(lines.cell_data[schema.FAMILY][row] < 0)
    points, normal = frozen(lines.points[one]), frozen(lines.point_data[schema.NORMAL][one])
    course = Course(points, normal, none, none, frozen(kind[one]), zero, passed, zero - 1)
    return Filament(course, zero + layer, none)


def _spoilt(path: Path, why: object) -> BadInputError:
    return BadInputError(f"{path} cannot be used ({why}); run `meshwind wind --layers` again")
