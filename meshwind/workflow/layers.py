"""Wind the layers of a laminate one on another."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.filament.hoop import HoopPlan
from meshwind.filament.laminate import LaidLayer, Laminate, Ply, helical_layer, hoop_layer
from meshwind.filament.levels import Levels, levels, station
from meshwind.filament.offset import TIGHT
from meshwind.filament.stations import angles_at, circuits_to_cover
from meshwind.path import Paths, Status, solve
from meshwind.planning.families import families
from meshwind.surface import Surface
from meshwind.workflow.layer_plans import HOOP, LayerPlan, LayersFile
from meshwind.workflow.notes import Note
from meshwind.workflow.options import Options

_TRIAL_PATHS, _TRIAL_PARTICLES = 6, 101
"""Paths a family, and their particles, with which the revolutions for an angle and the number of paths are found."""
_TRIALS = 30
"""Trials for an angle; each brings it nearer by a factor of about ten on smooth parts."""
_HANGING = 0.05
"""Share of a layer past the rims that is worth a warning: usual bands have a tenth of it."""
_NEAR = np.radians(0.05)
"""How near an angle is met."""


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
    plies = [_named(number, plan.ply, options, units) for number, plan in enumerate(asked.plans, 1)]
    for number, (plan, ply) in enumerate(zip(asked.plans, plies, strict=True), 1):
        for _ in range(plan.repeat):
            below = layers[-1].raised.surface if layers else surface
            layer = _named(number, _lay, below, plan, ply, options)
            notes += [Note(f"layer {number}: {line}", warning=True) for line in _faults(layer)]
            layers.append(layer)
    return Layered(Laminate(tuple(layers)), asked.file, options), tuple(dict.fromkeys(notes))


def _named(number, call, *arguments):  # type: ignore[no-untyped-def]
    """What a call gives; the message of its BadInputError names the layer."""
    try:
        return call(*arguments)
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
        return hoop_layer(surface, hoops, ply)
    if not between[0] < between[1]:
        raise BadInputError(f"it starts at v={between[0]:g} and ends at v={between[1]:g}; give its places in order")
    helices = _Helices(surface, between, ply.friction, lines)
    paths = helices.laid(*helices.settled(plan, ply.laying.width), options.particles)
    held = paths.status == Status.CONVERGED
    if not held.any():
        raise BadInputError(f"no path of it comes to rest: {paths.advice(0)}")
    return helical_layer(paths.subset(held), ply, int((~held).sum()))


@dataclass(frozen=True)
class _Helices:
    """The helical paths of a layer, laid with any number of them a family and any revolutions."""

    surface: Surface
    between: tuple[float, float]
    friction: float
    lines: Levels

    def laid(self, paths: int, revolutions: float, particles: int | None) -> Paths:
        """Lay both families."""
        ends = families(self.surface, paths, revolutions, between=self.between)
        friction = self.friction
        return solve(self.surface, ends.start, ends.end, family=ends.family, particles=particles, friction=friction)

    def tried(self, revolutions: float) -> Paths | None:
        """Some paths, or None where none of them comes to rest."""
        paths = self.laid(_TRIAL_PATHS, revolutions, _TRIAL_PARTICLES)
        held = paths.status == Status.CONVERGED
        return paths.subset(held) if held.any() else None

    def settled(self, plan: LayerPlan, width: float) -> tuple[int, float]:
        """Paths a family and revolutions of a plan with a band of this width."""
        revolutions = plan.revolutions
        if plan.angle is not None:
            revolutions = self.revolutions_at(np.radians(plan.angle))
        assert isinstance(revolutions, float)
        if plan.paths != AUTO:
            return int(plan.paths), revolutions
        trial = self.tried(revolutions)
        if trial is None:
            raise BadInputError(f"no path comes to rest at {revolutions:.4g} revolutions; give fewer, or more friction")
        return circuits_to_cover(trial, self.lines, width), revolutions

    def revolutions_at(self, angle: float) -> float:
        """Revolutions at which the median winding angle at the widest place of the layer is as wanted."""
        lines, (low, high) = self.lines, self.between
        inside = (lines.v >= low) & (lines.v <= high)
        inside |= np.abs(lines.v - 0.5 * (low + high)) <= 1.0 / len(lines.v)
        widest = np.array([lines.v[inside][int(np.argmax(lines.length[inside]))]])
        along = float(np.interp(high, lines.v, lines.mean) - np.interp(low, lines.v, lines.mean))
        turns = np.tan(angle) * along / float(lines.length[inside].mean())
        held, lost, reached = 0.0, np.inf, 0.0
        for _ in range(_TRIALS):
            trial = self.tried(float(turns))
            if trial is None:
                lost = min(lost, turns)
                turns = 0.5 * (held + lost)
                continue
            held, reached = float(turns), float(np.nanmedian(angles_at(trial, widest)))
            if abs(reached - angle) <= _NEAR:
                return held
            turns = held * np.clip(np.tan(angle) / max(np.tan(reached), _NEAR), 0.5, 2.0)
            turns = turns if turns < lost else 0.5 * (held + lost)
        raise BadInputError(
            f"its angle of {np.degrees(angle):g} degrees is not met: {np.degrees(reached):.2f} at {held:.4g} "
            f"revolutions{f', and past {lost:.4g} no path comes to rest' if np.isfinite(lost) else ''}; give another "
            "angle, or more friction"
        )


def first_helical(plans: tuple[LayerPlan, ...], surface: Surface, options: Options, units: str) -> Options:
    """The options of a run whose paths are those of the first helical layer, as it would lie on the bare part."""
    plan = next((plan for plan in plans if plan.kind != HOOP), None)
    if plan is None:
        return options
    ply = plan.ply(options, units)
    paths, turns = _Helices(surface, (0.0, 1.0), ply.friction, levels(surface)).settled(plan, ply.laying.width)
    return replace(options, paths=paths, revolutions=turns, friction=ply.friction, band_width=ply.laying.width)
