"""Pictures of a map: the part coloured by it, with a scale, and glyphs of directions where there are some."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.colours import colour_map
from meshwind.pictures import bodies, canvas
from meshwind.pictures.page import page_of

_ARC = 12
"""Segments of a glyph's arc."""


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """The picture of a map, with words."""
    page = page_of(scene)
    scale = canvas.fitting(page, scene)
    colours = colour_map(str(scene["colours"]))
    bodies.add_map(window, scene, colours)
    if "glyph_points" in scene:
        add_fans(window, scene)
    canvas.aim(window, page, scene, scene["centre"], canvas.middle(canvas.room(page)), scale)
    image = canvas.shot(window, page)
    pen = canvas.titled(image, page, scene)
    if len(scene.get("glyph_points", ())):
        canvas.note(pen, page, ["fans: directions", "that press; none", "where all but all do"])
    bar(image, pen, scene)
    canvas.ruler(pen, page, scale, str(scene["units"]))
    canvas.axes(pen, page, scene)
    return image


def bar(image: Any, pen: Any, scene: dict[str, Any]) -> None:
    """The scale of a scene that holds `Scale.told`."""
    words = [str(word) for word in scene["words"]]
    marks = [(float(share), str(told)) for share, told in zip(scene["marks"], scene["mark_words"], strict=True)]
    canvas.colour_bar(image, pen, page_of(scene), colour_map(str(scene["colours"])), words, marks)


def add_fans(window: Any, scene: dict[str, Any]) -> None:
    """Two flat sectors about each direction, as wide as the fibres that press."""
    count = len(scene["glyph_points"])
    if not count:
        return
    normal = scene["glyph_normals"] / np.linalg.norm(scene["glyph_normals"], axis=1, keepdims=True)
    ahead = scene["glyph_directions"]
    aside = np.cross(normal, ahead)
    turn = scene["glyph_reach"][:, None] * np.linspace(-1.0, 1.0, _ARC + 1)
    arc = np.cos(turn)[..., None] * ahead[:, None] + np.sin(turn)[..., None] * aside[:, None]
    size = float(scene["glyph_size"])
    tip = scene["glyph_points"] + size * scene["eye"]  # towards the eye, so that no bend of the part cuts them
    rim = np.concatenate([size * arc, -size * arc], axis=1) + tip[:, None]
    points = np.concatenate([tip[:, None], rim], axis=1)
    k = np.arange(1, _ARC + 1)
    fan = np.concatenate([np.stack([0 * k, k + start, k + start + 1], axis=1) for start in (0, _ARC + 1)])
    faces = (fan[None] + np.arange(count)[:, None, None] * points.shape[1]).reshape(-1, 3)
    fans = pv.PolyData.from_regular_faces(points.reshape(-1, 3), faces)
    window.add_mesh(fans, color=canvas.INK, lighting=False, render=False)
