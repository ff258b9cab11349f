"""How each map is shown: its title, its colours and its scale, the same in every picture and in the viewer."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
from meshwind.results import schema

_QUANTILE = 0.99
"""Quantile of the values at which a scale without a natural end stops, and shows that larger values exist, ..."""
_NEAR = 1.25
"""... unless the largest value is within this factor of it."""
_DECADES = 1.0 / 300.0
"""Lower end of a logarithmic scale over its upper end, ..."""
_CLEAR = 0.08
"""... and distance that other marks keep from those at its ends."""
_SMALLEST = 1e-200
"""If all values are less than this, a scale goes to 1."""
SEQUENTIAL, DIVERGING = "viridis", "RdBu_r"
SIGNAL = "#e0218a"
"""Colour of what is bare."""
_CUT = {"gap": ("RdPu", 0.3, 1.0), "distance": ("magma_r", 0.04, 0.86)}
"""Parts of colour maps: pale where all is well, dark where it is not, so that what matters stands out, in greys too."""


def colour_map(name: str) -> Any:
    """A function from shares (n,) to RGBA (n, 4): "gap", "distance", or one of Matplotlib's.

    All are even to the eye, safe for the colour-blind, and dark enough for white paper.
    """
    # imported late, as all that draws
    from matplotlib import colormaps
    from matplotlib.colors import ListedColormap

    if name not in _CUT:
        return colormaps[name]
    whole, first, last = _CUT[name]
    return ListedColormap(colormaps[whole](np.linspace(first, last, 256)), name)


def rgb(colours: Sequence[str]) -> Ints:
    """Colours as #rrggbb by their red, green and blue (n, 3)."""
    return np.array([[int(each[k : k + 2], 16) for k in (1, 3, 5)] for each in colours], dtype=np.uint8)


@dataclass(frozen=True)
class Scale:
    """A scale of colours from low to high, linear or logarithmic.

    words: lines above the scale; colours: name of a colour map; step: between its marks, None for a round one;
    beyond: whether there are values above `high`, which get its colour.
    """

    words: tuple[str, ...]
    colours: str
    low: float
    high: float
    log: bool = False
    step: float | None = None
    beyond: bool = False

    def shares(self, values: Floats) -> Floats:
        """Positions of values (k,) on the scale, 0 to 1; NaN stays NaN."""
        if self.log:
            part = np.log(np.maximum(values, self.low) / self.low) / np.log(self.high / self.low)
        else:
            part = (values - self.low) / (self.high - self.low)
        return np.asarray(np.clip(part, 0.0, 1.0))

    @property
    def marks(self) -> list[tuple[float, str]]:
        """Round values on the scale: their positions and their text."""
        values = self._powers() if self.log else self._steps()
        marks = [
            (float(share), quantity(float(value))) for share, value in zip(self.shares(values), values, strict=True)
        ]
        if self.log:
            marks = [mark for mark in marks if mark[0] > _CLEAR]
            marks.insert(0, (0.0, f"≤ {self.low:.2g}"))
        if self.beyond or self.log:
            marks = [mark for mark in marks if mark[0] < 1.0 - _CLEAR]
            marks.append((1.0, f"{'≥ ' if self.beyond else ''}{self.high:.2g}"))
        return marks

    def _steps(self) -> Floats:
        step = self.step or round_below((self.high - self.low) / 3.0)
        first, last = np.ceil(self.low / step - 1e-9), np.floor(self.high / step + 1e-9)
        return np.asarray(step * np.arange(first, last + 1.0) + 0.0)  # no -0

    def _powers(self) -> Floats:
        last = np.floor(np.log10(self.high) + 1e-9)
        return np.asarray(10.0 ** np.arange(np.ceil(np.log10(self.low) - 1e-9), last + 1.0))


Rule = Callable[[Floats], tuple[float, float]]


@dataclass(frozen=True)
class Look:
    """How a map is shown: title, words of its scale, unit, colours, and the rule for the ends of its scale.

    unit: "{u}" is replaced by the mesh's unit of length.
    """

    title: str
    words: str
    unit: str
    colours: str
    rule: Rule
    log: bool = False
    step: float | None = None

    def scale(self, values: Floats, units: str) -> Scale:
        """The scale for values (k,) of a part whose lengths are in `units`."""
        known = values[np.isfinite(values)]
        low, high = self.rule(known if len(known) else np.zeros(1))
        unit = self.unit.format(u=units) if units or "{u}" not in self.unit else ""
        words = tuple(self.words.split("\n")) + ((f"in {unit}",) if unit else ())
        beyond = bool(known.max(initial=high) > high * (1.0 + 1e-9)) and high > 0.0
        return Scale(words, self.colours, low, high, self.log, self.step, beyond)


def fixed(low: float, high: float) -> Rule:
    """A scale with natural ends."""
    return lambda values: (low, high)  # noqa: ARG005


def from_zero(values: Floats) -> tuple[float, float]:
    """From 0 to about the largest value."""
    return 0.0, _end(values)


def both_ways(values: Floats) -> tuple[float, float]:
    """Symmetric about 0."""
    end = _end(np.abs(values))
    return -end, end


def decades(values: Floats) -> tuple[float, float]:
    """From the largest value down by `_DECADES`, for a logarithmic scale."""
    most = float(values.max())
    high = most if most > _SMALLEST else 1.0
    return high * _DECADES, high


def _end(values: Floats) -> float:
    most, robust = float(values.max()), float(np.quantile(values, _QUANTILE))
    end = most if most <= _NEAR * robust else robust
    return end if end > _SMALLEST else 1.0


def round_below(value: float) -> float:
    """The largest of 1, 2, 5 times a power of ten that is not above value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(digit for digit in (1.0, 2.0, 5.0) if digit * power <= value * (1.0 + 1e-12)))


MAPS: dict[str, Look] = {
    schema.COVERAGE: Look("coverage", "layers of fibre", "", SEQUENTIAL, from_zero),
    schema.LAYERS: Look("layers of band", "bands over\nthe point", "", SEQUENTIAL, from_zero),
    schema.ANGLE: Look(
        "winding angle", "winding angle\nof family +1", schema.DEGREES, "cividis", fixed(0.0, 90.0), step=15.0
    ),
    schema.WINDABILITY: Look(
        "windability", "share of the\ndirections\nthat press", "", "cividis", fixed(0.0, 1.0), step=0.25
    ),
    schema.PRESS_REACH: Look(
        "press reach", "a fibre presses\nup to so far\nto both sides", schema.DEGREES, "cividis", fixed(0.0, 90.0),
        step=15.0,
    ),
    schema.CLASS: Look("class", "1 convex\n0 saddle\n−1 concave", "", "cividis", fixed(-1.0, 1.0), step=1.0),
    schema.GAUSSIAN_CURVATURE: Look("Gaussian curvature", "Gaussian\ncurvature", "1/{u}²", DIVERGING, both_ways),
    schema.MEAN_CURVATURE: Look("mean curvature", "mean curvature", schema.MEAN_CURVATURE.unit, DIVERGING, both_ways),
    schema.STRETCH: Look("stretch of the chart", "area scale\nover its mean", "", SEQUENTIAL, from_zero),
    schema.UNCERTAINTY: Look(
        "uncertainty", "may lie off\nthe part", schema.LENGTHS, "distance", decades, log=True
    ),
    schema.FIT_ERROR: Look("fit error", "distance\nto the mesh", schema.LENGTHS, "distance", decades, log=True),
}  # fmt: skip
"""The scalar maps of surface.vtu."""
LAMINATE = Look("thickness of the laminate", "thickness of\nall layers", schema.LENGTHS, SEQUENTIAL, from_zero)
"""The thickness of laminate.vtu, whose points are those of surface.vtu."""
EXPOSURE = Look("exposure", "load over that\nwhich makes\na ply fail", "", "distance", from_zero)
"""The exposure of solved.vtu."""
MOVED = Look("displacement", "displacement", schema.LENGTHS, SEQUENTIAL, from_zero)
"""The length of the displacements of solved.vtu."""
