"""Exports appear in a folder whole and together beside what is there, or not at all."""

import os
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from meshwind.errors import BadInputError
from meshwind.output.folder import prepare


@contextmanager
def beside(out: Path) -> Iterator[Path]:
    """Give a folder to write files and folders of files into; on leaving they move to `out`, on an error they vanish.

    Files of the same names in `out` are replaced, and in a folder of the same name numbered files (path_007.csv) of
    an earlier export do not stay.  All else in `out` is left alone.  Raises BadInputError where `out` cannot be
    written.
    """
    prepare(out)
    missing = [folder for folder in (out.absolute(), *out.absolute().parents) if not folder.exists()]
    staging: Path | None = None
    try:
        out.mkdir(parents=True, exist_ok=True)
        staging = Path(tempfile.mkdtemp(prefix=".writing-", dir=out))
        yield staging
        _move(staging, out)
    except OSError as error:
        raise BadInputError(f"cannot write to {out}: {error.strerror or error}; give another folder") from error
    finally:
        if staging is not None:
            shutil.rmtree(staging, ignore_errors=True)
        for folder in missing:
            if folder.is_dir() and not any(folder.iterdir()):
                folder.rmdir()


def _move(staging: Path, out: Path) -> None:
    fresh = sorted(path.relative_to(staging) for path in staging.rglob("*") if path.is_file())
    for name in fresh:
        if (out / name).is_dir() or any((out / above).is_file() for above in name.parents):
            raise BadInputError(f"{out / name} cannot be written: something of another kind is there; move it away")
    for top in {name.parts[0] for name in fresh if len(name.parts) > 1}:
        _clear(out / top, {name.name for name in fresh if name.parts[0] == top})
    for name in fresh:
        (out / name).parent.mkdir(exist_ok=True)
        os.replace(staging / name, out / name)


def _clear(folder: Path, fresh: set[str]) -> None:
    """Remove from a folder what an earlier export left of the same kinds and this one does not have."""
    kinds = {name.rsplit("_", 1)[0] for name in fresh if "_" in name}
    for old in folder.iterdir() if folder.is_dir() else ():
        if old.is_file() and old.name not in fresh and old.name.rsplit("_", 1)[0] in kinds:
            old.unlink()
