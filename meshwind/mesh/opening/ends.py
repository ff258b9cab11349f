"""Choose the two ends of a part: open rims, or poles to be opened."""

import re
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats, Ints, floats
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import loop_area_vector, loop_centroid, perimeter
from meshwind.mesh.geometry.axis import forward, longest_axis, rank
from meshwind.mesh.opening.holes import loop_size
from meshwind.mesh.opening.poles import Lip, extreme, nearest

_ALIKE = 1e9  # lengths are equal that agree to this many parts
_AXES = {"x": 0, "y": 1, "z": 2}
_ALIKE_SIZE = 1e-3  # sizes and distances that differ by less than this part are equal
_NEAR_EXTREME = 0.05  # rims within this part of the extent are equally far out


@dataclass(frozen=True)
class End:
    """One end: its centre (3,), and the loop of its rim or its lip; with neither the centre is a pole.

    diagonal: of the part, which says how many digits of a place mean something.
    """

    centre: Floats
    loop: Ints | None = None
    lip: Lip | None = None
    diagonal: float = 1.0

    @property
    def is_pole(self) -> bool:
        """Whether an opening has to be cut here."""
        return self.loop is None and self.lip is None

    @property
    def place(self) -> str:
        """Coordinates of the centre, as text."""
        return place(self.centre, self.diagonal)


def place(point: Floats | tuple[float, ...], diagonal: float) -> str:
    """Coordinates of a point as text, to a 10,000th of the part's diagonal or finer: no round-off, no 1e+08 twice."""
    digits = 5 - int(np.ceil(np.log10(diagonal)))
    return "(" + ", ".join(f"{round(float(x), digits) + 0.0:.12g}" for x in point) + ")"


@dataclass(frozen=True)
class Wish:
    """Where the ends are wanted: along a model axis (3,), at two points (2, 3), at two numbered rims, or anywhere."""

    axis: Floats | None = None
    points: Floats | None = None
    loops: tuple[int, int] | None = None
    text: str = "auto"


def parse(text: str) -> Wish:
    """Understand 'auto', 'x', 'y', 'z', 'x,y,z x,y,z' or 'loops i j'; anything else raises BadInputError."""
    word = text.strip().lower() if isinstance(text, str) else ""
    if word == "auto":
        return Wish()
    if word in _AXES:
        return Wish(axis=np.eye(3)[_AXES[word]], text=word)
    numbers = re.fullmatch(r"loops\s+(\d{1,9})[\s,]+(\d{1,9})", word)
    if numbers is not None:
        if int(numbers[1]) == int(numbers[2]):
            raise BadInputError(f"ends {text!r}: both are the same rim; give two numbers that `meshwind check` lists")
        return Wish(loops=(int(numbers[1]), int(numbers[2])), text=word)
    try:
        points = floats([[float(x) for x in part.split(",")] for part in word.split()], "ends", 2, 3)
    except ValueError as error:
        raise BadInputError(
            f"ends {text!r}: give auto, x, y, z or two points as in '0,0,0 0,0,100', or two open rims as in 'loops 0 1'"
        ) from error
    if (points[0] == points[1]).all():
        raise BadInputError(f"ends {text!r}: the two points are the same; give one at each end of the part")
    return Wish(points=points, text=word)


def numbered(vertices: Floats, rims: list[Ints]) -> list[Ints]:
    """Boundary loops in the order of their numbers: from the longest to the shortest, alike ones as in the file."""
    length = np.array([perimeter(vertices, loop) for loop in rims])
    order = (
        np.argsort(-np.round(_ALIKE * length / length.max()), kind="stable") if rims else np.empty(0, dtype=np.int64)
    )
    return [rims[k] for k in order]


def choose(vertices: Floats, faces: Ints, rims: list[Ints], wish: Wish) -> tuple[list[End], str]:
    """The start and the end of a part with the given boundary loops, and in words how they were chosen.

    Where the wish names loops by number, `rims` holds just those two.
    """
    pair, words = _choose(vertices, faces, rims, wish)
    diagonal = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    return [replace(end, diagonal=diagonal) for end in pair], words


def _choose(vertices: Floats, faces: Ints, rims: list[Ints], wish: Wish) -> tuple[list[End], str]:
    ends = [End(loop_centroid(vertices, loop), loop) for loop in rims]
    if wish.loops is not None:
        return ends, f"the open rims number {wish.loops[0]} and {wish.loops[1]}"
    if len(ends) >= 2:
        return _two_rims(vertices, faces, ends, wish)
    return _one_rim(vertices, faces, rims[0], wish) if rims else _two_poles(vertices, faces, wish)


def _two_rims(vertices: Floats, faces: Ints, ends: list[End], wish: Wish) -> tuple[list[End], str]:
    if wish.points is not None:
        away = np.array([[_distance(vertices, end, point) for end in ends] for point in wish.points])
        total = away[0][:, None] + away[1] + np.diag(np.full(len(ends), np.inf))
        first, second = np.unravel_index(np.argmin(total), total.shape)
        return [ends[first], ends[second]], "the open rims nearest to the given points"
    if wish.axis is not None:
        return _rims_along(vertices, ends, wish.axis), f"the open rims furthest out along {wish.text}"
    a, b = _largest_two(vertices, ends)
    long, short = (perimeter(vertices, end.loop) for end in (a, b) if end.loop is not None)
    if abs(long - short) > _ALIKE_SIZE * max(long, short):
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
    """The two ends of the largest rims; of rims alike in size those furthest apart."""
    sizes = _sizes(vertices, ends)
    second = float(np.sort(sizes)[-2])
    larger = np.flatnonzero(sizes > second * (1.0 + _ALIKE_SIZE))
    alike = np.flatnonzero(np.abs(sizes - second) <= second * _ALIKE_SIZE)
    i, j = np.triu_indices(len(alike), 1)
    first, last = (np.full(len(alike), larger[0]), alike) if len(larger) else (alike[i], alike[j])
    centre = np.array([end.centre for end in ends])
    apart = np.linalg.norm(centre[first] - centre[last], axis=1)
    pair = _best(apart, centre[first] + centre[last])
    return ends[first[pair]], ends[last[pair]]


def _sizes(vertices: Floats, ends: list[End]) -> Floats:
    """Area that each end's rim encloses."""
    return np.array([loop_size(vertices, end.loop) for end in ends if end.loop is not None])


def _best(values: Floats, places: Floats) -> int:
    """Number of the largest value; of those about as large, the one whose place (3,) comes first in rank."""
    alike = np.flatnonzero(values >= values.max() * (1.0 - _ALIKE_SIZE))
    return int(alike[np.argmin(rank(places[alike] - places.mean(axis=0)))])


def _rims_along(vertices: Floats, ends: list[End], axis: Floats) -> list[End]:
    """The rims at the lower and at the upper extreme of an axis, the larger one where several are that far out."""
    height = np.array([end.centre @ axis for end in ends])
    size, places = _sizes(vertices, ends), np.array([end.centre for end in ends])
    slack = _NEAR_EXTREME * np.ptp(vertices @ axis)
    low = _best(np.where(height <= height.min() + slack, size, -1.0), places)
    rest = np.arange(len(ends)) != low
    high = _best(np.where(rest & (height >= height[rest].max() - slack), size, -1.0), places)
    level = abs(height[low] - height[high]) <= _ALIKE_SIZE * slack
    upward = float(rank(places[high] - places[low])) > 0 if level else height[high] > height[low]
    return [ends[low], ends[high]] if upward else [ends[high], ends[low]]


def _one_rim(vertices: Floats, faces: Ints, loop: Ints, wish: Wish) -> tuple[list[End], str]:
    rim = End(loop_centroid(vertices, loop), loop)
    away = vertices.mean(axis=0) - rim.centre
    if wish.points is not None:
        feet = [nearest(vertices, faces, point) for point in wish.points]
        to_rim = [_distance(vertices, rim, point) for point in wish.points]
        to_foot = [float(np.linalg.norm(foot - point)) for foot, point in zip(feet, wish.points, strict=True)]
        if to_rim[0] + to_foot[1] <= to_rim[1] + to_foot[0]:
            return [rim, End(feet[1])], "the open rim, and a pole at the second point"
        return [End(feet[0]), rim], "a pole at the first point, and the open rim"
    if wish.axis is not None:
        direction = wish.axis if wish.axis @ away >= 0 else -wish.axis
        other = _closed_end(vertices, faces, direction)
        below = rim.centre @ wish.axis <= other.centre @ wish.axis
        return [rim, other] if below else [other, rim], f"the open rim and the pole across it along {wish.text}"
    normal = loop_area_vector(vertices, loop)
    direction = normal / np.linalg.norm(normal) * (1.0 if normal @ away >= 0 else -1.0)
    return [rim, _closed_end(vertices, faces, direction)], "the open rim, and the pole across it"


def _closed_end(vertices: Floats, faces: Ints, direction: Floats) -> End:
    centre, lip = extreme(vertices, faces, direction)
    return End(centre, lip=lip)


def _two_poles(vertices: Floats, faces: Ints, wish: Wish) -> tuple[list[End], str]:
    if wish.points is not None:
        a, b = (End(nearest(vertices, faces, point)) for point in wish.points)
        return [a, b], "poles at the given points"
    if wish.axis is not None:
        axis, words = wish.axis, f"poles on the {wish.text} axis"
    else:
        axis, kind = longest_axis(vertices, faces)
        axis, words = forward(vertices, faces, axis), f"poles on {kind}"
    return [_closed_end(vertices, faces, sign * axis) for sign in (-1.0, 1.0)], words
