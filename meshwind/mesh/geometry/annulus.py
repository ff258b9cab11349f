"""The mesh with two open ends: what can be cut and flattened."""

from dataclasses import dataclass

from meshwind.core.cast import Bools, Floats, Ints, Kept
from meshwind.mesh.geometry.mesh import Mesh


@dataclass(frozen=True)
class Annulus(Kept):
    """A mesh of genus 0 with exactly two boundary loops, outward oriented.

    vertices (n, 3) and faces (m, 3) are the trimmed mesh; rims are the two loops of vertex indices, the start
    (v=0) and the end (v=1), both ordered in the sense of growing u (counterclockwise as seen along the axis
    from the end towards the start, so that s_u x s_v points outward); trusted (n,) bool is False at vertices
    that trimming made, which lie on the flat facets rather than on the part; ends says in words how the ends
    were chosen.
    """

    mesh: Mesh
    vertices: Floats
    faces: Ints
    rims: tuple[Ints, Ints]
    trusted: Bools
    ends: str
