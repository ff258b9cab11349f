"""Choice of the two ends of a part: open rims, or poles that are to be opened."""

import re
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, Ints, floats
from meshwind.core.errors import BadInputError
from meshwind.core.spoken import called
from meshwind.mesh.geometry.areas_and_volumes import loop_area, loop_area_vector, loop_centroid, perimeter
from meshwind.mesh.geometry.axis import forward, longest_axis, rank
from meshwind.mesh.opening.poles import Lip, extreme, nearest

_AXES = {"x": 0, "y": 1, "z": 2}
_LENGTH_STEPS = 1e9
"""Lengths over the longest one are rounded to this many steps, so that round-off does not decide their order."""
_SAME_SIZE = 1e-3
"""Sizes and distances that differ relatively by less than this are equal."""
_SAME_HEIGHT = 0.05
"""Rims whose heights differ by less than this share of the extent are equally far out."""


@dataclass(frozen=True)
class End:
    """One end: its centre (3,), and the loop of its rim or its lip; without both, the centre is a pole.

    outward: the direction out of the part along its axis (3,), if the end was found along one; diagonal: of the part,
    which determines how many digits of a position are significant.
    """

    centre: Floats
    loop: Ints | None = None
    lip: Lip | None = None
    outward: Floats | None = None
    diagonal: float = 1.0

    @property
    def is_pole(self) -> bool:
        """Whether an opening has to be cut here."""
        return self.loop is None and self.lip is None

    @property
    def position(self) -> str:
        """Coordinates of the centre, as text."""
        return position_text(self.centre, self.diagonal)


def position_text(point: Floats | tuple[float, ...], diagonal: float) -> str:
    """Coordinates of a point as text, to a 10,000th of the part's diagonal or finer, without round-off."""
    digits = 5 - int(np.ceil(np.log10(diagonal)))
    return "(" + ", ".join(f"{round(float(x), digits) + 0.0:.12g}" for x in point) + ")"


@dataclass(frozen=True)
class EndsRequest:
    """Requested ends: along a model axis (3,), at two points (2, 3), or two rims by number; none of them is `auto`."""

    axis: Floats | None = None
    points: Floats | None = None
    loops: tuple[int, int] | None = None
    text: str = "auto"


def parse_ends(given: str | ArrayLike) -> EndsRequest:
    """Read 'auto', 'x', 'y', 'z', 'x,y,z x,y,z' or 'loops i j', or take two points (2, 3).

    Raises BadInputError for anything else.
    """
    word = given.strip().lower() if isinstance(given, str) else ""
    shown = " ".join(repr(given).split())
    if word == "auto":
        return EndsRequest()
    if word in _AXES:
        return EndsRequest(axis=np.eye(3)[_AXES[word]], text=word)
    numbers = re.fullmatch(r"loops\s+(\d{1,9})[\s,]+(\d{1,9})", word)
    if numbers is not None:
        if int(numbers[1]) == int(numbers[2]):
            raise BadInputError(f"ends {shown}: both are the same rim; give two numbers that {called('check')} lists")
        return EndsRequest(loops=(int(numbers[1]), int(numbers[2])), text=word)
    try:
        two = [[float(x) for x in part.split(",")] for part in word.split()] if isinstance(given, str) else given
        points = floats(two, "ends", 2, 3)
    except (TypeError, ValueError) as error:
        raise BadInputError(
            f"ends {shown}: give auto, x, y, z or two points as in '0,0,0 0,0,100', or two open rims as in 'loops 0 1'"
        ) from error
    if (points[0] == points[1]).all():
        raise BadInputError(f"ends {shown}: the two points are the same; give one at each end of the part")
    return EndsRequest(points=points, text=word or " ".join(",".join(map(repr, point)) for point in points.tolist()))


def rims_by_number(vertices: Floats, rims: list[Ints]) -> list[Ints]:
    """Boundary loops in the order of their numbers: from the longest to the shortest, equal ones as in the file."""
    if not rims:
        return []
    length = np.array([perimeter(vertices, loop) for loop in rims])
    order = np.argsort(-np.round(_LENGTH_STEPS * length / length.max()), kind="stable")
    return [rims[k] for k in order]


def choose_ends(vertices: Floats, faces: Ints, rims: list[Ints], request: EndsRequest) -> tuple[list[End], str]:
    """Choose the start and the end of a part with the given boundary loops; also returns how, in words.

    If the request has loops by number, `rims` are these two.
    """
    pair, words = _choose(vertices, faces, rims, request)
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    return [replace(end, diagonal=diagonal) for end in pair], words


def _choose(vertices: Floats, faces: Ints, rims: list[Ints], request: EndsRequest) -> tuple[list[End], str]:
    ends = [End(loop_centroid(vertices, loop), loop) for loop in rims]
    if request.loops is not None:
        return ends, f"the open rims number {request.loops[0]} and {request.loops[1]}"
    if len(ends) >= 2:
        return _two_rims(vertices, faces, ends, request)
    return _one_rim(vertices, faces, rims[0], request) if rims else _two_poles(vertices, faces, request)


def _two_rims(vertices: Floats, faces: Ints, ends: list[End], request: EndsRequest) -> tuple[list[End], str]:
    if request.points is not None:
        away = np.array([[_distance(vertices, end, point) for end in ends] for point in request.points])
        total = away[0][:, None] + away[1] + np.diag(np.full(len(ends), np.inf))
        first, second = np.unravel_index(np.argmin(total), total.shape)
        return [ends[first], ends[second]], "the open rims nearest to the given points"
    if request.axis is not None:
        return _rims_along(vertices, ends, request.axis), f"the open rims furthest out along {request.text}"
    a, b = _largest_two(vertices, ends)
    long, short = (perimeter(vertices, end.loop) for end in (a, b) if end.loop is not None)
    if abs(long - short) > _SAME_SIZE * max(long, short):
        pair = [a, b] if long > short else [b, a]
        return pair, "the two largest open rims, from the longer to the shorter"
    if forward(vertices, faces, b.centre - a.centre) @ (b.centre - a.centre) < 0:
        a, b = b, a
    return [a, b], "the two largest open rims, from the fuller end of the part"


def _distance(vertices: Floats, end: End, point: Floats) -> float:
    """Distance of a point to a rim or to its centre, whichever is nearer."""
    ring = np.concatenate([end.centre[None], vertices[end.loop]])
    return float(np.linalg.norm(ring - point, axis=1).min())


def _largest_two(vertices: Floats, ends: list[End]) -> tuple[End, End]:
    """The two ends of the largest rims; of rims of equal size those furthest apart."""
    sizes = _sizes(vertices, ends)
    second = float(np.sort(sizes)[-2])
    larger = np.flatnonzero(sizes > second * (1.0 + _SAME_SIZE))
    alike = np.flatnonzero(np.abs(sizes - second) <= second * _SAME_SIZE)
    i, j = np.triu_indices(len(alike), 1)
    first, last = (np.full(len(alike), larger[0]), alike) if len(larger) else (alike[i], alike[j])
    centre = np.array([end.centre for end in ends])
    apart = np.linalg.norm(centre[first] - centre[last], axis=1)
    pair = _best(apart, centre[first] + centre[last])
    return ends[first[pair]], ends[last[pair]]


def _sizes(vertices: Floats, ends: list[End]) -> Floats:
    """Area enclosed by the rim of each end."""
    return np.array([loop_area(vertices, end.loop) for end in ends if end.loop is not None])


def _best(values: Floats, centres: Floats) -> int:
    """Index of the largest value; of equal ones, of that whose centre (3,) comes first in rank."""
    alike = np.flatnonzero(values >= values.max() * (1.0 - _SAME_SIZE))
    return int(alike[np.argmin(rank(centres[alike] - centres.mean(axis=0)))])


def _rims_along(vertices: Floats, ends: list[End], axis: Floats) -> list[End]:
    """The rims at the lower and the upper extreme of an axis; of several that are equally far out the largest."""
    height = np.array([end.centre @ axis for end in ends])
    size, centres = _sizes(vertices, ends), np.array([end.centre for end in ends])
    slack = _SAME_HEIGHT * np.ptp(vertices @ axis)
    low = _best(np.where(height <= height.min() + slack, size, -1.0), centres)
    rest = np.arange(len(ends)) != low
    high = _best(np.where(rest & (height >= height[rest].max() - slack), size, -1.0), centres)
    level = abs(height[low] - height[high]) <= _SAME_SIZE * slack
    upward = float(rank(centres[high] - centres[low])) > 0 if level else height[high] > height[low]
    return [ends[low], ends[high]] if upward else [ends[high], ends[low]]


def _one_rim(vertices: Floats, faces: Ints, loop: Ints, request: EndsRequest) -> tuple[list[End], str]:
    rim = End(loop_centroid(vertices, loop), loop)
    away = vertices.mean(axis=0) - rim.centre
    if request.points is not None:
        feet = [nearest(vertices, faces, point) for point in request.points]
        to_rim = [_distance(vertices, rim, point) for point in request.points]
        to_foot = [float(np.linalg.norm(foot - point)) for foot, point in zip(feet, request.points, strict=True)]
        if to_rim[0] + to_foot[1] <= to_rim[1] + to_foot[0]:
            return [rim, End(feet[1])], "the open rim, and a pole at the second point"
        return [End(feet[0]), rim], "a pole at the first point, and the open rim"
    if request.axis is not None:
        direction = request.axis if request.axis @ away >= 0 else -request.axis
        other = _closed_end(vertices, faces, direction)
        below = rim.centre @ request.axis <= other.centre @ request.axis
        return [rim, other] if below else [other, rim], f"the open rim and the pole across it along {request.text}"
    normal = loop_area_vector(vertices, loop)
    direction = normal / np.linalg.norm(normal) * (1.0 if normal @ away >= 0 else -1.0)
    return [rim, _closed_end(vertices, faces, direction)], "the open rim, and the pole across it"


def _closed_end(vertices: Floats, faces: Ints, direction: Floats) -> End:
    centre, lip = extreme(vertices, faces, direction)
    return End(centre, lip=lip, outward=direction)


def _two_poles(vertices: Floats, faces: Ints, request: EndsRequest) -> tuple[list[End], str]:
    if request.points is not None:
        a, b = (End(nearest(vertices, faces, point)) for point in request.points)
        return [a, b], "poles at the given points"
    if request.axis is not None:
        axis, words = request.axis, f"poles on the {request.text} axis"
    else:
        axis, kind = longest_axis(vertices, faces)
        axis, words = forward(vertices, faces, axis), f"poles on {kind}"
    return [_closed_end(vertices, faces, sign * axis) for sign in (-1.0, 1.0)], words
