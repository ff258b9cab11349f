"""Small parts with known shapes, as arrays of vertices and faces."""

from collections.abc import Callable

import numpy as np
import trimesh

from meshwind.core.cast import Floats, Ints
from meshwind.mesh import Annulus
from meshwind.mesh.geometry.topology import edges, euler, loops, patches

Part = tuple[Floats, Ints]


def ball(subdivisions: int = 3) -> Part:
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions)
    return np.asarray(mesh.vertices, dtype=np.float64), np.asarray(mesh.faces, dtype=np.int64)


def pear(subdivisions: int = 3) -> Part:
    """Closed, with three different axes, its long one z, and fuller below than above."""
    vertices, faces = ball(subdivisions)
    x, y, z = vertices.T
    slim = 1.0 - 0.35 * z
    return np.column_stack([1.2 * slim * x + 0.1 * z**2, slim * y, 2.5 * z]), faces


def tube(radius: Callable[[Floats], Floats], height: float = 3.0, around: int = 24, along: int = 12) -> Part:
    """Open at both ends, about z from 0 to `height`, faces outward."""
    z = np.repeat(np.linspace(0.0, height, along + 1), around)
    turn = np.tile(np.arange(around) * 2 * np.pi / around, along + 1)
    vertices = np.column_stack([radius(z) * np.cos(turn), radius(z) * np.sin(turn), z])
    low = np.arange(along * around)
    right = low // around * around + (low + 1) % around
    lower, upper = np.column_stack([low, right, right + around]), np.column_stack([low, right + around, low + around])
    return vertices, np.concatenate([lower, upper])


def cone(**sizes: int) -> Part:
    """A tube whose rim at z = 0 is the longer."""
    return tube(lambda z: 1.0 - 0.1 * z, **sizes)


def box(low: tuple[float, float, float] = (0, 0, 0), size: tuple[float, float, float] = (1, 1, 1)) -> Part:
    mesh = trimesh.creation.box(size)
    return np.asarray(mesh.vertices) + np.array(low) + np.array(size) / 2, np.asarray(mesh.faces, dtype=np.int64)


def joined(*parts: Part) -> Part:
    starts = np.cumsum([0] + [len(vertices) for vertices, _ in parts])
    faces = [triangles + start for (_, triangles), start in zip(parts, starts[:-1], strict=True)]
    return np.concatenate([vertices for vertices, _ in parts]), np.concatenate(faces)


def shuffled(part: Part, seed: int = 0) -> Part:
    """The same part with its vertices, faces and corners in another order."""
    rng = np.random.default_rng(seed)
    vertices, faces = part
    order = rng.permutation(len(vertices))
    position = np.argsort(order)
    turn = (rng.integers(3, size=len(faces))[:, None] + np.arange(3)) % 3
    return vertices[order], np.take_along_axis(position[faces], turn, 1)[rng.permutation(len(faces))]


def rotation(seed: int = 0) -> Floats:
    matrix = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return np.asarray(matrix * np.sign(np.linalg.det(matrix)))


def assert_annulus(found: Annulus) -> None:
    """One oriented piece with Euler characteristic 0, and rims that are its loops in the sense of growing u."""
    faces = found.faces
    assert np.array_equal(np.unique(faces), np.arange(len(found.vertices)))
    assert edges(faces).count.max() == 2
    assert not patches(faces).any() and euler(faces) == 0
    assert len(found.trusted) == len(found.vertices) and np.isfinite(found.vertices).all()
    half = {(int(a), int(b)) for k in range(3) for a, b in faces[:, [k, (k + 1) % 3]]}
    assert len(half) == 3 * len(faces)  # no edge is run twice in one sense
    start, end = found.rims
    assert sorted(map(len, loops(faces))) == sorted(map(len, found.rims))
    for a, b in zip(start, np.roll(start, -1), strict=True):
        assert (int(a), int(b)) in half and (int(b), int(a)) not in half
    for a, b in zip(end, np.roll(end, -1), strict=True):
        assert (int(b), int(a)) in half and (int(a), int(b)) not in half


def moved(part: Part, matrix: Floats, shift: Floats, scale: float) -> Part:
    return scale * part[0] @ matrix.T + shift, part[1]


def cup() -> Part:
    """A cup: a closed wall 0.1 thick, mouth up at z = 3, lining down to z = 0.1."""
    outer, lining = tube(lambda z: 1.0 + 0 * z, 3.0), tube(lambda z: 0.9 + 0 * z, 2.9)
    vertices, faces = joined(outer, (lining[0] + [0, 0, 0.1], lining[1][:, ::-1]))
    n, size = 24, len(outer[0])
    ring = np.arange(n)
    out, inn = size - n + ring, len(vertices) - n + ring
    following = np.roll(ring, -1)
    lip = np.column_stack([out, out[following], inn]), np.column_stack([out[following], inn[following], inn])
    floor, bottom = size + ring, len(vertices)
    discs = np.concatenate([
        np.column_stack([ring[following], ring, np.full(n, bottom)]),
        np.column_stack([floor, floor[following], np.full(n, bottom + 1)]),
    ])  # fmt: skip
    centres = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, 0.1]])
    return np.concatenate([vertices, centres]), np.concatenate([faces, *lip, discs])
