"""Flattening: an annulus to the periodic rectangle, without flipped triangles."""

from meshwind.chart.chart import Chart
from meshwind.chart.flatten import flatten

__all__ = ["Chart", "flatten"]
