"""fibers.vtu and fibers.vtk: direction and thickness of the fibres on each cell of the surface."""

from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats
from meshwind.exporting.elements import Elements
from meshwind.exporting.plies import Plies
from meshwind.results.meshio_files import write_meshio
from meshwind.results.schema import (
    FIBERS,
    FIBERS_LEGACY,
    NORMAL,
    THICKNESS,
    U,
    V,
    family_fields,
    layer_family_fields,
    layer_fields,
)

FILES = FIBERS, FIBERS_LEGACY


def write_fibers(folder: Path, elements: Elements, laid: Plies, units: str = "") -> None:
    """Write both files into an existing folder; the fields are those of `cell_data`."""
    cells = [
        (kind, faces) for kind, faces in (("quad", elements.quads), ("triangle", elements.triangles)) if len(faces)
    ]
    data = {name: np.split(values, [len(cells[0][1])])[: len(cells)] for name, values in cell_data(laid).items()}
    u, v = np.array(elements.uv).T
    points = {str(U): u, str(V): v}
    for name in FILES:
        write_meshio(folder / name, elements.points, cells, point_data=points, cell_data=data, units=units)


def cell_data(laid: Plies) -> dict[str, Floats]:
    """Fields of k cells; those of family +1 are numbered 1, those of family -1 are numbered 2.

    fibre_1 and its alias FIB_DIR1 (k, 3) unit tangents of the fibres; angle_1 (k,) in degrees from the direction
    along the part, square to the level line of v, positive towards growing u; layers_1, thickness_1 (k,) in mesh units;
    thickness (k,) of both together; normal (k, 3) outward.

    Of a laminate, layer by layer from 1: fibre_1_2 and angle_1_2 of family -1 of the first layer, thickness_1 of the
    layer; a hoop has family +1 alone.
    """
    fields = _of_layers(laid) if laid.wound else _of_families(laid)
    return fields | {str(THICKNESS): laid.thickness, str(NORMAL): laid.normal}


def _of_families(laid: Plies) -> dict[str, Floats]:
    data: dict[str, Floats] = {}
    for ply in laid.families:
        names = family_fields(ply.family)
        arrays = ply.direction, ply.direction, np.degrees(ply.angle), ply.layers, ply.thickness
        data |= {str(name): values for name, values in zip(names, arrays, strict=True)}
    return data


def _of_layers(laid: Plies) -> dict[str, Floats]:
    data: dict[str, Floats] = {}
    for number, stack in enumerate(laid.stacks, 1):
        for ply in (laid.families[k] for k in stack):
            names = layer_family_fields(number, ply.family)
            data |= {str(names.direction): ply.direction, str(names.angle): np.degrees(ply.angle)}
        data[str(layer_fields(number).thickness)] = np.sum([laid.families[k].thickness for k in stack], axis=0)
    return data
