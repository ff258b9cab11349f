"""Scene of the movie of a program: the machine as it winds the filament."""

import textwrap
from dataclasses import replace

import numpy as np

from meshwind.appearance.ribbons import Fineness, ribbons
from meshwind.appearance.strips import Ribbons
from meshwind.appearance.view import View, framed
from meshwind.appearance.words import duration, quantity
from meshwind.core.cast import Floats, Ints
from meshwind.core.vectors import unit
from meshwind.filament.filament import backwards
from meshwind.pictures.animation_scene import FRAMES_PER_SECOND, Reel, motion_of
from meshwind.pictures.filament_scene import filament_scene
from meshwind.pictures.scenes import MachineScene, Shots
from meshwind.pictures.subject import Subject
from meshwind.program.axes import moved
from meshwind.program.program import Program
from meshwind.program.robot import robot_poses
from meshwind.program.words import AXES, DOES, fault_words

ROBOT = "krl"
"""Dialect of machines that are robots: of these the flange is drawn, as the program does not know the arm."""
_TURN = 12.0
"""Degrees of the mandrel from frame to frame up to which the eye follows the part."""
_HEIGHT, _TILT = np.radians(48.0), np.radians(16.0)
"""Angles from which the machine is seen: from above the eye, and from the side of an end."""
_IN_RIM, _THIN = 0.6, 0.022
"""Largest radius of a shaft that is drawn where the machine names none: over that of the smaller rim, and length."""
_REACH, _PAST = 0.1, 0.06
"""Lengths of the shafts past part and eye, and distance of the bed past the eye, over what the eye goes along."""
_FINE = Fineness(across=5, rows=15_000)
"""Of the bands: every frame draws all of them."""
_RARE = 0.1
"""Share of the frames that may be moved to blocks at fault: with more they would show nothing else."""
_ROUND = 48
"""Points round a ring, and rings along the part, by which the picture is made wide enough."""
_LINE = 21
"""Letters of a line beside the picture."""
_ROLLER = 2.2
"""Least width of the eye over the radius of the shaft."""


def machine_scene(of: Subject, made: Program, reel: Reel) -> MachineScene:
    """The machine that winds the filament of a subject by its program; raises BadInputError for too short a movie."""
    seen, blocks, mandrel = filament_scene(of), made.blocks, made.mandrel
    motion = motion_of(reel, mandrel.direction, round(float(np.ptp(blocks.mandrel)) / 360.0))
    skin = mandrel.inside(np.concatenate([of.points, seen.gear.points]))
    low, high = (float(end(np.append(skin[:, 0], blocks.eye_x))) for end in (np.min, np.max))
    rods, thick = _shafts(made, (low - _REACH * (high - low), high + _REACH * (high - low)))
    bed = float(max(blocks.eye_r.max(), np.hypot(skin[:, 1], skin[:, 2]).max())) + _PAST * (high - low) + thick
    times = frame_times(made, motion.frames)
    flange = np.zeros((0, 3, 3))
    if made.machine.dialect == ROBOT:
        block = np.minimum(np.searchsorted(blocks.time, times), len(blocks) - 1)
        flange = robot_poses(blocks.chosen(block), mandrel).axes
    scene = MachineScene(
        replace(seen, ribbons=_bands(of, made)),
        mandrel.origin, mandrel.frame, rods, thick, bed, max(_ROLLER * thick, max(of.widths)), flange,
        shots_of(made, times), motion,
    )  # fmt: skip
    frame = of.frame(f"{of.name} on {made.machine.name}", _subtitle(made), _view(scene, skin))
    return replace(scene, filament=replace(scene.filament, frame=frame))


def frame_times(made: Program, frames: int) -> Floats:
    """Seconds (f,) of the program at the frames of a movie.

    They are even over the program where the part then turns slowly enough for the eye to follow.  Otherwise the first
    half of the frames shows as much of the program as they can so, and the other half the rest.  Where a rare block at
    fault would be passed over, its own time is taken.
    """
    time, first = made.blocks.time, frames // 2
    gone = np.maximum.accumulate(made.blocks.mandrel) - made.blocks.mandrel[0]
    times = np.linspace(0.0, made.seconds, frames)
    if gone[-1] > _TURN * (frames - 1):
        slow = min(float(time[np.searchsorted(gone, _TURN * first)]), 0.5 * made.seconds)
        times = np.concatenate(
            [np.linspace(0.0, slow, first, endpoint=False), np.linspace(slow, made.seconds, frames - first)]
        )
    faulty = np.unique(time[[fault.index for fault in made.faults]])
    after = np.searchsorted(faulty, times[:-1], side="right")
    at = np.append(faulty, np.inf)[after]
    passed = at < times[1:]
    if passed.mean() < _RARE:
        times[1:][passed] = at[passed]
    return times


def shots_of(made: Program, times: Floats) -> Shots:
    """What the movie shows at times (f,): the axes go evenly from block to block."""
    blocks = made.blocks
    block = np.minimum(np.searchsorted(blocks.time, times), len(blocks) - 1)

    def at(values: Floats) -> Floats:
        return np.interp(times, blocks.time, values)

    kinds = {fault.index: fault.kind for fault in made.faults}
    faulty = np.isin(block, list(kinds))
    laid = at(blocks.arc_length)
    return Shots(
        mandrel=np.radians(at(blocks.mandrel)), x=at(blocks.eye_x), r=at(blocks.eye_r),
        roll=np.radians(at(blocks.roll)),
        touch=np.stack([at(blocks.point[:, k]) for k in range(3)], axis=1), laid=laid, faulty=faulty,
        notes=tuple(_note(made, block, times, k, kinds.get(int(block[k]), "")) for k in range(len(times))),
    )  # fmt: skip


def _note(made: Program, block: Ints, times: Floats, k: int, fault: str) -> str:
    """What is said beside a frame."""
    blocks, n, seconds = made.blocks, int(block[k]), float(times[k])
    step = seconds - float(times[k - 1]) if k else float(times[1])
    layer = [f"layer {blocks.layer[n] + 1} of {made.work.layers}"] if made.work.layers > 1 else []
    values = [
        f"{AXES[axis.moves]} {np.interp(seconds, blocks.time, moved(blocks, axis.moves, made.work.scale)):,.1f}"
        f"{'°' if axis.unit == 'deg' else f' {axis.unit}'}"
        for axis in made.machine.axes
    ]
    return "\n".join([
        *layer,
        f"circuit {blocks.circuit[n] + 1}, pass {'back' if blocks.passed[n] % 2 else 'out'}",
        DOES[int(blocks.kind[n])],
        "",
        duration(seconds),
        f"of {duration(made.seconds)}",
        f"{quantity(step * FRAMES_PER_SECOND, digits=2)} times as fast",
        "",
        *values,
        "",
        *textwrap.wrap(fault_words(fault), _LINE),
    ])  # fmt: skip


def _subtitle(made: Program) -> str:
    """The machine and the figures of the program."""
    laid = quantity(float(made.blocks.arc_length[-1]), made.work.units)
    faults = len({fault.index for fault in made.faults})
    wrong = f"  ·  faults at {faults} of {len(made.blocks)} blocks" if faults else ""
    return f"{made.machine.words}  ·  {duration(made.seconds)}, {laid} of fibre{wrong}"


def _shafts(made: Program, ends: tuple[float, float]) -> tuple[Floats, float]:
    """Where shafts start and end along the axis (k, 2), and their radius.

    A shaft of the machine goes through the part.  Without one the part is shown as held at the middles of its rims.
    """
    shaft = made.machine.shaft / made.work.scale
    if shaft > 0.0:
        return np.array([ends]), shaft
    skin = made.work.skin
    rims = skin.points.reshape(*skin.shape, 3)[:, [0, -1]]
    middles = rims.mean(axis=0)
    radius = float(np.linalg.norm(rims - middles, axis=2).min())
    inner = np.sort(made.mandrel.inside(middles)[:, 0])
    return np.array([[ends[0], inner[0]], [inner[1], ends[1]]]), min(_THIN * (ends[1] - ends[0]), _IN_RIM * radius)


def _view(scene: MachineScene, skin: Floats) -> View:
    """The view from above the eye, wide enough for part and machine; skin (k, 3): in the axis' frame."""
    along, toward, third = scene.frame
    above = np.cos(_HEIGHT) * toward + np.sin(_HEIGHT) * third
    eye = unit((np.cos(_TILT) * above - np.sin(_TILT) * along)[None])[0]
    up = unit(np.cross(along, eye)[None])[0]  # the axis is level on the picture
    up = up if up @ third > 0.0 else -up
    turn = np.linspace(0.0, 2.0 * np.pi, _ROUND, endpoint=False)
    ring = np.stack([0.0 * turn, np.cos(turn), np.sin(turn)], axis=1)
    radius = np.hypot(skin[:, 1], skin[:, 2])
    x = np.linspace(skin[:, 0].min(), skin[:, 0].max(), _ROUND)
    band = np.clip(np.searchsorted(x, skin[:, 0]), 1, _ROUND - 1)
    most = np.zeros(_ROUND)
    np.maximum.at(most, band, radius)
    np.maximum.at(most, band - 1, radius)
    bed = scene.bed + 1.5 * scene.thick
    chuck = 1.5 * scene.thick
    low, high = float(scene.rods.min()) - chuck, float(scene.rods.max()) + chuck
    inside = np.concatenate([
        (x[:, None, None] * [1.0, 0.0, 0.0] + most[:, None, None] * ring).reshape(-1, 3),
        [[end, r, 0.0] for end in (low, high) for r in (0.0, bed)],
        [[float(end), float(scene.shots.r.max()), 0.0] for end in (scene.shots.x.min(), scene.shots.x.max())],
    ])  # fmt: skip
    points = scene.origin + inside @ scene.frame
    return framed(points, View(np.cross(up, eye), up, eye, scene.origin, 1.0, 1.0))


def _bands(of: Subject, made: Program) -> Ribbons:
    """The bands of the filaments as they are wound."""
    wound = backwards(of.filaments) if made.backwards else of.filaments
    return ribbons(wound, of.paths.surface, of.widths, of.turned, _FINE)
