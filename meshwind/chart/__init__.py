"""The annulus on the periodic rectangle."""

from meshwind.chart.chart import Chart
from meshwind.chart.flatten import flatten

__all__ = ["Chart", "flatten"]
