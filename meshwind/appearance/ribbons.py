"""Bands of fibre as ribbons of their true width, bent across as what they lie on."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from meshwind.appearance.strips import Ribbons, Turned
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import TINY, unit
from meshwind.filament.course import Kind
from meshwind.filament.filament import Filament
from meshwind.results.pattern_types import PatternFigures
from meshwind.surface.evaluate import SU, SV
from meshwind.surface.forms import components, fundamental_forms
from meshwind.surface.grid import MOST, grid, rings
from meshwind.surface.surface import Surface

ACROSS = 7
"""Points across a ribbon."""
MOST_ROWS = 30_000
"""Rows of all ribbons together, about: more are not visible, and take 170 bytes each."""
_SHORT = 24
"""Points of a run of one kind that are all kept."""
LIFT = 1e-3, 5e-3
"""Height of the first and the last fibre over the part, over its diagonal: what is wound later lies above."""
_TIGHTEST = 0.5 * np.pi
"""Largest angle that a band bends through from its middle to its edge."""
_ROUND = 64
"""Points round a rim of which the middle is taken."""
_ALONG_RIM = 0.1
"""Sine of the angle between fibre and rim below which a band is cut as if it were so large."""


@dataclass(frozen=True)
class Fineness:
    """How fine ribbons are: points across one, an odd number, and about how many rows all have together."""

    across: int = ACROSS
    rows: int = MOST_ROWS


@dataclass(frozen=True)
class Line:
    """The drawn points of one filament (k,): their numbers in it, and the curvature (k,) across the fibre there."""

    filament: Filament
    kept: Ints
    across: Floats


def ribbons(
    filaments: Sequence[Filament],
    surface: Surface,
    widths: Sequence[float],
    turned: Sequence[Turned] = (),
    fineness: Fineness | None = None,
) -> Ribbons:
    """The bands of filaments, lifted off the part in the order of winding; widths: of the band of each layer.

    All comes from the filaments' own points and normals; the surface of the part only bends the bands across. turned:
    what turns them at the start and at the end; pins gather a band to their radius.
    """
    fine = fineness or Fineness()
    body, rims = _Body(surface), _Rims(surface)
    pins = [(surface.points(_rim(v)).mean(axis=0), one.pin) for v, one in zip((0.0, 1.0), turned, strict=False)]
    step = -(-sum(len(each.course) for each in filaments) // fine.rows)
    lines = [drawn(each, body, step) for each in filaments]
    total = sum(float(each.course.arc_length[-1]) for each in filaments)
    strips, laid, before = [], [], 0.0
    for line in lines:
        arc = line.filament.course.arc_length
        laid.append(before + arc[line.kept])
        before += float(arc[-1])
        lift = surface.size * (LIFT[0] + (LIFT[1] - LIFT[0]) * laid[-1] / max(total, TINY))
        width = np.asarray(widths, dtype=np.float64)[np.minimum(line.filament.layer[line.kept], len(widths) - 1)]
        strips.append(rims.cut(strip(line, gathered(line, width, pins), lift, fine.across), line, width))

    def of_courses(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(line.filament.course, name)[line.kept] for line in lines])

    def of_filaments(name: str) -> NDArray[Any]:
        return np.concatenate([getattr(line.filament, name)[line.kept] for line in lines])

    points, kind = np.concatenate(strips), of_courses("kind")
    return Ribbons(
        points=points,
        off_turns=_off(points, points[(kind == Kind.TURN) | (kind == Kind.DWELL), fine.across // 2]),
        laid=np.concatenate(laid),
        kind=kind,
        layer=of_filaments("layer"),
        circuit=of_courses("circuit"),
        passed=of_courses("passed"),
        path=of_courses("path"),
        angle=np.degrees(of_courses("angle")),
        slip=of_courses("slip"),
        thickness=of_filaments("thickness"),
        sizes=np.array([len(each) for each in strips]),
    )


def _off(points: Floats, turns: Floats) -> Floats:
    """Distance (k, m) of points (k, m, 3) from the nearest of others (t, 3)."""
    if not len(turns):
        return np.full(points.shape[:2], np.inf)
    return np.asarray(cKDTree(turns).query(points.reshape(-1, 3))[0]).reshape(points.shape[:2])


def turned_by(patterns: Sequence[PatternFigures]) -> tuple[Turned, ...]:
    """What turns a filament at the start and at the end, by the report's figures of its first layer that turns."""
    turnarounds = next((each["turnarounds"] for each in patterns if each["turnarounds"]), [])
    return tuple(Turned(each["kind"], each["reach"], each["radius"] or 0.0) for each in turnarounds)


def _rim(v: float) -> Floats:
    """Parameters (k, 2) of points round a rim."""
    u = np.arange(_ROUND) / _ROUND
    return np.stack([u, np.full(_ROUND, v)], axis=1)


def gathered(line: Line, width: Floats, pins: Sequence[tuple[Floats, float]]) -> Floats:
    """Width (k,) of a band that pins gather; pins: the middle of each rim, and the width of a band there.

    It has its whole width on the part and the pins' between them, and changes evenly on the way.
    """
    if not pins:
        return width
    course = line.filament.course
    points, kind, arc = course.points[line.kept], course.kind[line.kept], course.arc_length[line.kept]
    off = np.stack([np.linalg.norm(points - middle, axis=1) for middle, _ in pins])
    at_pins = np.array([wide or np.inf for _, wide in pins])[off.argmin(axis=0)]
    known = kind != Kind.TURN
    narrow = np.where(kind == Kind.DWELL, np.minimum(at_pins, width), width)
    return np.asarray(np.interp(arc, arc[known], narrow[known])) if known.any() else width


def drawn(filament: Filament, body: "_Body", step: int = 1) -> Line:
    """Every `step`-th point of a filament, and all of its short runs of one kind."""
    course = filament.course
    run = np.concatenate([[0], np.cumsum((np.diff(course.kind) != 0) | (np.diff(course.passed) != 0))])
    size = np.bincount(run)
    first = np.cumsum(size) - size
    place = np.arange(len(run)) - first[run]
    keep: Bools = (place % step == 0) | (place == size[run] - 1) | (size[run] <= _SHORT)
    kept = np.flatnonzero(keep)
    return Line(filament, kept, curvature_across(filament, body)[kept])


def strip(line: Line, width: Floats, lift: Floats, across: int = ACROSS) -> Floats:
    """Points (k, m, 3) across a band: arcs of length width (k,), square to the fibre, lifted by (k,) along the normal.

    In the air a band is ruled: its points go straight from where it lifts off to where it lands.
    """
    course = line.filament.course
    middle, normal = course.points[line.kept], course.normal[line.kept]
    steps = unit(np.diff(middle, axis=0))
    ahead = unit(np.concatenate([steps[:1], steps[:-1] + steps[1:], steps[-1:]]))
    aside = unit(np.cross(normal, ahead))
    up = np.cross(ahead, aside)
    off = width[:, None] * np.linspace(-0.5, 0.5, across)
    tightest = 2.0 * _TIGHTEST / np.maximum(width, TINY)
    bend = np.clip(evened(line, width), -tightest, tightest)[:, None]
    angle = bend * off
    flat = np.abs(angle) < 1e-6
    safe = np.where(flat, 1.0, bend)
    out = np.where(flat, off, np.sin(np.where(flat, 1.0, angle)) / safe)
    down = np.where(flat, -0.5 * bend * off**2, (np.cos(angle) - 1.0) / safe)
    centre = middle + lift[:, None] * normal
    rows = centre[:, None] + out[..., None] * aside[:, None] + down[..., None] * up[:, None]
    return _ruled(rows, course.arc_length[line.kept], course.kind[line.kept] == Kind.BRIDGE)


def evened(line: Line, width: Floats) -> Floats:
    """Curvature (k,) across a fibre on the part, its mean over a length as long as its band is wide (k,).

    A band lies over ribs and dents that are narrower than itself.
    """
    course = line.filament.course
    arc, kind = course.arc_length[line.kept], course.kind[line.kept]
    on = (kind == Kind.LAID) | (kind == Kind.BRIDGE)
    if not on.any():
        return line.across
    across = np.interp(arc, arc[on], line.across[on])
    whole = np.concatenate([[0.0], np.cumsum(0.5 * (across[1:] + across[:-1]) * np.diff(arc))])
    ends = np.clip([arc - 0.5 * width, arc + 0.5 * width], arc[0], arc[-1])
    length = np.maximum(ends[1] - ends[0], TINY)
    return np.where(on, (np.interp(ends[1], arc, whole) - np.interp(ends[0], arc, whole)) / length, line.across)


def _ruled(rows: Floats, arc: Floats, air: Bools) -> Floats:
    """Rows (k, m, 3) in which those in the air (k,) are between the last before them and the first after them."""
    ground = np.flatnonzero(~air)
    inside = np.flatnonzero(air)
    if not len(ground) or not len(inside):
        return np.asarray(rows)
    at = np.searchsorted(ground, inside)
    before, after = ground[np.maximum(at - 1, 0)], ground[np.minimum(at, len(ground) - 1)]
    share = np.clip((arc[inside] - arc[before]) / np.maximum(arc[after] - arc[before], TINY), 0.0, 1.0)
    weight = share[:, None, None]
    out = np.array(rows)
    out[inside] = (1.0 - weight) * rows[before] + weight * rows[after]
    return out


class _Body:
    """The part's curvature at the point of its grid that is nearest to any point."""

    def __init__(self, surface: Surface) -> None:
        self._frames = grid(surface).frames
        self._tree = cKDTree(self._frames[:, 0])

    def bent(self, points: Floats, ahead: Floats) -> Floats:
        """Normal curvature (n,) square to directions (n, 3) at points (n, 3), positive where the part bulges out."""
        frames = self._frames[self._tree.query(points)[1]]
        forms = fundamental_forms(frames)
        aside = np.cross(forms.normal, ahead)
        two, (du, dv) = forms.second, components(frames, aside).T
        bent = two.uu * du**2 + 2.0 * two.uv * du * dv + two.vv * dv**2
        return np.asarray(bent / np.maximum((aside**2).sum(axis=1), TINY))


class _Rims:
    """The part's rims, along which bands that end there are cut, as the part is."""

    def __init__(self, surface: Surface) -> None:
        frames = rings(surface, np.array([0.0, 1.0]), MOST)
        normal = np.cross(frames[:, :, SU], frames[:, :, SV])
        self._outwards = unit(np.cross(frames[:, :, SU], normal) * [[[1.0]], [[-1.0]]]).reshape(-1, 3)
        self._tree = cKDTree(frames[:, :, 0].reshape(-1, 3))
        self._near = float(np.linalg.norm(frames[:, :, SU], axis=2).max()) / MOST

    def beyond(self, points: Floats) -> tuple[Floats, Floats]:
        """How far points (..., 3) lie beyond the rim that is nearest, negative on the part; the way there (..., 3)."""
        at = self._tree.query(points)[1]
        out = self._outwards[at]
        return np.asarray(((points - self._tree.data[at]) * out).sum(axis=-1)), out

    def cut(self, rows: Floats, line: Line, width: Floats) -> Floats:
        """Rows (k, m, 3) of a band of width (k,) that ends along the rims on which its fibre ends, if it does."""
        course = line.filament.course
        middle, arc = course.points[line.kept], course.arc_length[line.kept]
        out = np.array(rows)
        for end, inner in ((0, 1), (-1, -2)):
            off, at = self._tree.query(middle[end])
            if course.kind[line.kept[end]] != Kind.LAID or off > self._near:
                continue
            ahead, way = unit(middle[end] - middle[inner]), self._outwards[at]
            steep = max(float(way @ ahead), _ALONG_RIM)
            # the last row goes on to the rim on the side on which it falls short of it
            short = np.clip((middle[end] - rows[end]) @ way / steep, 0.0, 0.5 * width[end])
            out[end] += short[:, None] * ahead
            near = np.abs(arc - arc[end]) <= 0.5 * width / steep
            over, away = self.beyond(out[near])
            out[near] -= np.maximum(over, 0.0)[..., None] * away
        return out


def curvature_across(filament: Filament, body: _Body) -> Floats:
    """Normal curvature (n,) square to the fibre of what it lies on, positive where that bulges outwards.

    On the part it is the surface's; on a prism that goes straight on along its axis, the part of the section's that a
    fibre at this angle leaves across itself.
    """
    course = filament.course
    step = np.diff(course.points, axis=0)
    size = np.maximum((step**2).sum(axis=1), TINY)
    along = (np.diff(course.normal, axis=0) * step).sum(axis=1) / size
    # at a place where the fibre leaves one body for another only one side is true: the flatter one
    both = np.stack([np.append(along[0], along), np.append(along, along[-1])])
    along = both[np.abs(both).argmin(axis=0), np.arange(both.shape[1])]
    hoop = np.maximum(np.sin(course.angle), 0.1)
    turning = (course.kind == Kind.TURN) | (course.kind == Kind.DWELL)
    across = np.where(turning, along * (np.cos(course.angle) / hoop) ** 2, 0.0)
    on = np.flatnonzero(~turning)
    if len(on):
        across[on] = body.bent(course.points[on], np.gradient(course.points, axis=0)[on])
    return np.asarray(across)
