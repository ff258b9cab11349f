"""`meshwind info`: what a mesh holds, what a run found, or what this installation can do; nothing is written."""

import platform
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated, Any

import typer

from meshwind.cli.arguments import Printed
from meshwind.cli.output import print_report
from meshwind.cli.signature import with_records
from meshwind.core.errors import BadInputError
from meshwind.core.version import version

EXAMPLES = """
    # a mesh: format, size, pieces, rims, fields
    meshwind info part.stl

    # the figures of a run
    meshwind info part-wound

    # versions, and whether this machine can draw
    meshwind info
"""
_LIBRARIES = "numpy", "scipy", "numba", "libigl", "trimesh", "meshio", "pyvista", "vtk", "matplotlib", "pillow", "osqp"
_EXTRAS = {"cad": ("OCP", "STEP"), "viewer": ("plotly", "viewer.html")}
"""Module that shows whether an optional part is installed, and what the part is for."""


@with_records
def info(
    *,
    what: Annotated[
        Path | None,
        typer.Argument(
            metavar="FILE_OR_DIR", help="Mesh, or results folder of `meshwind wind`; without it, this program."
        ),
    ] = None,
    printed: Printed,
) -> int:
    """Describe a mesh file, the run in a results folder, or this installation."""
    if what is None:
        figures = _installation()
        lines = _installation_lines(figures)
    elif what.is_dir():
        lines, figures = _run(what)
    else:
        lines, figures = _mesh(what)
    print_report(lines, figures, printed)
    return 0


def _run(folder: Path) -> tuple[list[str], dict[str, Any]]:
    from meshwind.cli.summary import redesign_lines, run_lines
    from meshwind.results.reading import read_report

    report = read_report(folder)
    try:
        lines = redesign_lines(report) if "redesign" in report else run_lines(report)
        run = f"run       {report['command'] or 'wound by the library'} (meshwind {report['meshwind']})"
        return [run, *lines], dict(report)
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise BadInputError(f"the report in {folder} lacks figures ({error}); make it again") from error


def _mesh(file: Path) -> tuple[list[str], dict[str, Any]]:
    from dataclasses import asdict

    from meshwind.cli.check import described
    from meshwind.mesh import inspect
    from meshwind.mesh.io.scalars import scalar_names

    found = inspect(file)
    fields = scalar_names(file)
    named = ", ".join(fields) or "none"
    return [*described(found), f"fields    {named}"], asdict(found) | {"fields": list(fields)}


def _installation() -> dict[str, Any]:
    """Versions by library, None where there is none; pictures and movies: "" or what is missing; extras: presence."""
    from meshwind.pictures.driver import can_draw
    from meshwind.pictures.movie import encoder

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


def _installation_lines(found: dict[str, Any]) -> list[str]:
    """The installation in a few lines."""
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
        return f"{name:<10}installed, for {_EXTRAS[name][1]}"
    return f'{name:<10}not installed; for {_EXTRAS[name][1]}: pip install "meshwind[{name}]"'


def _version(library: str) -> str | None:
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return None
