"""A barrel for files of scenes, and how a file that is read compares with it."""

from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.areas_and_volumes import areas
from meshwind.mesh.io.file_mesh import FileMesh
from meshwind.mesh.io.read import load

SIDES, RINGS = 8, 6


def barrel() -> tuple[Floats, Ints]:
    """An open barrel about z: 48 vertices, 80 triangles that look outward, 60 long, in its middle 50 across."""
    z, turn = np.meshgrid(np.linspace(0.0, 60.0, RINGS), np.arange(SIDES) * 2 * np.pi / SIDES, indexing="ij")
    radius = 20.0 + 5.0 * np.sin(np.pi * z / 60.0)
    points = np.column_stack([(radius * np.cos(turn)).ravel(), (radius * np.sin(turn)).ravel(), z.ravel()])
    ring, side = (index.ravel() for index in np.meshgrid(np.arange(RINGS - 1), np.arange(SIDES), indexing="ij"))
    a, b = ring * SIDES + side, ring * SIDES + (side + 1) % SIDES
    return points, np.concatenate([np.column_stack([a, b, b + SIDES]), np.column_stack([a, b + SIDES, a + SIDES])])


def area(points: Floats, faces: Ints) -> float:
    return float(areas(points, faces).sum())


def flow(held: FileMesh) -> float:
    """Six times the volume between a mesh and the origin: its sign tells an outward side of triangles from inward."""
    a, b, c = (held.vertices[held.faces[:, k]] for k in range(3))
    return float(np.einsum("ij,ij", a, np.cross(b, c)))


def said(path: Path) -> str:
    """The line in which a file is refused."""
    try:
        load(path)
    except BadInputError as error:
        assert "\n" not in str(error) and len(str(error)) < 400 and str(error).startswith(f"{path.name}: ")
        return str(error)
    raise AssertionError(f"{path.name} was read")
