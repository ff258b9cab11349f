"""The error of a fit: distances both ways between the surface and the mesh."""

import numpy as np

from meshwind.core.cast import Floats
from meshwind.core.kernel import njit
from meshwind.core.threads import parallel_for
from meshwind.surface.evaluate import Spline, position
from meshwind.surface.fitting.samples import Samples
from meshwind.surface.surface import FitError, Surface

DENSITY, MOST = 4, 256
"""Samples per span, and maximum number of samples, in each direction."""
WORST, FINER = 40, 9
"""Number of the worst samples around which the distance is sampled again, on FINER x FINER points of their own cell."""


def certify(surface: Surface, samples: Samples) -> FitError:
    """Distances of the trusted vertices to the surface, and of a dense sample of the surface to the facets.

    The surface is about the samples' middle.  The distance is sampled again around the worst samples, so that its
    maximum is true to a few per cent.
    """
    _, distance = samples.corrected(surface)
    distance = distance[samples.trusted]
    to_facets, largest = to_mesh(surface, samples)
    return FitError(
        to_surface_rms=float(np.sqrt(np.mean(distance**2))),
        to_surface_max=float(distance.max()),
        to_mesh_rms=float(np.sqrt(np.mean(to_facets**2))),
        to_mesh_max=largest,
        diagonal=samples.chart.annulus.mesh.diagonal,
    )


def to_mesh(surface: Surface, samples: Samples) -> tuple[Floats, float]:
    """Distances of an even sample of the surface to the facets, and the largest, sampled more closely."""
    counts = np.minimum(DENSITY * np.array(surface.spans), MOST)
    u, v = np.meshgrid(np.arange(counts[0]) / counts[0], np.linspace(0, 1, counts[1] + 1), indexing="ij")
    uv = np.stack([u.ravel(), v.ravel()], axis=1)
    distance = samples.facets.distances(_points(surface, uv))
    worst = uv[np.argsort(-distance, kind="stable")[:WORST]]
    step = np.linspace(-0.5, 0.5, FINER)
    offset = np.stack(np.meshgrid(step, step), axis=-1).reshape(-1, 2) / counts
    closer = (worst[:, None] + offset).reshape(-1, 2)
    closer[:, 1] = np.clip(closer[:, 1], 0.0, 1.0)
    return distance, max(float(distance.max()), float(samples.facets.distances(_points(surface, closer)).max()))


def _points(surface: Surface, uv: Floats) -> Floats:
    """Positions (n, 3) at uv (n, 2), in a third of the time that they take with derivatives."""
    out = np.empty((len(uv), 3))
    parallel_for(_positions, len(uv), 10_000, surface.spline, uv, out)
    return out


@njit(nogil=True, cache=True)
def _positions(first: int, last: int, spline: Spline, uv: Floats, out: Floats) -> None:
    for i in range(first, last):
        position(spline, uv[i, 0], uv[i, 1], out[i])
