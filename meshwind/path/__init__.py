"""Taut paths on a surface."""

from meshwind.path.drag import drag
from meshwind.path.paths import Counters, Paths, Status
from meshwind.path.solve import solve

__all__ = ["Counters", "Paths", "Status", "drag", "solve"]
