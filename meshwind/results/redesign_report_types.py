"""Keys of the report.json of a redesign, and what they hold."""

from typing import TypedDict, final

from meshwind.results.report_types import Failure, MeshFigures


class BeforeAfter(TypedDict):
    """A figure before and after."""

    before: float
    after: float


class CourseFigures(TypedDict):
    """One of the windings that the part is to hold, on the mesh that was read and on the edited one.

    between: v where its paths start and end; paths, particles: their numbers; converged: those at rest on the edited
    mesh; bridges_left: how many of the bridges in `left` are its own.
    """

    name: str
    kind: str
    revolutions: float
    paths: int
    particles: int
    between: list[float]
    bridged: BeforeAfter
    max_gap: BeforeAfter
    converged: int
    bridges_left: int


class RedesignWindingFigures(TypedDict):
    """The first winding, and the reason for its number of revolutions."""

    revolutions: float
    paths_per_family: int
    particles: int
    why: str


class DisplacementFigures(TypedDict):
    """Displacement of the vertices, and number that moved by more than a hundredth of the largest."""

    max: float
    mean: float
    vertices_moved: int


class VolumeFigures(TypedDict):
    """Volume with its open rims capped, in the mesh's units cubed; relative is None without a volume."""

    before: float
    change: float
    relative: float | None


class LeftFigures(TypedDict):
    """A bridge left on the edited surface: winding and fibre, between which v, its largest gap and where that is.

    by_bound: how much lower the gap would be, to first order, with a bound larger by 1; by_frozen: the same with what
    is frozen moved by 1, by its name; held_by: those of them that matter.
    """

    winding: int
    path: int
    family: int
    v: list[float]
    gap: float
    at: list[float]
    held_by: list[str]
    by_bound: float
    by_frozen: dict[str, float]


class RedesignFigures(TypedDict):
    """Outcome of a redesign; bridged is the share of the particles whose gap is above the threshold."""

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
    left: list[LeftFigures]


class RoundFigures(TypedDict):
    """One round of one stage, on the edited surface."""

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
    """The report of a redesign: `after` in `wound` is the proof, which the last round predicts."""

    meshwind: str
    command: str
    mesh: MeshFigures
    winding: RedesignWindingFigures
    windings: list[CourseFigures]
    redesign: RedesignFigures
    rounds: list[RoundFigures]
    wound: WoundBeforeAfter
    seconds: dict[str, float]
    notes: list[str]
