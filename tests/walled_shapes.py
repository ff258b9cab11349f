"""Parts with a wall, turned about z from a profile: which face is of which skin is known."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.mesh.geometry.topology import loops

OUTER, RIM, INNER = 1, 0, -1
"""What a face, or a stretch of a profile, belongs to."""

Stretch = tuple[float, float, int]
"""A corner (r, z) of a profile, and what the stretch from there to the next corner belongs to."""


@dataclass(frozen=True)
class Walled:
    """Vertices (n, 3), faces (m, 3), and the skin (m,) of each face."""

    vertices: Floats
    faces: Ints
    skin: Ints

    def moved(self, place: Callable[[Floats], Floats]) -> "Walled":
        return replace(self, vertices=place(self.vertices))

    def shuffled(self, seed: int = 0) -> "Walled":
        """With vertices, faces and corners in another order."""
        rng = np.random.default_rng(seed)
        order, mixed = rng.permutation(len(self.vertices)), rng.permutation(len(self.faces))
        turn = (rng.integers(3, size=len(self.faces))[:, None] + np.arange(3)) % 3
        faces = np.take_along_axis(np.argsort(order)[self.faces], turn, 1)
        return Walled(self.vertices[order], faces[mixed], self.skin[mixed])

    def area(self, skin: int) -> float:
        a, b, c = self.vertices[self.faces[self.skin == skin]].transpose(1, 0, 2)
        return float(0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1).sum())


@dataclass(frozen=True)
class Grid:
    """How finely a part is meshed: vertices around, and the longest edge along the profile.

    uneven: share of a step by which vertices are off their place at random, along creases but never across them.
    """

    around: int = 48
    step: float = 4.0
    uneven: float = 0.0


GRID = Grid()


def revolved(profile: Sequence[Stretch], grid: Grid = GRID) -> Walled:
    """The part of a profile that runs up the outside and back inside; closed, unless it starts and ends on the axis."""
    around, step, uneven = grid.around, grid.step, grid.uneven
    corners = np.array([corner[:2] for corner in profile])
    closed = corners[0, 0] > 0.0
    stretches = len(corners) if closed else len(corners) - 1
    points, skins, creased = [], [], []
    for k in range(stretches):
        a, b = corners[k], corners[(k + 1) % len(corners)]
        parts = max(1, int(np.ceil(np.linalg.norm(b - a) / step - 1e-9)))
        points.append(a + np.linspace(0.0, 1.0, parts + 1)[:-1, None] * (b - a))
        skins += [profile[k][2]] * parts
        creased += [True] + [False] * (parts - 1)
    rows = np.concatenate(points)
    ends = [] if closed else [corners[0], corners[-1]]
    if not closed:
        rows, creased = rows[1:], creased[1:]
    rng = np.random.default_rng(len(rows))
    turn = np.tile(np.arange(around) / around, (len(rows), 1))
    turn = turn + uneven * rng.uniform(-0.5, 0.5, turn.shape) / around
    before, after = np.roll(rows, 1, axis=0), np.roll(rows, -1, axis=0)
    if not closed:
        before[0], after[-1] = ends
    shift = uneven * rng.uniform(-0.5, 0.5, turn.shape) * ~np.array(creased)[:, None]
    place = rows[:, None] + np.maximum(shift, 0)[:, :, None] * (after - rows)[:, None]
    place = place + np.minimum(shift, 0)[:, :, None] * (rows - before)[:, None]
    angle = 2.0 * np.pi * turn
    vertices = np.stack([place[..., 0] * np.cos(angle), place[..., 0] * np.sin(angle), place[..., 1]], axis=-1)
    index = np.arange(len(rows) * around).reshape(len(rows), around)
    low = index if closed else index[:-1]
    high = np.roll(index, -1, axis=0) if closed else index[1:]
    quads = np.stack([low, np.roll(low, -1, axis=1), np.roll(high, -1, axis=1), high], axis=-1).reshape(-1, 4)
    flat = vertices.reshape(-1, 3)
    across = np.linalg.norm(flat[quads[:, :2]] - flat[quads[:, 2:]], axis=2)
    quads = np.where((across[:, 0] > 1.001 * across[:, 1])[:, None], np.roll(quads, 1, axis=1), quads)
    faces = quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)
    of_row = np.array(skins if closed else skins[1:-1])
    skin = np.repeat(of_row, 2 * around)
    if closed:
        return Walled(flat, faces, skin)
    ring, n = index[[0, -1]], len(flat)
    first = np.column_stack([np.roll(ring[0], -1), ring[0], np.full(around, n)])
    last = np.column_stack([ring[1], np.roll(ring[1], -1), np.full(around, n + 1)])
    poles = np.array([[0.0, 0.0, ends[0][1]], [0.0, 0.0, ends[1][1]]])
    return Walled(np.concatenate([flat, poles]), np.concatenate([faces, first, last]),
                  np.concatenate([skin, np.full(around, skins[0]), np.full(around, skins[-1])]))  # fmt: skip


def arc(
    middle: tuple[float, float], radius: float, start: float, end: float, skin: int, parts: int = 6
) -> list[Stretch]:
    """Corners of an arc of a profile, angles in degrees from the r axis; its end is the next stretch's first corner."""
    turn = np.radians(np.linspace(start, end, parts + 1))[:-1]
    return [(middle[0] + radius * float(np.cos(t)), middle[1] + radius * float(np.sin(t)), skin) for t in turn]


def bent(radius: float) -> Callable[[Floats], Floats]:
    """Bend the z axis to an arc of this radius about the y axis."""

    def place(points: Floats) -> Floats:
        turn = points[:, 2] / radius
        reach = radius - points[:, 0]
        return np.column_stack([radius - reach * np.cos(turn), points[:, 1], reach * np.sin(turn)])

    return place


def slanted(bottom: float, top: float, height: float) -> Callable[[Floats], Floats]:
    """Slant the ends of a part from z = 0 to `height`, in degrees."""

    def place(points: Floats) -> Floats:
        share = points[:, 2] / height
        rise = (1.0 - share) * np.tan(np.radians(bottom)) + share * np.tan(np.radians(top))
        return points + np.column_stack([0 * share, 0 * share, points[:, 0] * rise])

    return place


def pipe(radius: float = 30.0, wall: float = 3.0, height: float = 120.0, grid: Grid = GRID) -> Walled:
    return revolved(
        [(radius, 0, OUTER), (radius, height, RIM), (radius - wall, height, INNER), (radius - wall, 0, RIM)], grid
    )


def chamfered(
    radius: float = 30.0, wall: float = 4.0, height: float = 120.0, cut: float = 1.5, grid: Grid = GRID
) -> Walled:
    r, w, h, c = radius, wall, height, cut
    return revolved(
        [
            (r, c, OUTER),
            (r, h - c, RIM),
            (r - c, h, RIM),
            (r - w + c, h, RIM),
            (r - w, h - c, INNER),
            (r - w, c, RIM),
            (r - w + c, 0, RIM),
            (r - c, 0, RIM),
        ],
        grid,
    )


def filleted(
    radius: float = 30.0, wall: float = 6.0, height: float = 120.0, fillet: float = 2.0, grid: Grid = GRID
) -> Walled:
    r, w, h, f = radius, wall, height, fillet
    return revolved(
        [
            (r, f, OUTER),
            *arc((r - f, h - f), f, 0, 90, RIM),
            *arc((r - w + f, h - f), f, 90, 180, RIM),
            (r - w, h - f, INNER),
            *arc((r - w + f, f), f, 180, 270, RIM),
            *arc((r - f, f), f, 270, 360, RIM),
        ],
        grid,
    )


def flanged(
    radius: float = 30.0,
    wall: float = 3.0,
    height: float = 120.0,
    width: float = 15.0,
    thick: float = 8.0,
    grid: Grid = GRID,
) -> Walled:
    r, w, h, f, b = radius, wall, height, radius + width, thick
    return revolved(
        [
            (f, 0, OUTER),
            (f, b, OUTER),
            (r, b, OUTER),
            (r, h - b, OUTER),
            (f, h - b, OUTER),
            (f, h, RIM),
            (r - w, h, INNER),
            (r - w, 0, RIM),
        ],
        grid,
    )


def stepped(wall: float = 3.0, grid: Grid = GRID) -> Walled:
    w = wall
    return revolved(
        [
            (30, 0, OUTER),
            (30, 50, OUTER),
            (40, 60, OUTER),
            (40, 120, RIM),
            (40 - w, 120, INNER),
            (40 - w, 60 + w * 0.4, INNER),
            (30 - w, 50 + w * 0.4, INNER),
            (30 - w, 0, RIM),
        ],
        grid,
    )


def bottle(wall: float = 2.0, grid: Grid = GRID) -> Walled:
    w = wall
    return revolved(
        [
            (0, 0, OUTER),
            (30, 0, OUTER),
            (35, 5, OUTER),
            (35, 80, OUTER),
            (12, 110, OUTER),
            (12, 130, RIM),
            (12 - w, 130, INNER),
            (12 - w, 110 - 0.35 * w, INNER),
            (35 - w, 80 - 0.35 * w, INNER),
            (35 - w, 5, INNER),
            (30, w, INNER),
            (0, w, INNER),
        ],
        grid,
    )


def nozzle(grid: Grid = GRID) -> Walled:
    """Round outside, narrow and wide inside: the wall is 2 to 22 thick."""
    return revolved([(30, 0, OUTER), (30, 100, RIM), (25, 100, INNER), (8, 45, INNER), (8, 40, INNER), (28, 0, RIM)],
                    grid)  # fmt: skip


def vessel(wall: float = 2.0, grid: Grid = GRID) -> Walled:
    """A drum with round ends and a neck at each."""

    def meridian(radius: float, neck: float, skin: int) -> list[Stretch]:
        low, high = float(np.arcsin(neck / radius)), 0.5 * np.pi
        lower = [(radius * np.sin(t), 50.0 - radius * np.cos(t), skin) for t in np.linspace(low, high, 9)]
        upper = [(r, 200.0 - z, skin) for r, z, _ in lower[::-1]]
        return [(float(r), float(z), s) for r, z, s in [*lower, *upper]]

    outside, inside = meridian(50.0, 12.0, OUTER), meridian(50.0 - wall, 12.0 - wall, INNER)[::-1]
    return revolved([(12.0, -15.0, OUTER), *outside, (12.0, 215.0, RIM),
                     (12.0 - wall, 215.0, INNER), *inside, (12.0 - wall, -15.0, RIM)], grid)  # fmt: skip


def squared(points: Floats) -> Floats:
    """Make circles about z squares: the radius is that of the circle within."""
    turn = np.arctan2(points[:, 1], points[:, 0])
    stretch = 1.0 / np.maximum(np.abs(np.cos(turn)), np.abs(np.sin(turn)))
    return points * np.column_stack([stretch, stretch, np.ones(len(points))])


def blob(grid: Grid = GRID) -> Walled:
    """A closed solid without a wall, fuller below."""
    return revolved([(0, 0, OUTER), (25, 0, OUTER), (35, 20, OUTER), (20, 120, OUTER), (0, 120, OUTER)], grid)


def tunnelled(part: Walled, height: float, width: float, turn: float = 0.0) -> Walled:
    """A closed solid with a tunnel, about square and `width` wide, through its axis at a height, at an angle about it.

    The faces within twice the width are left out at both ends, and the vertices about the gap are drawn together.
    """
    vertices, faces = part.vertices.copy(), part.faces
    middle = np.repeat(vertices[faces].mean(axis=1).reshape(-1, 2, 3).mean(axis=1), 2, axis=0)  # of pairs: quads
    along = np.array([np.cos(turn), np.sin(turn), 0.0])
    gone, rims = np.zeros(len(faces), dtype=bool), []
    for sense in (1.0, -1.0):
        off = middle - [0.0, 0.0, height]
        beside = off - np.outer(off @ along, along)
        patch = np.abs(beside).max(axis=1) < max(width, 1.01 * np.abs(beside).max(axis=1).min())
        patch &= sense * (off @ along) > 0.0
        gone |= patch
        rims.append(loops(faces[patch])[0])
    for rim in rims:
        centre = vertices[rim].mean(axis=0)
        vertices[rim] = centre + 0.5 * width * (vertices[rim] - centre) / np.abs(vertices[rim] - centre).max()
    first, second = rims[0], rims[1][::-1]
    second = np.roll(second, -int(np.argmin(np.linalg.norm(vertices[second] - vertices[first[0]], axis=1))))
    following, beyond = np.roll(first, -1), np.roll(second, -1)
    walls = np.concatenate([np.column_stack([first, following, second]), np.column_stack([following, beyond, second])])
    return Walled(vertices, np.concatenate([faces[~gone], walls]),
                  np.concatenate([part.skin[~gone], np.full(len(walls), OUTER)]))  # fmt: skip
