"""Types of report.json: the figures of a run, and those of a redesign.

Lengths are in the mesh's units, angles in degrees, shares from 0 to 1; None is a figure that does not exist.
"""

from typing import NotRequired, TypedDict, final

from meshwind.results.laminate_types import LayerFigures
from meshwind.results.pattern_types import CoverFigures, PatternFigures, Spread


class WallFigures(TypedDict):
    """The skin that is wound of a part with a wall, "outer" or "inner", and the wall's median thickness."""

    side: str
    thickness: float


class MeshFigures(TypedDict):
    """The mesh that was read, after repair.

    read_vertices and read_faces are those of the file; units_from is "given", "file", "default" or "unknown", or
    words where the format names the unit; size is the extent along x, y and z.
    """

    name: str
    vertices: int
    faces: int
    read_vertices: int
    read_faces: int
    units: str
    units_from: str
    size: list[float]
    diagonal: float
    repairs: list[str]
    ends: NotRequired[str]
    wall: NotRequired[WallFigures]


class Distances(TypedDict):
    """Root mean square and largest."""

    rms: float
    max: float


class FitFigures(TypedDict):
    """Distances between surface and mesh; relative_max is over the diagonal."""

    rms: float | None
    max: float | None
    relative_max: float | None
    to_surface: NotRequired[Distances]
    to_mesh: NotRequired[Distances]


class EvidenceFigures(TypedDict):
    """What led the fit, what noise and sagitta were found in the mesh, and how far the surface may lie off the part."""

    data: str
    noise: float
    sagitta: float
    uncertainty: Distances


class SurfaceFigures(TypedDict):
    """The fitted surface: control points around and along, tolerance and error of the fit."""

    control_points: list[int]
    tolerance: float | None
    fit_error: FitFigures
    evidence: NotRequired[EvidenceFigures]
    flipped_triangles: int


class WindingFigures(TypedDict):
    """What was wound."""

    revolutions: float
    paths_per_family: int
    particles: int
    friction: float


class Failure(TypedDict):
    """A path that did not converge: number, status, its name and meaning, and the meaning with what holds all paths."""

    path: int
    status: int
    name: str
    meaning: str
    why: str


class AdviceFigures(TypedDict):
    """What holds all paths, tried with all of them; None where none was found, or none was needed.

    text: all of it in a sentence, "" for nothing; turns: share of each path's own turn; rougher: factor of the
    friction; particles: with which all come to rest.
    """

    text: str
    revolutions: float | None
    turns: float | None
    friction: float | None
    rougher: float | None
    particles: int | None


class UnresolvedFigures(TypedDict):
    """Bridges thinner than the threshold, which count as contact: how many, their share of the length, largest gap.

    threshold: the one given, None for the surface's uncertainty.
    """

    threshold: float | None
    bridges: int
    fraction: float
    max_gap: float


class OtherStateFigures(TypedDict):
    """Another state close to one of the paths: how far apart they lie and its length, None where the fibre slides off.

    status, name: how the path ends there; friction: the relative change of the friction with which it does; shift: that
    of the starting curve, to the left positive; one of them is 0.
    """

    path: int
    apart: float | None
    length: float | None
    status: int
    name: str
    friction: float
    shift: float


class OtherRestsFigures(TypedDict):
    """Other states close to the paths, looked for with these largest changes of friction and starting curve.

    largest_move: of the paths without one; None where all have one, or no slide had an answer.
    """

    friction: float
    shift: float
    largest_move: float | None
    found: list[OtherStateFigures]


class PathsFigures(TypedDict):
    """The paths; lengths, bridges and maxima are over those that `figures_over` names, residuals over the tension.

    length_error: what the total may be off by; position_error: how far a fibre may be from the polyline through its
    particles: both for the particles, not for the fit; other_rests: with friction only.
    """

    converged: int
    not_converged: list[Failure]
    advice: AdviceFigures
    figures_over: str
    length_total: float
    length_error: float
    position_error: float
    bridged_fraction: float
    bridges: int
    longest_bridge: float
    unresolved: UnresolvedFigures
    max_gap: float
    max_slip: float
    max_residual: float
    other_rests: NotRequired[OtherRestsFigures]


class CrossingFigures(TypedDict):
    """Crossings of the families: quality is |cos(angle)|, by_region counts them in equal parts of u and of v."""

    count: int
    angle: Spread
    quality: Spread
    off_surface: int
    own_family: int
    by_region: list[list[int]]


class CoverageFigures(TypedDict):
    """Layers on cells one pitch wide, and shares of the area under no, one, two and more bands."""

    min: float
    median: float
    max: float
    band_width: float
    cells: list[int]
    bare: float
    once: float
    twice: float
    more: float
    most_layers: int
    on_part: float
    bare_caps: list[float]


class SpacingFigures(TypedDict):
    """Distances between neighbours and, along the fibres, between crossings; gaps that the band's width leaves.

    partings: pairs of neighbours that part round a body; widest_parting, kept: largest distance between them, and
    between all other neighbours.  `asked` and `paths_added` are present only if a spacing was given; partings are then
    the pairs that exceed it.
    """

    neighbours: Spread
    d1: Spread
    d2: Spread
    widest_gap: float
    neighbours_apart: float | None
    partings: list[list[int]]
    widest_parting: float
    kept: float
    asked: NotRequired[float]
    paths_added: NotRequired[int]


class WindabilityFigures(TypedDict):
    """Shares of the area by class, and share of the directions in which a taut fibre presses."""

    convex: float
    saddle: float
    concave: float
    untouchable: float
    directions: float


class QuadFigures(TypedDict):
    """Counts and quality of the quad mesh; `of` names the paths that it is made of, `note` says why it is missing."""

    faces: int
    quads: int
    triangles: int
    convex_inner: float | None
    scaled_jacobian: Spread
    aspect: Spread
    warp: Spread
    off_surface_points: int
    left_out: list[int]
    of: str
    note: str


class FibreFigures(TypedDict):
    """The fibres on the part as a layer: length, masses in g, thickness over the part, angle and cover along it.

    Masses are None where tex is not known, thickness where that of the band is not, angle and cover on open surfaces.
    """

    length: float
    fibre_mass: float | None
    resin_mass: float | None
    band_thickness: float | None
    thickness: Spread | None
    angle: Spread | None
    cover: CoverFigures | None


class StationFigures(TypedDict):
    """A level line: v, its height along the axis, winding angles over the paths in degrees, and the cover factor."""

    v: float
    z: float
    angle: Spread
    cover: float


class ModelFigures(TypedDict):
    """Parts of the model that the paths needed, and counts of operations."""

    lifting: bool
    friction: bool
    surface_evaluations: int
    foot_points: int
    block_solves: int
    iterations: int


class PressingFigures(TypedDict):
    """Intervals of revolutions at which both families press on most of the surface, and the share of that."""

    intervals: list[list[float]]
    share: float


class HoldingFigures(TypedDict):
    """Bounds between which every path converges, how they were found, and the ends that fibres slide off."""

    low: float
    high: float | None
    by: str
    slides_off: str


class FurtherFigures(TypedDict):
    """Upper bound of the revolutions with this friction, and with openings wider by this factor."""

    friction: float
    with_friction: float | None
    opening: float
    with_opening: float | None


class RevolutionFigures(TypedDict):
    """The choice of revolutions and its reasons; a trial is revolutions, share at rest, share bridged."""

    chosen: float
    why: str
    bridged_fraction: float
    pressing: PressingFigures
    holding: HoldingFigures
    square: float
    further: FurtherFigures
    trials: list[list[float]]


@final
class Report(TypedDict):
    """The report of a run; seconds are per stage, notes are messages for the user."""

    meshwind: str
    command: str
    mesh: MeshFigures
    surface: SurfaceFigures
    winding: WindingFigures
    paths: PathsFigures
    crossings: CrossingFigures
    coverage: CoverageFigures
    spacing: SpacingFigures
    windability: WindabilityFigures
    quads: QuadFigures
    fibre: FibreFigures
    model: ModelFigures
    seconds: dict[str, float]
    notes: list[str]
    revolutions: NotRequired[RevolutionFigures]
    angle_stations: NotRequired[list[StationFigures]]
    pattern: NotRequired[list[PatternFigures]]
    laminate: NotRequired[list[LayerFigures]]
