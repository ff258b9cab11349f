"""winding.png: the part, the fibres of both families, and the bridges coloured by their gap."""

from typing import Any

import numpy as np
import pyvista as pv
from matplotlib import colormaps
from matplotlib.colors import ListedColormap

from meshwind.output.canvas import (
    BOTTOM,
    INK,
    INSIDE,
    LEFT,
    PART,
    RIGHT,
    SIZE,
    TOP,
    add_smooth,
    aim,
    axes,
    colour_bar,
    face,
    round_below,
    ruler,
    shot,
    titled,
)  # fmt: skip

FAMILY = {1: "#0072b2", -1: "#e69f00"}  # Okabe and Ito's blue and orange: told apart by every eye
LOOSE = "#7a7a7a"
GAPS = ListedColormap(colormaps["RdPu"](np.linspace(0.3, 1.0, 256)))
"""Pale where a bridge all but touches, dark where the gap is wide: what matters stands out, in greys too."""


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """The picture of the part and its fibres, with words."""
    room = SIZE[0] - LEFT - RIGHT, SIZE[1] - TOP - BOTTOM
    scale = float(max(scene["extent"][0] / room[0], scene["extent"][1] / room[1]))
    radius = min(3.0 * scale, 0.16 * float(scene["pitch"]))
    add_part(window, scene)
    add_fibres(window, scene, radius)
    add_bridges(window, scene, radius)
    aim(window, scene, scene["centre"], (LEFT + 0.5 * room[0], TOP + 0.5 * room[1]), scale)
    image = shot(window)
    pen = titled(image, scene)
    legend(pen, scene)
    if len(scene["bridges"]):
        units = str(scene["units"])
        colour_bar(image, pen, GAPS, ["bridges:", f"gap in {units}" if units else "gap"], marks(scene["max_gap"]))
    ruler(pen, scale, str(scene["units"]))
    axes(pen, scene)
    return image


def add_part(window: Any, scene: dict[str, Any]) -> None:
    """The fitted surface, matt, darker inside."""
    part = pv.PolyData.from_regular_faces(scene["points"], scene["quads"])
    part.point_data["Normals"] = scene["normals"] / np.linalg.norm(scene["normals"], axis=1, keepdims=True)
    part.point_data.active_normals_name = "Normals"
    add_smooth(
        window,
        part,
        color=PART,
        ambient=0.3,
        diffuse=0.8,
        backface_params={"color": INSIDE, "ambient": 0.25, "interpolation": "Phong"},
    )


def add_fibres(window: Any, scene: dict[str, Any], radius: float) -> None:
    """Both families as tubes lifted by their radius, so that they lie on the part and do not sink in."""
    size = scene["paths"].shape[1]
    points = scene["paths"] + radius * scene["path_lift"]
    for name, colour in FAMILY.items():
        add_tubes(window, points[(scene["family"] == name) & scene["taut"]], size, radius, colour)
    add_tubes(window, points[~scene["taut"]], size, 0.6 * radius, LOOSE)


def add_tubes(window: Any, points: Any, size: int, radius: float, colour: str) -> None:
    """Tubes around paths (p, size, 3)."""
    if len(points):
        lines = polylines(points.reshape(-1, 3), np.full(len(points), size))
        add_smooth(window, lines.tube(radius=radius, n_sides=8), color=colour, ambient=0.4, diffuse=0.7)


def add_bridges(window: Any, scene: dict[str, Any], radius: float) -> None:
    """The spans off the surface, thicker and coloured by their gap."""
    if not len(scene["bridges"]):
        return
    lines = polylines(scene["bridges"] + radius * scene["bridge_lift"], scene["bridge_sizes"])
    lines.point_data["gap"] = scene["bridge_gap"]
    tubes = lines.tube(radius=1.4 * radius, n_sides=10)
    add_smooth(
        window,
        tubes,
        scalars="gap",
        cmap=GAPS,
        show_scalar_bar=False,
        clim=[0.0, float(scene["max_gap"])],
        ambient=0.4,
        diffuse=0.65,
    )


def polylines(points: Any, sizes: Any) -> Any:
    """Polylines over consecutive points."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    cells = np.insert(np.arange(len(points)), starts[:-1], sizes)
    return pv.PolyData(points, lines=cells)


def legend(pen: Any, scene: dict[str, Any]) -> None:
    """Which colour is which family."""
    x, y = SIZE[0] - RIGHT + 20, TOP + 40
    rows = [(FAMILY[1], "family +1"), (FAMILY[-1], "family −1")]
    if not scene["taut"].all():
        rows.append((LOOSE, "not at rest"))
    for k, (colour, words) in enumerate(rows):
        pen.rectangle((x, y + 44 * k + 10, x + 44, y + 44 * k + 17), fill=colour)
        pen.text((x + 58, y + 44 * k), words, INK, font=face(25))


def marks(most: float) -> list[tuple[float, str]]:
    """Round values from 0 to most: their share of it, and their words."""
    step = round_below(float(most) / 3.0)
    values = step * np.arange(int(most / step * (1.0 + 1e-9)) + 1)
    return [(float(value / most), f"{value:.4g}") for value in values]
