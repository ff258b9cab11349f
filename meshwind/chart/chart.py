"""The annulus laid out on the periodic rectangle."""

from dataclasses import dataclass

from meshwind.core.cast import Floats, PicklableRecord
from meshwind.mesh.geometry.annulus import Annulus


@dataclass(frozen=True)
class Chart(PicklableRecord):
    """One-to-one map of an annulus to the periodic rectangle.

    Attributes
    ----------
    annulus : Annulus
        Mesh with two rims that was flattened.
    uv : ndarray of float, shape (n, 2)
        One representative of each vertex: u in turns, with period 1, and v in [0, 1].
    corner_uv : ndarray of float, shape (m, 3, 2)
        Corners of each triangle with u unwrapped, so that a triangle across the seam is whole.
    flipped : int
        Number of triangles without positive area in the rectangle; 0 in a chart from `flatten`.
    stretch : ndarray of float, shape (m,)
        Area of each triangle on the part over that in the rectangle, divided by its mean.

    Examples
    --------
    >>> import meshwind as mw
    >>> chart = mw.flatten(mw.annulus(mw.read("data/elbow.obj")))
    >>> chart.flipped
    0
    """

    annulus: Annulus
    uv: Floats
    corner_uv: Floats
    flipped: int
    stretch: Floats
