"""Pictures are drawn by a process of their own.

VTK without an OpenGL driver takes its whole process down, and it is slow to import and to draw its first
frame.  A second process is the probe for the one and hides the other behind the solver: start it early.
"""

import atexit
import io
import os
import subprocess
import sys
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.layup.layup import Layup
from meshwind.mandrel.annulus import Annulus
from meshwind.output.fit_scene import fit_scene
from meshwind.output.scene import scene
from meshwind.surface.surface import Surface

NO_DRIVER = (
    "no picture: VTK found no OpenGL driver on this machine; install one "
    "(Debian: apt-get install libegl1 libgl1-mesa-dri)"
)
_PATIENCE = 120.0
"""Seconds after which a picture is given up."""

_waiting: "list[Painter]" = []
"""The renderer that was started and has not drawn yet; there is never more than one."""


class Painter:
    """A process that can draw, once."""

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

    def paint(self, scenes: Mapping[Path, dict[str, Any]]) -> str:
        """Draw a scene into each file; return "" or one line that says which picture there is not, and why."""
        packed = io.BytesIO()
        arrays: dict[str, Any] = {}
        for number, (picture, seen) in enumerate(scenes.items()):
            told = seen | {"picture": str(picture.absolute())}
            arrays |= {f"{number}/{key}": value for key, value in told.items()}
        np.savez(packed, **arrays)
        names = [picture.name for picture in scenes]
        try:
            said, complaint = self._process.communicate(packed.getvalue(), timeout=_PATIENCE)
        except subprocess.TimeoutExpired:
            self.close()
            return f"no {' and '.join(names)}: drawing took more than {_PATIENCE:.0f} s"
        if self._process.returncode == 0:
            return ""
        words = said.decode(errors="replace").split("\n")
        if "ready" not in words and (self._process.returncode < 0 or b"OpenGL" in complaint):
            return NO_DRIVER
        last = complaint.decode(errors="replace").strip().splitlines()[-1:]
        missing = " and ".join(name for name in names if name not in words)
        return f"no {missing or 'picture'}: {''.join(last) or 'the renderer stopped'}"


def start_probe() -> None:
    """Start the renderer: it finds out whether this machine can draw while other work runs."""
    if not _waiting:
        _waiting.append(Painter())


def stop() -> None:
    """End a renderer that was started and is not needed."""
    while _waiting:
        _waiting.pop().close()


def draw(
    picture: str | PathLike[str], layup: Layup, name: str, units: str = "", revolutions: float | None = None
) -> str:
    """Draw the part and its fibres into a .png; return "" or one line that says why there is no picture.

    revolutions: what was asked for, for the title.
    """
    return paint({Path(picture): scene(layup, name, units, revolutions)})


def draw_fit(picture: str | PathLike[str], surface: Surface, annulus: Annulus, name: str = "", units: str = "") -> str:
    """Draw how far a surface and the mesh it was fitted to lie apart into a .png: both, and the worst place from near.

    Returns "" or one line that says why there is no picture; name: for the title, by default the mesh's.
    """
    return paint({Path(picture): fit_scene(surface, annulus, name or annulus.mesh.name, units)})


def paint(scenes: Mapping[Path, dict[str, Any]]) -> str:
    """Draw scenes into .png files by one process; return "" or one line that says what is not there, and why."""
    start_probe()
    return _waiting.pop().paint(scenes)


atexit.register(stop)
