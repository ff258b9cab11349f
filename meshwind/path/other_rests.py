"""Other states of rest close to those of a batch under friction, found by solving it again with small things changed.

Where a fibre comes to rest depends on where it started and on the friction.  Mostly the state moves with these in
proportion; where a bump or a ridge catches the fibre, or just does not, it leaps.  Each path slides again from a curve
to its left and from one to its right, with less friction and with more, by what a winder cannot tell apart.  The slides
are made on half the particles that decide where a path rests: the four cost little more than to solve it once, and what
they find is solved with all particles before it counts.
"""

from dataclasses import dataclass, field, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.vectors import TINY, unit
from meshwind.path.asked import Asked
from meshwind.path.batch import Batch, fresh, resampled
from meshwind.path.friction import Friction
from meshwind.path.kernels.lay import halvings
from meshwind.path.kernels.status import Status
from meshwind.path.levels import segments
from meshwind.path.sliding import fine_level
from meshwind.path.solver import Solver
from meshwind.surface.evaluate import SU, SV

if TYPE_CHECKING:
    from meshwind.path.paths import Paths

LOOSER = 0.05
"""Relative change of the friction: what repeated measurements of one fibre on one part differ by."""
ASIDE = 0.01
"""Shift of the starting curve in its middle, over the part's size."""
FAR = 0.025
"""Least distance of two states, over the part's size: below it nobody would call them two."""
LEAP = 0.6, 0.6, 0.5
"""Least shares of a move that are made in one half of a change, in one quarter and in one eighth, where it leaps; in
proportion they would be 1/2, 1/4 and 1/8."""
AT_REST = int(Status.CONVERGED), int(Status.TOO_COARSE)
OFF = int(Status.SLID_OFF_START), int(Status.SLID_OFF_END), int(Status.LEFT_CHART)


@dataclass(frozen=True)
class OtherRests:
    """For each of p paths, whether another state lies close to the one that it rests in.

    It is looked for with friction up to 5 % lower and higher, and with the starting curve shifted to either side, in
    its middle by up to 1 % of the part's size; one at a time.

    Attributes
    ----------
    apart : ndarray of float, shape (p,)
        Largest distance of the other state from the path, across it, in the surface's units; NaN where there is none
        or it is no state of rest.
    length : ndarray of float, shape (p,)
        Length of the fibre there, in the surface's units; NaN likewise.
    status : ndarray of int, shape (p,)
        How the path ends there, as `Status`: 0 at rest, 1 and 2 slid off; -1 where there is no other state.
    friction : ndarray of float, shape (p,)
        Relative change of the friction with which it ends there, 0 where none is needed.
    shift : ndarray of float, shape (p,)
        Shift of the starting curve with which it ends there, in the surface's units, positive to the left as seen from
        outside along the path; 0 where none is needed.
    moved : ndarray of float, shape (p,)
        Largest move, across itself, of a path without another state, in the surface's units, to the accuracy of few
        particles; NaN where it has one, is not at rest, or was not looked at: without friction, or where a slide has no
        answer.
    most_shifted : float
        The shift up to which was looked, in the surface's units.

    See Also
    --------
    Paths.other_rests : Look for them.

    Examples
    --------
    >>> import meshwind as mw
    >>> barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0)
    >>> paths = mw.solve(barrel, start=[(0.0, 0.0)], end=[(0.25, 1.0)], particles=101, friction=0.2)
    >>> paths.other_rests.found
    array([False])
    """

    apart: Floats
    length: Floats
    status: Ints
    friction: Floats
    shift: Floats
    moved: Floats
    most_shifted: float

    __repr__ = brief

    @property
    def found(self) -> Bools:
        """Whether each path (p,) would come to rest elsewhere, or slide off."""
        return frozen(self.status >= 0)


class _Change(NamedTuple):
    """A change of one path: shift and relative change of the friction, as shares of the largest."""

    shift: float
    friction: float

    def times(self, share: float) -> "_Change":
        return _Change(self.shift * share, self.friction * share)


WAYS = _Change(1.0, 0.0), _Change(-1.0, 0.0), _Change(0.0, -1.0), _Change(0.0, 1.0)
"""To the left, to the right, with less friction, with more."""


class _State(NamedTuple):
    """Where k paths of n particles lie, points (k, n, 3), and how they ended, status (k,)."""

    points: Floats
    status: Ints

    def row(self, k: int) -> "_State":
        return _State(self.points[k : k + 1], self.status[k : k + 1])


def look_for_other_rests(paths: "Paths") -> OtherRests:
    """Look for other states close to those of a batch."""
    p = len(paths)
    none, zero = np.full((3, p), np.nan), np.zeros((2, p))
    result = OtherRests(none[0], none[1], np.full(p, -1), zero[0], zero[1], none[2], ASIDE * paths.surface.size)
    asked = _asked(paths)
    index = np.flatnonzero(paths.status == Status.CONVERGED)
    if asked is not None and len(index):
        slides = _Slides(paths, asked, index)
        states = [slides.run(index, way) for way in WAYS]
        moves = np.stack([between(slides.rest(index, state), state) for state in states])
        result.moved[index] = moves.max(axis=0)  # NaN where one has no answer
        for k in np.flatnonzero((moves > slides.far).any(axis=0)).tolist():
            path = int(index[k])
            rest = slides.run(index[k : k + 1], _Change(0.0, 0.0))  # few particles alone may move a path
            tops = [state.row(k) for state in states]
            moved = np.array([between(rest, top)[0] for top in tops])
            result.moved[path] = moved.max()
            for way in np.argsort(-moved):  # NaN last
                if moved[way] > slides.far and slides.note(path, WAYS[way], (rest, tops[way]), result):
                    break
    arrays: dict[str, Any] = {
        each.name: frozen(getattr(result, each.name)) for each in fields(result) if each.name != "most_shifted"
    }
    return replace(result, **arrays)


def _asked(paths: "Paths") -> Asked | None:
    """What the paths were solved from; None where it is not known, or there is no friction."""
    asked = paths.asked
    if asked is None or asked.options.friction.none or (asked.initial is not None and len(asked) != len(paths)):
        return None
    start, end = frozen(paths.uv[:, 0]), frozen(paths.uv[:, -1])  # paths may have been added to those asked for
    return replace(asked, family=paths.family, start=start, end=end)


@dataclass
class _Slides:
    """Slides of paths with something changed.

    index: all paths that are slid; each is slid on as many segments, alone as among the others, so that where it comes
    to lie can be compared.  curves (p, n, 2): starting curves; left (p, n, 2): the step in (u, v) by one unit of length
    to their left.
    """

    paths: "Paths"
    asked: Asked
    index: Ints
    segments: int = field(init=False)
    curves: Floats = field(init=False)
    left: Floats = field(init=False)
    far: float = field(init=False)

    def __post_init__(self) -> None:
        paths, asked = self.paths, self.asked
        ends = np.stack([asked.start, asked.end], axis=1) if asked.initial is None else asked.initial
        self.curves = resampled(ends, paths.uv.shape[1])
        self.far = FAR * paths.surface.size
        self.left = _to_the_left(paths, self.curves)
        self.segments = self.enough()

    def enough(self) -> int:
        """Half the segments on which the paths were slid."""
        n, curves = self.curves.shape[1], self.curves[self.index]
        level = min((halvings(curve, n) for curve in curves), default=0)
        if not self.paths.on_surface[self.index].all():
            level = min(level, *(fine_level(curve, n) for curve in curves))
        return max(segments(n, level + 1), 2)

    def rest(self, index: Ints, like: _State) -> _State:
        """Where paths rest, on as many particles as another state has."""
        return _State(resampled(self.paths.points[index], like.points.shape[1]), np.zeros(len(index), np.int64))

    def run(self, index: Ints, change: _Change) -> _State:
        """Paths slid with a change, on half the particles on which they were slid, or where that stalls on as many."""
        starts = self.shifted(index, change.shift)
        batch = self.slid(starts, self.segments, change)
        stalled = np.flatnonzero(batch.status == Status.STALLED)
        if len(stalled):
            batch.put(stalled, self.slid(starts[stalled], 2 * (batch.particles - 1), change).halved())
        return _State(batch.X + self.paths.surface.middle, batch.status)

    def slid(self, starts: Floats, count: int, change: _Change) -> Batch:
        """Paths of so many segments slid from starting curves with a change of friction."""
        options, batch = self.asked.options, fresh(starts, count + 1)
        friction = self.friction(change.friction)
        solver = Solver(self.paths.surface, friction, options.bridging, options.tolerance, options.iterations)
        solver.coarse.slide(batch)
        return batch

    def shifted(self, index: Ints, shift: float) -> Floats:
        """Starting curves shifted, most in their middle, by a share of the largest shift."""
        by = shift * ASIDE * self.paths.surface.size
        hump = np.sin(np.linspace(0.0, np.pi, self.curves.shape[1]))
        moved = self.curves[index] + by * hump[:, None] * self.left[index]
        moved[..., 1] = np.clip(moved[..., 1], 0.0, 1.0)
        moved[:, [0, -1]] = self.curves[index][:, [0, -1]]
        return np.ascontiguousarray(moved)

    def friction(self, change: float) -> Friction:
        """The friction with a change."""
        return Friction(self.asked.options.friction.table * (1.0 + LOOSER * change))

    def note(self, path: int, change: _Change, ends: tuple[_State, _State], found: OtherRests) -> bool:
        """Write what a path does with a change, which moves it from one state to another, if it leaps; True if so."""
        share = self.leaps(path, change, *ends)
        for near in (share, 1.0) if share else ():
            small, index = change.times(near), np.array([path])
            given = replace(self.asked.rows(index), initial=frozen(self.shifted(index, small.shift)))
            options = replace(self.asked.options, friction=self.friction(small.friction))
            options = replace(options, particles=self.curves.shape[1])
            other = given.again(self.paths.surface, options, np.array([0]))
            state = _State(other.points, other.status)
            apart = between(self.rest(index, state), state)[0]
            if not apart > self.far:  # with all its particles it stays, or has no answer
                continue
            if np.isfinite(apart):
                found.apart[path], found.length[path] = apart, other.length[0]
            found.status[path], found.moved[path] = other.status[0], np.nan
            found.friction[path] = LOOSER * small.friction
            found.shift[path] = small.shift * ASIDE * self.paths.surface.size
            return True
        return False

    def leaps(self, path: int, change: _Change, low: _State, top: _State) -> float:
        """Share of a change with which a path has leapt; 0 where it moves in proportion, or slides have no answer."""
        index = np.array([path])
        whole = between(low, top)[0]
        share, step = 1.0, 0.5
        for least in LEAP:
            middle = self.run(index, change.times(share - step))
            below, above = between(low, middle)[0], between(middle, top)[0]
            if not max(below, above) >= max(self.far, least * whole):
                return 0.0
            if below >= above:
                top, share = middle, share - step
            else:
                low = middle
            step *= 0.5
        return share


def _to_the_left(paths: "Paths", curves: Floats) -> Floats:
    """Steps (p, n, 2) in (u, v) by one unit of length to the left of curves (p, n, 2), seen from outside."""
    frames = paths.surface.frames(curves.reshape(-1, 2)).reshape(*curves.shape[:2], 6, 3)
    su, sv = frames[:, :, SU], frames[:, :, SV]
    way = np.gradient(curves, axis=1)
    ahead = unit(way[..., :1] * su + way[..., 1:] * sv)
    left = unit(np.cross(np.cross(su, sv), ahead))
    e, f, g = (np.einsum("pnk,pnk->pn", a, b) for a, b in ((su, su), (su, sv), (sv, sv)))
    a, b = (np.einsum("pnk,pnk->pn", left, each) for each in (su, sv))
    area = np.maximum(e * g - f * f, TINY)
    return np.stack([(g * a - f * b) / area, (e * b - f * a) / area], axis=-1)


def between(one: _State, other: _State) -> Floats:
    """Largest distance (k,) of particles of one state from those of another, across the first.

    It is 0 where both slid off, inf where one did, and NaN where one has no answer.
    """
    ahead = unit(np.gradient(one.points, axis=1))
    step = other.points - one.points
    step = step - np.einsum("pnk,pnk->pn", step, ahead)[..., None] * ahead
    apart = np.linalg.norm(step, axis=2).max(axis=1)
    gone, went = np.isin(one.status, OFF), np.isin(other.status, OFF)
    apart[gone | went] = np.inf
    apart[gone & went] = 0.0
    known = (np.isin(one.status, AT_REST) | gone) & (np.isin(other.status, AT_REST) | went)
    apart[~known] = np.nan
    return np.asarray(apart)
