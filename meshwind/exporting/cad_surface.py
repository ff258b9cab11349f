"""Surfaces from STEP and IGES files: the faces that close in one direction."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import IGES, STEP, need, occ, parts_of, read_shape
from meshwind.surface.interpolate import sites, through
from meshwind.surface.surface import FitError, Surface

_COARSEST, _FINEST = 16, 512
_CLOSED = 1e-6
"""Largest distance over the diagonal between ends that form a seam."""
_CUT = 1e-4
"""Largest share of its patch's area that a face may lack; otherwise it is trimmed."""


@dataclass(frozen=True)
class Patch:
    """A rational B-spline patch: poles times weight, and weight, (mu, mv, 4), with knots, degrees, bounds in u and v.

    In a periodic direction, bounds may exceed the knots.
    """

    poles: Floats
    knots: tuple[Floats, Floats]
    degrees: tuple[int, int]
    bounds: tuple[tuple[float, float], tuple[float, float]]
    periodic: tuple[bool, bool]

    def on_grid(self, u: Floats, v: Floats) -> Floats:
        """Positions (p, q, 3) at all u (p,) and v (q,), each from 0 to 1 across the patch."""
        from scipy.interpolate import BSpline

        held = self.poles
        for axis, at in enumerate((u, v)):
            knots, degree, (first, last) = self.knots[axis], self.degrees[axis], self.bounds[axis]
            low, high = float(knots[degree]), float(knots[-degree - 1])
            where = first + at * (last - first)
            if self.periodic[axis]:
                where = low + np.mod(where - low, high - low)
            where = np.clip(where, low, high)
            held = np.moveaxis(BSpline(knots, np.moveaxis(held, axis, 0), degree)(where), 0, axis)
        return np.asarray(held[..., :3] / held[..., 3:])

    def turned(self) -> Patch:
        """The same patch with u and v exchanged."""
        poles = frozen(self.poles.swapaxes(0, 1))
        return Patch(poles, self.knots[::-1], self.degrees[::-1], self.bounds[::-1], self.periodic[::-1])

    def mirrored(self) -> Patch:
        """The same patch with u reversed."""
        return replace(self, bounds=(self.bounds[0][::-1], self.bounds[1]))

    @property
    def size(self) -> float:
        """Diagonal of the bounding box of some of its points."""
        t = np.linspace(0.0, 1.0, 17)
        return float(np.linalg.norm(np.ptp(self.on_grid(t, t).reshape(-1, 3), axis=0)))


def read_cad(path: str | PathLike[str], tolerance: float = 1e-7) -> tuple[Surface, ...]:
    """Read surfaces from a STEP or IGES file.

    Faces that close in one direction are read; each becomes a uniform bicubic surface.  It needs the extra
    ``meshwind[cad]``.

    Parameters
    ----------
    path : str or PathLike
        File to read.
    tolerance : float, default 1e-7
        Largest distance of a surface from its patch, over the size of the surface.

    Returns
    -------
    tuple of Surface
        Surfaces in mm, periodic in u and oriented outwards, the largest first.  `Surface.error` holds how far each is
        off.

    Raises
    ------
    BadInputError
        If the file cannot be read, or if no face closes in one direction; the message says what keeps each from it.

    Examples
    --------
    >>> import subprocess
    >>> import sys
    >>> import meshwind as mw
    >>> result = mw.wind("data/elbow.obj", paths=3, particles=51, units="mm", out="out", render=False)
    >>> command = [sys.executable, "-m", "meshwind", "export", "out", "--to", "step", "--quiet"]
    >>> done = subprocess.run(command, check=True)
    >>> (surface,) = mw.read_cad("out/surface.step")
    >>> surface.periodic
    True
    """
    need()
    name = Path(path)
    kept: list[Patch] = []
    reasons: list[str] = []
    for number, face in enumerate(_faces(name)):
        patch = _patch(face)
        why = "" if patch is not None else "it is cut by more than its two rims"
        if patch is not None:
            why, patch = _closing(patch)
            kept += [] if patch is None else [patch]
        reasons += [f"face {number}: {why}"] if why else []
    if not kept:
        found = "; ".join(reasons[:4]) or "it holds no face"
        raise BadInputError(
            f"{name.name} has no surface that closes in one direction ({found}); give a mesh of the part"
        )
    return tuple(_approximate(patch, tolerance) for patch in sorted(kept, key=lambda p: -p.size))


def _faces(path: Path) -> list[Any]:
    if path.suffix.lower() not in STEP + IGES:
        raise BadInputError(f"{path.name} is neither STEP nor IGES; give one of {', '.join(STEP + IGES)}")
    if not path.is_file():
        raise BadInputError(f"{path} not found; give the path of a STEP or IGES file")
    shape = read_shape(path).shape
    if shape is None:
        return []
    return parts_of(occ("BRepBuilderAPI").BRepBuilderAPI_NurbsConvert(shape, True).Shape(), "FACE")


def _patch(face: Any) -> Patch | None:
    """The face's patch between its bounds in u and v, None if the face is trimmed within them."""
    bounds = occ("BRepTools").BRepTools.UVBounds_s(face)
    spline = occ("BRep").BRep_Tool.Surface_s(face)
    whole = occ("BRepBuilderAPI").BRepBuilderAPI_MakeFace(spline, *bounds, 1e-7)
    areas = [_area(shape) for shape in (face, whole.Face())]
    if abs(areas[0] - areas[1]) > _CUT * areas[1]:
        return None
    return _numbers(spline, bounds)


def _area(shape: Any) -> float:
    properties = occ("GProp").GProp_GProps()
    occ("BRepGProp").BRepGProp.SurfaceProperties_s(shape, properties)
    return float(properties.Mass())


def _numbers(spline: Any, bounds: tuple[float, ...]) -> Patch:
    """Poles, weights and knots as arrays."""
    periodic = bool(spline.IsUPeriodic()), bool(spline.IsVPeriodic())
    spline = spline.Copy()
    spline.SetUNotPeriodic()
    spline.SetVNotPeriodic()
    nu, nv = spline.NbUPoles(), spline.NbVPoles()
    poles = np.empty((nu, nv, 4))
    for i in range(nu):
        for j in range(nv):
            pole, weight = spline.Pole(i + 1, j + 1), spline.Weight(i + 1, j + 1)
            poles[i, j] = pole.X() * weight, pole.Y() * weight, pole.Z() * weight, weight
    u = _repeated(spline.NbUKnots(), spline.UKnot, spline.UMultiplicity)
    v = _repeated(spline.NbVKnots(), spline.VKnot, spline.VMultiplicity)
    degrees = spline.UDegree(), spline.VDegree()
    return Patch(frozen(poles), (u, v), degrees, (tuple(bounds[:2]), tuple(bounds[2:])), periodic)  # type: ignore[arg-type]


def _repeated(count: int, knot: Any, times: Any) -> Floats:
    """The knots, each repeated by its multiplicity."""
    numbers = range(1, count + 1)
    return frozen(np.repeat([knot(k) for k in numbers], [times(k) for k in numbers]))


def _closing(patch: Patch) -> tuple[str, Patch | None]:
    """The patch, oriented to close in u and to face outward, or the reason why it cannot be wound."""
    t = np.linspace(0.0, 1.0, 65)
    samples = patch.on_grid(t, t)
    near = _CLOSED * patch.size
    closed = [bool(np.abs(np.take(samples, 0, a) - np.take(samples, -1, a)).max() < near) for a in (0, 1)]
    if closed[0] == closed[1]:
        return "it closes in both directions" if closed[0] else "it does not close", None
    if closed[1]:
        patch, samples = patch.turned(), samples.swapaxes(0, 1)
    rims = [np.linalg.norm(np.ptp(samples[:, end], axis=0)) for end in (0, -1)]
    if min(rims) < 1e-3 * patch.size:
        return "it ends in a point, which is no opening", None
    return "", patch if _outward(samples) else patch.mirrored()


def _outward(samples: Floats) -> bool:
    """Whether s_u x s_v points outward, by the sign of the volume that the samples enclose with flat ends."""
    middle = samples.mean(axis=(0, 1))
    a = samples - middle
    volume = _volume(a[:-1, :-1], a[1:, :-1], a[1:, 1:]) + _volume(a[:-1, :-1], a[1:, 1:], a[:-1, 1:])
    for end, sense in ((0, -1.0), (-1, 1.0)):
        rim = a[:, end]
        volume += sense * _volume(np.broadcast_to(rim[:-1].mean(axis=0), rim[:-1].shape), rim[:-1], rim[1:])
    return volume > 0.0


def _volume(a: Floats, b: Floats, c: Floats) -> float:
    return float((a * np.cross(b, c)).sum() / 6.0)


def _approximate(patch: Patch, tolerance: float) -> Surface:
    """Interpolate, doubling the spans in each direction that needs it, until the patch is met between the sites."""
    to_u, to_v = _even(patch, 0), _even(patch, 1)
    spans, near = [_COARSEST, _COARSEST], tolerance * patch.size
    while True:
        at = sites(spans[0], True), sites(spans[1], False)
        surface = through(patch.on_grid(to_u(at[0]), to_v(at[1])), (spans[0], spans[1]))
        off = []
        for axis, count in enumerate(spans):
            grid = list(at)
            grid[axis] = (np.arange(2 * count) + 0.25) / (2 * count)
            uv = np.stack(np.meshgrid(*grid, indexing="ij"), axis=2).reshape(-1, 2)
            exact = patch.on_grid(to_u(grid[0]), to_v(grid[1])).reshape(-1, 3)
            off.append(np.linalg.norm(surface.points(uv) - exact, axis=1))
        worst = [float(each.max()) for each in off]
        finer = [count * (1 + (far > near)) for count, far in zip(spans, worst, strict=True)]
        if max(worst) <= near or max(finer) > _FINEST:
            break
        spans = finer
    rms = float(np.sqrt((np.concatenate(off) ** 2).mean()))
    error = FitError(rms, max(worst), rms, max(worst), surface.size)
    return Surface(surface.control_points, True, error)


def _even(patch: Patch, axis: int) -> Callable[[Floats], Floats]:
    """Function from a parameter of constant mean speed to that of the patch, as circles in CAD vary in speed."""
    from scipy.interpolate import PchipInterpolator

    along, across = np.linspace(0.0, 1.0, _FINEST * 4 + 1), (np.arange(8) + 0.5) / 8
    points = patch.on_grid(along, across) if axis == 0 else patch.on_grid(across, along).swapaxes(0, 1)
    length = np.linalg.norm(np.diff(points, axis=0), axis=2).mean(axis=1)
    way = np.concatenate([[0.0], np.cumsum(length)])
    inverse = PchipInterpolator(way / way[-1], along)

    def to(values: Floats) -> Floats:
        return np.asarray(inverse(values))

    return to
