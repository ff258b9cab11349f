"""Assessment of a set of paths: crossings, coverage, bands, windability and the quad mesh."""

from meshwind.layup.bands import Bands, bands
from meshwind.layup.coverage import Coverage
from meshwind.layup.crossings import Crossings, own_crossings
from meshwind.layup.layup import Layup, assess
from meshwind.layup.quads import QuadMesh, QuadQuality, quad_quality
from meshwind.layup.windability import Windability, windability

__all__ = [
    "Bands",
    "Coverage",
    "Crossings",
    "Layup",
    "QuadMesh",
    "QuadQuality",
    "Windability",
    "assess",
    "bands",
    "own_crossings",
    "quad_quality",
    "windability",
]
