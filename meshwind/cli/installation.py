"""What this installation consists of and what it can do: versions, pictures, optional parts."""

import platform
from importlib import metadata
from importlib.util import find_spec
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.core.version import version

_LIBRARIES = "numpy", "scipy", "numba", "libigl", "trimesh", "meshio", "pyvista", "vtk", "matplotlib", "pillow", "osqp"
_EXTRAS = {"cad": ("OCP", "STEP"), "viewer": ("plotly", "viewer.html")}
"""Per optional part the module that it is known by, and what it is for."""


def installation() -> dict[str, Any]:
    """Versions by library, None where there is none; pictures and movies: "" or what is missing; extras present."""
    from meshwind.pictures.driver import can_draw
    from meshwind.pictures.encoder import encoder

    try:
        movies = "" if encoder() else "none"
    except BadInputError as error:
        movies = str(error)
    return {
        "meshwind": version(),
        "python": platform.python_version(),
        "libraries": {name: _version(name) for name in _LIBRARIES},
        "pictures": can_draw(),
        "movies": movies,
        "extras": {name: find_spec(module) is not None for name, (module, _) in _EXTRAS.items()},
    }


def told(found: dict[str, Any]) -> list[str]:
    """The same for a person, a label before each line."""
    libraries = ", ".join(f"{name} {number or 'missing'}" for name, number in found["libraries"].items())
    return [
        f"meshwind  {found['meshwind']}, Python {found['python']}",
        f"library   {libraries}",
        f"pictures  {found['pictures'] or 'can be drawn'}",
        f"movies    {found['movies'] or 'can be made, GIF and MP4'}",
        *(_extra(name, there) for name, there in found["extras"].items()),
    ]


def _extra(name: str, there: bool) -> str:
    if there:
        return f"{name:<10}there, for {_EXTRAS[name][1]}"
    return f'{name:<10}not there; for {_EXTRAS[name][1]} install it: pip install "meshwind[{name}]"'


def _version(library: str) -> str | None:
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return None
