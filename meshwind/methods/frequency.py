"""Natural frequencies of the chain, and the step sizes that the explicit schemes can take."""

import numpy as np
import scipy.linalg
from numpy.typing import ArrayLike

from meshwind.core.cast import Floats, floats
from meshwind.core.errors import BadInputError
from meshwind.methods.motion import Method
from meshwind.surface.evaluate import SU, SUU, SUV, SVV, S
from meshwind.surface.surface import Surface

MODES = 201
"""Number of frequencies up to the largest at which the stability of Runge-Kutta's method is tested."""
BISECTIONS = 60
"""More than the bits of a number: the bisection ends with the two sides next to each other."""
ROUND_OFF = 1e-12
"""A growth of less than this per step is round-off."""


def largest_frequency(surface: Surface, uv: ArrayLike, *, stiffness: float = 1.0, mass: float = 1.0) -> float:
    """Largest angular frequency omega_max of (4.8) linearised about the path uv (n, 2), all of it touching.

    In radians per unit of time, that is in sqrt(stiffness / mass); 2 sqrt(K/m) cos(pi / 2 / (n - 1)) for a straight
    chain.  The eigenvalue is that of the banded matrix in orthonormal tangent frames.
    """
    curve = floats(uv, "uv", -1, 2)
    if len(curve) < 3:
        raise BadInputError(f"uv has {len(curve)} points; give at least 3, the ends included")
    frames = surface.frames(curve)
    points, inner = frames[:, S], frames[1:-1]
    force = points[:-2] - 2.0 * points[1:-1] + points[2:]
    basis, scale = np.linalg.qr(np.swapaxes(inner[:, SU : SU + 2], 1, 2))
    bend = np.einsum("ik,iak->ia", force, inner[:, [SUU, SUV, SUV, SVV]]).reshape(-1, 2, 2)
    back = np.linalg.inv(scale)
    blocks = 2.0 * np.eye(2) - np.swapaxes(back, 1, 2) @ bend @ back
    links = -np.swapaxes(basis[:-1], 1, 2) @ basis[1:]
    top = [2 * len(blocks) - 1] * 2
    largest = scipy.linalg.eig_banded(_banded(blocks, links), eigvals_only=True, select="i", select_range=top)
    return float(np.sqrt(stiffness / mass * largest[-1]))


def _banded(blocks: Floats, links: Floats) -> Floats:
    """Upper diagonal form (4, 2 n) of a symmetric block tridiagonal matrix of 2 x 2 blocks."""
    count = len(blocks)
    band = np.zeros((4, 2 * count))
    band[3, 0::2], band[3, 1::2] = blocks[:, 0, 0], blocks[:, 1, 1]
    band[2, 1::2], band[2, 2::2] = blocks[:, 0, 1], links[:, 1, 0]
    band[1, 2::2], band[1, 3::2] = links[:, 0, 0], links[:, 1, 1]
    band[0, 3::2] = links[:, 0, 1]
    return band


def stable_step(method: str, frequency: float, *, damping: float = 0.0, mass: float = 1.0) -> float:
    """Largest stable step size of a scheme for modes up to the angular `frequency`, in units of time.

    With c = damping / mass, explicit Euler needs h < min(c / omega^2, 2 / c): undamped it has no stable step.  Its
    symplectic form has 2 / omega undamped, Runge-Kutta 2.83 / omega.  The implicit schemes have no limit: infinity.
    """
    scheme, c = Method(method), damping / mass
    if not frequency > 0.0:
        raise BadInputError(f"frequency is {frequency:g}; give a positive one, see largest_frequency")
    if scheme is Method.EXPLICIT_EULER:
        return min(c / frequency**2, 2.0 / c) if c > 0.0 else 0.0
    if scheme is Method.SYMPLECTIC_EULER:
        return float(np.sqrt(c * c + 4.0 * frequency**2) - c) / frequency**2
    return _runge_kutta(frequency, c) if scheme is Method.RUNGE_KUTTA else float("inf")


def _runge_kutta(frequency: float, c: float) -> float:
    """Bisect for the largest step at which the stability polynomial stays within the unit disc, for all modes."""
    modes = frequency * np.linspace(0.0, 1.0, MODES)
    root = np.sqrt((0.25 * c * c - modes**2).astype(complex))
    low, high = 0.0, 4.0 / frequency  # beyond the undamped limit of 2.83
    for _ in range(BISECTIONS):
        middle = 0.5 * (low + high)
        z = middle * np.concatenate([-0.5 * c + root, -0.5 * c - root])
        growth = np.abs(1.0 + z * (1.0 + z / 2.0 * (1.0 + z / 3.0 * (1.0 + z / 4.0))))
        low, high = (middle, high) if growth.max() <= 1.0 + ROUND_OFF else (low, middle)
    return low
