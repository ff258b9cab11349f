"""The time loop of the schemes in space, compiled whole: nothing is allocated once it runs but a tree query's stack."""

from typing import NamedTuple

import numpy as np

from meshwind.core.cast import Bools, Floats
from meshwind.core.kernel import njit
from meshwind.methods import kkt, penalty
from meshwind.methods.blocks import ChainMatrix, chain_matrix
from meshwind.methods.chain import (
    ANGLE,
    CONVERGED,
    DIVERGED,
    GROWTH,
    LENGTH,
    RESIDUAL,
    STEPS,
    STOPPED,
    TINY,
    energy_and_length,
    link,
    mean_angle,
)
from meshwind.methods.strand import kinetic_energy, move_by, unbalanced, update_gaps
from meshwind.path.kernels.landing import sag

PENALTY, KKT = range(2)


class SpaceRules(NamedTuple):
    """What a run in space does.

    scheme: one of the numbers above; steps: maximum number of steps; tolerance: of the residual, and of a move over the
    length; width: gap below which a particle touches; penalty: k_PF of (7.1) over the mass; stabilisation: share of a
    contact's gap that a step of KKT takes back.
    """

    scheme: int
    steps: int
    tolerance: float
    width: float
    penalty: float
    stabilisation: float


class SpaceWork(NamedTuple):
    """The linear system and arrays that a run fills again in every step.

    force (n, 3): the springs'; right (n, 3): right sides; unpinned (n,): False throughout.
    """

    matrix: ChainMatrix
    force: Floats
    right: Floats
    unpinned: Bools


@njit(cache=True)
def space_work(n, physics):
    """Work space of a run of n particles."""
    matrix = chain_matrix(n, physics.step, physics.stiffness, physics.damping)
    return SpaceWork(matrix, np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n, np.bool_))


@njit(nogil=True, cache=True)
def run_in_space(body, rules, physics, strand, history, tally):
    """Step the strand from rest; returns (residual, length, status), the arguments as for `run_on_surface`."""
    X, V, normal, touching, loose = strand.X, strand.V, strand.normal, strand.touching, strand.loose
    n, h = len(X), physics.step
    before, after, pressed = np.zeros(n, np.int64), np.zeros(n, np.int64), np.ones(n, np.bool_)
    work = space_work(n, physics)
    energy, length = energy_and_length(X)
    stored = 0.5 * n * rules.penalty * rules.width if rules.scheme == PENALTY else 0.0
    bound = GROWTH * (physics.stiffness * energy + stored)
    update_gaps(body, strand, 0.0, rules.width, tally)
    longest, status, station = np.inf, STOPPED, np.arange(n) * 1.0
    for k in range(rules.steps + 1):
        energy, length = energy_and_length(X)
        for i in range(n):
            pressed[i] = touching[i] and not loose[i]
        link(pressed, before, after)
        off_balance = max(unbalanced(X, normal, before, after), sag(X, after, station))
        residual = off_balance * (n - 1) / max(length, TINY)
        if len(history) > 0:
            history[k, LENGTH], history[k, RESIDUAL] = length, residual
            history[k, ANGLE] = mean_angle(X, normal, pressed)
        if residual <= rules.tolerance and longest <= rules.tolerance * length:
            status = CONVERGED
        if status == CONVERGED or k == rules.steps:
            break
        solved = True
        if rules.scheme == KKT:
            kkt.step(strand, physics, rules.stabilisation, work, tally)
        else:
            solved = penalty.step(strand, physics, rules, work, tally)
        if not solved or not kinetic_energy(V) + physics.stiffness * energy <= bound:
            status = DIVERGED
            break
        longest = move_by(X, V, h)
        update_gaps(body, strand, h, rules.width, tally)
        tally[STEPS] += 1
    for i in range(n):
        touching[i] = pressed[i] or i in (0, n - 1)
    return residual, length, status
