"""The normal equations of a net that is fitted to an integral, by preconditioned conjugate gradients.

An integral over the surface is nearly the tensor product of two one-dimensional Gram matrices, scaled from place to
place by how densely the data lie.  With that as its preconditioner the iteration ends within some ten steps
whatever the size of the net, so that the cost is linear in the control points.
"""

import numpy as np
from scipy.linalg import cho_solve_banded, cholesky_banded

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.core.kernel_arrays import fill_table
from meshwind.core.vectors import TINY
from meshwind.surface.fitting.normal_equations import REACH, gram_bands


class TensorGram:
    """The scaled tensor product of the Gram matrices along u and v, factored once: an approximate inverse.

    Along u, where the net is periodic, it is inverted by a Fourier transform, along v by banded Cholesky.
    """

    def __init__(self, stencil: Floats) -> None:
        rows, columns = stencil.shape[:2]
        around, along = gram_bands(rows, True), gram_bands(columns - REACH, False)
        lower = np.zeros((REACH + 1, columns))
        for k in range(REACH + 1):
            lower[k, : columns - k] = along[k:, REACH - k]
        self._factor = cholesky_banded(lower, lower=True)
        circulant = np.zeros(rows)
        for k in range(-REACH, REACH + 1):
            circulant[k % rows] += around[0, REACH + k]
        self._spectrum = np.fft.rfft(circulant).real[:, None, None]
        self._scale = np.sqrt(around[0, REACH] * along[:, REACH] / stencil[:, :, 0, REACH])[..., None]

    def solve(self, right: Floats) -> Floats:
        """The approximate solution (nu, nv, m) for right sides (nu, nv, m)."""
        rows, columns, sides = right.shape
        turned = np.fft.irfft(np.fft.rfft(right * self._scale, axis=0) / self._spectrum, rows, axis=0)
        flat = np.ascontiguousarray(turned.transpose(1, 0, 2)).reshape(columns, -1)
        flat = cho_solve_banded((self._factor, True), flat, overwrite_b=True, check_finite=False)
        return np.asarray(flat.reshape(columns, rows, sides).transpose(1, 0, 2) * self._scale)


def solve_iteratively(stencil: Floats, right: Floats, tolerance: Floats, start: Floats, steps: int) -> Floats | None:
    """Solve for nets (nu, nv, m), each of the right sides (nu, nv, m) for itself; see `normal_equations.accumulate`.

    tolerance (m,): reduction of each residual against its right side, in the preconditioner's norm; start (nu, nv, m):
    nets near the answer.  None if so many steps do not suffice.
    """
    inverse, image = TensorGram(stencil), np.empty_like(right)
    enough = tolerance**2 * (right * inverse.solve(right)).sum(axis=(0, 1))
    net = start.copy()
    _multiply(stencil, net, image)
    rest = right - image
    ahead = inverse.solve(rest)
    way, size = ahead.copy(), (rest * ahead).sum(axis=(0, 1))
    for _ in range(steps):
        if np.all(size <= enough):
            return net
        _multiply(stencil, way, image)
        step = size / np.maximum((way * image).sum(axis=(0, 1)), TINY)
        net += step * way
        rest -= step * image
        ahead = inverse.solve(rest)
        before, size = size, (rest * ahead).sum(axis=(0, 1))
        way = ahead + size / np.maximum(before, TINY) * way
    return None


@njit(nogil=True, cache=True)
def _multiply(stencil, net, out):
    """Write the symmetric matrix of a stencil (nu, nv, 4, 7) times nets (nu, nv, m) into `out`."""
    rows, columns, sides = net.shape
    for row in out:
        fill_table(row, 0.0)
    for i in range(rows):
        for r in range(REACH + 1):
            far = (i + r) % rows
            for j in range(columns):
                for s in range(0 if r > 0 else REACH, 2 * REACH + 1):
                    k = j + s - REACH
                    if k < 0 or k >= columns:
                        continue
                    a = stencil[i, j, r, s]
                    for c in range(sides):
                        out[i, j, c] += a * net[far, k, c]
                        if r > 0 or s > REACH:
                            out[far, k, c] += a * net[i, j, c]
