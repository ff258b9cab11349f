"""Export of a run's folder to named targets."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from numbers import Integral
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from meshwind.core.checks import check_word, text
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.exporting.elements import Elements, on_crossings, regular
from meshwind.exporting.fibers import write_fibers
from meshwind.exporting.formats import FORMATS, write_formats
from meshwind.exporting.frames import Limits, write_frames
from meshwind.exporting.material import DEFAULT, read_material
from meshwind.exporting.ordered_frames import write_ordered_frames
from meshwind.exporting.plies import laid_on, plies
from meshwind.exporting.shell_about import fingerprint_of_run
from meshwind.exporting.shell_deck import Deck, write_decks
from meshwind.exporting.shell_groups import TOLERANCE
from meshwind.exporting.shell_loads import Loads
from meshwind.exporting.step import write_step
from meshwind.exporting.viewer import write_viewer
from meshwind.results.folder import beside
from meshwind.results.reading import Results, read_results

GRID, QUADS = "grid", "quads"


@dataclass(frozen=True)
class ExportOptions:
    """Options of the exports; None is the default that each export states.  Lengths are in the mesh's units.

    thickness: of one layer of band; width: of the band; step, angle: longest step of robot frames and their largest
    turn in degrees; shell: elements of shell deck and fibre field, "grid" or "quads" for the run's quad mesh; count:
    approximate number of elements of the grid; formats: mesh formats of `FORMATS`; loads: of the shell deck, with what
    holds it; tolerance: degrees within which its elements share a section; material: name of one that is
    shipped, or a TOML file.
    """

    thickness: float | None = None
    width: float | None = None
    step: float | None = None
    angle: float | None = None
    shell: str = GRID
    count: int | None = None
    formats: Sequence[str] = ()
    loads: Loads = field(default_factory=Loads)
    tolerance: float = TOLERANCE
    material: str = DEFAULT

    def __post_init__(self) -> None:
        check_word(self.shell, "shell", (GRID, QUADS))
        if self.count is not None and not (isinstance(self.count, Integral) and 48 <= self.count <= 1_000_000):
            raise BadInputError(f"elements is {text(self.count)}; give a whole number from 48 to 1000000")
        _known("format", self.formats, FORMATS)


@dataclass(frozen=True)
class Exported:
    """What an export wrote.

    Attributes
    ----------
    files : tuple of Path
        The files.
    notes : tuple of str
        What a user should know of them.

    Examples
    --------
    >>> import meshwind as mw
    >>> result = mw.wind("data/tank.ply", paths=4, revolutions=0.3, particles=51)
    >>> [file.name for file in mw.export(result, formats="obj", out="files").files][:2]
    ['crossings.obj', 'paths.obj']
    """

    files: tuple[Path, ...]
    notes: tuple[str, ...]


Writer: TypeAlias = Callable[[Path, Results, ExportOptions], list[str]]
"""Writes into an existing folder; returns what the user should know."""


def write_exports(
    folder: str | PathLike[str],
    to: Sequence[str],
    out: str | PathLike[str] | None = None,
    options: ExportOptions | None = None,
) -> Exported:
    """Write the named `TARGETS` and the formats of the options into `out`, by default the results folder itself.

    All files appear, or none.  Raises BadInputError if a name is not known, the folder holds no results, or a target
    cannot be made from them.
    """
    given = options or ExportOptions()
    _known("target", to, TARGETS)
    if not (to or given.formats):
        targets, formats = f"{argument('to')} ({', '.join(TARGETS)})", f"{argument('formats')} ({', '.join(FORMATS)})"
        raise BadInputError(f"nothing to export; give {targets} or {formats}")
    results = read_results(folder)
    target = Path(folder if out is None else out)
    notes: list[str] = []
    with beside(target) as staging:
        for name in dict.fromkeys(to):
            notes += TARGETS[name](staging, results, given)
        if given.formats:
            notes += write_formats(staging, results, tuple(dict.fromkeys(given.formats)))
        names = sorted(path.relative_to(staging) for path in staging.rglob("*") if path.is_file())
    return Exported(tuple(target / name for name in names), tuple(notes))


def _known(what: str, names: Sequence[str], known: Mapping[str, object]) -> None:
    unknown = [name for name in names if name not in known]
    if unknown:
        raise BadInputError(f"{what} {unknown[0]!r} is not known; give {', '.join(known)}")


def _elements(results: Results, options: ExportOptions, count: int) -> Elements:
    surface = laid_on(results)
    if options.shell == QUADS:
        return on_crossings(results, surface)
    return regular(surface, options.count or count, results.surface)


def _deck(folder: Path, results: Results, options: ExportOptions) -> list[str]:
    if results.wound_layers is None and results.band_thickness is None and options.thickness is None:
        raise BadInputError(
            f"the run does not say how thick its band is; give {argument('thickness')}, which inp needs"
        )
    elements = _elements(results, options, 1000)
    laid = plies(results, elements, options.thickness, options.width)
    about = results.units, results.name, options.loads, options.tolerance, fingerprint_of_run(results.folder)
    return write_decks(folder, Deck(elements, laid, read_material(options.material), *about))


def _fibers(folder: Path, results: Results, options: ExportOptions) -> list[str]:
    elements = _elements(results, options, 10_000)
    write_fibers(folder, elements, plies(results, elements, options.thickness, options.width), results.units)
    return []


def _frames(folder: Path, results: Results, options: ExportOptions) -> list[str]:
    given = options.step, options.angle, options.width
    return write_frames(folder, results, *given) + write_ordered_frames(folder, results, Limits.of(results, *given))


def _step(folder: Path, results: Results, options: ExportOptions) -> list[str]:
    del options  # a surface and its curves have none
    return write_step(folder, results)


def _viewer(folder: Path, results: Results, options: ExportOptions) -> list[str]:
    del options  # what the page shows is chosen in the page
    return write_viewer(folder, results)


TARGETS: dict[str, Writer] = {
    "inp": _deck,
    "fibers": _fibers,
    "frames": _frames,
    "step": _step,
    "viewer": _viewer,
}
