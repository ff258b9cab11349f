"""What the pictures share: size, colours, typeface, light, ruler and axes."""

from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib import get_data_path
from PIL import Image, ImageDraw, ImageFont

SIZE = (1600, 1200)
LEFT, RIGHT, TOP, BOTTOM = 60, 285, 150, 120
"""Margins in pixels around the part: the title above, the scale below, the legend to the right."""
PAPER, INK, FAINT = "#ffffff", "#1c1c1c", "#5a5a5a"
PART, INSIDE = "#e6e2da", "#8f8a82"
BAR = (SIZE[0] - RIGHT + 20, 470, 930, 34)
"""The colour scale: left, top, bottom and width."""


def plotter() -> Any:
    """An empty window off the screen, its graphics proved to work."""
    window = pv.Plotter(off_screen=True, window_size=list(SIZE), lighting="none")
    window.add_mesh(pv.Sphere(theta_resolution=4, phi_resolution=4))
    window.enable_anti_aliasing("msaa", multi_samples=4)
    window.show(auto_close=False)
    return window


def add_smooth(window: Any, mesh: Any, **look: Any) -> None:
    """Add a mesh that brings its normals: `smooth_shading` would compute them anew, a third of the time."""
    actor = window.add_mesh(mesh, render=False, **look)
    actor.prop.interpolation = "Phong"


def aim(window: Any, scene: dict[str, Any], target: Any, middle: tuple[float, float], scale: float) -> None:
    """Look at a target (3,) so that it comes to a place in pixels, at so many mesh units a pixel."""
    right, up, eye = scene["right"], scene["up"], scene["eye"]
    off = 0.5 * SIZE[0] - middle[0], middle[1] - 0.5 * SIZE[1]
    focus = target + scale * (off[0] * right + off[1] * up)
    reach = 4.0 * float(np.linalg.norm(scene["extent"]))
    window.camera_position = [focus + reach * eye, focus, up]
    window.enable_parallel_projection()
    window.parallel_scale = 0.5 * SIZE[1] * scale
    window.set_background(PAPER)
    window.remove_all_lights()
    for x, y, strength in ((-0.6, 0.6, 0.68), (0.9, 0.0, 0.35)):  # a key from the upper left, a fill
        light = pv.Light(position=focus + reach * (eye + x * right + y * up), focal_point=focus, intensity=strength)
        light.positional = False
        window.add_light(light)
    window.reset_camera_clipping_range()


def shot(window: Any) -> Any:
    """The picture as it stands."""
    window.render()
    return Image.fromarray(window.screenshot(return_img=True))


def titled(image: Any, scene: dict[str, Any]) -> Any:
    """A pen for the image, its title and subtitle written."""
    pen = ImageDraw.Draw(image)
    pen.text((LEFT, 36), str(scene["title"]), INK, font=face(38))
    pen.text((LEFT, 88), str(scene["subtitle"]), FAINT, font=face(25))
    return pen


def face(size: int) -> Any:
    """The typeface that comes with Matplotlib, so that the picture is the same on every machine."""
    return ImageFont.truetype(str(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")), size)


def colour_bar(image: Any, pen: Any, colours: Any, words: list[str], marks: list[tuple[float, str]]) -> None:
    """A scale of colours with lines of words above it and marks at shares of its height, 0 below."""
    x, top, bottom, width = BAR
    shade = colours(np.linspace(1.0, 0.0, bottom - top))[:, None, :3]
    bar = np.repeat((255 * shade).astype(np.uint8), width, axis=1)
    image.paste(Image.fromarray(bar), (x, top))
    pen.rectangle((x, top, x + width, bottom), outline=INK)
    for k, line in enumerate(words):
        pen.text((x, top - 50 - 34 * (len(words) - 1 - k)), line, INK, font=face(25))
    for share, told in marks:
        y = bottom - (bottom - top) * share
        pen.line((x + width, y, x + width + 8, y), fill=INK)
        pen.text((x + width + 16, y), told, INK, font=face(21), anchor="lm")


def ruler(
    pen: Any, scale: float, units: str, left: float = LEFT, base: float = SIZE[1] - 52.0, most: int = 320
) -> None:
    """A bar of a round length, at most so many pixels, at so many mesh units a pixel."""
    length = round_below(most * scale)
    reach = length / scale
    pen.rectangle((left, base - 4, left + reach, base + 4), fill=INK)
    pen.text((left + reach + 16, base), f"{length:g} {units}".strip(), INK, font=face(25), anchor="lm")


def axes(pen: Any, scene: dict[str, Any]) -> None:
    """The model's axes as they point on the picture, the one towards the eye drawn last."""
    toward = scene["eye"]
    middle, reach = np.array([SIZE[0] - RIGHT + 110.0, SIZE[1] - 110.0]), 62.0
    flat = np.stack([scene["right"], -scene["up"]], axis=1)
    labels: list[Any] = []
    for axis in np.argsort(toward):
        tip = middle + reach * flat[axis]
        colour = INK if toward[axis] > -0.2 else FAINT
        pen.line((*middle, *tip), fill=colour, width=4)
        # an axis that points at the eye is all but a dot: its name goes where the other two are not
        plain = bool(np.linalg.norm(flat[axis]) > 0.2)
        away = flat[axis] if plain else -flat.sum(axis=0)
        away = away / np.linalg.norm(away)
        label = (tip if plain else middle) + 22.0 * away
        if any(np.linalg.norm(label - other) < 24.0 for other in labels):  # two axes that look like one
            label = label + 24.0 * np.array([-away[1], away[0]])
        labels.append(label)
        pen.text(tuple(label), "xyz"[axis], colour, font=face(25), anchor="mm")


def round_below(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= value * (1.0 + 1e-12)))
