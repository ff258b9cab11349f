"""winding.gif and winding.mp4 of a filament: its band is laid in the order of winding while the part turns."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.strips import WORDS, Ribbons
from meshwind.core.cast import Floats
from meshwind.filament.kinds import Kind
from meshwind.pictures import animation_picture, camera, canvas, filament_picture
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import ReelScene

_FREE = 0.16
"""Length of the free fibre that is drawn ahead of the band, over the largest extent of the picture."""
_THICK = 1.6
"""Half the width of the free fibre, in pixels of the designed page."""


def frames(window: Any, scene: ReelScene, page: Page) -> Iterator[Any]:
    """The frames in sequence; the last one shows the finished winding."""
    filament, last = scene.filament, scene.motion.frames - 1
    frame = filament.frame
    filament_picture.add_stand(window, filament)
    whole = filament.ribbons
    added = filament_picture.add_bands(window, filament, page)
    free = window.add_mesh(pv.Line(), color=canvas.INK, line_width=2.0 * _THICK * page.unit, render=False)
    for k, (done, view) in enumerate(animation_picture.steps(scene.motion, frame.view)):
        laid = whole if k == last else whole.until(done)
        for actor, mesh in zip(added, filament_picture.bands(filament, laid, view, page), strict=True):
            actor.mapper.dataset = mesh
        free.mapper.dataset = pv.Line(*_free(laid, _FREE * max(frame.view.width, frame.view.height)))
        free.visibility = 0 < k < last
        image = camera.portrait(window, page, view, filament.part.points)
        seen = replace(filament, frame=replace(frame, view=view))
        image = filament_picture.lettered(image, seen, page)
        canvas.note(canvas.pen(image), page, said(laid), below=len(filament_picture.rows(filament)))
        yield animation_picture.counted(image, page, done, scene.motion.total, frame.units)


def _free(laid: Ribbons, reach: float) -> tuple[Floats, Floats]:
    """Both ends of the fibre that comes to the point where it is laid, straight on from the band."""
    middle = laid.points[:, laid.points.shape[1] // 2]
    step = middle[-1] - middle[-2]
    return middle[-1], middle[-1] + reach * step / max(float(np.linalg.norm(step)), 1e-300)


def said(laid: Ribbons) -> list[str]:
    """What the fibre does where it is being laid."""
    where = [f"layer {laid.layer[-1] + 1}"] if laid.layer.max() > 0 else []
    return [
        f"circuit {laid.circuit[-1] + 1}, pass {'back' if laid.passed[-1] % 2 else 'out'}",
        ", ".join([*where, f"{laid.angle[-1]:.1f}°"]),
        WORDS[Kind(int(laid.kind[-1]))],
    ]
