"""program.gif and program.mp4: a machine winds a filament; the part turns, and the eye moves beside it."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pyvista as pv

from meshwind.appearance.looks import SIGNAL
from meshwind.appearance.strips import Ribbons
from meshwind.core.cast import Floats
from meshwind.pictures import animation_picture, camera, canvas, filament_picture
from meshwind.pictures.page import Page
from meshwind.pictures.scenes import MachineScene

_STEEL, _RAIL, _EYE = "#8d99a5", "#c9ced4", "#1f4e79"
_FIBRE, _FAULTY = canvas.INK, SIGNAL
_THICK = 5.0
"""Width of the free fibre in pixels of the designed page."""
_CHUCK = 2.4, 1.2
"""Radius and length of the chuck at the outer end of a shaft, over the shaft's radius."""
FLANGE = ("#c0392b", "x"), ("#1c7c3c", "y"), ("#2f6da8", "z")
"""Colours of the axes of a robot's flange."""
_REACH, _AXIS = 2.0, 0.12
"""Length of such an axis over the width of the eye, and its radius over that of the shaft."""
_SLIDE, _ARM, _ROLLER = 0.9, 0.28, 0.4
"""Half the size of the carriage, and radii of arm and eye, over the radius of the shaft."""


def frames(window: Any, scene: MachineScene, page: Page) -> Iterator[Any]:
    """The frames in sequence; the last one shows the finished winding."""
    filament, shots, last = scene.filament, scene.shots, scene.motion.frames - 1
    view, whole = filament.frame.view, filament.ribbons
    turning = [*filament_picture.add_stand(window, filament), *_shafts(window, scene)]
    band = filament_picture.add_bands(window, filament, page)
    free = window.add_mesh(pv.Line(), color=_FIBRE, line_width=_THICK * page.unit, lighting=False, render=False)
    lathe = not len(scene.flange)
    if lathe:
        _add(window, _bed(scene), _RAIL)
        carriage, arm = _add(window, _carriage(scene), _STEEL), _add(window, pv.Line(), _STEEL)
    else:
        arrows = [_add(window, pv.Line(), colour) for colour, _ in FLANGE]
    eye = _add(window, _roller(scene), _EYE)
    # bands are drawn nearer than they are, so that order tells which is seen; the eye, nearer still, goes along
    nearer = filament_picture.DEPTH * max(view.width, view.height) * view.eye
    for k in range(last + 1):
        turn = turned(scene.frame, scene.origin, float(shots.mandrel[k]))
        laid = whole if k == last else whole.until(float(shots.laid[k]))
        # the part stays in its place, and the camera's direction turns; the whole is turned as a body afterwards
        meshes = filament_picture.bands(filament, laid, replace(view, eye=view.eye @ turn[:3, :3]), page)
        for actor, mesh in zip(band, meshes, strict=True):
            actor.mapper.dataset = mesh
        for actor in (*turning, *band):
            actor.user_matrix = turn
        foot, tip = (place + nearer for place in places(scene, k))
        touch = shots.touch[k] + _lifted(laid, meshes[0])
        free.mapper.dataset = pv.Line(turn[:3, :3] @ touch + turn[:3, 3], tip)
        free.prop.color = _FAULTY if shots.faulty[k] else _FIBRE
        eye.prop.color = _FAULTY if shots.faulty[k] else _EYE
        if lathe:
            carriage.user_matrix = _matrix(np.eye(3), foot)
            arm.mapper.dataset = pv.Line(foot, tip).tube(radius=_ARM * scene.thick, n_sides=12)
        else:
            for arrow, way in zip(arrows, scene.flange[k].T, strict=True):
                end = tip + _REACH * scene.band * (way @ scene.frame)
                arrow.mapper.dataset = pv.Line(tip, end).tube(radius=_AXIS * scene.thick, n_sides=10)
        eye.user_matrix = _matrix(_rolled(scene.frame, float(shots.roll[k])), tip)
        yield _lettered(camera.portrait(window, page, view, filament.part.points), scene, page, k)


def _lifted(laid: Ribbons, drawn: Any) -> Floats:
    """By how much (3,) the last place of a band is drawn nearer than it is."""
    across = laid.points.shape[1]
    return np.asarray(drawn.points[-across:] - laid.points[-1])[across // 2]


def turned(frame: Floats, origin: Floats, angle: float) -> Floats:
    """The matrix (4, 4) that turns the part by an angle in radians about the axis of a frame (3, 3)."""
    c, s = np.cos(angle), np.sin(angle)
    turn = frame.T @ np.array([[1.0, 0.0, 0.0], [0.0, c, -s], [0.0, s, c]]) @ frame
    return _matrix(turn, origin - turn @ origin)


def places(scene: MachineScene, k: int) -> tuple[Floats, Floats]:
    """Where carriage and eye are in a frame of the movie."""
    on_axis = scene.origin + scene.shots.x[k] * scene.frame[0]
    return on_axis + scene.bed * scene.frame[1], on_axis + scene.shots.r[k] * scene.frame[1]


def _matrix(turn: Floats, by: Floats) -> Floats:
    """The matrix (4, 4) of a rotation (3, 3) and a move (3,)."""
    made = np.eye(4)
    made[:3, :3], made[:3, 3] = turn, by
    return made


def _rolled(frame: Floats, roll: float) -> Floats:
    """The rotation (3, 3) of the eye about the direction to the axis, so that its roller is square to the fibre."""
    c, s = np.cos(roll), np.sin(roll)
    return np.asarray(frame.T @ np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]) @ frame)


def _add(window: Any, body: Any, colour: str) -> Any:
    """Add a body of the machine."""
    return window.add_mesh(body, color=colour, ambient=0.35, diffuse=0.7, render=False)


def _shafts(window: Any, scene: MachineScene) -> Iterator[Any]:
    """Add the shafts that hold the part at both ends, and their chucks."""
    middle = scene.rods.mean()
    for first, last in scene.rods:
        yield _add(window, _rod(scene, first, last, scene.thick, 48), _STEEL)
        out = max((first, last), key=lambda end: abs(end - middle))
        end = out + np.sign(out - middle) * _CHUCK[1] * scene.thick
        yield _add(window, _rod(scene, out, end, _CHUCK[0] * scene.thick, 6), _RAIL)


def _rod(scene: MachineScene, first: float, last: float, radius: float, sides: int) -> Any:
    """A rod on the axis."""
    middle = scene.origin + 0.5 * (first + last) * scene.frame[0]
    return pv.Cylinder(
        center=middle, direction=scene.frame[0], radius=radius, height=abs(last - first), resolution=sides
    )


def _box(scene: MachineScene, sizes: tuple[float, float, float], at: Floats) -> Any:
    """A box of half sizes along the axes of the machine."""
    body = pv.Box([side * size for size in sizes for side in (-1.0, 1.0)])
    body.points = body.points @ scene.frame + at
    return body


def _bed(scene: MachineScene) -> Any:
    """The rail on which the carriage moves."""
    low, high = float(scene.rods.min()), float(scene.rods.max())
    middle = scene.origin + 0.5 * (low + high) * scene.frame[0] + (scene.bed + scene.thick) * scene.frame[1]
    return _box(scene, (0.5 * (high - low), 0.25 * scene.thick, 0.5 * scene.thick), middle)


def _carriage(scene: MachineScene) -> Any:
    """The carriage, at the origin."""
    size = _SLIDE * scene.thick
    return _box(scene, (size, 0.7 * size, size), np.zeros(3))


def _roller(scene: MachineScene) -> Any:
    """The eye, a roller at the origin, along the axis of the mandrel."""
    return pv.Cylinder(
        center=(0.0, 0.0, 0.0), direction=scene.frame[0], radius=_ROLLER * scene.thick, height=scene.band, resolution=24
    )


def _lettered(image: Any, scene: MachineScene, page: Page, k: int) -> Any:
    """The image with its title, legend, notes, scale bar and the fibre laid."""
    filament, shots = scene.filament, scene.shots
    pen = canvas.titled(image, page, filament.frame)
    rows = [*filament_picture.rows(filament), (_FIBRE, "free span")]
    rows += [(colour, f"flange {name}") for colour, name in FLANGE if len(scene.flange)]
    if shots.faulty.any():
        rows.append((_FAULTY, "at fault"))
    canvas.legend(pen, page, rows)
    canvas.note(pen, page, shots.notes[k].split("\n"), below=len(rows) + 1)
    canvas.ruler(pen, page, canvas.fitting(page, filament.frame.view), filament.frame.units)
    return animation_picture.counted(image, page, float(shots.laid[k]), scene.motion.total, filament.frame.units)
