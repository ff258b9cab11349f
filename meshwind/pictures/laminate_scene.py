"""Scene of laminate.png: the thickness of layers one on another, over the part and along it."""

import numpy as np

from meshwind.appearance.looks import LAMINATE
from meshwind.appearance.words import quantity
from meshwind.filament.course import Kind
from meshwind.filament.levels import levels
from meshwind.pictures.scenes import LaminateScene
from meshwind.pictures.subject import Subject


def laminate_scene(of: Subject) -> LaminateScene:
    """The thickness on the part, and the thickness and angle of each layer along it."""
    laminate = of.laminate
    assert laminate is not None
    lines = levels(of.paths.surface)
    v = np.unique(laminate.stations[:, 0])
    angles, thickness = np.full((2, laminate.layers, len(v)), np.nan)
    for number in range(laminate.layers):
        rows = laminate.of_layer(number)
        at = np.searchsorted(v, rows[:, 0])
        angles[number, at], thickness[number, at] = rows[:, 3], rows[:, 4]
    values = laminate.thickness.astype(np.float64)
    low, usual, high = (quantity(float(each), of.units, 3) for each in np.quantile(values, [0.0, 0.5, 1.0]))
    many = "one layer" if laminate.layers == 1 else f"{laminate.layers} layers"
    scale = LAMINATE.scale(values, of.units)
    joined = any((each.course.kind == Kind.JOIN).any() for each in of.filaments)
    without = "  ·  joins between layers are not in it" if joined else ""
    frame = of.frame(f"{of.name}: thickness of {many}", f"{low} to {high}, median {usual}{without}")
    names = tuple(f"layer {number} {each['kind']}" for number, each in enumerate(of.layers, 1))
    return LaminateScene(
        frame, of.part, scale, scale.shares(values), np.interp(v, lines.v, lines.mean), thickness, angles, names
    )  # fmt: skip
