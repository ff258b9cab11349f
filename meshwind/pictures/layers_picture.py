"""layers.png: the part by the layers of band over each place, in steps, with what is bare in a signal colour."""

from typing import Any

from meshwind.appearance.looks import rgb
from meshwind.pictures import bodies, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import LayersScene


def draw(window: Any, scene: LayersScene, page: Page) -> Any:
    """Draw the part in the colours of its steps, which do not blend, with text."""
    view = scene.frame.view
    canvas.add_smooth(window, bodies.body(scene.part), color=canvas.INSIDE, ambient=0.25, culling="front")
    outside = bodies.body(scene.part)
    outside.cell_data["colour"] = rgb(scene.colours)[scene.steps]
    canvas.add_smooth(window, outside, scalars="colour", rgb=True, ambient=0.6, diffuse=0.45, culling="back")
    image = canvas.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    canvas.legend(pen, page, list(zip(scene.colours, scene.words, strict=True)))
    canvas.ruler(pen, page, canvas.fitting(page, view), scene.frame.units)
    canvas.axes(pen, page, view)
    return image
