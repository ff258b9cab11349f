"""Wind the layers of a laminate one on another."""

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.filament.hoop import HoopPlan
from meshwind.filament.laminate import LaidLayer, Laminate, Ply, helical_layer, hoop_layer
from meshwind.filament.levels import levels, station
from meshwind.filament.offset import TIGHT
from meshwind.path import Status
from meshwind.surface import Surface
from meshwind.workflow.helices import Helices
from meshwind.workflow.layer_plans import HOOP, LayerPlan, LayersFile
from meshwind.workflow.notes import Note
from meshwind.workflow.options import Options

_HANGING = 0.05
"""Share of a layer past the rims that is worth a warning: usual bands have a tenth of it."""


@dataclass(frozen=True)
class Layered:
    """A laminate, its file, and the options that the run was given."""

    laminate: Laminate
    file: Path
    options: Options


def lay_layers(surface: Surface, asked: LayersFile, options: Options, units: str) -> tuple[Layered, tuple[Note, ...]]:
    """Wind layers on a surface, each on the one below, with notes on what does not hold.

    Raises BadInputError, naming the layer, where one cannot be wound.
    """
    layers: list[LaidLayer] = []
    notes: list[Note] = []
    plies = []
    for number, plan in enumerate(asked.plans, 1):
        with _naming(number):
            plies.append(plan.ply(options, units))
    for number, (plan, ply) in enumerate(zip(asked.plans, plies, strict=True), 1):
        for _ in range(plan.repeat):
            below = layers[-1].raised.surface if layers else surface
            with _naming(number):
                layer = _lay(below, plan, ply, options)
            notes += [Note(f"layer {number}: {line}", warning=True) for line in _faults(layer)]
            layers.append(layer)
    return Layered(Laminate(tuple(layers)), asked.file, options), tuple(dict.fromkeys(notes))


@contextmanager
def _naming(number: int) -> Iterator[None]:
    """Name the layer in the message of a BadInputError."""
    try:
        yield
    except BadInputError as error:
        raise BadInputError(f"layer {number}: {error}") from error


def _faults(layer: LaidLayer) -> list[str]:
    """What does not hold of a layer."""
    lines: list[str] = []
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


def _lay(surface: Surface, plan: LayerPlan, ply: Ply, options: Options) -> LaidLayer:
    """Wind one layer on a surface."""
    lines = levels(surface)
    between = station(plan.start, lines), station(plan.end, lines)
    if plan.kind == HOOP:
        hoops = HoopPlan(*between, ply.laying.width, plan.passes, plan.overlap, plan.stagger)
        return hoop_layer(surface, hoops, ply, lines)
    if not between[0] < between[1]:
        raise BadInputError(f"it starts at v={between[0]:g} and ends at v={between[1]:g}; give its places in order")
    helices = Helices(surface, between, ply.friction, lines)
    paths = helices.laid(
        *helices.settled(plan.angle, plan.revolutions, plan.paths, ply.laying.width), options.particles
    )
    held = paths.status == Status.CONVERGED
    if not held.any():
        raise BadInputError(f"no path of it comes to rest: {paths.advice(0)}")
    return helical_layer(paths.subset(held), ply, lines, int((~held).sum()))


def first_helical(plans: tuple[LayerPlan, ...], surface: Surface, options: Options, units: str) -> Options:
    """The options of a run whose paths are those of the first helical layer, as it would lie on the bare part."""
    plan = next((plan for plan in plans if plan.kind != HOOP), None)
    if plan is None:
        return options
    ply = plan.ply(options, units)
    paths, turns = Helices(surface, (0.0, 1.0), ply.friction, levels(surface)).settled(
        plan.angle, plan.revolutions, plan.paths, ply.laying.width
    )
    return replace(options, paths=paths, revolutions=turns, friction=ply.friction, band_width=ply.laying.width)
