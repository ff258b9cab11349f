"""Scenes: contents of the pictures, as records that `drawings` sends to the process that draws.

The `*_scene` modules make them, the `*_picture` modules draw them.  Importing this module loads nothing heavy, as both
processes need it.
"""

from dataclasses import dataclass
from typing import TypeAlias

from meshwind.appearance.looks import Scale
from meshwind.appearance.strips import Gear, Ribbons
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.pictures.contents import Frame as Frame
from meshwind.pictures.contents import Part as Part
from meshwind.pictures.curve_scenes import AnglesScene as AnglesScene
from meshwind.pictures.curve_scenes import LaminateScene as LaminateScene
from meshwind.pictures.edit_scenes import RedesignScene as RedesignScene
from meshwind.pictures.edit_scenes import RoundsScene as RoundsScene
from meshwind.pictures.edit_scenes import SliceScene as SliceScene


@dataclass(frozen=True)
class Fibres:
    """The fibres as points (p, n, 3), with the lift (p, n, 3) of their tubes, in radii; which converged (p,)."""

    points: Floats
    lift: Floats
    family: Ints
    converged: Bools


@dataclass(frozen=True)
class BridgeLines:
    """The bridges as consecutive polylines of `sizes` (b,) points: points and lift (k, 3), gap (k,).

    path and particle (k,): numbers of the path and of the particle on it.
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
class Motion:
    """How a movie goes, from nothing to the whole length of fibre, `total`.

    spin (3,): axis about which the part turns; turns: number of its turns; frames: number of frames; movies: files to
    write; encoder: path of FFmpeg.
    """

    total: float
    spin: Floats
    turns: int
    frames: int
    frames_per_second: int
    movies: tuple[str, ...]
    encoder: str


@dataclass(frozen=True)
class AnimationScene:
    """A winding with the length of fibre laid before each point of its fibres (p, n) and of its bridges (k,)."""

    winding: WindingScene
    laid: Floats
    bridge_laid: Floats
    motion: Motion


@dataclass(frozen=True)
class CrossingsScene:
    """The crossings (c, 3), with the surface's normals (c, 3) there, and positions on the scale (c,).

    room (c,): radius of a disc on each, in mesh units, up to which no two meet.
    """

    frame: Frame
    part: Part
    fibres: Fibres
    scale: Scale
    shares: Floats
    points: Floats
    normals: Floats
    room: Floats


@dataclass(frozen=True)
class Fans:
    """Directions in which a fibre presses: points, normals, middle directions (f, 3), reach to both sides (f,).

    size: radius of a fan, in mesh units.
    """

    points: Floats
    normals: Floats
    directions: Floats
    reach: Floats
    size: float


@dataclass(frozen=True)
class Spot:
    """A place (3,) on the part with the outward unit normal (3,) there, the radius of its ring, and what it is."""

    point: Floats
    normal: Floats
    size: float
    words: tuple[str, ...]


@dataclass(frozen=True)
class MapScene:
    """A map on the part: positions of its values on the scale (k,) and, if it has them, fans of directions.

    worst: the place that the picture is about, which gets a ring.
    """

    frame: Frame
    part: Part
    scale: Scale
    shares: Floats
    fans: Fans | None = None
    worst: Spot | None = None


@dataclass(frozen=True)
class LayersScene:
    """The layers of band over each cell of the part, in steps.

    uv (k, 2): of the part's points; steps (nu, nv): numbers of the colours and words over the middles of cells that are
    even in u and v; the first is for what is bare.
    """

    frame: Frame
    part: Part
    uv: Floats
    steps: Ints
    colours: tuple[str, ...]
    words: tuple[str, ...]


@dataclass(frozen=True)
class SlipScene:
    """The fibres by their slip: positions on the scale (p, n), NaN where it is not defined.

    needed: whether any fibre needs friction; bridges: whether any leaves the surface; bins (b,): shares of the length
    of fibre that touches, on equal parts of the scale; limit: position of the friction on the scale, 0 if none.
    """

    frame: Frame
    part: Part
    fibres: Fibres
    scale: Scale
    shares: Floats
    needed: bool
    bridges: bool
    bins: Floats
    limit: float


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
    """The chart as an image (h, w, 3) and the fibres on it, uv (p, n, 2); bridging (p, n): whether particles bridge.

    parted: outlines (k, 2 n, 2) of the strips between neighbours that part round a body.
    """

    frame: Frame
    image: Floats
    uv: Floats
    bridging: Bools
    family: Ints
    converged: Bools
    parted: Floats


@dataclass(frozen=True)
class MeasuredBody:
    """Triangles (m, 3) between points (n, 3), each with its distance (n,) to another body."""

    points: Floats
    faces: Ints
    distances: Floats


@dataclass(frozen=True)
class FitScene:
    """The mesh and the surface by their distance, and the worst places.

    pairs (r, 2, 3): for each place a point on the mesh and one on the surface; distances (r,) between them; seen
    (r, 2): whether they are visible; most: end of the scale; edge: median length of the mesh's edges; close_up: half
    the width of the close-up.
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
class Groups:
    """Rows of ribbons in groups (k,), with a colour and a name for each group."""

    of_rows: Ints
    colours: tuple[str, ...]
    names: tuple[str, ...]


@dataclass(frozen=True)
class FilamentScene:
    """The bands of a filament by the order of winding, on a scale, or in groups over a part in a signal colour."""

    frame: Frame
    part: Part
    ribbons: Ribbons
    gear: Gear
    scale: Scale | None = None
    groups: Groups | None = None


@dataclass(frozen=True)
class ReelScene:
    """The bands of a filament as they are wound."""

    filament: FilamentScene
    motion: Motion


@dataclass(frozen=True)
class Shots:
    """What the f frames of a program's movie show.

    mandrel (f,): its angle in radians; x, r (f,): the eye along the axis and from it; roll (f,): of the eye, in
    radians; touch (f, 3): where the fibre leaves the part, as the part stands at mandrel angle 0; laid (f,): length of
    fibre; faulty (f,): whether the block has a fault; notes: lines of text.
    """

    mandrel: Floats
    x: Floats
    r: Floats
    roll: Floats
    touch: Floats
    laid: Floats
    faulty: Bools
    notes: tuple[str, ...]


@dataclass(frozen=True)
class MachineScene:
    """A machine that winds a filament: the part turns on an axis, and the eye moves beside it.

    origin (3,) and frame (3, 3), rows along the axis, towards the eye, and square to both: of the axis; rods (k, 2):
    where shafts start and end along it; thick: their radius; bed: distance of the carriage's bed from the axis; band:
    width of the eye; flange (f, 3, 3): axes of a robot's flange as columns, in the same frame, none for a lathe.
    """

    filament: FilamentScene
    origin: Floats
    frame: Floats
    rods: Floats
    thick: float
    bed: float
    band: float
    flange: Floats
    shots: Shots
    motion: Motion


@dataclass(frozen=True)
class HitsScene:
    """Where free spans and eye of a program meet the part, and where the fibre does not come to lie as planned.

    spans (k, 2, 3): from where the fibre leaves the part to the eye; entries (k, 3): where each meets it; eyes (m, 3):
    that meet it; astray (l, 3): places from which the fibre comes to lie elsewhere; notes: lines of text.
    """

    frame: Frame
    part: Part
    gear: Gear
    spans: Floats
    entries: Floats
    eyes: Floats
    astray: Floats
    notes: tuple[str, ...]


FlatScene: TypeAlias = AnglesScene | RoundsScene | SliceScene | UnrolledScene
"""What has no part in space, and is drawn without graphics."""
Scene: TypeAlias = (
    WindingScene
    | FilamentScene
    | LaminateScene
    | AnimationScene
    | ReelScene
    | MachineScene
    | HitsScene
    | CrossingsScene
    | MapScene
    | LayersScene
    | SlipScene
    | QuadsScene
    | FitScene
    | RedesignScene
    | FlatScene
)
