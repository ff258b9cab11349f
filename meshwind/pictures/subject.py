"""Subject of the pictures of a winding: its layup, the maps on its surface, and the view."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.appearance.ribbons import turned_by
from meshwind.appearance.strips import Turned
from meshwind.appearance.view import View, best_view, named_view
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.filament.filament import Filament
from meshwind.layup.layup import Layup
from meshwind.path.lengths import lengths
from meshwind.path.paths import Paths, Status
from meshwind.pictures.scenes import Frame, Part
from meshwind.results.figures import PathFigures, path_figures
from meshwind.results.laminate_reading import ReadLaminate, read_laminate, widths
from meshwind.results.laminate_types import LayerFigures
from meshwind.results.pattern_types import PatternFigures
from meshwind.results.reading import Results, read_surface_grid
from meshwind.results.schema import NORMAL
from meshwind.surface.grid import grid

_MOST_POINTS, _FEWEST_POINTS, _ALL_POINTS = 250, 40, 60_000
"""Points drawn of a path, most and fewest, and of all paths together: more are not visible, and take 7 kB each."""


@dataclass(frozen=True)
class Subject:
    """A layup and its surface as outward quads (q, 4) between points (k, 3) with normals (k, 3) and maps (k,).

    name and units of the part for titles and legends; revolutions: as given, None if that is not known; seen_from:
    "auto", the name of a side, or a view; partings (k, 2): pairs of neighbours that part round a body.
    filaments of a continuous winding, its pattern in words, and what turns them at the start and at the end;
    laminate of a winding with layers, and the report's figures of these.
    """

    layup: Layup
    points: Floats
    quads: Ints
    normals: Floats
    name: str
    units: str = ""
    revolutions: float | None = None
    maps: Mapping[str, NDArray[Any]] = field(default_factory=dict)
    seen_from: str | View = "auto"
    partings: Ints = field(default_factory=lambda: np.zeros((0, 2), dtype=np.int64))
    filaments: tuple[Filament, ...] = ()
    pattern: str = ""
    turned: tuple[Turned, ...] = ()
    laminate: ReadLaminate | None = None
    layers: tuple[LayerFigures, ...] = ()

    @property
    def paths(self) -> Paths:
        """All paths."""
        return self.layup.paths

    @property
    def converged(self) -> Bools:
        """Which paths (p,) converged."""
        return np.asarray(self.paths.status == Status.CONVERGED)

    @property
    def widths(self) -> tuple[float, ...]:
        """Width of the band of each layer."""
        return widths(self.layers, self.layup.coverage.width)

    @cached_property
    def figures(self) -> PathFigures:
        """The report's figures of the paths."""
        return path_figures(self.paths)

    @cached_property
    def view(self) -> View:
        """View of the long side that shows most of the part, its bend and its bridges, or from the given side.

        The first hides half of the part, so that it is shown from the other side as well.
        """
        if isinstance(self.seen_from, View):
            return self.seen_from
        paths, kept = self.paths, self.kept
        drawn = paths.points[:, kept]
        if self.seen_from != "auto":
            return named_view(np.concatenate([self.points, drawn.reshape(-1, 3)]), self.seen_from)
        v = np.linspace(0.0, 1.0, 65)
        uv = np.stack(np.meshgrid(np.arange(32) / 32, v, indexing="ij"), axis=2).reshape(-1, 2)
        axis = paths.surface.points(uv).reshape(32, 65, 3).mean(axis=0)
        marks = drawn.reshape(-1, 3), paths.normal[:, kept].reshape(-1, 3), paths.gap[:, kept].ravel()
        return replace(best_view(self.points, self.quads, axis, *marks), both=True)

    @cached_property
    def kept(self) -> Ints:
        """Numbers of the particles that are drawn: every `stride`-th and the last."""
        count = self.paths.gap.shape[1]
        return np.unique(np.r_[np.arange(0, count, self.stride), count - 1])

    @property
    def stride(self) -> int:
        """Step between the particles that are drawn."""
        most = min(_MOST_POINTS, max(_FEWEST_POINTS, _ALL_POINTS // len(self.paths)))
        return -(-self.paths.gap.shape[1] // most)

    @property
    def pitch(self) -> float:
        """Mean distance from fibre to fibre of a family, in mesh units."""
        each = lengths(self.paths).polyline_length.sum() / len(np.unique(self.paths.family))
        return float(self.layup.coverage.area.sum() / max(each, 1e-300))

    @cached_property
    def part(self) -> Part:
        """The surface, with the fibres' pitch."""
        return Part(self.points, self.quads, self.normals, self.pitch)

    def frame(self, title: str, subtitle: str, view: View | None = None) -> Frame:
        """The words and the view."""
        return Frame(title, subtitle, self.units, view or self.view)

    def on(self, maps: Mapping[str, NDArray[Any]]) -> "Subject":
        """The same with the maps of surface.vtu, seen from the same side."""
        others = {name: values for name, values in maps.items() if name != NORMAL}
        return replace(self, normals=maps[NORMAL], maps=others, seen_from=self.view)

    def wound(self, filaments: Sequence[Filament], patterns: Sequence[PatternFigures]) -> "Subject":
        """The same as a continuous winding; patterns: the report's figures of it."""
        words = patterns[0]["words"] if len(patterns) == 1 else ""
        return replace(self, filaments=tuple(filaments), pattern=words, turned=turned_by(patterns))

    def layered(self, laminate: ReadLaminate | None, layers: Sequence[LayerFigures]) -> "Subject":
        """The same as a laminate, if there is one; layers: the report's figures of it."""
        return self if laminate is None or not layers else replace(self, laminate=laminate, layers=tuple(layers))


def subject(
    layup: Layup,
    name: str,
    units: str = "",
    revolutions: float | None = None,
    seen_from: str | View = "auto",
) -> Subject:
    """A layup to draw, without maps."""
    on = grid(layup.paths.surface)
    normals = np.cross(on.frames[:, 1], on.frames[:, 2])
    return Subject(layup, on.points, on.quads, normals, name, units, revolutions, seen_from=seen_from)


def subject_of(results: Results, seen_from: str = "auto") -> Subject:
    """The winding of a run's folder; raises BadInputError if it has no surface.vtu."""
    maps = read_surface_grid(results.folder, results.surface).point_data
    of = subject(results.layup, results.name, results.units, results.revolutions, seen_from).on(maps)
    of = replace(of, partings=results.partings)
    of = of.layered(read_laminate(results.folder, results.surface), results.layers)
    return of.wound(results.filaments, results.patterns) if results.filaments else of
