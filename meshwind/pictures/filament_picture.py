"""filament.png and bands.png: bands of true width, by their order or over what they leave bare."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import SIGNAL, Scale, colour_map, rgb
from meshwind.appearance.strips import Gear, Ribbons
from meshwind.appearance.view import View
from meshwind.core.cast import Floats, Ints
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import FilamentScene, Groups

BASE, HELD = "#bcc5ce", "#3d4852"
_RIM = "#1c1c1c"
_RIM_OPACITY, _RIM_WIDTH, _RIM_SHARE = 0.45, 1.3, 0.08
"""Opacity of the edges of bands, their width in pixels, and their largest share of a band's width.

Thinner than half a pixel they are fainter instead, as a line cannot be.
"""
DEPTH, _WITHIN = 0.3, 0.04
"""Depth by which the last band is seen before the first, and distance from turnarounds within which none is.

Both are over the extent of the picture.
"""


def draw(window: Any, scene: FilamentScene, page: Page) -> Any:
    """Draw part, turnarounds and bands, with text."""
    add_stand(window, scene)
    add_bands(window, scene, page)
    image = camera.portrait(window, page, scene.frame.view, scene.part.points)
    return lettered(image, scene, page)


def lettered(image: Any, scene: FilamentScene, page: Page) -> Any:
    """The image with its title, legend, scale, ruler and axes."""
    view = scene.frame.view
    pen = canvas.titled(image, page, scene.frame)
    if scene.scale is not None:
        canvas.scale_bar(image, pen, page, scene.scale)
    canvas.legend(pen, page, rows(scene))
    canvas.ruler(pen, page, canvas.fitting(page, view), scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def rows(scene: FilamentScene) -> list[tuple[str, str]]:
    """Rows of the legend: colours and words."""
    groups, stands = scene.groups, scene.gear
    found = [] if groups is None else [*zip(groups.colours, groups.names, strict=True), (SIGNAL, "bare")]
    return found + [
        (colour, words) for colour, words in ((HELD, stands.held_words), (BASE, stands.base_words)) if words
    ]


def add_stand(window: Any, scene: FilamentScene) -> list[Any]:
    """Add the part, in a signal colour where bands are in groups, and what the turnarounds stand on; return these."""
    signal = scene.groups is not None
    part = bodies.add_smooth(
        window, bodies.body(scene.part), color=SIGNAL if signal else canvas.PART, ambient=0.6 if signal else 0.3,
        diffuse=0.5 if signal else 0.8,
        backface_params={"color": canvas.INSIDE, "ambient": 0.25, "interpolation": "Phong"},
    )  # fmt: skip
    return [part, *add_gear(window, scene.gear)]


def add_gear(window: Any, stands: Gear) -> list[Any]:
    """Add what the turnarounds stand on; return it."""
    return [
        window.add_mesh(
            pv.PolyData.from_regular_faces(stands.points, quads), color=colour, ambient=0.35, diffuse=0.7, render=False
        )
        for quads, colour in ((stands.base, BASE), (stands.held, HELD))
        if len(quads)
    ]


def add_bands(window: Any, scene: FilamentScene, page: Page) -> list[Any]:
    """Add the bands and their edges; return what was added."""
    band, *edges = bands(scene, scene.ribbons, scene.frame.view, page)
    added = window.add_mesh(band, scalars="colour", rgb=True, ambient=0.45, diffuse=0.6, render=False)
    added.prop.interpolation = "Phong"
    across = np.linalg.norm(scene.ribbons.points[:, -1] - scene.ribbons.points[:, 0], axis=1)
    wide = float(np.median(across)) / canvas.fitting(page, scene.frame.view)
    line = min(_RIM_WIDTH * page.unit, _RIM_SHARE * wide)
    look = {"color": _RIM, "opacity": _RIM_OPACITY * min(2.0 * line, 1.0), "line_width": max(line, 0.5)}
    return [added, *(window.add_mesh(edge, render=False, lighting=False, **look) for edge in edges)]


def bands(scene: FilamentScene, ribbons: Ribbons, view: View, page: Page) -> list[Any]:
    """The bands of a scene, or the first of them, with their colours, and their two edges, which tell them apart."""
    size = max(view.width, view.height)
    # in perspective what is nearer is larger, too
    seen = ribbons if page.perspective else ribbons.before(view.eye, DEPTH * size, _WITHIN * size, view.both)
    mesh = pv.PolyData.from_regular_faces(seen.points.reshape(-1, 3), seen.quads)
    mesh.point_data["Normals"] = ribbons.normals.reshape(-1, 3)
    mesh.point_data.active_normals_name = "Normals"
    colours = _of_order(scene.scale, seen) if scene.groups is None else _of_group(scene.groups, len(seen.laid))
    mesh.point_data["colour"] = np.repeat(colours, seen.points.shape[1], axis=0)
    sides: list[Floats] = [np.ascontiguousarray(seen.points[:, side]) for side in (0, -1)]
    return [mesh, *(bodies.polylines(points, seen.sizes) for points in sides)]


def _of_order(scale: Scale | None, made: Ribbons) -> Ints:
    """Colours (k, 3) of rows by the length of fibre that is laid before."""
    assert scale is not None
    return np.asarray(255.0 * colour_map(scale.colours)(scale.shares(made.laid))[:, :3]).astype(np.uint8)


def _of_group(groups: Groups, count: int) -> Ints:
    """Colours (count, 3) of the first rows by their group."""
    return np.asarray(rgb(groups.colours)[groups.of_rows[:count]])
