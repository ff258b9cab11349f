"""quads.png: the quad mesh on the crossings."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.core.cast import Ints
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import QuadsScene

QUAD, TRIANGLE, EDGE, OFF = "#cfdce8", "#f0c987", "#33485a", "#b0127b"
_CLEAR = 20.0
"""Distance between fibres, in pixels, above which edges are drawn opaque."""

_VEIL = 0.3
"""Opacity of the part over the faces."""


def draw(window: Any, scene: QuadsScene, page: Page) -> Any:
    """Draw the quad mesh, with text."""
    view = scene.frame.view
    scale = canvas.fitting(page, view)
    kinds = (scene.quads, QUAD, "quads"), (scene.triangles, TRIANGLE, "triangles")
    faces = [kind for kind in kinds if len(kind[0])]
    for cells, colour, _ in faces:
        add_faces(window, scene, cells, colour, scale, page.unit)
    if faces:  # the flat faces cut off what bulges between their corners
        bodies.add_smooth(window, bodies.body(scene.part), color=canvas.PART, opacity=_VEIL, culling="back")
    else:
        bodies.add_part(window, scene.part)
    off = scene.corners[scene.off] if faces else ()
    if len(off):
        size = float(np.clip(0.4 * scene.part.pitch / scale, 1.5 * page.unit, 9.0 * page.unit))
        nearer = 3.0 * page.unit * scale * view.eye
        dots = pv.PolyData(np.concatenate([off + nearer, off - nearer]) if view.both else off + nearer)
        window.add_mesh(dots, color=OFF, point_size=size, render_points_as_spheres=True, lighting=False, render=False)
    image = camera.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    rows = [(colour, words) for _, colour, words in faces] + [(canvas.PART, "the part")]
    canvas.legend(pen, page, rows + ([(OFF, "off the surface")] if len(off) else []))
    canvas.ruler(pen, page, scale, scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def add_faces(window: Any, scene: QuadsScene, cells: Ints, colour: str, scale: float, unit: float) -> None:
    """Add faces of one kind with their edges, which are fainter the denser they are."""
    apart = scene.part.pitch / (scale * unit)
    mesh = pv.PolyData.from_regular_faces(scene.corners, cells)
    window.add_mesh(
        mesh,
        color=colour,
        ambient=0.4,
        diffuse=0.7,
        show_edges=True,
        edge_color=EDGE,
        edge_opacity=float(np.clip(apart / _CLEAR, 0.15, 1.0)),
        line_width=max(2.0 * unit, 1.0),
        backface_params={"color": canvas.INSIDE, "ambient": 0.25},
        render=False,
    )
