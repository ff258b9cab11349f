"""Pictures of a run, drawn in another process while this one writes its files."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

from meshwind.core.geometry import Data
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.gallery import Sheet, makers_of, names_of, placed
from meshwind.pictures.page import Page
from meshwind.pictures.painter import Painter, painter
from meshwind.pictures.subject import Subject, subject
from meshwind.results.laminate_reading import read_laminate
from meshwind.results.layup_figures import parted
from meshwind.results.schema import FIT_PICTURE, SHEET, WINDING, picture

if TYPE_CHECKING:
    from meshwind.run.result import Result


@contextmanager
def drawing(result: Result, out: Path) -> Iterator[Pictures]:
    """The pictures of a run: the winding, which is begun at once, the picture of a warning and the contact sheet."""
    # the folder is within the other, so that a killed run leaves nothing elsewhere
    with TemporaryDirectory(dir=out) as cells, painter() as one:
        made = Pictures(result, (out, Path(cells)), one)
        made.begin()
        yield made


class Pictures:
    """The pictures of a run on their way to the renderer; those of the sheet alone are in a folder of their own."""

    def __init__(self, result: Result, folders: tuple[Path, Path], one: Painter) -> None:
        self._result, self._folders, self._painter = result, folders, one
        self._sent: list[Path] = []
        on = subject(result.layup, result.mesh.name, result.mesh.units, result.revolutions)
        self._subject = replace(on, partings=parted(result.layup, result.spaced))

    def begin(self) -> None:
        """Send the picture of the winding."""
        self._send(self._subject, WINDING)

    def go_on(self, maps: Data) -> None:
        """Send the other pictures, when all files are written; maps: those of surface.vtu."""
        result, (out, _) = self._result, self._folders
        of = self._whole(maps, out)
        for name in makers_of(of):
            if name != WINDING:
                self._send(of, name)
        if any(note.picture == FIT_PICTURE for note in result.notes):
            scene = fit_scene(result.surface, result.chart.annulus, result.mesh.name, result.mesh.units)
            self._painter.send(out / FIT_PICTURE, Drawing(scene))

    def finish(self) -> str:
        """Wait for all pictures and arrange them on the sheet; return "" or what is missing for drawing."""
        sheet = Sheet(self._sent)
        missing = self._painter.finish(sheet.take)
        if not missing:
            sheet.write(self._folders[0] / picture(SHEET))
        return missing

    def _send(self, of: Subject, name: str) -> None:
        """Send the picture of a name: to be seen on its own, or on the sheet alone."""
        scenes, asked = {name: makers_of(of)[name](of)}, (WINDING, SHEET, *names_of(of))
        for file, one in placed(scenes, asked, Page(), *self._folders).items():
            self._painter.send(file, one)
            self._sent.append(file)

    def _whole(self, maps: Data, out: Path) -> Subject:
        """The subject with its maps and, if there are any, its filaments and its laminate."""
        result, of = self._result, self._subject.on(maps)
        if not result.filaments and result.layered is None:
            return of
        figures = result.report()
        of = of.layered(read_laminate(out, result.surface), figures.get("laminate", []))
        return of.wound(result.filaments, figures.get("pattern", [])) if result.filaments else of
