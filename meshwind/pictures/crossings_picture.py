"""crossings.png: the crossings of the two families, coloured by the angle between them."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import colour_map
from meshwind.pictures import bodies, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import CrossingsScene

FIBRE = "#a9a296"
_DOT = 9.0, 0.3
"""Radius of a dot in pixels, and its upper limit over the pitch."""
_RINGED = 4.0
"""Least radius of a dot with a ring, in pixels."""


def draw(window: Any, scene: CrossingsScene, page: Page) -> Any:
    """Draw the crossings, with text."""
    view = scene.frame.view
    scale = canvas.fitting(page, view)
    thick = 0.6 * bodies.radius(scene.part, scale, page.unit)
    bodies.add_part(window, scene.part)
    bodies.add_fibres(window, scene.fibres, thick, {1: FIBRE, -1: FIBRE})
    add_dots(window, scene, scale, page.unit, thick)
    image = canvas.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    canvas.legend(pen, page, [(FIBRE, "fibres")])
    canvas.scale_bar(image, pen, page, scene.scale)
    canvas.ruler(pen, page, scale, scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def add_dots(window: Any, scene: CrossingsScene, scale: float, unit: float, thick: float) -> None:
    """Add a dot per crossing, in a dark ring unless dots are small, so that pale ones stand out."""
    if not len(scene.points):
        return
    pixels, share = _DOT
    size = min(pixels * unit, max(share * scene.part.pitch / scale, 1.5 * unit))
    at = scene.points + 2.0 * thick * scene.normals
    eye = scene.frame.view.eye
    ring = (2.0 * size + 3.0 * unit, 0.0, {"color": canvas.INK})
    core = (2.0 * size, size * scale, {"scalars": "share", "cmap": colour_map(scene.scale.colours)})
    for wide, behind, look in (ring, core) if size > _RINGED * unit else (core,):
        dots = pv.PolyData(at + behind * eye)
        dots.point_data["share"] = np.asarray(scene.shares)
        window.add_mesh(
            dots,
            style="points",
            render_points_as_spheres=True,
            point_size=wide,
            lighting=False,
            clim=[0.0, 1.0],
            show_scalar_bar=False,
            render=False,
            **look,
        )
