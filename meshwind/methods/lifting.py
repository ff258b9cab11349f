"""Lifting from the surface and landing on it as the source has them (chapter 5, Algorithms 1 and 2)."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.methods.chain import EVALUATIONS, FEET, link
from meshwind.surface.evaluate import S, unit_normal
from meshwind.surface.foot import foot

PULL = 1e-9
"""A pull below this times the spacing is round-off: Algorithm 1 says > 0, which noise alone would pass."""


@njit(cache=True)
def lift(chain, weighted, slack):
    """Algorithm 1: release every touching particle that its touching neighbours pull off, until none is.

    The test is the source's unweighted (P- - 2 P + P+) . n > 0; `weighted` takes the force of (5.2) instead, which
    has the right sign where the gaps on the two sides differ.
    """
    X, normal, touching, clearance = chain.X, chain.normal, chain.touching, chain.clearance
    before, after = chain.before, chain.after
    n = len(X)
    link(touching, before, after)
    released = True
    while released:
        released = False
        i = after[0]
        while i < n - 1:
            p, q = before[i], after[i]
            a, b = (1.0 / (i - p), 1.0 / (q - i)) if weighted else (1.0, 1.0)
            pull = 0.0
            for k in range(3):
                pull += (a * (X[p, k] - X[i, k]) + b * (X[q, k] - X[i, k])) * normal[i, k]
            if pull > slack:
                touching[i] = False
                clearance[i] = 0.0
                after[p], before[q] = q, p
                released = True
            i = q


@njit(cache=True)
def straighten(chain):
    """Spread the lifted particles evenly between touching ones (section 5.2)."""
    X, clearance, after = chain.X, chain.clearance, chain.after
    i, n = 0, len(X)
    while i < n - 1:
        j = after[i]
        for m in range(i + 1, j):
            t = (m - i) / (j - i)
            moved = 0.0
            for k in range(3):
                x = (1.0 - t) * X[i, k] + t * X[j, k]
                moved += (x - X[m, k]) ** 2
                X[m, k] = x
            clearance[m] -= np.sqrt(moved)
        i = j


@njit(cache=True)
def land(spline, chain, tally):
    """Algorithm 2: lifted particles below the surface land on their feet, found by Newton's method (5.4 to 5.7).

    It starts at the last foot, which is where (5.10) keeps the shadow particle.  The gap shrinks by no more than the
    particle moves, so most need no foot.  A particle that lands has no velocity.
    """
    X, uv, V, frames, normal = chain.X, chain.uv, chain.V, chain.frames, chain.normal
    touching, clearance = chain.touching, chain.clearance
    for m in range(1, len(X) - 1):
        if touching[m] or clearance[m] > 0.0:
            continue
        tally[FEET] += 1
        tally[EVALUATIONS] += foot(spline, X[m], uv[m], frames[m])
        unit_normal(frames[m], normal[m])
        height = square = 0.0
        for k in range(3):
            r = X[m, k] - frames[m, S, k]
            height += r * normal[m, k]
            square += r * r
        clearance[m] = np.sqrt(square)
        if height <= 0.0:
            touching[m] = True
            V[m, 0] = V[m, 1] = 0.0
            for k in range(3):
                X[m, k] = frames[m, S, k]


@njit(cache=True)
def update_touching(spline, chain, weighted, slack, former, tally):
    """Lift, straighten, land; returns whether the set of touching particles has changed.

    former (n,) is work space for the set before.
    """
    touching = chain.touching
    n = len(touching)
    for i in range(n):
        former[i] = touching[i]
    lift(chain, weighted, slack)
    straighten(chain)
    land(spline, chain, tally)
    link(touching, chain.before, chain.after)
    changed = False
    for i in range(n):
        changed = changed or former[i] != touching[i]
    return changed
