"""From a mesh to the nearest one that can be wound: the automatic surface editing of section 6.4."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from os import PathLike
from typing import TYPE_CHECKING, cast

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats
from meshwind.core.cast import frozen as immutable
from meshwind.core.compile_ahead import compile_ahead
from meshwind.core.defaults import PATHS
from meshwind.core.parsing import number_or_auto
from meshwind.core.progress import Progress
from meshwind.editing.bound import bound_of
from meshwind.editing.edited_mesh import displaced, turned_over, volume_change
from meshwind.editing.freedom import Frozen
from meshwind.editing.frozen_part import frozen_part
from meshwind.editing.left import Left
from meshwind.editing.options import EditOptions, WindingOptions
from meshwind.editing.proof import Proof, prove_fitted
from meshwind.editing.result import Outcome, Round
from meshwind.editing.stages import Candidate, Run, edit_in_stages
from meshwind.editing.symmetry import axis_of, mesh_group, planes
from meshwind.editing.windings import Course, courses
from meshwind.mesh import Mesh
from meshwind.mesh.geometry.areas_and_volumes import volume
from meshwind.mesh.io.read import MeshLike
from meshwind.path import Paths, Status
from meshwind.planning.revolutions import Revolutions
from meshwind.results.schema import DISPLACEMENT
from meshwind.workflow.clock import Clock
from meshwind.workflow.options import Options
from meshwind.workflow.part import fit_part, read_source
from meshwind.workflow.winding import chosen_revolutions

if TYPE_CHECKING:
    import pyvista


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
    windings : tuple of Course
        The windings that the part is to hold, each with its revolutions and its name.
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
    windings: tuple[Course, ...]
    chosen: Revolutions | None
    volume: float
    volume_change: float
    turned_over: int
    left: tuple[Left, ...] = ()

    def __repr__(self) -> str:
        rounds = "1 round" if len(self.rounds) == 1 else f"{len(self.rounds)} rounds"
        return f"<meshwind Redesign: {self.mesh.name}, {rounds}, {self.outcome.advice}>"

    @property
    def rounds(self) -> tuple[Round, ...]:
        """Figures of all rounds."""
        return tuple(each for stage in self.stages for each in stage)

    @property
    def paths(self) -> Paths:
        """Paths of the first winding on the edited mesh; those of all are in `after.wound`."""
        return self.after.paths

    @property
    def revolutions(self) -> float:
        """Revolutions of the first winding."""
        return self.windings[0].revolutions

    @property
    def windable(self) -> bool:
        """Whether no path bridges any more."""
        return self.outcome == Outcome.WINDABLE

    @property
    def settled(self) -> bool:
        """Whether every path is in equilibrium: without bridges, fibres may still slide off the ends."""
        return all(bool((paths.status == Status.CONVERGED).all()) for paths in self.after.wound)

    @property
    def bridged(self) -> float:
        """Share of the particles of all windings that lie off the surface by more than counts as none."""
        return self.after.bridged

    def to_pyvista(self) -> pyvista.MultiBlock:
        """Give the part before and after to PyVista.

        Returns
        -------
        pyvista.MultiBlock
            Blocks "before" and "after", the meshes, whose points have the field "displacement", in the mesh's units,
            and "fibres_before" and "fibres_after", the paths of the first winding.

        Examples
        --------
        >>> import meshwind as mw
        >>> seen = mw.redesign("data/tank.ply", revolutions=0.3, paths=3, particles=51).to_pyvista()
        >>> seen.keys(), seen["after"]["displacement"].shape == seen["after"].points.shape
        (['before', 'after', 'fibres_before', 'fibres_after'], True)
        """
        import pyvista  # late: a redesign needs none

        before, after = self.part.to_pyvista(), self.mesh.to_pyvista()
        for each in (before, after):
            each.point_data[DISPLACEMENT] = self.displacement
        fibres = [proof.paths.to_pyvista() for proof in (self.before, self.after)]
        return pyvista.MultiBlock({
            "before": before, "after": after, "fibres_before": fibres[0], "fibres_after": fibres[1],
        })  # fmt: skip


def redesign(  # noqa: PLR0913
    mesh: MeshLike,
    *,
    revolutions: float | str | Sequence[float] = WindingOptions.revolutions,
    layers: str | PathLike[str] | None = WindingOptions.layers,
    paths: int = PATHS,
    particles: int | str | None = Options.particles,
    rounds: int = EditOptions.rounds,
    frozen: Frozen | str = EditOptions.frozen,
    bound: float | str | ArrayLike | None = EditOptions.bound,
    symmetry: int = EditOptions.symmetry,
    mirror: str | None = EditOptions.mirror,
    fairness: float = EditOptions.fairness,
    pressing: float = EditOptions.pressing,
    threshold: float | None = EditOptions.threshold,
    at_most: float = EditOptions.at_most,
    keep_volume: bool = EditOptions.keep_volume,
    only_outward: bool = EditOptions.only_outward,
    only_inward: bool = EditOptions.only_inward,
    component: int | None = Options.component,
    ends: str | ArrayLike = Options.ends,
    opening: float | None = Options.opening,
    side: str = Options.side,
    opening_by: str = Options.opening_by,
    tolerance: float = Options.tolerance,
    progress: Progress | None = None,
) -> Redesign:
    """Change a part as little as possible until no path of its windings bridges.

    The control points of the fitted surface are moved by a quadratic program per round, and the part is wound again.
    The edited mesh is then fitted and wound as by `wind`; only where nothing bridges on that, the part is windable.

    Parameters
    ----------
    mesh : str, PathLike, Mesh, trimesh.Trimesh, pyvista.PolyData, meshio.Mesh or tuple of two arrays
        Mesh, or the path of its file; see `read` for those of other libraries.
    revolutions : float, str or sequence of float, default "auto"
        Revolutions of the winding, also as "5/12", or "auto" to have them chosen.  Several, also as "0.5,0.8", are
        windings that the part is to hold all.
    layers : str or PathLike, optional
        File of a laminate as for `wind`, instead of the revolutions: the part is to hold each of its layers, helical or
        hoops, as if it lay on the bare part.
    paths : int, default 12
        Number of paths per family.
    particles : int or "auto", default 401
        Number of particles per path; "auto" or None picks as many as an error of the lengths of 1e-5 needs.
    rounds : int, default 10
        Maximum number of rounds.
    frozen : str, ndarray of bool or callable, optional
        What must not move: ranges such as "v<0.1, z>20" of u, v, x, y and z, those of a box by "&", "field:NAME" for a
        scalar of the mesh file, where it is above 0, or "faces:3-17" for faces by their numbers; a mask (nu, nv) of
        control points; or a function from their positions (m, 3) to a mask (m,).
    bound : float, str or array_like of float, optional
        Largest displacement, in the mesh's units: one number, "field:NAME" for a scalar of the mesh file, or one for
        each vertex of the mesh; where it is 0 nothing moves.  By default there is none.
    symmetry : int, default 1
        Order of rotation about the part that is kept, a divisor of the number of control points around it.
    mirror : str, optional
        Mirror planes that are kept, by commas: "x", "y" or "z" for one through the middle of the part, "x=12" for one
        at a place, or "a b c d" for ax+by+cz=d.
    fairness : float, default 0.4
        Wave length, over the size of the part, at which bending a change costs as much as the change itself.  0 for
        the objective of (6.12) alone.
    pressing : float, default 0.2
        Least normal curvature along the fibres, times the size of the part.
    threshold : float, optional
        Ignore gaps up to this, in the mesh's units.  By default the largest distance of a vertex from the fitted
        surface.
    at_most : float, default 0
        Gap that may stay, in the mesh's units, such as the thickness of the band.
    keep_volume : bool, default False
        Whether to keep the volume, to 1e-3 of it.
    only_outward, only_inward : bool, default False
        Whether to add material only, or to take it away only.
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
    options = EditOptions(
        bound,
        frozen,
        symmetry,
        mirror,
        threshold,
        at_most,
        keep_volume,
        only_outward,
        only_inward,
        rounds,
        fairness,
        pressing,
    )
    asked = WindingOptions(cast(float | str | tuple[float, ...], revolutions), layers)  # which makes a tuple of several
    winding = Options(
        paths, asked.most, number_or_auto(particles), component=component, ends=cast(str, ends), opening=opening,
        side=side, opening_by=opening_by, tolerance=tolerance,
    )  # fmt: skip
    Course.of(winding, 0.0)
    report = progress or _ignore
    compile_ahead(("wind", "redesign"), report)
    report("fit")
    source = read_source(mesh, winding)
    region = frozen_part(frozen, mesh, source.mesh)
    part = fit_part(source, winding, Clock()).counting(threshold)
    region = region.on_skin(part.chart.annulus)
    limit = bound_of(options.bound, mesh, source.mesh, part.chart.annulus)
    group = mesh_group(source.mesh.vertices, symmetry, planes(mirror), axis_of(part.surface))
    limit = limit if group is None else limit.kept(group)
    chosen = None
    if layers is None:
        chosen = chosen_revolutions(part.surface, winding, Clock(progress), further=False)
        winding = replace(winding, revolutions=winding.turns if chosen is None else chosen.choice)
    wanted = courses(part.surface, asked, winding, source.mesh.units)
    first = prove_fitted(part, wanted, at_most)
    run = Run(source.mesh, winding, wanted, options, region, limit, group, report, part.chart.annulus.wall)
    ended = edit_in_stages(run, Candidate(np.zeros_like(source.mesh.vertices), first))
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
        windings=wanted,
        chosen=chosen,
        volume=volume(vertices, faces),
        volume_change=volume_change(source.mesh, best.moves),
        turned_over=turned_over(source.mesh, best.moves),
        left=ended.left,
    )


def _ignore(_: str) -> None:
    """Report no progress."""
