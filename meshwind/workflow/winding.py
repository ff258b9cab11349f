"""Wind a fitted part and assess what was laid."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property, partial
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from meshwind.chart import Chart
from meshwind.core.defaults import PATHS
from meshwind.core.parsing import AUTO
from meshwind.core.progress import Progress
from meshwind.filament.filament import Filament, filament_of_layers, filaments_of
from meshwind.filament.levels import levels
from meshwind.filament.plain_layer import Band, PlainLayer, plain_layer
from meshwind.layup.layup import Layup, assess
from meshwind.mesh import Mesh
from meshwind.path import Paths, solve
from meshwind.path.friction import Friction, friction_from
from meshwind.planning.families import Families, families
from meshwind.planning.pins import PARAMETRIC, pin_table, read_pins
from meshwind.surface import Surface
from meshwind.workflow.band_plan import about_band, band_plan
from meshwind.workflow.clock import Clock
from meshwind.workflow.covering import Laid, lay_until_covered
from meshwind.workflow.notes import (
    Note,
    about_choice,
    about_contact,
    about_file,
    about_fit,
    about_layup,
    about_opening,
    about_other_rests,
    about_paths,
    about_spacing,
)
from meshwind.workflow.options import Options
from meshwind.workflow.part import Part, on_wound_skin

# what only some windings need, a filament, a laminate or a search for revolutions, is imported by those
if TYPE_CHECKING:
    from meshwind.filament.closing import ClosedLayer
    from meshwind.filament.ends import LayerPlan
    from meshwind.planning.revolutions import Revolutions
    from meshwind.planning.spacing import Spaced
    from meshwind.workflow.helices import Turned
    from meshwind.workflow.layer_plans import LayersFile
    from meshwind.workflow.layers import Layered


@dataclass(frozen=True, repr=False)
class Winding:
    """What every stage made of a part, and what the stages cost: see `meshwind.Result`, which is one with its files."""

    mesh: Mesh
    chart: Chart
    layup: Layup
    options: Options
    command: str
    seconds: dict[str, float]
    notes: tuple[Note, ...] = ()
    chosen: Revolutions | None = None
    spaced: Spaced | None = None
    source: Path | None = None
    closed: ClosedLayer | None = None
    layered: Layered | None = None
    turns: float = 0.0
    plain: PlainLayer = field(default_factory=PlainLayer)

    @cached_property
    def filaments(self) -> tuple[Filament, ...]:
        """The filaments of a continuous winding, over all its layers; none of another."""
        if self.layered is not None:
            return tuple(filament_of_layers(self.layered.laminate))
        return () if self.closed is None else tuple(filaments_of(self.closed))


def wind_part(part: Part, options: Options, command: str, clock: Clock, layers: LayersFile | None = None) -> Winding:
    """Lay the paths on a part that was fitted with the same options, and assess them; then its layers, if any.

    With layers the paths are those of the first helical one.
    """
    part = part.counting(options.threshold)
    surface, units = part.surface, part.source.mesh.units
    layered, about = None, tuple[Note, ...]()
    if layers is not None:
        from meshwind.workflow.layers import first_helical, lay_layers

        with clock.stage("layers"):
            layered, about = lay_layers(surface, layers, options, units, clock.tell)
            options = first_helical(layers.plans, layered, surface, units)
    with clock.stage("fit"):
        notes = (
            *about_file(part.source.mesh),
            *about_opening(part.chart.annulus),
            *about_fit(surface, part.chart, options.tolerance, options.worst_fit, units),
        )
        friction = _friction(part, options)
    chosen = chosen_revolutions(surface, options, clock, friction)
    revolutions = float(options.turns) if chosen is None else chosen.choice
    given, turned = options, None
    if options.angle is not None or options.paths is None:
        with clock.stage("choose"):
            options, turned, more = _planned(surface, options, revolutions, friction, clock.tell)
            notes = (*notes, *more)
        revolutions = float(options.turns)
    notes = (*notes, *about)
    first = None if layered is None else layered.laminate.layers[0].closed
    with clock.stage("wind"):
        closing = options.continuous and layered is None
        plan = _closing(options, revolutions, friction, turned, given.paths is None) if closing else None
        wound = partial(_wound, surface, options, revolutions, friction, (plan, clock.tell))
        if first is not None:
            laid_ = Laid(first.paths, first)
        elif given.paths is None and options.band_width is not None:
            laid_, note = lay_until_covered(wound, _count(options), options.band_width)
            notes = (*notes, note)
        else:
            laid_ = wound(_count(options))
        closed, laid = laid_.closed, laid_.paths
        spaced = _spaced(laid, options, revolutions, friction)
        laid = laid if spaced is None else spaced.paths
        notes = (*notes, *about_paths(laid), *about_choice(chosen), *about_spacing(spaced, units))
        notes = (*notes, *_about_turns(part, laid_, layered, turned))
        notes = (*notes, *about_contact(laid, units), *about_other_rests(laid, units))
    with clock.stage("assess"):
        layup = assess(laid, options.band_width)
        # a laminate has bands of its own
        band = band_plan(options, units) if layers is None else Band(options.band_width, units=units)
        plain = plain_layer(laid, band, layup.coverage.width)
        notes = (*notes, *about_layup(layup), *about_band(band, laid.surface))
    source = part.source
    return Winding(
        source.mesh, part.chart, layup, given, command, clock.seconds, notes, chosen, spaced, source.file,
        closed, layered, revolutions, plain,
    )  # fmt: skip


def _wound(
    surface: Surface,
    options: Options,
    revolutions: float,
    friction: float | Friction,
    close: tuple[LayerPlan | None, Progress],
    paths: int,
) -> Laid:
    """So many paths a family, as one filament if they are to close, and then a few more where the plan lets them."""
    closing, say = close
    if closing is None:
        return Laid(lay(surface, replace(options, paths=paths), revolutions, friction))
    from meshwind.filament.closing import close_layer

    closed = close_layer(surface, replace(closing, paths=paths), say)
    return Laid(closed.paths, closed)


def _spaced(laid: Paths, options: Options, revolutions: float, friction: float | Friction) -> Spaced | None:
    """Paths between those that were laid, where a spacing is to be kept."""
    if options.spacing is None:
        return None
    from meshwind.planning.spacing import space_out

    return space_out(laid, revolutions, options.spacing, friction)


def _about_turns(part: Part, laid: Laid, layered: Layered | None, turned: Turned | None) -> tuple[Note, ...]:
    """Notes on the layers, or on the one layer as a filament."""
    caps, units = part.chart.annulus.caps, part.source.mesh.units
    if layered is not None:
        from meshwind.workflow.layers import about_layers

        return tuple(about_layers(layered, caps, units))
    if laid.closed is None:
        return ()
    from meshwind.workflow.filament_notes import about_filament

    moved = () if turned is None else turned.moved(laid.paths)
    return (*about_filament(laid.closed, caps, units), *moved)


def lay(surface: Surface, options: Options, revolutions: float, friction: float | Friction = 0.0) -> Paths:
    """Lay the paths between their ends: the user's pins, or points spread evenly over the rims."""
    ends = _ends(surface, options, revolutions)
    laid = solve(surface, ends.start, ends.end, family=ends.family, particles=options.particles, friction=friction)
    if laid.asked is None or options.pins is None or pin_table(options.pins).has(PARAMETRIC):
        return laid
    return replace(laid, asked=replace(laid.asked, turns=False))  # pins in space stay where they are


def _planned(
    surface: Surface, options: Options, revolutions: float, friction: float | Friction, say: Progress
) -> tuple[Options, Turned | None, tuple[Note, ...]]:
    """The options with the revolutions of their angle, if any, and with as many paths as cover the part."""
    from meshwind.workflow.helices import Helices

    helices = Helices(surface, (0.0, 1.0), friction, levels(surface), say=say)
    turned, notes = None, []
    if options.paths is not None:
        helices = replace(helices, paths=options.paths)
    if options.angle is not None:
        turned = helices.turned_to(np.radians(options.angle), options.angle_at)
        revolutions = turned.revolutions
        words = turned.shortfall.removeprefix("its ") or turned.taken(options.angle_at)
        notes.append(Note(words, warning=not turned.met))
    paths = options.paths
    if paths is None:
        assert options.band_width is not None
        turns = (options.turn_start, options.turn_end) if options.continuous else (AUTO, AUTO)
        paths = helices.circuits(revolutions, options.band_width, turns)
    options = replace(options, paths=paths, revolutions=revolutions, angle=None, angle_at=None)
    return options, turned, tuple(notes)


def _closing(
    options: Options, revolutions: float, friction: float | Friction, turned: Turned | None, grows: bool
) -> LayerPlan:
    """The plan of the layer as one filament."""
    from meshwind.filament.ends import LayerPlan

    turns = (options.turn_start, options.turn_end)
    clear = 0.0 if options.band_width is None else 0.5 * options.band_width
    return LayerPlan(
        _count(options), revolutions, friction, options.particles, turns, clear,
        grows=grows, angle=None if turned is None else turned.wish,
    )  # fmt: skip


def _count(options: Options) -> int:
    """The paths of a family, which are chosen by now."""
    assert options.paths is not None
    return options.paths


def _ends(surface: Surface, options: Options, revolutions: float) -> Families:
    if options.pins is not None:
        return read_pins(options.pins, surface, revolutions)
    return families(surface, _count(options), revolutions)


def _friction(part: Part, options: Options) -> float | Friction:
    """The coefficient, or the field on the surface."""
    if isinstance(options.friction, float):
        return options.friction
    scalars = part.source.scalars
    if scalars is None:
        return 0.0
    scalars = on_wound_skin(scalars, part.chart.annulus)
    return friction_from(part.surface, scalars.points, scalars.values)


def chosen_revolutions(
    surface: Surface, options: Options, clock: Clock, friction: float | Friction = 0.0, further: bool = True
) -> Revolutions | None:
    """Choose the revolutions where they are "auto"; further as in `choose_revolutions`."""
    if options.turns != AUTO:
        return None
    from meshwind.planning.revolutions import choose_revolutions

    paths, particles = options.paths or PATHS, options.particles
    with clock.stage("choose"):
        return choose_revolutions(
            surface, paths=paths, particles=particles, friction=friction, further=further, progress=clock.tell
        )
