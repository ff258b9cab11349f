"""The forward solver: from a point, a direction and a length, march a fibre over the surface (section 3.3).

The march is by arc length, never by z, so that a path may turn back.  It is the ground truth for the taut paths
where they touch, and a planner's tool of its own: with a constant slip, kg = slip * kn, the fibre leaves the
geodesic by as much as a friction of |slip| can hold (3.12).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from meshwind.core.cast import Bools, Floats, Ints, depth, floats, frozen
from meshwind.core.checks import check_type, check_word, is_number, text
from meshwind.core.errors import BadInputError
from meshwind.core.threads import parallel_for
from meshwind.march.march import EVALUATIONS, ROWS, RUNNING, STOP, Marches, Rules, march_all
from meshwind.march.nearby import Beside, go_beside
from meshwind.march.traced import Stop, Trace
from meshwind.surface.evaluate import Spline
from meshwind.surface.surface import Surface

Method: TypeAlias = Literal["adaptive", "rk4"]
Press: TypeAlias = Literal["stop", "ignore"]

CHUNK = 256
"""Rows of a path that one compiled call writes; longer paths take more calls."""
LIMIT = 1_000_000
"""Most steps of a path."""
RK4_STEP = 1e-3
"""The fixed step over the part's size, where none is given."""
FINEST, COARSEST = 1e-14, 1e-2


def trace(  # noqa: PLR0913
    surface: Surface,
    start: ArrayLike,
    direction: ArrayLike,
    length: float,
    *,
    slip: float = 0.0,
    method: Method = "adaptive",
    step: float | None = None,
    tolerance: float = 1e-12,
    press: Press = "stop",
) -> Trace:
    """March one fibre from a start in a given direction.

    Parameters
    ----------
    surface : Surface
        Surface to march over.
    start : array_like of float, shape (2,)
        Parametric start, u in turns and v in [0, 1].
    direction : float or array_like of float, shape (2,)
        Angle from the direction of v, in radians and positive towards +u, or a tangent (du, dv) of any length.
    length : float
        Length of the fibre, in the surface's units.
    slip, method, step, tolerance, press : optional
        As for `traces`.

    Returns
    -------
    Trace
        The fibre, up to where it stopped.

    Raises
    ------
    BadInputError
        As for `traces`.

    See Also
    --------
    traces : March a batch of fibres.

    Examples
    --------
    >>> import meshwind as mw
    >>> sphere = mw.shapes.sphere_band(1.0, polar0=0.5, polar1=2.5)
    >>> fibre = mw.trace(sphere, start=(0.0, 0.5), direction=1.2, length=1.0)
    >>> round(float(fibre.arc_length[-1]), 9), fibre.stop.name
    (1.0, 'LENGTH')
    """
    point, heading = floats(start, "start", 2), np.array(direction if depth(direction, "direction") else [direction])
    if heading.shape not in ((1,), (2,)):
        raise BadInputError(f"direction has shape {heading.shape}; give an angle in radians or a tangent (du, dv)")
    way = heading if len(heading) == 1 else heading[None]
    return traces(
        surface, point[None], way, length, slip=slip, method=method, step=step, tolerance=tolerance, press=press
    )[0]


def traces(  # noqa: PLR0913
    surface: Surface,
    start: ArrayLike,
    direction: ArrayLike,
    length: ArrayLike,
    *,
    slip: ArrayLike = 0.0,
    method: Method = "adaptive",
    step: float | None = None,
    tolerance: float = 1e-12,
    press: Press = "stop",
) -> tuple[Trace, ...]:
    """March a batch of fibres from their starts in given directions.

    The fibres are spread over all cores; the results do not depend on the number of threads.

    Parameters
    ----------
    surface : Surface
        Surface to march over.
    start : array_like of float, shape (p, 2)
        Parametric starts, u in turns and v in [0, 1].
    direction : array_like of float, shape (p,) or (p, 2)
        Angles from the direction of v, in radians and positive towards +u, or tangents (du, dv) of any length.
    length : float or array_like of float, shape (p,)
        Lengths of the fibres, in the surface's units.
    slip : float or array_like of float, shape (p,), default 0
        Ratio of geodesic to normal curvature, positive to the left as seen from outside: ``|slip|`` is the required
        friction. 0 gives geodesics.  It has no effect where the surface does not press.
    method : {"adaptive", "rk4"}, default "adaptive"
        "adaptive" is of order 8 and controls the error of every step; "rk4" is the classical Runge-Kutta method of
        fixed steps.
    step : float, optional
        With "adaptive" the distance of the points, by default those of its steps; with "rk4" the length of a step, by
        default the size of the surface over 1000.
    tolerance : float, default 1e-12
        Largest error of a step of "adaptive": of the position over the size of the surface, and of the direction in
        radians.
    press : {"stop", "ignore"}, default "stop"
        "stop" ends a fibre where it no longer presses on the surface and would bridge; "ignore" keeps it on the
        surface.

    Returns
    -------
    tuple of Trace
        The fibres.  They meet rims, edges and the point of lift-off to round-off.

    Raises
    ------
    BadInputError
        If shapes do not belong together, a start lies off the surface or has no tangent plane, or a value is out of
        range.

    See Also
    --------
    solve : Paths between two given ends.

    Examples
    --------
    >>> import meshwind as mw
    >>> tube = mw.shapes.cylinder(radius=1.0, length=3.0)
    >>> fibres = mw.traces(tube, start=[(0.0, 0.0), (0.5, 0.0)], direction=[0.3, 0.6], length=9.0)
    >>> [fibre.stop.name for fibre in fibres]
    ['RIM_END', 'RIM_END']
    """
    return marched(
        surface, start, direction, length, slip=slip, method=method, step=step, tolerance=tolerance, press=press
    ).traces()


@dataclass(frozen=True)
class Marched:
    """p fibres as they were marched: rows (n, 5) each of arc length, u, v and their rates; slip (p,); counts (p, 7).

    Points, frames and curvatures are worked out only where `traces` are asked for.
    """

    surface: Surface
    rows: tuple[Floats, ...]
    slip: Floats
    counts: Ints

    @property
    def last(self) -> Floats:
        """The last row (p, 5) of each."""
        return np.array([row[-1] for row in self.rows])

    @property
    def stop(self) -> Ints:
        """Why each ended (p,), as `Stop`."""
        return np.asarray(self.counts[:, STOP])

    def put(self, at: Ints, by: Marched, which: Ints) -> Marched:
        """The same with those of numbers `at` (k,) replaced by those that have the numbers `which` (k,) in `by`."""
        rows, slip, counts = list(self.rows), self.slip.copy(), self.counts.copy()
        for old, new in zip(at, which, strict=True):
            rows[old] = by.rows[new]
        slip[at], counts[at] = by.slip[which], by.counts[which]
        return Marched(self.surface, tuple(rows), slip, counts)

    def beside(self, slip: Floats, most: float) -> tuple[Marched, Bools]:
        """The fibres with other slips (p,), little different, and which are good to `most` over the size.

        Those end on the rims that these end on.
        """
        lengths = [len(row) for row in self.rows]
        first, rows = np.cumsum([0, *lengths]), np.concatenate(self.rows)
        good = np.empty(len(lengths), dtype=np.bool_)
        both = frozen(np.stack([self.slip, slip], axis=1))
        made = Beside(
            frozen(first), frozen(rows), both, frozen(self.stop), self.surface.size, most, np.empty_like(rows), good
        )
        parallel_for(go_beside, len(lengths), 1, self.surface.spline, made)
        return Marched(self.surface, tuple(np.split(made.moved, first[1:-1])), slip, self.counts), good

    def with_more(self, other: Marched) -> Marched:
        """The same and after them those of another march over the same surface."""
        return Marched(
            self.surface, (*self.rows, *other.rows), np.concatenate([self.slip, other.slip]),
            np.concatenate([self.counts, other.counts]),
        )  # fmt: skip

    def traces(self) -> tuple[Trace, ...]:
        """The fibres with all that is known of their points."""
        return _finish(self.surface, list(self.rows), self.slip, self.counts)


def marched(  # noqa: PLR0913
    surface: Surface,
    start: ArrayLike,
    direction: ArrayLike,
    length: ArrayLike,
    *,
    slip: ArrayLike = 0.0,
    method: Method = "adaptive",
    step: float | None = None,
    tolerance: float = 1e-12,
    press: Press = "stop",
) -> Marched:
    """March a batch of fibres; see `traces`, of which this is all but the last step."""
    check_type(surface, "surface", Surface, "as fit(chart) returns it")
    _check(method, press, step, tolerance)
    at = floats(start, "start", -1, 2)
    if np.any((at[:, 1] < 0) | (at[:, 1] > 1)) or (not surface.periodic and np.any((at[:, 0] < 0) | (at[:, 0] > 1))):
        raise BadInputError("a start point lies off the surface; give v (and u, unless periodic) in [0, 1]")
    count = len(at)
    lengths, slips = _each(length, "length", count), _each(slip, "slip", count)
    if np.any(lengths <= 0):
        raise BadInputError(f"length is {lengths.min():g}; give a length above 0, in the surface's units")
    rates = _heading(surface, at, direction)
    exact = method == "adaptive"
    size = surface.size
    spacing = step if step is not None else np.inf if exact else RK4_STEP * size
    every = step is None and exact
    spans = np.array(surface.spans if exact else (1, 1))
    # as the kernels keep it: a place in the window, and which piece of the surface the window is
    piece = np.zeros((count, 2), np.int64)
    if exact:
        piece = np.floor(at * spans).astype(np.int64)
        piece[:, 1] = np.clip(piece[:, 1], 0, spans[1] - 1)
        if not surface.periodic:
            piece[:, 0] = np.clip(piece[:, 0], 0, spans[0] - 1)
    state = np.column_stack([np.zeros(count), np.full(count, size), at * spans - piece, rates * spans])
    counts = np.zeros((count, 7), np.int64)
    counts[:, :2], counts[:, 2], counts[:, STOP] = piece, 1, RUNNING
    rules = Rules(size, exact, every, float(spacing), tolerance, press == "stop", LIMIT)
    first = np.column_stack([np.zeros(count), at, rates])
    marches = Marches(slips, lengths, state, counts, np.empty((count, 0, 5)))
    rows = _march(Spline(np.array(surface.net), surface.periodic), rules, marches, first)
    return Marched(surface, tuple(rows), slips, counts)


def _march(spline: Spline, rules: Rules, start: Marches, first: Floats) -> list[Floats]:
    """March in chunks until every path has stopped; returns each path's rows (n, 5)."""
    chunks = [[row[None]] for row in first]
    going = np.arange(len(first))
    while len(going):
        state, tally, rows = start.state[going], start.counters[going], np.empty((len(going), CHUNK, 5))
        tally[:, ROWS] = 0
        marches = Marches(start.slip[going], start.length[going], state, tally, rows)
        parallel_for(march_all, len(going), 1, spline, rules, marches)
        start.state[going], start.counters[going] = state, tally
        for path, written, filled in zip(going, rows, tally[:, ROWS], strict=True):
            chunks[path].append(written[:filled].copy())
        going = going[tally[:, STOP] == RUNNING]
    return [np.concatenate(parts) for parts in chunks]


def _finish(surface: Surface, rows: list[Floats], slips: Floats, counts: Ints) -> tuple[Trace, ...]:
    """Points, frames and curvatures of all rows at once, then cut into one `Trace` a path."""
    if not rows:
        return ()
    whole = np.concatenate(rows)
    frames = surface.frames(whole[:, 1:3])
    p, q = whole[:, 3:4], whole[:, 4:5]
    velocity = p * frames[:, 1] + q * frames[:, 2]
    bend = p * p * frames[:, 3] + 2 * p * q * frames[:, 4] + q * q * frames[:, 5]
    speed = np.linalg.norm(velocity, axis=1)
    cross = np.cross(frames[:, 1], frames[:, 2])
    normal = cross / np.linalg.norm(cross, axis=1, keepdims=True)
    kn = -(bend * normal).sum(axis=1) / speed**2
    kg = np.repeat(slips, [len(r) for r in rows]) * np.maximum(kn, 0.0)
    tangent = velocity / speed[:, None]
    columns = frames[:, 0], whole[:, 1:3], whole[:, 3:5], tangent, normal, whole[:, 0], kn, kg
    cuts = np.cumsum([len(r) for r in rows])[:-1]
    names = "points", "uv", "uv_rate", "tangent", "normal", "arc_length", "normal_curvature", "geodesic_curvature"
    split = {name: np.split(column, cuts) for name, column in zip(names, columns, strict=True)}
    return tuple(
        Trace(
            surface=surface,
            slip=float(slips[path]),
            stop=Stop(int(counts[path, STOP])),
            evaluations=int(counts[path, EVALUATIONS]),
            **{name: frozen(parts[path]) for name, parts in split.items()},
        )
        for path in range(len(rows))
    )


def _heading(surface: Surface, at: Floats, direction: ArrayLike) -> Floats:
    """Unit-speed (p, q) of (3.19) for angles (n,) or tangents (n, 2)."""
    frames = surface.frames(at)
    su, sv = frames[:, 1], frames[:, 2]
    area = np.linalg.norm(np.cross(su, sv), axis=1)
    if np.any(area <= 1e-12 * np.linalg.norm(su, axis=1) * np.linalg.norm(sv, axis=1)):
        raise BadInputError("the surface has no tangent plane at a start point; start away from the pole")
    if depth(direction, "direction") == 2:
        rates = floats(direction, "direction", len(at), 2)
        if not np.all(np.any(rates != 0, axis=1)):
            raise BadInputError("a direction is (0, 0); give a tangent (du, dv) that is not zero")
        rates = rates / np.abs(rates).max(axis=1, keepdims=True)
    else:
        angle = _each(direction, "direction", len(at))
        meridian = np.linalg.norm(sv, axis=1)
        # along v, and at right angles to it: s_v x n = (|s_v|^2 s_u - (s_u . s_v) s_v) / |s_u x s_v|
        across = np.column_stack([meridian, -(su * sv).sum(axis=1) / meridian]) / area[:, None]
        rates = np.sin(angle)[:, None] * across
        rates[:, 1] += np.cos(angle) / meridian
    speed = np.linalg.norm(rates[:, :1] * su + rates[:, 1:] * sv, axis=1, keepdims=True)
    return np.asarray(rates / speed)


def _each(value: ArrayLike, name: str, count: int) -> Floats:
    """One number for each path, from one for all or from (count,)."""
    return floats(np.repeat(value, count) if depth(value, name) == 0 else value, name, count)


def _check(method: str, press: str, step: float | None, tolerance: float) -> None:
    check_word(method, "method", ("adaptive", "rk4"))
    check_word(press, "press", ("stop", "ignore"))
    if step is not None and not (is_number(step) and step > 0):
        raise BadInputError(f"step is {text(step)}; give a length above 0, in the surface's units")
    if not is_number(tolerance) or not FINEST <= tolerance <= COARSEST:
        raise BadInputError(f"tolerance is {text(tolerance)}; give one from {FINEST:g} to {COARSEST:g}")
