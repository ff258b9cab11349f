"""A layer that turns on caps: at one end or both the fibre touches the opening and comes back, with no dwell."""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from meshwind.core.cast import frozen
from meshwind.core.defaults import PARTICLES
from meshwind.filament.edge import Edge, edge
from meshwind.filament.ends import CAP, End, LayerPlan, choose_end
from meshwind.filament.joining import Joining
from meshwind.filament.polar import PolarPasses, passes_between_caps, passes_over_a_cap
from meshwind.path.friction import friction_of
from meshwind.surface.surface import Surface


@dataclass
class Cap:
    """The cap of a closed end.

    Parameters
    ----------
    surface : Surface
        Surface of the part.
    end : int
        0 at its start, 1 at its end.
    slip : float
        Largest slip of the half-legs that lead over it.
    """

    surface: Surface
    end: int
    slip: float
    name: str = field(default=CAP, init=False)
    rule: str = field(default="by the local rule: |kg| at most friction times kn, and kn above 0", init=False)
    reach: float = field(default=0.0, init=False)

    @cached_property
    def edge(self) -> Edge:
        """The prism on its opening, which only a fibre reaches that joins another layer."""
        return edge(self.surface, self.end)


def passes_on_caps(surface: Surface, plan: LayerPlan) -> PolarPasses:
    """The passes of a layer, of which one end or both turn on a cap."""
    friction = friction_of(surface, plan.friction).smallest
    particles = PARTICLES if plan.particles is None else plan.particles
    if plan.turns == (CAP, CAP):
        clear = (plan.clearance, plan.clearance)
        return passes_between_caps(surface, plan.paths, clearance=clear, friction=friction, particles=particles)
    return passes_over_a_cap(
        surface, plan.paths, cap="start" if plan.turns[0] == CAP else "end", clearance=plan.clearance,
        friction=friction, particles=particles,
    )  # fmt: skip


def ends_with_caps(surface: Surface, plan: LayerPlan, laid: PolarPasses) -> list[End | Cap]:
    """The turnarounds at both ends: caps, or what suits a rim."""
    worst = np.abs(laid.slip).max(axis=0)
    return [
        Cap(surface, end, float(worst[end])) if word == CAP else choose_end(surface, end, plan, word, laid.paths)
        for end, word in enumerate(plan.turns)
    ]


def joined_on_caps(laid: PolarPasses) -> Joining:
    """The joining of a layer between two caps: each pass starts where the one before ends."""
    assert laid.pattern is not None
    count = laid.pattern.circuits
    each, none = np.arange(count), np.zeros(count)
    return Joining(frozen(each), frozen(np.roll(each, -1)), frozen(none), frozen(none), laid.pattern.turns)
