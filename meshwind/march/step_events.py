"""Where a step of the forward solver must end: knot lines, rims and edges, and the point where the fibre lifts off.

Each is a root of a function of the step's own length, found on the step itself rather than on an interpolant of
it, so that it is as accurate as the method.  Coordinates are those of a window, [0, 1] in both directions.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.march.geodesic_equation import dormand_prince_8, rates, runge_kutta_4
from meshwind.surface.evaluate import Spline

OPEN, KNOT, EDGE = range(3)
"""What a window's side is: nothing, the next polynomial piece, or the end of the surface."""
WIDTH = 1e-7
"""A step may end so far (in spans) past a knot line: the pieces part there by less than round-off."""
SLACK = 1e-9
"""A normal curvature above minus this over the part's size is none: a straight ruling does not lift off."""
PRESS = 4
"""What may vanish at the end of a step: u, v, their rates p, q (0 to 3), or the normal curvature."""
STAYS, LEAVES, LIFTS = -1, 0, 4
"""How a step ended: inside, past side LEAVES + 0 to 3 (u low, u high, v low, v high), or with no pressure left."""
ROUNDS = 80


class Ground(NamedTuple):
    """What a path marches over: the spline, or for the exact method one piece of it, and what the march obeys.

    slip is the constant kg/kn that the fibre is steered with; size is the length that tolerances are relative to.
    """

    spline: Spline
    slip: float
    size: float
    exact: bool


class Work(NamedTuple):
    """Room for a step: the surface's frame (7, 3), the rates of the stages, and the rates (4,) at the end."""

    frame: Floats
    stages: Floats
    after: Floats


class Event(NamedTuple):
    """What ends a step: the quantity `what` meets target, to within slack; before is its value at the start."""

    what: int
    target: float
    slack: float
    before: float


@njit(cache=True)
def take(ground, y, h, work, end):
    """One step from y by h into `end`, with K[0] set; returns the number of surface evaluations."""
    spline, slip, exact = ground.spline, ground.slip, ground.exact
    if exact:
        return dormand_prince_8(spline, slip, y, h, work.frame, work.stages, end)
    return runge_kutta_4(spline, slip, y, h, work.frame, work.stages, end)


@njit(cache=True)
def measure(ground, what, end, work):
    """The quantity `what` at the end of a step."""
    if what < PRESS:
        return end[what]
    return rates(ground.spline, ground.slip, end, work.frame, work.after)[0]


@njit(cache=True)
def first_guess(what, target, y, h, end):
    """Step length at which a coordinate meets target: inverse cubic Hermite interpolation over the whole step."""
    a, b = y[what], end[what]
    slope0, slope1 = y[what + 2], end[what + 2]
    if not (slope0 * (b - a) > 0.0 and slope1 * (b - a) > 0.0):
        return 0.5 * h
    t = (target - a) / (b - a)
    m0, m1 = (b - a) / (slope0 * h), (b - a) / (slope1 * h)
    return h * t * (t * (3.0 - 2.0 * t) + (1.0 - t) * ((1.0 - t) * m0 - t * m1))


@njit(cache=True)
def shorten(ground, event, y, h, work, end):
    """Shorten a step of length h so that an event is at its end; returns (length, evaluations).

    At y the quantity is on the other side of the target than at `end`.  Within its slack of the target is near
    enough; with slack 0 the root is bracketed to round-off.  False position (Illinois), every third time a
    bisection.  The end lies past the target for rates, so that the next step sees their new sign, otherwise before.
    """
    what, target = event.what, event.target
    count = 0
    a, b = 0.0, h
    fa, fb = event.before - target, measure(ground, what, end, work) - target
    guess = first_guess(what, target, y, h, end) if what < 2 else b * fa / (fa - fb) if fa != fb else 0.5 * b
    past = what == 2 or what == 3
    last = -1
    for turn in range(ROUNDS):
        if not (a < guess < b):
            guess = 0.5 * (a + b)
        if guess in (a, b):
            break
        count += take(ground, y, guess, work, end) + (what == PRESS)
        f = measure(ground, what, end, work) - target
        if abs(f) < event.slack:
            return guess, count
        far = (f > 0.0) == (fb > 0.0)
        if far:
            b, fb = guess, f
            fa *= 0.5 if last == 1 else 1.0
        else:
            a, fa = guess, f
            fb *= 0.5 if last == 0 else 1.0
        last = 1 if far else 0
        if b - a <= 2e-16 * h:
            break
        guess = 0.5 * (a + b) if turn % 3 == 2 or fa == fb else a - fa * (b - a) / (fb - fa)
    found = b if past else a
    return found, count + take(ground, y, found, work, end)


@njit(cache=True)
def stay_one_way(ground, c, kind, y, h, work, end):
    """End the step where coordinate c turns back, if it may have been outside meanwhile; returns as `shorten`."""
    r0, r1 = y[2 + c], end[2 + c]
    reach = h * max(abs(r0), abs(r1))
    if kind == OPEN or r0 * r1 >= 0.0 or reach <= WIDTH:
        return h, 0
    high = max(y[c], end[c])
    low = min(y[c], end[c])
    if (1.0 - high if r0 > 0.0 else low) > reach:
        return h, 0
    return shorten(ground, Event(2 + c, 0.0, 0.0, r0), y, h, work, end)


@njit(cache=True)
def end_inside(ground, sides, y, h, work, end):
    """Cut the step at the first side that it passes; returns (length, how, evaluations)."""
    how = STAYS
    count = 0
    for c in range(2):
        for upper in range(2):
            side = 2 * c + upper
            kind = sides[side]
            if (y[2 + c] > 0.0) == (upper == 1):
                shorter, more = stay_one_way(ground, c, kind, y, h, work, end)
                how = STAYS if shorter < h else how
                h = shorter
                count += more
            out = end[c] - 1.0 if upper else -end[c]
            if kind == OPEN or out <= (WIDTH if kind == KNOT else 0.0):
                continue
            wall = float(upper)
            if kind == KNOT:
                target = wall + (0.5 * WIDTH if upper else -0.5 * WIDTH)
                h, more = shorten(ground, Event(c, target, 0.5 * WIDTH, y[c]), y, h, work, end)
                how = STAYS
            else:
                h, more = shorten(ground, Event(c, wall, 0.0, y[c]), y, h, work, end)
                end[c] = wall
                how = LEAVES + side
            count += more
    return h, how, count


@njit(cache=True)
def middle_press(ground, y, h, end, work):
    """Normal curvature half-way along a step, on the quintic through its two ends, of which the rates are known."""
    K, out = work.stages, work.after
    half = np.empty(4)
    for c in range(2):
        a, b, r0, r1, a0, a1 = y[c], end[c], y[2 + c], end[2 + c], K[0, 2 + c], out[2 + c]
        half[c] = 0.5 * (a + b) + h * (5.0 / 32.0 * (r0 - r1) + h / 64.0 * (a0 + a1))
        half[2 + c] = 15.0 / 8.0 * (b - a) / h - 7.0 / 16.0 * (r0 + r1) + h / 32.0 * (a1 - a0)
    return rates(ground.spline, ground.slip, half, work.frame, out)[0]


@njit(cache=True)
def end_pressed(ground, y, press, h, how, work, end):
    """Cut the step where the normal curvature along it falls below 0; returns (length, how, evaluations).

    A dip within the step is found by the parabola through its ends and its middle.
    """
    least = -SLACK / ground.size
    target = 0.0 if press > 0.0 else least
    at_end = measure(ground, PRESS, end, work)
    if at_end < least:
        h, count = shorten(ground, Event(PRESS, target, 0.0, press), y, h, work, end)
        return h, LIFTS, count + 1
    half = middle_press(ground, y, h, end, work)
    curve = 2.0 * (press - 2.0 * half + at_end)
    if not curve > 0.0:
        return h, how, 2
    t = (3.0 * press - 4.0 * half + at_end) / (2.0 * curve)
    if not (0.0 < t < 1.0 and press - curve * t * t < least):
        return h, how, 2
    dip = np.empty(4)
    count = 3 + take(ground, y, t * h, work, dip)
    if measure(ground, PRESS, dip, work) >= least:
        return h, how, count
    h, more = shorten(ground, Event(PRESS, target, 0.0, press), y, t * h, work, dip)
    end[:] = dip
    return h, LIFTS, count + more
