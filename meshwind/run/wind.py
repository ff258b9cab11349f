"""Wind a mesh and write the results with their pictures into a folder."""

from __future__ import annotations

from os import PathLike, fspath
from typing import TYPE_CHECKING, cast

from meshwind.core.parsing import number_or_auto
from meshwind.core.progress import Progress
from meshwind.mesh import check_file
from meshwind.mesh.io.read import MeshLike
from meshwind.pictures.painter import start_probe
from meshwind.planning.pins import check_pins
from meshwind.results import folder
from meshwind.run.result import Result, write_result
from meshwind.workflow.band_plan import check_band
from meshwind.workflow.clock import Clock
from meshwind.workflow.compiling import compile_for
from meshwind.workflow.options import Options
from meshwind.workflow.part import fit_part, read_source
from meshwind.workflow.winding import wind_part

if TYPE_CHECKING:
    from numpy.typing import ArrayLike


def wind(  # noqa: PLR0913
    mesh: MeshLike,
    *,
    paths: int | str | None = Options.paths,
    revolutions: float | str | None = Options.revolutions,
    friction: float | str = Options.friction,
    component: int | None = Options.component,
    ends: str | ArrayLike = Options.ends,
    opening: float | None = Options.opening,
    side: str = Options.side,
    opening_by: str = Options.opening_by,
    tolerance: float = Options.tolerance,
    threshold: float | None = Options.threshold,
    worst_fit: float = Options.worst_fit,
    units: str | None = Options.units,
    particles: int | str | None = Options.particles,
    spacing: float | None = Options.spacing,
    band_width: float | None = Options.band_width,
    band_thickness: float | None = Options.band_thickness,
    tex: float | None = Options.tex,
    tows: int | None = Options.tows,
    fibre_density: float | None = Options.fibre_density,
    resin_density: float | None = Options.resin_density,
    fibre_volume: float | None = Options.fibre_volume,
    pins: str | PathLike[str] | None = Options.pins,
    angle: float | None = Options.angle,
    angle_at: str | None = Options.angle_at,
    continuous: bool = Options.continuous,
    turn_start: str = Options.turn_start,
    turn_end: str = Options.turn_end,
    layers: str | PathLike[str] | None = None,
    out: str | PathLike[str] | None = None,
    overwrite: bool = False,
    render: bool = True,
    command: str = "",
    progress: Progress | None = None,
) -> Result:
    """Wind a part: lay two families of taut paths on a triangle mesh.

    The mesh is read and repaired, opened at its two ends, flattened to the periodic rectangle and fitted with a
    B-spline surface; the paths are laid on the surface and assessed.

    Parameters
    ----------
    mesh : str, PathLike, Mesh, trimesh.Trimesh, pyvista.PolyData, meshio.Mesh or tuple of two arrays
        Mesh, or the path of its file; see `read` for those of other libraries.
    paths : int or "auto", default 12
        Number of paths per family; the two families turn in opposite senses.  "auto" or None takes as many as cover the
        part with bands of `band_width`.
    revolutions : float or str, optional
        Turns of a path from end to end, also as "5/12"; "auto" picks the value with stable paths and least bridging.
        By default 0.5, or those of `angle`.
    friction : float or str, default 0
        Coefficient of friction between fibre and part, or "field:NAME" for a scalar of the mesh or its file.
    component : int, optional
        Piece of the mesh file to take, by decreasing area; 0 is the largest.  By default the largest, with a warning
        if another one is large.
    ends : str or array_like of float, shape (2, 3), default "auto"
        Where the ends are: "auto", "x", "y", "z", two points, also as "x,y,z x,y,z", or two open rims "loops 0 1";
        see `annulus`.
    opening : float, optional
        Radius of the opening at a closed end, in the mesh's units.  By default it follows from the part.
    side : {"outer", "inner"}, default "outer"
        Skin of a part with a wall that is wound; see `annulus`.
    opening_by : {"auto", "level", "plane"}, default "auto"
        How a closed end is opened: along a level line of the distance to its pole, or by a plane square to the axis;
        see `annulus`.
    tolerance : float, default 1e-5
        Largest distance of a mesh vertex from the fitted surface, over the part's diagonal.
    threshold : float, optional
        Largest gap between fibre and surface that is no bridge, in the mesh's units; 0 counts every gap.  By default
        the surface's uncertainty.
    worst_fit : float, default 0.1
        Largest distance between surface and mesh that is accepted at all, over the part's diagonal.
    units : str, optional
        Unit of the mesh: "mm", "cm", "m", "um", "in" or "ft"; "" if it is not known.  Nothing is converted.  By
        default that of the mesh: the one that its file names, or "mm" for a file that names none.
    particles : int or "auto", default 401
        Number of particles per path.  "auto" or None picks as many as an error of the lengths of 1e-5 needs.
    spacing : float, optional
        Largest distance between neighbouring paths, in the mesh's units: paths are added until it is kept.
    band_width : float, optional
        Width of the fibre band, in the mesh's units, for the coverage.  By default one layer per family.
    band_thickness : float, optional
        Mean thickness of the band, in the mesh's units; needs `band_width`.  By default it follows from `tex` and
        `band_width`.
    tex : float, optional
        Mass of one tow in g/km, from which the masses of fibre and resin follow.
    tows : int, optional
        Tows side by side in the band.  By default 1.
    fibre_density, resin_density : float, optional
        Densities in g/cm3.  By default 1.8, that of carbon, and 1.2.
    fibre_volume : float, optional
        Share of the fibre in the laminate's volume, above 0 and up to 1.  By default 0.6.
    pins : str or PathLike, optional
        CSV file of the paths' ends, see `read_pins`.  By default they are spread evenly over the rims.
    angle : float, optional
        Winding angle in degrees from the direction along the part, the median over the paths, from which the
        revolutions follow.  By default it is that of `revolutions`.
    angle_at : str, optional
        Where the angle is to be: "v=0.5", "z=120" along the part's axis, or "fraction=0.5" of its length.  By default
        the widest place.
    continuous : bool, default False
        Whether to wind one closed filament, with its turnarounds at both ends; revolutions move to where it closes.
    turn_start, turn_end : {"auto", "collar", "pins", "shaft", "cap"}, default "auto"
        Turnaround at each end; "auto" takes a collar where friction holds on a short one, and pins elsewhere.  On the
        "cap" of a closed end the fibre touches the opening and comes back: that sets the angle, not `revolutions`.
    layers : str or PathLike, optional
        TOML file of a laminate, whose layers are wound one on another; the paths are then those of its first helical
        layer on the bare part.  By default there is none.
    out : str or PathLike, optional
        Folder for the results.  By default nothing is written.
    overwrite : bool, default False
        Whether to replace results that the folder holds already.
    render : bool, default True
        Whether to draw pictures into the folder as well.
    command : str, default ""
        Command line, for the report.
    progress : callable, optional
        Called with the name of each stage as it starts.

    Returns
    -------
    Result
        Paths, layup and figures.

    Raises
    ------
    BadInputError
        If the mesh cannot be wound, an argument cannot be used, or, without `overwrite`, the folder holds results.

    See Also
    --------
    solve : Lay paths between given ends on any surface.
    redesign : Change a part so that no path bridges.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
    >>> result.settled, result.paths.points.shape
    (True, (8, 51, 3))
    """
    pinned = fspath(pins) if isinstance(pins, PathLike) else pins
    options = Options(
        number_or_auto(paths), revolutions, number_or_auto(particles), friction, component, cast(str, ends), opening,
        side, opening_by, tolerance, threshold, worst_fit, units, spacing, band_width, band_thickness, tex, tows,
        fibre_density, resin_density, fibre_volume, pinned, angle, angle_at, continuous, turn_start, turn_end,
    )  # fmt: skip
    if layers is None:
        plans = None
        check_band(options)
    else:
        from meshwind.workflow.layer_plans import read_layers  # late: most runs have no laminate

        plans = read_layers(layers, options)
    clock = Clock(progress)
    target = None if out is None else folder.named(out)
    check_file(mesh)
    if pinned is not None:
        check_pins(pinned)  # before all the work
    if target is not None:
        folder.prepare(target, overwrite)
        if render:
            start_probe()
    compile_for([options], progress, laminate=plans is not None)
    with clock.stage("read"):
        source = read_source(mesh, options)
    result = Result.of(wind_part(fit_part(source, options, clock), options, command, clock, plans))
    return result if target is None else write_result(result, target, render, overwrite, clock)
