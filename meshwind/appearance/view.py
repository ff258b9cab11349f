"""Views of a part: the direction to look from, and the extents on the picture."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats, Ints

_TILT = np.radians(14.0)
"""Angle by which the view is tilted towards an end of the part, to show its roundness."""
_TURNS = 24
_BEND = 8.0
"""Weight of the bend: a bend of 5% of the part's size outweighs the bridges."""


NAMED = {
    "x": (1.0, 0.0, 0.0), "-x": (-1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "-y": (0.0, -1.0, 0.0), "z": (0.0, 0.0, 1.0),
    "-z": (0.0, 0.0, -1.0), "iso": (1.0, -1.0, 1.0),
}  # fmt: skip
"""Directions to look from, by name."""


@dataclass(frozen=True)
class View:
    """A parallel projection: unit vectors towards the right, the top and the eye (3,), centre, extents.

    centre (3,) is the middle of what is seen; width and height its extents on the picture, in mesh units; both: whether
    pictures with room for it show the other side as well.
    """

    right: Floats
    up: Floats
    eye: Floats
    centre: Floats
    width: float
    height: float
    both: bool = False

    @property
    def other(self) -> "View":
        """The view from the other side, turned about the longer extent: what is seen has the same extents."""
        if self.upright:
            return replace(self, right=-self.right, eye=-self.eye)
        return replace(self, up=-self.up, eye=-self.eye)

    @property
    def upright(self) -> bool:
        """Whether what is seen is higher than wide."""
        return self.height > self.width


def best_view(points: Floats, quads: Ints, axis: Floats, marks: Floats, outward: Floats, weight: Floats) -> View:
    """View perpendicular to the long axis that shows most of the part, of its bend and of the marks.

    points (k, 3) and quads (q, 4) are the part; axis (j, 3) its middle from end to end; marks (m, 3) with outward
    normals (m, 3) and weights (m,) are what the picture is about.  A part whose long axis is along z is shown
    upright, others are shown lying.
    """
    area, normal = _facets(points, quads)
    middle = points[quads].mean(axis=1)
    centre = (area[:, None] * middle).sum(axis=0) / area.sum()
    spread = (middle - centre).T @ (area[:, None] * (middle - centre))
    long = np.linalg.eigh(spread)[1][:, -1]
    long = long * np.sign(long[np.abs(long).argmax()])
    across = _perpendicular(long)
    turn = 2.0 * np.pi * np.arange(_TURNS) / _TURNS
    sides = np.cos(turn)[:, None] * across + np.sin(turn)[:, None] * np.cross(long, across)
    shadow = np.abs(normal @ sides.T).T @ area / (2.0 * area.sum())
    seen = np.maximum(outward @ sides.T, 0.0).T @ weight / max(float(weight.sum()), 1e-300)
    bend = _bend(axis, long, sides) / np.sqrt(np.trace(spread) / area.sum())
    # A tie, as on a body of revolution, goes to the side that faces -y: the customary front.
    eye = sides[int(np.argmax(shadow + 0.5 * seen + _BEND * bend - 1e-3 * sides[:, 1]))]
    upright = abs(long[2]) > 0.7
    if upright and long[2] < 0.0:
        long = -long
    side = np.cross(eye, long) * (-1.0 if upright else 1.0)
    if not upright and side[2] < 0.0:
        long, side = -long, -side
    eye, long = np.cos(_TILT) * eye + np.sin(_TILT) * long, np.cos(_TILT) * long - np.sin(_TILT) * eye
    right, up = (side, long) if upright else (long, side)
    return _framed(np.concatenate([points, marks]), right, up, eye)


def merit_view(points: Floats, faces: Ints, eyes: Floats, merit: Floats) -> View:
    """View from the best of the directions `eyes` (k, 3), by their merit (k,) and by how much of a part they show.

    points (n, 3) and faces (m, 3) are the part.  Upright or lying as in `best_view`.
    """
    area, normal = _facets(points, faces[:, [0, 1, 2, 2]])
    middle = points[faces].mean(axis=1)
    centre = (area[:, None] * middle).sum(axis=0) / area.sum()
    frame = np.linalg.eigh((middle - centre).T @ (area[:, None] * (middle - centre)))[1]
    shadow = area @ np.abs(normal @ eyes.T)
    eye = eyes[int(np.argmax(merit + shadow / shadow.max()))]
    long = next(axis for axis in frame.T[::-1] if abs(axis @ eye) < 0.9)
    along = long - (long @ eye) * eye
    along /= np.linalg.norm(along)
    if abs(long[2]) > 0.7:
        up = along if along[2] > 0.0 else -along
        return _framed(points, np.cross(up, eye), up, eye)
    right = along if np.cross(eye, along)[2] >= 0.0 else -along
    return _framed(points, right, np.cross(eye, right), eye)


def named_view(points: Floats, name: str) -> View:
    """View of points (n, 3) from one of `NAMED`, with z upward or, if seen along z, with y upward."""
    eye = np.array(NAMED[name]) / np.linalg.norm(NAMED[name])
    start = np.array([0.0, 1.0, 0.0]) if abs(eye[2]) > 0.9 else np.array([0.0, 0.0, 1.0])
    up = start - (start @ eye) * eye
    up /= np.linalg.norm(up)
    return _framed(points, np.cross(up, eye), up, eye)


def around(count: int) -> Floats:
    """Unit vectors (count, 3) spread evenly over the sphere, on a spiral."""
    height = 1.0 - (2.0 * np.arange(count) + 1.0) / count
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    across = np.sqrt(1.0 - height**2)
    return np.stack([across * np.cos(turn), across * np.sin(turn), height], axis=1)


def framed(points: Floats, view: View) -> View:
    """A view from the same side that contains all points (n, 3)."""
    return replace(_framed(points, view.right, view.up, view.eye), both=view.both)


def _framed(points: Floats, right: Floats, up: Floats, eye: Floats) -> View:
    """The view with given axes that contains all points (n, 3)."""
    axes = np.stack([right, up, eye])
    flat = points @ axes.T
    low, high = flat.min(axis=0), flat.max(axis=0)
    return View(right, up, eye, 0.5 * (low + high) @ axes, float(high[0] - low[0]), float(high[1] - low[1]))


def _bend(axis: Floats, long: Floats, sides: Floats) -> Floats:
    """Root mean square deviation (s,) of the part's middle from a straight line, as seen from each of the sides."""
    along = axis @ long
    across = axis @ np.cross(sides, long).T
    slope = np.stack([along, np.ones_like(along)], axis=1)
    stray = across - slope @ np.linalg.lstsq(slope, across, rcond=None)[0]
    return np.asarray(np.sqrt((stray**2).mean(axis=0)))


def _facets(points: Floats, quads: Ints) -> tuple[Floats, Floats]:
    """Areas (q,) and unit normals (q, 3)."""
    corner = points[quads]
    cross = 0.5 * np.cross(corner[:, 2] - corner[:, 0], corner[:, 3] - corner[:, 1])
    area = np.linalg.norm(cross, axis=1)
    return area, np.divide(cross, area[:, None], out=np.zeros_like(cross), where=area[:, None] > 0.0)


def _perpendicular(axis: Floats) -> Floats:
    """Unit vector perpendicular to `axis`, as close as possible to -y, or to z if the axis is along y."""
    start = np.array([0.0, -1.0, 0.0]) if abs(axis[1]) < 0.9 else np.array([0.0, 0.0, 1.0])
    square = start - (start @ axis) * axis
    return np.asarray(square / np.linalg.norm(square))
