"""Flatten an annulus to the periodic rectangle by sparse harmonic systems whose weights even out the stretch."""

from __future__ import annotations

import igl
import numpy as np
from scipy.sparse.csgraph import dijkstra

from meshwind.chart.chart import Chart, signed_areas
from meshwind.chart.harmonic import EdgeGraph, harmonic
from meshwind.chart.reparametrise import canonical_u, even_speed
from meshwind.core.cast import Bools, Floats, Ints, frozen
from meshwind.core.errors import BadInputError
from meshwind.mesh.geometry.edge_graph import edge_graph
from meshwind.mesh.geometry.mesh import Annulus

EVEN = 1.15
"""Mean stretch (1 at best) up to which a chart is accepted at once: parts like a mandrel need no second solve."""
GAIN = 0.98
"""Re-weighting goes on while it brings the mean stretch below this share of the last one."""
ROUNDS = 8
"""Maximum number of times that the edges are re-weighted."""
EXPONENT = 0.5
"""Power of the area stretch by which weights are divided: 0.25 needs twice the rounds, 1 overshoots."""


def flatten(annulus: Annulus) -> Chart:
    """Map an annulus one to one to the periodic rectangle.

    Both coordinates solve a sparse Laplace equation on the mesh.  v is 0 on the start rim and 1 on the end rim; u has
    natural conditions at the rims and gains one turn across a cut, so that the twist between the ends comes out by
    itself and the cut leaves no trace.  At last v is spaced to a constant mean speed, and u turned to a canonical
    position.

    Parameters
    ----------
    annulus : Annulus
        Mesh with two rims, from `annulus`.

    Returns
    -------
    Chart
        Positions of all vertices in the rectangle, without flipped triangles.

    Raises
    ------
    BadInputError
        If a triangle still flips, which only degenerate triangles can bring about.

    Notes
    -----
    Weights are cotangents where these give an embedding and positive ones otherwise, which always do: the annulus
    mirrored into a torus is a discrete one-form embedding [1]_.  Where the map squeezes parts of the surface, weights
    are divided by the stretch and the systems solved again [2]_, which keeps them positive.

    References
    ----------
    .. [1] S. J. Gortler, C. Gotsman, D. Thurston, "Discrete one-forms on meshes and applications to 3D mesh
       parameterization", Computer Aided Geometric Design 23, 2006.
    .. [2] S. Yoshizawa, A. Belyaev, H.-P. Seidel, "A fast and simple stretch-minimizing mesh parameterization", Shape
       Modeling International, 2004.

    Examples
    --------
    >>> import meshwind as mw
    >>> chart = mw.flatten(mw.annulus(mw.read("data/elbow.obj")))
    >>> float(chart.uv[:, 1].min()), float(chart.uv[:, 1].max())
    (0.0, 1.0)
    """
    if not isinstance(annulus, Annulus):
        raise BadInputError(f"flatten takes an Annulus, not {type(annulus).__name__}; make one with annulus(mesh)")
    jump = _far_side(annulus, _seam(annulus)).astype(np.float64)
    graph = EdgeGraph.of(annulus, jump)
    weights = graph.cotangents
    uv = harmonic(annulus, graph, weights)
    corner = _corners(annulus, uv, jump)
    if (signed_areas(corner) <= 0).any():
        weights = graph.positive
        uv = harmonic(annulus, graph, weights, uv)
        corner = _corners(annulus, uv, jump)
        count = int((signed_areas(corner) <= 0).sum())
        if count:
            raise BadInputError(f"{count} triangles flip in the flattening; remesh the part without slivers")
    uv, corner = canonical_u(annulus, *_even_out_stretch(annulus, graph, weights, uv, corner, jump))
    area = signed_areas(corner)
    return Chart(annulus, frozen(uv), frozen(corner), int((area <= 0).sum()), frozen(_stretch(annulus, area)))


def _seam(annulus: Annulus) -> Ints:
    """Vertices of a shortest edge path from the start rim to the end rim that touches each rim once."""
    graph = edge_graph(annulus.vertices, annulus.faces)
    distance, previous, _ = dijkstra(graph, indices=annulus.rims[0], return_predecessors=True, min_only=True)
    path = [int(annulus.rims[1][np.argmin(distance[annulus.rims[1]])])]
    while previous[path[-1]] >= 0:
        path.append(int(previous[path[-1]]))
    return np.array(path[::-1], dtype=np.int64)


def _far_side(annulus: Annulus, path: Ints) -> Bools:
    """Corners (m, 3) at seam vertices whose triangle lies to the left of the seam, where u has gained a turn."""
    faces = annulus.faces
    first, second = faces, np.roll(faces, -1, axis=1)
    step = np.full(len(annulus.vertices), -1, dtype=np.int64)
    step[path[:-1]] = path[1:]
    forward, backward = step[first] == second, step[second] == first
    _, cut_faces, _ = igl.cut_mesh(annulus.vertices, faces, (forward | backward).astype(np.int64))
    touches = forward | np.roll(forward, 1, axis=1)
    return np.isin(cut_faces, cut_faces[touches])


def _even_out_stretch(
    annulus: Annulus, graph: EdgeGraph, weights: Floats, uv: Floats, corner: Floats, jump: Floats
) -> tuple[Floats, Floats]:
    """Space v evenly, and divide the weights by the stretch at their ends until the mean stretch stops decreasing."""
    space = igl.doublearea(annulus.vertices, annulus.faces) / 2
    faces, n = annulus.faces.ravel(), len(annulus.vertices)
    around = np.bincount(faces, np.repeat(space, 3), n)
    spaced = even_speed(annulus, uv, corner)
    stretch = _stretch(annulus, signed_areas(spaced[1]))
    for _ in range(ROUNDS):
        mean = float(np.average(stretch, weights=space))
        if mean < EVEN:
            break
        at = (np.bincount(faces, np.repeat(stretch * space, 3), n) / around) ** EXPONENT
        weights = np.maximum(weights, graph.positive) if (weights <= 0).any() else weights
        weights = weights / np.sqrt(at[graph.ends[:, 0]] * at[graph.ends[:, 1]])
        uv = trial = harmonic(annulus, graph, weights, uv)
        trial_corner = _corners(annulus, trial, jump)
        if (signed_areas(trial_corner) <= 0).any():
            break
        trial_spaced = even_speed(annulus, trial, trial_corner)
        trial_stretch = _stretch(annulus, signed_areas(trial_spaced[1]))
        if np.average(trial_stretch, weights=space) > GAIN * mean:
            break
        spaced, stretch = trial_spaced, trial_stretch
    return spaced


def _corners(annulus: Annulus, uv: Floats, jump: Floats) -> Floats:
    corner = uv[annulus.faces]
    corner[..., 0] += jump
    return corner


def _stretch(annulus: Annulus, area: Floats) -> Floats:
    """Area of each triangle on the part over that in the plane, divided by its mean."""
    space = igl.doublearea(annulus.vertices, annulus.faces) / 2
    return np.asarray(space / area * (area.sum() / space.sum()))
