"""The window that parts are drawn in: its camera, its lights, and pictures of it."""

from typing import Any

import numpy as np
import pyvista as pv
from PIL import Image

from meshwind.appearance.view import View
from meshwind.core.cast import Floats
from meshwind.pictures import canvas
from meshwind.pictures.page import Page

_PROBE = [160, 120]
"""Size of the window while it is tested: a page takes ten times as long."""
_ANGLE = np.radians(15.0)
"""Half the angle of view in perspective."""


def plotter() -> Any:
    """An empty off-screen window, after a test that its graphics work."""
    window = pv.Plotter(off_screen=True, window_size=_PROBE, lighting="none")
    window.add_mesh(pv.Sphere(theta_resolution=4, phi_resolution=4))
    window.enable_anti_aliasing("msaa", multi_samples=4)
    window.show(auto_close=False)
    return window


def portrait(window: Any, page: Page, view: View, points: Floats) -> Any:
    """Picture of the window's contents in the middle of the room for it, from both sides where there is room for two.

    points (k, 3): of the part.
    """
    boxes, scale = canvas.rooms(page, view), canvas.fitting(page, view)
    if len(boxes) == 1:
        aim(window, page, view, points, view.centre, canvas.middle(boxes[0]), scale)
        image = shot(window, page)
    else:
        box = boxes[1]
        half = round(box[0] - 0.5 * page.unit * canvas.BETWEEN), round(box[1] - 0.5 * page.unit * canvas.BETWEEN)
        corner = (half[0], 0) if view.upright else (0, half[1])
        first = (half[0], page.height) if view.upright else (page.width, half[1])
        last = page.width - corner[0], page.height - corner[1]
        image = canvas.blank(page)
        # a window for each half: the other half of a page would be drawn in vain
        sides = (first, view, boxes[0], (0, 0)), (last, view.other, box, corner)
        for size, seen, within, left in sides:
            x, y = canvas.middle(within)
            aim(window, page, seen, points, view.centre, (x - left[0], y - left[1]), scale, size)
            image.paste(shot(window, page, size), left)
        at = box[0] + 0.5 * box[2], page.height - page.unit * (canvas.BOTTOM - 30)
        canvas.pen(image).text(at, "from the other side", canvas.FAINT, font=canvas.face(page, 21), anchor="mm")
    return image


def aim(
    window: Any,
    page: Page,
    view: View,
    points: Floats,
    target: Floats,
    at: tuple[float, float],
    scale: float,
    size: tuple[int, int] | None = None,
) -> None:
    """Aim the camera so that a target (3,) appears at a position in pixels; scale: mesh units per pixel.

    points (k, 3): of the part, which the eye stays in front of in perspective; size: of the window, by default the
    page's.
    """
    right, up, eye = view.right, view.up, view.eye
    width, height = size or (page.width, page.height)
    off = 0.5 * width - at[0], at[1] - 0.5 * height
    focus = target + scale * (off[0] * right + off[1] * up)
    half = 0.5 * height * scale
    reach = 4.0 * float(np.linalg.norm([view.width, view.height]))
    if page.perspective:  # the nearest point appears as large as in parallel projection, so that nothing is cut off
        reach = half / np.tan(_ANGLE) + 0.5 * float(np.ptp(points @ eye))
    window.camera_position = [focus + reach * eye, focus, up]
    window.camera.parallel_projection = not page.perspective  # the window's own method would move the camera
    window.camera.parallel_scale = half
    window.camera.view_angle = float(np.degrees(2.0 * _ANGLE))
    window.set_background(canvas.PAPER)
    window.remove_all_lights()
    for x, y, strength in ((-0.6, 0.6, 0.68), (0.9, 0.0, 0.35)):  # a key light from the upper left, a fill light
        light = pv.Light(position=focus + reach * (eye + x * right + y * up), focal_point=focus, intensity=strength)
        light.positional = False
        window.add_light(light)
    window.reset_camera_clipping_range()


def shot(window: Any, page: Page, size: tuple[int, int] | None = None) -> Any:
    """Picture of the window in a size, by default the page's."""
    size = size or (page.width, page.height)
    if tuple(window.window_size) != size:
        window.render_window.SetSize(*size)  # the window's own method would render as well
    window.render()
    return Image.fromarray(window.screenshot(return_img=True, transparent_background=page.transparent))
