"""Draws scenes in a process of its own: `python -P renderer.py < scenes.npz`.

Says "ready" once the machine has proved that it can draw, then the name of each picture that it has saved, and "frame"
for each frame of a movie; without input it ends quietly.  Of meshwind it loads nothing but what draws.
"""

import io
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv  # noqa: F401  (before the next line, so that nothing beside meshwind can shadow it)

sys.path.insert(0, str(Path(__file__).parents[2]))
from meshwind.pictures import (
    animation,
    canvas,
    crossings_picture,
    fit_picture,
    map_picture,
    quads_picture,
    redesign_picture,
    slip_picture,
    unrolled,
    winding_picture,
)

DRAWN_BY = {
    "winding": winding_picture.draw,
    "fit": fit_picture.draw,
    "map": map_picture.draw,
    "slip": slip_picture.draw,
    "crossings": crossings_picture.draw,
    "quads": quads_picture.draw,
    "unrolled": unrolled.draw,
    "redesign": redesign_picture.draw,
}
FRAME = "frame"


def main() -> None:
    """Prove that the machine draws, read scenes, draw them."""
    window = canvas.plotter()
    say("ready")
    for scene in scenes(sys.stdin.buffer.read()):
        window.clear_actors()
        if str(scene["kind"]) == "animation":
            animation.draw(window, scene, lambda: say(FRAME))
        else:
            image = DRAWN_BY[str(scene["kind"])](window, scene)
            image.save(str(scene["picture"]), compress_level=1)
        say(Path(str(scene["picture"])).name)
    window.close()


def scenes(packed: bytes) -> list[dict[str, Any]]:
    """The scenes of an .npz whose arrays are named 0/title, 0/points, ..., 1/title, ..."""
    found: dict[str, dict[str, Any]] = {}
    if packed:
        with np.load(io.BytesIO(packed)) as arrays:
            for name, array in arrays.items():
                number, key = name.split("/")
                found.setdefault(number, {})[key] = array
    return list(found.values())


def say(word: str) -> None:
    """Tell the process that waits."""
    sys.stdout.write(f"{word}\n")
    sys.stdout.flush()


if __name__ == "__main__":
    main()
