"""Draws scenes in a process of its own: `python -P renderer.py`, sent blocks by `painter.py`.

Prints "ready" after a test that the machine can draw, then the name of each picture that it has saved, "frame" for
each frame of a movie, and "done" at the end of a batch; it ends with its input.  It loads only those parts of meshwind
that draw.
"""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pyvista as pv  # noqa: F401  (before the next line, so that nothing beside meshwind can shadow it)

sys.path.insert(0, str(Path(__file__).parents[2]))
from meshwind.pictures import (
    animation_picture,
    camera,
    crossings_picture,
    drawings,
    filament_picture,
    fit_picture,
    hits_picture,
    laminate_picture,
    layers_picture,
    machine_picture,
    map_picture,
    painter,
    quads_picture,
    redesign_picture,
    reel_picture,
    scenes,
    slip_picture,
    winding_picture,
)

DRAWN_BY: dict[type, Callable[..., Any]] = {
    scenes.WindingScene: winding_picture.draw,
    scenes.FitScene: fit_picture.draw,
    scenes.LayersScene: layers_picture.draw,
    scenes.MapScene: map_picture.draw,
    scenes.SlipScene: slip_picture.draw,
    scenes.CrossingsScene: crossings_picture.draw,
    scenes.QuadsScene: quads_picture.draw,
    scenes.RedesignScene: redesign_picture.draw,
    scenes.FilamentScene: filament_picture.draw,
    scenes.LaminateScene: laminate_picture.draw,
    scenes.HitsScene: hits_picture.draw,
}
MOVED_BY: dict[type, Callable[..., Any]] = {
    scenes.AnimationScene: animation_picture.frames,
    scenes.ReelScene: reel_picture.frames,
    scenes.MachineScene: machine_picture.frames,
}
FRAME = "frame"


def main() -> None:
    """Test that the machine can draw, read scenes, draw them."""
    window = camera.plotter()
    say(painter.READY)
    for packed in blocks():
        if not packed:
            say(painter.DONE)
            continue
        file, drawing = drawings.unpack(packed)
        window.clear_actors()
        if isinstance(drawing.scene, scenes.AnimationScene | scenes.ReelScene | scenes.MachineScene):
            frames = MOVED_BY[type(drawing.scene)](window, drawing.scene, drawing.page)
            animation_picture.draw(frames, drawing.scene.motion, drawing.page, lambda: say(FRAME))
        else:
            image = DRAWN_BY[type(drawing.scene)](window, drawing.scene, drawing.page)
            drawings.save(image, file)
        say(file.name)
    window.close()


def blocks() -> Iterator[bytes]:
    """The blocks that are sent, each after the number of its bytes."""
    while len(size := sys.stdin.buffer.read(8)) == 8:
        yield sys.stdin.buffer.read(int.from_bytes(size, "little"))


def say(word: str) -> None:
    """Print a word for the process that waits."""
    sys.stdout.write(f"{word}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
