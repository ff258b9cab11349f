"""Files written to a hidden folder appear together in another, even if the process is killed meanwhile.

If the other folder does not exist yet, the hidden one lies beside it and is renamed as a whole.  Otherwise it lies
within, and its name is the state:

    .writing-    files are being written; after a kill they are discarded
    .complete-   all are written; files that they replace are removed next
    .moving-     those are removed; files move in, report.json last, as it marks a folder as complete

Each step can be repeated, so `settle` discards or finishes what a killed process left.  A running process holds a lock
on its hidden folder, which others leave alone.
"""

import json
import os
import shutil
import sys
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from secrets import token_hex

from meshwind.core.errors import BadInputError
from meshwind.results.schema import REPORT

WRITING, COMPLETE, MOVING = ".writing-", ".complete-", ".moving-"
_REPLACED = ".replaced.json"
"""In a complete folder: the names of the files to remove."""
_ATTEMPTS = 3

Replaced = Callable[[list[Path]], Iterable[Path]]
"""Function from the new files to the old ones that they replace; all paths relative to their folder."""


@contextmanager
def staged(out: Path, replaced: Replaced) -> Iterator[Path]:
    """Yield a folder to write into; its files appear in `out` at the end, or vanish on an error.

    Files in subfolders go into those of `out`.  Files of `out` that have no new file's name and are not `replaced`
    stay.  Raises BadInputError if `out` cannot be written.
    """
    made = missing(out)
    hidden, lock = None, -1
    try:
        settle(out)
        hidden, lock = _made(out)
        yield hidden
        if hidden.parent == out:
            _finish(_commit(hidden, out, replaced), out)
        else:
            hidden.rename(out)
    except OSError as error:
        raise unwritable(out, error) from error
    finally:
        if hidden is not None:
            shutil.rmtree(hidden, ignore_errors=True)
        if lock >= 0:
            os.close(lock)
        remove_empty(made)


def settle(out: Path) -> None:
    """Finish what a killed process had completed for `out`, and discard what it had not."""
    for hidden in _left(out):
        lock = _locked(hidden)
        if lock is None:
            continue
        try:
            if hidden.name.startswith((COMPLETE, MOVING)):
                _finish(hidden, out)
            else:
                shutil.rmtree(hidden, ignore_errors=True)
        finally:
            os.close(lock)


def unwritable(out: Path, error: OSError) -> BadInputError:
    """The error for a folder that cannot be written; a file in its place or above it is named."""
    there = next((above for above in (out, *out.parents) if os.path.lexists(above)), out)
    if there.is_file():
        return BadInputError(f"cannot write to {out}: {there} is a file; give another folder")
    return BadInputError(f"cannot write to {out}: {error.strerror or error}; give another folder")


def missing(out: Path) -> list[Path]:
    """Folders that have to be made for `out`, the innermost first."""
    absolute = out.absolute()
    return [folder for folder in (absolute, *absolute.parents) if not os.path.lexists(folder)]


def remove_empty(folders: list[Path]) -> None:
    """Remove those folders that exist and are empty."""
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _made(out: Path) -> tuple[Path, int]:
    """A hidden folder for `out` and the lock on it, -1 where the file system has no locks."""
    if os.path.lexists(out):
        out.mkdir(exist_ok=True)  # fails on a link that leads nowhere
        prefix = out / WRITING
    else:
        prefix = out.parent / f".{out.name}{WRITING}"
        out.parent.mkdir(parents=True, exist_ok=True)
    for attempt in range(1, _ATTEMPTS + 1):
        hidden = prefix.with_name(prefix.name + token_hex(4))
        hidden.mkdir()
        lock = _locked(hidden)
        if lock is not None:
            return hidden, lock
        if attempt < _ATTEMPTS:  # another process that settles may have it: leave it to that
            with suppress(OSError):
                hidden.rmdir()
    return hidden, -1


def _left(out: Path) -> list[Path]:
    """Hidden folders for `out`, within it and beside it."""
    found: list[Path] = []
    for folder, starts in ((out, (WRITING, COMPLETE, MOVING)), (out.absolute().parent, (f".{out.name}{WRITING}",))):
        if out.name and folder.is_dir():
            found += (entry for entry in folder.iterdir() if entry.name.startswith(starts) and entry.is_dir())
    return sorted(found)


def _locked(hidden: Path) -> int | None:
    """An open descriptor that locks the folder as long as this process lives; None if it cannot be locked."""
    if sys.platform == "win32":
        return None
    import fcntl

    lock = -1
    try:
        lock = os.open(hidden, os.O_RDONLY)
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if os.path.samestat(os.fstat(lock), hidden.stat()):
            return lock
    except OSError:
        pass  # held by another process or gone
    if lock >= 0:
        os.close(lock)
    return None


def _commit(hidden: Path, out: Path, replaced: Replaced) -> Path:
    """Mark the folder as complete, after checking that all its files can move in."""
    fresh = _files(hidden)
    for name in fresh:
        if (out / name).is_dir():
            raise BadInputError(f"{out / name} is a folder where a file belongs; move it away")
        if any((out / above).is_file() for above in name.parents):
            raise BadInputError(f"{out / name} cannot be written: something of another kind is there; move it away")
    names = {*fresh, *replaced(fresh)}
    (hidden / _REPLACED).write_text(json.dumps(sorted(map(str, names), key=lambda name: name != REPORT)))
    return hidden.rename(out / hidden.name.replace(WRITING, COMPLETE))


def _finish(hidden: Path, out: Path) -> None:
    """Move a complete folder's files in, from whichever step it had reached."""
    if hidden.name.startswith(COMPLETE):
        for name in json.loads((hidden / _REPLACED).read_text()):
            (out / name).unlink(missing_ok=True)
            if Path(name).parent != Path():
                remove_empty([(out / name).parent])
        hidden = hidden.rename(out / hidden.name.replace(COMPLETE, MOVING))
    for name in sorted(_files(hidden), key=lambda name: name == Path(REPORT)):
        (out / name).parent.mkdir(exist_ok=True)
        os.replace(hidden / name, out / name)
    shutil.rmtree(hidden)


def _files(hidden: Path) -> list[Path]:
    """All files in a hidden folder but its own list, relative to it."""
    files = (path for path in hidden.rglob("*") if path.is_file() and path != hidden / _REPLACED)
    return sorted(path.relative_to(hidden) for path in files)
