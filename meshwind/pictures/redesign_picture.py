"""redesign.png: a part before and after the redesign, the latter coloured by its displacement."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import colour_map
from meshwind.pictures import camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import RedesignScene

_GAP, _HEAD = 24, 44
"""Pixels between the views, and above each view for its name."""


def draw(window: Any, scene: RedesignScene, page: Page) -> Any:
    """Draw two views from the same side, with text."""
    view, both = scene.frame.view, np.concatenate([scene.before, scene.after])
    image = canvas.blank(page)
    pen = canvas.titled(image, page, scene.frame)
    extent, head = (view.width, view.height), page.unit * _HEAD
    boxes = halves(page, extent)
    scale = max(extent[k] / (boxes[0][2 + k] - (0.0, head)[k]) for k in (0, 1))
    for box, name in zip(boxes, ("before", "after"), strict=True):
        left, top, width, height = box[0], box[1] + head, box[2], box[3] - head
        window.clear_actors()
        add(window, scene, name == "after")
        camera.aim(window, page, view, both, view.centre, canvas.middle((left, top, width, height)), scale)
        edges = round(left), round(top), round(left + width), round(top + height)
        image.paste(camera.shot(window, page).crop(edges), edges[:2])
        pen.text(box[:2], name, canvas.INK, font=canvas.face(page, 25))
    if len(scene.arrows):
        words = "arrows: how it moves" if scene.longer == 1.0 else f"arrows: {scene.longer:g} times the displacement"
        place = boxes[0][0] + page.unit * 110, boxes[0][1] + page.unit * 4
        pen.text(place, words, canvas.INK, font=canvas.face(page, 20))
    canvas.scale_bar(image, pen, page, scene.scale)
    canvas.ruler(pen, page, scale, scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def halves(page: Page, extent: tuple[float, float]) -> list[canvas.Box]:
    """Two boxes side by side or one above the other, whichever shows the part larger."""
    left, top, width, height = canvas.room(page)
    gap, head = page.unit * _GAP, page.unit * _HEAD
    w, h = (width - gap) / 2, (height - gap) / 2
    beside: list[canvas.Box] = [(left, top, w, height), (left + w + gap, top, w, height)]
    above: list[canvas.Box] = [(left, top, width, h), (left, top + h + gap, width, h)]
    return max((beside, above), key=lambda boxes: min(boxes[0][2] / extent[0], (boxes[0][3] - head) / extent[1]))


def add(window: Any, scene: RedesignScene, after: bool) -> None:
    """Add the part before, plain, or after, coloured."""
    part = pv.PolyData.from_regular_faces(scene.after if after else scene.before, scene.faces)
    part.point_data["shares"] = np.asarray(scene.shares)
    look: dict[str, Any] = {"color": canvas.PART, "ambient": 0.3, "diffuse": 0.8}
    if after:
        colours = colour_map(scene.scale.colours)
        look = {"scalars": "shares", "cmap": colours, "clim": [0.0, 1.0], "ambient": 0.55, "diffuse": 0.5}
    window.add_mesh(part, show_scalar_bar=False, render=False, **look)
    if not after and len(scene.arrows):
        _add_arrows(window, scene)


def _add_arrows(window: Any, scene: RedesignScene) -> None:
    """Add arrows on the part as it was: those outward begin on it, those inward end on it."""
    at, moves = scene.before[scene.arrows], scene.longer * (scene.after - scene.before)[scene.arrows]
    cloud = pv.PolyData(np.where(scene.outward[:, None], at, at - moves))
    cloud.point_data["moves"] = moves
    cloud.point_data["shares"] = np.asarray(scene.shares)[scene.arrows]
    arrow = pv.Arrow(tip_length=0.35, tip_radius=0.13, shaft_radius=0.045, tip_resolution=12, shaft_resolution=8)
    arrows = cloud.glyph(orient="moves", scale="moves", factor=1.0, geom=arrow)
    colours = colour_map(scene.scale.colours)
    window.add_mesh(
        arrows, scalars="shares", cmap=colours, clim=[0.0, 1.0], show_scalar_bar=False, render=False, ambient=0.5,
        diffuse=0.5,
    )  # fmt: skip
