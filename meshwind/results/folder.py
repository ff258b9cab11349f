"""A run's folder: files appear in it whole and together, or not at all, and results are replaced only on demand."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.results.schema import EXPORT_FOLDERS, EXPORTS, RESULTS
from meshwind.results.staging import staged


class _TrialError(Exception):
    """Ends a trial before anything has been written."""


def prepare(out: Path, overwrite: bool = False) -> None:
    """Make sure that files can be written into `out`, and leave nothing behind; first finish what a killed run left.

    Raises BadInputError where a file is in the way, where the folder cannot be written or where, without `overwrite`,
    it holds results.
    """
    try:
        with writing(out, overwrite):
            raise _TrialError
    except _TrialError:
        pass


@contextmanager
def writing(out: Path, overwrite: bool = False) -> Iterator[Path]:
    """Give a folder to write a run's files into; on leaving they move to `out`, on an error they vanish.

    With `overwrite` all results of an earlier run in `out` and exports of them are removed, also those that this one
    does not have, as they would belong to another report; all else is left alone.  On an error nothing is left, not
    even `out` itself where it was missing, and killed on the way the next run into `out` finishes the move or clears
    away.  Raises BadInputError where `out` cannot be written or, without `overwrite`, holds results.
    """
    _not_a_file(out)
    with staged(out, lambda _: map(Path, held)) as staging:
        held = _held(out, overwrite)
        yield staging
        held = _held(out, overwrite)


@contextmanager
def beside(out: Path) -> Iterator[Path]:
    """Give a folder for exports of a run; on leaving they move to `out` beside what is there, on an error they vanish.

    Files of the same names in `out` are replaced, and in a folder of the same name numbered files (path_007.csv) of
    an earlier export do not stay.  All else in `out` is left alone.  Raises BadInputError where `out` cannot be
    written.
    """
    _not_a_file(out)
    with staged(out, lambda fresh: _outdated(out, fresh)) as staging:
        yield staging


def exports_in(out: Path) -> list[str]:
    """Names of the exported files in a folder, relative to it; other files there and below are not among them."""
    folders = out, *map(out.joinpath, EXPORT_FOLDERS)
    files = [file for folder in folders if folder.is_dir() for file in folder.iterdir()]
    names = (file.relative_to(out).as_posix() for file in files if file.is_file())
    return sorted(name for name in names if EXPORTS.fullmatch(name))


def _not_a_file(out: Path) -> None:
    if out.exists() and not out.is_dir():
        raise BadInputError(f"{out} is a file; give a folder for the results")


def _held(out: Path, overwrite: bool) -> list[str]:
    """Names of the results in `out`; raises BadInputError where there are some that must not be replaced."""
    held = sorted(name for name in RESULTS if (out / name).is_file()) + exports_in(out)
    if held and not overwrite:
        what = ", ".join(held[:2]) + ", ..." * (len(held) > 2)
        raise BadInputError(
            f"{out} holds results already ({what}); give another folder, or --overwrite to replace them"
        )
    return held


def _outdated(out: Path, fresh: list[Path]) -> Iterator[Path]:
    """What an earlier export left in folders of the same kinds and this one does not have."""
    for top in {name.parts[0] for name in fresh if len(name.parts) > 1}:
        kinds = {name.name.rsplit("_", 1)[0] for name in fresh if name.parts[0] == top and "_" in name.name}
        for old in (out / top).iterdir() if (out / top).is_dir() else ():
            if old.is_file() and old.name.rsplit("_", 1)[0] in kinds:
                yield Path(top, old.name)
