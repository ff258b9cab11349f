"""Frames to GIF and MP4."""

import subprocess
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image

from meshwind.pictures.page import Page

_COLOURS = 255


@contextmanager
def writers(files: list[Path], page: Page, rate: int, encoder: str) -> Iterator[Callable[[Any], None]]:
    """A function that takes one frame after the other and writes it to all files, at so many a second.

    encoder: FFmpeg's executable, for what is no GIF.  Raises OSError where it fails.
    """
    with ExitStack() as stack:
        each = [
            stack.enter_context(_gif(file, rate) if file.suffix == ".gif" else _mp4(file, page, rate, encoder))
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
    # one palette for all frames, or plain areas would flicker: that of the last, which has every colour
    palette = held[-1].convert("RGB").quantize(_COLOURS, dither=Image.Dither.NONE)
    drawn = [frame.convert("RGB").quantize(palette=palette, dither=Image.Dither.NONE) for frame in held]
    drawn[0].save(file, save_all=True, append_images=drawn[1:], duration=1000 // rate, loop=0, optimize=False)


@contextmanager
def _mp4(file: Path, page: Page, rate: int, encoder: str) -> Iterator[Callable[[Any], None]]:
    width, height = page.width - page.width % 2, page.height - page.height % 2  # the coding takes even sizes only
    asked = ["-f", "rawvideo", "-pix_fmt", "rgb24", "-s", f"{width}x{height}", "-r", str(rate), "-i", "-"]
    made = ["-pix_fmt", "yuv420p", "-movflags", "+faststart", str(file)]
    process = subprocess.Popen(
        [encoder, "-y", "-loglevel", "error", *asked, *made], stdin=subprocess.PIPE, stdout=subprocess.DEVNULL
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
        raise OSError(f"{encoder} could not write {file.name}")
