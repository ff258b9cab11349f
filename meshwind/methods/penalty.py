"""The penalty force method: springs in space and a force (7.1) that keeps particles off the surface.

Linearly implicit like (7.2), the penalty force's slope included, so that its stiffness does not bound the step.
"""

from numba import njit

from meshwind.methods.blocks import XX, XY, XZ, YY, YZ, ZZ, solve
from meshwind.methods.chain import SOLVES
from meshwind.methods.collide import pulls


@njit(cache=True)
def step(strand, physics, width, push, pinned, system, force, tally):
    """New velocities of the strand; width is epsilon_PF, push is k_PF over the mass; pinned (n,) must be False.

    Returns whether the matrix kept its digits; the velocities are lost where not.
    """
    X, W, uv, frames, normal, touching, gap = strand
    diagonal, inverse, work = system
    h = physics.step
    coupling = h * h * physics.stiff
    free = 1.0 + h * physics.damp + 2.0 * coupling
    slope = h * h * push / width
    pulls(X, force)
    for i in range(1, len(X) - 1):
        s = diagonal[i]
        s[XX] = s[YY] = s[ZZ] = free
        s[XY] = s[XZ] = s[YZ] = 0.0
        press = 0.0
        if touching[i]:
            press = push * min((width - gap[i]) / width, 1.0)
            if gap[i] > 0.0:
                a, b, c = normal[i, 0], normal[i, 1], normal[i, 2]
                s[XX] += slope * a * a
                s[XY] += slope * a * b
                s[XZ] += slope * a * c
                s[YY] += slope * b * b
                s[YZ] += slope * b * c
                s[ZZ] += slope * c * c
        for k in range(3):
            W[i, k] += h * (physics.stiff * force[i, k] + press * normal[i, k])
    tally[SOLVES] += 1
    return solve(diagonal, coupling, normal, pinned, W, inverse, work)
