"""laminate.png: the thickness of a laminate on the part, and of its layers along it, with their angles."""

from typing import Any

import numpy as np

from meshwind.appearance.looks import colour_map
from meshwind.pictures import bodies, camera, canvas
from meshwind.pictures.curves import LABEL, TICKS, Curves
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import LaminateScene

_LAYERS = "#2f6da8", "#e08a1e", "#1c7c3c", "#8a5fb0", "#b3541e", "#5a6673"
"""Colours of layers, over and over."""
_PART = 0.34
"""Share of the page's width in which the part is seen."""
_BAR = 34.0, 460.0
"""Width and height of the scale, for a page of 1600 x 1200, ..."""
_LEFT, _BASE, _GAP, _RIGHT = 330.0, 130.0, 90.0, 40.0
"""... margins of the curves: from the part, below, between them, and to the right."""
_BESIDE, _ROW = 2, 0.12
"""Names of layers in a row of the legend, and height of a row over the largest thickness."""


def draw(window: Any, scene: LaminateScene, page: Page) -> Any:
    """Draw the part with its thickness, the scale, and the curves."""
    view, s = scene.frame.view, page.unit
    colours = colour_map(scene.scale.colours)
    bodies.add_map(window, scene.part, scene.shares, colours)
    _, top, _, height = canvas.room(page)
    box = s * canvas.LEFT, top, _PART * page.width, height
    scale = max(view.width / box[2], view.height / box[3])
    camera.aim(window, page, view, scene.part.points, view.centre, canvas.middle(box), scale)
    image = camera.shot(window, page)
    image = _curves(scene, page).on(image)
    pen = canvas.titled(image, page, scene.frame)
    canvas.ruler(pen, page, scale, scene.frame.units)
    return image


def _curves(scene: LaminateScene, page: Page) -> Curves:
    """The scale of the thickness, and both curves beside the part."""
    s, curves = page.unit, Curves(page)
    wide, high = page.width / s, page.height / s
    bar = canvas.LEFT + _PART * wide + 40.0, 0.5 * (high - _BAR[1]), *_BAR
    _scale(curves, scene, page, bar)
    left = canvas.LEFT + _PART * wide + _LEFT
    width, height = wide - left - _RIGHT, 0.5 * (high - canvas.TOP - _BASE - _GAP)
    upper = curves.axes((left, _BASE + height + _GAP, width, height), scene.stations)
    lower = curves.axes((left, _BASE, width, height), scene.stations)
    below = np.zeros(len(scene.stations))
    for k, (name, thickness, angles) in enumerate(zip(scene.names, scene.thickness, scene.angles, strict=True)):
        colour = _LAYERS[k % len(_LAYERS)]
        above = below + np.nan_to_num(thickness)
        upper.fill_between(scene.stations, below, above, color=colour, linewidth=0.0, label=name)
        lower.plot(scene.stations, angles, color=colour, linewidth=2.5 * s, label=name)
        below = above
    rows = -(-len(scene.names) // _BESIDE)
    upper.set_ylim(0.0, (1.1 + _ROW * rows) * max(float(below.max()), 1e-300))
    unit = f", {scene.frame.units}" if scene.frame.units else ""
    upper.set_ylabel(f"thickness{unit}", fontsize=LABEL * s)
    lower.set_ylim(0.0, 90.0)
    lower.set_yticks(np.arange(0.0, 91.0, 15.0))
    lower.set_ylabel("winding angle, degrees", fontsize=LABEL * s)
    lower.set_xlabel(curves.along(scene.frame.units), fontsize=LABEL * s)
    upper.legend(frameon=False, fontsize=TICKS * s, loc="upper center", ncols=min(_BESIDE, len(scene.names)))
    return curves


def _scale(curves: Curves, scene: LaminateScene, page: Page, box: tuple[float, float, float, float]) -> None:
    """Draw the scale of the thickness in a box."""
    s, scale = page.unit, scene.scale
    bar = curves.axes(box, np.array([0.0, 1.0]))
    bar.imshow(
        colour_map(scale.colours)(np.linspace(1.0, 0.0, 256))[:, None], aspect="auto", extent=(0.0, 1.0, 0.0, 1.0)
    )
    bar.grid(visible=False)
    bar.set_xticks([])
    bar.yaxis.tick_right()
    bar.set_yticks([share for share, _ in scale.marks], [words for _, words in scale.marks])
    bar.set_title("\n".join(scale.words), fontsize=LABEL * s, loc="left", pad=14 * s)
    for spine in bar.spines.values():
        spine.set_visible(True)
