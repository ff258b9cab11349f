"""From a mesh to the nearest one that can be wound: the automatic surface editing of section 6.4."""

from dataclasses import dataclass
from os import PathLike

from meshwind.cast import Floats, frozen
from meshwind.chart import Chart, flatten
from meshwind.errors import BadInputError
from meshwind.mandrel import Mesh, annulus, read
from meshwind.mandrel.measure import volume
from meshwind.path import Paths, Status
from meshwind.redesign.edit import FAIRNESS, PRESSING, Tell, edit
from meshwind.redesign.edited_mesh import displaced, displacement, turned_over, volume_change
from meshwind.redesign.freedom import Frozen
from meshwind.redesign.result import Outcome, Round
from meshwind.surface import Surface, fit


@dataclass(frozen=True, repr=False)
class Redesign:
    """A part that was edited until its fibres no longer bridge, or as far as that went.

    rounds: figures of each round; original, surface: the fitted surface before and after, with as many control
    points; paths: wound on `surface`; outcome: how it ended, with its advice; mesh: the edited mesh, vertices
    and faces in the order of `chart.annulus.mesh`, the one that was read; displacement (n, 3) of its vertices;
    volume, volume_change: of the mesh before, open rims capped, and by the edit, in its units cubed; turned_over:
    faces that the edit turned by more than a right angle, 0 in a sound one; threshold: a smaller gap is no bridge.
    """

    rounds: tuple[Round, ...]
    chart: Chart
    original: Surface
    surface: Surface
    paths: Paths
    outcome: Outcome
    threshold: float
    mesh: Mesh
    displacement: Floats
    volume: float
    volume_change: float
    turned_over: int

    def __repr__(self) -> str:
        return f"<meshwind Redesign: {self.mesh.name}, {len(self.rounds)} rounds, {self.outcome.advice}>"

    @property
    def windable(self) -> bool:
        """Whether nothing bridges any more."""
        return self.outcome == Outcome.WINDABLE

    @property
    def settled(self) -> bool:
        """Whether every path came to rest: a part without bridges may still let fibres slide off its ends."""
        return bool((self.paths.status == Status.CONVERGED).all())

    @property
    def bridged(self) -> float:
        """Share of the particles of `paths` whose gap is above the threshold."""
        return float((self.paths.gap > self.threshold).mean())


def redesign(
    mesh: str | PathLike[str] | Mesh,
    *,
    revolutions: float,
    paths: int = 12,
    particles: int = 401,
    rounds: int = 10,
    frozen_points: Frozen = None,
    bound: float | None = None,
    symmetry: int = 1,
    fairness: float = FAIRNESS,
    pressing: float = PRESSING,
    threshold: float | None = None,
    component: int = 0,
    ends: str = "auto",
    opening: float | None = None,
    tolerance: float = 1e-5,
    progress: Tell | None = None,
) -> Redesign:
    """Move the surface of a part as little as possible until no path of two families bridges.

    mesh: a file or a `Mesh`.  revolutions, paths, particles: of the winding; rounds: at most so many;
    frozen_points: mask (nu, nv) of control points that stay, or a function from their places (m, 3) to a mask (m,);
    bound: largest displacement, in the mesh's units; symmetry: order of rotation about u that is kept, a divisor of
    the control net's points around; fairness: wave length over the part's size at which bending a change costs as
    much as its size, 0 for the thesis's objective alone; pressing: least normal curvature along the fibres times
    the part's size; threshold: gap that counts as none, by default the largest distance of a vertex to the surface.
    component, ends, opening, tolerance: as in `wind`.  progress is called with a line before each stage and round.
    Raises BadInputError, in one line, for whatever the caller can mend; that no solution exists is an outcome.
    """
    if not isinstance(mesh, str | PathLike | Mesh):
        raise BadInputError(f"mesh is of type {type(mesh).__name__}; give the path of a mesh file or a meshwind.Mesh")
    tell: Tell = progress if progress is not None else _silent
    tell("fit")
    part = mesh if isinstance(mesh, Mesh) else read(mesh, component)
    chart = flatten(annulus(part, ends=ends, opening=opening))
    original = fit(chart, tolerance)
    edited = edit(
        original, revolutions=revolutions, paths=paths, particles=particles, rounds=rounds, frozen=frozen_points,
        bound=bound, symmetry=symmetry, fairness=fairness, pressing=pressing, threshold=threshold, progress=progress,
    )  # fmt: skip
    tell("mesh")
    moves = displacement(chart, original, edited.surface, bound)
    return Redesign(
        rounds=edited.rounds,
        chart=chart,
        original=original,
        surface=edited.surface,
        paths=edited.paths,
        outcome=edited.outcome,
        threshold=edited.threshold,
        mesh=displaced(part, moves),
        displacement=frozen(moves),
        volume=volume(part.vertices, part.faces),
        volume_change=volume_change(part, moves),
        turned_over=turned_over(part, moves),
    )


def _silent(_: str) -> None:
    """Say nothing."""
