"""crossings.png: the crossings of the two families, coloured by the angle between them."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import colour_map
from meshwind.core.cast import Floats
from meshwind.core.vectors import unit as unit_of
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import CrossingsScene

FIBRE = "#a9a296"
_DOT, _RING = 10.5, 2.0
"""Largest radius of a disc and width of its ring, in pixels."""
_RINGED = 4.0
"""Least radius of a disc with a ring, in pixels."""
_SIDES, _FEW_SIDES, _SMALL = 20, 6, 2.0
"""Sides of a disc, and of all where none has a larger radius in pixels: there are hundreds of thousands then."""

_NEARER = -12.0
"""Offset of the discs in depth, as OpenGL counts it, so that fibres that are drawn as lines do not hide them."""


def draw(window: Any, scene: CrossingsScene, page: Page) -> Any:
    """Draw the crossings, with text."""
    view = scene.frame.view
    scale = canvas.fitting(page, view)
    stroke = bodies.stroke(scene.part, scale, page.unit).times(0.6)
    bodies.add_part(window, scene.part)
    bodies.add_fibres(window, scene.fibres, stroke, {1: FIBRE, -1: FIBRE})
    add_dots(window, scene, scale, page.unit, stroke.radius)
    image = camera.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    canvas.legend(pen, page, [(FIBRE, "fibres")])
    canvas.scale_bar(image, pen, page, scene.scale)
    canvas.ruler(pen, page, scale, scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def add_dots(window: Any, scene: CrossingsScene, scale: float, unit: float, thick: float) -> None:
    """Add the discs and their rings."""
    if not len(scene.points):
        return
    cores, rings = dots(scene, scale, unit, thick)
    look = bodies.coloured("share", colour_map(scene.scale.colours), 1.0)
    added = [window.add_mesh(cores, lighting=False, render=False, **look)]
    added += [window.add_mesh(rings, color=canvas.INK, lighting=False, render=False)] if rings.n_cells else []
    for actor in added:
        actor.mapper.resolve = "polygon_offset"
        actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(_NEARER, _NEARER)


def dots(scene: CrossingsScene, scale: float, unit: float, thick: float) -> tuple[Any, Any]:
    """A disc per crossing, and dark rings around those that are not small, so that pale ones stand out.

    Discs lie on the part and keep within their room, so that they do not meet in any view.
    """
    size = radii(scene, scale, unit)
    lift = 2.4 * thick * scene.normals
    ringed = size > _RINGED * unit * scale
    inner = np.where(ringed, size - _RING * unit * scale, size)
    sides = _SIDES if size.max() > _SMALL * unit * scale else _FEW_SIDES
    rings = discs(scene.points[ringed] + lift[ringed], scene.normals[ringed], size[ringed], sides)
    cores = discs(scene.points + lift + 0.3 * thick * scene.normals, scene.normals, inner, sides)
    cores.cell_data["share"] = np.repeat(scene.shares, sides)
    return cores, rings


def radii(scene: CrossingsScene, scale: float, unit: float) -> Floats:
    """Radius (c,) of the disc on each crossing, in mesh units; scale: mesh units per pixel."""
    return np.minimum(scene.room, _DOT * unit * scale)


def discs(centres: Floats, normals: Floats, size: Floats, sides: int = _SIDES) -> Any:
    """Discs of radius size (c,) round centres (c, 3), square to normals (c, 3); a fan of triangles each."""
    up = unit_of(normals)
    least = np.eye(3)[np.abs(up).argmin(axis=1)] if len(up) else up
    right = unit_of(np.cross(up, least))
    turn = 2.0 * np.pi * np.arange(sides) / sides
    arc = np.cos(turn)[:, None] * right[:, None] + np.sin(turn)[:, None] * np.cross(up, right)[:, None]
    rim = centres[:, None] + size[:, None, None] * arc
    points = np.concatenate([centres[:, None], rim], axis=1)
    k = np.arange(sides)
    fan = np.stack([0 * k, 1 + k, 1 + (k + 1) % sides], axis=1)
    faces = (fan[None] + np.arange(len(centres))[:, None, None] * (sides + 1)).reshape(-1, 3)
    return pv.PolyData.from_regular_faces(points.reshape(-1, 3), faces)
