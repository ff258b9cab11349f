"""Export of a run, in memory or in its folder, to files for other programs."""

from __future__ import annotations

from collections.abc import Sequence
from os import PathLike

from meshwind.core.checks import path_given, several
from meshwind.core.errors import BadInputError
from meshwind.exporting.shell_loads import Loads
from meshwind.exporting.targets import Exported, ExportOptions, write_exports
from meshwind.run.loaded import LoadedResult
from meshwind.run.result import Result


def export(  # noqa: PLR0913
    run: str | PathLike[str] | Result | LoadedResult,
    to: str | Sequence[str] = (),
    *,
    formats: str | Sequence[str] = (),
    out: str | PathLike[str] | None = None,
    band_width: float | None = ExportOptions.width,
    thickness: float | None = ExportOptions.thickness,
    shell: str = ExportOptions.shell,
    elements: int | None = ExportOptions.count,
    pressure: float | None = Loads.pressure,
    axial: float | None = Loads.axial,
    torque: float | None = Loads.torque,
    held: str = Loads.held,
    material: str = ExportOptions.material,
    section_tolerance: float = ExportOptions.tolerance,
    step: float | None = ExportOptions.step,
    angle: float | None = ExportOptions.angle,
) -> Exported:
    """Write a run for solvers, robots, CAD and browsers; nothing is wound again.

    All files appear, or none.

    Parameters
    ----------
    run : str, PathLike, Result or LoadedResult
        Folder of a run, or its result.
    to : str or sequence of str, optional
        What is written: "inp", "fibers", "frames", "step" or "viewer", or several of them.
    formats : str or sequence of str, optional
        Mesh formats of all results: "vtu", "vtk", "xdmf", "ply", "obj" or "gmsh", or several of them.
    out : str or PathLike, optional
        Folder for the files.  By default that of the run; a result that is in none needs one.
    band_width : float, optional
        Width of the fibre band, in the mesh's units.  By default that of the run's coverage, or of the layer.
    thickness : float, optional
        Thickness of one layer of band, in the mesh's units.  By default that of the run's band; where that is not
        known, "inp" needs it, and "fibers" has 1e-3 of the part's diagonal.
    shell : {"grid", "quads"}, default "grid"
        Elements of "inp" and "fibers": a regular grid, or the quad mesh on the crossings.
    elements : int, optional
        Approximate number of elements of the grid.  By default 1000 for "inp" and 10000 for "fibers".
    pressure : float, optional
        Pressure inside, in MPa, as a load of "inp"; below 0 outside.  Rims that are not held bear what it has on closed
        ends.  Without any load there is a pull of 1000 N to begin with; a load of 0 is none.
    axial : float, optional
        Axial force in N on rims that are not held, which pulls them apart, or pushes below 0.
    torque : float, optional
        Torque in N m about the line from rim to rim, on the end counterclockwise seen from outside.
    held : {"start", "end", "both", "none"}, default "start"
        Rims that are clamped.  With "none" the loads on both rims balance.
    material : str, default "t700-epoxy"
        Material of "inp": name of one that is shipped, or a TOML file.
    section_tolerance : float, default 2
        Degrees within which angles of elements agree that share a section of "inp"; at 0 each has its own.
    step : float, optional
        Largest distance between frames, in the mesh's units.  By default 2 % of the part's diagonal.
    angle : float, optional
        Largest turn from frame to frame, in degrees.  By default 5.

    Returns
    -------
    Exported
        The `files` that were written, and `notes` on what they do not hold.

    Raises
    ------
    BadInputError
        If a name is not known, the folder holds no results, or a file cannot be made from them.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
    >>> done = mw.export(result, "fibers", formats="vtu", out="files")
    >>> [file.name for file in done.files][:3]
    ['fibers.vtk', 'fibers.vtu', 'crossings.vtu']
    """
    deck = Loads(pressure, axial, torque, held), section_tolerance, material
    options = ExportOptions(thickness, band_width, step, angle, shell, elements, several(formats, "formats"), *deck)
    names = several(to, "to")
    if out is not None:
        out = path_given(out, "out", "folder")
    if isinstance(run, Result):
        if out is None:
            raise BadInputError("the result is in no folder; give out, a folder for the files")
        with run.in_folder() as folder:
            return write_exports(folder, names, out, options)
    return write_exports(run.folder if isinstance(run, LoadedResult) else run, names, out, options)
