"""The fibre that a moving eye lays: straight from where it leaves the surface to the eye, it stays where it lies.

With the point P where it leaves, the outward normal n there, the eye E and the unit vector t from P to E, the fibre is
taut where t.n = 0.  While the eye sinks below the tangent plane, P runs towards it, so that t.n returns to 0: per
length s of it t.n grows by the normal curvature kn.  An eye that moves aside turns the fibre: its geodesic curvature
times l = |E - P| is the eye's way aside over the length that is laid, and friction has to hold it.  Where the span
meets the surface further on, the fibre lands there, and what lies between is a bridge.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Floats, Ints
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill_table
from meshwind.core.vectors import TINY
from meshwind.mesh.geometry.rays import DEEPEST, first_met
from meshwind.surface.evaluate import SU, SUU, SUV, SV, SVV, S, frame, unit_normal
from meshwind.surface.tree import nearest_foot

LAYS, LEFT, LOST, LIPS = range(4)
"""What a stretch ends as: the eye has come to its end; the fibre left the surface over a rim; it was not followed.
Within a move of the eye: it has come to the lip of a hollow."""
ONWARDS, THROUGH, BOTH = range(3)
"""Ways of moving along the surface."""
SHORTEST = 1e-3
"""Share of the eye's move that is not halved any more."""
NEAR = 0.01
"""Length over the surface's size of a hollow that does not count."""
FLAT = 1e-3
"""Share of the curvature before a lip that is none."""
AIM = 1e-10
"""Angle between span and surface, in radians, below which the span is tangent."""
LONGEST = 0.01
"""Longest step over the surface's size, at which a flat place is crossed."""
MOST = 200
"""Most steps for one move of the eye, which is twice round the part."""
SECANTS = 8
"""Times that a step is shortened, at most, because it leads too far."""
MARGIN, SWING = 1.2, 2e-3
"""Factor of the friction, and radians of the span, that a fibre may swing more than it can hold before it slides."""
LIGHT = 0.05
"""Turn of the fibre over the surface, in radians, below which it hardly touches where it landed."""
FARTHER = 10
"""Pieces of a line in a row that are no nearer, after which no other is looked at."""
NORMAL = 6
"""Row of the outward normal in a work frame (7, 3)."""


class Eyes(NamedTuple):
    """Places of the eye (k, 3) in a row; stretch m has those from first[m] to first[m + 1], and starts from (u, v)."""

    eye: Floats
    first: Ints
    start: Floats


class Relaid(NamedTuple):
    """What is laid while the eye comes to each place, to be filled in.

    uv (k, 2), u unwrapped; point (k, 3), NaN where the fibre slid on from there; laid (k,): length since the stretch's
    start; aside, press (k,): angles in radians through which the fibre turned along the surface and with it; bridge
    (k,): length of the bridge that landed; end (m,) and last (m,): what became of a stretch, and its last place.
    """

    uv: Floats
    point: Floats
    laid: Floats
    aside: Floats
    press: Floats
    bridge: Floats
    end: Ints
    last: Ints


@njit(nogil=True, cache=True)
def feet_of(first, last, body, points, uv, height):
    """Write the feet (n, 2) of points first to last, in blocks of a kernel's own, and how far away they are (n,)."""
    at, guess = np.empty((6, 3)), np.array([0.0, 0.5])
    for i in range(first, last):
        nearest_foot(body, points[i], guess, at)
        uv[i, 0], uv[i, 1] = guess[0], guess[1]
        height[i] = np.sqrt(
            (points[i, 0] - at[S, 0]) ** 2 + (points[i, 1] - at[S, 1]) ** 2 + (points[i, 2] - at[S, 2]) ** 2
        )


@njit(cache=True)
def heading(spline, u, v, eye, at):
    """From (u, v) towards the eye: (du/ds, dv/ds, t.n, kn, distance of the eye); frame and normal are left in `at`."""
    frame(spline, u, v, at)
    unit_normal(at, at[NORMAL])
    dip = square = a = b = ee = ff = gg = 0.0
    for k in range(3):
        r, su, sv = eye[k] - at[S, k], at[SU, k], at[SV, k]
        dip += r * at[NORMAL, k]
        square += r * r
        a += r * su
        b += r * sv
        ee += su * su
        ff += su * sv
        gg += sv * sv
    away = np.sqrt(square)
    area = max(ee * gg - ff * ff, TINY)
    p, q = (gg * a - ff * b) / area, (ee * b - ff * a) / area
    speed = max(np.sqrt(ee * p * p + 2.0 * ff * p * q + gg * q * q), TINY)
    p, q = p / speed, q / speed
    press = 0.0
    for k in range(3):
        bend = at[SUU, k] * p * p + 2.0 * at[SUV, k] * p * q + at[SVV, k] * q * q
        press -= bend * at[NORMAL, k]
    return p, q, dip / max(away, TINY), press, away


@njit(cache=True)
def between(one, other, share, out):
    """Write the point at a share of the way from one to another."""
    for k in range(3):
        out[k] = one[k] + share * (other[k] - one[k])


@njit(cache=True)
def step(spline, u, v, h, before, eye, share, work):
    """The place after a step h towards an eye that moves from a share of its way to another (Runge-Kutta, order 4)."""
    at, goal = work
    du = dv = p = q = 0.0
    for stage in range(4):
        along = 0.0 if stage == 0 else (0.5 if stage < 3 else 1.0)
        weight = 1.0 / 6.0 if stage in (0, 3) else 1.0 / 3.0
        between(before, eye, share[0] + along * (share[1] - share[0]), goal)
        p, q, _, _, _ = heading(spline, u + along * h * p, v + along * h * q, goal, at)
        du, dv = du + weight * p, dv + weight * q
    return u + h * du, v + h * dv


@njit(cache=True)
def advance(body, uv, before, eye, how, work):
    """Move (u, v) along the surface until the span is tangent at the eye; (length, its turn with the surface, end).

    how: ONWARDS ends, as LIPS, where the surface begins to bend away from the span; THROUGH does not, and BOTH may go
    back as well.
    """
    spline, at = body.spline, work[0]
    longest = LONGEST * body.size
    _, _, dip, press, _ = heading(spline, uv[0], uv[1], eye, at)
    laid = turned = 0.0
    if dip >= -AIM and not (how == BOTH and dip > AIM):
        return laid, turned, LAYS
    whole = dip
    for _ in range(MOST):
        if how == ONWARDS and press <= 0.0:
            return laid, turned, LIPS
        h = -dip / press if press > 0.0 else np.copysign(longest, -dip)
        h = min(max(h, -longest), longest)
        share = (1.0 - dip / whole, 1.0 - (dip + h * max(press, 0.0)) / whole)
        lips = False
        for _ in range(SECANTS):
            u, v = step(spline, uv[0], uv[1], h, before, eye, share, work)
            _, _, then, bends, _ = heading(spline, u, v, eye, at)
            if how == ONWARDS and then < -AIM and bends < -FLAT * press:
                h, lips = h * press / (press - bends), True
                continue
            if then <= AIM or dip >= 0.0:
                break
            h *= max(dip / (dip - then), 0.25)  # too far: the span must not stand off what was just laid
        if not np.isfinite(u + v):
            return laid, turned, LOST
        cut = 1.0
        if v > 1.0 or v < 0.0:
            cut = ((1.0 if v > 1.0 else 0.0) - uv[1]) / (v - uv[1])
        laid += cut * h
        turned += cut * h * 0.5 * (press + bends)
        uv[0], uv[1] = uv[0] + cut * (u - uv[0]), uv[1] + cut * (v - uv[1])
        if cut < 1.0:
            return laid, turned, LEFT
        if lips and then < -AIM:
            return laid, turned, LIPS
        dip, press = then, bends
        if abs(dip) <= AIM or (dip > 0.0 > whole):
            return laid, turned, LAYS
    return laid, turned, LOST


@njit(cache=True)
def aside_of(eye, before, at, here):
    """The eye's move from `before`, along the surface and square to the span, over its distance: an angle."""
    move, ray = np.empty(3), np.empty(3)
    square = 0.0
    for k in range(3):
        move[k] = eye[k] - before[k]
        ray[k] = 0.5 * (eye[k] + before[k]) - here[k]
        square += ray[k] * ray[k]
    n = at[NORMAL]
    a, b, c = n[1] * ray[2] - n[2] * ray[1], n[2] * ray[0] - n[0] * ray[2], n[0] * ray[1] - n[1] * ray[0]
    return (a * move[0] + b * move[1] + c * move[2]) / max(square, TINY)


@njit(cache=True)
def landing(body, below, uv, eye, work, stack, far):
    """Move (u, v) to where the span from there meets the surface further on; the length of the bridge, or 0."""
    at, ray, middle, here = work[0], work[1], np.empty(3), np.empty(3)
    _, _, _, _, span = heading(body.spline, uv[0], uv[1], eye, at)
    for k in range(3):
        here[k] = at[S, k]
        ray[k] = (eye[k] - here[k]) / max(span, TINY)
    _, enters = first_met(below, here, ray, 0.0, stack, far)
    if enters >= span or enters < NEAR * body.size:
        return 0.0
    for k in range(3):
        middle[k] = here[k] + (enters + 1e-9 * body.size) * ray[k]
    _, inside = first_met(below, middle, ray, 0.0, stack, far)
    if enters + inside >= span:  # the eye is inside
        inside = 0.0
    for k in range(3):
        middle[k] = here[k] + (enters + 0.5 * inside) * ray[k]
    nearest_foot(body, middle, uv, at[:NORMAL])
    bridge = 0.0
    for k in range(3):
        bridge += (at[S, k] - here[k]) ** 2
    return np.sqrt(bridge)


@njit(cache=True)
def follow(body, below, uv, eyes, work, tree_work):
    """Move (u, v) with the eye from one place to the next: (length laid, bridge, turn with the surface, end).

    At a lip the eye's move is halved, until the span has met the far side of the hollow before the fibre comes there; a
    hollow in which it meets nothing is too shallow to count.
    """
    first, eye = eyes
    before, goal = np.empty(3), np.empty(3)
    laid = bridge = turned = done = 0.0
    step, end, old_u, old_v = 1.0, LAYS, uv[0], uv[1]
    while done < 1.0:
        between(first, eye, done, before)
        between(first, eye, done + step, goal)
        more, bend, end = advance(body, uv, before, goal, ONWARDS if step > SHORTEST else THROUGH, work)
        if end == LIPS:
            uv[0], uv[1], step = old_u, old_v, 0.5 * step
            continue
        laid, turned = laid + more, turned + bend
        if end == LAYS:
            found = landing(body, below, uv, goal, work, tree_work[0], tree_work[1])
            if found > 0.0:
                more, bend, end = advance(body, uv, goal, goal, BOTH, work)
                bridge, laid, turned = bridge + found, laid + found + more, turned + abs(bend)
        if end != LAYS:
            break
        old_u, old_v, done = uv[0], uv[1], done + step
        step = min(2.0 * step, 1.0 - done)
    return laid, bridge, turned, end


@njit(nogil=True, cache=True)
def pull_all(first, last, body, below, friction, eyes, out):
    """Lay the stretches first to last, each from its start until the eye has come to its end."""
    work, tree_work = (np.empty((7, 3)), np.empty(3)), (np.empty(DEEPEST, np.int64), np.empty(DEEPEST))
    at, uv, here, lifts = work[0], np.empty(2), np.empty(3), np.empty(2)
    for m in range(first, last):
        begin, end = eyes.first[m], eyes.first[m + 1]
        uv[0], uv[1] = eyes.start[m, 0], eyes.start[m, 1]
        laid, became, light, before_bridge, aside, press = 0.0, LAYS, False, 0.0, 0.0, 0.0
        out.last[m], landed = end - 1, begin
        for i in range(begin, end):
            both = (eyes.eye[max(i - 1, begin)], eyes.eye[i])
            heading(body.spline, uv[0], uv[1], both[1], at)
            for k in range(3):
                here[k] = at[S, k]
            out.aside[i] = aside_of(both[1], both[0], at, here)
            aside += out.aside[i]
            start_u, start_v, start = uv[0], uv[1], laid
            moved, out.bridge[i], out.press[i], became = follow(body, below, uv, both, work, tree_work)
            if light and abs(aside) > MARGIN * friction * (press + out.press[i]) + SWING:
                # a fibre that hardly touches where it landed slides there, as if it landed only now
                fill_table(out.point[landed:i], np.nan)
                uv[0], uv[1], laid, light = lifts[0], lifts[1], before_bridge, False
                start_u, start_v, start, aside, press = uv[0], uv[1], laid, 0.0, 0.0
                moved, out.bridge[i], out.press[i], became = follow(body, below, uv, both, work, tree_work)
            laid += moved
            press += out.press[i]
            if out.bridge[i] > 0.0:
                if not light:
                    lifts[0], lifts[1], before_bridge, landed = start_u, start_v, start, i
                light, aside, press = True, 0.0, 0.0
            light = light and press < LIGHT
            frame(body.spline, uv[0], uv[1], at)
            out.uv[i, 0], out.uv[i, 1], out.laid[i] = uv[0], uv[1], laid
            for k in range(3):
                out.point[i, k] = at[S, k]
            if became != LAYS:
                out.last[m] = i
                break
        out.end[m] = became


class Row(NamedTuple):
    """Points (k, 3) on lines and lengths (k,) along them; line m has those from first[m] to first[m + 1]."""

    points: Floats
    along: Floats
    first: Ints


@njit(cache=True)
def to_piece(point, line, j):
    """Squared distance of a point to the piece of a line from point j to the next."""
    along = size = 0.0
    for k in range(3):
        step = line[j + 1, k] - line[j, k]
        along += step * (point[k] - line[j, k])
        size += step * step
    share = min(max(along / max(size, TINY), 0.0), 1.0)
    square = 0.0
    for k in range(3):
        square += (line[j, k] + share * (line[j + 1, k] - line[j, k]) - point[k]) ** 2
    return square


@njit(nogil=True, cache=True)
def apart_all(first, last, one, other, out):
    """Write the distances (k,) of the points of lines first to last in `one` from the same lines in `other`.

    A point is looked for about the same length along its line, as far both ways as pieces come nearer.
    """
    for m in range(first, last):
        j, end = other.first[m], other.first[m + 1] - 2
        for i in range(one.first[m], one.first[m + 1]):
            while j < end and other.along[j + 1] < one.along[i]:
                j += 1
            best = to_piece(one.points[i], other.points, j)
            for way in (-1, 1):
                k, worse = j + way, 0
                while other.first[m] <= k <= end and worse < FARTHER:
                    square = to_piece(one.points[i], other.points, k)
                    best, worse = min(best, square), 0 if square < best else worse + 1
                    k += way
            out[i] = np.sqrt(best)
