"""Paths whose particles stay where they are along the fibre: few of a finer answer, most of them where it bends."""

import numpy as np

from meshwind.core.kernel import njit
from meshwind.path.kernels.certificate import unresolved
from meshwind.path.kernels.coulomb import STUCK, Fibre, Grip
from meshwind.path.kernels.grip import hold_where_it_lies
from meshwind.path.kernels.resist import ROOM, resistance
from meshwind.path.kernels.rest import restore_contact, settle_evenly
from meshwind.path.kernels.state import CONVERGED, TOO_COARSE, energy, state_of


@njit(nogil=True, cache=True)
def relax_all_as_spaced(first, last, rough, limits, held, batch):
    """Relax paths first to last of a batch from where they are; if `held`, against friction from there."""
    n = batch.uv.shape[1]
    body = rough.body
    frames, offset = np.empty((n, 6, 3)), np.zeros(n)
    for p in range(first, last):
        state, counters = state_of(batch, p, frames), batch.counters[p]
        restore_contact(body, state, counters)
        state.pinned[:] = True
        resist = resistance(n if held else 0, 0.0, ROOM * energy(state.X)[1], 0.0)
        residual, status = settle_evenly(rough, resist, limits, True, False, state, batch.required[p], counters)
        if status == CONVERGED and unresolved(body, state, counters):
            status = TOO_COARSE
        if held:
            grip_as_it_lies(Fibre(state, Grip(batch.anchor[p], offset, batch.mode[p]), batch.starts[p]), body.size)
        batch.residual[p], batch.status[p] = residual, status


@njit(cache=True)
def grip_as_it_lies(fibre, size):
    """Find the anchors and modes of all particles, from anchors near by."""
    touching, mode = fibre.state.touching, fibre.grip.mode
    for i in range(1, len(touching) - 1):
        mode[i] = np.int8(STUCK)
        if touching[i]:
            hold_where_it_lies(fibre, i, size)
