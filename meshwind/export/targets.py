"""What a results folder can be exported to, by name, and the export itself."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from typing import TypeAlias

from meshwind.core.errors import BadInputError
from meshwind.export.elements import Elements, on_crossings, regular
from meshwind.export.fibers import write_fibers
from meshwind.export.formats import FORMATS, write_formats
from meshwind.export.frames import write_frames
from meshwind.export.material import Material
from meshwind.export.plies import plies
from meshwind.export.shell_deck import Deck, write_decks
from meshwind.export.step import write_step
from meshwind.export.viewer import write_viewer
from meshwind.results.folder import beside
from meshwind.results.reading import Results, read_results

GRID, QUADS = "grid", "quads"


@dataclass(frozen=True)
class Wishes:
    """Settings of the exports; None stands for what each says is its default.  Lengths in the mesh's units.

    thickness: of one layer of band; width: of the band; step, angle: longest step of robot frames and their largest
    turn in degrees; shell: elements of shell deck and fibre field, "grid" or "quads" for the run's quad mesh; count:
    elements of the grid, about; formats: mesh formats of `FORMATS`.
    """

    thickness: float | None = None
    width: float | None = None
    step: float | None = None
    angle: float | None = None
    shell: str = GRID
    count: int | None = None
    formats: Sequence[str] = ()

    def __post_init__(self) -> None:
        if self.shell not in (GRID, QUADS):
            raise BadInputError(f"shell is {self.shell!r}; give {GRID} or {QUADS}")
        if self.count is not None and not 48 <= self.count <= 1_000_000:
            raise BadInputError(f"elements is {self.count}; give a whole number from 48 to 1000000")
        _known("format", self.formats, FORMATS)


@dataclass(frozen=True)
class Exported:
    """The files that an export wrote, and what the user should know of them, a line each."""

    files: tuple[Path, ...]
    notes: tuple[str, ...]


Writer: TypeAlias = Callable[[Path, Results, Wishes], list[str]]
"""Writes into a folder that is there; returns what the user should know."""


def export(
    folder: str | PathLike[str],
    to: Sequence[str],
    out: str | PathLike[str] | None = None,
    wishes: Wishes | None = None,
) -> Exported:
    """Write what `to` names of `TARGETS`, and the wished formats, into `out`, by default the results folder itself.

    All files appear, or none.  Raises BadInputError for a name that is not known, for a folder that holds no results
    and where a target cannot be made of them.
    """
    asked = wishes or Wishes()
    _known("target", to, TARGETS)
    if not (to or asked.formats):
        raise BadInputError(f"nothing to export; give --to {','.join(TARGETS)} or --formats {','.join(FORMATS)}")
    results = read_results(folder)
    target = Path(folder if out is None else out)
    notes: list[str] = []
    with beside(target) as staging:
        for name in dict.fromkeys(to):
            notes += TARGETS[name](staging, results, asked)
        if asked.formats:
            notes += write_formats(staging, results, tuple(dict.fromkeys(asked.formats)))
        names = sorted(path.relative_to(staging) for path in staging.rglob("*") if path.is_file())
    return Exported(tuple(target / name for name in names), tuple(notes))


def _known(what: str, names: Sequence[str], known: Mapping[str, object]) -> None:
    strange = [name for name in names if name not in known]
    if strange:
        raise BadInputError(f"{what} {strange[0]!r} is not known; give {', '.join(known)}")


def _elements(results: Results, wishes: Wishes, count: int) -> Elements:
    if wishes.shell == QUADS:
        return on_crossings(results)
    return regular(results.surface, wishes.count or count)


def _deck(folder: Path, results: Results, wishes: Wishes) -> list[str]:
    elements = _elements(results, wishes, 1000)
    laid = plies(results, elements, wishes.thickness, wishes.width)
    return write_decks(folder, Deck(elements, laid, Material(), results.units, results.name))


def _fibers(folder: Path, results: Results, wishes: Wishes) -> list[str]:
    elements = _elements(results, wishes, 10_000)
    write_fibers(folder, elements, plies(results, elements, wishes.thickness, wishes.width), results.units)
    return []


def _frames(folder: Path, results: Results, wishes: Wishes) -> list[str]:
    return write_frames(folder, results, wishes.step, wishes.angle, wishes.width)


def _step(folder: Path, results: Results, wishes: Wishes) -> list[str]:
    del wishes  # a surface and its curves have no settings
    return write_step(folder, results)


def _viewer(folder: Path, results: Results, wishes: Wishes) -> list[str]:
    del wishes  # what the page shows is set in the page
    return write_viewer(folder, results)


TARGETS: dict[str, Writer] = {
    "inp": _deck,
    "fibers": _fibers,
    "frames": _frames,
    "step": _step,
    "viewer": _viewer,
}
