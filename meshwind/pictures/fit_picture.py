"""fit_error.png: the mesh and the fitted surface, coloured by their distance, and a close-up of the worst place."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import colour_map
from meshwind.core.cast import Floats, Ints
from meshwind.pictures import camera, canvas
from meshwind.pictures.bodies import coloured
from meshwind.pictures.canvas import FAINT, INK, PAPER, Box, face
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import FitScene

DISTANCES = colour_map("distance")
FAINTEST = 0.05
"""Lower end of the logarithmic scale over the largest distance; smaller distances get its palest colour."""
LOST = 0.15
"""Vertices of the mesh whose distance over the largest is more than this are drawn over the surface."""
GLASS, MARK = "#0072b2", "#0072b2"
GAP, HEAD = 20, 44
"""Pixels between the views, and above each view for its name."""
RING = 17
LEGIBLE = 14.0
"""Least length in pixels of the mesh's edges for them to be drawn."""
_MESH, _SURFACE, _LOST = "mesh", "surface", "lost"
"""Bodies in a view; the last is the part of the mesh that the surface misses."""


def draw(window: Any, scene: FitScene, page: Page) -> Any:
    """Draw three views from the same side, with text."""
    seen_from, units = scene.frame.view, scene.frame.units
    extent = seen_from.width, seen_from.height
    image = canvas.blank(page)
    pen = canvas.titled(image, page, scene.frame)
    boxes = cells(page, extent)
    inner = [below(page, box) for box in boxes]
    whole = max(extent[k] / (inner[0][2 + k] - (40, 0)[k] * page.unit) for k in (0, 1))
    near = 2.0 * scene.close_up / min(inner[2][2:])
    middle = scene.pairs[0].mean(axis=0)
    views = (
        ("the mesh", (_MESH,), seen_from.centre, whole, 0),
        ("the surface fitted to it", (_SURFACE,), seen_from.centre, whole, 1),
        ("place 1, lost mesh in blue", (_SURFACE, _LOST), middle, near, 1),
    )
    for k, (name, bodies, target, scale, side) in enumerate(views):
        window.clear_actors()
        for body in bodies:
            add(window, scene, body, scale)
        paste(window, image, page, scene, inner[k], target, scale)
        pen.text(boxes[k][:2], name, INK, font=face(page, 25))
        seen = scene.seen[:, side] | (np.arange(len(scene.pairs)) == 0)
        shown = np.flatnonzero(seen) if k < 2 else np.array([0])
        rings(pen, page, inner[k], spots(scene, inner[k], target, scale, scene.pairs[shown, side]), shown + 1)
    legend(image, pen, scene, page)
    canvas.ruler(pen, page, whole, units)
    half = 0.5 * (page.width / page.unit + canvas.LEFT - canvas.RIGHT) + 60
    canvas.ruler(pen, page, near, f"{units} at place 1".strip(), half)
    canvas.axes(pen, page, seen_from)
    return image


def cells(page: Page, extent: tuple[float, float]) -> list[Box]:
    """Three boxes in a row, in a column, or two over one, whichever shows the part largest."""
    left, top, width, height = canvas.room(page)
    gap, head = page.unit * GAP, page.unit * HEAD
    w, h = (width - 2 * gap) / 3, (height - 2 * gap) / 3
    row: list[Box] = [(left + k * (w + gap), top, w, height) for k in range(3)]
    column: list[Box] = [(left, top + k * (h + gap), width, h) for k in range(3)]
    w, h = (width - gap) / 2, (height - gap) / 2
    over: list[Box] = [(left, top, w, h), (left + w + gap, top, w, h), (left, top + h + gap, width, h)]
    return max((row, column, over), key=lambda boxes: min(boxes[0][2] / extent[0], (boxes[0][3] - head) / extent[1]))


def below(page: Page, box: Box) -> Box:
    """The box without the room for its name."""
    left, top, width, height = box
    head = page.unit * HEAD
    return left, top + head, width, height - head


def paste(window: Any, image: Any, page: Page, scene: FitScene, box: Box, target: Floats, scale: float) -> None:
    """Paste the window's view into a box of the image, its target in the middle."""
    left, top, width, height = (round(x) for x in box)
    camera.aim(window, page, scene.frame.view, scene.mesh.points, target, canvas.middle(box), scale)
    image.paste(camera.shot(window, page).crop((left, top, left + width, top + height)), (left, top))


def add(window: Any, scene: FitScene, name: str, scale: float) -> None:
    """The mesh or the surface coloured by its distance to the other, or in transparent blue what the surface misses."""
    body = scene.surface if name == _SURFACE else scene.mesh
    faces, share = body.faces, body.distances / scene.most
    if name == _LOST:
        faces = faces[(share[faces] > LOST).any(axis=1)]
        legible = scene.edge > LEGIBLE * scale
        look = {"color": GLASS, "opacity": 0.3, "show_edges": legible, "edge_color": GLASS}
    else:
        look = coloured("away", DISTANCES, 1.0)
    if len(faces):
        part = pv.PolyData.from_regular_faces(body.points, faces)
        part.point_data["away"] = 1.0 - np.log(np.maximum(share, FAINTEST)) / np.log(FAINTEST)
        window.add_mesh(part, ambient=0.4, diffuse=0.7, render=False, **look)


def spots(scene: FitScene, box: Box, target: Floats, scale: float, points: Floats) -> Floats:
    """Positions (k, 2) in pixels of points (k, 3) in a view."""
    view = scene.frame.view
    flat = (points - target) @ np.stack([view.right, -view.up], axis=1) / scale
    return np.asarray(flat + np.array(canvas.middle(box)))


def rings(pen: Any, page: Page, box: Box, at: Floats, numbers: Ints) -> None:
    """Draw a ring about each place in a view, then the numbers beside them, to the left at the edge of the view."""
    s = page.unit
    for x, y in at:
        for width, colour in ((7, PAPER), (3, MARK)):
            reach = s * (RING + width / 2)
            pen.ellipse((x - reach, y - reach, x + reach, y + reach), outline=colour, width=max(round(s * width), 1))
    stroke = round(4 * s)
    for (x, y), number in zip(at, numbers, strict=True):
        side = -1 if x + s * (2 * RING + 16) > box[0] + box[2] else 1
        position = x + side * s * (RING + 16), y - s * (RING + 8)
        font = face(page, 28)
        pen.text(position, str(number), MARK, font=font, anchor="mm", stroke_width=stroke, stroke_fill=PAPER)


def legend(image: Any, pen: Any, scene: FitScene, page: Page) -> None:
    """Draw the list of places with their distances, and the scale of colours."""
    s = page.unit
    x, y = canvas.legend_left(page), s * (canvas.TOP + 6)
    for k, distance in enumerate(scene.distances):
        shade = INK if scene.seen[k].any() else FAINT
        pen.text((x, y + s * 38 * k), f"{k + 1}", MARK, font=face(page, 25))
        pen.text((x + s * 30, y + s * (38 * k + 2)), with_share(scene, float(distance)), shade, font=face(page, 21))
    if not scene.seen.any(axis=1).all():
        last = y + s * (38 * len(scene.distances) + 2)
        pen.text((x, last), "grey: out of sight", FAINT, font=face(page, 21))
    units = scene.frame.units
    words = ["distance" + (f" in {units}" if units else ""), "(% of the part)"]
    canvas.colour_bar(image, pen, page, DISTANCES, words, marks(scene))


def marks(scene: FitScene) -> list[tuple[float, str]]:
    """Marks at 1, 2 and 5 times powers of ten, with the values also as percentages of the diagonal."""
    most = scene.most
    powers = 10.0 ** np.arange(np.floor(np.log10(FAINTEST * most)), np.ceil(np.log10(most)) + 1)
    values = np.outer(powers, [1.0, 2.0, 5.0]).ravel()
    share = 1.0 - np.log(values / most) / np.log(FAINTEST)
    inside = (share >= 0.0) & (share <= 1.0)
    return [(float(share[k]), with_share(scene, float(values[k]))) for k in np.flatnonzero(inside)]


def with_share(scene: FitScene, distance: float) -> str:
    """A distance, and its percentage of the diagonal."""
    return f"{distance:.2g} ({100.0 * distance / scene.diagonal:.2g} %)"
