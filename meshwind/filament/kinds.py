"""What the points of a fibre do.  Importing this module loads nothing heavy, as the process that draws needs it."""

from enum import IntEnum


class Kind(IntEnum):
    """What a point of a fibre does.

    Attributes
    ----------
    LAID : int
        0: it lies on the part.
    BRIDGE : int
        1: it is in the air, between two places where the fibre lies on the part.
    TURN : int
        2: it is in a turnaround, on its way to the next path or back from it.
    DWELL : int
        3: it waits in a turnaround, as a hoop, for the start of the next path.
    JOIN : int
        4: it leads from one layer to the next.
    """

    LAID = 0
    BRIDGE = 1
    TURN = 2
    DWELL = 3
    JOIN = 4
