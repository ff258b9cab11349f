"""What a batch of paths was solved from: a record with which it can be solved again, with one thing changed."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.path.friction import Friction

if TYPE_CHECKING:
    from meshwind.path.paths import Paths


@dataclass(frozen=True)
class Options:
    """What all paths of a solve have in common."""

    friction: Friction
    particles: int | None
    bridging: bool
    accuracy: float
    tolerance: float
    iterations: int


@dataclass(frozen=True)
class Asked:
    """What `solve` was asked for: ends (p, 2), family (p,), starting curves (p, k, 2) where they were given.

    solve: the function itself, which comes after the record in the order of imports.  turns: whether whoever asked can
    turn the ends.
    """

    solve: Callable[..., "Paths"]
    start: Floats
    end: Floats
    family: Ints
    initial: Floats | None
    options: Options
    turns: bool = True

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.start)

    def rows(self, chosen: Bools | Ints) -> "Asked":
        """Some of the paths."""
        curves = None if self.initial is None else frozen(self.initial[chosen])
        start, end, family = (frozen(each[chosen]) for each in (self.start, self.end, self.family))
        return replace(self, start=start, end=end, family=family, initial=curves)

    def joined(self, other: "Asked | None") -> "Asked | None":
        """Both batches as one; None where no single solve would give both."""
        if other is None or other.options != self.options or not (self.initial is None and other.initial is None):
            return None
        start, end, family = (
            frozen(np.concatenate([getattr(self, name), getattr(other, name)])) for name in ("start", "end", "family")
        )
        return replace(self, start=start, end=end, family=family)

    def again(self, surface: object, options: Options, index: Ints, end: Floats | None = None) -> "Paths":
        """Some of the paths solved on a surface with other options or, from straight lines, with other ends (p, 2)."""
        last = self.end if end is None else end
        return self.solve(
            surface,
            self.start[index],
            last[index],
            particles=options.particles,
            family=self.family[index],
            friction=options.friction,
            initial=None if self.initial is None or end is not None else self.initial[index],
            bridging=options.bridging,
            accuracy=options.accuracy,
            tolerance=options.tolerance,
            iterations=options.iterations,
        )
