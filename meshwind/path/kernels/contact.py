"""Which particles touch the surface: lifting (5.1), the springs that skip lifted particles (5.2), and the rims."""

from meshwind.core.kernel import njit
from meshwind.path.kernels.geometry import combine, dot, minus, row

DEEP, SHALLOW, NOTHING = range(3)
"""What a step may release: all that pulls off, as in a convex hull scan; only what its present neighbours pull off;
nothing.  A step that fails is tried again with the next."""
RIM = 1e-9
"""Particles closer than this to a rim or an edge, in v or u, are on it: a step that short lowers no energy visibly."""


@njit(forceinline=True, cache=True)
def pull(X, i, before, after):
    """Force on particle i from its nearest touching neighbours, per unit of spring: the row j of (5.2)."""
    here = row(X, i)
    return combine(1.0 / (i - before), minus(row(X, before), here), 1.0 / (after - i), minus(row(X, after), here))


@njit(forceinline=True, cache=True)
def spring_pull(X, station, i, before, after):
    """As `pull`, by springs between the particles' stations."""
    here = row(X, i)
    return combine(
        1.0 / (station[i] - station[before]), minus(row(X, before), here),
        1.0 / (station[after] - station[i]), minus(row(X, after), here),
    )  # fmt: skip


@njit(cache=True)
def link(touching, contacts):
    """Fill each touching particle's nearest touching neighbours; the two ends always touch."""
    before, after = contacts.before, contacts.after
    n = len(touching)
    last = 0
    for i in range(1, n):
        if touching[i]:
            before[i] = last
            after[last] = i
            last = i


@njit(cache=True)
def lift(state, slack, deep, contacts):
    """Release every touching particle that its neighbours pull off the surface (Algorithm 1).

    The force is the weighted one of (5.2): with uneven gaps the unweighted test of Algorithm 1 has the wrong sign.
    With `deep`, one pass with backtracking, as in a convex hull scan, reaches the fixed point that the source finds
    by repeated sweeps; without, only particles that their present neighbours pull off are released.  A pull up to
    `slack` counts as none.  Returns how many were released.
    """
    X, normal, touching, station = state.X, state.normal, state.touching, state.station
    before, after = contacts.before, contacts.after
    link(touching, contacts)
    released = 0
    i, n = after[0], len(touching)
    while i < n - 1:
        force = spring_pull(X, station, i, before[i], after[i])
        p, q = before[i], after[i]
        i_next = q
        if dot(force, row(normal, i)) > slack:
            touching[i] = False
            released += 1
            if deep:
                after[p], before[q] = q, p
                i_next = p if p > 0 else q
        i = i_next
    if not deep:
        link(touching, contacts)
    return released


@njit(cache=True)
def release(state, slack, caution, contacts):
    """Release what `caution` (DEEP, SHALLOW or NOTHING) lets go, and link the rest; returns how many were released."""
    if caution == NOTHING:
        link(state.touching, contacts)
        return 0
    return lift(state, slack, caution == DEEP, contacts)


@njit(cache=True)
def held(uv, i, periodic, fu, fv):
    """Bit 1: the force pushes particle i out over an edge in u; bit 2: out over a rim in v."""
    bits = 0
    if not periodic and ((uv[i, 0] <= RIM and fu < 0.0) or (uv[i, 0] >= 1.0 - RIM and fu > 0.0)):
        bits |= 1
    if (uv[i, 1] <= RIM and fv < 0.0) or (uv[i, 1] >= 1.0 - RIM and fv > 0.0):
        bits |= 2
    return bits
