"""Scene of layers.png: how many layers of band lie over each place, in steps, and what is bare."""

import numpy as np

from meshwind.appearance.layer_steps import STEP_COLOURS, layer_steps, step_words
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.pictures.scenes import LayersScene, Part
from meshwind.pictures.subject import Subject
from meshwind.surface.grid import grid, grid_quads


def layers_scene(of: Subject) -> LayersScene:
    """The layers over the middles of fine cells, with the share of the area that is on each step."""
    laid, firsts, steps = layer_steps(of.paths, of.layup.bands.width)
    shares = np.bincount(steps.ravel(), laid.area.ravel(), len(firsts)) / max(float(laid.area.sum()), 1e-300)
    words = tuple(
        f"{_short(named)}: {percent(share)}" for named, share in zip(step_words(firsts), shares.tolist(), strict=True)
    )
    first = "first layer alone  ·  " if of.laminate is not None and of.laminate.layers > 1 else ""
    subtitle = f"{first}band {quantity(laid.width, of.units, 3)} wide  ·  {percent(float(shares[0]))} of the part bare"
    frame = of.frame(f"{of.name}: layers of band over each place", subtitle)
    return LayersScene(frame, *_sheet(of), steps, STEP_COLOURS[: len(firsts)], words)


def _short(words: str) -> str:
    """Words of a step of several numbers without what the title says, so that the legend keeps its size."""
    numbers = words.removesuffix(" layers")
    return numbers if " " in numbers else words


def percent(share: float) -> str:
    """A share in percent, of which what is little does not read as none, nor what is nearly all as all."""
    value = 100.0 * share
    if 0.0 < value < 0.1:
        return "< 0.1 %"
    return f"{value:.1f} %" if value < 10.0 or 99.5 <= value < 100.0 else f"{value:.0f} %"


def _sheet(of: Subject) -> tuple[Part, Floats]:
    """The part with the uv (k, 2) of its points: around a closed one the first column comes again, at u = 1."""
    on = grid(of.paths.surface)
    nu, nv = on.shape
    if not on.surface.periodic:
        return of.part, on.uv
    points, normals, uv = (np.concatenate([each, each[:nv]]) for each in (of.points, of.normals, on.uv))
    uv[-nv:, 0] = 1.0
    return Part(points, grid_quads(nu + 1, nv, False), normals, of.pitch), uv
