"""What a set of paths amounts to: families, crossings, coverage, quads."""

from meshwind.layup.coverage import Coverage
from meshwind.layup.crossings import Crossings
from meshwind.layup.families import Families, families
from meshwind.layup.layup import Layup, assess
from meshwind.layup.quads import QuadMesh

__all__ = ["Coverage", "Crossings", "Families", "Layup", "QuadMesh", "assess", "families"]
