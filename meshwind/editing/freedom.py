"""How the control net may move: frozen control points and rotational symmetry."""

from collections.abc import Callable
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.surface.surface import Surface

Frozen: TypeAlias = ArrayLike | Callable[[Floats], ArrayLike] | None
"""A mask (nu, nv) of control points, or a function from their positions (m, 3) to a mask (m,)."""


def frozen_mask(surface: Surface, frozen: Frozen) -> Bools:
    """Mask (nu, nv) of the control points that must not move; raises BadInputError for another shape."""
    shape = surface.control_points.shape[:2]
    if frozen is None:
        return np.zeros(shape, dtype=bool)
    if callable(frozen):
        given = np.asarray(frozen(surface.control_points.reshape(-1, 3)))
        wanted: tuple[int, ...] = (shape[0] * shape[1],)
    else:
        given, wanted = np.asarray(frozen), shape
    if given.shape != wanted or given.dtype != np.bool_:
        raise BadInputError(f"frozen has shape {given.shape} of {given.dtype}; give a mask of bools of shape {wanted}")
    return np.asarray(given.reshape(shape))


def free_moves(surface: Surface, frozen: Bools, order: int = 1) -> sparse.csr_array:
    """Unit columns (3m, r) that span the allowed moves.

    order: of the rotational symmetry about u.  All control points with the same v and u mod 1/order then move alike in
    the part's cylindrical frame; where one of them is frozen, all are.
    """
    nu, nv = frozen.shape
    if order == 1:
        free = np.flatnonzero(np.repeat(~frozen.ravel(), 3))
        return sparse.eye_array(3 * nu * nv, format="csc")[:, free].tocsr()
    _check_order(surface, order)
    row, column = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    orbit = (row % (nu // order)) * nv + column
    fixed = np.zeros(orbit.max() + 1, dtype=bool)
    fixed[orbit[frozen]] = True
    frames = _cylindrical(surface.control_points.reshape(-1, 3), surface) / np.sqrt(order)
    number = np.cumsum(~fixed) - 1
    points = np.flatnonzero(~fixed[orbit.ravel()])
    at: Ints = number[orbit.ravel()[points]]
    rows = np.broadcast_to(3 * points[:, None, None] + np.arange(3)[:, None], (len(points), 3, 3))
    columns = np.broadcast_to(3 * at[:, None, None] + np.arange(3), (len(points), 3, 3))
    value = frames[points].transpose(0, 2, 1)
    shape = (3 * nu * nv, 3 * int((~fixed).sum()))
    return sparse.csr_array((value.ravel(), (rows.ravel(), columns.ravel())), shape=shape)


def _check_order(surface: Surface, order: int) -> None:
    nu = surface.control_points.shape[0]
    if not isinstance(order, int | np.integer) or order < 1 or not surface.periodic or nu % order:
        fit = ", ".join(str(k) for k in range(1, nu + 1) if nu % k == 0) if surface.periodic else "1"
        raise BadInputError(f"symmetry {order} does not fit the control net with {nu} points around; give one of {fit}")


def _cylindrical(points: Floats, surface: Surface) -> Floats:
    """Unit vectors (m, 3, 3) outward, around and along the axis through the centres of the net's rows."""
    rings = surface.control_points.mean(axis=0)
    middle = rings.mean(axis=0)
    axis = np.linalg.svd(rings - middle)[2][0]
    from_axis = points - middle - ((points - middle) @ axis)[:, None] * axis
    size = np.linalg.norm(from_axis, axis=1, keepdims=True)
    if size.min() < 1e-9 * surface.size:
        raise BadInputError("symmetry needs an axis that the control net stays off; this part has none: give 1")
    outward = from_axis / size
    along = np.broadcast_to(axis, outward.shape)
    return np.stack([outward, np.cross(along, outward), along], axis=1)
