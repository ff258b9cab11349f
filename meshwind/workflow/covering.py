"""As many paths as cover the part: counted with a few, and checked with those that are laid."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Floats
from meshwind.filament.closing import ClosedLayer
from meshwind.filament.ends import CAP
from meshwind.filament.levels import levels
from meshwind.filament.pattern import nearest_pattern
from meshwind.filament.stations import COVERED, circuits_to_cover, covers
from meshwind.path import Paths, Status
from meshwind.workflow.notes import Note

_ROUNDS = 20
"""Times that paths are added, each as many as would cover at the angle of the last ones: two or three are usual."""

_GROWTH = 1.05
"""Most paths over those that cover that are taken to close nearer: numbers that close well are rarely further apart."""
_FEW = 3
"""Paths by which a small number may grow all the same."""
_NEAR = 0.0175
"""Share by which revolutions may move: the angle changes by sin(2 angle) / 2 times that, half a degree at most."""


@dataclass(frozen=True)
class Laid:
    """The paths of a run, and the layer that they are closed to, if it is one filament."""

    paths: Paths
    closed: ClosedLayer | None = None

    @property
    def whole(self) -> bool:
        """Whether every path is at rest and in the filament."""
        left_out = 0 if self.closed is None else self.closed.left_out
        return not left_out and bool((self.paths.status == Status.CONVERGED).all())


def lay_until_covered(lay: Callable[[int], Laid], count: int, width: float) -> tuple[Laid, Note]:
    """Lay so many paths a family, and more until their bands of this width cover the part, with a note on how much.

    A filament takes a few more paths where these close nearer to the revolutions that were asked for.  More paths do
    not help where some do not come to rest: those are for the user to see to.
    """
    laid, most = lay(count), max(int(np.ceil(_GROWTH * count)), count + _FEW)
    lines = levels(laid.paths.surface)
    for _ in range(_ROUNDS):
        short = np.nanmin(covers(laid.paths, lines.v, width)) < 1.0 - COVERED
        least = max(count + 1, circuits_to_cover(laid.paths, lines, width)) if short else count
        better = least if laid.closed is None else _closing_nearer(laid.closed, least, max(most, least))
        if better == count or not laid.whole:
            break
        count = better
        laid = lay(count)
    return laid, _cover_note(count, lines.v, covers(laid.paths, lines.v, width))


def _closing_nearer(layer: ClosedLayer, least: int, most: int) -> int:
    """The first number of paths from `least` up that closes near enough to what was asked for, or the nearest."""
    asked, dwell = layer.plan.revolutions, float(layer.joining.start_dwell.mean() + layer.joining.end_dwell.mean())
    if CAP in layer.plan.turns or not asked > 0.0:
        return least
    counts = range(least, most + 1)
    off = [abs(nearest_pattern(n, 2.0 * asked + dwell).turns / n - dwell - 2.0 * asked) / 2.0 / asked for n in counts]
    return next((n for n, each in zip(counts, off, strict=True) if each <= _NEAR), counts[int(np.argmin(off))])


def _cover_note(count: int, v: Floats, cover: Floats) -> Note:
    least, most = int(np.nanargmin(cover)), int(np.nanargmax(cover))
    does = "cover" if cover[least] >= 1.0 - COVERED else "do not cover"
    return Note(
        f"{count} paths of each family {does} the part: {cover[least]:.3f} times at v={v[least]:.3g}, where they have "
        f"most to cover, and {cover[most]:.3g} times at v={v[most]:.3g}, where they have least",
        warning=does != "cover",
    )
