"""Points with lines and faces between them, as other libraries have them, which are imported when they are asked for.

What can be seen of a part, of its fibres or of a program is a `Block`; records that have one are `Geometric`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, TypeAlias

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Array, Floats, Ints

if TYPE_CHECKING:
    import meshio
    import pyvista
    import trimesh

Data: TypeAlias = Mapping[Any, Array]
"""Arrays by name, a text or a field of a file, with a row for each point or cell."""


def _none(corners: int) -> Ints:
    return np.zeros((0, corners), dtype=np.int64)


@dataclass(frozen=True)
class Block:
    """Points (n, 3) with what lies between them, and data by name.

    starts (l + 1,): polyline k goes through points starts[k] to starts[k + 1]; quads (q, 4) and triangles (t, 3) are
    indices of points.  Without lines and faces the points are vertices.  line_data: of the polylines.
    """

    points: Floats
    starts: Ints = field(default_factory=lambda: np.zeros(1, dtype=np.int64))
    quads: Ints = field(default_factory=lambda: _none(4))
    triangles: Ints = field(default_factory=lambda: _none(3))
    point_data: Data = field(default_factory=dict)
    line_data: Data = field(default_factory=dict)

    __repr__ = brief

    @property
    def faces(self) -> Ints:
        """All faces as triangles (2 q + t, 3); a quad's two in a row."""
        return np.concatenate([self.quads[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3), self.triangles])

    @property
    def segments(self) -> tuple[Ints, Ints]:
        """Segments (s, 2) of the polylines, and the line (s,) of each."""
        sizes = np.diff(self.starts)
        line = np.repeat(np.arange(len(sizes)), np.maximum(sizes - 1, 0))
        first = np.delete(np.arange(self.starts[-1]), self.starts[1:] - 1)
        return np.stack([first, first + 1], axis=1), line

    @property
    def cells(self) -> list[tuple[str, Ints]]:
        """Cells by meshio's name of their kind: segments for polylines."""
        kinds = [("line", self.segments[0]), ("quad", self.quads), ("triangle", self.triangles)]
        found = [(kind, np.array(block)) for kind, block in kinds if len(block)]
        return found or [("vertex", np.arange(len(self.points))[:, None])]

    def to_pyvista(self) -> pyvista.PolyData:
        """The block for PyVista: one cell for each polyline, quad, triangle or vertex."""
        import pyvista

        parts: dict[str, Any] = {}
        if len(self.starts) > 1:
            sizes = np.diff(self.starts)
            parts["lines"] = np.insert(np.arange(self.starts[-1]), self.starts[:-1], sizes)
        faces = [np.insert(block, 0, block.shape[1], axis=1).ravel() for block in (self.quads, self.triangles)]
        if len(self.quads) + len(self.triangles):
            parts["faces"] = np.concatenate(faces)
        made = pyvista.PolyData(np.array(self.points), **parts)
        for name, values in self.point_data.items():
            made.point_data[name] = np.array(values)
        for name, values in self.line_data.items():
            made.cell_data[name] = np.array(values)
        return made

    def to_trimesh(self) -> trimesh.Trimesh | trimesh.path.Path3D | trimesh.PointCloud:
        """The block for trimesh: a mesh of triangles, a path of polylines, or a cloud of points."""
        import trimesh

        if len(self.quads) + len(self.triangles):
            made = trimesh.Trimesh(np.array(self.points), self.faces, process=False)
            made.vertex_attributes.update({name: np.array(values) for name, values in self.point_data.items()})
            return made
        if len(self.starts) > 1:
            pieces = zip(self.starts[:-1], self.starts[1:], strict=True)
            lines = [trimesh.path.entities.Line(np.arange(first, last)) for first, last in pieces]
            return trimesh.path.Path3D(lines, np.array(self.points), process=False)
        return trimesh.PointCloud(np.array(self.points))

    def to_meshio(self) -> meshio.Mesh:
        """The block for meshio: polylines as line cells, one for each segment, with the data of their line."""
        import meshio

        line = self.segments[1]
        data = {name: [np.asarray(values)[line]] for name, values in self.line_data.items()} if len(line) else {}
        points = {
            str(name): np.array(values, dtype=np.uint8 if values.dtype == np.bool_ else None)  # meshio has no booleans
            for name, values in self.point_data.items()
        }
        return meshio.Mesh(np.array(self.points), self.cells, point_data=points, cell_data=data)

    def columns(self) -> Data:
        """The points with their data as columns of a table: x, y, z, and one for each component of a vector."""
        vectors = {name: values for name, values in self.point_data.items() if np.ndim(values) > 1}
        plain = {name: values for name, values in self.point_data.items() if name not in vectors}
        apart = {
            f"{name}_{axis}": values[:, k]
            for name, values in vectors.items()
            for k, axis in enumerate("uv" if values.shape[1] == 2 else "xyz")
        }
        return dict(zip("xyz", np.asarray(self.points).T, strict=True)) | plain | apart


def joined(blocks: Sequence[Block]) -> Block:
    """The polylines of several blocks with the same data, in a row."""
    starts = np.concatenate([[0], *(np.diff(each.starts) for each in blocks)]).cumsum()

    def together(data: Sequence[Data]) -> Data:
        return {name: np.concatenate([each[name] for each in data]) for name in data[0]}

    return Block(
        np.concatenate([each.points for each in blocks]),
        starts,
        point_data=together([each.point_data for each in blocks]),
        line_data=together([each.line_data for each in blocks]),
    )


class Geometric:
    """Base of records that have a shape in space, and give it to other libraries."""

    @property
    def block(self) -> Block:
        """The shape with its data."""
        raise NotImplementedError

    def to_pyvista(self) -> pyvista.PolyData:
        """Give the shape to PyVista, with its data on points and cells.

        Returns
        -------
        pyvista.PolyData
            A copy: one cell for each polyline, quad, triangle or vertex.

        Examples
        --------
        >>> import meshwind as mw
        >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0).to_pyvista()
        >>> tube.n_points, tube.n_cells, round(tube.length, 2)
        (6600, 6400, 4.12)
        """
        return self.block.to_pyvista()

    def to_trimesh(self) -> trimesh.Trimesh | trimesh.path.Path3D | trimesh.PointCloud:
        """Give the shape to trimesh.

        Returns
        -------
        trimesh.Trimesh, trimesh.path.Path3D or trimesh.PointCloud
            A copy: triangles, which two make of a quad, with the data of the points as vertex attributes; lines; or
            points.

        Examples
        --------
        >>> import meshwind as mw
        >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0).to_trimesh()
        >>> round(float(tube.area), 2)
        18.85
        """
        return self.block.to_trimesh()

    def to_meshio(self) -> meshio.Mesh:
        """Give the shape to meshio.

        Returns
        -------
        meshio.Mesh
            A copy; polylines are line cells, one for each segment, each with the data of its line.

        Examples
        --------
        >>> import meshwind as mw
        >>> mesh = mw.shapes.cylinder(radius=1.0, length=3.0).to_meshio()
        >>> list(mesh.cells_dict), sorted(mesh.point_data)
        (['quad'], ['normal', 'uv'])
        """
        return self.block.to_meshio()
