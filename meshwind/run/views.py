"""What a wound part gives to people and to other libraries, whether it was just wound or read from its folder."""

from __future__ import annotations

import base64
from collections.abc import Mapping
from contextlib import AbstractContextManager
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from meshwind.core.defaults import MACHINE
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block, Data
from meshwind.core.table import as_columns, data_frame
from meshwind.filament.filament import Filament, filaments_block
from meshwind.layup.layup import Layup
from meshwind.path.blocks import bridges_block, paths_block, paths_table
from meshwind.path.paths import Paths, Status
from meshwind.pictures.page import Page
from meshwind.pictures.picture import Picture
from meshwind.pictures.screen import has_screen, show
from meshwind.results.report_types import Report
from meshwind.results.schema import picture as picture_file
from meshwind.run.summary import run_lines
from meshwind.surface.grid import grid

if TYPE_CHECKING:
    import meshio
    import pandas
    import pyvista
    import trimesh

    from meshwind.program.program import Program

PART, FIBRES, BRIDGES, CROSSINGS, QUADS, FILAMENT = "part", "fibres", "bridges", "crossings", "quads", "filament"
"""Names of what is seen of a wound part."""
_LABEL = 10
"""Characters of a summary's label."""
_SMALL = Page(800, 600)
"""The picture in a notebook."""
TABLES = "paths", "points", "stations", CROSSINGS, BRIDGES, FILAMENT, "layers"
"""Tables of a wound part."""


class Wound(Protocol):
    """What the views are made of."""

    @property
    def name(self) -> str:
        """Name of the part."""

    @property
    def units(self) -> str:
        """Unit of length."""

    @property
    def paths(self) -> Paths:
        """All paths, family +1 first."""

    @property
    def layup(self) -> Layup:
        """Paths, crossings, quads and coverage."""

    @property
    def filaments(self) -> tuple[Filament, ...]:
        """The filaments, if the winding is continuous."""

    @property
    def diagonal(self) -> float:
        """Diagonal of the part."""

    @property
    def maps(self) -> Data:
        """The maps of surface.vtu."""

    def report(self) -> Report:
        """The figures."""

    def in_folder(self) -> AbstractContextManager[Path]:
        """A folder with the files of the run."""


class Views:
    """Base of results: pictures, tables, and what other libraries take."""

    def __repr__(self: Wound) -> str:
        at_rest = int((self.paths.status == Status.CONVERGED).sum())
        return f"<meshwind {type(self).__name__}: {self.name}, {at_rest} of {len(self.paths)} paths at rest>"

    def plot(
        self: Wound,
        what: str = "winding",
        *,
        page: Page | None = None,
        file: str | Path | None = None,
        interactive: bool | None = None,
    ) -> Picture | None:
        """Show the wound part: in a window where there is a screen, else as a picture.

        Parameters
        ----------
        what : str, default "winding"
            A picture of `render`, such as "winding", "coverage", "angles", "slip" or "bands".
        page : Page, optional
            Size, style and side of the picture.
        file : str or Path, optional
            File for the picture, which is then drawn in any case.
        interactive : bool, optional
            Whether to open a window, which shows part and fibres whatever `what` is.  By default where there is a
            screen, no file is asked for, and `what` is "winding".

        Returns
        -------
        Picture or None
            The picture, which a notebook shows; None after a window was closed.

        Raises
        ------
        BadInputError
            If there is no such picture of this run, or this machine cannot draw.

        Examples
        --------
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
        >>> result.plot("coverage", page=mw.Page(400, 300), interactive=False)
        <meshwind Picture: coverage of tank.ply, 400 x 300>
        """
        window = (has_screen() and file is None and what == "winding") if interactive is None else interactive
        if window:
            show(blocks(self), self.name)
            return None
        from meshwind.pictures.render import render  # late, as in all below: most runs are for their files

        with self.in_folder() as folder, TemporaryDirectory() as drawn:
            render(folder, [what], page, out=drawn)
            seen = Picture((Path(drawn) / picture_file(what)).read_bytes(), f"{what} of {self.name}")
        if file is not None:
            seen.save(file)
        return seen

    def to_pyvista(self: Wound) -> pyvista.MultiBlock:
        """Give the wound part to PyVista.

        Returns
        -------
        pyvista.MultiBlock
            Blocks "part" with the maps of the surface, "fibres", "bridges", "crossings", "quads" and "filament": those
            which there are, with the fields of the run's files.

        Examples
        --------
        >>> import meshwind as mw
        >>> seen = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51).to_pyvista()
        >>> seen.keys(), seen["fibres"].n_cells
        (['part', 'fibres', 'crossings', 'quads'], 8)
        """
        import pyvista

        made = pyvista.MultiBlock({name: block.to_pyvista() for name, block in blocks(self).items()})
        for each in made if self.units else ():
            each.field_data["units"] = [self.units]
        return made

    def to_trimesh(self: Wound) -> trimesh.Scene:
        """Give the wound part to trimesh.

        Returns
        -------
        trimesh.Scene
            Geometries of the names of `to_pyvista`: meshes of triangles, paths, and a cloud of the crossings.

        Examples
        --------
        >>> import meshwind as mw
        >>> scene = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51).to_trimesh()
        >>> scene.geometry["part"].is_watertight, len(scene.geometry["fibres"].entities)
        (False, 8)
        """
        import trimesh

        made = trimesh.Scene()
        for name, block in blocks(self).items():
            made.add_geometry(block.to_trimesh(), geom_name=name)
        made.units = self.units or None
        return made

    def to_meshio(self: Wound) -> dict[str, meshio.Mesh]:
        """Give the wound part to meshio, one mesh for each block.

        Returns
        -------
        dict of str to meshio.Mesh
            Meshes by the names of `to_pyvista`; polylines are line cells.

        Examples
        --------
        >>> import meshwind as mw
        >>> meshes = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51).to_meshio()
        >>> [(name, list(mesh.cells_dict)) for name, mesh in meshes.items()][:2]
        [('part', ['quad']), ('fibres', ['line'])]
        """
        return {name: block.to_meshio() for name, block in blocks(self).items()}

    def to_dataframe(self: Wound, of: str = "paths") -> pandas.DataFrame:
        """Give figures to pandas.

        Parameters
        ----------
        of : {"paths", "points", "stations", "crossings", "bridges", "filament", "layers"}, default "paths"
            What has a row: each path, each particle, each station along the part, each crossing, each bridge, each
            point of the filaments, or each layer.

        Returns
        -------
        pandas.DataFrame
            Columns are named as the fields of the files, and those of the report as its keys, with "_" between them.

        Raises
        ------
        BadInputError
            If `of` is another word, this run has nothing of it, or pandas is not installed.

        Examples
        --------
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
        >>> result.to_dataframe()["fibre_length"].round(1).unique().size
        1
        >>> result.to_dataframe("stations").columns.tolist()
        ['v', 'z', 'angle_min', 'angle_median', 'angle_max', 'cover']
        """
        return data_frame(_table(self, of))

    def program(self: Wound, machine: str = MACHINE, tension: float = 0.0) -> Program:
        """Plan the program of a winding machine for the filament; nothing is written.

        Parameters
        ----------
        machine : str, default "lathe-4"
            Name of a machine that is shipped, or the path of a TOML file of one.
        tension : float, default 0
            Tension of the fibre in N; 0 if none is set.

        Returns
        -------
        Program
            Blocks, time and faults; its `to_dataframe` gives the rows of program.csv.

        Raises
        ------
        BadInputError
            If the run was not wound with `continuous`, or the machine cannot be used.

        Examples
        --------
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=5, revolutions=0.3, particles=51, friction=0.3, continuous=True)
        >>> result.program("lathe-3").block.points.shape[1]
        3
        """
        from meshwind.program.machine import read_machine
        from meshwind.program.program import program
        from meshwind.program.work import Work

        if not self.filaments:
            raise BadInputError(f"{self.name} was not wound as a filament; wind it with continuous=True")
        work = Work(self.filaments, self.layup.paths.surface, self.diagonal, self.units, self.name)
        return program(work, read_machine(machine), tension)

    def _repr_html_(self: Wound) -> str:
        """The picture and the lines that the command prints, for a notebook."""
        from meshwind.pictures.render import render

        with self.in_folder() as folder, TemporaryDirectory() as drawn:
            try:
                render(folder, ["winding"], _SMALL, out=drawn)
                held = base64.b64encode((Path(drawn) / picture_file("winding")).read_bytes()).decode("ascii")
                image = f'<img alt="winding of {escape(self.name)}" width="560" src="data:image/png;base64,{held}">'
            except BadInputError as error:  # a machine without graphics
                image = f"<p>{escape(str(error))}</p>"
        lines = [line for line in run_lines(self.report()) if not line.startswith("seconds")]
        rows = "".join(
            f"<tr><th style='text-align:left'>{escape(line[:_LABEL].strip())}</th>"
            f"<td style='text-align:left'>{escape(line[_LABEL:])}</td></tr>"
            for line in lines
        )
        return f"<div>{image}<table>{rows}</table></div>"


def blocks(of: Wound) -> dict[str, Block]:
    """What is seen of a wound part, by name."""
    layup, on = of.layup, grid(of.layup.paths.surface)
    found = {
        PART: Block(on.points, quads=on.quads, point_data=of.maps),
        FIBRES: paths_block(layup.paths),
        BRIDGES: bridges_block(layup.paths),
        CROSSINGS: layup.crossings.block,
    }
    found = {name: block for name, block in found.items() if len(block.points)}
    if len(layup.quads.quads) + len(layup.quads.triangles):
        found[QUADS] = layup.quads.block
    if of.filaments:
        found[FILAMENT] = filaments_block(of.filaments)
    return found


def _table(of: Wound, what: str) -> Data:
    """Columns of one of `TABLES`."""
    if what not in TABLES:
        raise BadInputError(f"of is {what!r}; give {', '.join(TABLES[:-1])} or {TABLES[-1]}")
    if what in ("paths", "points"):
        return paths_table(of.layup.paths, what)
    if what == BRIDGES:
        return bridges_block(of.layup.paths).line_data
    if what == CROSSINGS:
        return of.layup.crossings.block.columns()
    if what == FILAMENT:
        if not of.filaments:
            raise BadInputError(f"{of.name} was not wound as a filament; wind it with continuous=True")
        block = filaments_block(of.filaments)
        return {"filament": np.repeat(block.line_data["filament"], np.diff(block.starts)), **block.columns()}
    report: Any = of.report()
    rows = report.get("angle_stations" if what == "stations" else "laminate", [])
    if not rows:
        raise BadInputError(f"{of.name} has no {what}; wind it with layers" if what == "layers" else "no stations")
    return as_columns([_flat(row) for row in rows])


def _flat(figures: Mapping[str, Any], before: str = "") -> dict[str, Any]:
    """Nested figures in a row, with "_" between their keys."""
    row: dict[str, Any] = {}
    for key, value in figures.items():
        row |= _flat(value, f"{before}{key}_") if isinstance(value, Mapping) else {f"{before}{key}": value}
    return row
