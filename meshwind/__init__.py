"""meshwind winds taut fibres on any freeform triangle mesh.

    import meshwind as mw

    result = mw.wind("data/vase.stl", paths=12, revolutions=0.8)
    result.write("out")

or stage by stage: `read`, `annulus`, `flatten`, `fit`, `families`, `solve`, `assess`.  Names load on first use,
so that importing the package costs next to nothing.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from meshwind.chart import Chart as Chart
    from meshwind.chart import flatten as flatten
    from meshwind.core.errors import BadInputError as BadInputError
    from meshwind.editing.redesign import Redesign as Redesign
    from meshwind.editing.redesign import redesign as redesign
    from meshwind.export.cad_surface import read_cad as read_cad
    from meshwind.layup import Layup as Layup
    from meshwind.layup import assess as assess
    from meshwind.layup import windability as windability
    from meshwind.march import Stop as Stop
    from meshwind.march import Trace as Trace
    from meshwind.march import trace as trace
    from meshwind.march import traces as traces
    from meshwind.mesh import Annulus as Annulus
    from meshwind.mesh import Mesh as Mesh
    from meshwind.mesh import annulus as annulus
    from meshwind.mesh import read as read
    from meshwind.path import Paths as Paths
    from meshwind.path import Status as Status
    from meshwind.path import drag as drag
    from meshwind.path import solve as solve
    from meshwind.path.friction import Friction as Friction
    from meshwind.path.friction import friction_from as friction_from
    from meshwind.pictures.page import Page as Page
    from meshwind.pictures.redesign_scene import draw_redesign as draw_redesign
    from meshwind.pictures.render import render as render
    from meshwind.planning import Families as Families
    from meshwind.planning import choose_revolutions as choose_revolutions
    from meshwind.planning import families as families
    from meshwind.planning import read_pins as read_pins
    from meshwind.planning import space_out as space_out
    from meshwind.results.image_files import read_image as read_image
    from meshwind.run.redesign import write_redesign as write_redesign
    from meshwind.run.wind import Result as Result
    from meshwind.run.wind import wind as wind
    from meshwind.surface import FitError as FitError
    from meshwind.surface import Surface as Surface
    from meshwind.surface import fit as fit
    from meshwind.surface import from_image as from_image
    from meshwind.surface import shapes as shapes
    from meshwind.surface import surface_image as surface_image

    __version__: str

_HOME = {
    "BadInputError": "core.errors",
    "Mesh": "mesh", "Annulus": "mesh", "read": "mesh", "annulus": "mesh",
    "Chart": "chart", "flatten": "chart",
    "Surface": "surface", "FitError": "surface", "fit": "surface", "shapes": "surface",
    "surface_image": "surface", "from_image": "surface", "read_image": "results.image_files",
    "trace": "march", "traces": "march", "Trace": "march", "Stop": "march",
    "Paths": "path", "Status": "path", "solve": "path", "drag": "path",
    "Friction": "path.friction", "friction_from": "path.friction",
    "Families": "planning", "families": "planning", "choose_revolutions": "planning", "read_pins": "planning",
    "space_out": "planning",
    "Layup": "layup", "assess": "layup", "windability": "layup",
    "read_cad": "export.cad_surface",
    "Redesign": "editing.redesign", "redesign": "editing.redesign", "write_redesign": "run.redesign",
    "Result": "run.wind", "wind": "run.wind",
    "render": "pictures.render", "Page": "pictures.page", "draw_redesign": "pictures.redesign_scene",
}  # fmt: skip

__all__ = sorted(_HOME)


def __getattr__(name: str) -> Any:
    if name == "__version__":
        return import_module("meshwind.core.version").version()
    if name not in _HOME:
        raise AttributeError(f"module 'meshwind' has no attribute {name!r}")
    value = getattr(import_module(f"meshwind.{_HOME[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
