"""report.json by type: the figures of a run, and those of a redesign.

Lengths are in the mesh's units, angles in degrees, shares from 0 to 1; None stands for a figure that does not exist.
"""

from typing import NotRequired, TypedDict, final


class Spread(TypedDict):
    """Smallest, median and largest of some values; None of nothing."""

    min: float | None
    median: float | None
    max: float | None


class MeshFigures(TypedDict):
    """The mesh that was read, after repair; read_vertices and read_faces are those of the file."""

    name: str
    vertices: int
    faces: int
    read_vertices: int
    read_faces: int
    units: str
    diagonal: float
    repairs: list[str]
    ends: NotRequired[str]


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


class SurfaceFigures(TypedDict):
    """The fitted surface: control points around and along, the tolerance that it was fitted to, how well it fits."""

    control_points: list[int]
    tolerance: float | None
    fit_error: FitFigures
    flipped_triangles: int


class WindingFigures(TypedDict):
    """What was wound."""

    revolutions: float
    paths_per_family: int
    particles: int
    friction: float


class Failure(TypedDict):
    """A path that did not converge: its number, its status, the status's name, and why with what would hold it."""

    path: int
    status: int
    name: str
    why: str


class PathsFigures(TypedDict):
    """The paths; all but the first two are over those that `figures_over` names, max_residual over the tension."""

    converged: int
    not_converged: list[Failure]
    figures_over: str
    length_total: float
    bridged_fraction: float
    bridges: int
    longest_bridge: float
    max_gap: float
    max_slip: float
    max_residual: float


class CrossingFigures(TypedDict):
    """Crossings of the families: quality is |cos(angle)|, by_region counts them in equal parts of u and of v."""

    count: int
    angle: Spread
    quality: Spread
    off_surface: int
    own_family: int
    by_region: list[list[int]]


class CoverageFigures(TypedDict):
    """Layers by cells of a pitch, and shares of the area under no, one, two and more bands."""

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

    From `asked` on only where a spacing was asked for: partings are pairs of paths between which it was not kept.
    """

    neighbours: Spread
    d1: Spread
    d2: Spread
    widest_gap: float
    neighbours_apart: float | None
    asked: NotRequired[float]
    kept: NotRequired[float]
    paths_added: NotRequired[int]
    partings: NotRequired[list[list[int]]]
    widest_parting: NotRequired[float]


class WindabilityFigures(TypedDict):
    """Shares of the area by kind, and of the directions in which a taut fibre presses."""

    convex: float
    saddle: float
    concave: float
    untouchable: float
    directions: float


class QuadFigures(TypedDict):
    """Counts and quality of the quad mesh; `of` says what it was made of, note why there is none."""

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
    """Length of all fibres, and their mass where the linear density is known."""

    length: float
    linear_density: float | None
    mass: float | None


class ModelFigures(TypedDict):
    """Which parts of the model the paths needed, and what they cost."""

    lifting: bool
    friction: bool
    surface_evaluations: int
    foot_points: int
    block_solves: int
    iterations: int


class PressingFigures(TypedDict):
    """Revolutions at which both families press on most of the surface, and its share."""

    intervals: list[list[float]]
    share: float


class HoldingFigures(TypedDict):
    """Revolutions between which every path converges, how they were found, and the ends that fibres slide off."""

    low: float
    high: float | None
    by: str
    slides_off: str


class FurtherFigures(TypedDict):
    """The bound of the revolutions with this friction, and with openings so many times as wide."""

    friction: float
    with_friction: float | None
    opening: float
    with_opening: float | None


class RevolutionFigures(TypedDict):
    """The choice of revolutions and what it rests on; a trial is revolutions, share at rest, share bridged."""

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
    """The report of a run; seconds are per stage, notes what the user should know beside the figures."""

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


class RedesignWindingFigures(TypedDict):
    """What was wound on both meshes, and why by so many revolutions."""

    revolutions: float
    paths_per_family: int
    particles: int
    why: str


class BeforeAfter(TypedDict):
    """A figure before and after."""

    before: float
    after: float


class DisplacementFigures(TypedDict):
    """How far vertices moved, and how many by more than a hundredth of the largest displacement."""

    max: float
    mean: float
    vertices_moved: int


class VolumeFigures(TypedDict):
    """Volume with its open rims capped, in the mesh's units cubed; relative is None without a volume."""

    before: float
    change: float
    relative: float | None


class RedesignFigures(TypedDict):
    """How a redesign ended; bridged is the share of the particles whose gap is above the threshold."""

    windable: bool
    outcome: str
    advice: str
    rounds: int
    threshold: float
    bridged: BeforeAfter
    max_gap: BeforeAfter
    displacement: DisplacementFigures
    volume: VolumeFigures
    faces_turned_over: int


class RoundFigures(TypedDict):
    """One round of one stage, on the surface that is edited."""

    stage: int
    round: int
    threshold: float
    bridged: BeforeAfter
    max_gap: BeforeAfter
    largest_move: float
    objective: float
    shortfall: float
    kkt_residual: float
    constraints: int
    iterations: int


class WoundFigures(TypedDict):
    """A mesh fitted and wound by itself."""

    control_points: list[int]
    converged: int
    not_converged: list[Failure]
    bridged: float
    max_gap: float
    threshold: float


class WoundBeforeAfter(TypedDict):
    """The mesh that was read and the edited one."""

    before: WoundFigures
    after: WoundFigures


@final
class RedesignReport(TypedDict):
    """The report of a redesign: the second of `wound` is the proof, which the last of the rounds predicts."""

    meshwind: str
    command: str
    mesh: MeshFigures
    winding: RedesignWindingFigures
    redesign: RedesignFigures
    rounds: list[RoundFigures]
    wound: WoundBeforeAfter
    seconds: dict[str, float]
    notes: list[str]
