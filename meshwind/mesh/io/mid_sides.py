"""Nodes on the edges of cells of second order, by which their faces are cut finer."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Ints

_EDGES = {
    "triangle6": [(0, 1), (1, 2), (2, 0)],
    "quad8": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "quad9": [(0, 1), (1, 2), (2, 3), (3, 0)],
    "tetra10": [(0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3)],
    "hexahedron20": [
        (0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7),
    ],
    "wedge15": [(0, 1), (1, 2), (2, 0), (3, 4), (4, 5), (5, 3), (0, 3), (1, 4), (2, 5)],
    "pyramid13": [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4), (3, 4)],
}  # fmt: skip
"""Edges of cells by the order of the nodes on them, which follow the corners."""
_EDGES["hexahedron27"], _EDGES["vtk-wedge15"] = _EDGES["hexahedron20"], _EDGES["wedge15"]
KINDS = tuple(_EDGES)


@dataclass(frozen=True)
class MidSides:
    """Edges (e, 2) by their lower and higher corner, in order, and the node on each (e,)."""

    keys: Ints
    middle: Ints
    points: int

    @classmethod
    def of(cls, tables: list[tuple[str, Ints]], points: int) -> "MidSides":
        """Those of cells of second order (c, nodes), given by their kind."""
        ends, middle = [np.empty((0, 2), dtype=np.int64)], [np.empty(0, dtype=np.int64)]
        for kind, table in tables:
            pairs = np.array(_EDGES[kind])
            corners = int(pairs.max()) + 1
            ends.append(table[:, pairs].reshape(-1, 2))
            middle.append(table[:, corners : corners + len(pairs)].ravel())
        keys, first = np.unique(_keys(np.concatenate(ends), points), return_index=True)
        return cls(keys, np.concatenate(middle)[first], points)

    def __bool__(self) -> bool:
        return len(self.keys) > 0

    def on(self, polygons: Ints) -> Ints:
        """The node on each side of polygons (p, k), from each corner to the next; -1 where there is none."""
        sides = np.stack([polygons, np.roll(polygons, -1, axis=1)], axis=2).reshape(-1, 2)
        keys = _keys(sides, self.points)
        at = np.minimum(np.searchsorted(self.keys, keys), len(self.keys) - 1)
        return np.where(self.keys[at] == keys, self.middle[at], -1).reshape(polygons.shape)


def _keys(edges: Ints, points: int) -> Ints:
    return np.asarray(edges.min(axis=1) * points + edges.max(axis=1))


def cut_finer(polygons: Ints, middle: Ints) -> Ints:
    """Triangles of triangles (p, 3) or quadrangles (p, 4) with a node on every side (p, k)."""
    count = polygons.shape[1]
    corners = [np.column_stack([middle[:, k - 1], polygons[:, k], middle[:, k]]) for k in range(count)]
    inner = [middle[:, [0, k, k + 1]] for k in range(1, count - 1)]
    return np.concatenate([*corners, *inner])


def complete(middle: Ints) -> Bools:
    """Which polygons have a node on every side."""
    return np.asarray((middle >= 0).all(axis=1))
