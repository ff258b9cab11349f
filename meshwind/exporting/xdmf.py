"""XDMF with its numbers in an HDF5 file beside it, for VTK's reader and for that of meshio.

PyVista opens no XDMF whose grid states no time, and meshio none whose grid does. So the grid that meshio reads refers
VTK to one within its `Information`, whose children meshio passes over: the same arrays and a time.
"""

from collections.abc import Mapping, Sequence
from io import BytesIO
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeAlias
from urllib.parse import quote
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints

if TYPE_CHECKING:
    from h5py import File

_NAMES = {"vertex": "Polyvertex", "line": "Polyline", "triangle": "Triangle", "quad": "Quadrilateral"}
_NUMBERS = {"triangle": 4, "quad": 5}
_TIMED = "/Xdmf/Domain/Grid/Information/Grid"
Data: TypeAlias = Mapping[str, NDArray[Any]]


def write_xdmf(
    path: Path, points: Floats, cells: Sequence[tuple[str, Ints]], point_data: Data, cell_data: Data, units: str = ""
) -> None:
    """Write PATH.xdmf and PATH.h5: points (n, 3), cells by kind, point data, cell data in the order of the cells.

    If there are several kinds of cells, they must be quads and triangles.
    """
    from h5py import File

    heavy, whole = path.with_suffix(".h5"), BytesIO()
    with File(whole, "w") as numbers:
        grid = [
            f'<Geometry GeometryType="XYZ">{_item(numbers, heavy, "points", points)}</Geometry>',
            _topology(numbers, heavy, cells),
        ]
        for centre, data in (("Node", point_data), ("Cell", cell_data)):
            for name, values in data.items():
                shape = "Scalar" if values.ndim == 1 else "Vector"
                item = _item(numbers, heavy, f"{centre.lower()}_data/{quote(name, safe=' ')}", values)
                opening = f'<Attribute Name={quoteattr(name)} AttributeType="{shape}" Center="{centre}">'
                grid.append(f"{opening}{item}</Attribute>")
    # a full disk ends the writing of plain bytes with a message of the system, that of HDF5 with one of its own
    heavy.write_bytes(whole.getbuffer())
    said = "\n".join(grid)
    path.write_text(
        f"""<?xml version="1.0"?>
<Xdmf Version="3.0"><Domain><Grid Name="Grid" Reference="XML">{_TIMED}
<Information Name="units" Value={quoteattr(units)}>&lt;none/&gt;<Grid Name="Grid"><Time Value="0"/>
{said}
</Grid></Information>
{said}
</Grid></Domain></Xdmf>
""",
        encoding="utf-8",
    )


def _topology(numbers: "File", heavy: Path, cells: Sequence[tuple[str, Ints]]) -> str:
    """A single kind by its name; quads and triangles as one list of kind and corners for each face."""
    count = sum(len(block) for _, block in cells)
    if len(cells) == 1:
        kind, block = cells[0]
        opening = f'TopologyType="{_NAMES[kind]}" NumberOfElements="{count}" NodesPerElement="{block.shape[1]}"'
        return f"<Topology {opening}>{_item(numbers, heavy, 'cells', block)}</Topology>"
    mixed = [np.insert(block, 0, _NUMBERS[kind], axis=1).ravel() for kind, block in cells]
    item = _item(numbers, heavy, "cells", np.concatenate(mixed))
    return f'<Topology TopologyType="Mixed" NumberOfElements="{count}">{item}</Topology>'


def _item(numbers: "File", heavy: Path, name: str, values: NDArray[Any]) -> str:
    """Keep an array under a name; return the XML that says where it is."""
    whole = values.dtype.kind in "iub"
    numbers[name] = values.astype("<i8" if whole else "<f8")
    kind, size = "Int" if whole else "Float", " ".join(map(str, values.shape))
    return f'<DataItem DataType="{kind}" Dimensions="{size}" Format="HDF" Precision="8">{heavy.name}:/{name}</DataItem>'
