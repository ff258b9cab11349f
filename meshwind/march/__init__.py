"""The forward solver: march a fibre over a surface from a point in a direction."""

from meshwind.march.forward import Stop, Trace, trace, traces

__all__ = ["Stop", "Trace", "trace", "traces"]
