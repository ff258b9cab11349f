"""The one surface type: a uniform bicubic tensor B-spline, periodic in u or not."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, PicklableRecord, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block, Geometric
from meshwind.core.threads import parallel_for
from meshwind.core.vectors import unit
from meshwind.surface import evaluate, tree
from meshwind.surface.evaluate import DEGREE, SU, SV, Spline
from meshwind.surface.grid import grid
from meshwind.surface.tree import NO_TREE, Body, SearchTree

if TYPE_CHECKING:
    from meshwind.surface.rims import Rim

_LEAST, _MOST = 1e-50, 1e50
"""Sizes of a surface: fourth powers of lengths beside them overflow, or underflow, where u and v are found."""


@dataclass(frozen=True)
class FitError:
    """Distances between a fitted surface and its mesh.

    Attributes
    ----------
    to_surface_rms, to_surface_max : float
        Root mean square and maximum of the distances from the mesh's own vertices to the surface, in the mesh's units.
    to_mesh_rms, to_mesh_max : float
        Root mean square and maximum of the distances from a dense sample of the surface to the mesh's facets, in the
        mesh's units.
    diagonal : float
        Diagonal of the mesh's bounding box, in the mesh's units.
    data : str
        What led the fit: "vertices"; or "facets" where the vertices do not lie on the part, or do not determine a net;
        or "curved facets", smooth triangles through vertices that do.
    noise : float
        Root mean square noise found in the vertices, in the mesh's units.
    sagitta : float
        Root mean square distance of the facets from a smooth part that they straddle, in the mesh's units.

    Examples
    --------
    >>> import meshwind as mw
    >>> surface = mw.fit(mw.flatten(mw.annulus(mw.read("data/elbow.obj"))))
    >>> surface.error.relative_max < 1e-3
    True
    """

    to_surface_rms: float
    to_surface_max: float
    to_mesh_rms: float
    to_mesh_max: float
    diagonal: float
    data: str = "vertices"
    noise: float = 0.0
    sagitta: float = 0.0

    @property
    def rms(self) -> float:
        """The larger of the two root mean squares, in the mesh's units."""
        return max(self.to_surface_rms, self.to_mesh_rms)

    @property
    def max(self) -> float:
        """The larger of the two maxima, in the mesh's units."""
        return max(self.to_surface_max, self.to_mesh_max)

    @property
    def relative_max(self) -> float:
        """The larger of the two maxima, over the diagonal of the mesh's bounding box."""
        return self.max / self.diagonal


@dataclass(frozen=True)
class Surface(PicklableRecord, Geometric):
    """Uniform bicubic B-spline surface s(u, v), with u in turns and v in [0, 1] from end to end.

    All surfaces are of this type: those that `fit` makes from a mesh, the analytic ones of `shapes`, and those read
    from images and CAD files.  It is immutable.

    Parameters
    ----------
    control_points : array_like of float, shape (nu, nv, 3)
        Control net, in the unit of the part, at least 4 x 4.  s_u x s_v must point out of the part.
    periodic : bool, default True
        Whether the surface closes in u.  It has nu spans over u in [0, 1) if so, otherwise nu - 3; v has nv - 3.
    error : FitError, optional
        Error of the fit.  None, the default, for a surface that was not fitted to a mesh.
    uncertainty : ndarray of float, shape (rows, columns), optional
        How far the surface may lie off the true part, in its units, in equal cells over u and v.  None, the default,
        for a surface that is exact.
    threshold : float, optional
        Gap up to which a fibre counts as lying on the surface, in its units.  None, the default, for `uncertainty`.

    Raises
    ------
    BadInputError
        If the control net has another shape, is too small, holds values that are not finite, or reaches over more than
        1e50 units or less than 1e-50.

    See Also
    --------
    fit : Fit a surface to a flattened mesh.
    shapes : Analytic surfaces.

    Examples
    --------
    >>> import meshwind as mw
    >>> surface = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> surface.spans
    (128, 8)
    >>> surface.points([(0.25, 0.5)]).round(6) + 0.0
    array([[0. , 1. , 1.5]])
    """

    control_points: Floats
    periodic: bool = True
    error: FitError | None = None
    uncertainty: Floats | None = None
    threshold: float | None = None

    __repr__ = brief

    def __post_init__(self) -> None:
        points = floats(self.control_points, "control_points", -1, -1, 3)
        if min(points.shape[:2]) < DEGREE + 1:
            raise BadInputError(f"a bicubic surface needs at least 4 x 4 control points, got {points.shape[:2]}")
        extent = float(np.ptp(points.reshape(-1, 3), axis=0).max())
        if extent and not _LEAST < extent < _MOST:
            raise BadInputError(f"a surface {extent:g} across is out of range; scale it to ordinary units")
        object.__setattr__(self, "control_points", frozen(points))

    @property
    def block(self) -> Block:
        """The surface as the grid of quads that surface.vtu has, with parameters and outward unit normals."""
        on = grid(self)
        return Block(on.points, quads=on.quads, point_data={"uv": on.uv, "normal": on.normals})

    @property
    def spans(self) -> tuple[int, int]:
        """Number of polynomial pieces in u and in v."""
        nu, nv = self.control_points.shape[:2]
        return (nu if self.periodic else nu - DEGREE), nv - DEGREE

    @cached_property
    def net(self) -> Floats:
        """Control points as the kernels take them: extended by three rows in u where the surface is periodic."""
        points = self.control_points
        return frozen(np.concatenate([points, points[:DEGREE]]) if self.periodic else points)

    @cached_property
    def knots(self) -> tuple[Floats, Floats]:
        """Knot vectors of u and v, uniform; the basis is that of `scipy.interpolate.BSpline`.

        In u the control points that go with them are `net`: the first three are repeated where the surface is
        periodic.
        """
        return tuple(frozen(np.arange(-DEGREE, n + DEGREE + 1) / n) for n in self.spans)  # type: ignore[return-value]

    @property
    def spline(self) -> Spline:
        """The surface as the evaluation kernels take it."""
        return Spline(self.net, self.periodic)

    @cached_property
    def rims(self) -> dict[float, Rim]:
        """The rings that `rims.rim` has measured, by v."""
        return {}

    @cached_property
    def tree(self) -> SearchTree:
        """Search tree for foot points, built on first use."""
        return SearchTree(*map(frozen, tree.build(self.spline)))

    @property
    def body(self) -> Body:
        """The surface as the contact kernels take it, with its search tree."""
        return Body(self.spline, self.tree, self.size)

    @property
    def body_without_tree(self) -> Body:
        """The surface as the contact kernels take it, without a search tree: for paths that cannot leave it."""
        return Body(self.spline, NO_TREE, self.size)

    @cached_property
    def middle(self) -> Floats:
        """Mean (3,) of the control points, in the surface's units."""
        return frozen(self.control_points.reshape(-1, 3).mean(axis=0))

    @cached_property
    def centred(self) -> Surface:
        """The surface moved to its own middle, where kernels lose no digits far from the origin."""
        return Surface(self.control_points - self.middle, self.periodic)

    @cached_property
    def size(self) -> float:
        """Diagonal of the control net's bounding box, the length that tolerances are relative to."""
        return float(np.linalg.norm(np.ptp(self.control_points.reshape(-1, 3), axis=0)))

    def uncertainty_at(self, uv: ArrayLike) -> Floats:
        """How far the surface may lie off the true part, bilinear between the cells of `uncertainty`.

        Parameters
        ----------
        uv : array_like of float, shape (n, 2)
            Parametric positions.

        Returns
        -------
        ndarray of float, shape (n,)
            Lengths in the surface's unit, 0 where the surface is exact.

        Examples
        --------
        >>> import meshwind as mw
        >>> mw.shapes.cylinder(1.0, 3.0).uncertainty_at([(0.25, 0.5)])
        array([0.])
        """
        where, table = floats(uv, "uv", -1, 2), self.uncertainty
        if table is None:
            return np.zeros(len(where))
        rows, columns = table.shape
        x, y = where[:, 0] * rows - 0.5, np.clip(where[:, 1] * columns - 0.5, 0.0, columns - 1.0)
        if not self.periodic:
            x = np.clip(x, 0.0, rows - 1.0)
        i, j = np.floor(x).astype(np.int64), np.minimum(y.astype(np.int64), max(columns - 2, 0))
        x, y = x - i, y - j
        near = [table[(i + a) % rows, np.minimum(j + b, columns - 1)] for a in (0, 1) for b in (0, 1)]
        return np.asarray((1 - x) * ((1 - y) * near[0] + y * near[1]) + x * ((1 - y) * near[2] + y * near[3]))

    def threshold_at(self, uv: ArrayLike) -> Floats:
        """Gap up to which a fibre counts as lying on the surface: `threshold`, or the uncertainty where it is None.

        Parameters
        ----------
        uv : array_like of float, shape (n, 2)
            Parametric positions.

        Returns
        -------
        ndarray of float, shape (n,)
            Lengths in the surface's unit.

        Examples
        --------
        >>> import meshwind as mw
        >>> from dataclasses import replace
        >>> tube = replace(mw.shapes.cylinder(1.0, 3.0), threshold=0.01)
        >>> tube.threshold_at([(0.25, 0.5)])
        array([0.01])
        """
        return (
            self.uncertainty_at(uv) if self.threshold is None else np.full(len(floats(uv, "uv", -1, 2)), self.threshold)
        )

    def frames(self, uv: ArrayLike) -> Floats:
        """Evaluate position and derivatives.

        Parameters
        ----------
        uv : array_like of float, shape (n, 2)
            Parametric points: u in turns, wrapped where the surface is periodic, and v in [0, 1].

        Returns
        -------
        ndarray of float, shape (n, 6, 3)
            Rows s, s_u, s_v, s_uu, s_uv, s_vv of each point, in the surface's units (u and v have none).

        Examples
        --------
        >>> import meshwind as mw
        >>> mw.shapes.cylinder(1.0, 3.0).frames([(0.25, 0.5)])[0, 2].round(6) + 0.0  # s_v
        array([0., 0., 3.])
        """
        where = floats(uv, "uv", -1, 2)
        out = np.empty((len(where), 6, 3))
        parallel_for(evaluate.frames, len(where), 2000, self.spline, where, out)
        return out

    def points(self, uv: ArrayLike) -> Floats:
        """Evaluate positions.

        Parameters
        ----------
        uv : array_like of float, shape (n, 2)
            Parametric points, as for `frames`.

        Returns
        -------
        ndarray of float, shape (n, 3)
            Positions, in the surface's units.

        Examples
        --------
        >>> import meshwind as mw
        >>> mw.shapes.cylinder(1.0, 3.0).points([(0.5, 1.0)]).round(6) + 0.0
        array([[-1.,  0.,  3.]])
        """
        where = floats(uv, "uv", -1, 2)
        out = np.empty((len(where), 3))
        parallel_for(evaluate.positions, len(where), 5000, self.spline, where, out)
        return out

    def normals(self, uv: ArrayLike) -> Floats:
        """Evaluate unit normals.

        Parameters
        ----------
        uv : array_like of float, shape (n, 2)
            Parametric points, as for `frames`.

        Returns
        -------
        ndarray of float, shape (n, 3)
            Unit normals that point outwards; zero where the surface has no tangent plane.

        Examples
        --------
        >>> import meshwind as mw
        >>> mw.shapes.cylinder(1.0, 3.0).normals([(0.25, 0.5)]).round(6) + 0.0
        array([[0., 1., 0.]])
        """
        frames = self.frames(uv)
        return unit(np.cross(frames[:, SU], frames[:, SV]))
