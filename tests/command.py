"""The command line within the process of the tests: as from outside, without the second in which Python starts."""

import gc
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from meshwind.cli import main


class _Caught:
    """A standard stream that goes to a file meanwhile, whether Python writes to it or a library in C."""

    def __init__(self, name: str, number: int) -> None:
        self.name, self.number, self.before = name, number, getattr(sys, name)
        self.before.flush()
        self.kept = os.dup(number)
        self.file = tempfile.TemporaryFile()
        os.dup2(self.file.fileno(), number)
        setattr(sys, name, open(number, "w", encoding="utf-8", closefd=False))

    def text(self) -> str:
        """Put the stream back, and tell what was written."""
        getattr(sys, self.name).close()
        setattr(sys, self.name, self.before)
        os.dup2(self.kept, self.number)
        os.close(self.kept)
        self.file.seek(0)
        with self.file:
            return self.file.read().decode("utf-8")


def meshwind(*arguments: str | Path, folder: Path | None = None) -> subprocess.CompletedProcess[str]:
    """Type `meshwind` with arguments in a folder: exit status, standard output and standard error."""
    here, argv, collected = Path.cwd(), sys.argv, gc.get_threshold()
    sys.argv = ["meshwind", *map(str, arguments)]
    os.chdir(folder or here)
    out, err = _Caught("stdout", 1), _Caught("stderr", 2)
    try:
        main()
        status: object = 0
    except SystemExit as ended:
        status = ended.code or 0
    finally:
        printed = out.text(), err.text()
        os.chdir(here)
        sys.argv = argv
        gc.unfreeze()
        gc.set_threshold(*collected)
    assert isinstance(status, int)
    return subprocess.CompletedProcess(["meshwind", *map(str, arguments)], status, *printed)
