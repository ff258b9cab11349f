"""What an answer is worth: true gaps, the friction that it needs, and whether its particles resolve the surface."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.core.vectors import TINY
from meshwind.path.kernels.landing import measure_gap
from meshwind.path.kernels.state import distance, energy
from meshwind.path.kernels.survey import blank_survey, survey
from meshwind.surface.evaluate import S

PULL = 1e-9
"""A pull off the surface below this angle (radians) is round-off, not lift."""
INSIDE = 1e-9
"""A lifted particle deeper than this times the part's size is inside the body."""
HALF_TURN, WHOLE_TURN = 0.4, 0.75
"""Change of u or v from particle to particle that only two sides of the body explain."""
DEEPEST = 0.5
"""Depth of a segment, over the particles' mean distance, from which they pass through what they do not follow: over an
edge of 90 degrees it is at most 0.35."""


@njit(cache=True)
def certify(body, state, required, counters):
    """True gaps of the lifted particles, and the friction |kg| / kn that each touching one requires.

    A lifted particle that turns out to be inside the body lands; returns how many did.
    """
    X, uv, frames, normal = state.X, state.uv, state.frames, state.normal
    touching, gap = state.touching, state.clear
    n = len(X)
    landed = 0
    for i in range(n):
        required[i] = np.nan
        if not touching[i]:
            height, gap[i] = measure_gap(body, state, i, counters)
            if height < -INSIDE * body.size and 0.0 < uv[i, 1] < 1.0:
                for k in range(3):
                    X[i, k] = frames[i, S, k]
                touching[i], gap[i] = True, 0.0
                landed += 1
    for i in range(1, n - 1):
        if touching[i]:
            gap[i] = 0.0
            required[i] = required_friction(X, normal, i)
    return landed


@njit(cache=True)
def leaps(state, periodic):
    """Whether the path passes through all of the body from one particle to the next."""
    return largest_leap(state, periodic) > max(HALF_TURN, 2.0 / (len(state.X) - 1))


@njit(cache=True)
def unresolved(body, state, counters):
    """Whether a segment passes deep inside the body, or the path through all of it."""
    n = len(state.X)
    if leaps(state, body.spline.periodic):
        return True
    _, length = energy(state.X)
    return survey(body, state, 0.0, blank_survey(n), counters) > DEEPEST * length / (n - 1)


@njit(cache=True)
def largest_leap(state, periodic):
    """Largest change of u or v from one particle, or its foot, to the next, where the body may be between the two.

    It is not where their gaps cover the way; a foot leaps from side to side of a hollow, too.  But by a whole turn no
    foot leaps.  Where u is not periodic only v counts.
    """
    X, uv, clear = state.X, state.uv, state.clear
    most = 0.0
    for i in range(len(uv) - 1):
        turn = abs(uv[i + 1, 0] - uv[i, 0]) if periodic else 0.0
        leap = max(turn, abs(uv[i + 1, 1] - uv[i, 1]))
        if turn > WHOLE_TURN or (leap > most and clear[i] + clear[i + 1] < distance(X, i, i + 1)):
            most = max(most, leap)
    return most


@njit(cache=True)
def required_friction(X, normal, i):
    """|kg| / kn from the turn of the polyline's unit tangent at particle i; 0 where the fibre runs straight."""
    side, press = turned(X, normal, i)
    return abs(side) / press if press > PULL else 0.0


@njit(cache=True)
def turned(X, normal, i):
    """Turn of the polyline's unit tangent at particle i in the surface, and that towards it: kg and kn by a spacing."""
    p = 1.0 / max(distance(X, i, i - 1), TINY)
    q = 1.0 / max(distance(X, i + 1, i), TINY)
    press = side = square = 0.0
    for k in range(3):
        c, d = (k + 1) % 3, (k + 2) % 3
        turn = q * (X[i + 1, k] - X[i, k]) - p * (X[i, k] - X[i - 1, k])
        b = normal[i, c] * (q * (X[i + 1, d] - X[i, d]) + p * (X[i, d] - X[i - 1, d]))
        b -= normal[i, d] * (q * (X[i + 1, c] - X[i, c]) + p * (X[i, c] - X[i - 1, c]))
        press -= turn * normal[i, k]
        side += turn * b
        square += b * b
    return side / np.sqrt(max(square, TINY)), press
