"""Planning of paths: families and pins, the number of revolutions, and the spacing of neighbours."""

from meshwind.planning.families import Families, families
from meshwind.planning.pins import read_pins
from meshwind.planning.pressing import Pressing, pressing
from meshwind.planning.revolutions import Revolutions, choose_revolutions
from meshwind.planning.spacing import Spaced, space_out

__all__ = [
    "Families",
    "Pressing",
    "Revolutions",
    "Spaced",
    "choose_revolutions",
    "families",
    "pressing",
    "read_pins",
    "space_out",
]
