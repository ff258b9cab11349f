"""The choice of the number of revolutions: one that is feasible, bridges least, and presses on most of the surface."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Floats
from meshwind.core.checks import check_switch, check_type, is_number, text, whole
from meshwind.core.defaults import PARTICLES, STEPS_PER_TURN
from meshwind.core.errors import BadInputError
from meshwind.core.progress import Progress, silent
from meshwind.path.friction import Friction, friction_of
from meshwind.path.limit import Way
from meshwind.planning.alternatives import alternatives
from meshwind.planning.families import hoop_revolutions, square_revolutions
from meshwind.planning.feasible import Feasible, feasible_revolutions
from meshwind.planning.pressing import Intervals, Pressing, pressing
from meshwind.planning.trials import PATHS, Trial, full_trial, holding_trial, trial
from meshwind.planning.windings import spread
from meshwind.surface.surface import Surface

CANDIDATES = 32
"""Numbers of revolutions that are compared."""
MARGIN = 0.97
"""Share of the feasible interval within which candidates lie: at its very end the fibre is about to slide."""
ALIKE = 0.005
"""Difference of bridged shares up to which windings are alike; among those the crossing angle decides."""
_MAX_CHECKED, _MAX_COMPARED = 10, 3
"""Candidates that are wound at full resolution at most, and feasible ones among them that are compared."""
_LEAST_COMPARED, _FAR = 2, 1.5
"""Candidates that are so at least, and how many times what their coarse windings missed another is to lie behind."""
_KNOWN = 3
"""Windings that are tried before others are passed over by how the share changes from one to the next."""
_APART = 0.04
"""Candidates this close, relative, to one that was wound at full resolution are passed over."""
_ACCURACY = 0.02
"""Relative accuracy of the best number, where all bridge."""
_TRIED = 8
"""Most paths per family in coarse windings."""
_UP, _DOWN = Way(0.0, np.inf, 1.0), Way(np.inf, 0.0, 1.0)
"""Ways in which bounds are rounded for print: into the interval."""
_ROUND_OFF = 1e-9
"""Difference of numbers of revolutions that is round-off."""


Wind = Callable[[float], Trial]
"""Winds by a number of revolutions."""


@dataclass(frozen=True)
class Revolutions:
    """The choice of the number of revolutions, and what it rests on.

    Attributes
    ----------
    chosen : Trial
        The winding at full resolution by the number chosen.
    pressing : Pressing
        The intervals in which points of the surface press.
    common : tuple of tuple of float
        The feasible interval or intervals in which most of the surface presses.
    common_share : float
        That share of the surface.
    feasible : Feasible
        The feasible revolutions.
    trials : tuple of Trial
        All windings that were tried, by growing revolutions.
    square : float
        Revolutions whose families cross at right angles on average.
    with_friction, with_opening : float
        Largest feasible revolutions with a friction of 0.2 or openings 1.5 times as wide (alternatives.py), 0 where
        not looked for or none, infinity where no number slides off.
    """

    chosen: Trial
    pressing: Pressing
    common: Intervals
    common_share: float
    feasible: Feasible
    trials: tuple[Trial, ...]
    square: float
    with_friction: float = 0.0
    with_opening: float = 0.0

    __repr__ = brief

    @property
    def choice(self) -> float:
        """Revolutions from end to end that were chosen."""
        return self.chosen.revolutions

    @property
    def why(self) -> str:
        """The reason for the choice, in a line."""
        if not self.feasible.any:
            here = "these fibres hold, others between them may not" if self.chosen.feasible else "here most hold"
            return f"{self.choice:.3g} revolutions: no number was found that keeps every fibre; {here}"
        low, high = self.feasible.low, self.feasible.high
        ends = f"from {_UP.rounded(low):.3g} " if low > 0.0 else ""
        if np.isfinite(high):
            bound = f"{ends}up to {_DOWN.rounded(high):.3g} no fibres slide off"
        else:
            bound = f"{ends}up to {self.trials[-1].revolutions:.3g} no number was found to slide off"
        share = self.chosen.bridged_share
        bridged = "no fibre bridges" if share == 0.0 else f"{100.0 * share:.2g} % of the fibre bridges, the least"
        return f"{self.choice:.3g} revolutions: {bridged}; {bound}"


def choose_revolutions(
    surface: Surface,
    *,
    paths: int = PATHS,
    particles: int | None = PARTICLES,
    friction: float | Friction = 0.0,
    most: float | None = None,
    further: bool = True,
    progress: Progress = silent,
) -> Revolutions:
    """Choose the number of revolutions.

    Only feasible revolutions are considered: those at which no fibre slides off an end.  Of these a number with the
    least bridging is taken; among numbers that are alike in that, one at which most of the surface presses, and then
    the one whose families cross closest to a right angle.

    Parameters
    ----------
    surface : Surface
        Surface that closes in u.
    paths : int, default 8
        Number of paths per family for which the choice is wound at full resolution.
    particles : int or None, default 401
        Number of particles per path there, as for `solve`.
    friction : float or Friction, default 0
        Coefficient of friction.
    most : float, optional
        Largest number of revolutions.  By default that of a hoop winding, and no more than `particles` can follow.
    further : bool, default True
        Whether to find what more friction and wider openings would allow as well.
    progress : callable, default silent
        Called with a few words as it goes on.

    Returns
    -------
    Revolutions
        The choice as `choice`, a line on it as `why`, the winding as `chosen`, and what the choice rests on.

    Raises
    ------
    BadInputError
        If the surface does not close in u, or `paths` or `most` is out of range.

    Examples
    --------
    >>> import meshwind as mw
    >>> barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0, spans=(32, 16))
    >>> found = mw.choose_revolutions(barrel, paths=4, particles=51, further=False)
    >>> 0.0 < found.choice < 0.6
    True
    """
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    if not surface.periodic:
        raise BadInputError("revolutions need a surface that closes in u; give end points to `solve` instead")
    paths = whole(paths, "paths", 1)
    if particles is not None:
        particles = whole(particles, "particles", 3)
    check_switch(further, "further")
    friction = friction_of(surface, friction)
    if most is None:
        most = hoop_revolutions(surface)
        most = most if particles is None else min(most, (particles - 1) / STEPS_PER_TURN)
    elif not is_number(most) or most <= 0.0:
        raise BadInputError(f"most is {text(most)}; give a largest number of revolutions above 0")
    tried = min(paths, _TRIED)
    progress("which hold")
    feasible = feasible_revolutions(surface, friction, most, paths, particles)
    square = square_revolutions(surface)
    pressed = pressing(surface)
    top = min(feasible.high, most)
    common = pressed.most_common(feasible.low, top)
    share = max((float(pressed.share(np.array([_inside(*each)]))[0]) for each in common), default=0.0)

    def tell(turns: float) -> float:
        progress(f"{turns:.4g} revolutions")
        return turns

    choice = _Choice(
        lambda turns: trial(surface, tell(turns), friction, tried),
        lambda turns: full_trial(surface, tell(turns), friction, paths, particles),
        _candidates(feasible, top, paths).tolist(), common, square, 0.5 / paths,
    )  # fmt: skip
    checked = choice.wind_best()
    trials = [*feasible.trials, *choice.tried, *checked]
    chosen = _least_bridging(checked or [each for each in trials if each.revolutions > 0.0])
    if not feasible.any:  # with any starts; those asked for may hold all the same
        progress("fewer, which hold")
        held = holding_trial(surface, chosen.revolutions, friction, paths, particles)
        if held.feasible:
            chosen = held
            trials.append(held)
    gains = 0.0, 0.0
    if further and feasible.any and np.isfinite(feasible.high):
        progress("what more friction and wider openings allow")
        gains = alternatives(spread(surface, friction, paths, particles), feasible, most)
    trials.sort(key=lambda each: each.revolutions)
    return Revolutions(chosen, pressed, common, share, feasible, tuple(trials), square, *gains)


def _inside(low: float, high: float) -> float:
    """A number inside an interval."""
    return 0.5 * (low + high) if np.isfinite(high) else low + 1.0


def _limit(feasible: Feasible) -> float:
    """The largest candidate."""
    return feasible.low + MARGIN * (feasible.high - feasible.low)


def _candidates(feasible: Feasible, top: float, paths: int) -> Floats:
    """Numbers spread evenly over the feasible ones, such that ends of both families meet on the end rim too."""
    last = min(top, _limit(feasible))
    if not feasible.any:
        return np.zeros(0)
    even = np.linspace(feasible.low, last, CANDIDATES + 1)[1:]
    meeting = np.unique(_meeting(even, paths))
    meeting = meeting[(meeting > feasible.low) & (meeting <= last) & (meeting > 0.0)]
    return meeting if len(meeting) else even


def _meeting(turns: Floats, paths: int) -> Floats:
    """The nearest revolutions by which both families end in the same points: whole multiples of 1 / 2 paths."""
    return np.asarray(np.round(2.0 * paths * turns) / (2.0 * paths))


@dataclass
class _Choice:
    """The best of some numbers of revolutions, and the windings that were tried for it.

    coarse, full: wind by a number with few, coarse paths and as asked; grain: least step between numbers.
    """

    coarse: Wind
    full: Wind
    numbers: list[float]
    common: Intervals
    square: float
    grain: float
    tried: list[Trial] = field(default_factory=list)

    def _rank(self, number: float) -> tuple[bool, float]:
        """What decides among numbers that bridge alike: whether most of the surface presses, then how square it is."""
        presses = any(low <= number <= high for low, high in self.common)
        return not presses, abs(float(np.log(number / self.square)))

    def _best_first(self) -> Iterator[Trial]:
        """The feasible numbers, best first: those that bridge no more than the least, then by what they bridge.

        One that bridges no more than what is alike is as good as any of a worse rank, which waits to be asked for.
        """
        wait: list[Trial] = []
        for number in sorted(self.numbers, key=self._rank):
            if self._hopeless(number):
                continue
            each = self.coarse(number)
            self.tried.append(each)
            if each.feasible and each.bridged_share <= ALIKE:
                yield each
            elif each.feasible:
                wait.append(each)
        least = min((each.bridged_share for each in self.tried if each.feasible), default=0.0)

        def merit(each: Trial) -> tuple[float, bool, float]:
            excess = each.bridged_share - least
            return 0.0 if excess <= ALIKE else excess, *self._rank(each.revolutions)

        yield from sorted(wait, key=merit)

    def _hopeless(self, number: float) -> bool:
        """Whether a number bridges more than the least, judged by those that were tried: by how far and how steeply."""
        known = sorted((each.revolutions, each.bridged_share) for each in self.tried if each.feasible)
        if len(known) < _KNOWN:
            return False
        turns, shares = np.transpose(known)
        steepest = float(np.abs(np.diff(shares) / np.diff(turns)).max())
        return bool((shares - steepest * np.abs(turns - number)).max() > shares.min() + ALIKE)

    def wind_best(self) -> list[Trial]:
        """Windings at full resolution of the best candidates and, where all bridge, of numbers beside the best.

        Coarse paths miss the bridged share by several percent of the fibre: where all bridge, candidates are compared
        at full resolution, and the numbers on both sides of the best as well.
        """
        checked: list[Trial] = []
        for best in self._best_first():
            if self._far_behind(best, checked):
                break
            near = [abs(each.revolutions - best.revolutions) < _APART * best.revolutions for each in checked]
            if not any(near):
                checked.append(self.full(best.revolutions))
            feasible = [each for each in checked if each.feasible]
            enough = len(checked) == _MAX_CHECKED or len(feasible) == _MAX_COMPARED
            if enough or any(each.bridged_share <= ALIKE for each in feasible):
                break
        return checked + self._beside(checked) if checked else []

    def _far_behind(self, one: Trial, checked: list[Trial]) -> bool:
        """Whether a coarse winding bridges so much more than the best at full resolution that it is no rival.

        That is far more than the coarse windings of those have missed, of which at least some are compared.
        """
        feasible = [each for each in checked if each.feasible]
        coarse = {each.revolutions: each.bridged_share for each in self.tried}
        missed = [abs(each.bridged_share - coarse[each.revolutions]) for each in feasible]
        if len(missed) < _LEAST_COMPARED:
            return False
        behind = one.bridged_share - min(each.bridged_share for each in feasible)
        return behind > ALIKE + _FAR * max(missed)

    def _beside(self, checked: list[Trial]) -> list[Trial]:
        """Windings on both sides of the best so far, in steps halved down to half a grain, while all bridge."""
        lost = {each.revolutions for each in self.tried if not each.feasible}
        numbers = sorted(number for number in self.numbers if number not in lost)
        beside: list[Trial] = []
        step = 0.5 * float(np.diff(numbers).max(initial=0.0))
        while True:
            best = _least_bridging([*checked, *beside])
            if step <= max(_ACCURACY * best.revolutions, 0.5 * self.grain) or best.bridged_share <= ALIKE:
                return beside
            whole = self.grain * np.ceil(step / self.grain - _ROUND_OFF)
            known = [each.revolutions for each in (*checked, *beside)]
            either = best.revolutions - whole, best.revolutions + whole
            new = [n for n in either if 0.0 < n <= numbers[-1] + _ROUND_OFF and not np.isclose(known, n).any()]
            beside += map(self.full, new)
            step *= 0.5


def _least_bridging(trials: list[Trial]) -> Trial:
    """The trial with most paths converged and, among those, least bridging."""
    return max(trials, key=lambda each: (each.converged, -each.bridged_share))
