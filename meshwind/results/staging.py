"""Files made in a hidden folder appear together in another, even where the process is killed on the way.

Where that other folder is not there yet, the hidden one lies beside it and is renamed as a whole.  Otherwise it lies
within, and its name says how far it has come:

    .writing-    files are being written; what a killed process left is rubbish
    .complete-   all are written: what they stand in for has to go
    .moving-     that has gone: they move in, report.json as the last: with it a folder is whole

Each step can be taken again, so `settle` clears away or finishes what a killed process left.  As long as a process
lives it holds a lock on its folder, and others leave that alone.
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
"""In a complete folder: the names of the files that go."""
_ATTEMPTS = 3

Replaced = Callable[[list[Path]], Iterable[Path]]
"""From the new files, the old ones that go as those come; all paths relative to their folder."""


@contextmanager
def staged(out: Path, replaced: Replaced) -> Iterator[Path]:
    """Give a folder to write into; on leaving its files appear in `out`, on an error they vanish.

    Files in folders within it go into those of `out`.  What is in `out` and neither of a new file's name nor
    `replaced` stays.  Raises BadInputError where `out` cannot be written.
    """
    made = missing(out)
    place, lock = None, -1
    try:
        settle(out)
        place, lock = _made(out)
        yield place
        if place.parent == out:
            _finish(_commit(place, out, replaced), out)
        else:
            place.rename(out)
    except OSError as error:
        raise unwritable(out, error) from error
    finally:
        if place is not None:
            shutil.rmtree(place, ignore_errors=True)
        if lock >= 0:
            os.close(lock)
        remove_empty(made)


def settle(out: Path) -> None:
    """Finish what a killed process had completed for `out`, and clear away what it had not."""
    for place in _left(out):
        lock = _locked(place)
        if lock is None:
            continue
        try:
            if place.name.startswith((COMPLETE, MOVING)):
                _finish(place, out)
            else:
                shutil.rmtree(place, ignore_errors=True)
        finally:
            os.close(lock)


def unwritable(out: Path, error: OSError) -> BadInputError:
    """What to tell of a folder that takes no files."""
    return BadInputError(f"cannot write to {out}: {error.strerror or error}; give another folder")


def missing(out: Path) -> list[Path]:
    """Folders that have to be made for `out`, the innermost first."""
    absolute = out.absolute()
    return [folder for folder in (absolute, *absolute.parents) if not os.path.lexists(folder)]


def remove_empty(folders: list[Path]) -> None:
    """Remove those folders that are there and empty; results keep theirs."""
    for folder in folders:
        if folder.is_dir() and not any(folder.iterdir()):
            folder.rmdir()


def _made(out: Path) -> tuple[Path, int]:
    """A hidden folder for `out` and the lock on it, -1 where the file system has no locks."""
    if os.path.lexists(out):
        out.mkdir(exist_ok=True)  # tells of a link that leads nowhere
        prefix = out / WRITING
    else:
        prefix = out.parent / f".{out.name}{WRITING}"
        out.parent.mkdir(parents=True, exist_ok=True)
    for attempt in range(1, _ATTEMPTS + 1):
        place = prefix.with_name(prefix.name + token_hex(4))
        place.mkdir()
        lock = _locked(place)
        if lock is not None:
            return place, lock
        if attempt < _ATTEMPTS:  # another process that settles may have it: leave it to that
            with suppress(OSError):
                place.rmdir()
    return place, -1


def _left(out: Path) -> list[Path]:
    """Hidden folders for `out`, within it and beside it."""
    found: list[Path] = []
    for folder, starts in ((out, (WRITING, COMPLETE, MOVING)), (out.absolute().parent, (f".{out.name}{WRITING}",))):
        if out.name and folder.is_dir():
            found += (entry for entry in folder.iterdir() if entry.name.startswith(starts) and entry.is_dir())
    return sorted(found)


def _locked(place: Path) -> int | None:
    """An open descriptor that holds the folder as long as this process lives; None where it cannot be held."""
    if sys.platform == "win32":
        return None
    import fcntl

    lock = -1
    try:
        lock = os.open(place, os.O_RDONLY)
        fcntl.flock(lock, fcntl.LOCK_EX | fcntl.LOCK_NB)
        if os.path.samestat(os.fstat(lock), place.stat()):
            return lock
    except OSError:
        pass  # held by another process or gone
    if lock >= 0:
        os.close(lock)
    return None


def _commit(place: Path, out: Path, replaced: Replaced) -> Path:
    """Mark the folder as complete, once all its files can move in."""
    fresh = _files(place)
    for name in fresh:
        if (out / name).is_dir():
            raise BadInputError(f"{out / name} is a folder where a file belongs; move it away")
        if any((out / above).is_file() for above in name.parents):
            raise BadInputError(f"{out / name} cannot be written: something of another kind is there; move it away")
    names = {*fresh, *replaced(fresh)}
    (place / _REPLACED).write_text(json.dumps(sorted(map(str, names), key=lambda name: name != REPORT)))
    return place.rename(out / place.name.replace(WRITING, COMPLETE))


def _finish(place: Path, out: Path) -> None:
    """Move a complete folder's files in, from wherever that stopped."""
    if place.name.startswith(COMPLETE):
        for name in json.loads((place / _REPLACED).read_text()):
            (out / name).unlink(missing_ok=True)
            if Path(name).parent != Path():
                remove_empty([(out / name).parent])
        place = place.rename(out / place.name.replace(COMPLETE, MOVING))
    for name in sorted(_files(place), key=lambda name: name == Path(REPORT)):
        (out / name).parent.mkdir(exist_ok=True)
        os.replace(place / name, out / name)
    shutil.rmtree(place)


def _files(place: Path) -> list[Path]:
    return sorted(path.relative_to(place) for path in place.rglob("*") if path.is_file() and path != place / _REPLACED)
