"""The plan of a closed layer: its turns, revolutions and dwells, settled with a few paths before all are laid."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Bools
from meshwind.core.defaults import PARTICLES
from meshwind.core.errors import BadInputError
from meshwind.core.progress import Progress, silent
from meshwind.filament.ends import ROOM, End, LayerPlan, Wish, choose_end
from meshwind.filament.pattern import nearest_pattern, patterns
from meshwind.filament.stations import median_angle, wound_angle
from meshwind.path import Paths, Status, solve
from meshwind.planning.families import families
from meshwind.surface.surface import Surface

_SCOUTS, _ANGLED = 12, 24
"""Paths per family that turnarounds and dwells are planned with, and those from which an angle is told as well."""
_PARTICLES = 401
"""Their particles: dwells of pins are then right to 1e-5 turns, and paths with friction or round sharp edges come to
rest sooner than with fewer."""
SCOUTS_PER_TURN = 40
"""Particles per turn that they have at least: with 20 paths round the edges of a flat spar do not come to rest."""
_SETTLED_IN = 8
"""Rounds in which revolutions and dwells are to suit one another."""
_FAR = 1.0
"""Revolutions times the circuits by which those that close may differ from those asked for; they are 1/2 apart."""
_CONTRACTS = 0.95
"""Share of a shortage of dwell that may be left after a round for the secant to be taken."""
_SPARE = 1e-5
"""Turns by which dwells are taken longer than a round shows: a few paths do not tell them better."""
_NEAR = 0.0175
"""Share by which revolutions may move: the angle changes by sin(2 angle) / 2 times that, half a degree at most."""
_GROWTH = 1.05
"""Most paths over those asked for that are taken to close nearer: numbers that close well are rarely further apart."""
_FEW = 3
"""Paths by which a small number may grow all the same."""
_MET = np.radians(0.3)
"""How near an angle is to be met; half a degree is asked for, and these few paths tell it to 0.2."""
_ENOUGH = np.radians(0.5)
"""How near the angle of all is to be."""
_BACK = 0.99
"""Share of the revolutions that is tried where paths do not come to rest with a little more than were asked for."""


@dataclass(frozen=True)
class Settled:
    """A pattern of N circuits in so many turns, the turnarounds, and the dwells in turns at the start and the end."""

    plan: LayerPlan
    ends: tuple[End, End]
    turns: int
    dwells: tuple[float, float]

    @property
    def revolutions(self) -> float:
        """Turns of a path from end to end."""
        return 0.5 * (self.turns / self.plan.paths - sum(self.dwells))

    @property
    def near(self) -> bool:
        """Whether the revolutions are next to those that were asked for."""
        return self.revolutions >= 0.0 and abs(self.revolutions - self.plan.revolutions) <= _FAR / self.plan.paths


def lay(surface: Surface, plan: LayerPlan, say: Progress = silent) -> tuple[Settled, Paths, int]:
    """What was settled on, all paths of a layer in equilibrium, as many of each family, and how many are left out.

    Where some of the paths come to rest in one place or another, a few tell the angle of all badly, and where some are
    left out, the others have another one than all would: if it is not met then, all are asked.
    """
    settled = settle(surface, plan, _ANGLED, say)
    say(f"{settled.plan.paths} paths a family at {settled.revolutions:.4g} revolutions")
    kept, left_out = _laid(surface, settled)
    if plan.angle is None:
        return settled, kept, left_out
    off = _missed(plan.angle, kept)
    if abs(off) > _ENOUGH:
        aim = plan.angle.wanted - (off - _off(settled, kept))
        other = settle(surface, replace(plan, angle=plan.angle._replace(wanted=aim)), None, say)
        nearer, more = _laid(surface, other)
        if more <= left_out and abs(_missed(plan.angle, nearer)) < abs(off):
            return other, nearer, more
    return settled, kept, left_out


def _missed(wish: Wish, paths: Paths) -> float:
    """By how much the median of paths misses an angle, in radians."""
    return wound_angle(paths, wish.v) - wish.wanted


def _laid(surface: Surface, settled: Settled) -> tuple[Paths, int]:
    plan = settled.plan
    return _some(_solved(surface, plan, plan.paths, settled.revolutions, -settled.dwells[0]))


def settle(surface: Surface, plan: LayerPlan, angled: int | None = _ANGLED, say: Progress = silent) -> Settled:
    """The pattern next to what was asked for, with dwells that are long enough at the revolutions that it leaves.

    Where that does not exist, or not within the angle that was asked for, the revolutions stay as they are, or as the
    angle needs them, and the filament waits as hoops until it closes.  Raises BadInputError where no path of a family
    is at rest, or a turnaround cannot be made.
    """
    say(f"a pattern near {plan.revolutions:.4g} revolutions")
    scouts, lost = _some(_scouts(surface, plan, plan.revolutions, 0.0, angled))
    ends, needed = _needed(surface, plan, scouts)
    counted = _counted(plan, 2.0 * plan.revolutions + sum(needed))
    if counted.paths != plan.paths:
        plan = counted
        ends, needed = _needed(surface, plan, scouts)
    found = _nearest(surface, Settled(plan, ends, 0, needed), angled)
    if found is not None:
        settled, tried, more_lost = found
        if more_lost <= lost and abs(_off(settled, tried)) <= _MET:
            return settled
    settled = _waiting(plan, ends, needed)
    return settled if plan.angle is None else _at_angle(surface, settled, needed, (lost, angled), say)


def _counted(plan: LayerPlan, turns: float) -> LayerPlan:
    """The first number of circuits that closes near enough to what was asked for, or the nearest of those allowed."""
    if not plan.grows or not plan.revolutions > 0.0:
        return plan
    counts = range(plan.paths, max(int(np.ceil(_GROWTH * plan.paths)), plan.paths + _FEW) + 1)
    off = [abs(nearest_pattern(n, turns).turns / n - turns) / 2.0 / plan.revolutions for n in counts]
    count = next((n for n, each in zip(counts, off, strict=True) if each <= _NEAR), counts[int(np.argmin(off))])
    return replace(plan, paths=count)


def _needed(surface: Surface, plan: LayerPlan, scouts: Paths) -> tuple[tuple[End, End], tuple[float, float]]:
    """The turnarounds, and the least dwells of the scouts."""
    start, end = (choose_end(surface, end, plan, word, scouts) for end, word in enumerate(plan.turns))
    return (start, end), (start.pairs(scouts).least_dwell(), end.pairs(scouts).least_dwell())


def _nearest(surface: Surface, first: Settled, angled: int | None) -> tuple[Settled, Paths, int] | None:
    """The pattern next to what was asked for, its scouts, and how many of them are left out; None if none settles.

    Longer dwells leave fewer revolutions, with which collars need still longer ones: the secant of the two gives where
    they meet.
    """
    plan, ends = first.plan, first.ends
    pattern = nearest_pattern(plan.paths, 2.0 * plan.revolutions + sum(first.dwells))
    settled, short = replace(first, turns=pattern.turns), np.inf
    for _ in range(_SETTLED_IN):
        if not settled.near:
            break
        rest = _at_rest(_scouts(surface, plan, settled.revolutions, -settled.dwells[0], angled))
        if rest is None:
            break
        tried, lost = rest
        now = np.array([end.pairs(tried).least_dwell() for end in ends]) - settled.dwells
        if now.max() <= ROOM:
            return settled, tried, lost
        factor = 1.0 / (1.0 - now.sum() / short) if now.sum() < _CONTRACTS * short else 1.0
        short = now.sum()
        start, end = np.array(settled.dwells) + factor * now + _SPARE
        settled = replace(settled, dwells=(float(start), float(end)))
    return None


def _waiting(plan: LayerPlan, ends: tuple[End, End], needed: tuple[float, float]) -> Settled:
    """The nearest pattern with the revolutions that were asked for: the filament waits as hoops until it closes."""
    pattern = patterns(plan.paths, 2.0 * plan.revolutions + sum(needed))[0]
    more = 0.5 * pattern.dwell
    # round-off must not leave fewer revolutions than none
    start = needed[0] + more
    return Settled(plan, ends, pattern.turns, (start, min(needed[1] + more, pattern.turns / plan.paths - start)))


def _at_angle(
    surface: Surface,
    settled: Settled,
    needed: tuple[float, float],
    scouts: tuple[int, int | None],
    say: Progress,
) -> Settled:
    """The pattern with the revolutions that the angle takes, with its circuits, where these are.

    scouts: how many of them may be left out, and how many a family there are.
    """
    lost, angled = scouts
    plan, ends, best, least = settled.plan, settled.ends, settled, np.inf
    assert plan.angle is not None
    for _ in range(_SETTLED_IN):
        say(f"the angle at {settled.revolutions:.4g} revolutions")
        rest = _at_rest(_scouts(surface, plan, settled.revolutions, -settled.dwells[0], angled))
        if rest is None or rest[1] > lost:
            settled = _waiting(replace(plan, revolutions=_BACK * settled.revolutions), ends, needed)
            continue
        tried = rest[0]
        first, second = (end.pairs(tried).least_dwell() for end in ends)
        off = _off(settled, tried)
        enough = first <= settled.dwells[0] + ROOM and second <= settled.dwells[1] + ROOM
        if enough and abs(off) < least:
            best, least = settled, abs(off)
            if least <= 0.5 * _MET:
                break
        needed = max(needed[0], first), max(needed[1], second)
        wanted = plan.angle.wanted
        turns = settled.revolutions * float(np.clip(np.tan(wanted) / np.tan(wanted + off), 0.8, 1.25))
        settled = _waiting(replace(plan, revolutions=turns), ends, needed)
    return best


def _off(settled: Settled, scouts: Paths) -> float:
    """How far the median angle of all paths is off the one that was asked for, in radians; 0 where none was."""
    plan = settled.plan
    if plan.angle is None:
        return 0.0
    return median_angle(scouts, plan.angle.v, plan.paths, -settled.dwells[0]) - plan.angle.wanted


def _scouts(surface: Surface, plan: LayerPlan, revolutions: float, phase: float, angled: int | None) -> Paths:
    if angled is None:
        return _solved(surface, plan, plan.paths, revolutions, phase)
    least = max(_PARTICLES, int(np.ceil(SCOUTS_PER_TURN * revolutions)))
    few = replace(plan, particles=min(plan.particles or PARTICLES, least))
    count = min(plan.paths, _SCOUTS if plan.angle is None else angled)
    return _solved(surface, few, count, revolutions, phase)


def _solved(surface: Surface, plan: LayerPlan, count: int, revolutions: float, phase: float) -> Paths:
    ends = families(surface, count, revolutions, phase=phase, between=plan.between)
    return solve(surface, ends.start, ends.end, family=ends.family, particles=plan.particles, friction=plan.friction)


def _some(paths: Paths) -> tuple[Paths, int]:
    """As `_at_rest`; raises BadInputError where no path of a family is."""
    rest = _at_rest(paths)
    if rest is None:
        raise BadInputError(
            "no filament can be wound, as no path of a family is at rest; "
            + paths.advice(int(np.argmin(paths.status == Status.CONVERGED)))
        )
    return rest


def _at_rest(paths: Paths) -> tuple[Paths, int] | None:
    """The paths in equilibrium, evened to as many of each family, and how many are left out; None without."""
    rest: Bools = paths.status == Status.CONVERGED
    counts = [int((rest & (paths.family == family)).sum()) for family in (1, -1)]
    if not min(counts):
        return None
    keep = np.flatnonzero(rest)
    richer = 1 if counts[0] > counts[1] else -1
    mine = keep[paths.family[keep] == richer]
    spare = abs(counts[0] - counts[1])
    out = mine[np.linspace(0, len(mine) - 1, spare).round().astype(np.int64)] if spare else mine[:0]
    keep = np.setdiff1d(keep, out)
    return (paths if len(keep) == len(paths) else paths.subset(keep)), len(paths) - len(keep)
