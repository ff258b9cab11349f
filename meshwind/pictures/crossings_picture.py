"""crossings.png: the crossings of the two families, coloured by the angle between them."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.colours import colour_map
from meshwind.pictures import bodies, canvas, map_picture
from meshwind.pictures.page import page_of

FIBRE = "#a9a296"
_DOT = 9.0, 0.3
"""Radius of a dot: so many pixels, but no more than this part of the pitch."""
_RINGED = 4.0
"""Smaller dots have no ring."""


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """The picture of the crossings, with words."""
    page = page_of(scene)
    scale = canvas.fitting(page, scene)
    thick = 0.6 * bodies.radius(scene, scale, page.unit)
    bodies.add_part(window, scene)
    bodies.add_fibres(window, scene, thick, {1: FIBRE, -1: FIBRE})
    add_dots(window, scene, scale, page.unit, thick)
    canvas.aim(window, page, scene, scene["centre"], canvas.middle(canvas.room(page)), scale)
    image = canvas.shot(window, page)
    pen = canvas.titled(image, page, scene)
    canvas.legend(pen, page, [(FIBRE, "fibres")])
    map_picture.bar(image, pen, scene)
    canvas.ruler(pen, page, scale, str(scene["units"]))
    canvas.axes(pen, page, scene)
    return image


def add_dots(window: Any, scene: dict[str, Any], scale: float, unit: float, thick: float) -> None:
    """A dot a crossing, in a ring of ink so that pale ones stand out, unless they are too many for that."""
    if not len(scene["crossings"]):
        return
    pixels, share = _DOT
    size = min(pixels * unit, max(share * float(scene["pitch"]) / scale, 1.5 * unit))
    at = scene["crossings"] + 2.0 * thick * scene["crossing_normals"]
    eye = scene["eye"]
    ring = (2.0 * size + 3.0 * unit, 0.0, {"color": canvas.INK})
    core = (2.0 * size, size * scale, {"scalars": "share", "cmap": colour_map(str(scene["colours"]))})
    for wide, behind, look in (ring, core) if size > _RINGED * unit else (core,):
        dots = pv.PolyData(at + behind * eye)
        dots.point_data["share"] = np.asarray(scene["shares"])
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
