"""Drawing in a process of its own.

Without an OpenGL driver VTK ends its process, and it is slow to import and to draw its first frame.  A second process
makes the first harmless, and started early it hides the second behind the solver.  It draws what it is sent while this
process goes on, and is kept for the pictures of later runs.  Importing this module loads nothing heavy, so that it can
start before the numerical libraries are there.
"""

import atexit
import os
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from queue import SimpleQueue
from threading import Thread, Timer
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

READY, DONE = "ready", "done"
"""What the renderer says when it has found that it can draw, and when it has drawn all that it was sent."""

_idle: "list[Painter]" = []
"""The renderer that has nothing to draw; at most one, but for a moment."""


class Painter:
    """A process that draws: it is sent pictures, in any number of batches."""

    def __init__(self) -> None:
        environment = dict(os.environ)
        if sys.platform.startswith("linux"):
            environment.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        script = Path(__file__).with_name("renderer.py")
        # a file, not a pipe: error messages of VTK must not fill a pipe that is not read while it draws
        self._complaint = tempfile.TemporaryFile()  # noqa: SIM115
        # -P keeps this folder off the process's import path, where its module names could shadow others.
        self.process = subprocess.Popen(
            [sys.executable, "-P", str(script)],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._complaint,
        )
        self._sent: list[Path] = []
        self._flat: list[tuple[Path, Drawing]] = []
        self._blocks: SimpleQueue[bytes | None] = SimpleQueue()
        self._ready = False
        # a thread, as scenes fill the pipe while the process draws the one before
        self._feeder = Thread(target=self._feed, daemon=True)
        self._feeder.start()

    @property
    def spent(self) -> bool:
        """Whether the process has drawn and ended; of one that has ended before it is to be told why."""
        return self._ready and self.process.poll() is not None

    def close(self) -> None:
        """End the process if it still runs."""
        if self.process.returncode is None:
            self.process.kill()
            self.process.wait()
        self._blocks.put(None)
        self._feeder.join()
        assert self.process.stdout is not None
        self.process.stdout.close()
        self._complaint.close()

    def send(self, picture: Path, drawing: "Drawing") -> None:
        """Have a drawing drawn into its file, after those that were sent before."""
        from meshwind.pictures.drawings import pack
        from meshwind.pictures.scenes import FlatScene

        self._sent.append(picture)
        if isinstance(drawing.scene, FlatScene):
            self._flat.append((picture, drawing))
        else:
            self._put(pack(picture, drawing))

    def finish(self, drawn: Drawn | None = None) -> str:
        """Wait for all that was sent; return "" or one line that says which picture is missing and why.

        A process that can go on is kept, and any other one is ended.
        """
        self._put(b"")
        pictures, self._sent = self._sent, []
        words, late = self._work(drawn)
        if words[-1:] == [DONE]:
            _keep(self)
            return ""
        self.process.wait()
        self._complaint.seek(0)
        complaint = self._complaint.read().decode(errors="replace")
        self.close()
        for picture in pictures:
            if picture.name not in words:
                picture.unlink(missing_ok=True)  # a process that was ended may leave an incomplete file
        missing = " and ".join(picture.name for picture in pictures if picture.name not in words)
        if late:
            return f"no {missing}: drawing took more than {_SILENT_SECONDS:.0f} s"
        if not self._ready and (self.process.returncode < 0 or "OpenGL" in complaint):
            return NO_DRIVER
        last = complaint.strip().splitlines()[-1:]
        return f"no {missing or 'picture'}: {''.join(last) or 'the renderer stopped'}"

    def _put(self, packed: bytes) -> None:
        """Send bytes, after their number; none end a batch."""
        self._blocks.put(len(packed).to_bytes(8, "little") + packed)

    def _feed(self) -> None:
        """In a thread: write what is sent to the process."""
        stdin = self.process.stdin
        assert stdin is not None
        while (block := self._blocks.get()) is not None:
            with suppress(OSError):  # it has crashed: its output and return code say why
                stdin.write(block)
                stdin.flush()
        with suppress(OSError):
            stdin.close()

    def _draw_flat(self, words: list[str], drawn: Drawn | None) -> None:
        """Draw in this process, once the other is at work, what it is not needed for; add what it would say to words.

        It would take as long to load what draws these as to draw all of a usual part.
        """
        flat, self._flat = self._flat, []
        if not flat:
            return
        from meshwind.pictures.flat import draw

        for picture, drawing in flat:
            draw(picture, drawing)
            words.append(picture.name)
            if drawn is not None:
                drawn(picture.name)

    def _work(self, drawn: Drawn | None) -> tuple[list[str], bool]:
        """Wait for the end of a batch or of the process: its output, and whether it was too slow and killed."""
        process, words = self.process, list[str]()
        if self._ready:
            self._draw_flat(words, drawn)
        stdout = process.stdout
        assert stdout is not None
        watch = Timer(_SILENT_SECONDS, process.kill)
        watch.start()
        try:
            for line in stdout:
                word = line.decode(errors="replace").strip()
                words.append(word)
                self._ready |= word == READY
                watch.cancel()
                if word == DONE:
                    break
                if word == READY:
                    self._draw_flat(words, drawn)
                watch = Timer(_SILENT_SECONDS, process.kill)
                watch.start()
                if drawn is not None and word != READY:
                    drawn(word)
        finally:
            late = watch.finished.is_set() and words[-1:] != [DONE]
            watch.cancel()
        return words, late


def start_probe() -> None:
    """Start the renderer, which tests whether this machine can draw while other work runs."""
    if not _idle:
        _keep(Painter())


def stop() -> None:
    """End a renderer that is not needed."""
    while _idle:
        _idle.pop().close()


def can_draw() -> str:
    """Test whether this machine can draw: return "" or one line that says why it cannot."""
    return paint({})


def paint(drawings: "Mapping[Path, Drawing]", drawn: Drawn | None = None) -> str:
    """Draw into files in one process; return "" or one line that says which picture is missing and why."""
    with painter() as one:
        for picture, drawing in drawings.items():
            one.send(picture, drawing)
        return one.finish(drawn)


@contextmanager
def painter() -> Iterator[Painter]:
    """A renderer for one batch: the one that waits, or a new one; it is ended where an error leaves it at work."""
    one = _taken()
    with ExitStack() as on_error:
        on_error.callback(one.close)
        yield one
        on_error.pop_all()


def _taken() -> Painter:
    with suppress(IndexError):  # none is idle, or another thread has taken it
        if not (one := _idle.pop()).spent:
            return one
        one.close()
    return Painter()


def _keep(one: Painter) -> None:
    """Keep a renderer for what is drawn next, unless another one waits already."""
    if _idle:
        one.close()
    else:
        _idle.append(one)


atexit.register(stop)
