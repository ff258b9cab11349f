"""The mesh with two open ends: what can be cut and flattened."""

from dataclasses import dataclass

from meshwind.core.cast import Bools, Floats, Ints, PicklableRecord
from meshwind.mesh.geometry.mesh import Mesh


@dataclass(frozen=True)
class Annulus(PicklableRecord):
    """Mesh of genus 0 with exactly two boundary loops, its rims, oriented outwards.

    Attributes
    ----------
    mesh : Mesh
        Mesh that was opened.
    vertices : ndarray of float, shape (n, 3)
        Positions, in the mesh's units.
    faces : ndarray of int, shape (m, 3)
        Vertices of each triangle.
    rims : tuple of two ndarray of int
        Vertices of the start rim (v=0) and of the end rim (v=1), in the sense of growing u: counterclockwise as seen
        along the axis from the end towards the start, so that s_u x s_v points outwards.
    trusted : ndarray of bool, shape (n,)
        False for vertices that trimming has made, which lie on the flat facets rather than on the part.
    ends : str
        How the ends were chosen, in words.

    Examples
    --------
    >>> import meshwind as mw
    >>> opened = mw.annulus(mw.read("data/elbow.obj"))
    >>> len(opened.rims)
    2
    """

    mesh: Mesh
    vertices: Floats
    faces: Ints
    rims: tuple[Ints, Ints]
    trusted: Bools
    ends: str
