"""What a user should know of a run beside its figures: how well the surface follows the mesh."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.appearance.words import power, quantity, ratio
from meshwind.chart import Chart
from meshwind.core.errors import BadInputError
from meshwind.layup.layup import Layup
from meshwind.mesh.opening.ends import place
from meshwind.path.paths import EDGE, Paths, Status
from meshwind.planning.revolutions import FRICTION, WIDER, Revolutions
from meshwind.planning.spacing import Spaced
from meshwind.results.schema import FIT_PICTURE, REVOLUTIONS_PICTURE
from meshwind.surface import FitError, Surface
from meshwind.surface.deviation import deviation

MISSED = 10.0
"""A vertex error of so many times the tolerance is worth a warning, ..."""
SHOWS = 1e-4
"""... where it is also more than this part of the diagonal: less than the facets of most meshes are off."""
UNRESOLVED = 1e-2
"""An error, either way, of more than this part of the diagonal means that the surface is another shape."""

SQUEEZED = 8.0
"""Area scale that is this uneven (its 99th percentile over its mean) is the mark of fingers, ears and fins."""
_TOLD = 3
"""So many of the places where they do are told by their coordinates."""
_PROTRUSIONS = "protrusions such as fingers and ears are squeezed by the chart; wind a part without them"
_COARSE = "its edges there are too sharp for the mesh; give a finer mesh, or round them"


@dataclass(frozen=True)
class Note:
    """One line for the user; a warning is one that says the results may not be what was wanted.

    picture: name of the file that shows what it is about, "" if none does.
    """

    text: str
    warning: bool = False
    picture: str = ""

    def __str__(self) -> str:
        return f"warning: {self.text}" if self.warning else self.text

    def shown(self, there: bool) -> "Note":
        """The note, naming its picture where that is there and not where it is not."""
        words = f"; see {self.picture}"
        return replace(self, text=self.text.removesuffix(words) + (words if there and self.picture else ""))


def about_paths(paths: Paths) -> tuple[Note, ...]:
    """What to say of the paths: how many cut an edge that their particles do not resolve."""
    cut = int((paths.sharpest_turn[paths.status == Status.CONVERGED] > EDGE).sum())
    if not cut:
        return ()
    told = "1 path turns" if cut == 1 else f"{cut} paths turn"
    more = 2 * paths.gap.shape[1] - 1
    return (Note(f"{told} over an edge within one segment, exact to its length there; --particles {more} tells more"),)


def about_layup(layup: Layup) -> tuple[Note, ...]:
    """Whether the quad mesh is of fibres that hold."""
    if not layup.initial:
        return ()
    return (Note("too few paths hold for a quad mesh: crossings and quads are those of the windings as asked for"),)


def about_choice(chosen: Revolutions | None) -> tuple[Note, ...]:
    """Why so many revolutions were chosen, and what would allow more."""
    if chosen is None:
        return ()
    ways = []
    if chosen.with_friction > 0.0:
        ways.append(f"friction {FRICTION:g} would allow {_number(chosen.with_friction)}")
    if chosen.with_opening > 0.0:
        ways.append(f"openings {WIDER:g} times as wide {_number(chosen.with_opening)}")
    more = f"; {', '.join(ways)}" if ways else ""
    return (Note(f"chose {chosen.why}{more}; see {REVOLUTIONS_PICTURE}", not chosen.holding.any, REVOLUTIONS_PICTURE),)


def _number(turns: float) -> str:
    return f"{turns:.3g}" if np.isfinite(turns) else "any number"


def about_spacing(spaced: Spaced | None, units: str = "") -> tuple[Note, ...]:
    """Where the spacing could not be kept, because no fibre rests between two neighbours."""
    if spaced is None or not len(spaced.partings):
        return ()
    many = len(spaced.partings)
    where = "1 place no fibre rests between two" if many == 1 else f"{many} places no fibre rests between"
    return (
        Note(
            f"at {where} neighbours, up to {quantity(spaced.widest, units, 2)} apart: they part around a boss, which "
            "other revolutions or friction may cover"
        ),
    )


def about_fit(surface: Surface, chart: Chart, tolerance: float, worst_fit: float, units: str = "") -> tuple[Note, ...]:
    """What to say of the fit; raises BadInputError where it is off by more than `worst_fit` of the part.

    A warning has FIT_PICTURE for its picture.
    """
    error = surface.error
    if error is None:
        return ()
    if error.relative_max > min(UNRESOLVED, worst_fit):
        text = _unresolved(surface, chart, error, units)
        if error.relative_max > worst_fit:
            raise BadInputError(f"{text}, or raise worst_fit (--worst-fit), now {worst_fit:g}")
        return (Note(text, True, FIT_PICTURE),)
    missed = error.to_surface_max / error.diagonal
    if missed <= tolerance:
        return ()
    text = _missed(error, missed, tolerance, units)
    if missed <= max(MISSED * tolerance, SHOWS):
        return (Note(text),)
    return (Note(f"{text}; surface and mesh lie furthest apart {_places(surface, chart)}", True, FIT_PICTURE),)


def _missed(error: FitError, missed: float, tolerance: float, units: str) -> str:
    return (
        f"the tolerance of {ratio(tolerance)} is missed: vertices lie up to {ratio(missed)} of the part "
        f"({quantity(error.to_surface_max, units, 2)}) off the surface; give a finer or smoother mesh, or accept it "
        f"with --tolerance {power(missed)}"
    )


def _unresolved(surface: Surface, chart: Chart, error: FitError, units: str) -> str:
    squeezed = float(np.quantile(chart.stretch, 0.99)) > SQUEEZED
    return (
        f"the surface does not resolve the part: it lies up to {quantity(error.max, units, 2)} "
        f"({100.0 * error.relative_max:.2g}% of the part) off the mesh {_places(surface, chart)}; "
        + (_PROTRUSIONS if squeezed else _COARSE)
    )


def _places(surface: Surface, chart: Chart) -> str:
    """Where the surface and the mesh lie furthest apart, looked at from both, region by region."""
    found = deviation(surface, chart.annulus).regions
    diagonal = chart.annulus.mesh.diagonal
    told = [place(where.on_surface, diagonal) for where in found]
    rest = len(told) - _TOLD
    more = told[1:_TOLD] + ([f"{rest} more {'place' if rest == 1 else 'places'}"] if rest > 0 else [])
    return f"near {told[0]}" + (f", then near {' and '.join(more)}" if more else "")
