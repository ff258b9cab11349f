"""March batches of fibres forward over a surface.

The adaptive method works in one polynomial piece of the spline at a time, in coordinates local to it: there the
equations are analytic, so order 8 is order 8, where steps across a knot line would see a kink in the curvature.
Steps therefore end on knot lines.  The source's RK4 takes its fixed steps over the surface as a whole.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.march.geodesic_equation import STAGES, local_error, rates
from meshwind.march.step_events import (
    EDGE,
    KNOT,
    LIFTS,
    OPEN,
    SLACK,
    STAYS,
    Ground,
    Work,
    end_inside,
    end_pressed,
    take,
)
from meshwind.surface.evaluate import Spline

RUNNING, LENGTH, RIM_START, RIM_END, EDGE_OF_SURFACE, LIFTS_OFF, STEP_LIMIT = range(-1, 6)
S, REACH, Y = 0, 1, 2
"""Places in a path's state: arc length, the controller's step, and from Y on the four unknowns."""
COLUMN, ROW, MARK, STEPS, EVALUATIONS, STOP, ROWS = range(7)
"""Places in a path's counters: the window's place, the next mark, counts, why it stopped, and rows written."""

OVERSHOOT = 0.02
"""Steps aim so far (in spans) past the next knot line, so that the crossing is bracketed."""
SHORTEST = 1e-13
"""A step below this times the part's size leads nowhere."""


@njit(cache=True)
def open_window(spline, exact, count, window):
    """Set the window on the path's place: for the exact method one piece, about its own corner to lose no digits."""
    if not exact:
        return
    i, j = count[COLUMN], count[ROW]
    if spline.periodic:
        i %= spline.net.shape[0] - 3
    for a in range(4):
        for b in range(4):
            for k in range(3):
                window[a, b, k] = spline.net[i + a, j + b, k] - spline.net[i + 1, j + 1, k]


@njit(cache=True)
def look_around(spans_u, spans_v, periodic, exact, count, sides):
    """What the window's four sides are."""
    inner = KNOT if exact else EDGE
    sides[0] = sides[1] = (KNOT if exact else OPEN) if periodic else inner
    sides[2] = sides[3] = inner
    if exact:
        if not periodic:
            sides[0] = EDGE if count[COLUMN] == 0 else KNOT
            sides[1] = EDGE if count[COLUMN] == spans_u - 1 else KNOT
        sides[2] = EDGE if count[ROW] == 0 else KNOT
        sides[3] = EDGE if count[ROW] == spans_v - 1 else KNOT


@njit(cache=True)
def room(sides, y):
    """Step length that reaches a little past the window, at the present rates."""
    h = np.inf
    for c in range(2):
        r = y[2 + c]
        if sides[2 * c] != OPEN and r != 0.0:
            h = min(h, ((1.0 - y[c] if r > 0.0 else y[c]) + OVERSHOOT) / abs(r))
    return h


@njit(cache=True)
def outward(sides, y):
    """The edge that the path stands on and moves out over, or STAYS."""
    for c in range(2):
        if sides[2 * c] == EDGE and y[c] <= 0.0 and y[2 + c] < 0.0:
            return 2 * c
        if sides[2 * c + 1] == EDGE and y[c] >= 1.0 and y[2 + c] > 0.0:
            return 2 * c + 1
    return STAYS


@njit(cache=True)
def reason(how):
    """The stop that a step's end stands for."""
    if how == LIFTS:
        return LIFTS_OFF
    if how == 2:
        return RIM_START
    return RIM_END if how == 3 else EDGE_OF_SURFACE


@njit(cache=True)
def controlled(ground, tolerance, y, h, reach, work, end):
    """Take a step of at most h whose local error stays within tolerance.

    Returns (length, the controller's next step, evaluations); the length is 0 where no step is short enough.
    """
    size, exact = ground.size, ground.exact
    count = 0
    while True:
        count += take(ground, y, h, work, end)
        error = local_error(h, size, work.frame, work.stages) / tolerance if exact else 0.0
        if error <= 1.0 and np.isfinite(end[0] + end[1] + end[2] + end[3]):
            grown = h * min(5.0, 0.9 * max(error, 1e-12) ** -0.125)
            return h, (grown if h >= reach else max(reach, grown)), count
        h *= max(0.1, 0.9 * error**-0.125) if 1.0 < error < 1e8 else 0.1
        reach = h
        if not exact or h < SHORTEST * size:
            return 0.0, reach, count


@njit(cache=True)
def change_window(exact, sides, count, y):
    """Step into the next piece where the path has passed a knot line; returns whether it did."""
    moved = False
    for c in range(2):
        if exact and sides[2 * c + 1] == KNOT and y[c] > 1.0:
            y[c] -= 1.0
            count[COLUMN + c] += 1
            moved = True
        elif exact and sides[2 * c] == KNOT and y[c] < 0.0:
            y[c] += 1.0
            count[COLUMN + c] -= 1
            moved = True
    return moved


class Rules(NamedTuple):
    """How all paths march.

    size: the part's, a length; exact: whether by the adaptive method; every: whether each step is recorded; spacing:
    arc length between marks that steps must meet; tolerance: of the local error; presses: whether a path stops where
    the fibre lifts off; limit: maximum number of steps.
    """

    size: float
    exact: bool
    every: bool
    spacing: float
    tolerance: float
    presses: bool
    limit: int


class Marches(NamedTuple):
    """Paths on the march: required friction kg/kn and length (p,), state (p, 6), counters (p, 7), rows (p, m, 5)."""

    slip: Floats
    length: Floats
    state: Floats
    counters: Ints
    rows: Floats


@njit(cache=True)
def march(spline, rules, path, marches):
    """March one path on until it stops or has filled its rows (m, 5) of (s, u, v, du/ds, dv/ds)."""
    size, exact, presses = rules.size, rules.exact, rules.presses
    slip, length, state = marches.slip[path], marches.length[path], marches.state[path]
    count, rows = marches.counters[path], marches.rows[path]
    spans = (spline.net.shape[0] - 3, spline.net.shape[1] - 3) if exact else (1, 1)
    window = np.empty((4, 4, 3)) if exact else spline.net
    ground = Ground(Spline(window, spline.periodic and not exact), slip, size, exact)
    work = Work(np.empty((7, 3)), np.empty((STAGES, 4)), np.empty(4))
    K = work.stages
    end = np.empty(4)
    y = state[Y:]
    sides = np.empty(4, np.int64)
    open_window(spline, exact, count, window)
    look_around(spans[0], spans[1], spline.periodic, exact, count, sides)
    while count[STOP] == RUNNING and count[ROWS] < len(rows):
        how = outward(sides, y)
        if how != STAYS:
            count[STOP] = reason(how)
            break
        press, speed = rates(ground.spline, slip, y, work.frame, K[0])
        count[EVALUATIONS] += 1
        if presses and press * size < -SLACK:
            count[STOP] = LIFTS_OFF
            break
        count[STEPS] += 1
        if count[STEPS] > rules.limit or not speed > 0.0:
            count[STOP] = STEP_LIMIT
            break
        if exact:  # unit speed (3.18): scale the rates as the curve run through at that speed
            for k in range(2):
                y[2 + k] /= speed
                K[0, k] /= speed
                K[0, 2 + k] /= speed * speed
        mark = min(count[MARK] * rules.spacing, length)
        h = mark - state[S]
        if exact:
            h = min(h, state[REACH], room(sides, y))
        whole = h >= mark - state[S]
        taken, state[REACH], more = controlled(ground, rules.tolerance, y, h, state[REACH], work, end)
        count[EVALUATIONS] += more
        if taken == 0.0:
            count[STOP] = STEP_LIMIT
            break
        shorter, how, more = end_inside(ground, sides, y, taken, work, end)
        count[EVALUATIONS] += more
        if presses and shorter > 0.0:
            shorter, how, more = end_pressed(ground, y, press, shorter, how, work, end)
            count[EVALUATIONS] += more
        y[:] = end
        if whole and shorter == h:
            state[S] = mark
            count[MARK] += 1
        else:
            state[S] += shorter
        if how != STAYS:
            count[STOP] = reason(how)
        elif state[S] >= length:
            count[STOP] = LENGTH
        if (rules.every or count[STOP] != RUNNING or state[S] == mark) and shorter > SHORTEST * size:
            record(state, count, spans, rows)
        if change_window(exact, sides, count, y):
            open_window(spline, exact, count, window)
            look_around(spans[0], spans[1], spline.periodic, exact, count, sides)


@njit(cache=True)
def record(state, count, spans, rows):
    """Write where a path is into its next row."""
    row, y = rows[count[ROWS]], state[Y:]
    row[0] = state[S]
    for c in range(2):
        row[1 + c] = (count[COLUMN + c] + y[c]) / spans[c]
        row[3 + c] = y[2 + c] / spans[c]
    count[ROWS] += 1


@njit(nogil=True, cache=True)
def march_all(first, last, spline, rules, marches):
    """March paths first to last on; see `march`."""
    for path in range(first, last):
        march(spline, rules, path, marches)
