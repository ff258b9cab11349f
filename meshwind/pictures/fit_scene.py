"""Scene of fit_error.png."""

import numpy as np

from meshwind.appearance.view import around, merit_view
from meshwind.appearance.words import quantity
from meshwind.core.cast import Bools, Floats
from meshwind.mesh.geometry.areas_and_volumes import edge_lengths
from meshwind.mesh.geometry.mesh import Annulus
from meshwind.pictures.scenes import FitScene, Frame, MeasuredBody
from meshwind.surface.fitting.deviation import Deviation, Mismatch, deviation
from meshwind.surface.surface import Surface

_EYES = 240
_EXACT = 1e-9
"""Smallest upper end of the scale, over the diagonal: distances below are round-off."""
_SKIP = 1e-3
"""Distance, over the diagonal, from a point to the start of a ray from it, which must not hit its own facets."""
_CLOSE_UP = 8.0, 0.05, 0.15
"""Half the width of the close-up over the largest distance, and its bounds over the diagonal."""


def fit_scene(surface: Surface, annulus: Annulus, name: str, units: str = "") -> FitScene:
    """Mesh and surface with their distances, the worst places, the view and the words."""
    found = deviation(surface, annulus)
    diagonal = annulus.mesh.diagonal
    eyes = around(_EYES)
    view = merit_view(found.mesh.points, found.mesh.faces, eyes, _merit(found, eyes, _SKIP * diagonal))
    worst = found.regions[0].distance
    size, least, most = _CLOSE_UP
    title = f"{name}: where the surface leaves the mesh"
    return FitScene(
        frame=Frame(title, _subtitle(found, diagonal, units), units, view),
        diagonal=diagonal,
        mesh=MeasuredBody(found.mesh.points, found.mesh.faces, found.to_surface),
        surface=MeasuredBody(found.surface.points, found.surface.faces, found.to_mesh),
        edge=float(np.median(edge_lengths(found.mesh.points, found.mesh.faces))),
        most=max(worst, _EXACT * diagonal),
        pairs=np.array([[region.on_mesh, region.on_surface] for region in found.regions]),
        seen=np.array([_seen(found, region, view.eye[None], _SKIP * diagonal)[:, 0] for region in found.regions]),
        distances=np.array([region.distance for region in found.regions]),
        close_up=float(np.clip(size * worst, least * diagonal, most * diagonal)),
    )


def _merit(found: Deviation, eyes: Floats, skip: float) -> Floats:
    """Merit of each direction (k, 3): whether the worst place is visible on both bodies, and the gap from its side."""
    worst = found.regions[0]
    gap = worst.on_surface - worst.on_mesh
    gap = gap / max(float(np.linalg.norm(gap)), 1e-300)
    in_sight = _seen(found, worst, eyes, skip)
    facing = np.maximum(eyes @ (found.mesh.normal(worst.on_mesh) + found.surface.normal(worst.on_surface)), 0.0)
    sidewise = 1.0 - np.abs(eyes @ gap)
    return np.asarray(2.0 * in_sight[0] + in_sight[1] + 0.5 * facing + 0.5 * sidewise - 1e-3 * eyes[:, 1])


def _seen(found: Deviation, region: Mismatch, eyes: Floats, skip: float) -> Bools:
    """Whether a place is visible (2, k) from each direction (k, 3): on the mesh alone and on the surface alone."""
    bodies = (found.mesh, region.on_mesh), (found.surface, region.on_surface)
    return np.stack([body.clear(point, eyes, skip) for body, point in bodies])


def _subtitle(found: Deviation, diagonal: float, units: str) -> str:
    worst = found.regions[0].distance
    nu, nv = found.grid.surface.control_points.shape[:2]
    return (
        f"distance between the two up to {quantity(worst, units, 2)}, {100.0 * worst / diagonal:.2g} % of the part"
        f"  ·  {nu} x {nv} control points"
    )
