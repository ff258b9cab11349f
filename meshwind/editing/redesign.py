"""From a mesh to the nearest one that can be wound: the automatic surface editing of section 6.4."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.cast import frozen as immutable
from meshwind.core.defaults import PATHS
from meshwind.core.errors import BadInputError
from meshwind.editing.edit import Edit, edit, is_better
from meshwind.editing.edited_mesh import displaced, displacement, turned_over, volume_change, within
from meshwind.editing.freedom import Frozen
from meshwind.editing.left import Left
from meshwind.editing.options import REVOLUTIONS, EditOptions
from meshwind.editing.proof import Proof, prove, prove_fitted
from meshwind.editing.region import FrozenPart, frozen_part
from meshwind.editing.result import Outcome, Round
from meshwind.editing.wall_left import wall_left
from meshwind.mesh import Mesh
from meshwind.mesh.geometry.areas_and_volumes import volume
from meshwind.mesh.geometry.mesh import Wall
from meshwind.path import Paths, Status
from meshwind.planning.revolutions import Revolutions
from meshwind.workflow.clock import Clock, Progress
from meshwind.workflow.options import Options
from meshwind.workflow.part import MeshLike, fit_part, read_source
from meshwind.workflow.winding import chosen_revolutions

STAGES = 3
"""Largest number of surfaces that are edited: the one fitted to an edited mesh is not quite the edited one, and fibres
may bridge on it again."""
FIRMER, TIGHTER, MORE_ROUNDS = 1.5, 0.1, 2
"""Of each later stage: the factor of the pressing, the factor of the threshold, and the largest number of rounds.

On the sample cast the refit lifts fibres by 0.003 mm, within its fit error; one such stage moves the part by 1.2 mm
more, and no fibre leaves it.
"""
LEAST_LEFT = 0.02
"""Of the bound: what a later stage may always move, as the sum is cut down to the bound afterwards."""


@dataclass(frozen=True, repr=False)
class Redesign:
    """Part that was edited until its fibres no longer bridge, or as far as that went.

    Attributes
    ----------
    part : Mesh
        Mesh that was read.
    mesh : Mesh
        Edited mesh, with the vertices and faces of `part` in their order.
    displacement : ndarray of float, shape (n, 3)
        Displacements of the vertices, in the mesh's units.
    before, after : Proof
        Chart, surface and paths of `part` and of `mesh`, each fitted and wound as by `wind`.
    stages : tuple of tuple of Round
        Figures of each round, for each of the fitted surfaces that were edited.
    outcome : Outcome
        How the redesign ended, with advice.
    revolutions : float
        Revolutions of the windings.
    chosen : Revolutions or None
        How the revolutions were chosen, where they were.
    volume : float
        Volume of `part`, open rims capped, in its unit cubed.
    volume_change : float
        Change of the volume by the edit.
    turned_over : int
        Number of faces that the edit turned by more than a right angle, 0 in a sound one.
    left : tuple of Left
        The bridges that the edit leaves, from the largest, each with its gap, where it is, and what holds it.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.redesign("data/tank.ply", revolutions=0.3, paths=3, particles=51)
    >>> tube.windable, tube.rounds
    (True, ())
    """

    part: Mesh
    mesh: Mesh
    displacement: Floats
    before: Proof
    after: Proof
    stages: tuple[tuple[Round, ...], ...]
    outcome: Outcome
    revolutions: float
    chosen: Revolutions | None
    volume: float
    volume_change: float
    turned_over: int
    left: tuple[Left, ...] = ()

    def __repr__(self) -> str:
        return f"<meshwind Redesign: {self.mesh.name}, {len(self.rounds)} rounds, {self.outcome.advice}>"

    @property
    def rounds(self) -> tuple[Round, ...]:
        """Figures of all rounds."""
        return tuple(each for stage in self.stages for each in stage)

    @property
    def paths(self) -> Paths:
        """Paths on the edited mesh."""
        return self.after.paths

    @property
    def windable(self) -> bool:
        """Whether no path bridges any more."""
        return self.outcome == Outcome.WINDABLE

    @property
    def settled(self) -> bool:
        """Whether every path is in equilibrium: without bridges, fibres may still slide off the ends."""
        return bool((self.paths.status == Status.CONVERGED).all())

    @property
    def bridged(self) -> float:
        """Share of the particles of `paths` that lie off the surface by more than counts as none."""
        return self.after.bridged


def redesign(  # noqa: PLR0913
    mesh: MeshLike,
    *,
    revolutions: float | str = REVOLUTIONS,
    paths: int = PATHS,
    particles: int | None = Options.particles,
    rounds: int = EditOptions.rounds,
    frozen: Frozen | str = EditOptions.frozen,
    bound: float | None = EditOptions.bound,
    symmetry: int = EditOptions.symmetry,
    fairness: float = EditOptions.fairness,
    pressing: float = EditOptions.pressing,
    threshold: float | None = EditOptions.threshold,
    component: int | None = Options.component,
    ends: str = Options.ends,
    opening: float | None = Options.opening,
    side: str = Options.side,
    opening_by: str = Options.opening_by,
    tolerance: float = Options.tolerance,
    progress: Progress | None = None,
) -> Redesign:
    """Change a part as little as possible until no path of two families bridges.

    The control points of the fitted surface are moved by a quadratic program per round, and the part is wound again.
    The edited mesh is then fitted and wound as by `wind`; only where nothing bridges on that, the part is windable.

    Parameters
    ----------
    mesh : str, PathLike, Mesh, trimesh.Trimesh, pyvista.PolyData, meshio.Mesh or tuple of two arrays
        Mesh, or the path of its file; see `read` for those of other libraries.
    revolutions : float or str, default "auto"
        Revolutions of the winding, or "auto" to have them chosen.
    paths : int, default 12
        Number of paths per family.
    particles : int, default 401
        Number of particles per path.
    rounds : int, default 10
        Maximum number of rounds.
    frozen : str, ndarray of bool or callable, optional
        What must not move: ranges such as "v<0.1, z>20" of u, v, x, y and z, or "field:NAME" for a scalar of the mesh
        file, where it is above 0; a mask (nu, nv) of control points; or a function from their positions (m, 3) to a
        mask (m,).
    bound : float, optional
        Largest displacement, in the mesh's units.  By default there is none.
    symmetry : int, default 1
        Order of rotation about the part that is kept, a divisor of the number of control points around it.
    fairness : float, default 0.4
        Wave length, over the size of the part, at which bending a change costs as much as the change itself.  0 for
        the objective of (6.12) alone.
    pressing : float, default 0.3
        Least normal curvature along the fibres, times the size of the part.
    threshold : float, optional
        Ignore gaps up to this, in the mesh's units.  By default the largest distance of a vertex from the fitted
        surface.
    component, ends, opening, side, opening_by, tolerance : optional
        As for `wind`.
    progress : callable, optional
        Called with one line before each stage and round.

    Returns
    -------
    Redesign
        Edited mesh, windings before and after, and how it ended.  That there is no solution is an outcome, not an
        error.

    Raises
    ------
    BadInputError
        If an argument cannot be used.

    See Also
    --------
    write_redesign : Write the results into a folder.

    Examples
    --------
    >>> import meshwind as mw
    >>> edited = mw.redesign("data/vase.stl", revolutions=0.8, paths=3, particles=101, bound=5.0)
    >>> edited.outcome.advice
    'no fibre bridges any more'
    """
    options = EditOptions(bound, frozen, symmetry, threshold, rounds, fairness, pressing)
    winding = Options(
        paths, revolutions, particles, component=component, ends=ends, opening=opening, side=side,
        opening_by=opening_by, tolerance=tolerance,
    )  # fmt: skip
    if winding.particles is None:
        raise BadInputError("particles is None; give a whole number, the same for all rounds of an edit")
    report = progress or _ignore
    region = frozen_part(frozen, mesh)
    report("fit")
    source = read_source(mesh, winding)
    part = fit_part(source, winding, Clock()).counting(threshold)
    region = region.on_skin(part.chart.annulus)
    chosen = chosen_revolutions(part.surface, winding, Clock(progress), further=False)
    if chosen is not None:
        winding = replace(winding, revolutions=chosen.choice)
    first = prove_fitted(part, winding)
    run = _Run(source.mesh, winding, options, region, report, part.chart.annulus.wall)
    ended = _edit_in_stages(run, _Candidate(np.zeros_like(source.mesh.vertices), first))
    best = ended.best
    vertices, faces = source.mesh.vertices, source.mesh.faces
    return Redesign(
        part=source.mesh,
        mesh=displaced(source.mesh, best.moves),
        displacement=immutable(best.moves),
        before=first,
        after=best.proof,
        stages=ended.stages,
        outcome=ended.outcome,
        revolutions=float(winding.turns),
        chosen=chosen,
        volume=volume(vertices, faces),
        volume_change=volume_change(source.mesh, best.moves),
        turned_over=turned_over(source.mesh, best.moves),
        left=ended.left,
    )


def _ignore(_: str) -> None:
    """Report no progress."""


@dataclass(frozen=True)
class _Candidate:
    """The mesh with its vertices moved by `moves` (n, 3), fitted and wound."""

    moves: Floats
    proof: Proof

    @property
    def merit(self) -> tuple[float, float]:
        """Bridged share and largest gap."""
        return self.proof.bridged, self.proof.gap


@dataclass(frozen=True)
class _Run:
    """What is the same in all stages: the mesh, its winding, the options as given, what must not move, and the wall."""

    mesh: Mesh
    winding: Options
    options: EditOptions
    frozen: FrozenPart
    progress: Progress
    wall: Wall | None

    def stage(self, now: _Candidate, number: int, rounds: int) -> Edit:
        """Edit the surface of a candidate; each stage after the first is tighter than the one before."""
        given = self.options
        options = replace(given, rounds=rounds, frozen=self.frozen.on(now.proof.surface, now.proof.chart.uv),
                          bound=_bound_left(given.bound, now.moves))  # fmt: skip
        if number > 0:
            pressing, threshold = given.pressing * FIRMER**number, TIGHTER * now.proof.threshold
            options = replace(options, rounds=min(rounds, MORE_ROUNDS), pressing=pressing, threshold=threshold)
        surface = now.proof.surface
        return edit(surface, self.winding, options, self.progress, self.frozen.named(surface, now.proof.chart.uv))

    def after(self, now: _Candidate, found: Edit) -> _Candidate | None:
        """Move the vertices as the surface was moved, then fit and wind the mesh; None where that pierces its wall."""
        self.progress("fit")
        more = displacement(now.proof.chart, now.proof.surface, found.surface)
        moves = within(now.moves + more, self.options.bound)
        if self.wall is not None and wall_left(self.mesh, self.wall, moves).pierced:
            return None
        return _Candidate(moves, prove(displaced(self.mesh, moves), self.winding, self.options.threshold))

    def can_go_on(self, proof: Proof) -> bool:
        """Whether what must not move and the symmetry can be kept on the control net of another surface."""
        around = proof.surface.control_points.shape[0]
        return self.frozen.on_any_surface and around % self.options.symmetry == 0


@dataclass(frozen=True)
class _Ended:
    """What the stages came to, and the bridges left on the surface that was edited for the best candidate."""

    best: _Candidate
    stages: tuple[tuple[Round, ...], ...]
    outcome: Outcome
    left: tuple[Left, ...]


def _edit_in_stages(run: _Run, first: _Candidate) -> _Ended:
    """Edit the fitted surface, and again the one that is fitted to the edited mesh while fibres leave that."""
    best = now = first
    left = run.options.rounds
    found = run.stage(now, 0, left)
    stages, outcome, bridges = list[tuple[Round, ...]](), found.outcome, found.left
    while found.rounds:
        stages.append(found.rounds)
        left -= len(found.rounds)
        after = run.after(now, found)
        if after is None:
            outcome = Outcome.WALL_PIERCED
            break
        now = after
        gains = is_better(now.merit, best.merit)
        best, bridges = (now, found.left) if gains else (best, bridges)
        if not (gains and outcome == Outcome.WINDABLE and not now.proof.windable):
            break
        if len(stages) == STAGES or not (left and run.can_go_on(now.proof)):
            break
        found = run.stage(now, len(stages), left)
    if best.proof.windable:
        outcome = Outcome.WINDABLE
    elif outcome == Outcome.WINDABLE:
        outcome = Outcome.NOT_KEPT if left > 0 else Outcome.ROUNDS_SPENT
    return _Ended(best, tuple(stages), outcome, () if best.proof.windable else bridges)


def _bound_left(bound: float | None, moves: Floats) -> float | None:
    """What is left of the bound after the moves (n, 3) so far."""
    if bound is None:
        return None
    return max(bound - float(np.linalg.norm(moves, axis=1).max()), LEAST_LEFT * bound)
