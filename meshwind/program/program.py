"""A program from the filaments of a run: eye, blocks, time and what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block, Geometric
from meshwind.core.spoken import argument
from meshwind.core.table import data_frame
from meshwind.program.axes import limits_of, timing_of
from meshwind.program.blocks import TRAVEL, Blocks, columns
from meshwind.program.body import Body, body_round
from meshwind.program.clear import Shaft
from meshwind.program.eye import LONGEST, Poses, Solver, Spans, at_radius, on_body
from meshwind.program.faults import EYE, SPAN, Fault, collisions, unreachable
from meshwind.program.head import frames, head_of, within
from meshwind.program.hollows import in_hollows
from meshwind.program.machine import Machine
from meshwind.program.mandrel import Mandrel, mandrel_of
from meshwind.program.stepping import Steps, smooth, stepped
from meshwind.program.track import Track, track
from meshwind.program.travel import in_a_row
from meshwind.program.work import Work

if TYPE_CHECKING:
    import pandas

CLEARANCE = 0.05
"""Distance of the eye from part and shaft, over the part's diagonal, where the machine's file gives none."""
TURN, ROLL, MOVE = 5.0, 10.0, 10.0
"""Longest steps between blocks: degrees of the mandrel, degrees of roll and yaw, mm of the eye."""
_SMALL = 0.05
"""Longest step of the eye over the part's diagonal, for parts that are smaller than the step in mm is made for."""
_LIFT, _PAST = 0.1, 1.1
"""How far the eye keeps off the part where it runs out along a bridge, over the clearance, and over its own radius."""
_FARTHEST = 20.0
"""Clearance, shaft and eye radius over the part's diagonal above which spans would take blocks without end."""
_LONGER = 3.0
"""Clearance that is tried where the eye comes too near, over that which is wanted."""


@dataclass(frozen=True)
class Program(Geometric):
    """A program.

    Attributes
    ----------
    work : Work
        What it winds.
    machine : Machine
        The machine that it is for.
    mandrel : Mandrel
        The axis on which the part turns.
    body : Body
        What the eye keeps out of, in coordinates along the axis and from it.
    clearance : float
        Distance that the body keeps from part and turnarounds, in the mesh's units.
    nearest : float
        Least distance of the eye from the part: less than the clearance only where it goes into hollows.  Below 0 if
        the eye is inside of it, or of the shaft, anywhere; no remedy is taken that leads there.
    blocks : Blocks
        Its blocks.
    tracks : tuple of Track
        The fibre that they lay, a track a filament.
    radius : float or None
        Where the eye stays from the axis if it has no cross-feed, in the mesh's units.
    faults : tuple of Fault
        What is wrong with it, by block.
    losses : dict of str to float
        By what an axis moves that the machine lacks: the largest distance, in mm, or angle, in degrees, that is lost.
    limits : dict of str to float
        Seconds in which each axis, or the fibre's speed, is what limits.
    limiting : ndarray of int, shape (n - 1,)
        What limits the way to each of the n blocks but the first: its number among `limits`.
    remedies : tuple of str
        What was tried against faults, and what came of it.
    backwards : bool
        Whether each filament is wound from its end to its start.
    """

    work: Work
    machine: Machine
    mandrel: Mandrel
    body: Body
    clearance: float
    nearest: float
    blocks: Blocks
    tracks: tuple[Track, ...]
    radius: float | None
    faults: tuple[Fault, ...]
    losses: dict[str, float]
    limits: dict[str, float]
    limiting: Ints
    remedies: tuple[str, ...] = ()
    backwards: bool = False

    __repr__ = brief

    @property
    def block(self) -> Block:
        """The way of the eye as a polyline, with the columns of program.csv for each block."""
        data = {name: values for name, values in columns(self.blocks).items() if name not in ("x", "y", "z")}
        return Block(self.eyes, np.array([0, len(self.blocks)]), point_data=data)

    def to_dataframe(self) -> pandas.DataFrame:
        """The blocks as a table for pandas, a row each, with the columns of program.csv."""
        return data_frame(columns(self.blocks))

    @property
    def eyes(self) -> Floats:
        """The eye (n, 3) in the blocks, as the machine holds it, in the mesh's coordinates."""
        return stands(self.blocks, self.mandrel, self.radius)

    @property
    def seconds(self) -> float:
        """Its duration."""
        return float(self.blocks.time[-1])

    @property
    def seconds_of_layers(self) -> list[float]:
        """Duration of each layer; that of a join counts for the layer that it leads to."""
        step = np.diff(self.blocks.time, prepend=0.0)
        return [float(each) for each in np.bincount(self.blocks.layer, step, self.work.layers)]


@dataclass(frozen=True)
class Way:
    """How a program is wound: its clearance in the mesh's units, and whether from each filament's end.

    shorter: whether the eye goes into hollows, with a shorter span, where a span would meet the part beyond them.
    """

    clearance: float
    backwards: bool = False
    shorter: bool = False


def program(work: Work, machine: Machine, tension: float = 0.0) -> Program:
    """The program of a machine for what is to be wound.

    Where span or eye meet the part, the other direction of travel and a longer span are tried; what is left is in
    `faults`.

    Parameters
    ----------
    work : Work
        What is to be wound.
    machine : Machine
        The machine.
    tension : float, default 0
        Tension of the fibre in N; 0 if none is set.

    Returns
    -------
    Program
        The program.
    """
    if not (np.isfinite(tension) and tension >= 0.0):
        raise BadInputError(f"tension is {tension}; give a number of newtons of at least 0")
    for name in ("clearance", "eye_radius", "shaft"):
        value = getattr(machine, name)
        if value is not None and value > _FARTHEST * work.diagonal * work.scale:
            raise BadInputError(
                f"{name} of {machine.name} is {value:g} mm, and the diagonal of the part is only "
                f"{work.diagonal * work.scale:.4g} mm; give less, or wind with other {argument('units')}"
            )
    share = CLEARANCE * work.diagonal
    way = Way(share if machine.clearance is None else machine.clearance / work.scale)
    best = _wound(work, machine, way)
    tried: list[str] = []
    for wanted, words, change in (
        (SPAN, "the other direction of travel", {"backwards": True} if work.turnable else {}),
        (SPAN, "shorter spans in hollows", {"shorter": True} if machine.axis("cross") is not None else {}),
        (EYE, "a longer span", {"clearance": _LONGER * way.clearance}),
    ):
        hits = sum(fault.kind == wanted for fault in best.faults)
        if not hits or not change:
            continue
        other = replace(way, **change)  # type: ignore[arg-type]
        another = _wound(work, machine, other)
        # a shaft that is thicker than the part at its ends may hold the eye in any case
        lowest = 0.0 if "shorter" in change else min(best.nearest, 0.0)
        left = sum(fault.kind == wanted for fault in another.faults)
        better = len(another.faults) < len(best.faults) and another.nearest >= lowest
        better &= not other.shorter or smooth(another.blocks, _steps(work), _SMALL * work.diagonal)
        still = f"{left} of {hits} blocks still meet" if left <= hits else f"{left} blocks meet, not {hits},"
        tried.append(f"{words}: {still} the part; {'taken' if better else 'not taken'}")
        best, way = (another, other) if better else (best, way)
    blocks = replace(best.blocks, tension=frozen(np.where(best.blocks.kind == TRAVEL, 0.0, tension)))
    return replace(best, blocks=blocks, remedies=tuple(tried))


def _wound(work: Work, machine: Machine, way: Way) -> Program:
    """The program that winds in one way."""
    points = np.concatenate([each.course.points[:: -1 if way.backwards else 1] for each in work.filaments])
    mandrel = mandrel_of(work.surface, points)
    scale = work.scale
    shaft = machine.shaft / scale
    body = _body(work, mandrel, points, (shaft, way.clearance))
    blocked = work.blocked(mandrel, Shaft(shaft, (float(body.x[0]), float(body.x[-1]))))
    spans, radius = _spans(machine, body, work)
    head = head_of(machine, scale)
    if way.shorter:
        lift = max(_LIFT * way.clearance, 0.0 if head is None else _PAST * head.radius)
        spans = in_hollows(spans, blocked, mandrel, way.clearance, lift)
    steps = _steps(work)
    parts, laid, turned = [], 0.0, -np.inf
    tracks = tuple(track(filament, way.backwards) for filament in work.filaments)
    for on in tracks:
        found = stepped(on, Solver(on, mandrel, spans), steps)
        part = _blocks(on, found, mandrel, laid, turned)
        laid, turned = float(part.arc_length[-1]), float(part.mandrel[-1])
        parts.append(part)
    blocks = in_a_row(parts, mandrel, body if radius is None else None, steps)
    timing = timing_of(blocks, machine, scale)
    blocks = replace(blocks, time=frozen(np.concatenate([[0.0], np.cumsum(timing.seconds)])))
    names = limits_of(machine).names
    eyes = stands(blocks, mandrel, radius)
    nearest = float(blocked.surface.distances(frozen(eyes)).min())
    if within(blocked.surface, eyes, mandrel.towards(blocks.mandrel)).any():
        nearest = -nearest
    faults = (
        *collisions(blocks, eyes, blocked, head, frames(blocks, mandrel, machine)),
        *unreachable(blocks, machine, scale),
    )
    return Program(
        work, machine, mandrel, body, way.clearance, nearest, blocks, tracks, radius, tuple(sorted(faults)),
        _losses(blocks, machine, radius, scale),
        {name: float(timing.seconds[timing.limit == k].sum()) for k, name in enumerate(names)},
        frozen(timing.limit), backwards=way.backwards,
    )  # fmt: skip


def _body(work: Work, mandrel: Mandrel, points: Floats, keeps: tuple[float, float]) -> Body:
    """The body round the part, its turnarounds and a shaft; keeps: the shaft's radius, and the clearance."""
    inside = mandrel.inside(np.concatenate([work.skin.points, points]))
    return body_round(inside[:, 0], np.maximum(np.hypot(inside[:, 1], inside[:, 2]), keeps[0]), keeps[1])


def _spans(machine: Machine, body: Body, work: Work) -> tuple[Spans, float | None]:
    """The free spans of a machine, and the radius at which its eye stays if it has no cross-feed."""
    if machine.axis("cross") is not None:
        return on_body(body), None
    radius = body.radius if machine.eye_radius is None else machine.eye_radius / work.scale
    if radius < body.radius - 1e-9 * body.size:
        raise BadInputError(
            f"the eye of {machine.name} stays {radius * work.scale:.6g} mm from the axis, but the part "
            f"with its clearance needs {body.radius * work.scale:.6g} mm; give a larger eye_radius, or a "
            "smaller clearance"
        )
    return at_radius(radius, LONGEST * body.size), radius


def _blocks(on: Track, found: Poses, mandrel: Mandrel, laid: float, turned: float) -> Blocks:
    """Blocks at poses on a track, not timed yet; they go on from a length laid and an angle of the mandrel."""
    index, share = on.piece(found.at)
    told = np.where(share == 0.0, np.maximum(index - 1, 0), index)  # what a block has done, not what the next will
    normal = on.normals[index, 0] + share[:, None] * (on.normals[index, 1] - on.normals[index, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)
    slip = on.slip[index, 0] + share * (on.slip[index, 1] - on.slip[index, 0])
    angle = np.degrees(found.mandrel)
    # filaments follow one another without turning back: whole turns are added
    first = float(np.mod(angle[0], 360.0)) if turned == -np.inf else float(angle[0])
    whole_turns = 0.0 if turned == -np.inf else 360.0 * np.ceil((turned - first) / 360.0)
    angle = angle - angle[0] + first + whole_turns
    contact, tangent = on.contact(found.at)[0], found.tangent @ mandrel.frame
    n = len(found)
    return Blocks(
        layer=frozen(on.layer[told]), circuit=frozen(on.circuit[told]), passed=frozen(on.passed[told]),
        path=frozen(on.path[told]), kind=frozen(on.kind[told]), arc_length=frozen(laid + found.laid),
        point=frozen(contact), tangent=frozen(tangent), normal=frozen(normal), free_length=frozen(found.span),
        eye_x=frozen(found.x), eye_r=frozen(found.r), mandrel=frozen(angle), roll=frozen(np.degrees(found.roll)),
        yaw=frozen(np.degrees(found.yaw)), time=frozen(np.zeros(n)), tension=frozen(np.zeros(n)), slip=frozen(slip),
    )  # fmt: skip


def stands(blocks: Blocks, mandrel: Mandrel, radius: float | None) -> Floats:
    """The eye (n, 3) as a machine holds it: on the fibre's line, or at its own radius if it has no cross-feed."""
    if radius is None:
        return blocks.eye
    return mandrel.eye(blocks.eye_x, np.where(blocks.kind == TRAVEL, blocks.eye_r, radius), blocks.mandrel)


def _steps(work: Work) -> Steps:
    """The longest steps between blocks."""
    length = min(MOVE / work.scale, _SMALL * work.diagonal)
    return Steps(np.radians(TURN), np.radians(ROLL), np.radians(ROLL), length, length, length)


def _losses(blocks: Blocks, machine: Machine, radius: float | None, scale: float) -> dict[str, float]:
    """What a machine cannot follow for want of axes."""
    losses = {}
    if radius is not None:
        losses["cross"] = float(scale * np.abs(blocks.eye_r - radius).max())
    for moves in ("roll", "yaw"):
        if machine.axis(moves) is None:
            angle = getattr(blocks, moves)
            losses[moves] = float(np.abs(angle - 180.0 * np.round(angle / 180.0)).max())
    return losses
