"""Drawing in a process of its own.

Without an OpenGL driver VTK ends its process, and it is slow to import and to draw its first frame.  A second process
makes the first harmless, and started early it hides the second behind the solver.  Importing this module loads nothing
heavy, so that the process can start before the numerical libraries are there.
"""

import atexit
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping
from contextlib import suppress
from pathlib import Path
from threading import Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from meshwind.pictures.drawings import Drawing

NO_DRIVER = (
    "no picture: VTK found no OpenGL driver on this machine; install one "
    "(Debian: apt-get install libegl1 libgl1-mesa-dri)"
)
_SILENT_SECONDS = 120.0
"""Seconds without output after which the process is ended."""

Drawn = Callable[[str], None]
"""Called with the name of each picture when it is drawn, and with "frame" for each frame of a movie."""

_waiting: "list[Painter]" = []
"""The renderer that was started and has not drawn yet; at most one."""


class Painter:
    """A process that can draw once."""

    def __init__(self) -> None:
        environment = dict(os.environ)
        if sys.platform.startswith("linux"):
            environment.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        script = Path(__file__).with_name("renderer.py")
        # a file, not a pipe: error messages of VTK must not fill a pipe that is not read while it draws
        self._complaint = tempfile.TemporaryFile()  # noqa: SIM115
        # -P keeps this folder off the process's import path, where its module names could shadow others.
        self._process = subprocess.Popen(
            [sys.executable, "-P", str(script)],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaint,
        )

    def close(self) -> None:
        """End the process if it still runs."""
        if self._process.returncode is None:
            self._process.kill()
            self._process.communicate()
        self._complaint.close()

    def paint(self, drawings: "Mapping[Path, Drawing]", drawn: Drawn | None = None) -> str:
        """Draw each into its file; return "" or one line that says which picture is missing and why."""
        from meshwind.pictures.drawings import pack

        names = [picture.name for picture in drawings]
        words, late = self._work(pack(drawings), drawn)
        complaint = self._complained()
        self.close()
        for picture in drawings:
            if picture.name not in words:
                picture.unlink(missing_ok=True)  # a process that was ended may leave an incomplete file
        missing = " and ".join(name for name in names if name not in words)
        if late:
            return f"no {missing}: drawing took more than {_SILENT_SECONDS:.0f} s"
        if self._process.returncode == 0:
            return ""
        if "ready" not in words and (self._process.returncode < 0 or "OpenGL" in complaint):
            return NO_DRIVER
        last = complaint.strip().splitlines()[-1:]
        return f"no {missing or 'picture'}: {''.join(last) or 'the renderer stopped'}"

    def _work(self, packed: bytes, drawn: Drawn | None) -> tuple[list[str], bool]:
        """Send the scenes and wait for the end of the process: its output, and whether it was too slow and killed."""
        process, words, late = self._process, [], False
        stdin, stdout = process.stdin, process.stdout
        assert stdin is not None and stdout is not None
        watch = Timer(_SILENT_SECONDS, process.kill)
        watch.start()
        try:
            for send in (lambda: stdin.write(packed), stdin.close):
                with suppress(BrokenPipeError):  # it has crashed: its output and return code say why
                    send()
            for line in stdout:
                words.append(line.decode(errors="replace").strip())
                watch.cancel()
                watch = Timer(_SILENT_SECONDS, process.kill)
                watch.start()
                if drawn is not None and words[-1] != "ready":
                    drawn(words[-1])
            process.wait()
        finally:
            late = watch.finished.is_set()
            watch.cancel()
            stdout.close()
        return words, late

    def _complained(self) -> str:
        self._complaint.seek(0)
        return self._complaint.read().decode(errors="replace")


def start_probe() -> None:
    """Start the renderer, which tests whether this machine can draw while other work runs."""
    if not _waiting:
        _waiting.append(Painter())


def stop() -> None:
    """End a renderer that was started but is not needed."""
    while _waiting:
        _waiting.pop().close()


def can_draw() -> str:
    """Test whether this machine can draw: return "" or one line that says why it cannot."""
    return paint({})


def paint(drawings: "Mapping[Path, Drawing]", drawn: Drawn | None = None) -> str:
    """Draw into files in one process; return "" or one line that says which picture is missing and why."""
    start_probe()
    return _waiting.pop().paint(drawings, drawn)


atexit.register(stop)
