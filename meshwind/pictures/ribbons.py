"""Bands of fibre as ribbons of their true width, bent across as what they lie on."""

from dataclasses import dataclass

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import TINY, unit
from meshwind.filament.course import Kind
from meshwind.filament.filament import Filament
from meshwind.path.paths import Paths
from meshwind.pictures.scenes import Ribbons
from meshwind.surface.forms import components, fundamental_forms

ACROSS = 7
"""Points across a ribbon."""
_MOST_POINTS = 30_000
"""Points along all ribbons together, about: more are not visible, and take 170 bytes each."""
_SHORT = 24
"""Points of a run of one kind that are all kept."""
_LIFT = 1e-3, 5e-3
"""Height of the first and the last fibre over the part, over its diagonal: what is wound later lies above."""
_TIGHTEST = 0.5 * np.pi
"""Largest angle that a band bends through from its middle to its edge."""
_SAME = 1e-6
"""Largest distance, over the part's diagonal, of a point of a filament from its particle."""


@dataclass(frozen=True)
class Line:
    """The drawn points of one filament (k,): their numbers in it, and the curvature (k,) across the fibre there."""

    filament: Filament
    kept: Ints
    across: Floats


def ribbons(filaments: tuple[Filament, ...], paths: Paths, width: float, order: bool = True) -> Ribbons:
    """The bands of filaments, lifted off the part in the order of winding.

    order: whether shares are those of the fibre that is laid before, 0 to 1; else they are 0 on passes from the start
    to the end and 1 on passes back.
    """
    lines = [drawn(each, paths, len(filaments)) for each in filaments]
    total = sum(float(each.course.arc_length[-1]) for each in filaments)
    strips, shares, before = [], [], 0.0
    for line in lines:
        arc = line.filament.course.arc_length
        laid = (before + arc[line.kept]) / max(total, TINY)
        before += float(arc[-1])
        strips.append(strip(line, width, paths.surface.size * (_LIFT[0] + (_LIFT[1] - _LIFT[0]) * laid)))
        shares.append(laid if order else (line.filament.course.passed[line.kept] % 2).astype(np.float64))
    return Ribbons(np.concatenate(strips), np.concatenate(shares), np.array([len(each) for each in strips]))


def drawn(filament: Filament, paths: Paths, many: int = 1) -> Line:
    """Every so many points of a filament, and all of its short runs of one kind; many: number of filaments."""
    course = filament.course
    run = np.concatenate([[0], np.cumsum((np.diff(course.kind) != 0) | (np.diff(course.passed) != 0))])
    size = np.bincount(run)
    first = np.cumsum(size) - size
    place = np.arange(len(run)) - first[run]
    step = -(-len(run) * many // _MOST_POINTS)
    keep: Bools = (place % step == 0) | (place == size[run] - 1) | (size[run] <= _SHORT)
    kept = np.flatnonzero(keep)
    return Line(filament, kept, curvature_across(filament, paths)[kept])


def strip(line: Line, width: float, lift: Floats) -> Floats:
    """Points (k, m, 3) across a band: arcs of length `width`, square to the fibre, lifted by (k,) along the normal."""
    course = line.filament.course
    middle, normal = course.points[line.kept], course.normal[line.kept]
    steps = unit(np.diff(middle, axis=0))
    ahead = unit(np.concatenate([steps[:1], steps[:-1] + steps[1:], steps[-1:]]))
    aside = unit(np.cross(normal, ahead))
    up = np.cross(ahead, aside)
    off = width * np.linspace(-0.5, 0.5, ACROSS)
    tightest = 2.0 * _TIGHTEST / max(width, TINY)
    bend = np.clip(line.across, -tightest, tightest)[:, None]
    angle = bend * off
    flat = np.abs(angle) < 1e-6
    safe = np.where(flat, 1.0, bend)
    out = np.where(flat, off, np.sin(np.where(flat, 1.0, angle)) / safe)
    down = np.where(flat, -0.5 * bend * off**2, (np.cos(angle) - 1.0) / safe)
    centre = middle + lift[:, None] * normal
    return np.asarray(centre[:, None] + out[..., None] * aside[:, None] + down[..., None] * up[:, None])


def curvature_across(filament: Filament, paths: Paths) -> Floats:
    """Normal curvature (n,) square to the fibre of what it lies on, positive where that bulges outwards.

    On the part it is the surface's at the path's particle; on a prism that goes straight on along its axis, the part of
    the section's that a fibre at this angle leaves across itself.
    """
    course = filament.course
    step = np.diff(course.points, axis=0)
    size = np.maximum((step**2).sum(axis=1), TINY)
    along = (np.diff(course.normal, axis=0) * step).sum(axis=1) / size
    # at a place where the fibre leaves one body for another only one side is true: the flatter one
    both = np.stack([np.append(along[0], along), np.append(along, along[-1])])
    along = both[np.abs(both).argmin(axis=0), np.arange(both.shape[1])]
    hoop = np.maximum(np.sin(course.angle), 0.1)
    across = np.where(course.kind >= Kind.TURN, along * (np.cos(course.angle) / hoop) ** 2, 0.0)
    row, column = particles(filament, paths)
    on = np.flatnonzero(row >= 0)
    if len(on):
        frames = paths.surface.frames(np.ascontiguousarray(paths.uv[row[on], column[on]]))
        forms = fundamental_forms(frames)
        ahead = np.gradient(course.points, axis=0)[on]
        aside = np.cross(forms.normal, ahead)
        two, (du, dv) = forms.second, components(frames, aside).T
        bent = two.uu * du**2 + 2.0 * two.uv * du * dv + two.vv * dv**2
        across[on] = bent / np.maximum((aside**2).sum(axis=1), TINY)
    return np.asarray(across)


def particles(filament: Filament, paths: Paths) -> tuple[Ints, Ints]:
    """Path and particle (n,) of every point of a filament, -1 where it is none of these paths."""
    course = filament.course
    path = np.where(course.path < len(paths), course.path, -1)
    run = np.concatenate([[0], np.cumsum(np.diff(path) != 0)])
    last = np.append(np.flatnonzero(np.diff(path) != 0), len(path) - 1)
    # the first particle of a path may be the last point of the turnaround before it, so they count from the last
    left = last[run] - np.arange(len(path))
    most = paths.gap.shape[1] - 1
    row = np.where((path >= 0) & (left <= most), path, -1)
    column = np.where(paths.family[np.maximum(row, 0)] > 0, most - left, left)
    column = np.where(row >= 0, column, 0)
    off = np.linalg.norm(paths.points[np.maximum(row, 0), column] - course.points, axis=1)
    row = np.where(off <= _SAME * paths.surface.size, row, -1)
    return row, column
