"""The forward solver: march a fibre over a surface from a point in a direction."""

from meshwind.march.forward import trace, traces
from meshwind.march.traced import Stop, Trace

__all__ = ["Stop", "Trace", "trace", "traces"]
