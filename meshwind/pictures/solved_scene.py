"""Scene of solved.png: how near the plies of a solved deck are to failure, element by element."""

from dataclasses import replace

import numpy as np
from scipy.spatial import cKDTree

from meshwind.appearance.looks import EXPOSURE, MOVED
from meshwind.appearance.view import View, best_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.pictures.scenes import Frame, MapScene, Part, Spot
from meshwind.solving.deck import ReadDeck
from meshwind.solving.fields import Solved
from meshwind.solving.figures import SolvedFigures, loaded

_RING = 0.03
"""Radius of the ring, over the longer side of what is seen."""
_BINS = 12
"""Points of the middle of a part, from which the view knows its bend."""
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
        title, subtitle = "exposure of the worst ply, by Tsai and Wu", f"{loaded(made)}  ·  {moved}"
    scale = look.scale(values, units)
    frame = Frame(f"{made['part']}: {title}", subtitle, units, _view(deck, values))
    return MapScene(frame, _part(deck), scale, scale.shares(values), worst=_ring(done, made, frame.view))


def _ring(done: Solved, made: SolvedFigures, view: View) -> Spot:
    """A ring where the first ply fails, or where the part moves most."""
    size, largest = _RING * max(view.width, view.height), made.get("largest")
    if largest is not None:
        e = largest["number"] - 1
        ply = f"ply {largest['ply']} of {largest['plies']}", f"layer {largest['layer']}, family {largest['family']:+d}"
        return Spot(done.deck.centre[e], done.deck.normal[e], size, ("ring: fails first", *ply))
    node = made["moved"]["number"] - 1
    return Spot(done.deck.points[node], done.deck.normal_at[node], size, ("ring: where it", "moves most"))


def _view(deck: ReadDeck, values: Floats) -> View:
    """The view that shows most of the part and of the largest values (4 k,) of its elements' corners."""
    each = values.reshape(-1, 4).max(axis=1)
    weight = (each / max(float(each.max()), 1e-300)) ** _SHARP
    seen = best_view(deck.points, deck.faces, _axis(deck), deck.centre, deck.normal, weight)
    return replace(seen, both=True)


def _axis(deck: ReadDeck) -> Floats:
    """Middle of the part from rim to rim: means of elements by their distances from both."""
    start, end = (cKDTree(deck.points[rim]).query(deck.centre)[0] for rim in deck.rims)
    order = np.argsort(start / np.maximum(start + end, 1e-300), kind="stable")
    return np.array([deck.centre[few].mean(axis=0) for few in np.array_split(order, _BINS)])


def _part(deck: ReadDeck) -> Part:
    """The elements, each with corners of its own, so that values do not blend from one to the next."""
    points = deck.points[deck.faces]
    size = float(np.linalg.norm(points[:, 1] - points[:, 0], axis=1).mean())
    quads = np.arange(points.size // 3).reshape(-1, 4)
    return Part(points.reshape(-1, 3), quads, deck.normal_at[deck.faces].reshape(-1, 3), size)
