"""The result of an earlier run, from its folder."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, fields
from functools import cached_property
from os import PathLike
from pathlib import Path

from meshwind.core.geometry import Data
from meshwind.core.parsing import AUTO, read_toml
from meshwind.filament.filament import Filament
from meshwind.layup.layup import Layup
from meshwind.path.paths import Paths
from meshwind.results.reading import Results, read_results, read_surface_grid
from meshwind.results.report_types import Report
from meshwind.results.schema import CONFIG
from meshwind.results.wound_layers import WoundLayers
from meshwind.run.views import Views
from meshwind.surface.surface import Surface
from meshwind.workflow.notes import Note
from meshwind.workflow.options import Options

_WARNING = "warning: "


@dataclass(frozen=True, repr=False)
class LoadedResult(Views):
    """The result of an earlier run, as `load` reads it from its folder.

    It has the paths, the surface, the layup, the filaments, the figures, the options and the notes of `Result`, equal
    to the last bit, and its pictures and tables.  The mesh and its chart are not in the folder.

    Attributes
    ----------
    results : Results
        What the files hold.

    See Also
    --------
    load : Read a folder.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51, out="out", render=False)
    >>> mw.load("out")
    <meshwind LoadedResult: tank.ply, 8 of 8 paths at rest>
    """

    results: Results

    @property
    def folder(self) -> Path:
        """The folder."""
        return self.results.folder

    @property
    def name(self) -> str:
        """Name of the part."""
        return self.results.name

    @property
    def units(self) -> str:
        """Name of the unit of length, "" where it is not known."""
        return self.results.units

    @property
    def diagonal(self) -> float:
        """Diagonal of the part, in the mesh's units."""
        return self.results.diagonal

    @property
    def surface(self) -> Surface:
        """The fitted surface."""
        return self.results.surface

    @property
    def paths(self) -> Paths:
        """All paths, family +1 first."""
        return self.results.paths

    @property
    def layup(self) -> Layup:
        """Paths with crossings, quads and coverage."""
        return self.results.layup

    @property
    def filaments(self) -> tuple[Filament, ...]:
        """The filaments of a continuous winding; none of another."""
        return self.results.filaments

    @property
    def layers(self) -> WoundLayers | None:
        """The layers one on another, None where the run has none."""
        return self.results.wound_layers

    @property
    def revolutions(self) -> float | None:
        """Revolutions from end to end, None where the report has none."""
        return self.results.revolutions

    @property
    def settled(self) -> bool:
        """Whether every path is in equilibrium."""
        return bool(self.results.at_rest.all())

    @property
    def command(self) -> str:
        """Command line of the run, "" where it was wound from Python."""
        return str(self.report().get("command", ""))

    @property
    def seconds(self) -> dict[str, float]:
        """Wall time of each stage."""
        return dict(self.report().get("seconds", {}))

    @property
    def notes(self) -> tuple[Note, ...]:
        """What a user should know beside the figures."""
        texts = self.report().get("notes", [])
        return tuple(Note(text.removeprefix(_WARNING), text.startswith(_WARNING)) for text in texts)

    @cached_property
    def maps(self) -> Data:
        """The maps of surface.vtu, by name, at the points of its grid."""
        return read_surface_grid(self.folder, self.surface).point_data

    @cached_property
    def options(self) -> Options | None:
        """Options that the part was wound with, None where the folder has no meshwind.toml."""
        file = self.folder / CONFIG
        if not file.is_file():
            return None
        held = {key.replace("-", "_"): value for key, value in read_toml(file, "config").items()}
        given = {each.name: held[each.name] for each in fields(Options) if each.name in held}
        given |= {name: None for name in ("paths", "particles") if given.get(name) == AUTO}
        if "pins" in given:
            given["pins"] = str(self.folder / given["pins"])
        return Options(**given)

    def report(self) -> Report:
        """Give the figures of the run.

        Returns
        -------
        dict
            Contents of `report.json`: lengths in the mesh's units, angles in degrees.

        Examples
        --------
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51, out="out", render=False)
        >>> mw.load("out").report()["paths"]["converged"]
        8
        """
        return self.results.report

    @contextmanager
    def in_folder(self) -> Iterator[Path]:
        """Yield the folder of the run.

        Yields
        ------
        Path
            The folder.

        Examples
        --------
        >>> import meshwind as mw
        >>> result = mw.wind("data/tank.ply", paths=3, particles=51, out="out", render=False)
        >>> with mw.load("out").in_folder() as folder:
        ...     (folder / "report.json").is_file()
        True
        """
        yield self.folder


def load(folder: str | PathLike[str]) -> LoadedResult:
    """Read the result of an earlier run from its folder.

    Parameters
    ----------
    folder : str or PathLike
        Folder that `wind` or `Result.write`, or the command `meshwind wind`, left.

    Returns
    -------
    LoadedResult
        The result, with the same arrays to the last bit.

    Raises
    ------
    BadInputError
        If the folder holds no run, or its files are damaged or do not belong together.

    See Also
    --------
    wind : Wind a part.

    Examples
    --------
    >>> import meshwind as mw
    >>> import numpy as np
    >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51, out="out", render=False)
    >>> same = mw.load("out")
    >>> np.array_equal(same.paths.points, result.paths.points)
    True
    >>> same.options == result.options
    True
    """
    return LoadedResult(read_results(folder))
