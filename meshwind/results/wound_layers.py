"""Reading the layers of a laminate from a run's folder: what each lies on, its fibres, and its thickness."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block
from meshwind.core.spoken import argument
from meshwind.path.paths import Counters, Paths, Status
from meshwind.results import schema
from meshwind.results.laminate_types import LayerFigures
from meshwind.results.vtk_reading import read_faces, read_lines
from meshwind.surface.grid import grid
from meshwind.surface.surface import Surface

_OFF = 1e-5
"""Largest distance, over the part's size, of a fibre that lies on what is below it."""


@dataclass(frozen=True)
class WoundLayer:
    """A layer of a laminate.

    figures: what the report says of it; paths: its fibres on the surface that it lies on, those of a hoop as one path
    of family +1; table (nu, nv): its thickness on the points of the part's grid, in the mesh's units.
    """

    figures: LayerFigures
    paths: Paths
    table: Floats

    def thickness(self, uv: Floats) -> Floats:
        """Thickness (n,) at uv (n, 2), linear between the points of the grid."""
        from scipy.interpolate import RegularGridInterpolator

        closed = np.concatenate([self.table, self.table[:1]])
        axes = [np.linspace(0.0, 1.0, count) for count in closed.shape]
        at = np.stack([np.mod(uv[:, 0], 1.0), np.clip(uv[:, 1], 0.0, 1.0)], axis=1)
        return np.asarray(RegularGridInterpolator(axes, closed)(at))


@dataclass(frozen=True)
class WoundLayers:
    """The layers of a laminate in order of winding, and the surface on top of the last."""

    layers: tuple[WoundLayer, ...]
    top: Surface

    @property
    def middle(self) -> Surface:
        """The surface halfway between the part and the top of the laminate."""
        below = self.layers[0].paths.surface
        return Surface(frozen(0.5 * (below.control_points + self.top.control_points)), below.periodic)


def read_wound_layers(folder: Path, part: Surface, figures: list[LayerFigures]) -> WoundLayers | None:
    """Read the layers of a run on `part` that its report has these figures of; None if it has none.

    Raises BadInputError if a file is missing or damaged.
    """
    if not figures:
        return None
    maps = read_faces(folder / schema.LAMINATE).point_data
    shape, names = grid(part).shape, [schema.layer_fields(k).thickness for k in range(1, len(figures) + 1)]
    lacking = [name for name in names if maps.get(name, np.zeros(0)).size != shape[0] * shape[1]]
    if lacking or not all(np.isfinite(maps[name]).all() for name in names):
        raise spoilt(folder / schema.LAMINATE, f"no map {lacking[0]} of the part" if lacking else "it holds NaN")
    paths, top = read_layer_paths(folder, part)
    if len(paths) != len(figures):
        raise spoilt(folder / schema.LAYER_SURFACES, "its surfaces are not those of the layers")
    each = zip(figures, paths, names, strict=True)
    return WoundLayers(
        tuple(WoundLayer(says, laid, frozen(maps[name].reshape(shape))) for says, laid, name in each), top
    )


def read_layer_paths(folder: Path, part: Surface) -> tuple[list[Paths], Surface]:
    """Read the fibres of each layer on the surface that it lies on, and the surface on top of the last.

    Raises BadInputError if a file is missing or damaged.
    """
    nets, lines = _nets(folder / schema.LAYER_SURFACES), read_lines(folder / schema.LAYER_FIBRES)
    if len(nets) < 2 or nets.shape[1:] != part.control_points.shape:
        raise spoilt(folder / schema.LAYER_SURFACES, "its surfaces are not those of the part")
    surfaces = [part, *(Surface(net, part.periodic) for net in nets[1:])]
    return [_paths(folder, lines, k, surface) for k, surface in enumerate(surfaces[:-1])], surfaces[-1]


def _nets(path: Path) -> Floats:
    """Control points (l + 1, nu, nv, 3) of the surfaces below each of l layers and on top."""
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
            nets = np.asarray(held[schema.CONTROL_POINTS], dtype=np.float64)
    except (OSError, EOFError, ValueError, LookupError) as error:
        raise spoilt(path, error) from error
    if nets.ndim != 4 or not np.isfinite(nets).all():
        raise spoilt(path, "no surfaces in it")
    return nets


def _paths(folder: Path, lines: Block, number: int, surface: Surface) -> Paths:
    """The fibres of layer `number`, from 0, on the surface below it."""
    source = folder / schema.LAYER_FIBRES
    data: dict[str, Any] = {**lines.point_data, **lines.line_data}
    lacking = [name for name in (*schema.LAYER_FIBRES.point_data, *schema.LAYER_FIBRES.cell_data) if name not in data]
    if lacking:
        raise spoilt(source, f"no {' or '.join(lacking)} in it")
    sizes = np.diff(lines.starts)
    mine = data[schema.LAYER] == number
    if not mine.any() or len(set(sizes[mine])) > 1:
        raise spoilt(source, f"its lines are not those of layer {number + 1}")
    shape = int(mine.sum()), int(sizes[mine][0])
    at = np.repeat(mine, sizes)
    points, uv, normal = (
        frozen(np.array(values[at], dtype=np.float64).reshape(*shape, -1))
        for values in (lines.points, data[schema.UV], data[schema.NORMAL])
    )
    if not all(np.isfinite(values).all() for values in (points, uv, normal)):
        raise spoilt(source, "it holds NaN or infinite values")
    gap = np.linalg.norm(points - surface.points(uv.reshape(-1, 2)).reshape(points.shape), axis=2)
    on = gap <= _OFF * surface.size
    return Paths(
        surface=surface, points=points, uv=uv, on_surface=frozen(on), gap=frozen(np.where(on, 0.0, gap)),
        normal=normal, slip=frozen(np.full(shape, np.nan)),
        family=frozen(data[schema.FAMILY][mine].astype(np.int64)),
        status=frozen(np.full(shape[0], int(Status.CONVERGED))), residual=frozen(np.zeros(shape[0])),
        friction=0.0, counters=Counters(0, 0, 0, 0),
    )  # fmt: skip


def spoilt(path: Path, why: object) -> BadInputError:
    """The error of a laminate's file that cannot be used."""
    return BadInputError(f"{path} cannot be used ({why}); wind it with {argument('layers')} again")
