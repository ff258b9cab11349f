"""The penalty force method: springs in space and a force (7.1) that keeps particles off the surface.

Linearly implicit like (7.2), the penalty force's slope included, so that its stiffness does not bound the step.
"""

from meshwind.core.kernel import njit
from meshwind.methods.blocks import XX, XY, XZ, YY, YZ, ZZ, solve
from meshwind.methods.chain import SOLVES
from meshwind.methods.strand import spring_forces


@njit(cache=True)
def step(strand, physics, rules, work, tally):
    """New velocities of the strand; returns whether the matrix kept its digits: the velocities are lost where not."""
    X, V, normal, touching, gap = strand.X, strand.V, strand.normal, strand.touching, strand.gap
    h, width, force, diagonal = physics.step, rules.width, work.force, work.matrix.diagonal
    slope = h * h * rules.penalty / width
    spring_forces(X, force)
    for i in range(1, len(X) - 1):
        s = diagonal[i]
        s[XX] = s[YY] = s[ZZ] = work.matrix.free
        s[XY] = s[XZ] = s[YZ] = 0.0
        press = 0.0
        if touching[i]:
            press = rules.penalty * min((width - gap[i]) / width, 1.0)
            if gap[i] > 0.0:
                a, b, c = normal[i, 0], normal[i, 1], normal[i, 2]
                s[XX] += slope * a * a
                s[XY] += slope * a * b
                s[XZ] += slope * a * c
                s[YY] += slope * b * b
                s[YZ] += slope * b * c
                s[ZZ] += slope * c * c
        for k in range(3):
            V[i, k] += h * (physics.stiffness * force[i, k] + press * normal[i, k])
    tally[SOLVES] += 1
    return solve(work.matrix, normal, work.unpinned, V)
