"""What is to be seen on each picture, as records that travel to the process that draws.

Gathered by the `*_scene` modules, drawn by the `*_picture` modules of the same names.  Loads nothing heavy, as both
processes need it.
"""

import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from pathlib import Path
from types import NoneType, UnionType
from typing import Any, TypeAlias, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from meshwind.appearance.looks import Scale
from meshwind.appearance.view import View
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.pictures.page import Page


@dataclass(frozen=True)
class Frame:
    """What every picture has: its words, the name of the unit of length, and the side that it is seen from."""

    title: str
    subtitle: str
    units: str
    view: View


@dataclass(frozen=True)
class Part:
    """The surface: outward quads (q, 4) between points (k, 3) with normals (k, 3) of any length.

    pitch: mean distance from fibre to fibre of a family on it, in mesh units.
    """

    points: Floats
    quads: Ints
    normals: Floats
    pitch: float


@dataclass(frozen=True)
class Fibres:
    """The fibres as points (p, n, 3), and where to lift them (p, n, 3), in radii of the tube; which converged (p,)."""

    points: Floats
    lift: Floats
    family: Ints
    converged: Bools


@dataclass(frozen=True)
class BridgeLines:
    """The bridges as polylines one after the other, of so many points each: points and lift (k, 3), gap (k,).

    path and particle (k,) say which particle a point is.
    """

    points: Floats
    lift: Floats
    gap: Floats
    path: Ints
    particle: Ints
    sizes: Ints


@dataclass(frozen=True)
class WindingScene:
    """The part, the fibres of both families, and the bridges coloured by their gap."""

    frame: Frame
    part: Part
    fibres: Fibres
    bridges: BridgeLines
    max_gap: float


@dataclass(frozen=True)
class AnimationScene:
    """A winding with how much fibre is laid before each point of its fibres (p, n) and of its bridges (k,).

    total: length of all; spin (3,): the axis that the part turns about, by so many turns; frames: how many, so many a
    second; movies: the files; encoder: FFmpeg's executable.
    """

    winding: WindingScene
    laid: Floats
    bridge_laid: Floats
    total: float
    spin: Floats
    turns: int
    frames: int
    frames_per_second: int
    movies: tuple[str, ...]
    encoder: str


@dataclass(frozen=True)
class CrossingsScene:
    """The crossings (c, 3), with the surface's normals (c, 3) there, and where they lie on the scale (c,)."""

    frame: Frame
    part: Part
    fibres: Fibres
    scale: Scale
    shares: Floats
    points: Floats
    normals: Floats


@dataclass(frozen=True)
class Fans:
    """Directions that press at some points: points, normals, middle directions (f, 3), angle to both sides (f,).

    size: radius of a fan, in mesh units.
    """

    points: Floats
    normals: Floats
    directions: Floats
    reach: Floats
    size: float


@dataclass(frozen=True)
class MapScene:
    """A map on the part: where its values lie on the scale (k,), and fans of directions, if it has them."""

    frame: Frame
    part: Part
    scale: Scale
    shares: Floats
    fans: Fans | None = None


@dataclass(frozen=True)
class SlipScene:
    """The fibres by their slip: where it lies on the scale (p, n), NaN where it is not defined.

    needed: whether any fibre needs friction; bridges: whether any leaves the surface.
    """

    frame: Frame
    part: Part
    fibres: Fibres
    scale: Scale
    shares: Floats
    needed: bool
    bridges: bool


@dataclass(frozen=True)
class QuadsScene:
    """The quad mesh: quads (q, 4) and triangles (t, 3) between corners (n, 3); which are off the surface (n,)."""

    frame: Frame
    part: Part
    corners: Floats
    off: Bools
    quads: Ints
    triangles: Ints


@dataclass(frozen=True)
class UnrolledScene:
    """The chart as an image (h, w, 3) and the fibres on it, uv (p, n, 2), with where they bridge (p, n)."""

    frame: Frame
    image: Floats
    uv: Floats
    bridging: Bools
    family: Ints
    converged: Bools


@dataclass(frozen=True)
class MeasuredBody:
    """Triangles (m, 3) between points (n, 3), each with its distance (n,) to another body."""

    points: Floats
    faces: Ints
    distances: Floats


@dataclass(frozen=True)
class FitScene:
    """The mesh and the surface by their distance, and the worst place from near.

    pairs (r, 2, 3): a point on the mesh and one on the surface for each region that the surface misses, their
    distances (r,), and whether each is in sight (r, 2); most: end of the scale; edge: usual length of the mesh's;
    close_up: half the width of the view from near.
    """

    frame: Frame
    diagonal: float
    mesh: MeasuredBody
    surface: MeasuredBody
    edge: float
    most: float
    pairs: Floats
    seen: Bools
    distances: Floats
    close_up: float


@dataclass(frozen=True)
class RedesignScene:
    """Vertices (n, 3) before and after, with faces (m, 3), and where the displacement lies on the scale (n,)."""

    frame: Frame
    scale: Scale
    shares: Floats
    before: Floats
    after: Floats
    faces: Ints


Scene: TypeAlias = (
    WindingScene
    | AnimationScene
    | CrossingsScene
    | MapScene
    | SlipScene
    | QuadsScene
    | UnrolledScene
    | FitScene
    | RedesignScene
)
_KINDS: dict[str, type[Any]] = {kind.__name__: kind for kind in get_args(Scene)}


@dataclass(frozen=True)
class Drawing:
    """A scene and the page to draw it on."""

    scene: Scene
    page: Page = field(default_factory=Page)


def pack(drawings: Mapping[Path, Drawing]) -> bytes:
    """Drawings by the file of each, as an .npz whose arrays are named 0/file, 0/page/width, 0/scene/part/points, ..."""
    arrays: dict[str, Any] = {}
    for number, (file, drawing) in enumerate(drawings.items()):
        named = {"file": str(file.absolute()), "kind": type(drawing.scene).__name__} | _arrays(drawing)
        arrays |= {f"{number}/{name}": value for name, value in named.items()}
    packed = io.BytesIO()
    np.savez(packed, **arrays)
    return packed.getvalue()


def unpack(packed: bytes) -> Iterator[tuple[Path, Drawing]]:
    """The drawings that were packed, in their order."""
    if not packed:
        return
    with np.load(io.BytesIO(packed)) as held:
        arrays = dict(held)
    for number in dict.fromkeys(name.split("/")[0] for name in arrays):
        mine = _below(arrays, number)
        scene = _record(_KINDS[str(mine["kind"])], _below(mine, "scene"))
        yield Path(str(mine["file"])), Drawing(scene, _record(Page, _below(mine, "page")))


def _arrays(record: Any) -> dict[str, Any]:
    """The fields of a record, and of the records in it, that are not None."""
    arrays: dict[str, Any] = {}
    for each in fields(record):
        value = getattr(record, each.name)
        if is_dataclass(value):
            arrays |= {f"{each.name}/{name}": array for name, array in _arrays(value).items()}
        elif value is not None:
            arrays[each.name] = np.asarray(value)
    return arrays


def _record(kind: type[Any], arrays: Mapping[str, NDArray[Any]]) -> Any:
    """The record of a kind whose fields these arrays are."""
    hints = get_type_hints(kind)
    return kind(**{each.name: _value(hints[each.name], each.name, arrays) for each in fields(kind)})


def _value(hint: Any, name: str, arrays: Mapping[str, NDArray[Any]]) -> Any:
    """A field by its type: a record, a plain value, a tuple, an array; None where there is none."""
    kind = next(part for part in get_args(hint) if part is not NoneType) if isinstance(hint, UnionType) else hint
    if is_dataclass(kind):
        below = _below(arrays, name)
        return _record(kind, below) if below else None  # type: ignore[arg-type]
    if name not in arrays:
        return None
    if get_origin(kind) is tuple:
        return tuple(arrays[name].tolist())
    return kind(arrays[name].item()) if kind in (str, int, float, bool) else arrays[name]


def _below(arrays: Mapping[str, NDArray[Any]], name: str) -> dict[str, NDArray[Any]]:
    """The arrays whose names begin with this one, without it."""
    return {key.removeprefix(f"{name}/"): array for key, array in arrays.items() if key.startswith(f"{name}/")}
