"""viewer.html: a run in one page for a browser, which works offline.

The page is made of the files in `viewer_page` and draws by WebGL 2 itself: nothing else is needed to write or show it.
"""

import json
import re
from pathlib import Path
from typing import TypedDict

import numpy as np

from meshwind.appearance.looks import SEQUENTIAL
from meshwind.appearance.view import best_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.core.geometry import Block
from meshwind.exporting.packing import Stops, stops
from meshwind.exporting.viewer_fibres import FibreData, fibre_data
from meshwind.exporting.viewer_filament import FilamentData, filament_data, gear_of
from meshwind.exporting.viewer_program import ProgramData, Wound
from meshwind.exporting.viewer_quads import QuadData, quad_data
from meshwind.exporting.viewer_surface import SurfaceData, surface_data
from meshwind.path.lengths import bridged_share, lengths
from meshwind.results.reading import Results, read_surface_grid
from meshwind.results.schema import UV, VIEWER

_PARTS = Path(__file__).parent / "viewer_page"
_SCRIPTS = (
    "data", "vectors", "shaders", "drawing", "camera", "bodies", "picking", "maps", "fibres", "tools", "laying",
    "start",
)  # fmt: skip
"""Parts of the script, in the order in which they build on each other."""


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
    notes: list[str]
    surface: SurfaceData
    fibres: FibreData
    colours: dict[str, Stops]
    max_gap: float
    camera: CameraData
    quads: QuadData | None
    filament: FilamentData | None
    program: ProgramData | None


def write_viewer(folder: Path, results: Results, wound: Wound | None = None) -> list[str]:
    """Write viewer.html, or the page of a program, into a folder."""
    data = json.dumps(page_data(results, wound), allow_nan=False, separators=(",", ":")).replace("</", "<\\/")
    (folder / (VIEWER if wound is None else wound.file)).write_text(page(results.name, data), encoding="utf-8")
    return []


def page(name: str, data: str) -> str:
    """The page with its style, its script and its data in it."""
    script = "\n".join(_part(f"{part}.js") for part in _SCRIPTS)
    parts = {"/*STYLE*/": _part("page.css"), "/*DATA*/": data, "/*SCRIPT*/": script, "<!--NAME-->": _escaped(name)}
    marks = "|".join(re.escape(mark) for mark in parts)
    # in one go: a part's content is not searched for the marks of others
    return re.sub(marks, lambda mark: parts[mark[0]], _part("page.html"))


def _part(name: str) -> str:
    return (_PARTS / name).read_text(encoding="utf-8")


def page_data(results: Results, wound: Wound | None = None) -> PageData:
    """Contents of the page, with the program of a machine if there is one."""
    grid = read_surface_grid(results.folder, results.surface)
    stands = gear_of(results)
    surface, fibres = surface_data(grid, results), fibre_data(results)
    quads = quad_data(results)
    beside = stands.points if wound is None else np.concatenate([stands.points, wound.eye])
    return {
        "name": results.name,
        "units": results.units,
        "facts": _facts(results),
        "surface": surface,
        "fibres": fibres,
        "colours": {"gap": stops("gap"), "scale": stops(SEQUENTIAL)},
        "notes": _notes(surface, fibres, quads, results),
        "max_gap": float(lengths(results.paths).max_gap[results.at_rest].max(initial=0.0)),
        "camera": _camera(grid, results, beside),
        "quads": quads if quads is not None and quads["ends"]["data"] else None,
        "filament": filament_data(results, stands, results.filaments if wound is None else wound.filaments),
        "program": None if wound is None else wound.data,
    }


def _notes(surface: SurfaceData, fibres: FibreData, quads: QuadData | None, results: Results) -> list[str]:
    """What the page does not show, or only coarsely."""
    off = f"The part is drawn by facets up to {quantity(surface['off'], results.units, 2)} off its surface"
    notes = [f"{off}; values under the pointer are those of the nearest node of {surface['whole']} in surface.vtu."]
    if surface["shown"] < surface["whole"]:
        notes[0] = notes[0].replace(f"of {surface['whole']}", f"of {surface['shown']} out of {surface['whole']}")
    if fibres["step"] > 1:
        notes.append(
            f"Of the fibres' particles the page has one in {fibres['step']}, and those where bridges begin and end; "
            "the figures of fibres are from all of them."
        )
    if quads is not None and not quads["ends"]["data"]:
        notes.append(f"The {quads['count']} quads between crossings are too many for the page; quads.vtu has them.")
    if results.layers:
        notes.append("Fibres are those of the first layer.")
    return notes


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


def _escaped(text: str) -> str:
    return text.replace("&", "&amp;").replace("<", "&lt;")
