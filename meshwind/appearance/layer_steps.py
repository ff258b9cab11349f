"""Steps of the number of layers over a place, one colour each, the same in pictures and in the viewer."""

from typing import NamedTuple

import numpy as np

from meshwind.appearance.looks import SIGNAL
from meshwind.core.cast import Ints
from meshwind.layup.bands import Bands, bands
from meshwind.path.paths import Paths

_ABOVE = "#dbe8f1", "#a9cbe2", "#6fa8d0", "#3b80b5", "#1f5a8c", "#0b2f52"
"""Colours of the steps above bare, the more layers the darker."""
STEP_COLOURS = (SIGNAL, *_ABOVE)
"""Colours of all steps, bare first."""
_ACROSS = 24
"""Cells across a band, so that its edges look straight."""


class LayerSteps(NamedTuple):
    """The bands over fine cells, the least number of layers on each step, and the step (nu, nv) of each cell."""

    laid: Bands
    firsts: Ints
    steps: Ints


def layer_steps(paths: Paths, width: float) -> LayerSteps:
    """The layers of bands of a width over the middles of fine cells, in steps."""
    laid = bands(paths, width, _ACROSS)
    firsts = step_firsts(int(laid.layers.max(initial=0)))
    return LayerSteps(laid, firsts, np.searchsorted(firsts, laid.layers, side="right") - 1)


def step_firsts(most: int) -> Ints:
    """The least number of layers on each step: one by one up to `most` or, where these are too many, in doublings."""
    if most <= len(_ABOVE):
        return np.arange(most + 1)
    return np.concatenate([[0], 2 ** np.arange(min(len(_ABOVE), most.bit_length()))])


def step_words(firsts: Ints) -> list[str]:
    """Words for the steps: bare, 1 layer, 2 layers, 4 to 7 layers; the last is open where steps are doublings."""
    words = ["bare"]
    for k, first in enumerate(firsts.tolist()[1:], 1):
        last = int(firsts[k + 1]) - 1 if k + 1 < len(firsts) else first
        many = f"{first} to {last}" if last > first else str(first)
        if k + 1 == len(firsts) and k < first:
            many = f"{first} or more"
        words.append(f"{many} layer{'s' * (many != '1')}")
    return words
