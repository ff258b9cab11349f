"""As many paths as cover the part: counted with a few, and checked with those that are laid."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from meshwind.core.cast import Floats
from meshwind.filament.levels import levels
from meshwind.filament.stations import COVERED, circuits_to_cover, covers
from meshwind.path import Paths, Status
from meshwind.workflow.notes import Note

if TYPE_CHECKING:
    from meshwind.filament.closing import ClosedLayer

_ROUNDS = 20
"""Times that paths are added, each as many as would cover at the angle of the last ones: two or three are usual."""


@dataclass(frozen=True)
class Laid:
    """The paths of a run, and the layer that they are closed to, if it is one filament."""

    paths: Paths
    closed: ClosedLayer | None = None

    @property
    def count(self) -> int:
        """Paths of a family."""
        return len(self.paths) // 2

    @property
    def whole(self) -> bool:
        """Whether every path is at rest and in the filament."""
        left_out = 0 if self.closed is None else self.closed.left_out
        return not left_out and bool((self.paths.status == Status.CONVERGED).all())


def lay_until_covered(lay: Callable[[int], Laid], count: int, width: float) -> tuple[Laid, Note]:
    """Lay so many paths a family, and more until their bands of this width cover the part, with a note on how much.

    More paths do not help where some do not come to rest: those are for the user to see to.
    """
    laid = lay(count)
    lines = levels(laid.paths.surface)
    for _ in range(_ROUNDS):
        if not laid.whole or np.nanmin(covers(laid.paths, lines.v, width)) >= 1.0 - COVERED:
            break
        laid = lay(max(laid.count + 1, circuits_to_cover(laid.paths, lines, width)))
    return laid, _cover_note(laid.count, lines.v, covers(laid.paths, lines.v, width))


def _cover_note(count: int, v: Floats, cover: Floats) -> Note:
    least, most = int(np.nanargmin(cover)), int(np.nanargmax(cover))
    does = "cover" if cover[least] >= 1.0 - COVERED else "do not cover"
    return Note(
        f"{count} paths of each family {does} the part: {cover[least]:.3f} times at v={v[least]:.3g}, where they have "
        f"most to cover, and {cover[most]:.3g} times at v={v[most]:.3g}, where they have least",
        warning=does != "cover",
    )
