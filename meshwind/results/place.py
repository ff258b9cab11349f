"""Exports appear in a folder whole and together beside what is there, or not at all."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.results.staging import staged


@contextmanager
def beside(out: Path) -> Iterator[Path]:
    """Give a folder to write files and folders of files into; on leaving they move to `out`, on an error they vanish.

    Files of the same names in `out` are replaced, and in a folder of the same name numbered files (path_007.csv) of
    an earlier export do not stay.  All else in `out` is left alone.  Raises BadInputError where `out` cannot be
    written.
    """
    if out.exists() and not out.is_dir():
        raise BadInputError(f"{out} is a file; give a folder for the results")
    with staged(out, lambda fresh: _outdated(out, fresh)) as staging:
        yield staging


def _outdated(out: Path, fresh: list[Path]) -> Iterator[Path]:
    """What an earlier export left in folders of the same kinds and this one does not have."""
    for top in {name.parts[0] for name in fresh if len(name.parts) > 1}:
        kinds = {name.name.rsplit("_", 1)[0] for name in fresh if name.parts[0] == top and "_" in name.name}
        for old in (out / top).iterdir() if (out / top).is_dir() else ():
            if old.is_file() and old.name.rsplit("_", 1)[0] in kinds:
                yield Path(top, old.name)
