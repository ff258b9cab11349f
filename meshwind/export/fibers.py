"""fibers.vtu and fibers.vtk: on each cell of the surface, where the fibres run and how thick they lie."""

from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats
from meshwind.export.elements import Elements
from meshwind.export.plies import Plies
from meshwind.export.signature import sign

FILES = "fibers.vtu", "fibers.vtk"


def write_fibers(folder: Path, elements: Elements, laid: Plies, units: str = "") -> None:
    """Write both files into a folder that is there; the fields are those of `cell_data`."""
    import meshio

    cells = [
        (kind, faces) for kind, faces in (("quad", elements.quads), ("triangle", elements.triangles)) if len(faces)
    ]
    data = {name: np.split(values, [len(cells[0][1])])[: len(cells)] for name, values in cell_data(laid).items()}
    u, v = np.array(elements.uv).T
    mesh = meshio.Mesh(np.array(elements.points), cells, point_data={"u": u, "v": v}, cell_data=data)
    for name in FILES:
        mesh.write(folder / name)
        sign(folder / name, units)


def cell_data(laid: Plies) -> dict[str, Floats]:
    """Fields of k cells, of family +1 with the number 1 and of family -1 with 2.

    fibre_1 and its alias FIB_DIR1 (k, 3) unit tangents of the fibres; angle_1 (k,) in degrees from the meridian, 0
    along the part, positive towards growing u; layers_1, thickness_1 (k,) in mesh units; thickness (k,) of both
    together; normal (k, 3) outward.
    """
    data: dict[str, Floats] = {}
    for ply in laid.families:
        number = 1 if ply.family > 0 else 2
        data[f"fibre_{number}"] = ply.direction
        data[f"FIB_DIR{number}"] = ply.direction
        data[f"angle_{number}"] = np.degrees(ply.angle)
        data[f"layers_{number}"] = ply.layers
        data[f"thickness_{number}"] = ply.thickness
    return data | {"thickness": laid.thickness, "normal": laid.normal}
