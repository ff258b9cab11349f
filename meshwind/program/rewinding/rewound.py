"""What became of a program that was wound again, pass by pass, and what is said of it."""

from collections.abc import Sequence
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.program.blocks import Blocks
from meshwind.program.faults import LIES, Fault, place
from meshwind.program.rewinding.stretches import Stretches, together


@dataclass(frozen=True)
class Rewound:
    """What became of the stretches (m,) of a program that lie on the part.

    Attributes
    ----------
    stretches : Stretches
        Where they are in the program.
    distance : ndarray of float, shape (m,)
        Largest distance between where the fibre comes to lie and where it was planned, in the mesh's units.
    block : ndarray of int, shape (m,)
        The block in which it is that far.
    slip : ndarray of float, shape (m,)
        Largest friction that the fibre needs to stay where the eye lays it.
    slid : ndarray of bool, shape (m,)
        Whether it needs more than there is, and was solved again.
    followed : ndarray of bool, shape (m,)
        Whether it was followed to its end, and came to rest if it slid.
    slack : ndarray of float, shape (m,)
        Length of fibre that the eye gives back, as no spool takes it up; the program allows none.
    allowed : ndarray of float, shape (m,)
        Half of the band's width: the largest distance of a stretch that is good.
    seconds : float
        What it took.
    """

    stretches: Stretches
    distance: Floats
    block: Ints
    slip: Floats
    slid: Bools
    followed: Bools
    slack: Floats
    allowed: Floats
    seconds: float = 0.0

    @cached_property
    def good(self) -> Bools:
        """Whether the fibre of each stretch comes to lie where it was planned, within half of its band's width."""
        return np.asarray(self.followed & (self.distance <= self.allowed))

    def faults(self, blocks: Blocks, units: str = "") -> list[Fault]:
        """The stretches that are not good; units: of the mesh."""
        return [Fault(int(self.block[k]), LIES, self._words(int(k), blocks, units)) for k in np.flatnonzero(~self.good)]

    def _words(self, k: int, blocks: Blocks, units: str) -> str:
        where = place(blocks, int(self.block[k]))
        if self.followed[k]:
            slid = f", sliding where it needs a friction of {self.slip[k]:.2g}" if self.slid[k] else ""
            away = quantity(float(self.distance[k]), units, 3)
            return f"wound again, the fibre lies {away} from where it was planned{slid}, {where}"
        if self.slid[k]:
            return f"wound again, the fibre slides off where it needs a friction of {self.slip[k]:.2g}, {where}"
        return f"wound again, the fibre cannot be followed {where}"

    @property
    def figures(self) -> dict[str, Any]:
        """What program.json says of it; lengths in the mesh's units."""
        good = self.distance[self.good]
        return {
            "passes": len(self.distance),
            "good": int(self.good.sum()),
            "distance": {"median": float(np.median(good)), "max": float(good.max())} if len(good) else None,
            "slip": float(self.slip.max(initial=0.0)),
            "slid": int(self.slid.sum()),
            "slack": float(self.slack.max(initial=0.0)),
            "seconds": self.seconds,
        }


def joined(parts: Sequence[Rewound], seconds: float) -> Rewound:
    """One from several, its stretches in the order of the program."""
    stretches = together([part.stretches for part in parts])
    order = np.argsort(stretches.first, kind="stable")
    values = {
        each.name: np.concatenate([getattr(part, each.name) for part in parts])[order] for each in fields(Rewound)[1:-1]
    }
    return Rewound(stretches=stretches.chosen(order), seconds=seconds, **values)


def nothing() -> Rewound:
    """What became of a program whose fibre lies on the part nowhere."""
    none, no = np.zeros(0), np.zeros(0, dtype=np.int64)
    return Rewound(Stretches(no, no, no, np.zeros((0, 2))), none, no, none, none > 0.0, none > 0.0, none, none)
