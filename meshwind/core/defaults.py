"""Defaults that several functions share."""

PATHS = 12
"""Paths per family."""
REVOLUTIONS = 0.5
"""Turns of a path from end to end."""
PARTICLES = 401
"""Particles per path: lengths are then right to 1e-5 on paths of up to about one turn."""
FIT_TOLERANCE = 1e-5
"""Largest distance of a vertex from the fitted surface, over the mesh's diagonal: no more than lengths are off by."""
STEPS_PER_TURN = 8
"""Fewest steps of a path per turn: with fewer, a polyline does not show the course of the fibre."""
SIDES = ("outer", "inner")
"""Skins of a part with a wall; the first is wound by default."""
OPENED_BY = ("auto", "level", "plane")
"""How a closed end is opened: along a level line of the distance to its pole, or by a plane square to the axis."""
MACHINE = "lathe-4"
"""The machine of a program for which none is named: a lathe of four axes, as large as the part needs."""
TURNAROUNDS = ("collar", "pins", "shaft", "cap")
"""Turnarounds: over a rim, and on the cap of a closed end."""
