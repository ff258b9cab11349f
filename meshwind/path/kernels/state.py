"""One path while it is relaxed: its particles and contacts, when to stop, what it costs and how it ended.

Records are passed on whole.  Copies run in plain loops: they compile ten times as fast as slices.
"""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.kernel import njit
from meshwind.path.kernels.status import Status
from meshwind.surface.evaluate import S, frame, unit_normal

EVALUATIONS, FEET, SOLVES, ITERATIONS = range(4)
"""Columns of a path's counters: surface evaluations, foot points, linear solves and iterations."""

CONVERGED, SLID_OFF_START, SLID_OFF_END, UNSTABLE, STALLED, LEFT_CHART, TOO_COARSE = (int(each) for each in Status)
NEEDS_TREE = -1
"""The fibre leaves the surface and no search tree was given: start again with one.

No result ever has it, and no `Status` may have its number.
"""


class State(NamedTuple):
    """Particles of one path.

    X (n, 3): positions; uv (n, 2): parameters of the particle or of its foot; frames (n, 6, 3) and outward normals
    (n, 3) of the surface there; touching (n,): whether the particle touches; clear (n,): a lower bound of the gap of
    those that do not; station (n,): where along the fibre they belong, from 0 to n - 1, so that the springs' natural
    lengths are the differences: 1 for all where they are spaced evenly; pinned (n,): whether it moves across the fibre
    only.
    """

    X: Floats
    uv: Floats
    frames: Floats
    normal: Floats
    touching: Bools
    clear: Floats
    station: Floats
    pinned: Bools


class Contacts(NamedTuple):
    """Touching particles of one path.

    inner (n,): those between the ends in order, of which there are as many as the assembly counted; before, after
    (n,): each one's nearest touching neighbours.
    """

    inner: Ints
    before: Ints
    after: Ints


class Limits(NamedTuple):
    """When a particle leaves the surface, and when the iteration ends.

    pull_off: angle (radians) of the pull that lifts a particle, infinite for a fibre that cannot leave the surface;
    tolerance: largest unbalanced force over the tension (radians) of a converged path; iterations: maximum number.
    """

    pull_off: float
    tolerance: float
    iterations: int


@njit(cache=True)
def blank(n):
    """A state of n particles, all touching somewhere; their normals, not yet known, are zero."""
    return State(
        np.empty((n, 3)),
        np.empty((n, 2)),
        np.empty((n, 6, 3)),
        np.zeros((n, 3)),
        np.ones(n, np.bool_),
        np.zeros(n),
        np.arange(n) * 1.0,
        np.zeros(n, np.bool_),
    )


@njit(cache=True)
def no_contacts(n):
    """Room for the contacts of n particles."""
    return Contacts(np.empty(n, np.int64), np.zeros(n, np.int64), np.zeros(n, np.int64))


@njit(cache=True)
def state_of(batch, path, frames):
    """The state of one path of a batch, which it shares; frames (n, 6, 3) are work space."""
    return State(
        batch.X[path], batch.uv[path], frames, batch.normal[path], batch.touching[path], batch.gap[path],
        np.arange(batch.X.shape[1]) * 1.0, np.zeros(batch.X.shape[1], np.bool_),
    )  # fmt: skip


@njit(cache=True)
def copy(source, target):
    """Copy a state into another."""
    for i in range(len(source.X)):
        copy_particle(source, target, i)
        target.station[i], target.pinned[i] = source.station[i], source.pinned[i]


@njit(forceinline=True, cache=True)
def copy_particle(source, target, i):
    """Copy particle i of a state into another, but for its station and pin."""
    move_particle(source, i, target, i)


@njit(cache=True)
def move_particle(source, j, target, i):
    """Copy particle j of a state to particle i of another, but for its station and pin."""
    for k in range(3):
        target.X[i, k] = source.X[j, k]
        target.normal[i, k] = source.normal[j, k]
        for row in range(6):
            target.frames[i, row, k] = source.frames[j, row, k]
    target.uv[i, 0], target.uv[i, 1] = source.uv[j, 0], source.uv[j, 1]
    target.touching[i] = source.touching[j]
    target.clear[i] = source.clear[j]


@njit(cache=True)
def copy_lifted(source, target, i):
    """Copy lifted particle i of a state into another, but for its frame, which is that of its foot if needed."""
    for k in range(3):
        target.X[i, k] = source.X[i, k]
        target.normal[i, k] = source.normal[i, k]
    target.uv[i, 0], target.uv[i, 1] = source.uv[i, 0], source.uv[i, 1]
    target.touching[i] = source.touching[i]
    target.clear[i] = source.clear[i]


@njit(cache=True)
def put_on_surface(spline, state, i, u, v):
    """Put particle i on the surface at (u, v)."""
    X, uv, frames, normal = state.X, state.uv, state.frames, state.normal
    touching, clear = state.touching, state.clear
    uv[i, 0], uv[i, 1] = u, v
    frame(spline, u, v, frames[i])
    unit_normal(frames[i], normal[i])
    for k in range(3):
        X[i, k] = frames[i, S, k]
    touching[i] = True
    clear[i] = 0.0


@njit(forceinline=True, cache=True)
def distance(X, i, j):
    """Distance of two particles."""
    return np.sqrt((X[i, 0] - X[j, 0]) ** 2 + (X[i, 1] - X[j, 1]) ** 2 + (X[i, 2] - X[j, 2]) ** 2)


@njit(cache=True)
def energy(X):
    """The springs' energy 1/2 sum |P_{i+1} - P_i|^2 (4.1), and the length."""
    total = 0.0
    length = 0.0
    for i in range(len(X) - 1):
        d = distance(X, i + 1, i)
        total += d * d
        length += d
    return 0.5 * total, length


@njit(cache=True)
def spring_energy(state):
    """The energy of springs between the particles' stations, and the length: that of `energy` where these are even."""
    X, station = state.X, state.station
    total = length = 0.0
    for i in range(len(X) - 1):
        d = distance(X, i + 1, i)
        total += d * d / (station[i + 1] - station[i])
        length += d
    return 0.5 * total, length
