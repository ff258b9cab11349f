"""Scene of layers.png: how many layers of band lie over each place, in steps, and what is bare."""

import numpy as np

from meshwind.appearance.layer_steps import STEP_COLOURS, step_firsts, step_words
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.layup.bands import bands
from meshwind.pictures.scenes import LayersScene, Part
from meshwind.pictures.subject import Subject
from meshwind.surface.grid import grid_quads, parameter_grid

_ACROSS = 24
"""Cells across a band, so that its edges look straight."""


def layers_scene(of: Subject) -> LayersScene:
    """The layers over the middles of fine cells, with the share of the area that is on each step."""
    laid = bands(of.paths, of.layup.bands.width, _ACROSS)
    firsts = step_firsts(int(laid.layers.max(initial=0)))
    steps = np.searchsorted(firsts, laid.layers.ravel(), side="right") - 1
    shares = np.bincount(steps, laid.area.ravel(), len(firsts)) / max(float(laid.area.sum()), 1e-300)
    words = tuple(
        f"{named}: {percent(share)}" for named, share in zip(step_words(firsts), shares.tolist(), strict=True)
    )
    first = "first layer alone  ·  " if of.laminate is not None and of.laminate.layers > 1 else ""
    subtitle = f"{first}band {quantity(laid.width, of.units, 3)} wide  ·  {percent(float(shares[0]))} of the part bare"
    frame = of.frame(f"{of.name}: layers of band over each place", subtitle)
    return LayersScene(frame, _cells(of, *laid.layers.shape), steps, STEP_COLOURS[: len(firsts)], words)


def percent(share: float) -> str:
    """A share in percent, of which what is little does not read as none, nor what is nearly all as all."""
    value = 100.0 * share
    if 0.0 < value < 0.1:
        return "< 0.1 %"
    return f"{value:.1f} %" if value < 10.0 or 99.5 <= value < 100.0 else f"{value:.0f} %"


def _cells(of: Subject, nu: int, nv: int) -> Part:
    """The part as nu x nv quads, u slowest."""
    surface = of.paths.surface
    around = np.arange(nu + (not surface.periodic)) / nu
    frames = surface.frames(parameter_grid(around, np.linspace(0.0, 1.0, nv + 1)))
    points: Floats = np.ascontiguousarray(frames[:, 0])
    normals = np.cross(frames[:, 1], frames[:, 2])
    return Part(points, grid_quads(len(around), nv + 1, surface.periodic), normals, of.pitch)
