"""What is to be seen on fit_error.png, gathered as arrays for the process that draws it."""

from typing import Any

import numpy as np

from meshwind.appearance.view import around, place_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Bools, Floats
from meshwind.mesh.geometry.annulus import Annulus
from meshwind.mesh.geometry.measure import edge_lengths
from meshwind.surface.fitting.deviation import Deviation, Mismatch, Triangles, deviation
from meshwind.surface.surface import Surface

_EYES = 240
_EXACT = 1e-9
"""Over the diagonal: distances below are round-off, and the scale of colours does not go there."""
_SKIP = 1e-3
"""Over the diagonal: a ray from a place starts this far off it, clear of its own facets."""
_CLOSE_UP = 8.0, 0.05, 0.15
"""Half a close-up's width over the worst distance, and its bounds over the diagonal."""


def fit_scene(surface: Surface, annulus: Annulus, name: str, units: str = "") -> dict[str, Any]:
    """All that the renderer needs: mesh and surface with their distances, the worst places, the view, the words."""
    found = deviation(surface, annulus)
    diagonal = annulus.mesh.diagonal
    eyes = around(_EYES)
    view = place_view(found.mesh.points, found.mesh.faces, eyes, _merit(found, eyes, _SKIP * diagonal))
    towards = view.eye[None]
    worst = found.regions[0]
    size, least, most = _CLOSE_UP
    return {
        "kind": "fit",
        "title": f"{name}: where the surface leaves the mesh",
        "subtitle": _subtitle(found, diagonal, units),
        "units": units,
        "diagonal": diagonal,
        "mesh_points": found.mesh.points,
        "mesh_faces": found.mesh.faces,
        "mesh_away": found.to_surface,
        "edge": float(np.median(edge_lengths(found.mesh.points, found.mesh.faces))),
        "surface_points": found.surface.points,
        "surface_faces": found.surface.faces,
        "surface_away": found.to_mesh,
        "most": max(worst.distance, _EXACT * diagonal),
        "places": np.array([[region.on_mesh, region.on_surface] for region in found.regions]),
        "seen": np.array([_seen(found, region, towards, _SKIP * diagonal)[:, 0] for region in found.regions]),
        "away": np.array([region.distance for region in found.regions]),
        "close_up": float(np.clip(size * worst.distance, least * diagonal, most * diagonal)),
        "right": view.right,
        "up": view.up,
        "eye": view.eye,
        "centre": view.centre,
        "extent": np.array([view.width, view.height]),
    }


def _merit(found: Deviation, eyes: Floats, skip: float) -> Floats:
    """How well each direction (k, 3) shows the worst place: in sight on both bodies, and the gap from its side."""
    worst = found.regions[0]
    gap = worst.on_surface - worst.on_mesh
    gap = gap / max(float(np.linalg.norm(gap)), 1e-300)
    in_sight = _seen(found, worst, eyes, skip)
    facing = np.maximum(eyes @ (found.mesh.normal(worst.on_mesh) + found.surface.normal(worst.on_surface)), 0.0)
    sidewise = 1.0 - np.abs(eyes @ gap)
    return np.asarray(2.0 * in_sight[0] + in_sight[1] + 0.5 * facing + 0.5 * sidewise - 1e-3 * eyes[:, 1])


def _seen(found: Deviation, region: Mismatch, eyes: Floats, skip: float) -> Bools:
    """Whether a place is in sight (2, k) from each direction (k, 3): on the mesh alone and on the surface alone."""
    pairs: list[tuple[Triangles, Floats]] = [(found.mesh, region.on_mesh), (found.surface, region.on_surface)]
    return np.stack([body.clear(point, eyes, skip) for body, point in pairs])


def _subtitle(found: Deviation, diagonal: float, units: str) -> str:
    worst = found.regions[0].distance
    nu, nv = found.grid.surface.control_points.shape[:2]
    return (
        f"distance between the two up to {quantity(worst, units, 2)}, {100.0 * worst / diagonal:.2g} % of the part"
        f"  ·  {nu} x {nv} control points"
    )
