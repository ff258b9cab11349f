"""quads.png: the quad mesh on the crossings."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.pictures import bodies, canvas
from meshwind.pictures.page import page_of

QUAD, TRIANGLE, EDGE, OFF = "#cfdce8", "#f0c987", "#33485a", "#b0127b"
_CLEAR = 20.0
"""Pixels between fibres above which edges are drawn in full."""


def draw(window: Any, scene: dict[str, Any]) -> Any:
    """The picture of the quad mesh, with words."""
    page = page_of(scene)
    scale = canvas.fitting(page, scene)
    faces = [(scene["mesh_quads"], QUAD), (scene["mesh_triangles"], TRIANGLE)]
    for cells, colour in faces:
        if len(cells):
            add_faces(window, scene, cells, colour, scale, page.unit)
    if not any(len(cells) for cells, _ in faces):
        bodies.add_part(window, scene)
    off = scene["corners"][scene["corner_off"]] if any(len(cells) for cells, _ in faces) else ()
    if len(off):
        size = float(np.clip(0.4 * scene["pitch"] / scale, 1.5 * page.unit, 9.0 * page.unit))
        dots = pv.PolyData(off + 3.0 * page.unit * scale * scene["eye"])
        window.add_mesh(dots, color=OFF, point_size=size, render_points_as_spheres=True, lighting=False, render=False)
    canvas.aim(window, page, scene, scene["centre"], canvas.middle(canvas.room(page)), scale)
    image = canvas.shot(window, page)
    pen = canvas.titled(image, page, scene)
    rows = [(colour, words) for (cells, colour), words in zip(faces, ("quads", "triangles"), strict=True) if len(cells)]
    canvas.legend(pen, page, rows + ([(OFF, "off the surface")] if len(off) else []))
    canvas.ruler(pen, page, scale, str(scene["units"]))
    canvas.axes(pen, page, scene)
    return image


def add_faces(window: Any, scene: dict[str, Any], cells: Any, colour: str, scale: float, unit: float) -> None:
    """Faces of one kind with their edges, fainter where they are so many that they would hide all else."""
    apart = float(scene["pitch"]) / (scale * unit)
    mesh = pv.PolyData.from_regular_faces(scene["corners"], cells)
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
