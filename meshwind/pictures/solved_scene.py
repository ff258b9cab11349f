"""Scene of solved.png: how near the plies of a solved deck are to failure, element by element."""

from dataclasses import replace

import numpy as np

from meshwind.appearance.looks import EXPOSURE, MOVED
from meshwind.appearance.view import View, best_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.pictures.scenes import Frame, MapScene, Part
from meshwind.solving.deck import ReadDeck
from meshwind.solving.fields import Solved
from meshwind.solving.figures import SolvedFigures, loaded, which

_SHARP = 4
"""Power of the exposure that counts for the view: it shows what is nearest to failure."""


def solved_scene(done: Solved, made: SolvedFigures) -> MapScene:
    """The elements by their exposure; by the displacement of their corners where strengths are not known."""
    deck, units, largest = done.deck, made["units"], made.get("largest")
    moved = f"moves by up to {quantity(made['moved']['length'], units, 3)}"
    if done.worst is None or largest is None:
        values, look = done.moved[deck.faces].ravel(), MOVED
        title, subtitle = "displacement", f"{moved}; no strengths are known of {made['material']}"
    else:
        values, look = np.repeat(done.worst.exposure, 4), EXPOSURE
        where = f"{quantity(largest['from_rim'], units, 2)} from a rim"
        title, subtitle = "Tsai-Wu index of the worst ply", f"{loaded(largest)}: {which(largest)}, {where}  ·  {moved}"
    scale = look.scale(values, units)
    frame = Frame(f"{made['part']}: {title}", subtitle, units, _view(deck, values))
    return MapScene(frame, _part(deck), scale, scale.shares(values))


def _view(deck: ReadDeck, values: Floats) -> View:
    """The view that shows most of the part and of the largest values (4 k,) of its elements' corners."""
    each = values.reshape(-1, 4).max(axis=1)
    weight = (each / max(float(each.max()), 1e-300)) ** _SHARP
    axis = np.array([deck.points[rim].mean(axis=0) for rim in deck.rims])
    seen = best_view(deck.points, deck.faces, axis, deck.centre, deck.normal, weight)
    return replace(seen, both=True)


def _part(deck: ReadDeck) -> Part:
    """The elements, each with corners of its own, so that values do not blend from one to the next."""
    points = deck.points[deck.faces]
    total = np.zeros_like(deck.points)
    np.add.at(total, deck.faces, deck.normal[:, None])
    size = float(np.linalg.norm(points[:, 1] - points[:, 0], axis=1).mean())
    quads = np.arange(points.size // 3).reshape(-1, 4)
    return Part(points.reshape(-1, 3), quads, total[deck.faces].reshape(-1, 3), size)
