"""The pictures of a winding by name; each is a file of that name."""

from collections.abc import Callable
from typing import Any

from meshwind.pictures.layup_scenes import crossings_scene, quads_scene
from meshwind.pictures.map_scene import coverage_scene, fit_map_scene, windability_scene
from meshwind.pictures.slip_scene import slip_scene
from meshwind.pictures.subject import Subject
from meshwind.pictures.unrolled_scene import unrolled_scene
from meshwind.pictures.winding_scene import winding_scene
from meshwind.results.schema import FIT, FIT_ERROR

PICTURES: dict[str, Callable[[Subject], dict[str, Any]]] = {
    "winding": winding_scene,
    "crossings": crossings_scene,
    "coverage": coverage_scene,
    "windability": windability_scene,
    "slip": slip_scene,
    "fit": fit_map_scene,
    "unrolled": unrolled_scene,
    "quads": quads_scene,
}


def scenes_of(of: Subject) -> dict[str, dict[str, Any]]:
    """All pictures that there are of a winding; without its fit error the surface has no picture of that."""
    return {name: make(of) for name, make in PICTURES.items() if name != FIT or FIT_ERROR in of.maps}
