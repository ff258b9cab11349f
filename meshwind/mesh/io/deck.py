"""Reading of Abaqus and CalculiX decks (INP) by meshio."""

import re
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.in_subprocess import Arrays
from meshwind.mesh.io.msh import surface_of


def read_deck(path: Path) -> Arrays:
    """Surface of a deck, for `in_subprocess`."""
    import meshio

    if re.search(rb"^\s*\*\s*include\b", path.read_bytes(), re.MULTILINE | re.IGNORECASE):
        raise BadInputError(f"{path.name}: includes another file, which is not read; join them into one")
    try:
        return surface_of(meshio.read(path)).packed()
    except meshio.ReadError as error:
        raise ValueError(str(error)) from error
