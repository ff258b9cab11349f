"""Writing into a folder: all files appear together or none, and results are replaced only on demand."""

from collections.abc import Iterator
from contextlib import contextmanager
from os import PathLike, fsencode, fspath
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument
from meshwind.results.schema import (
    EXPORT_FOLDERS,
    EXPORTS,
    OF_SOLVED,
    RESULTS,
    SHELL,
)
from meshwind.results.staging import staged


class _TrialError(Exception):
    """Ends a trial run of `writing` before anything is written."""


def prepare(out: Path, overwrite: bool = False) -> None:
    """Check that files can be written into `out` without leaving any; first finish what a killed run left.

    Raises BadInputError if `out` is a file, cannot be written or, without `overwrite`, holds results.
    """
    try:
        with writing(out, overwrite):
            raise _TrialError
    except _TrialError:
        pass


@contextmanager
def writing(out: Path, overwrite: bool = False) -> Iterator[Path]:
    """Yield a folder for the files of a run; they move to `out` at the end, or vanish on an error.

    With `overwrite`, all results of an earlier run in `out` and their exports are removed, including files that this
    run does not have, as they would belong to another report; other files stay.  After an error nothing is left, not
    even `out` if it did not exist before.  After a killed run, the next one into `out` finishes the move or cleans
    up.  Raises BadInputError if `out` cannot be written or, without `overwrite`, holds results.
    """
    _not_a_file(out)
    with staged(out, lambda _: map(Path, held)) as staging:
        held = _held(out, overwrite)
        yield staging
        held = _held(out, overwrite)


@contextmanager
def beside(out: Path) -> Iterator[Path]:
    """Yield a folder for exports of a run; they move to `out` beside its other files at the end, or vanish on an error.

    Files of the same name in `out` are replaced.  Numbered files (path_007.csv) of an earlier export in a folder of the
    same name are removed, and with a new deck what was solved of an earlier one.  Other files stay.
    Raises BadInputError if `out` cannot be written.
    """
    _not_a_file(out)
    with staged(out, lambda fresh: _outdated(out, fresh)) as staging:
        yield staging


def exports_in(out: Path) -> list[str]:
    """Names of the exported files in a folder and its export folders, relative to it."""
    folders = out, *map(out.joinpath, EXPORT_FOLDERS)
    files = [file for folder in folders if folder.is_dir() for file in folder.iterdir()]
    names = (file.relative_to(out).as_posix() for file in files if file.is_file())
    return sorted(name for name in names if EXPORTS.fullmatch(name))


def named(out: str | PathLike[str]) -> Path:
    """A folder for results by its name; raises BadInputError for one that is not possible."""
    if not isinstance(out, str | PathLike) or not fspath(out).strip():
        raise BadInputError(f"out is {out!r}; give the path of a folder for the results")
    try:
        possible = b"\0" not in fsencode(out)
    except UnicodeEncodeError:
        possible = False
    if not possible:
        raise BadInputError(f"out is {fspath(out)[:40]!r}, which is not a possible name of a folder; give another")
    return Path(out)


def _not_a_file(out: Path) -> None:
    if out.exists() and not out.is_dir():
        raise BadInputError(f"{out} is a file; give a folder for the results")


def _held(out: Path, overwrite: bool) -> list[str]:
    """Names of the results in `out`; raises BadInputError if there are any that must not be replaced."""
    held = sorted(name for name in RESULTS if (out / name).is_file()) + exports_in(out)
    if held and not overwrite:
        what = ", ".join(held[:2]) + ", ..." * (len(held) > 2)
        raise BadInputError(
            f"{out} holds results already ({what}); give another folder, or "
            f"{argument('overwrite', True)} to replace them"
        )
    return held


def _outdated(out: Path, fresh: list[Path]) -> Iterator[Path]:
    """Files of an earlier export: numbered ones of kinds that this one writes into a folder, and those of a deck."""
    if Path(SHELL) in fresh:
        yield from (Path(name) for name in OF_SOLVED if (out / name).is_file())
    for top in {name.parts[0] for name in fresh if len(name.parts) > 1}:
        kinds = {name.name.rsplit("_", 1)[0] for name in fresh if name.parts[0] == top and "_" in name.name}
        for old in (out / top).iterdir() if (out / top).is_dir() else ():
            if old.is_file() and old.name.rsplit("_", 1)[0] in kinds:
                yield Path(top, old.name)
