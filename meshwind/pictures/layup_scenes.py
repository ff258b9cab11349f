"""What is to be seen on the pictures of crossings and of the quad mesh."""

from typing import Any

import numpy as np

from meshwind.appearance.looks import Look, fixed
from meshwind.pictures.subject import Subject
from meshwind.pictures.winding_scene import fibres

ANGLE = Look("crossing angle", "angle between\nthe families", "degrees", "viridis", fixed(0.0, 90.0), step=15.0)


def crossings_scene(of: Subject) -> dict[str, Any]:
    """Where the two families cross, by the angle between them."""
    met = of.layup.crossings
    angle = np.degrees(met.angle)
    scale = ANGLE.scale(angle, of.units)
    told = "the families do not cross"
    if len(met):
        low, usual, high = np.quantile(angle, [0.0, 0.5, 1.0])
        told = f"{len(met)} crossings at {low:.0f}° to {high:.0f}°, half of them above {usual:.0f}°"
    normals = of.paths.surface.normals(met.uv) if len(met) else np.zeros((0, 3))
    seen = of.framed("crossings", f"{of.name}: angle at which the families cross", told) | fibres(of) | scale.told
    return seen | {"shares": scale.shares(angle), "crossings": met.points, "crossing_normals": normals}


def quads_scene(of: Subject) -> dict[str, Any]:
    """The quad mesh: quads, triangles at the rims, and the corners that lie off the surface."""
    mesh = of.layup.quads
    count = f"{len(mesh.quads)} quads, {len(mesh.triangles)} triangles"
    off = int((~mesh.on_surface).sum())
    where = (
        f"{off} of {len(mesh.points)} corners off the surface, where a fibre bridges"
        if off
        else "every corner on the surface"
    )
    told = f"{count}  ·  {where}"
    if not len(mesh.quads) + len(mesh.triangles):
        told = f"no quad mesh: {mesh.note}" if mesh.note else "no quad mesh"
    return of.framed("quads", f"{of.name}: quad mesh on the crossings", told) | {
        "corners": mesh.points,
        "corner_off": ~mesh.on_surface,
        "mesh_quads": mesh.quads,
        "mesh_triangles": mesh.triangles,
    }
