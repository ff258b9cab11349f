"""What stands on the pictures: the part, fibres as tubes, bridges by their gap."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.pictures.canvas import INSIDE, PART, add_smooth

FAMILY = {1: "#0072b2", -1: "#e69f00"}  # Okabe and Ito's blue and orange: told apart by every eye
LOOSE = "#7a7a7a"
NAMES = {1: "family +1", -1: "family −1"}
TUBE = 3.0, 0.16
"""Radius of a tube: so many pixels, but no more than this part of the pitch."""
_MANY = 60_000


def add_part(window: Any, scene: dict[str, Any]) -> None:
    """The fitted surface, matt, darker inside."""
    part = body(scene["points"], scene["quads"], scene["normals"])
    inside = {"color": INSIDE, "ambient": 0.25, "interpolation": "Phong"}
    add_smooth(window, part, backface_params=inside, color=PART, ambient=0.3, diffuse=0.8)


def add_map(window: Any, scene: dict[str, Any], colours: Any) -> None:
    """The fitted surface coloured by the scene's shares, plain inside: there colours would be read as the outside's."""
    part = body(scene["points"], scene["quads"], scene["normals"])
    add_smooth(window, part, color=INSIDE, ambient=0.25, culling="front")
    outside = part.copy()
    outside.point_data["shares"] = scene["shares"]
    look = {"scalars": "shares", "cmap": colours, "clim": [0.0, 1.0], "show_scalar_bar": False}
    add_smooth(window, outside, ambient=0.55, diffuse=0.5, culling="back", **look)


def body(points: Any, faces: Any, normals: Any) -> Any:
    """Faces (m, 3 or 4) between points (n, 3) with normals (n, 3) of any length."""
    part = pv.PolyData.from_regular_faces(points, faces)
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    part.point_data["Normals"] = normals / np.maximum(size, 1e-300)
    part.point_data.active_normals_name = "Normals"
    return part


def radius(scene: dict[str, Any], scale: float, unit: float) -> float:
    """Radius of the fibres' tubes, at so many mesh units a pixel."""
    pixels, share = TUBE
    return float(min(pixels * unit * scale, share * float(scene["pitch"])))


def add_fibres(window: Any, scene: dict[str, Any], thick: float, colours: dict[int, str] = FAMILY) -> None:
    """Both families as tubes lifted by their radius, so that they lie on the part and do not sink in."""
    size = scene["paths"].shape[1]
    points = scene["paths"] + thick * scene["path_lift"]
    for name, colour in colours.items():
        add_tubes(window, points[(scene["family"] == name) & scene["taut"]], size, thick, colour)
    add_tubes(window, points[~scene["taut"]], size, 0.6 * thick, LOOSE)


def sides(points: int) -> int:
    """Of tubes through so many points: where there are many they are too thin to look angular."""
    return 8 if points <= _MANY else 4


def add_tubes(window: Any, points: Any, size: int, thick: float, colour: str) -> None:
    """Tubes around paths (p, size, 3)."""
    if len(points):
        lines = polylines(points.reshape(-1, 3), np.full(len(points), size))
        add_smooth(
            window, lines.tube(radius=thick, n_sides=sides(lines.n_points)), color=colour, ambient=0.4, diffuse=0.7
        )


def add_coloured_tubes(window: Any, lines: Any, thick: float, name: str, colours: Any, most: float) -> None:
    """Tubes around polylines, coloured by their point data from 0 to most."""
    tubes = lines.tube(radius=thick, n_sides=sides(lines.n_points) + 2)
    add_smooth(
        window, tubes, scalars=name, cmap=colours, show_scalar_bar=False, clim=[0.0, most], ambient=0.4, diffuse=0.65
    )


def polylines(points: Any, sizes: Any) -> Any:
    """Polylines over consecutive points."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    cells = np.insert(np.arange(len(points)), starts[:-1], sizes)
    return pv.PolyData(points, lines=cells)
