"""filament.png and bands.png: bands of true width, by their order or over what they leave bare."""

from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import colour_map
from meshwind.core.cast import Floats, Ints
from meshwind.core.lists import spread
from meshwind.pictures import bodies, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import FilamentScene, Ribbons

GEAR, SIGNAL = "#aab4be", "#e0218a"
_BANDS = {0.0: "#9cc3dc", 1.0: "#f2cf8d"}
"""Paler than the fibres of the families, so that the signal colour stands out."""
_RIM = "#1c1c1c"
_RIM_OPACITY, _RIM_WIDTH = 0.45, 1.3


def draw(window: Any, scene: FilamentScene, page: Page) -> Any:
    """Draw part, turnarounds and bands, with text."""
    view, signal = scene.frame.view, scene.scale is None
    body = bodies.body(scene.part)
    canvas.add_smooth(
        window, body, color=SIGNAL if signal else canvas.PART, ambient=0.6 if signal else 0.3,
        diffuse=0.5 if signal else 0.8,
        backface_params={"color": canvas.INSIDE, "ambient": 0.25, "interpolation": "Phong"},
    )  # fmt: skip
    if len(scene.gear.quads):
        gear = pv.PolyData.from_regular_faces(scene.gear.points, scene.gear.quads)
        window.add_mesh(gear, color=GEAR, ambient=0.35, diffuse=0.7, render=False)
    _add_ribbons(window, scene)
    _add_edges(window, scene.ribbons, page)
    image = canvas.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    rows = [(GEAR, scene.gear.words)] if scene.gear.words else []
    if scene.scale is None:
        rows = [(_BANDS[0.0], "passes out"), (_BANDS[1.0], "passes back"), (SIGNAL, "bare"), *rows]
    else:
        canvas.scale_bar(image, pen, page, scene.scale)
    canvas.legend(pen, page, rows)
    canvas.ruler(pen, page, canvas.fitting(page, view), scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def _add_ribbons(window: Any, scene: FilamentScene) -> None:
    """Add the bands with their colours."""
    ribbons = scene.ribbons
    mesh = pv.PolyData.from_regular_faces(ribbons.points.reshape(-1, 3), cells(ribbons))
    shares = np.repeat(ribbons.shares, ribbons.points.shape[1])
    if scene.scale is None:
        table = np.array([_rgb(_BANDS[0.0]), _rgb(_BANDS[1.0])], dtype=np.uint8)
        mesh.point_data["colour"] = table[(shares > 0.5).astype(np.int64)]
        window.add_mesh(mesh, scalars="colour", rgb=True, ambient=0.45, diffuse=0.6, render=False)
        return
    mesh.point_data["share"] = shares
    window.add_mesh(
        mesh, scalars="share", cmap=colour_map(scene.scale.colours), clim=[0.0, 1.0], show_scalar_bar=False,
        ambient=0.45, diffuse=0.6, render=False,
    )  # fmt: skip


def cells(ribbons: Ribbons) -> Ints:
    """Quads (q, 4) of all ribbons between their points in a row."""
    across = ribbons.points.shape[1]
    begin = np.cumsum(ribbons.sizes) - ribbons.sizes
    row = spread(begin, ribbons.sizes - 1)
    corner = (row[:, None] * across + np.arange(across - 1)).ravel()
    return np.stack([corner, corner + 1, corner + across + 1, corner + across], axis=1)


def _add_edges(window: Any, ribbons: Ribbons, page: Page) -> None:
    """Add the two edges of every band as thin lines, so that bands that touch can be told apart."""
    for side in (0, -1):
        lines = bodies.polylines(np.ascontiguousarray(ribbons.points[:, side]), ribbons.sizes)
        window.add_mesh(
            lines, color=_RIM, opacity=_RIM_OPACITY, line_width=max(_RIM_WIDTH * page.unit, 0.5), lighting=False,
            render=False,
        )  # fmt: skip


def _rgb(colour: str) -> Floats:
    return np.array([int(colour[k : k + 2], 16) for k in (1, 3, 5)], dtype=np.float64)
