"""What a set of paths amounts to: crossings, coverage, windability and the quad mesh."""

from meshwind.layup.bands import Bands, bands
from meshwind.layup.coverage import Coverage
from meshwind.layup.crossings import Crossings, own_crossings
from meshwind.layup.layup import Layup, assess
from meshwind.layup.quad_quality import QuadQuality, quad_quality
from meshwind.layup.quads import QuadMesh
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
