"""One filament in order of winding, over one layer or several."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.course import Course


@dataclass(frozen=True)
class Filament:
    """A filament in order of winding, with the layer of each of its n points, and the laminate's thickness below it."""

    course: Course
    layer: Ints
    thickness: Floats


def filaments_of(layer: ClosedLayer) -> list[Filament]:
    """The filaments of one layer on the bare part."""
    return [
        Filament(each, np.zeros(len(each), dtype=np.int64), np.zeros(len(each))) for each in layer.filaments
    ]  # fmt: skip
