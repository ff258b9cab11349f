"""A corpus of broken meshes: one fault each, and several together.

Run as a script it writes every mesh as OBJ into the folder it is given.
"""

import sys
from collections.abc import Callable, Iterator
from itertools import combinations
from pathlib import Path

import numpy as np
import trimesh
from mesh_shapes import Part, ball, box, cone, cup, joined, moved, pear, rotation, tube

from meshwind.core.cast import Floats, Ints

Fault = Callable[[Part], Part]


def rng(part: Part) -> np.random.Generator:
    """The same numbers for the same part in every run."""
    return np.random.default_rng(len(part[1]))


def some(part: Part, share: float) -> Ints:
    """A random choice of faces."""
    return np.sort(rng(part).choice(len(part[1]), max(1, int(share * len(part[1]))), replace=False))


def grid(points: Floats, turned: bool = False, rows_closed: bool = True) -> Part:
    """Quadrangles between the rows and columns of points (r, c, 3), closed along rows and columns.

    turned: the last row meets the first one in reverse, as on a Klein bottle.
    """
    rows, columns = points.shape[:2]
    index = np.arange(rows * columns).reshape(rows, columns)
    last = index[:1, ::-1] if turned else index[:1]
    index = np.concatenate([index, last] if rows_closed else [index])
    a, b = index[:-1].ravel(), index[1:].ravel()
    c, d = np.roll(index, -1, axis=1)[1:].ravel(), np.roll(index, -1, axis=1)[:-1].ravel()
    return points.reshape(-1, 3), np.concatenate([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def torus(around: int = 32, across: int = 12) -> Part:
    u, v = np.meshgrid(*(np.arange(n) / n * 2 * np.pi for n in (around, across)), indexing="ij")
    wide = 2 + 0.6 * np.cos(v)
    return grid(np.stack([wide * np.cos(u), wide * np.sin(u), 0.6 * np.sin(v)], axis=-1))


def klein() -> Part:
    u, v = np.meshgrid(*(np.arange(n) / n * 2 * np.pi for n in (32, 16)), indexing="ij")
    v = v + np.pi / 16  # no two rows meet where the surface runs through itself
    wide = 2 + np.cos(u / 2) * np.sin(v) - np.sin(u / 2) * np.sin(2 * v)
    tall = np.sin(u / 2) * np.sin(v) + np.cos(u / 2) * np.sin(2 * v)
    return grid(np.stack([wide * np.cos(u), wide * np.sin(u), tall], axis=-1), turned=True)


def moebius() -> Part:
    turn = np.arange(60) / 30 * 2 * np.pi  # one edge of the strip runs round twice
    wide = 1 + 0.3 * np.cos(turn / 2)
    edge = np.column_stack([wide * np.cos(turn), wide * np.sin(turn), 0.3 * np.sin(turn / 2)])
    a = np.arange(30)
    b = a + 1
    across = (b + 30) % 60
    return edge, np.concatenate([np.column_stack([a, b, across]), np.column_stack([a, across, a + 30])])


def genus_two() -> Part:
    """A slab of voxels with two windows."""
    solid = np.ones((7, 3, 1), dtype=bool)
    solid[[1, 5], 1] = False
    return voxels(solid)


def voxels(solid: np.ndarray) -> Part:
    """Skin of the unit cells that are solid."""
    cells = np.argwhere(solid)
    vertices, faces = joined(*[box(tuple(map(float, cell))) for cell in cells])  # type: ignore[arg-type]
    corners = np.round(2 * vertices[faces]).astype(np.int64)
    low, high = corners.min(axis=1), corners.max(axis=1)
    _, inverse, count = np.unique(low + high, axis=0, return_inverse=True, return_counts=True)
    return vertices, faces[count[inverse.ravel()] == 2]


def stairs() -> Part:
    """A ball of voxels."""
    x, y, z = np.meshgrid(*(np.arange(10) - 4.5,) * 3, indexing="ij")
    return voxels(x**2 + y**2 + (0.7 * z) ** 2 < 17)


def elbow() -> Part:
    """A tube whose middle line crosses itself."""
    turn, around = np.linspace(0, 3 * np.pi, 60), np.arange(16) / 16 * 2 * np.pi
    middle = np.column_stack([np.sin(turn), np.sin(2 * turn), 0.02 * turn])
    ahead = np.gradient(middle, axis=0)
    ahead /= np.linalg.norm(ahead, axis=1, keepdims=True)
    side = np.cross(ahead, [0.0, 0.0, 1.0])
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    up = np.cross(side, ahead)
    ring = np.cos(around)[:, None] * side[:, None] + np.sin(around)[:, None] * up[:, None]
    return grid(middle[:, None] + 0.2 * ring, rows_closed=False)


def sheet() -> Part:
    x, y = np.meshgrid(np.arange(6.0), np.arange(6.0))
    low = (np.arange(5)[:, None] * 6 + np.arange(5)).ravel()
    faces = [np.column_stack([low, low + 1, low + 7]), np.column_stack([low, low + 7, low + 6])]
    return np.column_stack([x.ravel(), y.ravel(), 0.1 * np.sin(x.ravel())]), np.concatenate(faces)


def branch() -> Part:
    """A tube with a large round hole in its side: three rims."""
    return without_patch(cone(around=48, along=36), [0.85, 0, 1.5], 0.4)


def without_patch(part: Part, centre: list[float], radius: float) -> Part:
    near = np.linalg.norm(part[0][part[1]].mean(axis=1) - centre, axis=1) < radius
    return part[0], part[1][~near]


def scaled(x: float, y: float, z: float) -> Fault:
    return lambda part: (part[0] * [x, y, z], part[1])


def duplicated(part: Part) -> Part:
    return part[0], np.concatenate([part[1], part[1][some(part, 0.1)]])


def flipped(part: Part) -> Part:
    faces = part[1].copy()
    faces[some(part, 0.3)] = faces[some(part, 0.3)][:, ::-1]
    return part[0], faces


def one_flipped(part: Part) -> Part:
    return part[0], np.concatenate([part[1][:1, ::-1], part[1][1:]])


def inside_out(part: Part) -> Part:
    return part[0], part[1][:, ::-1]


def soup(part: Part) -> Part:
    """Unwelded: every face has vertices of its own."""
    return part[0][part[1]].reshape(-1, 3), np.arange(part[1].size).reshape(-1, 3)


def loose(scale: float) -> Fault:
    """Unwelded, with copies of a vertex apart by this share of the diagonal."""

    def apply(part: Part) -> Part:
        vertices, faces = soup(part)
        size = float(np.linalg.norm(np.ptp(vertices, axis=0)))
        return vertices + rng(part).normal(size=vertices.shape) * scale * size, faces

    return apply


def degenerate(part: Part) -> Part:
    """Faces with a repeated vertex, and faces with three collinear vertices."""
    vertices, faces = part
    few = faces[some(part, 0.05)]
    middle = vertices[few[:, :2]].mean(axis=1)
    line = np.column_stack([few[:, 0], len(vertices) + np.arange(len(few)), few[:, 1]])
    return np.concatenate([vertices, middle]), np.concatenate([faces, few[:, [0, 1, 1]], line])


def needles(part: Part) -> Part:
    """Faces split close to a corner, so that parts of them are needles."""
    vertices, faces = part
    few = some(part, 0.1)
    weight = np.array([1 - 2e-5, 1e-5, 1e-5])
    points = np.einsum("fci,c->fi", vertices[faces[few]], weight)
    new = len(vertices) + np.arange(len(few))
    a, b, c = faces[few].T
    split = [np.column_stack(corners) for corners in ((a, b, new), (b, c, new), (c, a, new))]
    return np.concatenate([vertices, points]), np.concatenate([np.delete(faces, few, axis=0), *split])


def t_junctions(part: Part) -> Part:
    """Faces halved at the midpoint of an edge that the neighbouring face does not split."""
    vertices, faces = part
    few = some(part, 0.05)
    a, b, c = faces[few].T
    new = len(vertices) + np.arange(len(few))
    split = [np.column_stack(corners) for corners in ((a, new, c), (new, b, c))]
    middle = 0.5 * (vertices[a] + vertices[b])
    return np.concatenate([vertices, middle]), np.concatenate([np.delete(faces, few, axis=0), *split])


def hanging(part: Part) -> Part:
    """One half refined and the other not, with new vertices pushed off the edges."""
    vertices, faces = part
    fine = vertices[faces].mean(axis=1)[:, 2] > np.median(vertices[:, 2])
    points, split = trimesh.remesh.subdivide(vertices, faces[fine])
    return joined((vertices, faces[~fine]), (np.asarray(points) * 1.0001, np.asarray(split)))


def cracked(part: Part) -> Part:
    """Two halves that do not meet."""
    vertices, faces = part
    upper = vertices[faces].mean(axis=1)[:, 2] > np.median(vertices[:, 2])
    return joined((vertices, faces[~upper]), (vertices + [0.003, 0, 0.002], faces[upper]))


def small_hole(part: Part) -> Part:
    return part[0], part[1][1:]


def large_hole(part: Part) -> Part:
    low, high = part[0].min(axis=0), part[0].max(axis=0)
    centre = [high[0], 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])]
    return without_patch(part, list(map(float, centre)), 0.25 * float(np.ptp(part[0])))


def many_holes(part: Part) -> Part:
    return part[0], np.delete(part[1], some(part, 0.05), axis=0)


def fin(part: Part) -> Part:
    a, b = part[1][5, :2]
    return np.concatenate([part[0], 1.3 * part[0][[a]] + 0.1]), np.concatenate([part[1], [[a, b, len(part[0])]]])


def bow_tie(part: Part) -> Part:
    """Two distant vertices joined."""
    near, far = int(np.argmax(part[0][:, 0])), int(np.argmin(part[0][:, 0]))
    return part[0], np.where(part[1] == far, near, part[1])


def inner_wall(part: Part) -> Part:
    """A diaphragm on a ring of vertices inside."""
    found = part[1][np.argsort(part[0][part[1]].mean(axis=1)[:, 2])]
    ring = np.unique(found[len(found) // 2 : len(found) // 2 + 12])
    wall = np.column_stack([ring, np.roll(ring, -1), np.full(len(ring), len(part[0]))])
    return np.concatenate([part[0], part[0][ring].mean(axis=0, keepdims=True)]), np.concatenate([part[1], wall])


def double_skin(part: Part) -> Part:
    """The part twice, a little smaller and inside out, as a shell in CAD."""
    middle = part[0].mean(axis=0)
    return joined(part, (middle + 0.98 * (part[0] - middle), part[1][:, ::-1]))


def double_coincident(part: Part) -> Part:
    """The part twice in the same position, with quadrangles cut along the other diagonal if possible."""
    return joined(part, (part[0] + 1e-5 * np.ptp(part[0]), part[1]))


def beside(part: Part) -> Part:
    return joined(part, (part[0] + [2.5 * float(np.ptp(part[0])), 0, 0], part[1]))


def nested(part: Part) -> Part:
    return joined(part, (0.3 * part[0], part[1]))


def noisy(part: Part) -> Part:
    return part[0] + 0.01 * rng(part).normal(size=part[0].shape), part[1]


def rough(part: Part) -> Part:
    """Scan noise of the size of the faces."""
    return part[0] + 0.08 * rng(part).normal(size=part[0].shape), part[1]


def spiky(part: Part) -> Part:
    tips = rng(part).random(len(part[0])) < 0.02
    return np.where(tips[:, None], 2.0 * part[0], part[0]), part[1]


def with_value(value: float) -> Fault:
    def apply(part: Part) -> Part:
        vertices = part[0].copy()
        vertices[7, 1] = value
        return vertices, part[1]

    return apply


def with_index(value: int) -> Fault:
    return lambda part: (part[0], np.concatenate([part[1][:-1], [[0, 1, value]]]))


def uneven(part: Part) -> Part:
    """Refined five times around one point."""
    vertices, faces = part
    for _ in range(5):
        near = np.argsort(np.linalg.norm(vertices[faces].mean(axis=1) - vertices[faces[0, 0]], axis=1))[:60]
        points, split = trimesh.remesh.subdivide(vertices, faces, near)
        vertices, faces = np.asarray(points), np.asarray(split)
    return vertices, faces


def touching_rims() -> Part:
    """A tube with a hole in its side that reaches its rim in one vertex."""
    vertices, faces = cone()
    hole = (vertices[faces] == vertices[6]).all(axis=2).any(axis=1)
    keep = np.zeros(len(vertices), dtype=bool)
    keep[[5, 6, 7]] = True
    touching = hole & ~(keep[faces].sum(axis=1) >= 2)
    return vertices, faces[~touching]


def pinched_rim() -> Part:
    """A tube with one end that ends in a point."""
    return tube(lambda z: 1.0 - z / 3.0)


def two_balls(gap: float) -> Part:
    return joined(ball(2), moved(ball(2), np.eye(3), np.array([2.0 + gap, 0, 0]), 1.0))


def line() -> Part:
    return np.linspace(0, 1, 30)[:, None] * [1.0, 2.0, 3.0], np.arange(30).reshape(-1, 3)


def pancake() -> Part:
    return scaled(1, 1, 1e-3)(ball(3))


TETRAHEDRON: Part = (np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
                     np.array([[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]))  # fmt: skip
FAULTS: dict[str, Fault] = {
    "duplicated faces": duplicated, "flipped faces": flipped, "one face flipped": one_flipped,
    "inside out": inside_out, "unwelded": soup, "loose by 1e-9": loose(1e-9), "loose by 1e-6": loose(1e-6),
    "loose by 1e-4": loose(1e-4), "loose by 1e-2": loose(1e-2), "degenerate faces": degenerate, "needles": needles,
    "T-junctions": t_junctions, "hanging nodes": hanging, "crack": cracked, "small hole": small_hole,
    "large hole": large_hole, "many holes": many_holes, "fin": fin, "bow-tie": bow_tie, "inner wall": inner_wall,
    "double skin": double_skin, "coincident double": double_coincident, "two bodies": beside, "nested bodies": nested,
    "noise": noisy, "rough": rough, "spikes": spiky, "uneven": uneven,
}  # fmt: skip
"""Faults that any part can have; each is tried on a tube and on a closed part."""
SHAPES: dict[str, Callable[[], Part]] = {
    "torus": torus, "torus with a hole": lambda: without_patch(torus(), [2.6, 0, 0], 0.5), "genus 2": genus_two,
    "Klein bottle": klein, "Moebius strip": moebius, "three rims": branch, "rims that touch": touching_rims,
    "rim pinched to a point": pinched_rim, "sheet": sheet, "tetrahedron": lambda: TETRAHEDRON, "cube": box,
    "triangle": lambda: (np.eye(3), np.array([[0, 1, 2]])),
    "two triangles": lambda: (TETRAHEDRON[0], TETRAHEDRON[1][:2]), "cup": cup,
    "needle": lambda: scaled(1e-3, 1e-3, 1)(tube(lambda z: 1.0 + 0 * z)),
    "long closed": lambda: scaled(1, 1, 800)(pear()),
    "thin tube": lambda: tube(lambda z: 1e-3 + 0 * z, 1.0, 16, 400), "pancake": pancake,
    "flat tube": lambda: scaled(1, 1e-7, 1)(cone()), "short tube": lambda: scaled(1, 1, 1e-3)(cone()),
    "self-intersecting": elbow, "stairs": stairs, "touching balls": lambda: two_balls(0.0),
    "overlapping balls": lambda: two_balls(-0.7), "cubes on an edge": lambda: joined(box(), box((1, 1, 0))),
    "cubes on a face": lambda: joined(box(), box((1, 0, 0))), "line": line,
    "one point": lambda: (np.ones((30, 3)), np.arange(30).reshape(-1, 3)),
    "empty": lambda: (np.empty((0, 3)), np.empty((0, 3), dtype=np.int64)),
    "no faces": lambda: (pear()[0], np.empty((0, 3), dtype=np.int64)),
    "NaN": lambda: with_value(np.nan)(pear()), "inf": lambda: with_value(np.inf)(pear()),
    "one at 1e300": lambda: with_value(1e300)(pear()), "one at 1e30": lambda: with_value(1e30)(pear()),
    "one at 1e6": lambda: with_value(1e6)(pear()),
    "all 1e300": lambda: scaled(1e300, 1e300, 1e300)(pear()), "all 1e40": lambda: scaled(1e40, 1e40, 1e40)(pear()),
    "all 1e-40": lambda: scaled(1e-40, 1e-40, 1e-40)(pear()),
    "all 1e-300": lambda: scaled(1e-300, 1e-300, 1e-300)(pear()),
    "denormal": lambda: scaled(1e-315, 1e-315, 1e-315)(pear()),
    "far away": lambda: (pear()[0] + 1e8, pear()[1]), "very far away": lambda: (pear()[0] + 1e15, pear()[1]),
    "index too high": lambda: with_index(10**6)(pear()), "index negative": lambda: with_index(-1)(pear()),
    "random soup": lambda: (np.random.default_rng(5).random((120, 3)), np.arange(120).reshape(-1, 3)),
    "random web": lambda: (np.random.default_rng(6).random((40, 3)),
                           np.random.default_rng(7).integers(40, size=(300, 3))),
}  # fmt: skip


def meshes() -> Iterator[tuple[str, Callable[[], Part]]]:
    """Name and maker of every mesh of the corpus."""
    yield from SHAPES.items()
    for name, fault in FAULTS.items():
        yield f"tube, {name}", lambda fault=fault: fault(cone())  # type: ignore[misc]
        yield f"pear, {name}", lambda fault=fault: fault(pear())  # type: ignore[misc]
    for k, (one, two) in enumerate(list(combinations(FAULTS, 2))[::12]):
        part = cone if k % 2 else pear

        def both(one: str = one, two: str = two, part: Callable[[], Part] = part, k: int = k) -> Part:
            return FAULTS[two](FAULTS[one](moved(part(), rotation(k), np.array([1.0, 2, 3]), 1.0)))

        yield f"{part.__name__}, {one} and {two}", both


MESHES = dict(meshes())


def save_obj(path: Path, part: Part) -> None:
    """Write OBJ with all digits and the indices as they are, valid or not."""
    points = "".join(f"v {float(x)!r} {float(y)!r} {float(z)!r}\n" for x, y, z in part[0])
    path.write_text(points + "".join(f"f {a + 1} {b + 1} {c + 1}\n" for a, b, c in part[1]))


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in MESHES.items():
        save_obj(folder / f"{name.replace(' ', '-').replace(',', '')}.obj", make())
