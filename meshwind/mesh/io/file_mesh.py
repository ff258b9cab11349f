"""What a reader finds in a file."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.units import BY_FILE, Unit
from meshwind.mesh.io.in_subprocess import Arrays


@dataclass(frozen=True)
class FileMesh:
    """The surface in a file: vertices (n, 3) and triangles (m, 3), before any repair.

    units: the unit of length as the file names it, "" if it names none; warnings: what of the file is not part of the
    surface, or was read otherwise than it is written, in words, each with how much of it; units_from: who named the
    unit, as in `core.units`; notes: how the surface was made, in words.
    """

    vertices: Floats
    faces: Ints
    units: str = ""
    warnings: tuple[str, ...] = ()
    units_from: str = BY_FILE
    notes: tuple[str, ...] = ()

    @property
    def unit(self) -> Unit:
        """The unit as the file names it, and who did."""
        return Unit(self.units, self.units_from)

    def packed(self) -> Arrays:
        """The same as arrays, for `in_subprocess`."""
        return {
            "vertices": self.vertices,
            "faces": self.faces,
            "units": np.array(self.units, dtype=np.str_),
            "warnings": np.array(self.warnings, dtype=np.str_),
            "units_from": np.array(self.units_from, dtype=np.str_),
            "notes": np.array(self.notes, dtype=np.str_),
        }

    @classmethod
    def unpacked(cls, arrays: Arrays) -> "FileMesh":
        """The inverse of `packed`."""
        warnings, notes = (tuple(str(each) for each in arrays[key]) for key in ("warnings", "notes"))
        units, units_from = str(arrays["units"]), str(arrays["units_from"])
        return cls(arrays["vertices"], arrays["faces"], units, warnings, units_from, notes)
