"""A part of the surface in words, "v<0.1, z>20": where a redesign must change nothing."""

import re
from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.editing.stencil import weights
from meshwind.mesh.io.scalars import Scalars
from meshwind.surface.surface import Surface

FIELD = "field:"
"""Before the name of a scalar of the mesh file: the region is where it is above 0."""
PER_SPAN = 6
"""Samples of the surface a span and direction: a control point that moves any sample of the region stays."""
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_RANGE = re.compile(rf"(?:({_NUMBER})<)?([uvxyz])(?:([<>])({_NUMBER}))?", re.IGNORECASE)
_ADVICE = (
    'give ranges of u, v, x, y or z by commas, as in "v<0.1, 20<z<35", or field:NAME for a scalar of the mesh file'
)


@dataclass(frozen=True)
class Range:
    """Where a coordinate lies between two numbers: u and v of the plane, x, y and z in the mesh's units."""

    name: str
    low: float
    high: float

    def holds(self, uv: Floats, points: Floats) -> Bools:
        """Mask (k,) of the places uv (k, 2), at points (k, 3), that lie in it."""
        value = uv[:, 0] % 1.0 if self.name == "u" else uv[:, 1] if self.name == "v" else None
        value = points[:, "xyz".index(self.name)] if value is None else value
        return np.asarray((value > self.low) & (value < self.high))


@dataclass(frozen=True)
class Region:
    """All places that lie in one of the ranges, or where a field of the mesh file is above 0; text is how it was told.

    field: name of the scalar, "" without one.
    """

    ranges: tuple[Range, ...]
    field: str
    text: str

    def control_points(self, surface: Surface, uv: Floats, scalars: Scalars | None = None) -> Bools:
        """Mask (nu, nv) of the control points that the surface within the region hangs on.

        uv (n, 2): places that count beside a lattice over the whole surface, such as the vertices'.  Raises
        BadInputError where the region is empty.
        """
        around, along = (PER_SPAN * spans for spans in surface.spans)
        u, v = np.meshgrid(np.arange(around) / around, np.linspace(0.0, 1.0, along + 1), indexing="ij")
        places = np.concatenate([np.stack([u.ravel(), v.ravel()], axis=1), uv])
        inside = self._holds(places, surface.points(places), scalars)
        if not inside.any():
            raise BadInputError(f"freeze {self.text!r} holds nothing of the part; {_ADVICE}")
        which, _ = weights(surface, places[inside], ((0, 0),))
        mask = np.zeros(surface.control_points.shape[:2], dtype=bool)
        mask.reshape(-1)[which] = True
        return mask

    def _holds(self, uv: Floats, points: Floats, scalars: Scalars | None) -> Bools:
        inside = np.zeros(len(uv), dtype=bool)
        for each in self.ranges:
            inside |= each.holds(uv, points)
        if scalars is not None:
            inside |= scalars.values[cKDTree(scalars.points).query(points)[1]] > 0.0
        return inside


def parse(text: str) -> Region:
    """The region that a text tells of; raises BadInputError with what may be said."""
    if not isinstance(text, str):
        raise BadInputError(f"freeze is {text!r}; {_ADVICE}")
    ranges, field = [], ""
    for term in (term.strip() for term in text.split(",")):
        if term.startswith(FIELD) and term.removeprefix(FIELD).strip() and not field:
            field = term.removeprefix(FIELD).strip()
        else:
            ranges.append(_range(term.replace(" ", ""), text))
    return Region(tuple(ranges), field, text)


def _range(term: str, text: str) -> Range:
    found = _RANGE.fullmatch(term)
    if found is None or not (found[1] or found[3]) or (found[1] and found[3] == ">"):
        raise BadInputError(f"freeze is {text!r}; {_ADVICE}")
    bound = float(found[4]) if found[3] else np.inf
    low = float(found[1]) if found[1] else bound if found[3] == ">" else -np.inf
    return Range(found[2].lower(), low, np.inf if found[3] == ">" else bound)
