"""What exports of a run leave beside it: files that tell of that run and must go with it."""

import re
from pathlib import Path

_EXPORTS = re.compile(
    r"shell\.inp|shell_s4r\.inp|fibers\.vtu|fibers\.vtk|surface\.step|frames/(path_\d{3,}|all)\.csv"
    r"|formats/(surface|quads|paths|bridges|crossings)\.(vtu|vtk|xdmf|raw|ply|obj|msh)"
)
FOLDERS = "frames", "formats"
"""Folders that exports make."""


def exports_in(out: Path) -> list[str]:
    """Names of the exported files in a folder, as seen from it; whatever else lies there or below is not among them."""
    files = [file for folder in (out, *map(out.joinpath, FOLDERS)) if folder.is_dir() for file in folder.iterdir()]
    names = (file.relative_to(out).as_posix() for file in files if file.is_file())
    return sorted(name for name in names if _EXPORTS.fullmatch(name))
