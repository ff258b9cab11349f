"""viewer.html: a run in one page for a browser, which works offline.

The template is `viewer.html` beside this file; plotly.js is copied into it from the installed package plotly.
"""

import json
from importlib.util import find_spec
from pathlib import Path
from typing import TypedDict

import numpy as np

from meshwind.appearance.looks import LAMINATE, MAPS, Look
from meshwind.appearance.view import best_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.core.geometry import Block
from meshwind.exporting.packing import Packed, Stops, packed, stops
from meshwind.exporting.viewer_filament import FilamentData, filament_data, gear_of
from meshwind.exporting.viewer_program import ProgramData, Wound
from meshwind.path.lengths import bridged_share, bridging, lengths
from meshwind.results.laminate_reading import read_laminate
from meshwind.results.reading import Results, read_surface_grid
from meshwind.results.schema import NORMAL, UV, VIEWER

_MOST = 12_000
"""Number of points of the surface that a browser turns smoothly without a graphics card."""
_SUNK = 2e-3
"""Offset below the surface, over its size, at which it is drawn, so that fibres on it are visible."""
_NO_PLOTLY = 'the viewer needs the Python package plotly, for plotly.js; pip install "meshwind[viewer]"'


class MapData(TypedDict):
    """A map of the surface and how it is shown; marks are positions on its scale."""

    name: str
    title: str
    words: str
    unit: str
    colours: Stops
    low: float
    high: float
    log: bool
    values: Packed
    marks: list[float]
    mark_words: list[str]


class SurfaceData(TypedDict):
    """The surface: points, points as drawn, triangles, uv and maps."""

    points: Packed
    drawn: Packed
    triangles: Packed
    uv: Packed
    maps: list[MapData]


class LineData(TypedDict):
    """Segments of fibres of one kind, with data at their points; NaN points separate them."""

    kind: str
    family: int
    words: str
    count: int
    path: Packed
    points: Packed
    uv: Packed
    gap: Packed
    slip: Packed
    arc: Packed


class CameraData(TypedDict):
    """Directions to the eye and up, and visible extents over the largest side of the bounding box."""

    eye: list[float]
    up: list[float]
    width: float
    height: float


class PageData(TypedDict):
    """Contents of the page."""

    name: str
    units: str
    facts: list[str]
    surface: SurfaceData
    fibres: list[LineData]
    colours: dict[str, Stops]
    max_gap: float
    camera: CameraData
    filament: FilamentData | None
    program: ProgramData | None


def write_viewer(folder: Path, results: Results, wound: Wound | None = None) -> list[str]:
    """Write viewer.html, or the page of a program, into a folder; raises BadInputError if plotly is not installed."""
    if find_spec("plotly") is None:
        raise BadInputError(_NO_PLOTLY)
    from plotly.offline import get_plotlyjs

    page = Path(__file__).with_suffix(".html").read_text(encoding="utf-8")
    data = json.dumps(page_data(results, wound), allow_nan=False).replace("</", "<\\/")
    for mark, content in (("/*PLOTLY*/", get_plotlyjs()), ("/*SCENE*/", data), ("<!--NAME-->", _escaped(results.name))):
        before, after = page.split(mark)
        page = before + content + after
    (folder / (VIEWER if wound is None else wound.file)).write_text(page, encoding="utf-8")
    return []


def page_data(results: Results, wound: Wound | None = None) -> PageData:
    """Contents of the page, with the program of a machine if there is one."""
    grid = read_surface_grid(results.folder, results.surface)
    stands = gear_of(results)
    beside = stands.points if wound is None else np.concatenate([stands.points, wound.eye])
    return {
        "name": results.name,
        "units": results.units,
        "facts": _facts(results),
        "surface": _surface(grid, results),
        "fibres": _fibres(results),
        "colours": {"gap": stops("gap")},
        "max_gap": float(lengths(results.paths).max_gap[results.at_rest].max(initial=0.0)),
        "camera": _camera(grid, results, beside),
        "filament": filament_data(results, stands, results.filaments if wound is None else wound.filaments),
        "program": None if wound is None else wound.data,
    }


def _surface(grid: Block, results: Results) -> SurfaceData:
    """The surface, thinned to about `_MOST` points, with its maps."""
    uv = grid.point_data[UV]
    nv = int((uv[:, 0] == uv[0, 0]).sum())
    nu = len(uv) // nv
    share = min(np.sqrt(_MOST / len(uv)), 1.0)
    rows = _thinned(nu, share, results.surface.periodic)
    columns = _thinned(nv, share, False)
    kept = (rows[:, None] * nv + columns).ravel()
    number = np.arange(len(kept)).reshape(len(rows), len(columns))
    number = np.concatenate([number, number[:1]]) if results.surface.periodic else number
    a, b, c, d = (part.ravel() for part in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    points = grid.points[kept]
    size = np.linalg.norm(np.ptp(points, axis=0))
    known = [(name, look, grid.point_data[name]) for name, look in MAPS.items() if name in grid.point_data]
    laminate = read_laminate(results.folder, results.surface)
    if laminate is not None:
        known.insert(0, ("laminate", LAMINATE, laminate.thickness))
    maps = [_map(name, look, values.astype(np.float64), kept, results.units) for name, look, values in known]
    return {
        "points": packed(points.T),
        "drawn": packed((points - _SUNK * size * grid.point_data[NORMAL][kept]).T),
        "triangles": packed(np.concatenate([np.stack([a, b, c]), np.stack([a, c, d])], axis=1)),
        "uv": packed(uv[kept].T),
        "maps": maps,
    }


def _map(name: str, look: Look, values: Floats, kept: Ints, units: str) -> MapData:
    scale = look.scale(values, units)
    marks = scale.marks
    return {
        "name": name,
        "title": look.title,
        "words": "<br>".join(scale.words),
        "unit": look.unit.format(u=units) if units else "",
        "colours": stops(scale.colours),
        "low": scale.low,
        "high": scale.high,
        "log": scale.log,
        "values": packed(values[kept]),
        "marks": [share for share, _ in marks],
        "mark_words": [words for _, words in marks],
    }


def _fibres(results: Results) -> list[LineData]:
    """Fibres of each family on the surface, bridges, and paths that did not converge; empty kinds are left out."""
    paths, taut = results.paths, results.at_rest
    off = bridging(paths)
    touching = ~(off[:, :-1] | off[:, 1:])
    kinds = [("loose", 0, "not at rest", ~taut, np.ones_like(touching))]
    for family, words in ((1, "family +1"), (-1, "family −1")):
        mine = taut & (paths.family == family)
        kinds += [
            ("family", family, words, mine, touching),
            ("bridges", family, f"bridges of {words}", mine, ~touching),
        ]
    made = [_lines(results, *kind) for kind in kinds]
    return [lines for lines in made if lines["count"]]


def _lines(results: Results, kind: str, family: int, words: str, mine: Bools, wanted: Bools) -> LineData:
    """The wanted segments (p, n - 1) of some paths (p,) in sequence, with a NaN point after each run."""
    paths = results.paths
    segments = wanted & mine[:, None]
    used = np.zeros(paths.gap.shape, dtype=bool)
    used[:, :-1] |= segments
    used[:, 1:] |= segments
    path, particle = np.nonzero(used)
    goes_on = np.zeros(paths.gap.shape, dtype=bool)
    goes_on[:, :-1] = segments
    breaks = np.flatnonzero(~goes_on[path, particle]) + 1

    def at_points(values: Floats) -> Packed:
        return packed(np.insert(values[path, particle], breaks, np.nan, axis=0).T)

    return {
        "kind": kind,
        "family": family,
        "words": words,
        "count": len(path),
        "path": packed(np.insert(path, breaks, -1)),
        "points": at_points(paths.points),
        "uv": at_points(paths.uv),
        "gap": at_points(paths.gap),
        "slip": at_points(paths.slip),
        "arc": at_points(lengths(paths).arc_length),
    }


def _camera(grid: Block, results: Results, beside: Floats) -> CameraData:
    """The camera, as on the pictures, but with the part in the middle; beside (k, 3): points beyond the part."""
    nv = int((grid.point_data[UV][:, 0] == grid.point_data[UV][0, 0]).sum())
    axis = grid.points.reshape(-1, nv, 3).mean(axis=0)
    paths = results.paths
    marks = paths.points.reshape(-1, 3), paths.normal.reshape(-1, 3), paths.gap.ravel()
    view = best_view(grid.points, grid.quads, axis, *marks)
    middle = 0.5 * (grid.points.min(axis=0) + grid.points.max(axis=0))
    past = 2.0 * np.abs((beside - middle) @ np.stack([view.right, view.up], axis=1)).max(axis=0, initial=0.0)
    largest = float(np.ptp(grid.points, axis=0).max())
    return {
        "eye": view.eye.tolist(),
        "up": view.up.tolist(),
        "width": max(view.width, float(past[0])) / largest,
        "height": max(view.height, float(past[1])) / largest,
    }


def _facts(results: Results) -> list[str]:
    """Summary of the run in a few lines."""
    paths = results.paths
    each = lengths(paths)
    at_rest = int(results.at_rest.sum())
    total, bridged = float(each.polyline_length.sum()), bridged_share((each, np.ones(len(paths), dtype=bool)))
    lines = [
        f"{len(paths)} fibres, {at_rest} at rest",
        f"length {quantity(total, results.units)}, {100.0 * bridged:.1f} % of it bridged",
        f"friction {paths.friction:g}",
    ]
    width = results.band_width
    return lines if width is None else [*lines, f"band {quantity(width, results.units, 3)} wide"]


def _thinned(count: int, share: float, closed: bool) -> Ints:
    """About `share` of the numbers below `count`, evenly spaced, with both ends or around a circle."""
    many = max(round(share * count), 3)
    return np.unique(np.rint(np.linspace(0, count - (count / many if closed else 1), many)).astype(np.int64))


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")
