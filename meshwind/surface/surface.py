"""The one surface type: a uniform bicubic tensor B-spline, periodic in u or not."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Kept, floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.threads import spread
from meshwind.surface import evaluate, tree
from meshwind.surface.evaluate import Spline
from meshwind.surface.tree import NO_TREE, Body, SearchTree

DEGREE = 3


@dataclass(frozen=True)
class FitError:
    """How far a fitted surface and its mesh lie apart, in the mesh's units.

    to_surface: distances of the mesh's own vertices to the surface; to_mesh: distances of a dense sample of
    the surface to the mesh's facets.  relative_max is the larger maximum over the mesh's diagonal.
    """

    to_surface_rms: float
    to_surface_max: float
    to_mesh_rms: float
    to_mesh_max: float
    diagonal: float

    @property
    def rms(self) -> float:
        """The larger of the two root mean squares."""
        return max(self.to_surface_rms, self.to_mesh_rms)

    @property
    def max(self) -> float:
        """The larger of the two maxima."""
        return max(self.to_surface_max, self.to_mesh_max)

    @property
    def relative_max(self) -> float:
        """`max` over the diagonal of the mesh's bounding box."""
        return self.max / self.diagonal


@dataclass(frozen=True)
class Surface(Kept):
    """A uniform bicubic B-spline surface s(u, v) with u in turns and v in [0, 1] from end to end.

    control_points (nu, nv, 3); with `periodic` u has nu spans over [0, 1), otherwise nu - 3; v has nv - 3.
    s_u x s_v points outward.  `error` is the fit's certificate, None for an analytic shape.
    """

    control_points: Floats
    periodic: bool = True
    error: FitError | None = None

    def __post_init__(self) -> None:
        points = floats(self.control_points, "control_points", -1, -1, 3)
        if min(points.shape[:2]) < DEGREE + 1:
            raise BadInputError(f"a bicubic surface needs at least 4 x 4 control points, got {points.shape[:2]}")
        object.__setattr__(self, "control_points", frozen(points))

    @property
    def spans(self) -> tuple[int, int]:
        """Number of polynomial pieces in u and in v."""
        nu, nv = self.control_points.shape[:2]
        return (nu if self.periodic else nu - DEGREE), nv - DEGREE

    @cached_property
    def net(self) -> Floats:
        """Control points as the kernels want them: wrapped by three rows in u where periodic."""
        points = self.control_points
        return frozen(np.concatenate([points, points[:DEGREE]]) if self.periodic else points)

    @cached_property
    def knots(self) -> tuple[Floats, Floats]:
        """Knot vectors of u and v, uniform; the basis is that of `scipy.interpolate.BSpline`.

        In u the net is `net`, that is the control points with the first three repeated where periodic.
        """
        return tuple(frozen(np.arange(-DEGREE, n + DEGREE + 1) / n) for n in self.spans)  # type: ignore[return-value]

    @property
    def spline(self) -> Spline:
        """The surface as the evaluation kernels take it."""
        return Spline(self.net, self.periodic)

    @cached_property
    def tree(self) -> SearchTree:
        """The search tree for foot points; built on first use."""
        return SearchTree(*map(frozen, tree.build(self.spline)))

    @property
    def body(self) -> Body:
        """The surface as the contact kernels take it, with its search tree."""
        return Body(self.spline, self.tree, self.size)

    @property
    def untreed(self) -> Body:
        """The body without its search tree, for paths that do not leave the surface."""
        return Body(self.spline, NO_TREE, self.size)

    @cached_property
    def middle(self) -> Floats:
        """Mean of the control points (3,)."""
        return frozen(self.control_points.reshape(-1, 3).mean(axis=0))

    @cached_property
    def centred(self) -> "Surface":
        """The surface about its own middle: kernels that work there lose no digits far from the origin."""
        return Surface(self.control_points - self.middle, self.periodic)

    @cached_property
    def size(self) -> float:
        """Diagonal of the control net's bounding box: the length that tolerances are relative to."""
        return float(np.linalg.norm(np.ptp(self.control_points.reshape(-1, 3), axis=0)))

    def frames(self, uv: ArrayLike) -> Floats:
        """Position and derivatives (n, 6, 3) in the order s, s_u, s_v, s_uu, s_uv, s_vv at uv (n, 2)."""
        where = floats(uv, "uv", -1, 2)
        out = np.empty((len(where), 6, 3))
        spread(evaluate.frames, len(where), 2000, self.spline, where, out)
        return out

    def points(self, uv: ArrayLike) -> Floats:
        """Positions (n, 3) at uv (n, 2), in the surface's units."""
        return self.frames(uv)[:, 0]

    def normals(self, uv: ArrayLike) -> Floats:
        """Outward unit normals (n, 3) at uv (n, 2)."""
        frames = self.frames(uv)
        normal = np.cross(frames[:, 1], frames[:, 2])
        size = np.linalg.norm(normal, axis=1, keepdims=True)
        return np.asarray(np.divide(normal, size, out=np.zeros_like(normal), where=size > 0))
