"""Pictures of maps: the part coloured by a map, with a scale and, if the scene has them, fans of directions
and a ring round the worst place."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import SIGNAL, colour_map
from meshwind.core.cast import Floats
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import Fans, MapScene, Spot

_ARC = 12
"""Segments of a fan's arc."""
_LIFT, _INNER, _AROUND = 0.3, 0.72, 48
"""Of a ring: its distance from the part and its inner radius, over its radius, and its number of segments."""


def draw(window: Any, scene: MapScene, page: Page) -> Any:
    """Draw the map, with text."""
    view = scene.frame.view
    bodies.add_map(window, scene.part, scene.shares, colour_map(scene.scale.colours))
    fans = scene.fans if scene.fans is not None and len(scene.fans.points) else None
    if fans is not None:
        add_fans(window, fans, view.eye)
    if scene.worst is not None:
        add_ring(window, scene.worst)
    image = camera.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    if fans is not None:
        canvas.note(pen, page, ["fans: directions", "that press; none", "where nearly all do"])
    if scene.worst is not None:
        canvas.note(pen, page, list(scene.worst.words))
    canvas.scale_bar(image, pen, page, scene.scale)
    canvas.ruler(pen, page, canvas.fitting(page, view), scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def add_ring(window: Any, spot: Spot) -> None:
    """Add a flat ring round a place, lifted so that the part does not cut it."""
    centre = spot.point + _LIFT * spot.size * spot.normal
    ring = pv.Disc(center=centre, inner=_INNER * spot.size, outer=spot.size, normal=spot.normal, c_res=_AROUND)
    window.add_mesh(ring, color=SIGNAL, lighting=False, render=False)


def add_fans(window: Any, fans: Fans, eye: Floats) -> None:
    """Add two flat sectors about each direction, as wide as the range of directions in which fibres press."""
    normal = fans.normals / np.linalg.norm(fans.normals, axis=1, keepdims=True)
    ahead = fans.directions
    aside = np.cross(normal, ahead)
    turn = fans.reach[:, None] * np.linspace(-1.0, 1.0, _ARC + 1)
    arc = np.cos(turn)[..., None] * ahead[:, None] + np.sin(turn)[..., None] * aside[:, None]
    nearer = np.where(normal @ eye < 0.0, -fans.size, fans.size)[:, None]
    tip = fans.points + nearer * eye  # moved towards an eye on its side, so that the part does not cut them
    rim = np.concatenate([fans.size * arc, -fans.size * arc], axis=1) + tip[:, None]
    points = np.concatenate([tip[:, None], rim], axis=1)
    k = np.arange(1, _ARC + 1)
    fan = np.concatenate([np.stack([0 * k, k + start, k + start + 1], axis=1) for start in (0, _ARC + 1)])
    faces = (fan[None] + np.arange(len(tip))[:, None, None] * points.shape[1]).reshape(-1, 3)
    mesh = pv.PolyData.from_regular_faces(points.reshape(-1, 3), faces)
    window.add_mesh(mesh, color=canvas.INK, lighting=False, render=False)
