"""Turnarounds on collars of a tube, which have closed forms: lengths, overrun, and the slip that they need."""

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS
from comparison.problem import TURN

from charts.maps import Row, key, paint, sweep
from charts.record import Results
from charts.style import save
from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.closing import ClosedLayer, close_layer
from meshwind.filament.course import Course, Kind
from meshwind.filament.ends import LayerPlan
from meshwind.surface import shapes

RADIUS, LENGTH = 50.0, 400.0
"""Of the tube, in mm."""
CIRCUITS, PARTICLES = 15, 401
ANGLES = (10.0, 20.0, 30.0, 45.0, 60.0, 75.0)
"""Winding angles that are asked for, in degrees; the pattern moves them."""
FRICTION = (0.05, 0.1, 0.2, 0.3, 0.5)
EXACT = 1e-3
"""Relative error of lengths and overrun up to which they are right, and ..."""
STEEP = 0.02
"""... by how much more slip than is stated the points of a turn may need, relative: they are some degrees apart."""


LEVEL = np.radians(89.0)
"""Angle from which a turn counts as a hoop, where it needs no slip."""


def passed(layer: ClosedLayer, kind: Kind) -> float:
    """Length of a kind in all filaments."""
    total = 0.0
    for course in layer.filaments:
        of = course.kind[1:] == kind
        total += float(np.linalg.norm(np.diff(course.points, axis=0), axis=1)[of].sum())
    return total


def needed(course: Course) -> Floats:
    """Slip at the inner points of turns: the change of the angle from the axis over that around the tube, sin of it."""
    step = np.diff(course.points, axis=0)
    turned = np.diff(np.unwrap(np.arctan2(course.points[:, 1], course.points[:, 0])))
    lean = np.arctan2(RADIUS * np.abs(turned), np.abs(step[:, 2]))
    apart = 0.5 * (np.abs(turned[1:]) + np.abs(turned[:-1]))
    inner = (course.kind[:-2] == Kind.TURN) & (course.kind[1:-1] == Kind.TURN) & (course.kind[2:] == Kind.TURN)
    inner &= (lean[:-1] < LEVEL) & (lean[1:] < LEVEL)
    middle = 0.5 * (lean[1:] + lean[:-1])
    return np.abs(np.diff(lean))[inner] / (apart * np.sin(middle))[inner]


def cell(friction: float, asked: float) -> Row:
    """A row of one layer: how far its lengths and its overrun are off the closed forms, and the slip of its points."""
    row: Row = dict(method=OURS, friction=friction, asked=asked)
    turns = LENGTH * np.tan(np.radians(asked)) / (TURN * RADIUS)
    tube = shapes.cylinder(RADIUS, LENGTH)
    try:
        layer = close_layer(tube, LayerPlan(CIRCUITS, turns, friction, PARTICLES, ("collar", "collar")))
    except BadInputError as refusal:
        return row | dict(result="refused", why=str(refusal))
    angle = np.arctan(layer.revolutions * TURN * RADIUS / LENGTH)
    slip = max(each.slip for each in layer.turnarounds)
    exact = {
        "legs": (passed(layer, Kind.LAID), 2 * CIRCUITS * LENGTH / np.cos(angle)),
        "turns": (passed(layer, Kind.TURN), 4 * CIRCUITS * RADIUS / slip / np.tan(angle)),
        "overrun": (layer.turnarounds[1].reach, RADIUS / slip * (1.0 / np.sin(angle) - 1.0)),
    }
    errors = {name: float(abs(found / right - 1.0)) for name, (found, right) in exact.items()}
    steepest = max(float(needed(course).max(initial=0.0)) for course in layer.filaments)
    right = max(errors.values()) <= EXACT and slip <= friction and steepest <= (1.0 + STEEP) * slip
    return row | errors | dict(result="ok" if right else "wrong", angle=float(np.degrees(angle)), stated_slip=slip,
                               slip=steepest, why="")  # fmt: skip


def draw(results: Results, quick: bool) -> None:
    """A map over winding angle and friction."""
    angles, friction = (ANGLES[1::2], FRICTION[::2]) if quick else (ANGLES, FRICTION)
    classes, rows = sweep(friction, angles, cell)
    figure, axes = plt.subplots(figsize=(9, 5.2))
    places = [float(k) for k in range(len(angles))]
    for k, row in enumerate(rows):
        if "slip" in row:
            worst = max(row[of] for of in ("legs", "turns", "overrun"))
            words = f"{worst:.0e}\n{row['slip']:.3g} of {row['stated_slip']:.3g}"
            axes.text(k % len(angles), k // len(angles) - 0.25, words, ha="center", va="center", fontsize=7)
    paint(axes, places, [float(k) for k in range(len(friction))], classes)
    axes.set_xticks(places, [f"{each:g}" for each in angles])
    axes.set_yticks(range(len(friction)), [f"{each:g}" for each in friction])
    axes.set(
        xlabel="winding angle that was asked for [degrees]",
        ylabel="friction",
        title=(
            f"Turnarounds on collars of a tube, radius {RADIUS:g}, length {LENGTH:g} mm, {CIRCUITS} circuits;"
            f"\nright: lengths of legs and turns and the overrun within {EXACT:g} of their closed forms,\nand no point"
            " needs more slip than is stated (numbers: error; slip)"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "turnarounds")
    results.table("turnarounds", rows)
