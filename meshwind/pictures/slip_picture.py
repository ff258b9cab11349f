"""slip.png: fibres coloured by the friction they need, grey where they leave the surface."""

from typing import Any

import numpy as np

from meshwind.appearance.colours import colour_map
from meshwind.pictures import bodies, canvas, map_picture
from meshwind.pictures.page import page_of

OFF = "#8c857a"


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """The picture of the slip, with words."""
    page = page_of(scene)
    scale = canvas.fitting(page, scene)
    thick = bodies.radius(scene, scale, page.unit)
    bodies.add_part(window, scene)
    bodies.add_tubes(window, *_laid(scene, ~scene["taut"], thick), 0.6 * thick, bodies.LOOSE)
    _add_known(window, scene, thick)
    canvas.aim(window, page, scene, scene["centre"], canvas.middle(canvas.room(page)), scale)
    image = canvas.shot(window, page)
    pen = canvas.titled(image, page, scene)
    rows = [(OFF, "off the surface")] if scene["bridges"] else []
    if not scene["needed"]:
        rows = [(_zero(scene), "needs none"), *rows]
    canvas.legend(pen, page, rows if scene["taut"].all() else [(bodies.LOOSE, "not at rest"), *rows])
    if scene["needed"]:
        map_picture.bar(image, pen, scene)
    canvas.ruler(pen, page, scale, str(scene["units"]))
    canvas.axes(pen, page, scene)
    return image


def _laid(scene: dict[str, Any], which: Any, thick: float) -> tuple[Any, int]:
    """Points of the chosen fibres, lifted to lie on the part, and how many each has."""
    return (scene["paths"] + thick * scene["path_lift"])[which], scene["paths"].shape[1]


def _add_known(window: Any, scene: dict[str, Any], thick: float) -> None:
    """Fibres at rest: coloured between particles whose slip is known, thin and grey between others."""
    points, _ = _laid(scene, scene["taut"], thick)
    shares = scene["shares"][scene["taut"]]
    known = np.isfinite(shares[:, 1:]) & np.isfinite(shares[:, :-1])
    grey, lines = runs(points, shares, ~known), runs(points, shares, known)
    if grey is not None:
        canvas.add_smooth(
            window,
            grey.tube(radius=0.7 * thick, n_sides=bodies.sides(grey.n_points)),
            color=OFF,
            ambient=0.4,
            diffuse=0.7,
        )
    if lines is not None:
        colours = colour_map(str(scene["colours"]))
        bodies.add_coloured_tubes(window, lines, thick, "share", colours, 1.0)


def runs(points: Any, shares: Any, wanted: Any) -> Any:
    """Polylines over each run of wanted segments (p, n - 1) of paths (p, n, 3), with their shares; None without one."""
    padded = np.pad(wanted, ((0, 0), (1, 1))).astype(np.int8)
    path, first = np.nonzero(np.diff(padded, axis=1) == 1)
    _, last = np.nonzero(np.diff(padded, axis=1) == -1)
    if not len(path):
        return None
    sizes = last - first + 1
    row = np.repeat(path, sizes)
    column = np.arange(sizes.sum()) - np.repeat(np.cumsum(sizes) - sizes - first, sizes)
    lines = bodies.polylines(points[row, column], sizes)
    lines.point_data["share"] = shares[row, column]
    return lines


def _zero(scene: dict[str, Any]) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour_map(str(scene["colours"]))(0.0)[:3])
