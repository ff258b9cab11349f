"""hits.png: free spans and eyes of a program that meet the part, and where the fibre goes astray."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import SIGNAL
from meshwind.core.cast import Floats
from meshwind.pictures import bodies, camera, canvas, filament_picture
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import HitsScene

_SPAN, _EYE, _ASTRAY = SIGNAL, "#1f4e79", "#b35806"
_THIN, _MARK = 1.6, 6.0
"""Radius in pixels of a span's tube, and of the mark where it meets the part."""
_THROUGH = 0.35
"""Opacity of what is seen through the part."""


def draw(window: Any, scene: HitsScene, page: Page) -> Any:
    """Draw the part with the spans and marks, with text."""
    view = scene.frame.view
    pixel = canvas.fitting(page, view)
    bodies.add_part(window, scene.part)
    filament_picture.add_gear(window, scene.gear)
    nearer = 2.0 * float(np.linalg.norm([view.width, view.height])) * view.eye
    if len(scene.spans):
        tubes = bodies.polylines(scene.spans.reshape(-1, 3), np.full(len(scene.spans), 2)).tube(
            radius=_THIN * page.unit * pixel, n_sides=8
        )
        _both(window, tubes, _SPAN, nearer)
    for places, colour in ((scene.entries, _SPAN), (scene.eyes, _EYE), (scene.astray, _ASTRAY)):
        if len(places):
            _both(window, _balls(places, _MARK * page.unit * pixel), colour, nearer)
    image = camera.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    rows = [
        (colour, words)
        for colour, words, shown in (
            (_SPAN, "span that hits", scene.spans), (_EYE, "eye that hits", scene.eyes),
            (_ASTRAY, "lies elsewhere", scene.astray), (filament_picture.HELD, scene.gear.held_words, scene.gear.held),
        )
        if len(shown) and words
    ]  # fmt: skip
    canvas.legend(pen, page, rows)
    canvas.note(pen, page, list(scene.notes), below=len(rows) + 1)
    canvas.ruler(pen, page, pixel, scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def _both(window: Any, body: Any, colour: str, nearer: Floats) -> None:
    """Add a body, and a pale copy in front of all, so that it is seen where the part hides it."""
    window.add_mesh(body, color=colour, ambient=0.6, diffuse=0.5, render=False)
    window.add_mesh(body.translate(nearer, inplace=False), color=colour, lighting=False, opacity=_THROUGH, render=False)


def _balls(places: Floats, radius: float) -> Any:
    """Balls at places (k, 3)."""
    return pv.PolyData(places).glyph(geom=pv.Sphere(radius=radius, theta_resolution=14, phi_resolution=14), scale=False)
