"""Flat ends of a closed part, such as the caps of a cylinder: a ring of them is left about the opening."""

import numpy as np

from meshwind.mesh.geometry.areas_and_volumes import area_vectors
from meshwind.mesh.geometry.mesh import Annulus

_FLAT = np.cos(np.radians(3.0))
"""Least cosine of the angle between the facets beside an opening and their mean: those of domes turn by far more."""


def has_flat_ends(annulus: Annulus) -> bool:
    """Whether an opening was cut into a flat end."""
    for rim in annulus.rims:
        if annulus.trusted[rim].all():
            continue  # open in the file
        beside = np.isin(annulus.faces, rim).any(axis=1)
        across = area_vectors(annulus.vertices, annulus.faces[beside])
        mean = across.sum(axis=0)
        turn = across @ mean / (np.linalg.norm(across, axis=1) * max(float(np.linalg.norm(mean)), 1e-300))
        if turn.min() > _FLAT:
            return True
    return False
