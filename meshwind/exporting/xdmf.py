"""XDMF with its numbers in one binary file beside it.

meshio's writer needs h5py even without HDF5, and numbers in the XML itself would lose NaN, which VTK's reader (also
ParaView's) misreads.
"""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, BinaryIO, TypeAlias
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints

_NAMES = {"vertex": "Polyvertex", "line": "Polyline", "triangle": "Triangle", "quad": "Quadrilateral"}
_NUMBERS = {"triangle": 4, "quad": 5}
Data: TypeAlias = Mapping[str, NDArray[Any]]


def write_xdmf(
    path: Path, points: Floats, cells: Sequence[tuple[str, Ints]], point_data: Data, cell_data: Data, units: str = ""
) -> None:
    """Write PATH.xdmf and PATH.raw: points (n, 3), cells by kind, point data, cell data in the order of the cells.

    If there are several kinds of cells, they must be quads and triangles.
    """
    raw = path.with_suffix(".raw")
    with path.open("w", encoding="utf-8") as file, raw.open("wb") as numbers:
        file.write('<?xml version="1.0"?>\n<Xdmf Version="3.0"><Domain><Grid Name="Grid">\n')
        file.write('<Time Value="0"/>\n')  # PyVista reads no file without a time
        file.write(f'<Information Name="units" Value={quoteattr(units)}/>\n')
        file.write(f'<Geometry GeometryType="XYZ">{_item(numbers, points)}</Geometry>\n{_topology(numbers, cells)}')
        for centre, data in (("Node", point_data), ("Cell", cell_data)):
            for name, values in data.items():
                shape = "Scalar" if values.ndim == 1 else "Vector"
                file.write(f'<Attribute Name={quoteattr(name)} AttributeType="{shape}" Center="{centre}">')
                file.write(f"{_item(numbers, values)}</Attribute>\n")
        file.write("</Grid></Domain></Xdmf>\n")


def _topology(numbers: BinaryIO, cells: Sequence[tuple[str, Ints]]) -> str:
    """A single kind by its name; quads and triangles as one list of kind and corners for each face."""
    count = sum(len(block) for _, block in cells)
    if len(cells) == 1:
        kind, block = cells[0]
        opening = f'TopologyType="{_NAMES[kind]}" NumberOfElements="{count}" NodesPerElement="{block.shape[1]}"'
        return f"<Topology {opening}>{_item(numbers, block)}</Topology>\n"
    mixed = [np.insert(block, 0, _NUMBERS[kind], axis=1).ravel() for kind, block in cells]
    item = _item(numbers, np.concatenate(mixed))
    return f'<Topology TopologyType="Mixed" NumberOfElements="{count}">{item}</Topology>\n'


def _item(numbers: BinaryIO, values: NDArray[Any]) -> str:
    """Append an array to the file of numbers; return the XML that says where it is."""
    whole = values.dtype.kind in "iub"
    kind, size = "Int" if whole else "Float", " ".join(map(str, values.shape))
    start = numbers.tell()
    numbers.write(np.ascontiguousarray(values, dtype="<i8" if whole else "<f8").tobytes())
    file = Path(numbers.name).name
    return (
        f'<DataItem DataType="{kind}" Dimensions="{size}" Format="Binary" Endian="Little" Precision="8" '
        f'Seek="{start}">{file}</DataItem>'
    )
