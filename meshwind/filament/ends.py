"""The two ends of a layer: which turnaround suits each, and how long the dwell there must be."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.defaults import PARTICLES
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import AUTO
from meshwind.filament.collar_turn import Collar
from meshwind.filament.edge import Edge, Legs, edge
from meshwind.filament.joining import Surplus
from meshwind.filament.lift import legs_of_all, lifts
from meshwind.filament.part_edge import part_edge
from meshwind.filament.part_turn import Bend
from meshwind.filament.pin_turn import Pins, Shaft
from meshwind.filament.turnaround import Turnaround
from meshwind.path import Paths
from meshwind.path.friction import Friction, friction_of
from meshwind.surface.rims import Rim, rim
from meshwind.surface.surface import Surface

CAP = "cap"
"""The turnaround on a closed end, whose passes are marched."""
_SETTLED = 60
"""Rounds in which the least dwell is found."""
ROOM = 1e-6
"""Turns of dwell beyond the least, so that round-off does not cost a place."""
_PIN_WIDE, _PIN_HIGH = 1 / 6, 1 / 2
"""Radius of a pin, and height of its middle over the rim, over the distance of the paths along the rim, ..."""
_PIN_HIGHER = 3 / 4
"""... and the height where the prism stands up from the part, over which a span swings as it turns round its pin."""
_SHAFT = 0.5
"""Radius of a shaft over the least distance of the hull from its axis."""
_LONGEST_DWELL = 20.0
"""Turns that a turnaround may take: the fibre of a longer one would be most of the layer."""
_LONGEST_COLLAR = 1.0
"""Collar over the rim's mean diameter, above which pins are taken instead."""


class Wish(NamedTuple):
    """The winding angle that a layer is to have: the median over its paths on the level line v, in radians."""

    v: float
    wanted: float


@dataclass(frozen=True)
class LayerPlan:
    """What a closed layer is to be.

    Parameters
    ----------
    paths : int
        Paths per family: circuits of the layer.
    revolutions : float
        Turns of a path from end to end; moved to where the layer closes.
    friction : float or Friction, default 0
        Coefficient of friction, as for `solve`.
    particles : int or None, default 401
        Particles per path.
    turns : tuple of str, default ("auto", "auto")
        Turnarounds at the start and at the end: "collar", "pins", "shaft", "cap" or "auto".  On a cap the angle follows
        from the opening, so that the revolutions are not kept.
    clearance : float, default 0
        Distance at which fibres pass the opening of a cap, in the surface's units.
    between : tuple of float, default (0, 1)
        The v of the lines that the paths start and end on.  Within the part they turn beyond these lines, on the part.
    grows : bool, default False
        Whether there may be a few paths more where they close nearer to the revolutions.
    angle : Wish or None, default None
        The angle that the revolutions are for, and are moved for as well; not on caps.
    """

    paths: int
    revolutions: float
    friction: float | Friction = 0.0
    particles: int | None = PARTICLES
    turns: tuple[str, str] = (AUTO, AUTO)
    clearance: float = 0.0
    between: tuple[float, float] = (0.0, 1.0)
    grows: bool = False
    angle: Wish | None = None


@dataclass(frozen=True)
class End:
    """One end: the edge, what turns there, and its rim, in shares of which ends are spread."""

    surface: Surface
    v: float
    edge: Edge
    turnaround: Turnaround

    def shares(self, paths: Paths, family: int) -> Floats:
        """Shares of the rim's length, unwrapped, at which the paths of a family cross it."""
        u = paths.uv[paths.family == family, -self.edge.end, 0]
        return self._rim.shares(u)

    @cached_property
    def _rim(self) -> Rim:
        return rim(self.surface, self.v)

    def pairs(self, paths: Paths) -> "Pairs":
        """The legs that arrive and those that leave."""
        families_ = (1, -1) if self.edge.end else (-1, 1)
        into, out = legs_of_all(self.turnaround, paths, families_)
        if np.isinf(into.height).any() or np.isinf(out.height).any():
            raise BadInputError(
                f"the turnaround at the {'end' if self.edge.end else 'start'} ({self.turnaround.name}) stands up from "
                "the part, and fibres that aim at its axis slide up on it without end; give pins or a shaft there"
            )
        at, off = (self.shares(paths, family) for family in families_)
        return Pairs(self, into, out, at, off)


@dataclass(frozen=True)
class Pairs:
    """At one end: legs that arrive and leave (N,), and the shares (N,) of the rim where they do."""

    end: End
    arriving: Legs
    leaving: Legs
    at: Floats
    off: Floats

    def later(self, into: Ints, out: Ints, dwell: Floats) -> Floats:
        """Lengths (n,) along the hull at which legs `out` leave, a dwell (n,) of the rim after legs `into` came."""
        turns = np.round(self.at[into] + dwell - self.off[out])
        return np.asarray(self.leaving.around[out] + turns * self.end.edge.hull.perimeter)

    @property
    def _other(self) -> str:
        """What to give instead of a turnaround that takes too long."""
        if self.end.turnaround.name == "collar":
            return "give pins or a shaft, more friction, or a larger angle"
        return "fibres come to it nearly as hoops: give fewer revolutions, or open the part further inside"

    @property
    def surplus(self) -> Surplus:
        """What each dwell has to spare."""
        return lambda into, out, dwell: self.end.turnaround.surplus(
            self.arriving.chosen(into), self.leaving.chosen(out), self.later(into, out, dwell)
        )

    def least_dwell(self) -> float:
        """Least dwell with which every arriving leg has room to a leg that leaves at just that dwell.

        Legs that leave are taken from those that do, as periodic functions of where.
        """
        edge_ = self.end.edge
        order = np.argsort(np.mod(self.off, 1.0))
        place = np.mod(self.off, 1.0)[order]
        perimeter = edge_.hull.perimeter

        def between(values: Floats, share: Floats) -> Floats:
            return np.asarray(np.interp(share, place, values[order], period=1.0))

        ahead = self.leaving.around - perimeter * self.off
        dwell = 0.0
        for _ in range(_SETTLED):
            share = self.at + dwell
            later = perimeter * share + between(ahead, share)
            leave = Legs(later, between(self.leaving.height, share), between(self.leaving.angle, share),
                         self.leaving.points, -1)  # fmt: skip
            short = -float(self.end.turnaround.surplus(self.arriving, leave, later).min())
            if short <= ROOM:
                break
            dwell += short
            if not dwell < _LONGEST_DWELL:
                raise BadInputError(
                    f"the turnaround at the {'end' if edge_.end else 'start'} ({self.end.turnaround.name}) would take "
                    f"more than {_LONGEST_DWELL:g} turns; {self._other}"
                )
        return dwell + 2.0 * ROOM


def choose_end(surface: Surface, end: int, plan: LayerPlan, word: str, scouts: Paths) -> End:
    """An end, 0 or 1, with the turnaround that was asked for, or that suits it."""
    v, held = plan.between[end], friction_of(surface, plan.friction)
    if 0.0 < v < 1.0:
        return _within(surface, end, v, word, held.smallest)
    on = edge(surface, v)
    friction = float(held.table[:, -end].min())
    pitch = on.hull.perimeter / plan.paths
    pins = Pins(on, _PIN_HIGH * pitch, _PIN_WIDE * pitch, pitch)
    if lifts(on, scouts):
        pins = replace(pins, height=_PIN_HIGHER * pitch)
    if word == "pins":
        return End(surface, v, on, pins)
    if word == "shaft":
        least = float(np.linalg.norm(on.hull.points, axis=1).min())
        return End(surface, v, on, Shaft(on, pins.height, _SHAFT * least))
    if word == "collar" and not friction > 0.0:
        raise BadInputError("a collar holds no fibre without friction; give friction, or pins or a shaft for this end")
    if friction > 0.0:
        collar = Collar(on, friction)
        if word == "collar" or _top(collar, scouts) <= _LONGEST_COLLAR * on.hull.perimeter / np.pi:
            return End(surface, v, on, collar)
    return End(surface, v, on, pins)


def _top(collar: Collar, scouts: Paths) -> float:
    """Height over the rim up to which a collar must reach; infinite where no collar is long enough."""
    each = legs_of_all(collar, scouts)
    if any(np.isinf(legs.height).any() for legs in each):
        return np.inf
    tops = [collar.reached(legs, np.zeros(len(legs)))[1].max() for legs in each]
    return float(max(tops)) - collar.edge.highest


def _within(surface: Surface, end: int, v: float, word: str, friction: float) -> End:
    """The end of a layer within the part."""
    if word not in (AUTO, "collar"):
        raise BadInputError(
            f"{word} stands at a rim, and the layer ends at v={v:.3g}; leave {word} out, or let it end at the rim"
        )
    if not friction > 0.0:
        raise BadInputError(
            f"a layer that ends at v={v:.3g} turns on the part, which takes friction; give friction, or let it end at "
            "the rims"
        )
    on = part_edge(surface, v, end)
    return End(surface, v, on, Bend(on, friction))
