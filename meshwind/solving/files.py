"""solved.vtu: the fields of a solved deck, for ParaView and PyVista."""

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.results.meshio_files import write_meshio
from meshwind.results.schema import (
    DISPLACEMENT,
    EXPOSURE,
    NORMAL,
    THICKNESS,
    TSAI_WU,
    WORST_FAMILY,
    WORST_LAYER,
    WORST_PLY,
    ply_fields,
)
from meshwind.solving.fields import Solved


def write_solved(file: Path, done: Solved, units: str) -> None:
    """Write the elements with their middle nodes, and their fields; lengths are in mesh units, stresses in MPa."""
    deck = done.deck
    cells = [(kind, faces) for kind, faces in (("quad8", deck.quads), ("triangle6", deck.triangles)) if len(faces)]
    data = {name: np.split(values, [len(cells[0][1])])[: len(cells)] for name, values in cell_data(done).items()}
    moved = {str(DISPLACEMENT): done.displacement}
    write_meshio(file, deck.points, cells, point_data=moved, cell_data=data, units=units)


def cell_data(done: Solved) -> dict[str, NDArray[Any]]:
    """Fields of k elements.

    Of each ply, by the number of its layer and of its family, which is 1 for +1 and 2 for -1: fibre_1_2 (k, 3) its
    direction; stress_1_2 and strain_1_2 (k, 3) along the fibre, across it and in shear, as means over the ply; NaN
    where it is not.  Of the point that is nearest to failure: exposure, tsai_wu, and the numbers of its ply from the
    inside out, of its layer and of its family.
    """
    data: dict[str, NDArray[Any]] = {}
    for (layer, family), fields in done.plies.items():
        names = ply_fields(layer, family)
        arrays = fields.direction, fields.stress, fields.strain
        data |= {str(name): values for name, values in zip(names, arrays, strict=True)}
    if done.worst is not None:
        data |= {str(EXPOSURE): done.worst.exposure, str(TSAI_WU): done.worst.polynomial}
        layers = done.worst_layer
        data |= {
            str(WORST_PLY): done.worst.place + 1,
            str(WORST_LAYER): np.array([each.layer for each in layers]),
            str(WORST_FAMILY): np.array([each.family for each in layers]),
        }
    return data | {str(THICKNESS): done.thickness, str(NORMAL): done.deck.normal}
