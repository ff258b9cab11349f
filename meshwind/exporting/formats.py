"""The results as meshes in other formats, by meshio; what a format cannot hold is reported."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from meshwind.core.cast import Floats, Ints
from meshwind.core.geometry import Block, Data
from meshwind.core.units import lengths_in
from meshwind.exporting.xdmf import write_xdmf
from meshwind.results.meshio_files import write_meshio
from meshwind.results.reading import Results, read_surface_grid
from meshwind.results.schema import BRIDGES, CROSSINGS, FORMATS_FOLDER, PATHS, QUADS, SURFACE
from meshwind.results.vtk_reading import read_faces, read_lines, read_vertices


@dataclass(frozen=True)
class _Part:
    """One result as a mesh: cells by kind, point data, and cell data in the order of the cells."""

    name: str
    points: Floats
    cells: tuple[tuple[str, Ints], ...]
    point_data: Data
    cell_data: Data
    units: str


def write_formats(folder: Path, results: Results, formats: tuple[str, ...]) -> list[str]:
    """Write surface, quads, paths, bridges and crossings in each format into the folder's `formats`.

    Polylines become line cells, one per segment, each with the data of its path.  Returns one line for each thing that
    a format cannot hold.
    """
    (folder / FORMATS_FOLDER).mkdir()
    lost: list[str] = []
    for part in _parts(results):
        if not len(part.points):
            lost.append(f"{part.name}: there are none, so no format has a file of them")
            continue
        for name in formats:
            lost += FORMATS[name](folder / FORMATS_FOLDER, part)
    return list(dict.fromkeys(lost))


def _parts(results: Results) -> list[_Part]:
    """The results that are meshes; bridges and crossings may have no points."""
    folder, units = results.folder, results.units
    surface, quads = read_surface_grid(folder, results.surface), read_faces(folder / QUADS)
    parts = [_of_faces(SURFACE.stem, surface, units), _of_faces(QUADS.stem, quads, units)]
    parts += [_of_lines(file.stem, read_lines(folder / file), units) for file in (PATHS, BRIDGES)]
    points, data = read_vertices(folder / CROSSINGS)
    parts.append(_Part(CROSSINGS.stem, points, (_vertices(points),), data, {}, units))
    return parts


def _of_faces(name: str, read: Block, units: str) -> _Part:
    return _Part(name, read.points, tuple(read.cells), read.point_data, {}, units)


def _of_lines(name: str, read: Block, units: str) -> _Part:
    """Polylines as line cells: each segment carries the data of its line."""
    segments, line = read.segments
    data = {key: values[line] for key, values in read.line_data.items()}
    return _Part(name, read.points, (("line", segments),), read.point_data, data, units)


def _vertices(points: Floats) -> tuple[str, Ints]:
    return "vertex", np.arange(len(points))[:, None]


def _apart(data: Data, widest: int) -> dict[str, NDArray[Any]]:
    """The data; vectors that do not have 3 components, or with `widest` 1 all, are split: uv into uv_0, uv_1."""
    out: dict[str, NDArray[Any]] = {}
    for name, values in data.items():
        if values.ndim == 1 or values.shape[1] == 3 <= widest:
            out[name] = values
        else:
            out |= {f"{name}_{k}": np.ascontiguousarray(values[:, k]) for k in range(values.shape[1])}
    return out


def _whole(data: Data, kind: type[np.signedinteger[Any]]) -> Data:
    """The data with all whole numbers of one kind."""
    return {name: values if values.dtype.kind == "f" else values.astype(kind) for name, values in data.items()}


def _vtk(folder: Path, part: _Part) -> list[str]:
    """Whole numbers of 64 bits: VTK knows meshio's name of no other kind, and leaves out all fields from there on."""
    points, cells = (_whole(data, np.int64) for data in (part.point_data, part.cell_data))
    return _vtu(folder, replace(part, point_data=points, cell_data=cells), "vtk")


def _vtu(folder: Path, part: _Part, suffix: str = "vtu") -> list[str]:
    data = {name: [values] for name, values in part.cell_data.items()}
    file, points = folder / f"{part.name}.{suffix}", _apart(part.point_data, 3)
    write_meshio(file, part.points, part.cells, point_data=points, cell_data=data, units=part.units)
    return []


def _xdmf(folder: Path, part: _Part) -> list[str]:
    data = _apart(part.point_data, 3)
    write_xdmf(folder / f"{part.name}.xdmf", part.points, part.cells, data, part.cell_data, part.units)
    return []


def _gmsh(folder: Path, part: _Part) -> list[str]:
    import meshio

    tags = {
        name: [np.full(len(block), number, dtype=np.int64) for number, (_, block) in enumerate(part.cells, start=1)]
        for name in ("gmsh:physical", "gmsh:geometrical")
    }
    cell_data: dict[str, list[NDArray[Any]]] = {n: [v.astype(float)] for n, v in part.cell_data.items()}
    point_data = {name: values.astype(float) for name, values in _apart(part.point_data, 3).items()}
    cells = [(kind, np.array(block)) for kind, block in part.cells]
    mesh = meshio.Mesh(np.array(part.points), cells, point_data=point_data, cell_data=cell_data | tags)
    meshio.gmsh.write(str(folder / f"{part.name}.msh"), mesh, fmt_version="2.2", binary=True)
    return [f"gmsh: no entry for the unit of length; {lengths_in(part.units)}"]


def _ply(folder: Path, part: _Part) -> list[str]:
    """meshio's PLY has only faces and point data, so lines are written as their points."""
    lost = [f"ply: no data of cells; of {part.name} it lacks {', '.join(part.cell_data)}"] if part.cell_data else []
    kinds = {kind for kind, _ in part.cells}
    if kinds & {"line", "vertex"}:
        lost += ["ply: no lines; paths and bridges are written as their points"] if "line" in kinds else []
        part = replace(part, cells=())
    cells = [(kind, block.astype(np.int32)) for kind, block in part.cells]  # PLY has no wider integers
    data = _apart(_whole(part.point_data, np.int32), 1)
    write_meshio(folder / f"{part.name}.ply", part.points, cells, point_data=data, units=part.units)
    return lost


def _obj(folder: Path, part: _Part) -> list[str]:
    """OBJ without meshio, which writes faces only and neither lines nor points."""
    letters = {"quad": "f", "triangle": "f", "line": "l", "vertex": "p"}
    with (folder / f"{part.name}.obj").open("w", encoding="ascii") as file:
        file.write(f"# {part.name} of a winding, {lengths_in(part.units)}\n")
        np.savetxt(file, part.points, fmt="v %.17g %.17g %.17g")
        for kind, block in part.cells:
            np.savetxt(file, block + 1, fmt=" ".join([letters[kind]] + block.shape[1] * ["%d"]))
    return ["obj: no fields; only points, lines and faces are written"]


FORMATS: dict[str, Callable[[Path, _Part], list[str]]] = {
    "vtu": _vtu, "vtk": _vtk, "xdmf": _xdmf, "ply": _ply, "obj": _obj, "gmsh": _gmsh,
}  # fmt: skip
"""Mesh formats by name: each writes one part into a folder and returns a line for everything that it cannot hold."""
