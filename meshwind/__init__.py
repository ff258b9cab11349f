"""meshwind winds taut fibres on freeform triangle meshes.

The whole work in two lines::

    import meshwind as mw

    result = mw.wind("data/vase.stl", paths=12, revolutions=0.8)
    result.write("out")

or stage by stage: `read`, `annulus`, `flatten`, `fit`, `families`, `solve`, `assess`.  `meshwind.theory` states the
equations, with the numbers that are cited below and in the code.  Names are imported on first use, so that importing
the package itself costs next to nothing.

Glossary
--------
Units: "length" is the unit of the mesh; angles are in radians here and in the code, and in degrees in files.

Surface and chart

============== =============================================================== ============ ========
symbol         name                                                            unit         equation
============== =============================================================== ============ ========
u, v           parameters: u around the part, v from the start rim to the end  turns, 1
               rim
s(u, v)        surface; s_u, s_uv, ... its partial derivatives                 length       (3.19)
n              outward unit normal, along s_u x s_v                            1            (3.4)
C              control net: the control points of the surface                  length       (6.7)
..             annulus: mesh with two boundary loops and no handle
..             rim: either of the two loops, v=0 (start) and v=1 (end)
..             opening: hole cut about the pole of a closed end
..             chart: one-to-one map of the annulus to the periodic rectangle
..             stretch: area on the part over area in the chart                1
..             fit error: distance between the surface and the mesh            length
..             foot: nearest point of the surface to a point                   length       (5.4)
============== =============================================================== ============ ========

Fibres

============== =============================================================== ============ ========
symbol         name                                                            unit         equation
============== =============================================================== ============ ========
P_i            particle i of a path                                            length       (4.1)
t              unit tangent of the fibre                                       1            (3.19)
T              tension, the same all along a fibre                             force        (3.4)
N              support: normal force per length of fibre                       force/length (3.4)
kn             normal curvature of the fibre, positive where it presses        1/length     (3.12)
kg             geodesic curvature, its bend within the surface                 1/length     (3.12)
mu             coefficient of friction                                         1            (3.12)
``|kg|/kn``    required friction: the coefficient that the fibre needs to stay 1            (3.12)
               where it is; the field and attribute `slip`
alpha          winding angle, from the direction of v: 0 along the part, pi/2  rad
               around it (hoop)
n_rev          revolutions: turns of a path from end to end                    turns        (6.1)
..             family: the paths of one sense of turning, +1 or -1
..             geodesic: path with kg = 0
..             initial path: straight in the chart, before the fibre is taut                (6.2)
..             taut path: path in equilibrium, each particle stuck or slipping              (3.12)
..             touching, lifted: on the surface, off it                                     (5.1)
gap            distance of a lifted particle from its foot                     length       (5.4)
..             bridging: a fibre spans a hollow in a straight line                          (5.2)
..             windability: share of the tangent directions in which a fibre   1            (6.3)
               presses
..             feasible revolutions: those at which no fibre slides off a rim  turns
============== =============================================================== ============ ========

Layup

============== =============================================================== ============ ========
symbol         name                                                            unit         equation
============== =============================================================== ============ ========
theta          angle of a crossing of the two families                         rad
..             quality of a crossing: ``|cos(theta)|``, 0 where it is square   1
..             band: the fibre with its width
..             coverage (cover factor): layers of band over the surface, as    1
               length of fibre times width over area
..             spacing: distance between neighbours of a family                length
============== =============================================================== ============ ========

Solver

============== =============================================================== ============ ========
symbol         name                                                            unit         equation
============== =============================================================== ============ ========
E              energy of the springs between the particles                     length^2     (4.1)
F_i            force on particle i from its neighbours                         length       (4.1)
J              Jacobian (s_u, s_v) of the particles' positions                 length       (4.4)
K, m, beta     spring constant, mass, damping; only K/m and beta/m count                    (4.7)
h              time step of the literature's methods                                        (4.10)
..             residual: largest unbalanced tangential force over T            rad          (3.12)
..             active set: which particles touch, and which of these stick
..             negative curvature: direction in which E falls from an          length^2     (4.1)
               equilibrium, which is then a saddle and not stable
..             nested iteration: solving with few particles first, and
               starting from that with more
..             converged: in equilibrium within the tolerance
============== =============================================================== ============ ========
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from meshwind.chart import Chart as Chart
    from meshwind.chart import flatten as flatten
    from meshwind.core.errors import BadInputError as BadInputError
    from meshwind.editing.redesign import Redesign as Redesign
    from meshwind.editing.redesign import redesign as redesign
    from meshwind.exporting.cad_surface import read_cad as read_cad
    from meshwind.exporting.targets import Exported as Exported
    from meshwind.layup import Layup as Layup
    from meshwind.layup import assess as assess
    from meshwind.layup import windability as windability
    from meshwind.march import Stop as Stop
    from meshwind.march import Trace as Trace
    from meshwind.march import trace as trace
    from meshwind.march import traces as traces
    from meshwind.mesh import Annulus as Annulus
    from meshwind.mesh import Findings as Findings
    from meshwind.mesh import Mesh as Mesh
    from meshwind.mesh import annulus as annulus
    from meshwind.mesh import check as check
    from meshwind.mesh import read as read
    from meshwind.path import Paths as Paths
    from meshwind.path import Status as Status
    from meshwind.path import drag as drag
    from meshwind.path import solve as solve
    from meshwind.path.friction import Friction as Friction
    from meshwind.path.friction import friction_from as friction_from
    from meshwind.path.one_path import OnePath as OnePath
    from meshwind.pictures.page import Page as Page
    from meshwind.pictures.picture import Picture as Picture
    from meshwind.pictures.redesign_scene import draw_redesign as draw_redesign
    from meshwind.pictures.render import render as render
    from meshwind.planning.families import Families as Families
    from meshwind.planning.families import families as families
    from meshwind.planning.pins import read_pins as read_pins
    from meshwind.planning.revolutions import choose_revolutions as choose_revolutions
    from meshwind.planning.spacing import space_out as space_out
    from meshwind.results.image_files import read_image as read_image
    from meshwind.run.export import export as export
    from meshwind.run.loaded import LoadedResult as LoadedResult
    from meshwind.run.loaded import load as load
    from meshwind.run.redesign import write_redesign as write_redesign
    from meshwind.run.result import Result as Result
    from meshwind.run.solve import Solution as Solution
    from meshwind.run.solve import solve_deck as solve_deck
    from meshwind.run.wind import wind as wind
    from meshwind.studies.run import Swept as Swept
    from meshwind.studies.run import sweep as sweep
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
    "check": "mesh", "Findings": "mesh",
    "Chart": "chart", "flatten": "chart",
    "Surface": "surface", "FitError": "surface", "fit": "surface", "shapes": "surface",
    "surface_image": "surface", "from_image": "surface", "read_image": "results.image_files",
    "trace": "march", "traces": "march", "Trace": "march", "Stop": "march",
    "Paths": "path", "Status": "path", "solve": "path", "drag": "path", "OnePath": "path.one_path",
    "Friction": "path.friction", "friction_from": "path.friction",
    "Families": "planning.families", "families": "planning.families", "read_pins": "planning.pins",
    "choose_revolutions": "planning.revolutions", "space_out": "planning.spacing",
    "Layup": "layup", "assess": "layup", "windability": "layup",
    "read_cad": "exporting.cad_surface",
    "Redesign": "editing.redesign", "redesign": "editing.redesign", "write_redesign": "run.redesign",
    "Result": "run.result", "wind": "run.wind", "load": "run.loaded", "LoadedResult": "run.loaded",
    "solve_deck": "run.solve", "Solution": "run.solve",
    "export": "run.export", "Exported": "exporting.targets", "sweep": "studies.run", "Swept": "studies.run",
    "render": "pictures.render", "Page": "pictures.page", "Picture": "pictures.picture",
    "draw_redesign": "pictures.redesign_scene",
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
