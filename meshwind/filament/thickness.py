"""The thickness of the laminate: the volume of the bands, deposited on the cells of the surface."""

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import TINY
from meshwind.layup.bands import cells_for
from meshwind.layup.coverage import add_lengths, between_centres, cell_areas
from meshwind.path.paths import Paths
from meshwind.surface.evaluate import SU, SUU, SV, SVV
from meshwind.surface.forms import components
from meshwind.surface.surface import Surface

FLAT, LENS = SECTIONS = ("flat", "lens")
"""Sections of a band: of even thickness, or a parabola that is 0 at both edges."""
HOLLOW, FILLED = BRIDGED = ("hollow", "filled")
"""What becomes of the room below a bridge: it stays, or it is filled up to the fibre before the next layer."""
_STRIPS = 24
"""Strips across a band: four to each of the cells, of which about six lie across."""


@dataclass(frozen=True)
class Laying:
    """How a fibre lies: as a band of a width and a mean thickness, in the surface's units.

    Parameters
    ----------
    width, thickness : float
        Of the band, in the surface's units, above 0.
    section : {"flat", "lens"}, default "flat"
        Thickness across the band: even, or 3/2 (1 - x^2) times the mean, with x from -1 to 1.
    bridges : {"hollow", "filled"}, default "hollow"
        What becomes of the room below a bridge.

    Raises
    ------
    BadInputError
        If a number or a word cannot be used.
    """

    width: float
    thickness: float
    section: str = FLAT
    bridges: str = HOLLOW

    def __post_init__(self) -> None:
        for name in ("width", "thickness"):
            value = getattr(self, name)
            if not 0.0 < value < np.inf:
                raise BadInputError(f"the band's {name} is {value:g}; give a length above 0 in the part's units")
        for name, words in (("section", SECTIONS), ("bridges", BRIDGED)):
            if getattr(self, name) not in words:
                raise BadInputError(f"{name} is {getattr(self, name)!r}; give {' or '.join(words)}")

    def shares(self, strips: int) -> Floats:
        """Shares (strips,) of the band's volume in equal strips across it; their sum is 1."""
        x = np.linspace(-1.0, 1.0, strips + 1)
        passed = 0.5 * x if self.section == FLAT else 0.75 * (x - x**3 / 3.0)
        shares = np.diff(passed)
        return np.asarray(shares / shares.sum())


@dataclass(frozen=True)
class Tracks:
    """Where p fibres of n points lie on a surface: uv (p, n, 2) of their feet, and gap (p, n) above these.

    steps (p, n - 1): length of the fibre from each point to the next, in the surface's units.
    """

    uv: Floats
    steps: Floats
    gap: Floats

    __repr__ = brief

    @property
    def length(self) -> float:
        """Length of all fibres."""
        return float(self.steps.sum())


def tracks(paths: Paths) -> Tracks:
    """Where paths lie; the steps of each add up to its `length`, which is more exact than its polyline."""
    steps = np.linalg.norm(np.diff(paths.points, axis=1), axis=2)
    exact = paths.length / np.maximum(steps.sum(axis=1), TINY)
    return Tracks(paths.uv, frozen(steps * exact[:, None]), paths.gap)


@dataclass(frozen=True)
class Thickness:
    """Thickness of a layer over the cells of an even grid on the (u, v) rectangle, which closes in u.

    Attributes
    ----------
    cells : ndarray of float, shape (nu, nv)
        Mean thickness over each cell, in the surface's units.
    filler : ndarray of float, shape (nu, nv)
        Mean height of what fills the room below bridges; 0 where they stay hollow.
    area : ndarray of float, shape (nu, nv)
        Areas of the cells.
    over_rim : float
        Volume of the parts of bands that hang over a rim: it is in `cells`, mirrored at the rim, where it stands for
        the corner on the other side of the fibre, which the turnaround covers.
    """

    cells: Floats
    filler: Floats
    area: Floats
    over_rim: float

    __repr__ = brief

    @property
    def volume(self) -> float:
        """Volume of the bands: thickness times area, summed."""
        return float((self.cells * self.area).sum())

    @property
    def min(self) -> float:
        """Least thickness of a cell."""
        return float(self.cells.min())

    @property
    def median(self) -> float:
        """Median thickness over the cells."""
        return float(np.median(self.cells))

    @property
    def max(self) -> float:
        """Largest thickness of a cell."""
        return float(self.cells.max())

    @property
    def mean(self) -> float:
        """Mean thickness over the area."""
        return self.volume / float(self.area.sum())

    def and_(self, other: "Thickness") -> "Thickness":
        """The thickness of both, over the same cells."""
        return replace(
            self,
            cells=frozen(self.cells + other.cells),
            filler=frozen(np.maximum(self.filler, other.filler)),
            over_rim=self.over_rim + other.over_rim,
        )

    def at(self, uv: Floats) -> Floats:
        """Thickness at uv (n, 2), linear between the centres of the cells."""
        return between_centres(self.cells, uv)

    def along(self) -> Floats:
        """Mean thickness (nv,) of each ring of cells, from the start rim to the end rim."""
        return np.asarray((self.cells * self.area).sum(axis=0) / self.area.sum(axis=0))


def deposit(surface: Surface, laid: Tracks, laying: Laying) -> Thickness:
    """Deposit the volume of bands on the surface.

    Each band is cut into strips along its fibre, which lie beside it along geodesics square to it. A strip has the
    fibre's length, also where the surface or a bend makes it longer or shorter, so that the volume is width times
    thickness times length of the fibres, to round-off. A bridge lies at its feet.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    laid : Tracks
        Fibres on it: `tracks(paths)`, or those of a hoop.
    laying : Laying
        The band.

    Returns
    -------
    Thickness
        Thickness over cells, about six of them across the band.

    Raises
    ------
    BadInputError
        If the surface is open in u.

    Examples
    --------
    >>> import meshwind as mw
    >>> from meshwind.filament.thickness import Laying, deposit, tracks
    >>> tube = mw.shapes.cylinder(radius=50.0, length=200.0)
    >>> ends = mw.families(tube, paths=8, revolutions=0.6)
    >>> paths = mw.solve(tube, ends.start, ends.end, family=ends.family, particles=101)
    >>> layer = deposit(tube, tracks(paths), Laying(width=10.0, thickness=0.2))
    >>> bool(abs(layer.volume / (10.0 * 0.2 * paths.length.sum()) - 1.0) < 1e-9)
    True
    """
    if not surface.periodic:
        raise BadInputError("the thickness is deposited on parts that close in u only; wind a part that does")
    nu, nv = cells_for(surface, laying.width)
    area = cell_areas(surface, nu, nv)
    length, raised, over = (np.zeros((nu, nv)) for _ in range(3))
    between = 0.5 * (laid.gap[:, 1:] + laid.gap[:, :-1])
    lifted = laying.bridges == FILLED and bool((between > 0.0).any())
    for at, past, share in _strips(surface, laid.uv, laying):
        add_lengths(at, share * laid.steps, length)
        if past.any():
            add_lengths(at, share * laid.steps * 0.5 * (past[:, 1:] + past[:, :-1]), over)
        if lifted:
            add_lengths(at, share * laid.steps * between, raised)
    section = laying.width * laying.thickness
    cells = np.divide(section * length, area, out=np.zeros_like(length), where=area > 0.0)
    height = np.divide(raised, length, out=np.zeros_like(length), where=length > 0.0)
    filler = height * np.minimum(cells / laying.thickness, 1.0)
    return Thickness(frozen(cells), frozen(filler), frozen(area), float(section * over.sum()))


def _strips(surface: Surface, uv: Floats, laying: Laying) -> Iterator[tuple[Floats, Floats, float]]:
    """The strips of all bands: the parameters (p, n, 2) of each one's middle, where it is past a rim, and its share.

    Past a rim (p, n) is 1 where the geodesic to the strip was mirrored at one, otherwise 0.
    """
    shares, half = laying.shares(_STRIPS), _STRIPS // 2
    apart = laying.width / _STRIPS
    for side in (1.0, -1.0):
        state = _square(surface, uv, side)
        past = np.zeros(uv.shape[:2], dtype=np.bool_)
        for k in range(half):
            state = _further(surface, state, apart if k else 0.5 * apart)
            state, met = _mirrored(surface, state)
            past ^= met.reshape(past.shape)
            at = half + k if side > 0.0 else half - 1 - k
            yield np.ascontiguousarray(state[:, :2].reshape(uv.shape)), past.astype(np.float64), float(shares[at])


def _mirrored(surface: Surface, state: Floats) -> tuple[Floats, Bools]:
    """Geodesics (m, 4) that are past a rim, sent back from it as light from a mirror, and which these are (m,)."""
    v = state[:, 1]
    met = (v < 0.0) | (v > 1.0)
    if not met.any():
        return state, met
    out = state.copy()
    out[met, 1] = np.clip(np.where(v[met] > 1.0, 2.0 - v[met], -v[met]), 0.0, 1.0)
    frames = surface.frames(np.ascontiguousarray(out[met, :2]))
    su, sv = frames[:, SU], frames[:, SV]
    slant = (su * sv).sum(axis=1) / np.maximum((su * su).sum(axis=1), TINY)  # s_v - slant s_u is square to the rim
    out[met, 2] += 2.0 * slant * state[met, 3]
    out[met, 3] = -state[met, 3]
    return out, met


def _square(surface: Surface, uv: Floats, side: float) -> Floats:
    """Where the geodesics square to the fibres start: (m, 4) rows u, v, and their rates over arc length."""
    step = np.gradient(uv, axis=1, edge_order=2 if uv.shape[1] > 2 else 1).reshape(-1, 2)
    at = np.ascontiguousarray(uv.reshape(-1, 2))
    frames = surface.frames(at)
    su, sv = frames[:, SU], frames[:, SV]
    e, f, g = ((a * b).sum(axis=1) for a, b in ((su, su), (su, sv), (sv, sv)))
    p, q = step[:, 0], step[:, 1]
    speed = np.sqrt(np.maximum(e * p * p + 2.0 * f * p * q + g * q * q, TINY))
    area = np.sqrt(np.maximum(e * g - f * f, TINY))
    scale = side / (speed * area)
    return np.stack([at[:, 0], at[:, 1], -scale * (f * p + g * q), scale * (e * p + f * q)], axis=1)


def _further(surface: Surface, state: Floats, step: float) -> Floats:
    """Geodesics (m, 4) a step further, by the classic method of Runge and Kutta (3.22)."""
    first = _rates(surface, state)
    second = _rates(surface, state + 0.5 * step * first)
    third = _rates(surface, state + 0.5 * step * second)
    fourth = _rates(surface, state + step * third)
    return np.asarray(state + step / 6.0 * (first + 2.0 * second + 2.0 * third + fourth))


def _rates(surface: Surface, state: Floats) -> Floats:
    """The right-hand side (m, 4) of the geodesic equations; rest where the surface has no tangent plane."""
    frames = surface.frames(np.ascontiguousarray(state[:, :2]))
    p, q = state[:, 2], state[:, 3]
    squares = np.stack([p * p, 2.0 * p * q, q * q], axis=1)[:, :, None]
    bend = (frames[:, SUU : SVV + 1] * squares).sum(axis=1)
    return np.concatenate([state[:, 2:], -components(frames, bend)], axis=1)
