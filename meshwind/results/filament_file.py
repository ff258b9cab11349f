"""filament.vtp: the filaments of all layers, each one polyline in the order of winding."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from meshwind.core.cast import frozen
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import called
from meshwind.filament.course import Course
from meshwind.filament.filament import Filament, filaments_block
from meshwind.results import schema
from meshwind.results.vtk_files import write_lines
from meshwind.results.vtk_reading import read_lines


def write_filaments(path: Path, filaments: Sequence[Filament], units: str = "") -> None:
    """Write one polyline a filament; angles in degrees, lengths along the polyline from the filament's start."""
    write_lines(path, schema.FILAMENT, filaments_block(filaments), units)


def read_filaments(path: Path) -> list[Filament]:
    """Read what `write_filaments` wrote; raises BadInputError if the file is missing or damaged."""
    read = read_lines(path)
    lacking = [name for name in schema.FILAMENT.point_data if name not in read.point_data]
    if lacking or len(read.starts) < 2:
        why = f"no {' or '.join(lacking)} in it" if lacking else "no filament in it"
        raise BadInputError(f"{path} cannot be used ({why}); run {called('wind', continuous=True)} again")
    normal, angle = read.point_data[schema.NORMAL], read.point_data[schema.WINDING_ANGLE]
    known = read.points, normal, angle, read.point_data[schema.ARC_LENGTH]
    if normal.shape != read.points.shape or not all(np.isfinite(values).all() for values in known):
        raise BadInputError(
            f"{path} cannot be used (it holds no finite numbers); run {called('wind', continuous=True)} again"
        )
    counts = [
        read.point_data[name].astype(np.int64)
        for name in (schema.KIND, schema.CIRCUIT, schema.PASS, schema.PATH, schema.LAYER)
    ]
    found = []
    for first, last in zip(read.starts[:-1], read.starts[1:], strict=True):
        one = slice(int(first), int(last))
        kind, circuit, passed, path_, layer = (frozen(each[one]) for each in counts)
        course = Course(
            frozen(read.points[one]), frozen(normal[one]), frozen(np.radians(angle[one])),
            frozen(read.point_data[schema.SLIP][one]), kind, circuit, passed, path_,
        )  # fmt: skip
        found.append(Filament(course, layer, frozen(read.point_data[schema.THICKNESS][one])))
    return found
