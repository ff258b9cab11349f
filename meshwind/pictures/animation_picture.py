"""winding.gif and winding.mp4: fibre is laid down along its path while the part turns."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.view import View
from meshwind.core.cast import Floats
from meshwind.pictures import bodies, camera, canvas, movie, winding_picture
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import AnimationScene, Motion

_HOLD = 1.5
"""Seconds for which the finished winding is shown."""


def draw(shown: Iterator[Any], motion: Motion, page: Page, drawn: Callable[[], None]) -> None:
    """Draw all frames that are shown into the movies; `drawn` is called after each."""
    files = [Path(name) for name in motion.movies]
    with movie.writers(files, page, motion.frames_per_second, motion.encoder) as write:
        for frame in shown:
            write(frame)
            drawn()
        for _ in range(round(_HOLD * motion.frames_per_second)):
            write(frame)


def frames(window: Any, scene: AnimationScene, page: Page) -> Iterator[Any]:
    """The frames in sequence; the last one shows the finished winding."""
    winding = scene.winding
    frame, part = winding.frame, winding.part
    scale = canvas.fitting(page, frame.view)
    thick = bodies.stroke(part, scale, page.unit).radius
    bodies.add_part(window, part)
    grown = [*_fibres(window, scene, thick), *_bridges(window, scene, thick)]
    head = window.add_mesh(pv.Sphere(radius=2.2 * thick), color=canvas.INK, render=False)
    for k, (done, view) in enumerate(steps(scene.motion, frame.view)):
        for actor, whole in grown:
            clipped = k < scene.motion.frames - 1
            actor.mapper.dataset = whole.clip_scalar(scalars="laid", value=done) if clipped else whole
        head.position = _head(scene, done, thick)
        head.visibility = 0 < k < scene.motion.frames - 1
        image = camera.portrait(window, page, view, part.points)
        seen = replace(winding, frame=replace(frame, view=view))
        yield counted(winding_picture.lettered(image, seen, page), page, done, scene.motion.total, frame.units)


def steps(motion: Motion, view: View) -> Iterator[tuple[float, View]]:
    """The length of fibre that is laid at each frame, and the view of the part, which turns."""
    for k in range(motion.frames):
        share = k / (motion.frames - 1)
        yield share * motion.total, _turned(view, motion.spin, -2.0 * np.pi * motion.turns * share)


def _fibres(window: Any, scene: AnimationScene, thick: float) -> Iterator[tuple[Any, Any]]:
    fibres = scene.winding.fibres
    points, converged = bodies.lifted(fibres, thick), fibres.converged
    kinds = [(colour, (fibres.family == name) & converged, 1.0) for name, colour in canvas.FAMILY.items()]
    for colour, mine, share in [*kinds, (canvas.LOOSE, ~converged, 0.6)]:
        if mine.any():
            lines = bodies.polylines(points[mine].reshape(-1, 3), np.full(mine.sum(), points.shape[1]))
            lines.point_data["laid"] = scene.laid[mine].ravel()
            tubes = lines.tube(radius=share * thick, n_sides=8)
            look = {"color": colour, "ambient": 0.4, "diffuse": 0.7, "show_scalar_bar": False, "scalars": None}
            yield window.add_mesh(tubes, render=False, **look), tubes


def _bridges(window: Any, scene: AnimationScene, thick: float) -> Iterator[tuple[Any, Any]]:
    bridges = scene.winding.bridges
    if not len(bridges.points):
        return
    lines = bodies.polylines(bridges.points + thick * bridges.lift, bridges.sizes)
    lines.point_data["gap"] = bridges.gap
    lines.point_data["laid"] = scene.bridge_laid
    tubes = lines.tube(radius=1.4 * thick, n_sides=10)
    look = bodies.coloured("gap", winding_picture.GAPS, scene.winding.max_gap)
    yield window.add_mesh(tubes, render=False, ambient=0.4, diffuse=0.65, **look), tubes


def _head(scene: AnimationScene, done: float, thick: float) -> Floats:
    """Position of the point where fibre is being laid."""
    laid = scene.laid
    path = int(np.flatnonzero(laid[:, 0] <= done)[np.argmax(laid[laid[:, 0] <= done, 0])])
    k = int(np.clip(np.searchsorted(laid[path], done), 1, laid.shape[1] - 1))
    before, after = laid[path, k - 1], laid[path, k]
    share = float(np.clip((done - before) / max(after - before, 1e-300), 0.0, 1.0))
    line = bodies.lifted(scene.winding.fibres, thick)[path]
    return np.asarray((1.0 - share) * line[k - 1] + share * line[k])


def _turned(view: View, spin: Floats, angle: float) -> View:
    """The view after turning the eye about the part's axis; the part seems to turn the other way."""
    around = np.array([[0.0, -spin[2], spin[1]], [spin[2], 0.0, -spin[0]], [-spin[1], spin[0], 0.0]])
    turn = np.eye(3) + np.sin(angle) * around + (1.0 - np.cos(angle)) * around @ around
    return replace(view, right=turn @ view.right, up=turn @ view.up, eye=turn @ view.eye)


def counted(image: Any, page: Page, done: float, total: float, units: str) -> Any:
    """The image with a progress bar of the laid fibre."""
    s = page.unit
    left, width = 0.5 * page.width, 300.0 * s
    top = page.height - 52.0 * s
    pen = canvas.pen(image)
    pen.rectangle((left, top - 6 * s, left + width, top + 6 * s), outline=canvas.FAINT)
    pen.rectangle((left, top - 6 * s, left + width * done / total, top + 6 * s), fill=canvas.FAINT)
    words = f"{done:,.0f} {units} laid" if units and total >= 100.0 else f"{100.0 * done / total:.0f} % laid"
    pen.text((left, top - 30 * s), words, canvas.INK, font=canvas.face(page, 21), anchor="lm")
    return image
