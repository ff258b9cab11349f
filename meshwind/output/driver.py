"""winding.png is drawn by a process of its own.

VTK without an OpenGL driver takes its whole process down, and it is slow to import and to draw its first
frame.  A second process is the probe for the one and hides the other behind the solver: start it early.
"""

import atexit
import io
import os
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.layup.layup import Layup
from meshwind.output.scene import scene

NO_DRIVER = (
    "no picture: VTK found no OpenGL driver on this machine; install one "
    "(Debian: apt-get install libegl1 libgl1-mesa-dri)"
)
_PATIENCE = 120.0
"""Seconds after which a picture is given up."""

_waiting: "list[Painter]" = []
"""The renderer that was started and has not drawn yet; there is never more than one."""


class Painter:
    """A process that can draw one picture."""

    def __init__(self) -> None:
        environment = dict(os.environ)
        if sys.platform.startswith("linux"):
            environment.setdefault("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow")
        script = Path(__file__).with_name("renderer.py")
        # -P keeps this folder off the process's import path, where its module names could shadow others.
        self._process = subprocess.Popen(
            [sys.executable, "-P", str(script)],
            env=environment,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )

    def close(self) -> None:
        """End the process if it still runs."""
        if self._process.returncode is None:
            self._process.kill()
            self._process.communicate()

    def paint(self, picture: Path, seen: dict[str, Any]) -> str:
        """Draw a scene into a file; return "" or one line that says why there is no picture."""
        packed = io.BytesIO()
        np.savez(packed, picture=str(picture.absolute()), **seen)
        try:
            said, complaint = self._process.communicate(packed.getvalue(), timeout=_PATIENCE)
        except subprocess.TimeoutExpired:
            self.close()
            return f"no picture: drawing took more than {_PATIENCE:.0f} s"
        if self._process.returncode == 0:
            return ""
        if not said.startswith(b"ready") and (self._process.returncode < 0 or b"OpenGL" in complaint):
            return NO_DRIVER
        last = complaint.decode(errors="replace").strip().splitlines()[-1:]
        return f"no picture: {''.join(last) or 'the renderer stopped'}"


def start_probe() -> None:
    """Start the renderer: it finds out whether this machine can draw while other work runs."""
    if not _waiting:
        _waiting.append(Painter())


def stop() -> None:
    """End a renderer that was started and is not needed."""
    while _waiting:
        _waiting.pop().close()


def draw(picture: Path, layup: Layup, name: str, units: str = "") -> str:
    """Draw the part and its fibres into a .png; return "" or one line that says why there is no picture."""
    start_probe()
    return _waiting.pop().paint(picture, scene(layup, name, units))


atexit.register(stop)
