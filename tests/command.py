"""The command line within the process of the tests: as from outside, without the second in which Python starts."""

import gc
import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import chdir, contextmanager
from pathlib import Path
from tempfile import TemporaryFile
from typing import IO

from meshwind.cli import main


@contextmanager
def _caught(name: str, number: int) -> Iterator[IO[bytes]]:
    """A file that a standard stream goes to meanwhile, whether Python writes to it or a library in C."""
    before, kept = getattr(sys, name), os.dup(number)
    before.flush()
    with TemporaryFile() as file:
        os.dup2(file.fileno(), number)
        try:
            with open(number, "w", encoding="utf-8", closefd=False) as stream:
                setattr(sys, name, stream)
                yield file
        finally:
            setattr(sys, name, before)
            os.dup2(kept, number)
            os.close(kept)


def _text(file: IO[bytes]) -> str:
    file.seek(0)
    return file.read().decode("utf-8")


def meshwind(*arguments: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Type `meshwind` with arguments in a folder: exit status, standard output and standard error."""
    typed, argv, threshold = ["meshwind", *map(str, arguments)], sys.argv, gc.get_threshold()
    sys.argv = typed
    try:
        with chdir(folder or Path.cwd()), _caught("stdout", 1) as out, _caught("stderr", 2) as err:
            status = _exit_status()
            sys.stdout.flush()
            sys.stderr.flush()
            return subprocess.CompletedProcess(typed, status, _text(out), _text(err))
    finally:
        sys.argv = argv
        gc.unfreeze()
        gc.set_threshold(*threshold)


def _exit_status() -> int:
    try:
        main()
    except SystemExit as ended:
        assert isinstance(ended.code, int)
        return ended.code
    raise AssertionError("the command line has not ended by an exit status")
