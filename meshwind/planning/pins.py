"""End points that a user gives: fixation pins, from a CSV file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.checks import check_type, is_number, path_given, text
from meshwind.core.errors import BadInputError
from meshwind.planning.families import Families, families_between
from meshwind.planning.pin_table import PinTable, read_table
from meshwind.surface.foot import feet
from meshwind.surface.grid import parameter_grid
from meshwind.surface.surface import Surface

PARAMETRIC = ("u0", "v0", "u1", "v1")
SPATIAL = ("x0", "y0", "z0", "x1", "y1", "z1")
TURNS = "revolutions"
_FARTHEST = 0.05
"""A pin further off the surface than this, over the part's size, is not meant for this part."""
_SEEDS = (64, 65)
"""Grid of points from which the nearest on the surface is looked for."""


def read_pins(path: str | Path, surface: Surface, revolutions: float) -> Families:
    r"""Read the end points of paths from a CSV file.

    The first row names the columns, and every other row holds the two pins of a path.  Columns are parted by commas,
    semicolons, tabs or blanks; a comma that does not part them is a decimal one.  Columns u0, v0, u1, v1 are
    parametric, u in turns and unwrapped, so that its change is the number of revolutions.  Columns x0, y0, z0, x1, y1,
    z1 are points in the mesh's units, which are moved to the nearest points of the surface; their paths turn by about
    what a column revolutions says, negative for the other sense, or else by `revolutions`, once in each sense.

    Parameters
    ----------
    path : str or Path
        CSV file.
    surface : Surface
        Surface that the pins are on.
    revolutions : float
        Turns for pins in space without a column of their own.

    Returns
    -------
    Families
        End points, family +1 first.

    Raises
    ------
    BadInputError
        If the file cannot be read or a row cannot be used; the message names the row.

    Examples
    --------
    >>> from pathlib import Path
    >>> import meshwind as mw
    >>> lines = Path("pins.csv").write_text("u0,v0,u1,v1\n0,0,0.5,1\n0.25,0,-0.25,1\n")
    >>> mw.read_pins("pins.csv", mw.shapes.cylinder(1.0, 3.0), revolutions=0.5).family
    array([ 1, -1])
    """
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    if not is_number(revolutions):
        raise BadInputError(f"revolutions is {text(revolutions)}; give a number")
    table = pin_table(path)
    lines = table.lines
    if table.has(PARAMETRIC):
        uv = table.numbers(PARAMETRIC)
        start, end = uv[:, :2], uv[:, 2:]
    else:
        xyz = table.numbers(SPATIAL)
        turns = table.numbers((TURNS,))[:, 0] if TURNS in table.names else None
        start, end = (_on_surface(surface, points, table) for points in (xyz[:, :3], xyz[:, 3:]))
        start, end = _turned(start, end, turns, revolutions)
        lines = np.resize(lines, len(start))  # twice where both senses are wound
    wrong = np.flatnonzero((start[:, 1] < 0) | (start[:, 1] > 1) | (end[:, 1] < 0) | (end[:, 1] > 1))
    if len(wrong):
        raise BadInputError(f"{table.file}: row {lines[wrong[0]]} has v outside [0, 1]; v runs from rim to rim")
    same = np.flatnonzero((start == end).all(axis=1))
    if len(same):
        raise BadInputError(f"{table.file}: row {lines[same[0]]} starts and ends in one point; give two different pins")
    return families_between(start, end)


def pin_table(path: str | Path) -> PinTable:
    """The table in a file of pins.  Raises BadInputError if it cannot be read or lacks columns."""
    return read_table(path_given(path, "pins", "CSV file of pins"), (PARAMETRIC, SPATIAL))


def check_pins(path: str | Path) -> None:
    """Raise BadInputError if a file of pins cannot be used on any surface."""
    table = pin_table(path)
    spatial = SPATIAL + (TURNS,) * (TURNS in table.names)
    table.numbers(PARAMETRIC if table.has(PARAMETRIC) else spatial)


def _on_surface(surface: Surface, points: Floats, table: PinTable) -> Floats:
    """The parametric points (p, 2) of the surface that are nearest to points (p, 3)."""
    seeds = parameter_grid(np.arange(_SEEDS[0]) / _SEEDS[0], np.linspace(0.0, 1.0, _SEEDS[1]))
    apart = np.linalg.norm(surface.points(seeds)[None] - points[:, None], axis=2)
    at = np.array(seeds[apart.argmin(axis=1)])
    frames = np.empty((len(at), 6, 3))
    feet(0, len(at), surface.spline, np.ascontiguousarray(points), at, frames)
    off = np.linalg.norm(frames[:, 0] - points, axis=1)
    far = np.flatnonzero(off > _FARTHEST * surface.size)
    if len(far):
        raise BadInputError(
            f"{table.file}: row {table.lines[far[0]]} has a pin {off[far[0]]:.3g} off the part; "
            "give points on it, in the mesh's coordinates"
        )
    return at


def _turned(start: Floats, end: Floats, turns: Floats | None, revolutions: float) -> tuple[Floats, Floats]:
    """Unwrap the ends' u to the change nearest to what is wanted, in both senses where that is left open."""
    if turns is None:
        turns = np.repeat([revolutions, -revolutions], len(start))
        start, end = np.concatenate([start, start]), np.concatenate([end, end])
    end = end.copy()
    end[:, 0] += np.round(start[:, 0] + turns - end[:, 0])
    return start, end
