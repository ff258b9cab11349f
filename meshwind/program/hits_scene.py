"""Scene of what is wrong with a program on the part: spans and eyes that meet it, and fibre that goes astray."""

from collections import Counter
from dataclasses import replace

import numpy as np

from meshwind.appearance.gear import gear
from meshwind.appearance.strips import Gear
from meshwind.appearance.view import View, around, framed, merit_view
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import sizes, unit
from meshwind.mesh.geometry.rays import cast
from meshwind.pictures.scenes import HitsScene
from meshwind.pictures.subject import Subject
from meshwind.program.clear import Shaft, rod
from meshwind.program.faults import EYE, LIES, SPAN
from meshwind.program.program import Program
from meshwind.program.words import DOES, fault_words

_EYES = 240
"""Directions from which the picture may be seen."""
_ACROSS = 0.5
"""Cosine to the axis up to which one of them is taken: from an end a part shows little."""
_MOST = 400
"""Spans and marks that are drawn of each kind: more cannot be told apart."""
_LINES = 6
"""Lines that name single blocks."""


def blocks_at_fault(made: Program, kind: str) -> Ints:
    """Numbers of the blocks with a fault of some kind."""
    return np.array(sorted({fault.index for fault in made.faults if fault.kind == kind}), dtype=np.int64)


def hits_scene(of: Subject, made: Program) -> HitsScene | None:
    """The places at which a program is at fault on the part; None if there are none."""
    blocks = made.blocks
    spans, eyes, astray = (blocks_at_fault(made, kind) for kind in (SPAN, EYE, LIES))
    if not len(spans) + len(eyes) + len(astray):
        return None
    shown, eye = _some(spans), made.eyes
    lines = np.stack([blocks.point[shown], eye[shown]], axis=1)
    far, shaft = _met(made, shown)
    entries = blocks.point[shown] + far[:, None] * unit(lines[:, 1] - lines[:, 0])
    marks, others = eye[_some(eyes)], blocks.point[_some(astray)]
    stands = _with_shaft(made, gear(of.paths.surface, of.filaments, of.turned))
    everything = np.concatenate([of.points, stands.points, lines.reshape(-1, 3), marks])
    every = np.concatenate([spans, eyes, astray])
    view = _view(of, made, everything, (eye[every] - of.points.mean(axis=0), blocks.normal[every]))
    words = "; ".join(
        f"{fault_words(kind)} at {len(found)} block{'s' * (len(found) > 1)}"
        for kind, found in ((SPAN, spans), (EYE, eyes), (LIES, astray)) if len(found)
    )  # fmt: skip
    frame = of.frame(f"{of.name}: where the program is at fault", f"{made.machine.name}  ·  {words}", view)
    return HitsScene(frame, of.part, stands, lines, entries, marks, others, _notes(made, every, shaft))


def _some(index: Ints) -> Ints:
    """Up to `_MOST` of the numbers, evenly."""
    return index[:: -(-len(index) // _MOST)] if len(index) else index


def _met(made: Program, index: Ints) -> tuple[Floats, Bools]:
    """Lengths (k,) of free spans at which they meet part or shaft, and which of them meet the shaft."""
    work, blocks = made.work, made.blocks
    shaft = Shaft(made.machine.shaft / work.scale, (float(made.body.x[0]), float(made.body.x[-1])))
    blocked = work.blocked(made.mandrel, shaft)
    spans = (made.eyes - blocks.point)[index]
    face, far = cast(blocked.below, blocks.point[index], unit(spans), 0.0)
    return np.minimum(far, sizes(spans)), np.asarray(face >= blocked.own)


def _with_shaft(made: Program, stands: Gear) -> Gear:
    """What the turnarounds stand on, with the machine's shaft."""
    radius = made.machine.shaft / made.work.scale
    if not radius > 0.0:
        return stands
    points, sides = rod(radius, (float(made.body.x[0]), float(made.body.x[-1])))
    quads = sides[:, [0, 1, 2, 2]] + len(stands.points)
    return replace(
        stands, points=np.concatenate([stands.points, made.mandrel.outside(points)]),
        held=np.concatenate([stands.held, quads]),
        held_words=f"{stands.held_words}, shaft" if stands.held_words else "shaft",
    )  # fmt: skip


def _view(of: Subject, made: Program, everything: Floats, sides: tuple[Floats, Floats]) -> View:
    """The view from the side on which most of the places are; sides (k, 3): directions out to each of them."""
    eyes = around(_EYES)
    eyes = eyes[np.abs(eyes @ made.mandrel.direction) < _ACROSS]
    merit = np.zeros(len(eyes))
    for out in sides:
        size = np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-300)
        merit += np.clip((out / size) @ eyes.T, 0.0, None).mean(axis=0)
    faces = np.concatenate([of.quads[:, [0, 1, 2]], of.quads[:, [0, 2, 3]]])
    return framed(everything, merit_view(of.points, faces, eyes, merit))


def _notes(made: Program, index: Ints, shaft: Bools) -> tuple[str, ...]:
    """What the fibre does at the blocks, and the first of them with circuit and pass; shaft: spans that meet it."""
    blocks = made.blocks
    counts = Counter(int(kind) for kind in blocks.kind[index])
    lines = [f"{count} {DOES[kind]}" for kind, count in counts.most_common()]
    if shaft.any():
        lines.append(f"{'all' if shaft.all() else f'{100.0 * shaft.mean():.0f} %'} of these spans hit")
        lines.append("the shaft, not the part")
    lines.append("")
    passes = dict.fromkeys(zip(blocks.layer[index], blocks.circuit[index], blocks.passed[index], strict=True))
    layers = made.work.layers > 1
    for layer, circuit, passed in list(passes)[:_LINES]:
        way = "back" if passed % 2 else "out"
        lines.append(f"{f'layer {layer + 1}, ' if layers else ''}circuit {circuit + 1}, pass {way}")
    if len(passes) > _LINES:
        lines.append(f"and {len(passes) - _LINES} more passes")
    return tuple(lines)
