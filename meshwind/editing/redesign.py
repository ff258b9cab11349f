"""From a mesh to the nearest one that can be wound: the automatic surface editing of section 6.4."""

from dataclasses import dataclass
from os import PathLike, fspath
from typing import Any

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.cast import frozen as immutable
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.editing.edit import FAIRNESS, PRESSING, Edit, Tell, check, edit
from meshwind.editing.edited_mesh import displaced, displacement, turned_over, volume_change, within
from meshwind.editing.freedom import Frozen
from meshwind.editing.proof import Winding, Wound, fitted
from meshwind.editing.region import Region, parse
from meshwind.editing.result import Outcome, Round
from meshwind.mesh import Mesh, read
from meshwind.mesh.geometry.measure import volume
from meshwind.mesh.io.scalars import Scalars, read_scalars
from meshwind.path import Paths, Status
from meshwind.planning.revolutions import Revolutions, choose_revolutions
from meshwind.surface import Surface

STAGES = 3
"""So often a mesh is edited at most: fitted anew, it is not quite the surface that was edited, and may bridge again."""
FIRMER, TIGHTER, MORE_ROUNDS = 1.5, 0.1, 2
"""How a later stage is asked: so much more pressing, so much of the threshold, and at most so many rounds.  On the
sample cast the refit lifts fibres by 0.003 mm, within its fit error; one such stage moves the part by 1.2 mm more, and
no fibre leaves it."""
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
        Displacements of the vertices, in the mesh's unit.
    before, after : Wound
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
    before: Wound
    after: Wound
    stages: tuple[tuple[Round, ...], ...]
    outcome: Outcome
    revolutions: float
    chosen: Revolutions | None
    volume: float
    volume_change: float
    turned_over: int

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
        """Share of the particles of `paths` whose gap is above the threshold."""
        return self.after.bridged


def redesign(  # noqa: PLR0913
    mesh: str | PathLike[str] | Mesh,
    *,
    revolutions: float | str,
    paths: int = 12,
    particles: int = 401,
    rounds: int = 10,
    frozen: Frozen | str = None,
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
    """Change a part as little as possible until no path of two families bridges.

    The control points of the fitted surface are moved by a quadratic program per round, and the part is wound again.
    The edited mesh is then fitted and wound as by `wind`; only where nothing bridges on that, the part is windable.

    Parameters
    ----------
    mesh : str, PathLike or Mesh
        Mesh, or the path of its file.
    revolutions : float or str
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
        Largest displacement, in the mesh's unit.  By default there is none.
    symmetry : int, default 1
        Order of rotation about the part that is kept, a divisor of the number of control points around it.
    fairness : float, default 0.4
        Wave length, over the size of the part, at which bending a change costs as much as the change itself.  0 for
        the objective of (6.12) alone.
    pressing : float, default 0.2
        Least normal curvature along the fibres, times the size of the part.
    threshold : float, optional
        Ignore gaps up to this, in the mesh's unit.  By default the largest distance of a vertex from the fitted
        surface.
    component, ends, opening, tolerance : optional
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
    if not isinstance(mesh, str | PathLike | Mesh):
        raise BadInputError(f"mesh is of type {type(mesh).__name__}; give the path of a mesh file or a meshwind.Mesh")
    tell: Tell = progress if progress is not None else _silent
    check(rounds, bound, fairness, pressing, threshold)
    held = _held(frozen, mesh)
    tell("fit")
    part = mesh if isinstance(mesh, Mesh) else read(mesh, component)
    chart, surface = fitted(part, ends, opening, tolerance)
    chosen = _chosen(surface, revolutions, paths, particles, tell)
    turns = chosen.choice if chosen is not None else float(revolutions)
    winding = Winding(turns, paths, particles, threshold, ends, opening, tolerance)
    settings = {
        "revolutions": turns, "paths": paths, "particles": particles, "symmetry": symmetry, "fairness": fairness,
        "pressing": pressing, "threshold": threshold, "progress": progress,
    }  # fmt: skip
    first = winding.wound(chart, surface)
    best, stages, outcome = _edited(part, first, winding, _Limits(rounds, bound, held), settings, tell)
    return Redesign(
        part=part,
        mesh=displaced(part, best.moves),
        displacement=immutable(best.moves),
        before=first,
        after=best.wound,
        stages=stages,
        outcome=outcome,
        revolutions=turns,
        chosen=chosen,
        volume=volume(part.vertices, part.faces),
        volume_change=volume_change(part, best.moves),
        turned_over=turned_over(part, best.moves),
    )


def _silent(_: str) -> None:
    """Say nothing."""


def _chosen(surface: Surface, revolutions: float | str, paths: int, particles: int, tell: Tell) -> Revolutions | None:
    """The revolutions, where they are to be chosen."""
    if not isinstance(revolutions, str):
        return None
    if revolutions != AUTO:
        raise BadInputError(f"revolutions is {revolutions!r}; give a number from 0 up, or {AUTO!r}")
    tell("choose")
    return choose_revolutions(surface, paths=paths, particles=particles, further=False)


@dataclass(frozen=True)
class _Held:
    """What must not move: as it was given, or a region with the field that it may be told by."""

    given: Frozen
    region: Region | None = None
    scalars: Scalars | None = None

    def on(self, wound: Wound) -> Frozen:
        """The same on a surface."""
        if self.region is None:
            return self.given
        return self.region.control_points(wound.surface, wound.chart.uv, self.scalars)

    @property
    def lasts(self) -> bool:
        """Whether it can be told on another control net."""
        return self.region is not None or self.given is None or callable(self.given)


def _held(frozen: Frozen | str, mesh: str | PathLike[str] | Mesh) -> _Held:
    if not isinstance(frozen, str):
        return _Held(frozen)
    region = parse(frozen)
    if not region.field:
        return _Held(None, region)
    if isinstance(mesh, Mesh):
        raise BadInputError(f"frozen is {frozen!r} but the mesh is no file; give a mask of control points")
    return _Held(None, region, read_scalars(fspath(mesh), region.field))


@dataclass(frozen=True)
class _Limits:
    """At most so many rounds in all, the largest displacement in all, and what must not move."""

    rounds: int
    bound: float | None
    held: _Held


@dataclass(frozen=True)
class _Moved:
    """A mesh whose vertices were moved by `moves` (n, 3), fitted and wound."""

    moves: Floats
    wound: Wound

    @property
    def merit(self) -> tuple[float, float]:
        """The less the better."""
        return self.wound.bridged, self.wound.gap


def _edited(
    part: Mesh, first: Wound, winding: Winding, limits: _Limits, settings: dict[str, Any], tell: Tell
) -> tuple[_Moved, tuple[tuple[Round, ...], ...], Outcome]:
    """Edit the fitted surface, and again the one that is fitted to the edited mesh while fibres leave that."""
    best = now = _Moved(np.zeros_like(part.vertices), first)
    found = _stage(now, limits, limits.rounds, settings)
    stages, outcome, left = list[tuple[Round, ...]](), found.outcome, limits.rounds
    while found.rounds:
        stages.append(found.rounds)
        left -= len(found.rounds)
        tell("fit")
        more = displacement(now.wound.chart, now.wound.surface, found.surface)
        moves = within(now.moves + more, limits.bound)
        now = _Moved(moves, winding.wound(*winding.fitted(displaced(part, moves))))
        gains = now.merit < best.merit
        best = min(now, best, key=lambda each: each.merit)
        if not (gains and outcome == Outcome.WINDABLE and _wants_more(now.wound, winding)):
            break
        if len(stages) == STAGES or not (left and limits.held.lasts and _symmetric(now.wound, settings["symmetry"])):
            break
        firmer = settings["pressing"] * FIRMER ** len(stages)
        tighter = settings | {"pressing": firmer, "threshold": TIGHTER * now.wound.threshold}
        found = _stage(now, limits, min(left, MORE_ROUNDS), tighter)
    if best.wound.sound:
        outcome = Outcome.WINDABLE
    elif outcome == Outcome.WINDABLE:
        outcome = Outcome.NOT_KEPT if left > 0 else Outcome.ROUNDS_SPENT
    return best, tuple(stages), outcome


def _stage(now: _Moved, limits: _Limits, rounds: int, settings: dict[str, Any]) -> Edit:
    """Edit the surface as it is now."""
    bound = _rest(limits.bound, now.moves)
    return edit(now.wound.surface, rounds=rounds, frozen=limits.held.on(now.wound), bound=bound, **settings)


def _wants_more(wound: Wound, winding: Winding) -> bool:
    """Whether a fibre bridges, or leaves the surface at all where the user did not say how far it may."""
    return not wound.sound or (winding.threshold is None and wound.gap > 0.0)


def _rest(bound: float | None, moves: Floats) -> float | None:
    """What of the bound is left after the moves (n, 3) so far."""
    if bound is None:
        return None
    return max(bound - float(np.linalg.norm(moves, axis=1).max()), LEAST_LEFT * bound)


def _symmetric(wound: Wound, order: int) -> bool:
    """Whether a symmetry of that order can be kept on another control net."""
    return wound.surface.control_points.shape[0] % order == 0
