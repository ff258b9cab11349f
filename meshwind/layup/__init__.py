"""What a set of paths amounts to: families, revolutions, spacing, crossings, coverage, quads."""

from meshwind.layup.bands import Bands, bands
from meshwind.layup.coverage import Coverage
from meshwind.layup.crossings import Crossings, own_crossings
from meshwind.layup.families import Families, families
from meshwind.layup.layup import Layup, assess
from meshwind.layup.neighbours import CellSides, Neighbours, cell_sides, neighbours
from meshwind.layup.pins import read_pins
from meshwind.layup.pressing import Pressing, pressing
from meshwind.layup.quad_quality import QuadQuality, quad_quality
from meshwind.layup.quads import QuadMesh
from meshwind.layup.revolutions import Revolutions, choose_revolutions
from meshwind.layup.spacing import Spaced, space_out
from meshwind.layup.windability import Windability, windability

__all__ = [
    "Bands",
    "CellSides",
    "Coverage",
    "Crossings",
    "Families",
    "Layup",
    "Neighbours",
    "Pressing",
    "QuadMesh",
    "QuadQuality",
    "Revolutions",
    "Spaced",
    "Windability",
    "assess",
    "bands",
    "cell_sides",
    "choose_revolutions",
    "families",
    "neighbours",
    "own_crossings",
    "pressing",
    "quad_quality",
    "read_pins",
    "space_out",
    "windability",
]
