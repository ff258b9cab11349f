"""winding.gif and winding.mp4: fibre is laid down along its path while the part turns."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pyvista as pv

from meshwind.pictures import bodies, canvas, movie, winding_picture
from meshwind.pictures.page import Page, page_of

_HOLD = 1.5
"""Seconds that the finished winding stays."""


def draw(window: Any, scene: dict[str, Any], tell: Callable[[], None]) -> None:
    """Draw all frames into the movies of the scene; tell is called after each."""
    files = [Path(str(name)) for name in scene["movies"]]
    page, rate = page_of(scene), int(scene["a_second"])
    with movie.writers(files, page, rate, str(scene["encoder"])) as write:
        for frame in frames(window, scene):
            write(frame)
            tell()
        for _ in range(round(_HOLD * rate)):
            write(frame)


def frames(window: Any, scene: dict[str, Any]) -> Iterator[Any]:
    """The frames one after the other, the last one wound in full."""
    page = page_of(scene)
    scale = canvas.fitting(page, scene)
    thick = bodies.radius(scene, scale, page.unit)
    bodies.add_part(window, scene)
    grown = [*_fibres(window, scene, thick), *_bridges(window, scene, thick)]
    head = window.add_mesh(pv.Sphere(radius=2.2 * thick), color=canvas.INK, render=False)
    count, total = int(scene["frames"]), float(scene["total"])
    for k in range(count):
        done = total * k / (count - 1)
        for actor, whole in grown:
            actor.mapper.dataset = whole.clip_scalar(scalars="laid", value=done) if k < count - 1 else whole
        head.position = _head(scene, done, thick)
        head.visibility = 0 < k < count - 1
        turned = scene | _turned(scene, -2.0 * np.pi * float(scene["turns"]) * k / (count - 1))
        canvas.aim(window, page, turned, scene["centre"], canvas.middle(canvas.room(page)), scale)
        image = winding_picture.lettered(canvas.shot(window, page), turned, scale)
        yield _counted(image, page, done, total, str(scene["units"]))


def _fibres(window: Any, scene: dict[str, Any], thick: float) -> Iterator[tuple[Any, Any]]:
    points = scene["paths"] + thick * scene["path_lift"]
    family, taut = scene["family"], scene["taut"]
    kinds = [(colour, (family == name) & taut, 1.0) for name, colour in bodies.FAMILY.items()]
    for colour, mine, share in [*kinds, (bodies.LOOSE, ~taut, 0.6)]:
        if mine.any():
            lines = bodies.polylines(points[mine].reshape(-1, 3), np.full(mine.sum(), points.shape[1]))
            lines.point_data["laid"] = scene["laid"][mine].ravel()
            tubes = lines.tube(radius=share * thick, n_sides=8)
            look = {"color": colour, "ambient": 0.4, "diffuse": 0.7, "show_scalar_bar": False, "scalars": None}
            yield window.add_mesh(tubes, render=False, **look), tubes


def _bridges(window: Any, scene: dict[str, Any], thick: float) -> Iterator[tuple[Any, Any]]:
    if not len(scene["bridges"]):
        return
    lines = bodies.polylines(scene["bridges"] + thick * scene["bridge_lift"], scene["bridge_sizes"])
    lines.point_data["gap"] = scene["bridge_gap"]
    lines.point_data["laid"] = scene["bridge_laid"]
    tubes = lines.tube(radius=1.4 * thick, n_sides=10)
    look = {"scalars": "gap", "cmap": winding_picture.GAPS, "clim": [0.0, float(scene["max_gap"])]}
    yield window.add_mesh(tubes, render=False, show_scalar_bar=False, ambient=0.4, diffuse=0.65, **look), tubes


def _head(scene: dict[str, Any], done: float, thick: float) -> Any:
    """Where the fibre is being laid."""
    laid = scene["laid"]
    path = int(np.flatnonzero(laid[:, 0] <= done)[np.argmax(laid[laid[:, 0] <= done, 0])])
    k = int(np.clip(np.searchsorted(laid[path], done), 1, laid.shape[1] - 1))
    before, after = laid[path, k - 1], laid[path, k]
    share = float(np.clip((done - before) / max(after - before, 1e-300), 0.0, 1.0))
    line = scene["paths"][path] + thick * scene["path_lift"][path]
    return (1.0 - share) * line[k - 1] + share * line[k]


def _turned(scene: dict[str, Any], angle: float) -> dict[str, Any]:
    """The view after the eye has gone around the part's axis: the part turns the other way."""
    spin = scene["spin"]
    around = np.array([[0.0, -spin[2], spin[1]], [spin[2], 0.0, -spin[0]], [-spin[1], spin[0], 0.0]])
    turn = np.eye(3) + np.sin(angle) * around + (1.0 - np.cos(angle)) * around @ around
    return {name: turn @ scene[name] for name in ("right", "up", "eye")}


def _counted(image: Any, page: Page, done: float, total: float, units: str) -> Any:
    """A bar of how much fibre is laid, and the words."""
    s = page.unit
    left, width = 0.5 * page.width, 300.0 * s
    top = page.height - 52.0 * s
    pen = canvas.pen(image)
    pen.rectangle((left, top - 6 * s, left + width, top + 6 * s), outline=canvas.FAINT)
    pen.rectangle((left, top - 6 * s, left + width * done / total, top + 6 * s), fill=canvas.FAINT)
    told = f"{done:,.0f} {units} laid" if units and total >= 100.0 else f"{100.0 * done / total:.0f} % laid"
    pen.text((left, top - 30 * s), told, canvas.INK, font=canvas.face(page, 21), anchor="lm")
    return image
