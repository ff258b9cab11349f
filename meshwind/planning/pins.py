"""End points that a user gives: fixation pins, from a CSV file."""

import codecs
import csv
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.planning.families import Families, families_between
from meshwind.surface.foot import feet
from meshwind.surface.grid import parameter_grid
from meshwind.surface.surface import Surface

PARAMETRIC = ("u0", "v0", "u1", "v1")
SPATIAL = ("x0", "y0", "z0", "x1", "y1", "z1")
TURNS = "revolutions"
_COLUMNS = f"{','.join(PARAMETRIC)} or {','.join(SPATIAL)}, and {TURNS} beside the latter if need be"
_FARTHEST = 0.05
"""A pin further off the surface than this, over the part's size, is not meant for this part."""
_SEEDS = (64, 65)
"""Grid of points from which the nearest on the surface is looked for."""


def read_pins(path: str | Path, surface: Surface, revolutions: float) -> Families:
    r"""Read the end points of paths from a CSV file.

    The first row names the columns, and every other row holds the two pins of a path.  Columns u0, v0, u1, v1 are
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
    path = Path(path)
    names, rows = _table(path)
    if set(PARAMETRIC) <= set(names):
        uv = rows[:, [names.index(name) for name in PARAMETRIC]]
        start, end = uv[:, :2], uv[:, 2:]
    elif set(SPATIAL) <= set(names):
        xyz = rows[:, [names.index(name) for name in SPATIAL]]
        turns = rows[:, names.index(TURNS)] if TURNS in names else None
        start, end = (_on_surface(surface, points, path) for points in (xyz[:, :3], xyz[:, 3:]))
        start, end = _turned(start, end, turns, revolutions)
    else:
        raise BadInputError(f"{path.name}: its first row is {','.join(names)!r}; name the columns {_COLUMNS}")
    wrong = np.flatnonzero((start[:, 1] < 0) | (start[:, 1] > 1) | (end[:, 1] < 0) | (end[:, 1] > 1))
    if len(wrong):
        raise BadInputError(f"{path.name}: row {wrong[0] + 2} has v outside [0, 1]; v runs from rim to rim")
    same = np.flatnonzero((start == end).all(axis=1))
    if len(same):
        raise BadInputError(f"{path.name}: row {same[0] + 2} starts and ends in one point; give two different pins")
    return families_between(start, end)


def _table(path: Path) -> tuple[list[str], Floats]:
    """Column names and numbers (rows, columns)."""
    rows, decimal = _rows(path)
    if len(rows) < 2:
        raise BadInputError(f"{path.name}: holds no pins; give a row of column names, then a row per path")
    names = [cell.strip().lower() for cell in rows[0]]
    values = np.empty((len(rows) - 1, len(names)))
    for number, row in enumerate(rows[1:]):
        try:
            values[number] = [float(cell.replace(decimal, ".")) for cell in row]
        except ValueError as error:
            raise BadInputError(f"{path.name}: row {number + 2} is not {len(names)} numbers; mend it") from error
    wrong = np.flatnonzero(~np.isfinite(values).all(axis=1))
    if len(wrong):
        raise BadInputError(f"{path.name}: row {wrong[0] + 2} holds NaN or infinite values; mend it")
    return names, values


def _rows(path: Path) -> tuple[list[list[str]], str]:
    """Rows of cells, without empty ones, and the decimal sign: a comma is one where it does not separate the cells."""
    try:
        content = path.read_bytes()
        encoding = "utf-16" if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)) else "utf-8-sig"
        lines = content.decode(encoding).splitlines()
        told = lines[0].strip().lower() if lines else ""
        if told.startswith("sep=") and len(told) == 5:
            lines = lines[1:]
        separator = next((sign for sign in (";", "\t") if lines and sign in lines[0]), ",")
        rows = [row for row in csv.reader(lines, delimiter=separator) if any(cell.strip() for cell in row)]
    except FileNotFoundError as error:
        raise BadInputError(f"{path}: there is no such file; give a CSV file of pins") from error
    except (OSError, ValueError, csv.Error) as error:
        raise BadInputError(f"{path}: cannot be read as CSV; give a text file of comma-separated numbers") from error
    return rows, "." if separator == "," else ","


def _on_surface(surface: Surface, points: Floats, path: Path) -> Floats:
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
            f"{path.name}: row {far[0] + 2} has a pin {off[far[0]]:.3g} off the part; "
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
