"""Scenes of rounds.png and slice.png: how a redesign went, and a cut through its worst bridge."""

from collections.abc import Sequence

import numpy as np

from meshwind.appearance.view import View
from meshwind.appearance.words import quantity
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import unit
from meshwind.path.paths import Paths
from meshwind.pictures.scenes import Frame, RoundsScene, SliceScene

_BESIDE = 0.25
"""Of the length of a bridge: what is shown of the part beyond each of its ends."""
_NEAR = 0.01
"""Of the same: a fibre further off the plane is not drawn in it."""


def rounds_scene(
    gaps: Sequence[float], bridged: Sequence[float], moves: Sequence[float], stages: Sequence[tuple[int, int]],
    threshold: float, name: str, units: str, view: View,
) -> RoundsScene:  # fmt: skip
    """What there was before all rounds and after each: gaps, shares and moves (r,), and stage and round of each."""
    title = f"{name}: the rounds of the redesign"
    subtitle = f"largest gap {quantity(gaps[0], units, 3)} before, {quantity(gaps[-1], units, 3)} after the last round"
    names = tuple(f"{stage}.{number}" if number else "before" for stage, number in stages)
    return RoundsScene(
        Frame(title, subtitle, units, view), np.array(gaps), np.array(bridged), np.array(moves),
        np.array([stage for stage, _ in stages]), names, threshold,
    )  # fmt: skip


def slice_scene(
    before: Paths, after: Paths, vertices: Floats, moves: Floats, faces: Ints, words: tuple[str, str], view: View
) -> SliceScene | None:
    """The plane of the worst bridge and the surface's normal below it, through the mesh before and after.

    words: name of the part, and its unit.  None where no fibre bridges.
    """
    path, at = (int(k) for k in np.unravel_index(int(np.argmax(before.gap)), before.gap.shape))
    if before.on_surface[path, at]:
        return None
    touching = np.flatnonzero(before.on_surface[path])
    first = int(touching[touching < at].max(initial=0))
    last = int(touching[touching > at].min(initial=before.gap.shape[1] - 1))
    points = before.points[path]
    chord = points[last] - points[first]
    length = float(np.linalg.norm(chord))
    along = unit(chord)
    up = unit(before.normal[path, at] - (before.normal[path, at] @ along) * along)
    foot = points[at] - before.gap[path, at] * before.normal[path, at]
    across, origin = np.cross(along, up), points[first]
    frame = np.stack([along, up, across], axis=1)

    def flat(where: Floats) -> Floats:
        return np.asarray((where - origin) @ frame)

    reach = (1.0 + 2.0 * _BESIDE) * length
    low, high = np.array([-_BESIDE * length, -np.inf]), np.array([(1.0 + _BESIDE) * length, np.inf])
    cuts = [_cut(flat(each), faces, low[0], high[0], reach) for each in (vertices, vertices + moves)]
    fibre, other = flat(points), flat(after.points[path])
    shown = (np.abs(fibre[:, 2]) < _NEAR * length) & (fibre[:, 0] > low[0]) & (fibre[:, 0] < high[0])
    kept = _around(shown, at)
    mine = (np.abs(other[:, 2]) < _NEAR * length) & (other[:, 0] > low[0]) & (other[:, 0] < high[0])
    fibre, other, gap = fibre[kept, :2], other[_around(mine, at), :2], flat(np.stack([foot, points[at]]))[:, :2]
    heights = np.concatenate([*(cut[..., 1].ravel() for cut in cuts), fibre[:, 1], other[:, 1]])
    low[1], high[1] = float(heights.min()), float(heights.max())
    title = f"{words[0]}: a cut along the worst bridge"
    largest = quantity(float(after.gap[path].max()), words[1], 3)
    gap_words, span = (quantity(each, words[1], 3) for each in (float(before.gap[path, at]), length))
    subtitle = (
        f"fibre {path}, a gap of {gap_words} over {span}; after the redesign the largest of this fibre is {largest}"
    )
    return SliceScene(Frame(title, subtitle, words[1], view), cuts[0], cuts[1], fibre, other, gap, low, high)


def _cut(points: Floats, faces: Ints, low: float, high: float, reach: float) -> Floats:
    """Segments (k, 2, 2) in which triangles between points (n, 3) meet the plane z = 0, near its x axis."""
    corners = points[faces]
    corners = corners[(corners[..., 2].min(axis=1) <= 0.0) & (corners[..., 2].max(axis=1) > 0.0)]
    other = np.roll(corners, -1, axis=1)
    a, b = corners[..., 2], other[..., 2]
    crosses = (a <= 0.0) != (b <= 0.0)
    share = np.where(crosses, a / np.where(crosses, a - b, 1.0), 0.0)
    meets = (corners + share[..., None] * (other - corners))[..., :2]
    lines = meets[crosses].reshape(-1, 2, 2)  # each triangle has two sides that cross
    near = (lines[..., 0].max(axis=1) > low) & (lines[..., 0].min(axis=1) < high)
    return lines[near & (np.abs(lines[..., 1]).max(axis=1) < 0.5 * reach)]


def _around(marked: Bools, at: int) -> slice:
    """The run of marked places about one of them."""
    if not marked[at]:
        return slice(0, 0)
    gaps = np.flatnonzero(~marked)
    return slice(int(gaps[gaps < at].max(initial=-1)) + 1, int(gaps[gaps > at].min(initial=len(marked))))
