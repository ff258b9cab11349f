"""The faces of a mesh as a graph: which meet at an edge, how strongly they are linked, and fields on them."""

from dataclasses import dataclass

import igl
import numpy as np
from scipy import sparse

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.geometry.areas_and_volumes import areas
from meshwind.mesh.geometry.topology import components, edges


@dataclass(frozen=True)
class FaceGraph:
    """Faces that share an edge, first (e,) and second (e,), among those with the given areas (m,).

    weight: length of each edge over the distance of the two faces' middles across it, as in finite volumes.
    """

    area: Floats
    first: Ints
    second: Ints
    weight: Floats

    @staticmethod
    def of(vertices: Floats, faces: Ints) -> "FaceGraph":
        """The graph of a mesh; edges with one face link nothing."""
        found = edges(faces)
        one, two = (half // 3 for half in found.pairs())
        ends = vertices[found.ends[found.count == 2]]
        middle, place = ends.mean(axis=1), vertices[faces].mean(axis=1)
        apart = np.linalg.norm(middle - place[one], axis=1) + np.linalg.norm(middle - place[two], axis=1)
        length = np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)
        return FaceGraph(areas(vertices, faces), one, two, length / np.maximum(apart, np.finfo(float).tiny))

    def borders(self, label: Ints) -> Bools:
        """Mask (m,) of the faces that have a neighbour with another label (m,)."""
        differ = label[self.first] != label[self.second]
        mask = np.zeros(len(self.area), dtype=bool)
        mask[self.first[differ]] = mask[self.second[differ]] = True
        return mask

    def pieces(self, mask: Bools) -> Ints:
        """Label (m,) of the connected piece of each face of the mask (m,); the others are pieces by themselves."""
        inside = mask[self.first] & mask[self.second]
        return components(len(self.area), self.first[inside], self.second[inside])

    def linked(self, mask: Bools, seed: Bools) -> Bools:
        """The faces of the mask (m,) that are connected, within it, with a seed (m,) in it."""
        label = self.pieces(mask)
        reached = np.zeros(len(label), dtype=bool)
        reached[label[mask & seed]] = True
        return np.asarray(mask & reached[label])

    def largest(self, mask: Bools) -> Bools:
        """The connected piece of the mask (m,) with the largest area."""
        if not mask.any():
            return mask
        label = self.pieces(mask)
        size = np.bincount(label, self.area * mask)
        return np.asarray(mask & (label == np.argmax(size)))

    def smoothed(self, values: Floats, pull: Floats, link: Floats) -> Floats:
        """The field x (m,) that minimises sum pull (x - values)^2 + sum over edges of weight link (difference of x)^2.

        pull (m,) may be 0 for faces without a value; link (e,).
        """
        return _solved(len(values), self.first, self.second, self.weight * link, pull, pull * values)

    def extended(self, values: Floats, known: Bools, into: Bools) -> Floats:
        """Values (m, k) of the known faces (m,) continued harmonically into others (m,): one row for each of those."""
        number = np.full(len(self.area), -1, dtype=np.int64)
        number[into] = np.arange(int(into.sum()))
        one, two = self.first, self.second
        inner, outward, inward = (
            into[one] & into[two], into[one] & known[two], into[two] & known[one]
        )  # fmt: skip
        here = number[np.concatenate([one[outward], two[inward]])]
        there = np.concatenate([two[outward], one[inward]])
        weight = np.concatenate([self.weight[outward], self.weight[inward]])
        count = int(into.sum())
        # a piece that touches no known face gets values of 0
        pull = np.full(count, 1e-12 * self.weight.max(initial=1.0))
        pull += np.bincount(here, weight, count)
        right = np.zeros((count, values.shape[1]))
        np.add.at(right, here, weight[:, None] * values[there])
        return _solved(count, number[one[inner]], number[two[inner]], self.weight[inner], pull, right)


def _solved(count: int, first: Ints, second: Ints, weight: Floats, pull: Floats, right: Floats) -> Floats:
    """Solve (Laplacian of the links + pull) x = right, for each column, by libigl's sparse Cholesky.

    SuperLU with a symmetric ordering took 200 times as long on one mesh of 32,000 faces.
    """
    diagonal = np.bincount(first, weight, count) + np.bincount(second, weight, count) + pull
    node = np.arange(count)
    matrix = sparse.csc_matrix(
        (np.r_[-weight, -weight, diagonal], (np.r_[first, second, node], np.r_[second, first, node])),
        shape=(count, count),
    )
    columns = right.reshape(count, -1)
    known, none = np.zeros(0, dtype=np.int64), sparse.csc_matrix((0, count))
    x = igl.min_quad_with_fixed(matrix, -columns, known, np.zeros((0, columns.shape[1])), none,
                                np.zeros((0, columns.shape[1])), True)  # fmt: skip
    return np.asarray(x).reshape(right.shape)
