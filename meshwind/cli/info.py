"""`meshwind info`: what a mesh holds, what a run found, or what this installation can do; nothing is written."""

from pathlib import Path
from typing import Annotated, Any

import typer

from meshwind.cli.arguments import AsJson, Quiet
from meshwind.cli.outcome import tell
from meshwind.core.errors import BadInputError

EXAMPLES = """
    # a mesh: format, size, pieces, rims, fields
    meshwind info part.stl

    # the figures of a run
    meshwind info part-wound

    # versions, and whether this machine can draw
    meshwind info
"""


def info(
    what: Annotated[
        Path | None,
        typer.Argument(metavar="FILE_OR_DIR", help="A mesh, or a folder of `meshwind wind`; without it this program."),
    ] = None,
    as_json: AsJson = False,
    quiet: Quiet = False,
) -> int:
    """Tell what a mesh file holds, what the run that left a folder found, or what this installation can do."""
    if what is None:
        lines, figures = _installation()
    elif what.is_dir():
        lines, figures = _run(what)
    else:
        lines, figures = _mesh(what)
    tell(lines, figures, as_json, quiet)
    return 0


def _installation() -> tuple[list[str], dict[str, Any]]:
    from meshwind.cli.installation import installation, told

    found = installation()
    return told(found), found


def _run(folder: Path) -> tuple[list[str], dict[str, Any]]:
    from meshwind.cli import redesign, summary
    from meshwind.results.reading import read_report

    report = read_report(folder)
    described = redesign.described if "redesign" in report else summary.described
    try:
        run = f"run       {report['command'] or 'wound by the library'} (meshwind {report['meshwind']})"
        return [run, *described(report)], report
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
