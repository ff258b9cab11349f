"""The annulus laid out on the periodic rectangle."""

from dataclasses import dataclass

from meshwind.core.cast import Floats, Kept
from meshwind.mesh.geometry.annulus import Annulus


@dataclass(frozen=True)
class Chart(Kept):
    """A one-to-one map of an annulus to the periodic rectangle, u in turns (period 1), v in [0, 1].

    uv (n, 2) is one representative of each vertex; corner_uv (m, 3, 2) holds the corners of each triangle
    unwrapped, so that a triangle across the seam is whole; flipped counts triangles with area <= 0 (always 0
    in a chart that `flatten` returns); stretch (m,) is the area scale of each triangle, part to rectangle,
    divided by its mean.
    """

    annulus: Annulus
    uv: Floats
    corner_uv: Floats
    flipped: int
    stretch: Floats
