"""Turnarounds on the part itself, where a layer ends within it: steered as on a collar."""

from dataclasses import dataclass, field, replace

import numpy as np

from meshwind.core.cast import Floats, frozen
from meshwind.core.vectors import TINY, unit
from meshwind.filament.collar_turn import Collar
from meshwind.filament.course import Courses
from meshwind.filament.edge import Legs
from meshwind.filament.part_edge import PartEdge
from meshwind.filament.thickness import Tracks
from meshwind.filament.turnaround import Catch


@dataclass
class Bend:
    """Turnarounds on the part, beyond the level line where a layer ends.

    Parameters
    ----------
    edge : PartEdge
        The line.
    steered : float
        Slip with which the fibre would be steered on a prism over the line, above 0; on the part it is another one.

    Attributes
    ----------
    tracks : Tracks or None
        Where the fibres of the turns lie, once they were made.
    """

    edge: PartEdge
    steered: float
    name: str = field(default="bend", init=False)
    rule: str = field(default="steered on the part, where the slip is that of its own curvatures", init=False)
    slip: float = field(default=0.0, init=False)
    tracks: Tracks | None = field(default=None, init=False)

    def __post_init__(self) -> None:
        self._collar = Collar(self.edge, self.steered)

    @property
    def catch(self) -> Catch:
        """See `Turnaround.catch`."""
        return self._collar.catch

    @property
    def reach(self) -> float:
        """Height over the line's highest point up to which fibre comes, of the turns that were made."""
        return self._collar.reach

    @property
    def line(self) -> float:
        """The v to which fibre comes."""
        reach = self.reach if self.edge.end else -self.reach
        return float(np.clip(self.edge.along(self.edge.passed + reach), 0.0, 1.0))

    def surplus(self, arriving: Legs, leaving: Legs, later: Floats) -> Floats:
        """See `Turnaround.surplus`."""
        return self._collar.surplus(arriving, leaving, later)

    def courses(self, arriving: Legs, leaving: Legs, later: Floats) -> Courses:
        """See `Turnaround.courses`."""
        made = self._collar.courses(arriving, leaving, later)
        self.tracks = self._tracks(made)
        slip = slips(made)
        self.slip = max(self.slip, float(slip.max(initial=0.0)))
        return Courses(replace(made.course, slip=frozen(slip)), made.count)

    def _tracks(self, made: Courses) -> Tracks:
        """Where the fibres lie, each with as many points."""
        uv = self.edge.uv(made.course.points)
        many = int(made.count.max())
        share = np.linspace(0.0, 1.0, many)
        at = (made.first[:, None] + share * (made.count - 1)[:, None]).ravel()
        rows = np.stack([np.interp(at, np.arange(len(uv)), uv[:, k]) for k in (0, 1)], axis=1)
        points = self.edge.surface.points(rows).reshape(len(made.count), many, 3)
        steps = np.linalg.norm(np.diff(points, axis=1), axis=2)
        return Tracks(rows.reshape(len(made.count), many, 2), frozen(steps), np.zeros((len(made.count), many)))


def slips(made: Courses) -> Floats:
    """Friction |kg|/kn (n,) that courses need, from their points and normals; infinite where they would lift."""
    points, normal = made.course.points, made.course.normal
    step = np.diff(points, axis=0)
    length = np.maximum(np.linalg.norm(step, axis=1), TINY)
    ahead = step / length[:, None]
    bent = 2.0 * np.diff(ahead, axis=0) / (length[1:] + length[:-1])[:, None]
    along = unit(ahead[1:] + ahead[:-1])
    press = -(bent * normal[1:-1]).sum(axis=1)
    side = np.abs((bent * np.cross(normal[1:-1], along)).sum(axis=1))
    slip = np.zeros(len(points))
    slip[1:-1] = np.divide(side, press, out=np.full(len(side), np.inf), where=press > 0.0)
    # the ends have no point before or after them
    slip[made.first], slip[made.first + made.count - 1] = slip[made.first + 1], slip[made.first + made.count - 2]
    return slip
