"""Pictures of a winding and of a fit, drawn by the process of `painter.py`."""

from os import PathLike
from pathlib import Path

from meshwind.layup.layup import Layup
from meshwind.mesh.geometry.mesh import Annulus
from meshwind.pictures.drawings import Drawing
from meshwind.pictures.fit_scene import fit_scene
from meshwind.pictures.painter import NO_DRIVER, Drawn, can_draw, paint, start_probe, stop
from meshwind.pictures.subject import subject
from meshwind.pictures.winding_scene import winding_scene
from meshwind.surface.surface import Surface

__all__ = ["NO_DRIVER", "Drawn", "can_draw", "draw", "draw_fit", "paint", "start_probe", "stop"]


def draw(
    picture: str | PathLike[str], layup: Layup, name: str, units: str = "", revolutions: float | None = None
) -> str:
    """Draw the part and its fibres into a .png; return "" or one line that says why there is no picture.

    revolutions: as given, for the title.
    """
    return paint({Path(picture): Drawing(winding_scene(subject(layup, name, units, revolutions)))})


def draw_fit(picture: str | PathLike[str], surface: Surface, annulus: Annulus, name: str = "", units: str = "") -> str:
    """Draw the distance between a surface and its mesh into a .png: both, and a close-up of the worst place.

    Returns "" or one line that says why there is no picture; name: for the title, by default the mesh's.
    """
    return paint({Path(picture): Drawing(fit_scene(surface, annulus, name or annulus.mesh.name, units))})
