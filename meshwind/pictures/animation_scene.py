"""What is to be seen while a part is wound: the fibres in the order they are laid, and the axis it turns about."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.path.lengths import lengths
from meshwind.pictures.scenes import AnimationScene
from meshwind.pictures.subject import Subject
from meshwind.pictures.winding_scene import winding_scene

FRAMES_PER_SECOND = 25
SHORTEST, LONGEST = 1.0, 120.0
"""Seconds of a movie."""
_TURNS = 2
_MOST_POINTS = 40_000
"""Points of all fibres together that are drawn."""


def animation_scene(of: Subject, seconds: float, movies: list[Path], encoder: str = "") -> AnimationScene:
    """The winding with how much fibre is laid before each of its points; movies: files to write, by an encoder.

    Raises BadInputError for seconds that are no length of a movie.
    """
    if not SHORTEST <= seconds <= LONGEST:
        raise BadInputError(f"seconds is {seconds:g}; give a number from {SHORTEST:g} to {LONGEST:g}")
    seen = winding_scene(of)
    view, fibres, bridges = seen.frame.view, seen.fibres, seen.bridges
    thin = -(-fibres.points.shape[0] * fibres.points.shape[1] // _MOST_POINTS)
    chosen = np.unique(np.r_[np.arange(0, len(of.kept), thin), len(of.kept) - 1])
    arc = lengths(of.paths).arc_length
    before = laid_before(of.paths.family, arc[:, -1])[:, None] + arc
    spin, centre, extent = turning(of.points, of.paths.points.reshape(-1, 3), view.up, view.right)
    view = replace(view, centre=centre, width=float(extent[0]), height=float(extent[1]))
    winding = replace(
        seen,
        frame=replace(seen.frame, view=view),
        fibres=replace(fibres, points=fibres.points[:, chosen], lift=fibres.lift[:, chosen]),
    )
    return AnimationScene(
        winding=winding,
        laid=before[:, of.kept[chosen]],
        bridge_laid=before[bridges.path, bridges.particle],
        total=float(arc[:, -1].sum()),
        spin=spin,
        turns=_TURNS,
        frames=round(FRAMES_PER_SECOND * seconds),
        frames_per_second=FRAMES_PER_SECOND,
        movies=tuple(str(movie.absolute()) for movie in movies),
        encoder=encoder,
    )


def laid_before(family: Ints, length: Floats) -> Floats:
    """Length of fibre (p,) that is laid before each path: the families take turns, path by path."""
    rank = np.zeros(len(family), dtype=np.int64)
    for name in np.unique(family):
        mine = np.flatnonzero(family == name)
        rank[mine] = np.arange(len(mine))
    order = np.lexsort((-family, rank))
    before = np.zeros(len(family))
    before[order] = np.cumsum(length[order]) - length[order]
    return before


def turning(points: Floats, fibres: Floats, up: Floats, right: Floats) -> tuple[Floats, Floats, Floats]:
    """The part's long axis, the middle of all on it, and the extents on the picture that hold it as it turns."""
    middle = points.mean(axis=0)
    spin = np.linalg.svd(points - middle, full_matrices=False)[2][0]
    everything = np.concatenate([points, fibres])
    along = (everything - middle) @ spin
    centre = middle + 0.5 * (along.min() + along.max()) * spin
    off = everything - centre
    height = off @ spin
    radius = np.sqrt(np.maximum((off**2).sum(axis=1) - height**2, 0.0))
    # a point on a circle about the axis strays so far in a direction of the picture, at most
    extent = [
        2.0 * float((np.abs(height * (spin @ side)) + radius * np.sqrt(max(1.0 - (spin @ side) ** 2, 0.0))).max())
        for side in (right, up)
    ]
    return spin, centre, np.array(extent)
