"""crossings.png: the crossings of the two families, coloured by the angle between them."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import colour_map
from meshwind.core.cast import Floats, Ints
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
    for mesh, colours in ((cores, look), (rings, {"color": canvas.INK})):
        if not mesh.n_cells:
            continue
        # from behind, as through an opening, the part is to hide them
        window.add_mesh(mesh, lighting=False, render=False, culling="front", **colours)
        actor = window.add_mesh(mesh, lighting=False, render=False, culling="back", **colours)
        actor.mapper.resolve = "polygon_offset"
        actor.mapper.SetRelativeCoincidentTopologyPolygonOffsetParameters(_NEARER, _NEARER)


def dots(scene: CrossingsScene, scale: float, unit: float, thick: float) -> tuple[Any, Any]:
    """A disc per crossing, and dark rings around those that are not small, so that pale ones stand out.

    Discs lie on the part and keep within their room, so that they do not meet in any view.
    """
    size = radii(scene, scale, unit)
    ringed = size > _RINGED * unit * scale
    inner = np.where(ringed, size - _RING * unit * scale, size)
    sides = _SIDES if size.max() > _SMALL * unit * scale else _FEW_SIDES
    centres = scene.points + 2.4 * thick * scene.normals
    cores = discs(centres, scene.normals, inner, sides)
    cores.cell_data["share"] = np.repeat(scene.shares, sides)
    return cores, annuli(centres[ringed], scene.normals[ringed], inner[ringed], size[ringed], sides)


def radii(scene: CrossingsScene, scale: float, unit: float) -> Floats:
    """Radius (c,) of the disc on each crossing, in mesh units; scale: mesh units per pixel."""
    return np.minimum(scene.room, _DOT * unit * scale)


def discs(centres: Floats, normals: Floats, size: Floats, sides: int = _SIDES) -> Any:
    """Discs of radius size (c,) round centres (c, 3), square to normals (c, 3); a fan of triangles each."""
    points = np.concatenate([centres[:, None], _circles(centres, normals, size, sides)], axis=1)
    k = np.arange(sides)
    return _faces(points, np.stack([0 * k, 1 + k, 1 + (k + 1) % sides], axis=1))


def annuli(centres: Floats, normals: Floats, inner: Floats, outer: Floats, sides: int = _SIDES) -> Any:
    """Rings between radii inner and outer (c,), which leave what is within them free from both sides."""
    points = np.concatenate([_circles(centres, normals, size, sides) for size in (inner, outer)], axis=1)
    k = np.arange(sides)
    after = (k + 1) % sides
    return _faces(points, np.stack([k, sides + k, sides + after, after], axis=1))


def _circles(centres: Floats, normals: Floats, size: Floats, sides: int) -> Floats:
    """Points (c, sides, 3) on circles of radius size (c,)."""
    up = unit_of(normals)
    least = np.eye(3)[np.abs(up).argmin(axis=1)] if len(up) else up
    right = unit_of(np.cross(up, least))
    turn = 2.0 * np.pi * np.arange(sides) / sides
    arc = np.cos(turn)[:, None] * right[:, None] + np.sin(turn)[:, None] * np.cross(up, right)[:, None]
    return np.asarray(centres[:, None] + size[:, None, None] * arc)


def _faces(points: Floats, faces: Ints) -> Any:
    """The same faces (f, m) between the points of each body, which are (c, k, 3)."""
    count, many = points.shape[:2]
    whole = (faces[None] + np.arange(count)[:, None, None] * many).reshape(-1, faces.shape[1])
    return pv.PolyData.from_regular_faces(points.reshape(-1, 3), whole)
