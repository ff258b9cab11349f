"""fit_error.png: the mesh, the surface that was fitted to it, and the worst place from near, by their distance."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.colours import colour_map
from meshwind.pictures import canvas
from meshwind.pictures.canvas import FAINT, INK, PAPER, Box, face
from meshwind.pictures.page import Page, page_of

DISTANCES = colour_map("distance")
FAINTEST = 0.05
"""The scale is logarithmic from the worst down to this part of it, and palest for all that is less."""
LOST = 0.15
"""A vertex of the mesh that is further off than this part of the worst is drawn over the surface."""
GLASS, MARK = "#0072b2", "#0072b2"
GAP, HEAD = 20, 44
"""Pixels between the views, and above each for its name."""
RING = 17
LEGIBLE = 14.0
"""Pixels that an edge of the mesh must be long for a net of them not to hide all else."""


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """Three views from one side, with words."""
    page = page_of(scene)
    image = canvas.blank(page)
    pen = canvas.titled(image, page, scene)
    boxes = cells(page, scene["extent"])
    inner = [below(page, box) for box in boxes]
    whole = max(float(scene["extent"][k]) / (inner[0][2 + k] - (40, 0)[k] * page.unit) for k in (0, 1))
    near = 2.0 * float(scene["close_up"]) / min(inner[2][2:])
    middle = scene["places"][0].mean(axis=0)
    views = (
        ("the mesh", ("mesh",), scene["centre"], whole, 0),
        ("the surface fitted to it", ("surface",), scene["centre"], whole, 1),
        ("place 1, lost mesh in blue", ("surface", "lost"), middle, near, 1),
    )
    for k, (name, bodies, target, scale, side) in enumerate(views):
        view(window, image, scene, inner[k], bodies, target, scale)
        pen.text(boxes[k][:2], name, INK, font=face(page, 25))
        seen = scene["seen"][:, side] | (np.arange(len(scene["places"])) == 0)
        shown = np.flatnonzero(seen) if k < 2 else np.array([0])
        rings(pen, page, inner[k], spots(scene, inner[k], target, scale, scene["places"][shown, side]), shown + 1)
    legend(image, pen, scene)
    units = str(scene["units"])
    canvas.ruler(pen, page, whole, units)
    half = 0.5 * (page.width / page.unit + canvas.LEFT - canvas.RIGHT) + 60
    canvas.ruler(pen, page, near, f"{units} at place 1".strip(), half)
    canvas.axes(pen, page, scene)
    return image


def cells(page: Page, extent: Any) -> list[Box]:
    """Left, top, width and height of three boxes: in a row, in a column, or two over one; as the part is largest."""
    left, top, width, height = canvas.room(page)
    gap, head = page.unit * GAP, page.unit * HEAD
    w, h = (width - 2 * gap) / 3, (height - 2 * gap) / 3
    row: list[Box] = [(left + k * (w + gap), top, w, height) for k in range(3)]
    column: list[Box] = [(left, top + k * (h + gap), width, h) for k in range(3)]
    w, h = (width - gap) / 2, (height - gap) / 2
    over: list[Box] = [(left, top, w, h), (left + w + gap, top, w, h), (left, top + h + gap, width, h)]
    return max((row, column, over), key=lambda boxes: min(boxes[0][2] / extent[0], (boxes[0][3] - head) / extent[1]))


def below(page: Page, box: Box) -> Box:
    """What its name leaves of a box."""
    left, top, width, height = box
    head = page.unit * HEAD
    return left, top + head, width, height - head


def view(window: Any, image: Any, scene: Any, box: Box, bodies: Any, target: Any, scale: float) -> None:
    """One view, its target in the middle of its box."""
    page = page_of(scene)
    left, top, width, height = (round(x) for x in box)
    window.clear_actors()
    for body in bodies:
        add(window, scene, body, scale)
    canvas.aim(window, page, scene, target, canvas.middle(box), scale)
    image.paste(canvas.shot(window, page).crop((left, top, left + width, top + height)), (left, top))


def add(window: Any, scene: Any, body: str, scale: float) -> None:
    """The mesh or the surface coloured by its distance to the other, or as blue glass what the surface lost of it."""
    name = "mesh" if body == "lost" else body
    faces, share = scene[f"{name}_faces"], scene[f"{name}_away"] / float(scene["most"])
    if body == "lost":
        faces = faces[(share[faces] > LOST).any(axis=1)]
        legible = float(scene["edge"]) > LEGIBLE * scale
        look = {"color": GLASS, "opacity": 0.3, "show_edges": legible, "edge_color": GLASS}
    else:
        look = {"scalars": "away", "cmap": DISTANCES, "clim": [0.0, 1.0], "show_scalar_bar": False}
    if len(faces):
        part = pv.PolyData.from_regular_faces(scene[f"{name}_points"], faces)
        part.point_data["away"] = 1.0 - np.log(np.maximum(share, FAINTEST)) / np.log(FAINTEST)
        window.add_mesh(part, ambient=0.4, diffuse=0.7, render=False, **look)


def spots(scene: Any, box: Box, target: Any, scale: float, points: Any) -> Any:
    """Where points (k, 3) come to lie in a view, in pixels (k, 2)."""
    flat = (points - target) @ np.stack([scene["right"], -scene["up"]], axis=1) / scale
    return flat + np.array(canvas.middle(box))


def rings(pen: Any, page: Page, box: Box, at: Any, numbers: Any) -> None:
    """A ring about each place in a view, then the numbers beside them: to the left where the view ends."""
    s = page.unit
    for x, y in at:
        for width, colour in ((7, PAPER), (3, MARK)):
            reach = s * (RING + width / 2)
            pen.ellipse((x - reach, y - reach, x + reach, y + reach), outline=colour, width=max(round(s * width), 1))
    look: dict[str, Any] = {"font": face(page, 28), "anchor": "mm", "stroke_width": round(4 * s), "stroke_fill": PAPER}
    for (x, y), number in zip(at, numbers, strict=True):
        side = -1 if x + s * (2 * RING + 16) > box[0] + box[2] else 1
        pen.text((x + side * s * (RING + 16), y - s * (RING + 8)), str(number), MARK, **look)


def legend(image: Any, pen: Any, scene: Any) -> None:
    """The places by number with their distance, and the scale of colours."""
    page = page_of(scene)
    s = page.unit
    x, y = canvas.legend_left(page), s * (canvas.TOP + 6)
    for k, away in enumerate(scene["away"]):
        shade = INK if scene["seen"][k].any() else FAINT
        pen.text((x, y + s * 38 * k), f"{k + 1}", MARK, font=face(page, 25))
        pen.text((x + s * 30, y + s * (38 * k + 2)), told(scene, float(away)), shade, font=face(page, 21))
    if not scene["seen"].any(axis=1).all():
        last = y + s * (38 * len(scene["away"]) + 2)
        pen.text((x, last), "grey: out of sight", FAINT, font=face(page, 21))
    units = str(scene["units"])
    words = ["distance" + (f" in {units}" if units else ""), "(% of the part)"]
    canvas.colour_bar(image, pen, page, DISTANCES, words, marks(scene))


def marks(scene: Any) -> list[tuple[float, str]]:
    """1, 2 and 5 times powers of ten on the scale, with their shares of the part."""
    most = float(scene["most"])
    powers = 10.0 ** np.arange(np.floor(np.log10(FAINTEST * most)), np.ceil(np.log10(most)) + 1)
    values = np.outer(powers, [1.0, 2.0, 5.0]).ravel()
    share = 1.0 - np.log(values / most) / np.log(FAINTEST)
    inside = (share >= 0.0) & (share <= 1.0)
    return [(float(share[k]), told(scene, float(values[k]))) for k in np.flatnonzero(inside)]


def told(scene: Any, away: float) -> str:
    """A distance and its share of the part."""
    return f"{away:.2g} ({100.0 * away / float(scene['diagonal']):.2g} %)"
