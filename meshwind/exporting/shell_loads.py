"""The load step of a shell deck: a pull, or pressure inside with what it pulls at the ends."""

from collections.abc import Iterator

import numpy as np

from meshwind.core.cast import Floats
from meshwind.exporting.elements import Elements
from meshwind.exporting.shell_nodes import Nodes, Rim

FORCE = 1000.0
"""Pull of the step, in N."""
_NOTHING = 1e-12
"""Share of a load along an axis below which it is left out."""


def step(nodes: Nodes, elements: Elements, pressure: float | None) -> Iterator[str]:
    """Lines of the load step, with the start rim held.

    The end rim is pulled, or, if a pressure in N over the unit of length squared is given, the part is under it.
    """
    start, end = nodes.rims
    if pressure is None:
        axis = nodes.points[end.nodes].mean(axis=0) - nodes.points[start.nodes].mean(axis=0)
        force = FORCE * axis / np.linalg.norm(axis)
        yield f"** load to begin with, replace it by your own: START held, END pulled by {FORCE:g} N in all"
    else:
        force = pressure * end.area
        yield f"** load: a pressure of {pressure:.9g} on the inside; START held, END pulled by the"
        yield f"** {np.linalg.norm(force):.6g} N that it has on that opening, as on the end of a closed vessel"
    yield "*STEP"
    yield "*STATIC"
    yield "*BOUNDARY"
    yield "START, 1, 6"
    yield "*CLOAD"
    yield from _spread(end, force)
    if pressure is not None:
        yield from _inside(elements, pressure)
    yield "*NODE PRINT, NSET=END"
    yield "U"
    yield "*NODE FILE"
    yield "U"
    yield "*EL FILE"
    yield "S"
    yield "*END STEP"


def _inside(elements: Elements, pressure: float) -> Iterator[str]:
    """Pressure along the outward normals, as large on each element as its inside has it."""
    yield "*DLOAD"
    if elements.skin is elements.surface:
        yield f"SHELL, P, {pressure:.9g}"
        return
    for e, share in enumerate(elements.pressed, 1):
        yield f"{e}, P, {pressure * share:.9g}"


def _spread(rim: Rim, force: Floats) -> Iterator[str]:
    """A force (3,) shared by the nodes of a rim."""
    whole = float(np.linalg.norm(force))
    for node, share in zip(rim.nodes + 1, rim.shares, strict=True):
        for direction, part in enumerate(force, start=1):
            if abs(part) > _NOTHING * whole:
                yield f"{node}, {direction}, {share * part:.9g}"
