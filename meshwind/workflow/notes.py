"""Notes and warnings for the user beside the figures of a run."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from meshwind.appearance.words import power, quantity, ratio
from meshwind.chart import Chart
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.layup.layup import Layup
from meshwind.mesh import Annulus, Mesh
from meshwind.mesh.opening.branches import BRANCHES, CUT
from meshwind.mesh.opening.choose_ends import position_text
from meshwind.mesh.opening.flat_ends import has_flat_ends
from meshwind.path.lengths import lengths, unresolved_share
from meshwind.path.other_rests import OtherRests
from meshwind.path.paths import EDGE, Paths, Status, converged_or_all
from meshwind.results.schema import FIT_PICTURE, REVOLUTIONS_PICTURE
from meshwind.surface import FitError, Surface
from meshwind.surface.fitting.deviation import deviation

if TYPE_CHECKING:
    from meshwind.planning.revolutions import Revolutions
    from meshwind.planning.spacing import Spaced

MISSED = 10.0
"""A vertex error of more than this many times the tolerance is worth a warning, ..."""
SHOWS = 1e-4
"""... where it is also more than this share of the diagonal: less than the facets of most meshes are off."""
UNRESOLVED = 1e-2
"""An error in either direction of more than this share of the diagonal means that the surface has another shape."""
APART, APART_RMS = 3e-3, 3e-4
"""Largest distance between surface and mesh, and the facets' root mean square, over the diagonal, without a warning."""

LEFT_OUT = 5e-4
"""Least share of the fibre that is off the surface and not counted, of which a note tells: it shows as 0.1 %."""
SQUEEZED = 8.0
"""A 99th percentile of the area scale above this, over its mean, is typical of fingers, ears and fins."""
_FIGURE = re.compile(r"\d[\d.,e+-]*")
"""A number in a note, by which notes of one kind may differ."""
_MAX_LISTED = 3
"""Places where surface and mesh lie far apart that are listed with their coordinates."""
_PROTRUSIONS = "protrusions such as fingers, ears and branches are squeezed by the chart; wind a part without them"
_FINER = "give a finer or smoother mesh"
_LEGS = f"{BRANCHES}; {CUT}"
_COARSE = "its edges there are too sharp for the mesh; give a finer mesh, or round them"
_CAPS = (
    "its flat ends meet the flank at sharp edges; leave the flat ends off the mesh, or open them up to the edge by "
    "{opening}"
)
_HELD = 0.2
"""Vertices that are off the surface by less than this share of what the facets are off by lie on it ..."""
_ON_PART = 5e-3
"""... and by less than this share of the diagonal."""


@dataclass(frozen=True)
class Note:
    """One line for the user; a warning where the results may not be what was wanted.

    picture: name of the file that shows the subject, "" if there is none.
    """

    text: str
    warning: bool = False
    picture: str = ""

    def __str__(self) -> str:
        return f"warning: {self.text}" if self.warning else self.text

    def shown(self, there: bool) -> Note:
        """The note with a reference to its picture where there is one."""
        reference = f"; see {self.picture}"
        return replace(self, text=self.text.removesuffix(reference) + (reference if there and self.picture else ""))


def of_layers(notes: Sequence[tuple[int, Note]]) -> tuple[Note, ...]:
    """Notes on layers, by their numbers: one of each kind, with the layers it is of.

    Notes of a kind differ in their figures at most, and the first layer's are told.
    """
    kinds: dict[str, list[tuple[int, Note]]] = {}
    for number, note in notes:
        kinds.setdefault(_FIGURE.sub("#", note.text), []).append((number, note))
    told = []
    for alike in kinds.values():
        note = alike[0][1]
        same = [number for number, other in alike if other.text == note.text]
        others = [number for number, other in alike if other.text != note.text]
        likewise = f" (layer{'s' * (len(others) > 1)} {_listed(others)} likewise)" if others else ""
        told.append(replace(note, text=f"layer{'s' * (len(same) > 1)} {_listed(same)}{likewise}: {note.text}"))
    return tuple(told)


def _listed(numbers: Sequence[int]) -> str:
    return ", ".join(map(str, dict.fromkeys(numbers)))


def about_file(mesh: Mesh) -> tuple[Note, ...]:
    """Notes on how the mesh was made, and warnings of what the file holds beside it or was not read as written."""
    return (*map(Note, mesh.notes), *(Note(text, warning=True) for text in mesh.warnings))


def about_opening(annulus: Annulus) -> tuple[Note, ...]:
    """Notes on what was decided in opening a part, such as the skin of one with a wall; warnings of its branches."""
    return (*map(Note, annulus.notes), *(Note(text, warning=True) for text in annulus.warnings))


def about_paths(paths: Paths) -> tuple[Note, ...]:
    """Note on paths that turn over an edge which their particles do not resolve."""
    cut = int((paths.sharpest_turn[paths.status == Status.CONVERGED] > EDGE).sum())
    if not cut:
        return ()
    which = "1 path turns" if cut == 1 else f"{cut} paths turn"
    more = 2 * paths.gap.shape[1] - 1
    return (
        Note(
            f"{which} over an edge within one segment, exact to its length there; "
            f"{argument('particles', more)} resolves it better"
        ),
    )


def about_contact(paths: Paths, units: str = "") -> tuple[Note, ...]:
    """Note on the fibre whose distance from the surface is too small to count as bridging."""
    share = unresolved_share((lengths(paths), converged_or_all(paths.status)))
    if share < LEFT_OUT:
        return ()
    limit = paths.surface.threshold
    less = "the surface's uncertainty" if limit is None else f"the threshold of {quantity(limit, units, 2)}"
    return (Note(f"{100.0 * share:.1f} % of the fibre is off the surface by less than {less}, and counts as contact"),)


def about_other_rests(paths: Paths, units: str = "") -> tuple[Note, ...]:
    """Note on paths that would rest elsewhere, or slide off, with a little less or more friction or a little aside."""
    rests = paths.other_rests
    found = np.flatnonzero(rests.found)
    if not len(found):
        return ()
    listed = [_elsewhere(rests, int(path), units) for path in found[:_MAX_LISTED]]
    left = len(found) - _MAX_LISTED
    listed += [f"{left} more {'path' if left == 1 else 'paths'} in the report"] if left > 0 else []
    rest = "rests" if len(found) == 1 else "rest"
    return (Note(f"{len(found)} of {len(paths)} paths {rest} close to another state: {'; '.join(listed)}"),)


def _elsewhere(rests: OtherRests, path: int, units: str) -> str:
    """Where a path would lie with which change."""
    status, change, shift = Status(int(rests.status[path])), rests.friction[path], rests.shift[path]
    if np.isnan(rests.apart[path]):
        where = f"would not rest ({status.meaning})"
    else:
        where = f"would lie {quantity(rests.apart[path], units, 2)} away"
    if shift == 0.0:
        return (
            f"path {path} {where} if friction were {100.0 * abs(change):.2g} % {'lower' if change < 0.0 else 'higher'}"
        )
    side = "left" if shift > 0.0 else "right"
    return f"path {path} {where} if it were laid {quantity(abs(shift), units, 2)} further to the {side} at first"


def about_layup(layup: Layup) -> tuple[Note, ...]:
    """Note on a quad mesh that is not of converged paths."""
    if not layup.initial:
        return ()
    return (Note("too few paths converged for a quad mesh: crossings and quads are those of the windings as planned"),)


def about_choice(chosen: Revolutions | None) -> tuple[Note, ...]:
    """Note on why the revolutions were chosen, and what would allow more."""
    if chosen is None:
        return ()
    from meshwind.planning.alternatives import FRICTION  # late: most runs choose no revolutions

    more = []
    if chosen.with_friction > 0.0:
        more.append(f"friction {FRICTION:g} may allow {_number(chosen.with_friction)}")
    if chosen.with_opening > 0.0:
        more.append("wider openings may allow more")
    allowed = f"; {', '.join(more)}" if more else ""
    return (
        Note(f"chose {chosen.why}{allowed}; see {REVOLUTIONS_PICTURE}", not chosen.feasible.any, REVOLUTIONS_PICTURE),
    )


def _number(turns: float) -> str:
    return f"about {turns:.3g}" if np.isfinite(turns) else "any number"


def about_spacing(spaced: Spaced | None, units: str = "") -> tuple[Note, ...]:
    """Note on neighbours that stay further apart than the spacing, because no path lies stably between them."""
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
    """Notes on the fit; raises BadInputError where it is off by more than `worst_fit` of the part.

    A warning has FIT_PICTURE for its picture.
    """
    error = surface.error
    if error is None:
        return ()
    if error.relative_max > min(UNRESOLVED, worst_fit):
        text = _unresolved(surface, chart, error, units)
        if error.relative_max > worst_fit:
            told = "".join(f"; the file: {each}" for each in chart.annulus.mesh.warnings[:1])
            raise BadInputError(f"{text}, or raise {argument('worst_fit')}, now {worst_fit:g}{told}")
        return (Note(text, True, FIT_PICTURE),)
    if error.data != "vertices":
        return _followed(surface, chart, error, units)
    missed = error.to_surface_max / error.diagonal
    if missed <= tolerance:
        return ()
    text = _missed(error, missed, tolerance, units, _LEGS if _branches(chart) else _FINER)
    if missed <= max(MISSED * tolerance, SHOWS):
        return (Note(text),)
    return (Note(f"{text}; surface and mesh lie furthest apart {_places(surface, chart)}", True, FIT_PICTURE),)


def _followed(surface: Surface, chart: Chart, error: FitError, units: str) -> tuple[Note, ...]:
    """Notes on a surface that the facets led: why, and a warning where it lies far off them."""
    notes = list[Note]()
    if error.data == "facets":
        scatter = quantity(error.noise, units, 2)
        creased = f", for {_CAPS.format(opening=argument('opening'))}" if has_flat_ends(chart.annulus) else ""
        notes.append(
            Note(
                f"the vertices lie {scatter} off a smooth surface (root mean square), as in a decimated or "
                f"creased mesh: the surface follows the facets{creased}"
            )
        )
    else:
        text = "the vertices lie too far apart to hold a surface alone: it follows curved facets between them"
        notes.append(Note(text))
    if max(error.max / APART, error.to_mesh_rms / APART_RMS) > error.diagonal:
        notes.append(Note(_apart(surface, chart, error, units), True, FIT_PICTURE))
    return tuple(notes)


def _missed(error: FitError, missed: float, tolerance: float, units: str, instead: str) -> str:
    return (
        f"the tolerance of {ratio(tolerance)} is missed: vertices lie up to {ratio(missed)} of the part "
        f"({quantity(error.to_surface_max, units, 2)}) off the surface; {instead}, or accept it "
        f"with {argument('tolerance', power(missed))}"
    )


def _unresolved(surface: Surface, chart: Chart, error: FitError, units: str) -> str:
    text = _apart(surface, chart, error, units)
    return text if _is_coarse(chart, error) else f"the surface does not resolve the part: {text}"


def _apart(surface: Surface, chart: Chart, error: FitError, units: str) -> str:
    """How far and where surface and mesh lie apart, why, and what helps."""
    length = f"{quantity(error.max, units, 2)} ({100.0 * error.relative_max:.2g} % of the part)"
    places = _places(surface, chart)
    if _is_coarse(chart, error):
        return (
            f"the mesh is coarse: its facets lie up to {length} off the smooth surface through their corners, {places};"
            " where the part is curved there, the surface is the truer one; where it is flat, give a finer mesh"
        )
    return f"surface and mesh lie up to {length} apart {places}; {_cause(chart)}"


def _is_coarse(chart: Chart, error: FitError) -> bool:
    """Whether the surface keeps to the vertices, and only the flat facets between them lie off it."""
    on_part = min(_HELD * error.to_mesh_max, _ON_PART * error.diagonal)
    return error.to_surface_max < on_part and not _branches(chart)


def _cause(chart: Chart) -> str:
    """Why a surface lies far off the mesh, and what helps."""
    if _branches(chart):
        return _LEGS
    if has_flat_ends(chart.annulus):
        return _CAPS.format(opening=argument("opening"))
    squeezed = float(np.quantile(chart.stretch, 0.99)) > SQUEEZED
    return _PROTRUSIONS if squeezed else _COARSE


def _branches(chart: Chart) -> bool:
    """Whether the part has wide ends beside the two that are wound between."""
    return any(text.startswith(BRANCHES) for text in chart.annulus.warnings)


def _places(surface: Surface, chart: Chart) -> str:
    """Where the surface and the mesh lie furthest apart, seen from both, region by region."""
    found = deviation(surface, chart.annulus).regions
    diagonal = chart.annulus.mesh.diagonal
    first, *others = [position_text(where.on_surface, diagonal) for where in found]
    listed, left = others[: _MAX_LISTED - 1], len(found) - _MAX_LISTED
    listed += [f"{left} more {'place' if left == 1 else 'places'}"] if left > 0 else []
    return f"near {first}" + (f", then near {' and '.join(listed)}" if listed else "")
