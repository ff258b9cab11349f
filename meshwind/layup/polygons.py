"""Polygons of any size split into quads and triangles."""

import numpy as np

from meshwind.core.cast import Floats, Ints


def split(polygons: list[Ints], points: Floats) -> tuple[Ints, Ints]:
    """Quads (q, 4) and triangles (t, 3) that fill polygons (m, n), each with n >= 3 corners.

    A pentagon gives a quad and a triangle, cut where the quad comes out best; larger ones give a fan.
    """
    quads, triangles = [np.zeros((0, 4), dtype=np.int64)], [np.zeros((0, 3), dtype=np.int64)]
    for polygon in polygons:
        n = polygon.shape[1]
        if n == 4:
            quads.append(polygon)
        elif n == 5:
            best = _best_start(polygon, points)
            polygon = np.take_along_axis(polygon, (best[:, None] + np.arange(5)) % 5, axis=1)
            quads.append(polygon[:, :4])
            triangles.append(polygon[:, [0, 3, 4]])
        else:
            triangles.extend(polygon[:, [0, k, k + 1]] for k in range(1, n - 1))
    return np.concatenate(quads), np.concatenate(triangles)


def _best_start(pentagons: Ints, points: Floats) -> Ints:
    """Where to start each pentagon so that its first four corners make the squarest quad."""
    quality = [_squareness(points[np.roll(pentagons, -k, axis=1)[:, :4]]) for k in range(5)]
    return np.asarray(np.argmax(quality, axis=0))


def _squareness(corners: Floats) -> Floats:
    """Smallest sine of the corner angles of quads (m, 4, 3), signed by the quad's own normal."""
    ahead = np.roll(corners, -1, axis=1) - corners
    behind = np.roll(corners, 1, axis=1) - corners
    normal = np.cross(corners[:, 2] - corners[:, 0], corners[:, 3] - corners[:, 1])
    sine = (np.cross(ahead, behind) * normal[:, None]).sum(axis=2)
    scale = np.linalg.norm(ahead, axis=2) * np.linalg.norm(behind, axis=2)
    scale *= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.asarray(np.divide(sine, scale, out=np.full_like(sine, -1.0), where=scale > 0).min(axis=1))
