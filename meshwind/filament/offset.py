"""The surface that the next layer is wound on: the one below, raised by the thickness of the layer."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import TINY
from meshwind.filament.smoothing import smoothed
from meshwind.filament.thickness import Thickness
from meshwind.layup.coverage import between_centres
from meshwind.surface.evaluate import S
from meshwind.surface.forms import fundamental_forms
from meshwind.surface.grid import mean_speeds, midpoints, parameter_grid
from meshwind.surface.interpolate import sites, through
from meshwind.surface.principal import Principal, principal
from meshwind.surface.surface import Surface

_SPEED_SAMPLES = 32
"""Points each way from which the length of a span is taken."""
_PLACES = 3
"""Places each way in a span at which the new surface is compared: its middle alone may be off by two thirds of most."""
_NEWTON_STEPS = 6
"""Newton's steps from a thickness to a height, which differ by less than a part in two: convergence is quadratic."""
TIGHT = 0.5
"""A thickness above this share of a hollow's radius is worth a warning: twice as thick, and the next surface folds."""


@dataclass(frozen=True)
class Raised:
    """A surface raised by a layer, in the surface's units.

    Attributes
    ----------
    surface : Surface
        The new surface, on the same u and v, with as many spans.
    height : ndarray of float, shape (nu, nv)
        By how much it was raised over each cell of the layer's thickness, filler included.
    off_rms, off_max : float
        Distances of the new surface from the points that it stands for, along the normal and sideways, between the
        parameters at which it meets them.
    evened : float
        Root mean square of what smoothing changed the thickness by, over the mean thickness; the volume stays.
    hollow : float
        Largest height over the radius of a hollow of the surface below; from 1 on the offset folds.
    where : tuple of float
        The u and v of that place.
    """

    surface: Surface
    height: Floats
    off_rms: float
    off_max: float
    evened: float
    hollow: float
    where: tuple[float, float]

    __repr__ = brief

    def at(self, uv: Floats) -> Floats:
        """By how much the surface was raised at uv (n, 2), linear between the centres of the cells."""
        return between_centres(self.height, uv)

    @property
    def tight(self) -> bool:
        """Whether a hollow is nearly filled up."""
        return self.hollow > TIGHT


def raised(surface: Surface, layer: Thickness, width: float) -> Raised:
    """Raise a surface by a layer, smoothed over the width of its band, or over a span where that is longer.

    The surface is raised along its normals by the height h at which the volume between both surfaces is that of the
    layer: h + H h^2 + K h^3/3 is the thickness, with the mean curvature H, positive where the surface bulges outward,
    and the Gaussian curvature K.

    Parameters
    ----------
    surface : Surface
        Surface that the layer lies on.
    layer : Thickness
        The layer.
    width : float
        Width of its band, in the surface's units.

    Returns
    -------
    Raised
        The new surface, and how near it is to what it stands for.

    Raises
    ------
    BadInputError
        If the offset folds: the layer is thicker than the radius of a hollow.

    Examples
    --------
    >>> import meshwind as mw
    >>> from meshwind.filament.offset import raised
    >>> from meshwind.filament.thickness import Laying, deposit, tracks
    >>> tube = mw.shapes.cylinder(radius=50.0, length=200.0)
    >>> ends = mw.families(tube, paths=24, revolutions=0.6)
    >>> paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=101)
    >>> layer = deposit(tube, tracks(paths), Laying(width=10.0, thickness=0.2))
    >>> next_one = raised(tube, layer, 10.0).surface
    >>> next_one.spans == tube.spans
    True
    """
    reach = max(width, *(speed / spans for speed, spans in zip(mean_speeds(surface, _SPEED_SAMPLES), surface.spans,
                                                              strict=True)))  # fmt: skip
    whole = layer.cells + layer.filler
    even = smoothed(surface, whole, layer.area, reach)
    at = parameter_grid(sites(surface.spans[0], surface.periodic), sites(surface.spans[1], False))
    points, _ = _offset(surface, at, between_centres(even, at))
    shape = len(sites(surface.spans[0], surface.periodic)), len(sites(surface.spans[1], False))
    net = through(points.reshape(*shape, 3), surface.spans, surface.periodic).control_points
    between = parameter_grid(*(midpoints(_PLACES * spans) for spans in surface.spans))
    height, hollow, where = _hollows(surface, even)
    wanted, _ = _offset(surface, between, between_centres(even, between))
    new = replace(surface, control_points=net)
    off = np.linalg.norm(new.points(between) - wanted, axis=1)
    _check_turned(surface, new, between)
    doubt = surface.uncertainty if surface.uncertainty is not None else np.zeros((1, 1))
    new = replace(new, uncertainty=doubt + float(off.max()))
    mean = float((whole * layer.area).sum() / layer.area.sum())
    change = np.sqrt(((even - whole) ** 2 * layer.area).sum() / layer.area.sum()) / max(mean, TINY)
    return Raised(new, height, float(np.sqrt((off**2).mean())), float(off.max()), float(change), hollow, where)


def _height(thickness: Floats, mean: Floats, gauss: Floats) -> Floats:
    """Heights (m,) of layers of a thickness over surfaces of these curvatures (m,)."""
    h = thickness.copy()
    for _ in range(_NEWTON_STEPS):
        volume = h + mean * h**2 + gauss * h**3 / 3.0 - thickness
        h = h - volume / np.maximum(1.0 + 2.0 * mean * h + gauss * h**2, 0.1)
    return h


def _offset(surface: Surface, uv: Floats, thickness: Floats) -> tuple[Floats, Floats]:
    """Points (m, 3) above uv (m, 2), raised by the heights (m,) of a thickness."""
    frames = surface.frames(uv)
    forms = fundamental_forms(frames)
    bent = principal(frames, forms)
    _check_folds(thickness, bent, uv)
    height = _height(thickness, 0.5 * (bent.largest + bent.smallest), bent.largest * bent.smallest)
    return frames[:, S] + height[:, None] * forms.normal, height


def _hollows(surface: Surface, thickness: Floats) -> tuple[Floats, float, tuple[float, float]]:
    """The heights (nu, nv) over the cells, the largest over a hollow's radius, and the u and v of that."""
    nu, nv = thickness.shape
    uv = parameter_grid(midpoints(nu), midpoints(nv))
    frames = surface.frames(uv)
    bent = principal(frames, fundamental_forms(frames))
    _, height = _offset(surface, uv, thickness.ravel())
    depth = -height * bent.smallest
    worst = int(np.argmax(depth))
    return height.reshape(nu, nv), max(float(depth[worst]), 0.0), (float(uv[worst, 0]), float(uv[worst, 1]))


def _check_folds(thickness: Floats, bent: Principal, uv: Floats) -> None:
    """Raise BadInputError where a layer takes more room than there is up to the middle of a hollow's curvature."""
    hollow = np.maximum(-bent.smallest, TINY)
    # h + H h^2 + K h^3 / 3 at the height h = 1 / hollow is the room
    over = np.where(bent.smallest < 0.0, 6.0 * thickness * hollow**2 / np.maximum(3.0 * hollow + bent.largest, TINY), 0)
    worst = int(np.argmax(over))
    if over[worst] >= 1.0:
        raise BadInputError(
            f"a layer {thickness[worst]:.3g} thick folds in a hollow of radius {1.0 / hollow[worst]:.3g} at "
            f"u={uv[worst, 0]:.3g}, v={uv[worst, 1]:.3g}; give a thinner band or fewer paths"
        )


def _check_turned(below: Surface, above: Surface, uv: Floats) -> None:
    """Raise BadInputError where the new surface faces the other way."""
    facing = (below.normals(uv) * above.normals(uv)).sum(axis=1)
    worst = int(np.argmin(facing))
    if facing[worst] <= 0.0:
        raise BadInputError(
            f"the surface above the layer folds at u={uv[worst, 0]:.3g}, v={uv[worst, 1]:.3g}, where its thickness "
            "changes too fast; give a thinner or a wider band"
        )
