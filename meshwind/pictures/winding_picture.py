"""winding.png: the part, the fibres of both families, and the bridges coloured by their gap."""

from typing import Any

import numpy as np

from meshwind.appearance.looks import colour_map, round_below
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import Fibres, WindingScene

GAPS = colour_map("gap")


def draw(window: Any, scene: WindingScene, page: Page) -> Any:
    """Draw the part and its fibres, with text."""
    scale = canvas.fitting(page, scene.frame.view)
    stroke = bodies.stroke(scene.part, scale, page.unit)
    bodies.add_part(window, scene.part)
    bodies.add_fibres(window, scene.fibres, stroke)
    add_bridges(window, scene, stroke)
    return lettered(camera.portrait(window, page, scene.frame.view, scene.part.points), scene, page)


def lettered(image: Any, scene: WindingScene, page: Page) -> Any:
    """The image with its title, legend, scale of gaps, ruler and axes."""
    frame = scene.frame
    pen = canvas.titled(image, page, frame)
    canvas.legend(pen, page, families(scene.fibres))
    if scene.max_gap > 0.0:
        words = ["bridges:", f"gap in {frame.units}" if frame.units else "gap"]
        canvas.colour_bar(image, pen, page, GAPS, words, marks(scene.max_gap))
    canvas.ruler(pen, page, canvas.fitting(page, frame.view), frame.units)
    canvas.axes(pen, page, frame.view)
    return image


def families(fibres: Fibres) -> list[tuple[str, str]]:
    """Rows of the legend: colour and name of each family."""
    rows = [(canvas.FAMILY[name], words) for name, words in canvas.NAMES.items()]
    return rows if fibres.converged.all() else [*rows, (canvas.LOOSE, "not at rest")]


def add_bridges(window: Any, scene: WindingScene, stroke: bodies.Stroke) -> None:
    """Add the spans off the surface, thicker and coloured by their gap."""
    bridges = scene.bridges
    if not len(bridges.points):
        return
    lines = bodies.polylines(bridges.points + stroke.radius * bridges.lift, bridges.sizes)
    lines.point_data["gap"] = bridges.gap
    bodies.add_strokes(window, lines, stroke.times(1.4), **bodies.coloured("gap", GAPS, scene.max_gap))


def marks(most: float) -> list[tuple[float, str]]:
    """Round values from 0 to `most`: their positions and their text."""
    step = round_below(most / 3.0)
    values = step * np.arange(int(most / step * (1.0 + 1e-9)) + 1)
    return [(float(value / most), f"{value:.4g}") for value in values]
