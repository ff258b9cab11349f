"""filament.vtp: the filaments of all layers, each one polyline in the order of winding."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.course import Course
from meshwind.results import schema
from meshwind.results.vtk_files import write_lines


@dataclass(frozen=True)
class Filament:
    """A filament in order of winding, with the layer of each of its n points, and the laminate's thickness there."""

    course: Course
    layer: Ints
    thickness: Floats


def filaments_of(layer: ClosedLayer) -> list[Filament]:
    """The filaments of one layer on the bare part."""
    return [
        Filament(each, np.zeros(len(each), dtype=np.int64), np.zeros(len(each))) for each in layer.filaments
    ]  # fmt: skip


def write_filaments(path: Path, filaments: Sequence[Filament], units: str = "") -> None:
    """Write one polyline a filament; angles in degrees, lengths along the polyline from the filament's start."""
    courses = [each.course for each in filaments]
    starts = np.concatenate([[0], np.cumsum([len(each) for each in courses])])
    arc = [each.arc_length for each in courses]

    def all_of(name: str) -> Floats:
        return np.concatenate([getattr(each, name) for each in courses])

    point_data = {
        schema.KIND: all_of("kind").astype(np.uint8),
        schema.LAYER: np.concatenate([each.layer for each in filaments]),
        schema.CIRCUIT: all_of("circuit"),
        schema.PASS: all_of("passed"),
        schema.PATH: all_of("path"),
        schema.ARC_LENGTH: np.concatenate(arc),
        schema.WINDING_ANGLE: np.degrees(all_of("angle")),
        schema.SLIP: all_of("slip"),
        schema.NORMAL: all_of("normal"),
        schema.THICKNESS: np.concatenate([each.thickness for each in filaments]),
    }
    cell_data = {schema.FILAMENT_ID: np.arange(len(filaments)), schema.LENGTH: np.array([each[-1] for each in arc])}
    write_lines(path, all_of("points"), starts, point_data, cell_data, units)
