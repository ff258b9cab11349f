"""Bands of fibre as strips between rows of points, in the order of winding.

Importing this module loads nothing heavy, as the process that draws needs it, too.
"""

from dataclasses import dataclass, fields, replace

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.lists import spread
from meshwind.core.vectors import TINY, unit
from meshwind.filament.kinds import Kind

WORDS = {
    Kind.LAID: "on the part",
    Kind.BRIDGE: "over a hollow",
    Kind.TURN: "in a turnaround",
    Kind.DWELL: "waiting at the end",
    Kind.JOIN: "on to the next layer",
}
"""What a fibre does, by kind, for those who watch it being laid."""
_FACING = 3.0
"""One over the cosine between the directions to the eye and of the normal from which a band faces the eye fully."""


@dataclass(frozen=True)
class Ribbons:
    """Bands as strips one after the other, of k rows of m points across.

    points (k, m, 3); laid (k,): length of all fibre laid before each row; kind, layer, circuit, passed, path (k,) as in
    a filament; angle (k,): winding angle in degrees; slip, thickness (k,) as in a filament; sizes (l,): rows of each
    strip; off_turns (k, m): distance of each point from the nearest turnaround, infinite where there is none.
    """

    points: Floats
    off_turns: Floats
    laid: Floats
    kind: Ints
    layer: Ints
    circuit: Ints
    passed: Ints
    path: Ints
    angle: Floats
    slip: Floats
    thickness: Floats
    sizes: Ints

    @property
    def quads(self) -> Ints:
        """Quads (q, 4) between the points, seen from outside against the clock, in the order of laying."""
        across = self.points.shape[1]
        begin = np.cumsum(self.sizes) - self.sizes
        row = spread(begin, self.sizes - 1)
        corner = (row[:, None] * across + np.arange(across - 1)).ravel()
        return np.stack([corner, corner + across, corner + across + 1, corner + 1], axis=1)

    @property
    def normals(self) -> Floats:
        """Outward unit normals (k, m, 3) of the strips."""
        ahead = np.zeros_like(self.points)
        steps = np.diff(self.points, axis=0)
        steps[np.cumsum(self.sizes)[:-1] - 1] = 0.0  # from one strip to the next
        ahead[:-1] += steps
        ahead[1:] += steps
        return unit(np.cross(ahead, np.gradient(self.points, axis=1)))

    def before(self, eye: Floats, depth: float, within: float, both: bool = False) -> "Ribbons":
        """The same as an eye in direction (3,) shall see it: what is laid later before what is laid earlier.

        Fibres are computed one by one. Where they cross in the air the later one would lie on the earlier one, but they
        would cut through each other; so bands that face the eye come nearer to it by up to `depth`, but for turnarounds
        and what is `within` a distance of them, which has pins in front of it.
        both: for an eye on the other side, too.
        """
        share = (self.laid / max(float(self.laid[-1]), TINY))[:, None]
        # both depend on the place alone, so that where bands cross their order alone decides
        clear = np.clip(self.off_turns / max(within, TINY) - 1.0, 0.0, 1.0)
        facing = np.clip(_FACING * (self.normals @ eye), -1.0 if both else 0.0, 1.0)
        return replace(self, points=self.points + (depth * share * clear * facing)[..., None] * eye)

    def until(self, done: float) -> "Ribbons":
        """What is laid when a length of fibre is laid; the last row of it is between two of these."""
        rows = int(np.searchsorted(self.laid, done, side="right"))
        first = np.cumsum(self.sizes) - self.sizes
        strip = int(np.searchsorted(first, max(rows - 1, 0), side="right")) - 1
        among = 0 < rows < first[strip] + self.sizes[strip]
        if among:
            before, after = self.laid[rows - 1], self.laid[rows]
            share = float((done - before) / (after - before))
            between = (1.0 - share) * self.points[rows - 1] + share * self.points[rows]
        each = {part.name: getattr(self, part.name)[: rows + among] for part in fields(self) if part.name != "sizes"}
        sizes = np.append(self.sizes[:strip], rows + among - first[strip])
        if among:
            each |= {
                "points": np.concatenate([self.points[:rows], between[None]]),
                "laid": np.append(self.laid[:rows], done),
            }
        return Ribbons(**each, sizes=sizes[sizes > 0])


@dataclass(frozen=True)
class Gear:
    """What the turnarounds stand on: quads between points (n, 3), and names for the legend.

    base (q, 4): of collars, and of the rings that pins stand on; held (p, 4): of pins and shafts, which hold the fibre.
    """

    points: Floats
    base: Ints
    held: Ints
    base_words: str = ""
    held_words: str = ""


@dataclass(frozen=True)
class Turned:
    """What turns a filament at one end: a word for it, its reach over the rim, and the radius of pins or shaft."""

    kind: str
    reach: float
    radius: float

    @property
    def pin(self) -> float:
        """Radius of the pins, also of those before a shaft; 0 where there are none."""
        if self.kind == "shaft":
            return _SLIM * self.reach
        return self.radius if self.kind == "pins" else 0.0


_SLIM = 0.12
"""Radius of the pins before a shaft over the reach: they only turn the fibre inwards."""
