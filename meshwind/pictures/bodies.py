"""Meshes in the pictures: the part, fibres as tubes, bridges coloured by their gap."""

from typing import Any, NamedTuple

import numpy as np
import pyvista as pv

from meshwind.core.cast import Floats, Ints
from meshwind.pictures.canvas import FAMILY, INSIDE, LOOSE, PART
from meshwind.pictures.scenes import Fibres, Part

TUBE = 3.0, 0.16
"""Radius of a tube in pixels, and its upper limit over the pitch."""
_SIDES = 8
"""Sides of a tube."""
_MANY = 30_000
"""Points above which fibres are thinner than a pixel or so, and drawn as lines: tubes take 7 kB a point."""


class Stroke(NamedTuple):
    """How thick a fibre is drawn: its radius, and the size of a pixel, in mesh units."""

    radius: float
    pixel: float

    def times(self, share: float) -> "Stroke":
        """A stroke whose radius is a multiple of this one's."""
        return self._replace(radius=share * self.radius)

    @property
    def width(self) -> float:
        """Width of a line, in pixels."""
        return max(2.0 * self.radius / self.pixel, 1.0)


def add_part(window: Any, part: Part) -> None:
    """Add the fitted surface, matt, darker inside."""
    inside = {"color": INSIDE, "ambient": 0.25, "interpolation": "Phong"}
    add_smooth(window, body(part), backface_params=inside, color=PART, ambient=0.3, diffuse=0.8)


def add_map(window: Any, part: Part, shares: Floats, colours: Any) -> None:
    """Add the fitted surface coloured by shares (k,) outside, and plain inside, where colours would mislead."""
    inside = body(part)
    add_smooth(window, inside, color=INSIDE, ambient=0.25, culling="front")
    outside = inside.copy()
    outside.point_data["shares"] = shares
    add_smooth(window, outside, ambient=0.55, diffuse=0.5, culling="back", **coloured("shares", colours, 1.0))


def add_smooth(window: Any, mesh: Any, **look: Any) -> Any:
    """Add a mesh that has normals; `smooth_shading` would compute them again, which takes a third of the time."""
    actor = window.add_mesh(mesh, render=False, **look)
    actor.prop.interpolation = "Phong"
    return actor


def body(part: Part) -> Any:
    """The quads of a part with unit normals."""
    mesh = pv.PolyData.from_regular_faces(part.points, part.quads)
    size = np.linalg.norm(part.normals, axis=1, keepdims=True)
    mesh.point_data["Normals"] = part.normals / np.maximum(size, 1e-300)
    mesh.point_data.active_normals_name = "Normals"
    return mesh


def stroke(part: Part, scale: float, unit: float) -> Stroke:
    """That of the fibres; scale: mesh units per pixel, unit: pixels per pixel of the designed page."""
    pixels, share = TUBE
    return Stroke(float(min(pixels * unit * scale, share * part.pitch)), scale)


def lifted(fibres: Fibres, thick: float) -> Floats:
    """Points (p, n, 3) of the fibres, lifted by the radius of their tubes so that these lie on the part."""
    return np.asarray(fibres.points + thick * fibres.lift)


def add_fibres(window: Any, fibres: Fibres, stroke: Stroke, colours: dict[int, str] = FAMILY) -> None:
    """Add both families."""
    points = lifted(fibres, stroke.radius)
    for name, colour in colours.items():
        add_paths(window, points[(fibres.family == name) & fibres.converged], stroke, colour)
    add_paths(window, points[~fibres.converged], stroke.times(0.6), LOOSE)


def add_paths(window: Any, points: Floats, stroke: Stroke, colour: str) -> None:
    """Add paths (p, n, 3) of one colour."""
    if len(points):
        lines = polylines(points.reshape(-1, 3), np.full(len(points), points.shape[1]))
        add_strokes(window, lines, stroke, color=colour)


def add_strokes(window: Any, lines: Any, stroke: Stroke, **look: Any) -> None:
    """Add polylines as tubes or, where they are many, as lines, which the part does not hide."""
    if lines.n_points <= _MANY:
        tubes = lines.tube(radius=stroke.radius, n_sides=_SIDES)
        add_smooth(window, tubes, ambient=0.4, diffuse=0.7, **look)
        return
    actor = window.add_mesh(lines, line_width=stroke.width, lighting=False, render=False, **look)
    actor.mapper.resolve = "polygon_offset"  # else the facets of the part would cut lines that lie on it


def coloured(name: str, colours: Any, most: float) -> dict[str, Any]:
    """The look of what is coloured by one of its fields from 0 to `most`."""
    return {"scalars": name, "cmap": colours, "show_scalar_bar": False, "clim": [0.0, most]}


def polylines(points: Floats, sizes: Ints) -> Any:
    """Polylines over consecutive points (k, 3); sizes (l,): number of points of each."""
    starts = np.concatenate([[0], np.cumsum(sizes)])
    cells = np.insert(np.arange(len(points)), starts[:-1], sizes)
    return pv.PolyData(points, lines=cells)
