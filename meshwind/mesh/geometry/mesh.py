"""The triangle mesh of a part, and the annulus: the mesh with two open ends that is flattened."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, PicklableRecord
from meshwind.core.geometry import Block, Geometric
from meshwind.core.units import BY_DEFAULT, GIVEN, Unit


@dataclass(frozen=True)
class Mesh(PicklableRecord, Geometric):
    """Triangle mesh of a part: manifold, in one piece, oriented outwards.

    `read` makes one and repairs it.  A mesh that is built from arrays must be sound already.

    Parameters
    ----------
    vertices : ndarray of float, shape (n, 3)
        Positions, in the unit of the file.
    faces : ndarray of int, shape (m, 3)
        Vertices of each triangle, counted from 0, counterclockwise as seen from outside.
    name : str, default "mesh"
        Name for titles and messages.
    repairs : tuple of str, optional
        What was changed, in words.
    read_vertices, read_faces : int, default 0
        What the file held before it was repaired.
    units : str, default ""
        Unit of length: "mm", "cm", "m", "um", "in" or "ft"; "" if it is not known.
    units_from : str, default ""
        Who named the unit: "given" by the user, "file", or "default" where nobody did, so that it is assumed; words,
        such as "as glTF always is" or "converted from in", where the format did; "" if it is not known.
    warnings : tuple of str, optional
        What the file holds beside the mesh, or was read otherwise than it is written, in words.
    notes : tuple of str, optional
        How the mesh was made from the file, in words.

    Examples
    --------
    >>> import meshwind as mw
    >>> mesh = mw.read("data/elbow.obj")
    >>> mesh.vertices.shape[1], mesh.faces.shape[1], mesh.name
    (3, 3, 'elbow.obj')
    """

    vertices: Floats
    faces: Ints
    name: str = "mesh"
    repairs: tuple[str, ...] = ()
    read_vertices: int = 0
    read_faces: int = 0
    units: str = ""
    units_from: str = ""
    warnings: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    __repr__ = brief

    @property
    def block(self) -> Block:
        """The triangles."""
        return Block(self.vertices, triangles=self.faces)

    @property
    def size(self) -> tuple[float, float, float]:
        """Extents along x, y and z, in the mesh's units."""
        x, y, z = (float(extent) for extent in np.ptp(self.vertices, axis=0))
        return x, y, z

    @property
    def diagonal(self) -> float:
        """Diagonal of the bounding box, in the mesh's units."""
        return float(np.linalg.norm(np.ptp(self.vertices, axis=0)))

    def in_units(self, given: str | None, assumed: str = "") -> Mesh:
        """Name the unit of the mesh; nothing is converted.

        Parameters
        ----------
        given : str or None
            Unit that the user gives; it outranks the one that the file names, with a warning.  None keeps the mesh's.
        assumed : str, default ""
            Unit of a mesh that has none.

        Returns
        -------
        Mesh
            The same mesh with its unit.

        Raises
        ------
        BadInputError
            If a unit is not known.

        Examples
        --------
        >>> import meshwind as mw
        >>> mw.read("data/elbow.obj").in_units("in").units
        'in'
        """
        if given is None and self.units:
            return self
        named = self.units_from not in (GIVEN, BY_DEFAULT)
        unit = Unit.of(given, Unit(self.units, self.units_from) if named else Unit(), assumed)
        warnings = (*self.warnings, unit.warning) if unit.warning else self.warnings
        return replace(self, units=unit.name, units_from=unit.named_by, warnings=warnings)


@dataclass(frozen=True)
class Wall(PicklableRecord):
    """The wall of a part, of which one skin is wound.

    side: "outer" or "inner", the skin that is wound; thickness: median of the wall; left_out: share of the part's
    surface that belongs to neither skin; skin: the one that is wound; opposite (k, 3): faces of the part's mesh on the
    other one.
    """

    side: str
    thickness: float
    left_out: float
    skin: Mesh
    opposite: Ints


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
    notes : tuple of str, default ()
        What was decided for the user, in words: the skin of a part with a wall, a plane in place of a level line.
    wall : Wall, optional
        Wall of a part whose skin this is: its `side`, "outer" or "inner", and its median `thickness`.  None for other
        parts.
    warnings : tuple of str, default ()
        Branches and wide holes that were closed, in words.
    caps : tuple of two bool, default (False, False)
        Whether the start and the end are closed ends of the part, at which an opening was cut, rather than rims of it.

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
    notes: tuple[str, ...] = ()
    wall: Wall | None = None
    warnings: tuple[str, ...] = ()
    caps: tuple[bool, bool] = (False, False)

    __repr__ = brief
