"""A hoop layer: turns one band apart along the part, there and back between two stations, with a half turn between."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.checks import whole
from meshwind.core.errors import BadInputError
from meshwind.core.vectors import TINY
from meshwind.filament.bend import bend
from meshwind.filament.course import Course, Kind
from meshwind.filament.levels import Levels, level_at, levels
from meshwind.filament.thickness import Tracks
from meshwind.surface.surface import Surface

_PER_SPAN, _FEWEST = 4, 120
"""Points of the fibre for each span around the part, and at least in a turn."""
_MOST_POINTS = 2_000_000
"""Points that a hoop layer may take."""
_WAIT = 0.5
"""Turns at a constant v between two passes: half a turn, so that the next one starts on the far side."""


@dataclass(frozen=True)
class HoopPlan:
    """A hoop layer that is asked for.

    Parameters
    ----------
    start, end : float
        v of the two lines between which the band stays, edges included, start < end.
    width : float
        Width of the band, in the surface's units.
    passes : int, default 1
        Times that it goes from one line to the other: 2 for there and back.
    overlap : float, default 0
        Share of the band that the next turn lies on, at least 0 and below 1.
    stagger : float, default 0
        By how much each pass ends before the one before, in the surface's units, so that the ends make no step.
    from_end : bool, default False
        Whether the first pass goes from the end line to the start line.
    u : float, default 0
        Where it begins, in turns.

    Raises
    ------
    BadInputError
        If a number is out of range.
    """

    start: float
    end: float
    width: float
    passes: int = 1
    overlap: float = 0.0
    stagger: float = 0.0
    from_end: bool = False
    u: float = 0.0

    def __post_init__(self) -> None:
        if not 0.0 <= self.start < self.end <= 1.0:
            raise BadInputError(
                f"a hoop layer from v={self.start:g} to v={self.end:g} has no room; give two places in their order "
                "along the part"
            )
        if not 0.0 < self.width < np.inf:
            raise BadInputError(f"the band's width is {self.width:g}; give a length above 0 in the part's units")
        whole(self.passes, "passes", 1)
        if not 0.0 <= self.overlap < 1.0:
            raise BadInputError(f"overlap is {self.overlap:g}; give a share of the band from 0 up to, not with, 1")
        if not 0.0 <= self.stagger < np.inf:
            raise BadInputError(f"stagger is {self.stagger:g}; give a length of at least 0 in the part's units")


@dataclass(frozen=True)
class Hoop:
    """A hoop layer on a surface.

    Attributes
    ----------
    course : Course
        Its fibre, in order of winding: the passes are laid, the half turns between them dwell.
    tracks : Tracks
        Where the fibre lies, for its thickness: one row, of which u never falls.
    pitch : float
        Distance between neighbouring turns where the level lines are furthest apart, in the surface's units.
    turns : float
        Turns of the mandrel, the half turns at reversals included.
    cover : tuple of float
        Least and largest cover factor of one pass between its first and last turn: width over distance of turns.
    friction : float
        Friction that the laid fibre needs where it presses on the surface, |kg|/kn at most.
    lifts : float
        Share of the fibre's length that does not press on the surface, so that no friction holds it: it would bridge.
    worst : tuple of float
        The u and v where the fibre lifts or, where it does not, where it needs most friction.
    """

    course: Course
    tracks: Tracks
    pitch: float
    turns: float
    cover: tuple[float, float]
    friction: float
    lifts: float
    worst: tuple[float, float]

    __repr__ = brief

    def slips(self, friction: float) -> float:
        """Share of the fibre's length that needs more friction than this, or does not press at all."""
        held = np.asarray(self.course.slip <= friction)
        weight = _weights(self.tracks.steps[0])
        return float(weight[~held].sum() / weight.sum())

    def advice(self, friction: float) -> str:
        """Say whether friction holds the layer and, where it does not, what would; "" where it holds."""
        u, v = self.worst
        if self.lifts > 0.0:
            return (
                f"{_percent(self.lifts)} of the hoop does not press on the part, worst at u={u:.3g}, v={v:.3g}: it "
                "bridges there, whatever the friction; end the hoop before it, or wind at a smaller angle"
            )
        if self.friction > friction:
            return (
                f"{_percent(self.slips(friction))} of the hoop slips off: it needs a friction of "
                f"{self.friction:.3g} at u={u:.3g}, v={v:.3g}, and has {friction:g}; end the hoop before it"
            )
        return ""


def hoop(surface: Surface, plan: HoopPlan) -> Hoop:
    """Wind a hoop layer on a surface.

    The fibre grows in v as it turns, so that neighbouring turns lie one pitch apart where the level lines v = const
    are furthest apart, and closer elsewhere: no gap opens. Its middle stays half a band inside both lines.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    plan : HoopPlan
        What is asked for.

    Returns
    -------
    Hoop
        The fibre, its cover, and the friction that it needs.

    Raises
    ------
    BadInputError
        If the surface is open in u, or the room between the lines is narrower than the band.

    Examples
    --------
    >>> import meshwind as mw
    >>> from meshwind.filament.hoop import HoopPlan, hoop
    >>> tube = mw.shapes.cylinder(radius=50.0, length=200.0)
    >>> layer = hoop(tube, HoopPlan(0.1, 0.9, width=10.0, passes=2))
    >>> round(layer.turns, 6), round(layer.friction, 6)
    (30.5, 0.0)
    """
    lines = levels(surface)
    passed = lines.widest
    ends = _ends(plan, lines)
    pitch = plan.width * (1.0 - plan.overlap)
    turned, distance, passes, dwell = _course(ends, pitch, max(_PER_SPAN * surface.spans[0], _FEWEST))
    u = plan.u + turned
    along = level_at(passed, lines)
    uv = np.stack([u, np.clip(along(distance), 0.0, 1.0)], axis=1)
    rate = np.where(dwell, 0.0, np.where((passes % 2 == 1) != plan.from_end, -pitch, pitch))
    bent = bend(surface, uv, along(distance, 1) * rate, along(distance, 2) * rate**2)
    course = Course(
        points=frozen(bent.points), normal=frozen(bent.normal), angle=frozen(bent.angle), slip=frozen(bent.slip),
        kind=frozen(np.where(dwell, int(Kind.DWELL), int(Kind.LAID))), circuit=frozen(passes // 2),
        passed=frozen(passes), path=frozen(np.full(len(u), -1)),
    )  # fmt: skip
    lifted, weight = ~np.isfinite(bent.slip), _weights(bent.steps)
    worst = uv[int(np.argmax(np.where(lifted, np.inf, bent.slip)))]
    laid = Tracks(frozen(uv[None]), frozen(bent.steps[None]), frozen(np.zeros((1, len(u)))))
    slip = float(np.max(bent.slip, initial=0.0, where=~lifted))
    lifts = float(weight[lifted].sum() / weight.sum())
    where = float(worst[0] % 1.0), float(worst[1])
    return Hoop(course, laid, pitch, float(u[-1] - u[0]), _cover(lines, plan, ends), slip, lifts, where)


def _percent(share: float) -> str:
    """A share in per cent, to two digits."""
    return f"{float(f'{100.0 * share:.2g}'):g} %"


def _weights(steps: Floats) -> Floats:
    """Length (n,) of the fibre that each point stands for, from the steps (n - 1,) between them."""
    return np.asarray(0.5 * (np.r_[steps, 0.0] + np.r_[0.0, steps]))


def begins_at(plan: HoopPlan, lines: Levels) -> float:
    """The v at which a hoop begins."""
    return float(level_at(lines.widest, lines)(_ends(plan, lines)[0]))


def _ends(plan: HoopPlan, lines: Levels) -> Floats:
    """Distances (passes + 1,) at which the passes start and end."""
    low, high = (float(np.interp(v, lines.v, lines.widest)) + side * 0.5 * plan.width
                 for v, side in ((plan.start, 1.0), (plan.end, -1.0)))  # fmt: skip
    k = np.arange(plan.passes + 1)
    ends = np.where(k % 2 == 0, low, high) + np.where(k % 2 == 0, 1.0, -1.0) * plan.stagger * (k // 2)
    if not (np.diff(ends) * np.where(np.arange(plan.passes) % 2, -1.0, 1.0) > 0.0).all():
        raise BadInputError(
            f"between v={plan.start:g} and v={plan.end:g} is no room for {plan.passes} passes of a band {plan.width:g} "
            f"wide with a stagger of {plan.stagger:g}; give places further apart, fewer passes or less stagger"
        )
    return np.asarray(low + high - ends if plan.from_end else ends)


def _course(ends: Floats, pitch: float, per_turn: int) -> tuple[Floats, Floats, Ints, Bools]:
    """The whole course: u, distance, pass and whether it dwells, each (n,)."""
    many = np.ceil(np.abs(np.diff(ends)) / pitch * per_turn).astype(np.int64) + 1
    total = int(many.sum())
    if total > _MOST_POINTS:
        raise BadInputError(
            f"the hoop layer would take {np.abs(np.diff(ends)).sum() / pitch:,.0f} turns; give a wider band or fewer "
            "passes"
        )
    waiting = int(np.ceil(_WAIT * per_turn))
    parts: list[tuple[Floats, Floats, Ints, Bools]] = []
    turned = 0.0
    for k, count in enumerate(many):  # passes are few
        a, b = ends[k], ends[k + 1]
        u = turned + np.linspace(0.0, abs(b - a) / pitch, count)
        parts.append((u, np.linspace(a, b, count), np.full(count, k), np.zeros(count, np.bool_)))
        turned = float(u[-1])
        if k < len(many) - 1:
            u = turned + _WAIT * np.arange(1, waiting) / waiting
            parts.append((u, np.full(len(u), b), np.full(len(u), k), np.ones(len(u), np.bool_)))
            turned += _WAIT
    u, distance, passes, dwell = (np.concatenate(each) for each in zip(*parts, strict=True))
    return u, distance, passes, dwell


def _cover(lines: Levels, plan: HoopPlan, ends: Floats) -> tuple[float, float]:
    """Least and largest cover of one pass: at the widest place it is the band over the pitch, elsewhere more."""
    passed = lines.widest
    inside = (passed >= min(ends[:2])) & (passed <= max(ends[:2]))
    inside[int(np.argmin(np.abs(passed - ends[:2].mean())))] = True
    closer = lines.apart[inside].max(axis=1, keepdims=True) / np.maximum(lines.apart[inside], TINY)
    return 1.0 / (1.0 - plan.overlap), float(closer.max()) / (1.0 - plan.overlap)
