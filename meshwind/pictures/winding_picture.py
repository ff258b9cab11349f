"""winding.png: the part, the fibres of both families, and the bridges coloured by their gap."""

from typing import Any

import numpy as np

from meshwind.appearance.colours import colour_map
from meshwind.appearance.looks import round_below
from meshwind.pictures import bodies, canvas
from meshwind.pictures.page import page_of

GAPS = colour_map("gap")


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """The picture of the part and its fibres, with words."""
    page = page_of(scene)
    scale = canvas.fitting(page, scene)
    thick = bodies.radius(scene, scale, page.unit)
    bodies.add_part(window, scene)
    bodies.add_fibres(window, scene, thick)
    add_bridges(window, scene, thick)
    canvas.aim(window, page, scene, scene["centre"], canvas.middle(canvas.room(page)), scale)
    image = canvas.shot(window, page)
    return lettered(image, scene, scale)


def lettered(image: Any, scene: dict[str, Any], scale: float) -> Any:
    """The image with its title, legend, scale of gaps, ruler and axes."""
    page = page_of(scene)
    pen = canvas.titled(image, page, scene)
    canvas.legend(pen, page, families(scene))
    units = str(scene["units"])
    if len(scene["bridges"]):
        words = ["bridges:", f"gap in {units}" if units else "gap"]
        canvas.colour_bar(image, pen, page, GAPS, words, marks(scene["max_gap"]))
    canvas.ruler(pen, page, scale, units)
    canvas.axes(pen, page, scene)
    return image


def families(scene: dict[str, Any]) -> list[tuple[str, str]]:
    """Which colour is which family, for the legend."""
    rows = [(bodies.FAMILY[name], words) for name, words in bodies.NAMES.items()]
    return rows if scene["taut"].all() else [*rows, (bodies.LOOSE, "not at rest")]


def add_bridges(window: Any, scene: dict[str, Any], thick: float) -> None:
    """The spans off the surface, thicker and coloured by their gap."""
    if not len(scene["bridges"]):
        return
    lines = bodies.polylines(scene["bridges"] + thick * scene["bridge_lift"], scene["bridge_sizes"])
    lines.point_data["gap"] = scene["bridge_gap"]
    bodies.add_coloured_tubes(window, lines, 1.4 * thick, "gap", GAPS, float(scene["max_gap"]))


def marks(most: float) -> list[tuple[float, str]]:
    """Round values from 0 to most: their share of it, and their words."""
    step = round_below(float(most) / 3.0)
    values = step * np.arange(int(most / step * (1.0 + 1e-9)) + 1)
    return [(float(value / most), f"{value:.4g}") for value in values]
