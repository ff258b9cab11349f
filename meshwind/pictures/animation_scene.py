"""Scenes of movies: fibres or a filament in the order of laying, and the axis about which the part turns."""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from meshwind.appearance.view import View
from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.path.lengths import lengths
from meshwind.pictures.filament_scene import filament_scene
from meshwind.pictures.scenes import AnimationScene, Motion, ReelScene
from meshwind.pictures.subject import Subject
from meshwind.pictures.winding_scene import winding_scene

FRAMES_PER_SECOND = 25
SHORTEST, LONGEST = 1.0, 120.0
"""Shortest and longest movie, in seconds."""
_TURNS = 2
_MOST_POINTS = 40_000
"""Largest number of points of all fibres together."""


def animation_scene(of: Subject, seconds: float, movies: list[Path], encoder: str = "") -> AnimationScene:
    """The winding with the length of fibre laid before each of its points; movies: files to write; encoder: FFmpeg.

    Raises BadInputError if `seconds` is out of range.
    """
    seen = winding_scene(of)
    view, fibres, bridges = seen.frame.view, seen.fibres, seen.bridges
    thin = -(-fibres.points.shape[0] * fibres.points.shape[1] // _MOST_POINTS)
    chosen = np.unique(np.r_[np.arange(0, len(of.kept), thin), len(of.kept) - 1])
    arc = lengths(of.paths).arc_length
    before = laid_before(of.paths.family, arc[:, -1])[:, None] + arc
    total = float(arc[:, -1].sum())
    view, motion = moving(of.points, of.paths.points.reshape(-1, 3), view, Reel(total, seconds, movies, encoder))
    winding = replace(
        seen,
        frame=replace(seen.frame, view=view),
        fibres=replace(fibres, points=fibres.points[:, chosen], lift=fibres.lift[:, chosen]),
    )
    return AnimationScene(
        winding=winding,
        laid=before[:, of.kept[chosen]],
        bridge_laid=before[bridges.path, bridges.particle],
        motion=motion,
    )


def reel_scene(of: Subject, seconds: float, movies: list[Path], encoder: str = "") -> ReelScene:
    """The filaments of a winding in the order of winding; arguments and errors as of `animation_scene`."""
    seen = filament_scene(of)
    everything = np.concatenate([seen.ribbons.points.reshape(-1, 3), seen.gear.points])
    total = float(seen.ribbons.laid[-1])
    view, motion = moving(of.points, everything, seen.frame.view, Reel(total, seconds, movies, encoder))
    middle = seen.ribbons.points[:, seen.ribbons.points.shape[1] // 2]
    turned = np.cross(middle[:-1] - view.centre, np.diff(middle, axis=0)).sum(axis=0) @ motion.spin
    motion = replace(motion, spin=motion.spin if turned < 0.0 else -motion.spin)  # the part turns against the fibre
    return ReelScene(replace(seen, frame=replace(seen.frame, view=view)), motion)


@dataclass(frozen=True)
class Reel:
    """Length of fibre that a movie lays, its seconds, its files, and the path of FFmpeg."""

    total: float
    seconds: float
    movies: list[Path]
    encoder: str


def moving(points: Floats, fibres: Floats, view: View, reel: Reel) -> tuple[View, Motion]:
    """The view, wide enough for every turn of the part and its fibres, and the motion of the movie.

    Raises BadInputError if the seconds are out of range.
    """
    spin, centre, extent = turning(points, fibres, view.up, view.right)
    motion = motion_of(reel, spin, _TURNS)
    return replace(view, centre=centre, width=float(extent[0]), height=float(extent[1]), both=False), motion


def motion_of(reel: Reel, spin: Floats, turns: int) -> Motion:
    """The motion of a movie in which the part turns about an axis; raises BadInputError if it is too short or long."""
    check_seconds(reel.seconds)
    return Motion(
        total=reel.total,
        spin=spin,
        turns=turns,
        frames=round(FRAMES_PER_SECOND * reel.seconds),
        frames_per_second=FRAMES_PER_SECOND,
        movies=tuple(str(movie.absolute()) for movie in reel.movies),
        encoder=reel.encoder,
    )


def check_seconds(seconds: float) -> None:
    """Raise BadInputError if a movie of so many seconds is too short or too long."""
    if not SHORTEST <= seconds <= LONGEST:
        raise BadInputError(f"seconds is {seconds:g}; give a number from {SHORTEST:g} to {LONGEST:g}")


def laid_before(family: Ints, length: Floats) -> Floats:
    """Length of fibre (p,) laid before each path; paths of the two families alternate."""
    rank = np.zeros(len(family), dtype=np.int64)
    for name in np.unique(family):
        mine = np.flatnonzero(family == name)
        rank[mine] = np.arange(len(mine))
    order = np.lexsort((-family, rank))
    before = np.zeros(len(family))
    before[order] = np.cumsum(length[order]) - length[order]
    return before


def turning(points: Floats, fibres: Floats, up: Floats, right: Floats) -> tuple[Floats, Floats, Floats]:
    """The part's long axis, the centre of everything on it, and extents on the picture that suffice for every turn."""
    middle = points.mean(axis=0)
    spin = np.linalg.svd(points - middle, full_matrices=False)[2][0]
    everything = np.concatenate([points, fibres])
    along = (everything - middle) @ spin
    centre = middle + 0.5 * (along.min() + along.max()) * spin
    off = everything - centre
    height = off @ spin
    radius = np.sqrt(np.maximum((off**2).sum(axis=1) - height**2, 0.0))
    # the largest distance of a point that circles about the axis, in a direction of the picture
    extent = [
        2.0 * float((np.abs(height * (spin @ side)) + radius * np.sqrt(max(1.0 - (spin @ side) ** 2, 0.0))).max())
        for side in (right, up)
    ]
    return spin, centre, np.array(extent)
