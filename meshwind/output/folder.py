"""The output folder: files appear in it whole and together, or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwind.errors import BadInputError

RESULTS = frozenset(
    ("paths.vtp", "bridges.vtp", "crossings.vtp", "quads.vtu", "quads.obj", "surface.vtu", "surface.npz")
    + ("chart.png", "report.json", "winding.png", "fit_error.png", "revolutions.png", "sheet.png", "crossings.png")
    + ("coverage.png", "windability.png", "slip.png", "fit.png", "unrolled.png", "quads.png", "redesign.png")
    + ("winding.gif", "winding.mp4", "viewer.html", "edited.ply", "edited.vtu", "before.png", "after.png")
)
"""All that a run, or what is made of it, may leave in its folder."""


def prepare(out: Path) -> None:
    """Make sure that files can be written into `out`, and leave nothing behind.

    Raises BadInputError where a file is in the way or the place cannot be written.
    """
    made = _missing(out)
    try:
        trial = _staging(out)
        trial.rmdir()
    finally:
        _remove_empty(made)


@contextmanager
def writing(out: Path) -> Iterator[Path]:
    """Give a folder to write files into; on leaving they move to `out`, on an error they vanish.

    Files of the same names in `out` are replaced; results of an earlier run that this one does not have are
    removed, as they would belong to another report; all else is left alone.  On an error nothing is left, not
    even `out` itself where it was missing.  Raises BadInputError where `out` cannot be written.
    """
    made = _missing(out)
    staging: Path | None = None
    try:
        staging = _staging(out)
        yield staging
        _move(staging, out)
    except OSError as error:
        raise _unwritable(out, error) from error
    finally:
        if staging is not None:
            shutil.rmtree(staging, ignore_errors=True)
        _remove_empty(made)


def _unwritable(out: Path, error: OSError) -> BadInputError:
    return BadInputError(f"cannot write to {out}: {error.strerror or error}; give another folder")


def _missing(out: Path) -> list[Path]:
    """Folders that have to be made for `out`, the innermost first."""
    absolute = out.absolute()
    return [folder for folder in (absolute, *absolute.parents) if not os.path.lexists(folder)]


def _staging(out: Path) -> Path:
    """Make `out` and a folder within it, so that a move to `out` is a rename on one file system."""
    if out.exists() and not out.is_dir():
        raise BadInputError(f"{out} is a file; give a folder for the results")
    try:
        out.mkdir(parents=True, exist_ok=True)
        return Path(tempfile.mkdtemp(prefix=".writing-", dir=out))
    except OSError as error:
        raise _unwritable(out, error) from error


def _move(staging: Path, out: Path) -> None:
    for file in sorted(staging.iterdir()):
        if (out / file.name).is_dir():
            raise BadInputError(f"{out / file.name} is a folder where a file belongs; move it away")
    fresh = sorted(staging.iterdir())
    for name in RESULTS - {file.name for file in fresh}:
        if (out / name).is_file():
            (out / name).unlink()
    for file in fresh:
        os.replace(file, out / file.name)


def _remove_empty(folders: list[Path]) -> None:
    """Remove those folders that are there and empty; results keep theirs."""
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()
