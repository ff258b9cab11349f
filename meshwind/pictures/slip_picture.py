"""slip.png: fibres coloured by required friction, grey where they leave the surface."""

from typing import Any

import numpy as np

from meshwind.appearance.looks import SIGNAL, colour_map
from meshwind.core.cast import Bools, Floats
from meshwind.core.lists import spread
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import SlipScene

OFF = "#8c857a"
_BARS, _LIMIT = "#5a6673", SIGNAL
_BESIDE, _RIGHT = 125.0, 14.0
"""Distance of the histogram from the left edge of the scale, and from the right edge of the page."""


def draw(window: Any, scene: SlipScene, page: Page) -> Any:
    """Draw the slip, with text."""
    view, converged = scene.frame.view, scene.fibres.converged
    scale = canvas.fitting(page, view)
    stroke = bodies.stroke(scene.part, scale, page.unit)
    points = bodies.lifted(scene.fibres, stroke.radius)
    bodies.add_part(window, scene.part)
    bodies.add_paths(window, points[~converged], stroke.times(0.6), canvas.LOOSE)
    _add_known(window, scene, points[converged], stroke)
    image = camera.portrait(window, page, view, scene.part.points)
    pen = canvas.titled(image, page, scene.frame)
    rows = [(OFF, "off the surface")] if scene.bridges else []
    if not scene.needed:
        rows = [(_zero(scene), "needs none"), *rows]
    canvas.legend(pen, page, rows if converged.all() else [(canvas.LOOSE, "not at rest"), *rows])
    if scene.needed:
        canvas.scale_bar(image, pen, page, scene.scale)
        add_histogram(pen, scene, page)
    canvas.ruler(pen, page, scale, scene.frame.units)
    canvas.axes(pen, page, view)
    return image


def add_histogram(pen: Any, scene: SlipScene, page: Page) -> None:
    """Draw the shares of the fibre as bars beside the scale, and the friction that there is as a line."""
    left, top, wide, high = bars_box(page)
    s, count, most = page.unit, len(scene.bins), max(float(scene.bins.max()), 1e-300)
    words = canvas.face(page, 19)
    for k, share in enumerate(scene.bins.tolist()):
        base, reach = top + high * (1.0 - k / count), wide * share / most
        if share > 0.0:
            pen.rectangle((left, base - high / count + s, left + max(reach, s), base - s), fill=_BARS)
        if share == scene.bins.max():
            pen.text((left + wide, base + 3 * s), f"{100.0 * share:.0f} %", canvas.INK, font=words, anchor="rt")
    pen.line((left, top, left, top + high), fill=canvas.FAINT)
    for k, line in enumerate(("bars: share of the", "fibre that touches")):
        pen.text((canvas.legend_left(page), top + high + s * (18 + 26 * k)), line, canvas.FAINT, font=words)
    if scene.limit:
        y = top + high * (1.0 - scene.limit)
        scale, _, thick, _ = canvas.bar_box(page)
        for first, last in ((scale, scale + thick), (left, left + wide)):  # not through the marks between
            pen.line((first, y, last, y), fill=_LIMIT, width=max(round(3 * s), 1))
        pen.text((left, top - 6 * s), "friction", _LIMIT, font=words, anchor="lb")


def bars_box(page: Page) -> canvas.Box:
    """The box of the histogram, beside the scale and the text of its marks."""
    _, top, _, high = canvas.bar_box(page)
    left = canvas.legend_left(page) + page.unit * _BESIDE
    return left, top, page.width - page.unit * _RIGHT - left, high


def _add_known(window: Any, scene: SlipScene, points: Floats, stroke: bodies.Stroke) -> None:
    """Add converged fibres: coloured between particles whose slip is known, thin and grey between others."""
    shares = scene.shares[scene.fibres.converged]
    known = np.isfinite(shares[:, 1:]) & np.isfinite(shares[:, :-1])
    grey, lines = runs(points, shares, ~known), runs(points, shares, known)
    if grey is not None:
        bodies.add_strokes(window, grey, stroke.times(0.7), color=OFF)
    if lines is not None:
        colours = colour_map(scene.scale.colours)
        bodies.add_strokes(window, lines, stroke, **bodies.coloured("share", colours, 1.0))


def runs(points: Floats, shares: Floats, wanted: Bools) -> Any:
    """Polylines over runs of wanted segments (p, n - 1) of paths (p, n, 3), with shares; None if there is none."""
    padded = np.pad(wanted, ((0, 0), (1, 1))).astype(np.int8)
    path, first = np.nonzero(np.diff(padded, axis=1) == 1)
    _, last = np.nonzero(np.diff(padded, axis=1) == -1)
    if not len(path):
        return None
    sizes = last - first + 1
    row = np.repeat(path, sizes)
    column = spread(first, sizes)
    lines = bodies.polylines(points[row, column], sizes)
    lines.point_data["share"] = shares[row, column]
    return lines


def _zero(scene: SlipScene) -> str:
    return "#" + "".join(f"{round(255 * part):02x}" for part in colour_map(scene.scale.colours)(0.0)[:3])
