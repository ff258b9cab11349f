"""Writers of GIF and MP4."""

import shutil
import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from meshwind.core.errors import BadInputError
from meshwind.pictures.page import Page

_COLOURS = 255
"""Colours of a GIF's palette, which has room for 256."""
_SAMPLED = 7
"""Frames from which the palette is taken."""


def encoder() -> str:
    """Path of FFmpeg, installed or from imageio-ffmpeg; raises BadInputError if there is none."""
    found = shutil.which("ffmpeg")
    if found:
        return found
    if find_spec("imageio_ffmpeg") is None:
        raise BadInputError(
            "mp4 needs FFmpeg, which is not on this machine; install it (Debian: apt-get install ffmpeg; "
            'or: pip install "meshwind[movie]"), or give gif instead'
        )
    from imageio_ffmpeg import get_ffmpeg_exe

    return str(get_ffmpeg_exe())


@contextmanager
def writers(files: list[Path], page: Page, rate: int, ffmpeg: str) -> Iterator[Callable[[Any], None]]:
    """Yield a function that writes a frame to all files; rate: frames per second.

    ffmpeg: path of its executable, for other files than GIF.  Raises OSError if it fails.
    """
    with ExitStack() as stack:
        each = [
            stack.enter_context(_gif(file, rate) if file.suffix == ".gif" else _mp4(file, page, rate, ffmpeg))
            for file in files
        ]

        def write(frame: Any) -> None:
            for one in each:
                one(frame)

        yield write


@contextmanager
def _gif(file: Path, rate: int) -> Iterator[Callable[[Any], None]]:
    held: list[Any] = []
    yield held.append
    # one palette for all frames, so that plain areas do not flicker
    palette = _sampled(held).quantize(_COLOURS, dither=Image.Dither.NONE)
    drawn = [frame.convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE) for frame in held]
    drawn[0].save(file, save_all=True, append_images=drawn[1:], duration=1000 // rate, loop=0, optimize=False)


def _sampled(frames: list[Any]) -> Any:
    """A picture of some of the frames, evenly spaced, in a column: of their colours the last alone may hide some."""
    chosen = [frames[k] for k in sorted({round(k) for k in np.linspace(0, len(frames) - 1, _SAMPLED)})]
    column = Image.new("RGB", (chosen[0].width, sum(frame.height for frame in chosen)))
    for number, frame in enumerate(chosen):
        column.paste(frame.convert("RGB"), (0, number * frame.height))
    return column


@contextmanager
def _mp4(file: Path, page: Page, rate: int, ffmpeg: str) -> Iterator[Callable[[Any], None]]:
    width, height = page.width - page.width % 2, page.height - page.height % 2  # the encoding needs even sizes
    asked = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(rate), "-i", "-"]
    made = ["-pix_fmt", "yuv420p", "-movflags", "+faststart", str(file)]
    process = subprocess.Popen(
        [ffmpeg, "-y", "-loglevel", "error", *asked, *made], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL
    )
    pipe: Any = process.stdin

    def write(frame: Any) -> None:
        pipe.write(np.ascontiguousarray(np.asarray(frame.convert("RGB"))[:height, :width]).tobytes())

    try:
        yield write
    finally:
        pipe.close()
        process.wait()
    if process.returncode:
        raise OSError(f"{ffmpeg} could not write {file.name}")
