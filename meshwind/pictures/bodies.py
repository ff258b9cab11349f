"""Meshes in the pictures: the part, fibres as tubes, bridges coloured by their gap."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.core.cast import Floats, Ints
from meshwind.pictures.canvas import INSIDE, PART, add_smooth
from meshwind.pictures.scenes import Fibres, Part

FAMILY = {1: "#0072b2", -1: "#e69f00"}  # Okabe and Ito's blue and orange, which every eye distinguishes
LOOSE = "#7a7a7a"
NAMES = {1: "family +1", -1: "family −1"}
TUBE = 3.0, 0.16
"""Radius of a tube in pixels, and its upper limit over the pitch."""
_MANY = 60_000
"""Number of points above which tubes are thin enough to have fewer sides."""


def add_part(window: Any, part: Part) -> None:
    """Add the fitted surface, matt, darker inside."""
    inside = {"color": INSIDE, "ambient": 0.25, "interpolation": "Phong"}
    add_smooth(window, body(part), backface_params=inside, color=PART, ambient=0.3, diffuse=0.8)


def add_map(window: Any, part: Part, shares: Floats, colours: Any) -> None:
    """Add the fitted surface coloured by shares (k,) outside, and plain inside, where colours would mislead."""
    inside = body(part)
    add_smooth(window, inside, color=INSIDE, ambient=0.25, culling="front")
    outside = inside.copy()
    outside.point_data["shares"] = shares
    look = {"scalars": "shares", "cmap": colours, "clim": [0.0, 1.0], "show_scalar_bar": False}
    add_smooth(window, outside, ambient=0.55, diffuse=0.5, culling="back", **look)


def body(part: Part) -> Any:
    """The quads of a part with unit normals."""
    mesh = pv.PolyData.from_regular_faces(part.points, part.quads)
    size = np.linalg.norm(part.normals, axis=1, keepdims=True)
    mesh.point_data["Normals"] = part.normals / np.maximum(size, 1e-300)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def radius(part: Part, scale: float, unit: float) -> float:
    """Radius of the fibres' tubes; scale: mesh units per pixel, unit: pixels per pixel of the designed page."""
    pixels, share = TUBE
    return float(min(pixels * unit * scale, share * part.pitch))


def lifted(fibres: Fibres, thick: float) -> Floats:
    """Points (p, n, 3) of the fibres, lifted by the radius of their tubes so that these lie on the part."""
    return np.asarray(fibres.points + thick * fibres.lift)


def add_fibres(window: Any, fibres: Fibres, thick: float, colours: dict[int, str] = FAMILY) -> None:
    """Add both families as tubes."""
    points = lifted(fibres, thick)
    for name, colour in colours.items():
        add_tubes(window, points[(fibres.family == name) & fibres.converged], thick, colour)
    add_tubes(window, points[~fibres.converged], 0.6 * thick, LOOSE)


def sides(points: int) -> int:
    """Number of sides of tubes through this many points in all."""
    return 8 if points <= _MANY else 4


def add_tubes(window: Any, points: Floats, thick: float, colour: str) -> None:
    """Add tubes around paths (p, n, 3)."""
    if len(points):
        lines = polylines(points.reshape(-1, 3), np.full(len(points), points.shape[1]))
        add_smooth(
            window, lines.tube(radius=thick, n_sides=sides(lines.n_points)), color=colour, ambient=0.4, diffuse=0.7
        )


def add_coloured_tubes(window: Any, lines: Any, thick: float, name: str, colours: Any, most: float) -> None:
    """Add tubes around polylines, coloured by one of their fields from 0 to `most`."""
    tubes = lines.tube(radius=thick, n_sides=sides(lines.n_points) + 2)
    add_smooth(
        window, tubes, scalars=name, cmap=colours, show_scalar_bar=False, clim=[0.0, most], ambient=0.4, diffuse=0.65
    )


def polylines(points: Floats, sizes: Ints) -> Any:
    """Polylines over consecutive points (k, 3); sizes (l,): number of points of each."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    cells = np.insert(np.arange(len(points)), starts[:-1], sizes)
    return pv.PolyData(points, lines=cells)
