"""Tell the outside of a hollow part from its inside, roughly: from what its faces see and what lies behind them."""

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.mesh.walls.face_graph import FaceGraph
from meshwind.mesh.walls.sight import Sight

OUTER, RIM, INNER = 1, 0, -1
"""Labels of faces: of the outer skin, of the rims between the skins, of the inner skin."""
_SAMPLES, _FEW, _FEWEST = 6000, 2000, 500
"""Faces whose sky view factor is computed, by area: to find the sides, whether there are any, and whether to ask."""
_HOLLOW = (-0.2, 0.15)
"""A part is hollow where this share of its surface has a sky view factor so much less than the face behind it.

Samples: 0.25 to 0.5 on pipes, rings and bottles; below 0.1 on solid parts, 0.2 on one with wings close to its body.
"""
_HARDLY = (-0.1, 0.03)
"""The same for a part with a hole right through: of a block with a bore, little is inside."""
_SMOOTH = 0.015
"""Over area / diagonal, about a fifth of the radius of a pipe: what the sides are smoothed over."""
_CREASE = np.cos(np.radians(30.0))
"""Faces that turn by more than this about a convex edge ..."""
_LOOSE = 0.05
"""... are linked by this share: sides change at creases rather than beside them."""


def hollow(sight: Sight, area: Floats, hardly: bool) -> bool:
    """Whether much of the surface is the inside of a hollow; with `hardly`, whether any is."""
    least, share = _HARDLY if hardly else _HOLLOW
    for count, enough in ((_FEWEST, share / 3.0), (_FEW, share)):
        chosen, worth = _sampled(area, count)
        darker, seen = _contrast(sight, chosen, len(area))
        if worth[seen & (darker < least)].sum() <= enough * worth.sum():
            return False
    return True


def sides(sight: Sight, graph: FaceGraph) -> Ints:
    """OUTER or INNER (m,) for each face; each in one piece, if there are any.

    Of the faces on both sides of a wall the outer one has the larger sky view factor, however small: the difference,
    smoothed over the surface, has a sign.
    """
    chosen, worth = _sampled(graph.area, _SAMPLES)
    darker, seen = _contrast(sight, chosen, len(graph.area))
    one, two = graph.first, graph.second
    turn = np.einsum("ij,ij->i", sight.normals[one], sight.normals[two])
    convex = np.einsum("ij,ij->i", sight.middles[two] - sight.middles[one], sight.normals[one]) < 0.0
    link = np.where(convex & (turn < _CREASE), _LOOSE, 1.0)
    total = float(graph.area.sum())
    smooth = _SMOOTH * total / sight.diagonal
    if not seen.any():
        return np.full(len(graph.area), OUTER)
    pull = worth * seen * total / smooth**2
    label = np.where(graph.smoothed(darker, pull, link) > 0.0, OUTER, INNER)
    for side in (INNER, OUTER):  # what is left of a side beside its largest piece belongs to the other
        mask = label == side
        label[mask & ~graph.largest(mask)] = -side
    return label


def _sampled(area: Floats, count: int) -> tuple[Ints, Floats]:
    """Some faces at even intervals of area, or all where these are not more; the share of area (m,) of each."""
    if len(area) <= count:
        return np.arange(len(area)), area / area.sum()
    share = np.cumsum(area) / area.sum()
    picks = np.minimum(np.searchsorted(share, (np.arange(count) + 0.5) / count), len(area) - 1)
    worth = np.bincount(picks, minlength=len(area)) / count
    return np.flatnonzero(worth), worth


def _contrast(sight: Sight, chosen: Ints, count: int) -> tuple[Floats, Bools]:
    """Difference (m,) of the sky view factors of a face and the one behind it, and where (m,) it is known."""
    behind, _ = sight.behind(chosen)
    front, behind = chosen[behind >= 0], behind[behind >= 0]
    viewing = np.union1d(front, behind)
    sky = np.zeros(count)
    sky[viewing] = sight.sky_view(viewing)
    facing = np.maximum(0.0, -np.einsum("ij,ij->i", sight.normals[front], sight.normals[behind]))
    value, seen = np.zeros(count), np.zeros(count, dtype=bool)
    value[front] = (sky[front] - sky[behind]) * facing
    seen[front] = True
    return value, seen
