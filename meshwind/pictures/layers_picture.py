"""layers.png: the part by the layers of band over each place, in steps, with what is bare in a signal colour."""

from typing import Any

import pyvista as pv

from meshwind.appearance.looks import rgb
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import LayersScene


def draw(window: Any, scene: LayersScene, page: Page) -> Any:
    """Draw the part in the colours of its steps, with text."""
    view = scene.frame.view
    bodies.add_smooth(window, bodies.body(scene.part), color=canvas.INSIDE, ambient=0.25, culling="front")
    outside = bodies.body(scene.part)
    outside.active_texture_coordinates = scene.uv
    # an image on the part, as its cells are many more than the quads that show its shape
    image = rgb(scene.colours)[scene.steps.T[::-1]]
    texture = pv.Texture(image)
    texture.interpolate = True  # without smaller copies, for which it would be resampled
    texture.wrap = pv.Texture.WrapType.CLAMP_TO_EDGE
    bodies.add_smooth(window, outside, texture=texture, color="white", ambient=0.6, diffuse=0.45, culling="back")
    drawn = camera.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(drawn, page, scene.frame)
    canvas.legend(pen, page, list(zip(scene.colours, scene.words, strict=True)))
    canvas.ruler(pen, page, canvas.fitting(page, view), scene.frame.units)
    canvas.axes(pen, page, view)
    return drawn
