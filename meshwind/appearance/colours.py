"""Colour maps: even to the eye, safe for the colour-blind, and dark enough for white paper."""

from typing import Any

from matplotlib import colormaps
from matplotlib.colors import ListedColormap
from numpy import linspace

_CUT = {"gap": ("RdPu", 0.3, 1.0), "distance": ("magma_r", 0.04, 0.86)}
"""Parts of maps: pale where all is well, dark where it is not, so that what matters stands out, in greys too."""


def colour_map(name: str) -> Any:
    """A function from shares (n,) to RGBA (n, 4): "gap", "distance", or one of Matplotlib's."""
    if name not in _CUT:
        return colormaps[name]
    whole, first, last = _CUT[name]
    return ListedColormap(colormaps[whole](linspace(first, last, 256)), name)
