"""`meshwind info`: what a mesh holds, what a run found, or what this installation can do; nothing is written."""

import platform
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import Annotated

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
_LIBRARIES = (
    "numpy",
    "scipy",
    "numba",
    "libigl",
    "trimesh",
    "meshio",
    "pyvista",
    "vtk",
    "matplotlib",
    "pillow",
    "clarabel",
    "h5py",
)
_EXTRAS = {"cad": ("OCP", "STEP"), "pandas": ("pandas", "tables in Python")}
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
    lines: list[str]
    figures: Mapping[str, object]
    if what is None:
        found = _installation()
        lines, figures = found.lines, asdict(found)
    elif what.is_dir():
        lines, figures = _run(what)
    else:
        lines, figures = _mesh(what)
    print_report(lines, figures, printed)
    return 0


def _run(folder: Path) -> tuple[list[str], Mapping[str, object]]:
    from meshwind.results.reading import read_report
    from meshwind.run.summary import redesign_lines, run_lines

    report = read_report(folder)
    try:
        lines = redesign_lines(report) if "redesign" in report else run_lines(report)
        run = f"run       {report['command'] or 'wound by the library'} (meshwind {report['meshwind']})"
        return [run, *lines], dict(report)
    except (LookupError, TypeError, ValueError, AttributeError) as error:
        raise BadInputError(f"the report in {folder} lacks figures ({error}); make it again") from error


def _mesh(file: Path) -> tuple[list[str], Mapping[str, object]]:
    from meshwind.cli.check import described
    from meshwind.mesh import check
    from meshwind.mesh.io.scalars import scalar_names

    found = check(file)
    fields = scalar_names(file)
    named = ", ".join(fields) or "none"
    return [*described(found), f"fields    {named}"], asdict(found) | {"fields": list(fields)}


@dataclass(frozen=True)
class _Installation:
    """The version of each library, None where there is none, and what can be done.

    pictures, movies: "" or what is missing for them; extras: whether each optional part is installed.
    """

    meshwind: str
    python: str
    libraries: dict[str, str | None]
    pictures: str
    movies: str
    extras: dict[str, bool]

    @property
    def lines(self) -> list[str]:
        """The same in a few lines."""
        libraries = ", ".join(f"{name} {number or 'missing'}" for name, number in self.libraries.items())
        return [
            f"meshwind  {self.meshwind}, Python {self.python}",
            f"library   {libraries}",
            f"pictures  {self.pictures or 'can be drawn'}",
            f"movies    {self.movies or 'can be made, GIF and MP4'}",
            *(_extra(name, installed) for name, installed in self.extras.items()),
        ]


def _installation() -> _Installation:
    from meshwind.pictures.driver import can_draw
    from meshwind.pictures.movie import encoder

    try:
        movies = "" if encoder() else "none"
    except BadInputError as error:
        movies = str(error)
    return _Installation(
        meshwind=version(),
        python=platform.python_version(),
        libraries={name: _version(name) for name in _LIBRARIES},
        pictures=can_draw(),
        movies=movies,
        extras={name: find_spec(module) is not None for name, (module, _) in _EXTRAS.items()},
    )


def _extra(name: str, installed: bool) -> str:
    if installed:
        return f"{name:<10}installed, for {_EXTRAS[name][1]}"
    return f'{name:<10}not installed; for {_EXTRAS[name][1]}: pip install "meshwind[{name}]"'


def _version(library: str) -> str | None:
    try:
        return metadata.version(library)
    except metadata.PackageNotFoundError:
        return None
