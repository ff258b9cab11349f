"""Wind the layers of a laminate one on another."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.brief import brief
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.core.progress import Progress, silent
from meshwind.filament.closing import close_layer
from meshwind.filament.ends import LayerPlan as ClosingPlan
from meshwind.filament.hoop import HoopPlan, hoop
from meshwind.filament.joins import Tail, strand_of_hoop, strand_of_paths
from meshwind.filament.laminate import LaidLayer, Laminate, Ply, helical_layer, hoop_layer
from meshwind.filament.levels import levels, stretch
from meshwind.filament.offset import TIGHT
from meshwind.filament.spiral import Ground
from meshwind.path import Status
from meshwind.surface import Surface
from meshwind.workflow.covering import Laid, lay_until_covered
from meshwind.workflow.filament_notes import about_filament
from meshwind.workflow.helices import Helices, Settled
from meshwind.workflow.layer_plans import HOOP, LayerPlan, LayersFile
from meshwind.workflow.notes import Note, of_layers
from meshwind.workflow.options import Options

_HANGING = 0.05
"""Share of a layer past the rims that is worth a warning: usual bands have a tenth of it."""


@dataclass(frozen=True)
class Layered:
    """A laminate, its file, the run's options, and what was settled on for the first layer if it is helical."""

    laminate: Laminate
    file: Path
    options: Options
    first: Settled | None = None

    __repr__ = brief


def lay_layers(
    surface: Surface, asked: LayersFile, options: Options, units: str, say: Progress = silent
) -> tuple[Layered, tuple[Note, ...]]:
    """Wind layers on a surface, each on the one below, with notes on what does not hold.

    Raises BadInputError, naming the layer, where one cannot be wound.
    """
    layers: list[LaidLayer] = []
    notes: list[tuple[int, Note]] = []
    plies = []
    first: Settled | None = None
    lines = levels(surface)
    for number, plan in enumerate(asked.plans, 1):
        with _naming(number):
            plies.append(plan.ply(options, units))
            stretch(plan.start, plan.end, lines)  # a mistake in it is told before the layers below are wound
    for number, (plan, ply) in enumerate(zip(asked.plans, plies, strict=True), 1):
        for _ in range(plan.repeat):
            now = f"layer {len(layers) + 1}"
            say(now)
            with _naming(number):
                layer, last = _lay(_Below.of(layers, surface), plan, ply, options, partial(_say_of, say, now))
            first = first if layers else last
            layers.append(layer)
            if last is not None and last.taken:
                notes.append((len(layers), Note(last.taken)))
            notes += [(len(layers), Note(line, warning=True)) for line in _faults(layer)]
    return Layered(Laminate(tuple(layers)), asked.file, options, first), of_layers(notes)


def _say_of(say: Progress, layer: str, words: str) -> None:
    """Say something of a layer."""
    say(f"{layer}, {words}")


@contextmanager
def _naming(number: int) -> Iterator[None]:
    """Name the layer in the message of a BadInputError."""
    try:
        yield
    except BadInputError as error:
        raise BadInputError(f"layer {number}: {error}") from error


def _faults(layer: LaidLayer) -> list[str]:
    """What does not hold of a layer."""
    lines = [layer.shortfall] if layer.shortfall else []
    if layer.strand is not None and layer.strand.slip > layer.friction:
        slip = layer.strand.slip
        needed = f"needs a friction of {slip:.3g}, and has {layer.friction:g}" if np.isfinite(slip) else "lifts off"
        lines.append(
            f"the join that leads to it {needed}: hold it until the layer is on it, or cut before it by cut = true"
        )
    if layer.hoop is not None and (line := layer.hoop.advice(layer.friction)):
        lines.append(line)
    if layer.left_out:
        lines.append(f"{layer.left_out} paths are not at rest and left out of the thickness; give other revolutions")
    hanging = layer.thickness.over_rim / layer.thickness.volume
    if hanging > _HANGING:
        lines.append(
            f"{100.0 * hanging:.2g} % of its bands hang over a rim and count as laid inside of it; give a narrower "
            "band or wider openings"
        )
    if layer.raised.tight:
        u, v = layer.raised.where
        lines.append(
            f"its thickness is {layer.raised.hollow:.2g} of the radius of a hollow at u={u:.3g}, v={v:.3g} "
            f"(more than {TIGHT:g}): the next surface is all but folded there"
        )
    return lines


@dataclass(frozen=True)
class _Below:
    """What a layer lies on: a surface, and where the fibre of the layer before ends, None for the first."""

    surface: Surface
    tail: Tail | None = None

    @classmethod
    def of(cls, layers: list[LaidLayer], part: Surface) -> "_Below":
        if not layers:
            return cls(part)
        last = layers[-1]
        return cls(last.raised.surface, None if last.strand is None else last.strand.tail)


def _lay(below: _Below, plan: LayerPlan, ply: Ply, options: Options, say: Progress) -> tuple[LaidLayer, Settled | None]:
    """Wind one layer on a surface; with what was settled on for it, if it is helical."""
    surface = below.surface
    lines = levels(surface)
    ground = Ground(surface, lines, ply.laying.width)
    between = stretch(plan.start, plan.end, lines)
    tail = None if plan.cut else below.tail
    if plan.kind == HOOP:
        hoops = HoopPlan(*between, ply.laying.width, plan.passes, plan.overlap, plan.stagger)
        if not options.continuous:
            return hoop_layer(surface, hoop(surface, hoops), ply, lines), None
        strand, laid = strand_of_hoop(hoops, tail, ground, ply.friction)
        return hoop_layer(surface, laid, ply, lines, replace(strand, cut=plan.cut)), None
    helices = Helices(surface, between, ply.friction, lines, say=say)
    if isinstance(plan.paths, int):
        helices = replace(helices, paths=plan.paths)
    turns = plan.turns(options) if options.continuous else (AUTO, AUTO)
    settled = helices.settled(plan.angle, plan.revolutions, plan.paths, ply.laying.width, turns)
    if options.continuous:
        closing = ClosingPlan(
            settled.paths, settled.revolutions, ply.friction, options.particles, turns,
            0.5 * ply.laying.width, between, plan.paths == AUTO, settled.wish,
        )  # fmt: skip
    else:
        closing = None

    def lay(count: int) -> Laid:
        if closing is None:
            return Laid(helices.laid(count, settled.revolutions, options.particles))
        closed = close_layer(surface, replace(closing, paths=count), say)
        return Laid(closed.paths, closed)

    wound = lay(settled.paths) if plan.paths != AUTO else lay_until_covered(lay, settled.paths, ply.laying.width)[0]
    paths, closed = wound.paths, wound.closed
    if closed is not None:
        strand = replace(strand_of_paths(closed, tail, ground, ply.friction), cut=plan.cut)
        layer = helical_layer(paths, ply, lines, closed.left_out, strand)
        return replace(layer, shortfall=settled.shortfall), settled
    held = paths.status == Status.CONVERGED
    if not held.any():
        raise BadInputError(f"no path of it comes to rest: {paths.advice(0)}")
    layer = helical_layer(paths.subset(held), ply, lines, int((~held).sum()))
    return replace(layer, shortfall=settled.shortfall), settled


def first_helical(plans: tuple[LayerPlan, ...], layered: Layered, surface: Surface, units: str) -> Options:
    """The options of a run whose paths are those of the first helical layer, as it would lie on the bare part."""
    options = layered.options
    plan = next((plan for plan in plans if plan.kind != HOOP), None)
    if plan is None:
        return options
    ply, settled, lines = plan.ply(options, units), layered.first, levels(surface)
    if settled is None or stretch(plan.start, plan.end, lines) != (0.0, 1.0):
        settled = Helices(surface, (0.0, 1.0), ply.friction, lines).settled(
            plan.angle, plan.revolutions, plan.paths, ply.laying.width, plan.turns(options)
        )
    return replace(
        options, paths=settled.paths, revolutions=settled.revolutions, friction=ply.friction,
        band_width=ply.laying.width,
    )  # fmt: skip


def about_layers(layered: Layered, caps: tuple[bool, bool], units: str) -> tuple[Note, ...]:
    """Notes on how the layers of one filament close and turn; caps: which ends of the part are closed."""
    each = [
        (number, note)
        for number, layer in enumerate(layered.laminate.layers, 1)
        if layer.closed is not None
        for note in about_filament(layer.closed, caps, units)
    ]
    notes = list(of_layers(each))
    joins = [layer.strand.join for layer in layered.laminate.layers if layer.strand and layer.strand.join]
    if joins:
        length = quantity(sum(float(each.arc_length[-1]) for each in joins), units, 3)
        notes.append(Note(f"joins between layers, {length} of fibre, are in no layer's thickness"))
    return tuple(dict.fromkeys(notes))
