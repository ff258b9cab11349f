"""Symmetry that an edit keeps: rotations and reflections of a part's control net and of its vertices."""

import re
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import shortened
from meshwind.core.vectors import rotation
from meshwind.editing.feet import feet_of
from meshwind.editing.region import SAMPLES_PER_SPAN
from meshwind.editing.stencil import lattice
from meshwind.surface.surface import Surface

SAME_PLACE = 1e-6
"""Over the size: vertices that are no further from an image are it."""
EVEN = 0.9
"""Mean resultant of the turns of u by a mirror, 1 where it is one of the chart, below which it is none."""
MOST = 1024
"""Largest number of motions of a symmetry."""
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_PLANE = re.compile(rf"([xyz])(?:=({_NUMBER}))?", re.IGNORECASE)
_ADVICE = (
    'give planes by commas: x, y or z through the middle, x=12.5 at a place, or four numbers "a b c d" for ax+by+cz=d'
)


@dataclass(frozen=True)
class Plane:
    """A mirror plane: its unit normal, and how far along that it is, None for the middle of the part."""

    normal: tuple[float, float, float]
    at: float | None

    @property
    def matrix(self) -> Floats:
        """The reflection of directions (3, 3)."""
        return np.eye(3) - 2.0 * np.outer(self.normal, self.normal)

    def images(self, points: Floats, middle: Floats) -> Floats:
        """Points (k, 3) reflected."""
        at = float(middle @ np.array(self.normal)) if self.at is None else self.at
        return np.asarray(points - 2.0 * ((points @ np.array(self.normal)) - at)[:, None] * np.array(self.normal))


def planes(text: str | None) -> tuple[Plane, ...]:
    """Understand mirror planes, separated by commas; raises BadInputError for anything else."""
    if text is None:
        return ()
    return tuple(_plane(term.strip(), text) for term in text.split(","))


def _plane(term: str, text: str) -> Plane:
    found = _PLANE.fullmatch(term.replace(" ", ""))
    if found is not None:
        x, y, z = (float(name == found[1].lower()) for name in "xyz")
        return Plane((x, y, z), None if found[2] is None else float(found[2]))
    words = term.split()
    if len(words) == 4 and all(re.fullmatch(_NUMBER, word, re.IGNORECASE) for word in words):
        values = np.array([float(word) for word in words])
        size = float(np.linalg.norm(values[:3]))
        if size > 0.0:
            a, b, c = (float(x) for x in values[:3] / size)
            return Plane((a, b, c), float(values[3]) / size)
    raise BadInputError(f"mirror is {shortened(repr(text))}; {_ADVICE}")


@dataclass(frozen=True)
class Group:
    """Motions that are kept: the image (g, m) of each of m points, and the matrices (g, 3, 3) of directions."""

    images: Ints
    matrices: Floats

    def any_of(self, marked: Bools) -> Bools:
        """Mask (m,) of the points of which one that they are moved to is marked."""
        return np.asarray(marked[self.images].any(axis=0))

    def least_of(self, values: Floats) -> Floats:
        """The least value (m,) of the points that each is moved to."""
        return np.asarray(values[self.images].min(axis=0))

    def mean(self, moves: Floats) -> Floats:
        """The nearest moves (m, 3) that are symmetric."""
        return np.asarray(np.einsum("gji,gmj->mi", self.matrices, moves[self.images]) / len(self.images))


def group_of(generators: Sequence[tuple[Ints, Floats]], count: int) -> Group:
    """All motions of `count` points that follow from some, each as the points' images (m,) and a matrix (3, 3)."""
    found = {np.arange(count).tobytes(): (np.arange(count), np.eye(3))}
    last = list(found.values())
    while last:
        now = []
        for images, matrix in last:
            for by, turn in generators:
                composed, turned = by[images], turn @ matrix
                known = found.setdefault(composed.tobytes(), (composed, turned))
                if np.abs(known[1] - turned).max() > 1e-9:
                    raise BadInputError(
                        "symmetry and mirror do not go together: give one of them, or planes along the axis"
                    )
                if known[1] is turned:
                    now.append((composed, turned))
        last = now
        if len(found) > MOST:
            raise BadInputError(f"symmetry has more than {MOST} motions; give a lower order or fewer mirror planes")
    return Group(np.array([images for images, _ in found.values()]), np.array([turn for _, turn in found.values()]))


@dataclass(frozen=True)
class Reflected:
    """What a mirror plane makes of a surface's parameters: u to sign * u + turn, and v to 1 - v if it is flipped."""

    sign: int
    turn: float
    flipped: bool


def reflected(surface: Surface, plane: Plane, middle: Floats) -> Reflected:
    """Find that; raises BadInputError where the surface is far from its image."""
    uv = lattice(surface, SAMPLES_PER_SPAN)
    uv = uv[np.abs(uv[:, 1] - 0.5) < 0.45]
    points = surface.points(uv)
    images = plane.images(points, middle)
    to = feet_of(surface, images, uv[cKDTree(points).query(images)[1]])
    flipped = bool(np.corrcoef(uv[:, 1], to[:, 1])[0, 1] < 0.0)
    sums = {sign: np.exp(2j * np.pi * (to[:, 0] - sign * uv[:, 0])).mean() for sign in (1, -1)}
    sign = max(sums, key=lambda each: abs(sums[each]))
    if abs(sums[sign]) < EVEN:
        raise BadInputError(f"mirror plane {plane.normal} is far from mapping the part to itself; {_ADVICE}")
    return Reflected(sign, float(np.angle(sums[sign]) / (2.0 * np.pi)), flipped)


def net_group(surface: Surface, order: int, mirrors: Sequence[Plane], middle: Floats | None = None) -> Group:
    """The motions of a control net (nu, nv), whose points are counted along v first; middle: of the part."""
    nu, nv = surface.control_points.shape[:2]
    _check_order(surface, order)
    middle = surface.control_points.reshape(-1, 3).mean(axis=0) if middle is None else middle
    row, column = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    generators = []
    maps = [reflected(surface, plane, middle) for plane in mirrors]
    if order > 1:
        turn = _turn(surface, order, [(plane, each) for plane, each in zip(mirrors, maps, strict=True)])
        generators.append((((row + nu // order) % nu * nv + column).ravel(), turn))
    for plane, each in zip(mirrors, maps, strict=True):
        shift = round(each.turn * nu)
        if each.sign < 0 and abs(each.turn * nu - shift) > 0.25:
            raise BadInputError(
                f"mirror plane {plane.normal} lies between rows of the control net with {nu} points around; "
                "give another tolerance, or one plane"
            )
        rows = (2 - row if each.sign < 0 else row) + shift  # a row's spline is centred one knot before it
        columns = nv - 1 - column if each.flipped else column
        generators.append(((rows % nu * nv + columns).ravel(), plane.matrix))
    return group_of(generators, nu * nv)


def _check_order(surface: Surface, order: int) -> None:
    nu = surface.control_points.shape[0]
    if not isinstance(order, int | np.integer) or order < 1 or not surface.periodic or nu % order:
        fit = ", ".join(str(k) for k in range(1, nu + 1) if nu % k == 0) if surface.periodic else "1"
        raise BadInputError(f"symmetry {order} does not fit the control net with {nu} points around; give one of {fit}")


def _turn(surface: Surface, order: int, mirrors: Sequence[tuple[Plane, Reflected]]) -> Floats:
    """The rotation (3, 3) by a share of a turn of u, about the axis through the centres of the net's rows."""
    net = surface.control_points
    rings, axis = net.mean(axis=0), axis_of(surface)
    for plane, each in mirrors:  # so that they go together
        along = float(axis @ np.array(plane.normal)) * np.array(plane.normal)
        axis = along if each.flipped else axis - along
    axis /= np.linalg.norm(axis)
    shifted, centred = np.roll(net - rings, -(net.shape[0] // order), axis=0), net - rings
    both = [rotation(axis, sense * 2.0 * np.pi / order) for sense in (1, -1)]
    return min(both, key=lambda turn: float(np.abs(centred @ turn.T - shifted).sum()))


def axis_of(surface: Surface) -> Floats:
    """Direction (3,) of the axis through the centres of the rows of control points."""
    rings = surface.control_points.mean(axis=0)
    return np.asarray(np.linalg.svd(rings - rings.mean(axis=0))[2][0])


def mesh_group(vertices: Floats, order: int, mirrors: Sequence[Plane], axis: Floats) -> Group | None:
    """The motions of the vertices (n, 3) of a mesh that is symmetric itself; None for any other.

    axis: about that of the part, for rotations.
    """
    middle = vertices.mean(axis=0)
    generators = []
    if order > 1:
        directions = np.linalg.eigh(np.cov((vertices - middle).T))[1].T
        near = directions[int(np.argmax(np.abs(directions @ axis)))]
        turn = rotation(near, 2.0 * np.pi / order)
        images = _images(vertices, (vertices - middle) @ turn.T + middle)
        if images is None:
            return None
        generators.append((images, turn))
    for plane in mirrors:
        images = _images(vertices, plane.images(vertices, middle))
        if images is None:
            return None
        generators.append((images, plane.matrix))
    return group_of(generators, len(vertices)) if generators else None


def _images(vertices: Floats, moved: Floats) -> Ints | None:
    """The vertices (n,) at which moved ones lie; None where one lies at none."""
    distance, images = cKDTree(vertices).query(moved)
    size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
    sound = distance.max() <= SAME_PLACE * size and len(np.unique(images)) == len(vertices)
    return np.asarray(images) if sound else None
