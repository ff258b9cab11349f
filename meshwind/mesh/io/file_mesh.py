"""What a reader finds in a file."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.io.in_subprocess import Arrays


@dataclass(frozen=True)
class FileMesh:
    """The surface in a file: vertices (n, 3) and triangles (m, 3), before any repair.

    units: the unit of length that the file names, as in `core.units`, "" if it names none; warnings: what of the file
    is not part of the surface, or was read otherwise than it is written, in words, each with how much of it.
    """

    vertices: Floats
    faces: Ints
    units: str = ""
    warnings: tuple[str, ...] = ()

    def packed(self) -> Arrays:
        """The same as arrays, for `in_subprocess`."""
        return {
            "vertices": self.vertices,
            "faces": self.faces,
            "units": np.array(self.units, dtype=np.str_),
            "warnings": np.array(self.warnings, dtype=np.str_),
        }

    @classmethod
    def unpacked(cls, arrays: Arrays) -> "FileMesh":
        """The inverse of `packed`."""
        words = tuple(str(each) for each in arrays["warnings"])
        return cls(arrays["vertices"], arrays["faces"], str(arrays["units"]), words)
