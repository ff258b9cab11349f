"""What meshio signs its files with becomes the place where a file tells its unit of length."""

import re
from pathlib import Path

from meshwind.core.units import lengths_in

_SIGNED = re.compile(rb"(written|This file was created) by meshio v[\w.]+|Created by meshio [^\n]+")


def sign(path: Path, units: str) -> None:
    """Say in the header of a .vtu, .vtk or .ply file that meshio wrote what its lengths are in."""
    told = f"meshwind, {lengths_in(units)}".encode("ascii")
    path.write_bytes(_SIGNED.sub(told, path.read_bytes(), count=1))
