"""Draws a scene in a process of its own: `python -P renderer.py < scene.npz`.  Imports nothing of meshwind.

Says "ready" once the machine has proved that it can draw; without input after that it ends quietly.
"""

import io
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv
from matplotlib import colormaps, get_data_path
from matplotlib.colors import ListedColormap
from PIL import Image, ImageDraw, ImageFont

SIZE = (1600, 1200)
LEFT, RIGHT, TOP, BOTTOM = 60, 285, 150, 120
"""Margins in pixels around the part: the title above, the scale below, the legend to the right."""
PAPER, INK, FAINT = "#ffffff", "#1c1c1c", "#5a5a5a"
PART, INSIDE = "#e6e2da", "#8f8a82"
FAMILY = {1: "#0072b2", -1: "#e69f00"}  # Okabe and Ito's blue and orange: told apart by every eye
LOOSE = "#7a7a7a"
GAPS = ListedColormap(colormaps["RdPu"](np.linspace(0.3, 1.0, 256)))
"""Pale where a bridge all but touches, dark where the gap is wide: what matters stands out, in greys too."""


def main() -> None:
    """Prove that the machine draws, read a scene, draw it."""
    plotter = pv.Plotter(off_screen=True, window_size=list(SIZE), lighting="none")
    plotter.add_mesh(pv.Sphere(theta_resolution=4, phi_resolution=4))
    plotter.enable_anti_aliasing("msaa", multi_samples=4)
    plotter.show(auto_close=False)
    sys.stdout.write("ready\n")
    sys.stdout.flush()
    packed = sys.stdin.buffer.read()
    if packed:
        plotter.clear_actors()
        with np.load(io.BytesIO(packed)) as scene:
            draw(plotter, dict(scene))
    plotter.close()


def draw(plotter: Any, scene: dict[str, Any]) -> None:
    """Draw the part and its fibres, then the words, and save the picture."""
    scale = mesh_units_per_pixel(scene["extent"])
    radius = min(3.0 * scale, 0.16 * float(scene["pitch"]))
    add_part(plotter, scene)
    add_fibres(plotter, scene, radius)
    add_bridges(plotter, scene, radius)
    aim(plotter, scene, scale)
    plotter.render()
    image = Image.fromarray(plotter.screenshot(return_img=True))
    annotate(image, scene, scale)
    image.save(str(scene["picture"]), compress_level=1)


def mesh_units_per_pixel(extent: Any) -> float:
    """The scale at which the part fills the room between the margins."""
    room = (SIZE[0] - LEFT - RIGHT, SIZE[1] - TOP - BOTTOM)
    return float(max(extent[0] / room[0], extent[1] / room[1]))


def add_part(plotter: Any, scene: dict[str, Any]) -> None:
    """The fitted surface, matt, darker inside."""
    part = pv.PolyData.from_regular_faces(scene["points"], scene["quads"])
    part.point_data["Normals"] = scene["normals"] / np.linalg.norm(scene["normals"], axis=1, keepdims=True)
    part.point_data.active_normals_name = "Normals"
    add_smooth(
        plotter,
        part,
        color=PART,
        ambient=0.3,
        diffuse=0.8,
        backface_params={"color": INSIDE, "ambient": 0.25, "interpolation": "Phong"},
    )


def add_smooth(plotter: Any, mesh: Any, **look: Any) -> None:
    """Add a mesh that brings its normals: `smooth_shading` would compute them anew, a third of the time."""
    actor = plotter.add_mesh(mesh, **look)
    actor.prop.interpolation = "Phong"


def add_fibres(plotter: Any, scene: dict[str, Any], radius: float) -> None:
    """Both families as tubes lifted by their radius, so that they lie on the part and do not sink in."""
    size = scene["paths"].shape[1]
    points = scene["paths"] + radius * scene["path_lift"]
    for name, colour in FAMILY.items():
        add_tubes(plotter, points[(scene["family"] == name) & scene["taut"]], size, radius, colour)
    add_tubes(plotter, points[~scene["taut"]], size, 0.6 * radius, LOOSE)


def add_tubes(plotter: Any, points: Any, size: int, radius: float, colour: str) -> None:
    """Tubes around paths (p, size, 3)."""
    if len(points):
        lines = polylines(points.reshape(-1, 3), np.full(len(points), size))
        add_smooth(plotter, lines.tube(radius=radius, n_sides=8), color=colour, ambient=0.4, diffuse=0.7)


def add_bridges(plotter: Any, scene: dict[str, Any], radius: float) -> None:
    """The spans off the surface, thicker and coloured by their gap."""
    if not len(scene["bridges"]):
        return
    lines = polylines(scene["bridges"] + radius * scene["bridge_lift"], scene["bridge_sizes"])
    lines.point_data["gap"] = scene["bridge_gap"]
    tubes = lines.tube(radius=1.4 * radius, n_sides=10)
    add_smooth(
        plotter,
        tubes,
        scalars="gap",
        cmap=GAPS,
        show_scalar_bar=False,
        clim=[0.0, float(scene["max_gap"])],
        ambient=0.4,
        diffuse=0.65,
    )


def polylines(points: Any, sizes: Any) -> Any:
    """Polylines over consecutive points."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    cells = np.insert(np.arange(len(points)), starts[:-1], sizes)
    return pv.PolyData(points, lines=cells)


def aim(plotter: Any, scene: dict[str, Any], scale: float) -> None:
    """Look square on; the part sits in the middle of the room between the margins."""
    shift = 0.5 * scale * ((RIGHT - LEFT) * scene["right"] + (BOTTOM - TOP) * -scene["up"])
    focus = scene["centre"] + shift
    reach = 4.0 * float(np.linalg.norm(scene["extent"]))
    plotter.camera_position = [focus + reach * scene["eye"], focus, scene["up"]]
    plotter.enable_parallel_projection()
    plotter.parallel_scale = 0.5 * SIZE[1] * scale
    plotter.set_background(PAPER)
    for x, y, strength in ((-0.6, 0.6, 0.68), (0.9, 0.0, 0.35)):  # a key from the upper left, a fill
        side = scene["eye"] + x * scene["right"] + y * scene["up"]
        light = pv.Light(position=focus + reach * side, focal_point=focus, intensity=strength)
        light.positional = False
        plotter.add_light(light)
    plotter.reset_camera_clipping_range()


def annotate(image: Any, scene: dict[str, Any], scale: float) -> None:
    """Title, legend, colour scale, ruler and axes."""
    pen = ImageDraw.Draw(image)
    pen.text((LEFT, 36), str(scene["title"]), INK, font=face(38))
    pen.text((LEFT, 88), str(scene["subtitle"]), FAINT, font=face(25))
    legend(pen, scene)
    if len(scene["bridges"]):
        colour_scale(image, pen, float(scene["max_gap"]), str(scene["units"]))
    ruler(pen, scale, str(scene["units"]))
    axes(pen, scene)


def face(size: int) -> Any:
    """The typeface that comes with Matplotlib, so that the picture is the same on every machine."""
    return ImageFont.truetype(str(Path(get_data_path(), "fonts", "ttf", "DejaVuSans.ttf")), size)


def legend(pen: Any, scene: dict[str, Any]) -> None:
    """Which colour is which family."""
    x, y = SIZE[0] - RIGHT + 20, TOP + 40
    rows = [(FAMILY[1], "family +1"), (FAMILY[-1], "family −1")]
    if not scene["taut"].all():
        rows.append((LOOSE, "not at rest"))
    for k, (colour, words) in enumerate(rows):
        pen.rectangle((x, y + 44 * k + 10, x + 44, y + 44 * k + 17), fill=colour)
        pen.text((x + 58, y + 44 * k), words, INK, font=face(25))


def colour_scale(image: Any, pen: Any, most: float, units: str) -> None:
    """The gap of the bridges, 0 below."""
    x, top, bottom, width = SIZE[0] - RIGHT + 20, 470, 930, 34
    shade = GAPS(np.linspace(1.0, 0.0, bottom - top))[:, None, :3]
    bar = np.repeat((255 * shade).astype(np.uint8), width, axis=1)
    image.paste(Image.fromarray(bar), (x, top))
    pen.rectangle((x, top, x + width, bottom), outline=INK)
    pen.text((x, top - 84), "bridges:", INK, font=face(25))
    pen.text((x, top - 50), f"gap in {units}" if units else "gap", INK, font=face(25))
    for tick in ticks(most):
        y = bottom - (bottom - top) * tick / most
        pen.line((x + width, y, x + width + 8, y), fill=INK)
        pen.text((x + width + 16, y), f"{tick:.4g}", INK, font=face(23), anchor="lm")


def ruler(pen: Any, scale: float, units: str) -> None:
    """A bar of a round length at the picture's own scale."""
    length = round_below(320.0 * scale)
    x, y, reach = LEFT, SIZE[1] - 52, length / scale
    pen.rectangle((x, y - 4, x + reach, y + 4), fill=INK)
    pen.text((x + reach + 16, y), f"{length:g} {units}".strip(), INK, font=face(25), anchor="lm")


def axes(pen: Any, scene: dict[str, Any]) -> None:
    """The model's axes as they point on the picture, the one towards the eye drawn last."""
    toward = scene["eye"]
    middle, reach = np.array([SIZE[0] - RIGHT + 110.0, SIZE[1] - 110.0]), 62.0
    flat = np.stack([scene["right"], -scene["up"]], axis=1)
    for axis in np.argsort(toward):
        tip = middle + reach * flat[axis]
        colour = INK if toward[axis] > -0.2 else FAINT
        pen.line((*middle, *tip), fill=colour, width=4)
        # an axis that points at the eye is all but a dot: its name goes where the other two are not
        plain = bool(np.linalg.norm(flat[axis]) > 0.2)
        away = flat[axis] if plain else -flat.sum(axis=0)
        label = (tip if plain else middle) + 22.0 * away / np.linalg.norm(away)
        pen.text(tuple(label), "xyz"[axis], colour, font=face(25), anchor="mm")


def round_below(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= value * (1.0 + 1e-12)))


def ticks(most: float) -> Any:
    """Round values from 0 to most."""
    step = round_below(most / 3.0)
    return step * np.arange(int(most / step * (1.0 + 1e-9)) + 1)


if __name__ == "__main__":
    main()
