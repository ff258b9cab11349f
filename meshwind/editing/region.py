"""What a redesign must not move: control points, or a region of the surface in words such as "v<0.1, z>20"."""

import re
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Bools, Floats
from meshwind.core.errors import BadInputError
from meshwind.editing.freedom import Frozen
from meshwind.editing.stencil import weights
from meshwind.mesh import Annulus
from meshwind.mesh.io.scalars import Scalars
from meshwind.surface.surface import Surface
from meshwind.workflow.option_checks import FIELD
from meshwind.workflow.part import MeshLike, on_wound_skin, read_field

SAMPLES_PER_SPAN = 6
"""Samples of the surface per span and direction: a control point that moves any sample of the region is frozen."""
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_RANGE = re.compile(rf"(?:({_NUMBER})<)?([uvxyz])(?:([<>])({_NUMBER}))?", re.IGNORECASE)
_ADVICE = (
    f'give ranges of u, v, x, y or z by commas, as in "v<0.1, 20<z<35", or {FIELD}NAME for a scalar of the mesh file'
)


@dataclass(frozen=True)
class Range:
    """Where a coordinate lies between two numbers: u and v of the plane, x, y and z in the mesh's units."""

    name: str
    low: float
    high: float

    def contains(self, uv: Floats, points: Floats) -> Bools:
        """Mask (k,) of the points (k, 3), with parameters uv (k, 2), that lie in it."""
        value = uv[:, 0] % 1.0 if self.name == "u" else uv[:, 1] if self.name == "v" else None
        value = points[:, "xyz".index(self.name)] if value is None else value
        return np.asarray((value > self.low) & (value < self.high))


@dataclass(frozen=True)
class Region:
    """All points that lie in one of the ranges, or where a scalar of the mesh file is above 0.

    field: name of the scalar, "" without one; text: the region as it was given.
    """

    ranges: tuple[Range, ...]
    field: str
    text: str

    def control_points(self, surface: Surface, uv: Floats, scalars: Scalars | None = None) -> Bools:
        """Mask (nu, nv) of the control points that the surface within the region depends on.

        uv (n, 2): parameters of points that are looked at beside a lattice over the whole surface, such as the mesh's
        vertices.  Raises BadInputError where the region is empty.
        """
        samples = self._samples(surface, uv)
        inside = self._contains(samples, surface.points(samples), scalars)
        if not inside.any():
            raise BadInputError(f"freeze {self.text!r} contains no point of the part; {_ADVICE}")
        which, _ = weights(surface, samples[inside], ((0, 0),))
        mask = np.zeros(surface.control_points.shape[:2], dtype=bool)
        mask.reshape(-1)[which] = True
        return mask

    @property
    def parts(self) -> tuple["Region", ...]:
        """A region of each range, and that of the field."""
        terms = [term.strip() for term in self.text.split(",")]
        return tuple(parse(term) for term in terms)

    def touches(self, surface: Surface, uv: Floats, scalars: Scalars | None) -> bool:
        """Whether a point of the part lies in it."""
        samples = self._samples(surface, uv)
        return bool(self._contains(samples, surface.points(samples), scalars).any())

    def _samples(self, surface: Surface, uv: Floats) -> Floats:
        around, along = (SAMPLES_PER_SPAN * spans for spans in surface.spans)
        u, v = np.meshgrid(np.arange(around) / around, np.linspace(0.0, 1.0, along + 1), indexing="ij")
        return np.concatenate([np.stack([u.ravel(), v.ravel()], axis=1), uv])

    def _contains(self, uv: Floats, points: Floats, scalars: Scalars | None) -> Bools:
        inside = np.zeros(len(uv), dtype=bool)
        for each in self.ranges:
            inside |= each.contains(uv, points)
        if scalars is not None:
            inside |= scalars.values[cKDTree(scalars.points).query(points)[1]] > 0.0
        return inside


def parse(text: str) -> Region:
    """Understand ranges and a field, separated by commas; raises BadInputError for anything else."""
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


@dataclass(frozen=True)
class FrozenPart:
    """What must not move: as it was given, or a region with the scalars of its field."""

    given: Frozen
    region: Region | None = None
    scalars: Scalars | None = None

    def on(self, surface: Surface, uv: Floats) -> Frozen:
        """The same for the control points of a surface; uv as in `Region.control_points`."""
        return self.given if self.region is None else self.region.control_points(surface, uv, self.scalars)

    def on_skin(self, annulus: Annulus) -> "FrozenPart":
        """The same with the scalars of the skin that is wound, if the part has a wall."""
        return self if self.scalars is None else replace(self, scalars=on_wound_skin(self.scalars, annulus))

    def named(self, surface: Surface, uv: Floats) -> dict[str, Bools] | None:
        """Masks of control points by each range and field, as they were given; None where it is no region."""
        if self.region is None:
            return None
        return {
            each.text: each.control_points(surface, uv, self.scalars if each.field else None)
            for each in self.region.parts
            if each.touches(surface, uv, self.scalars if each.field else None)
        }

    @property
    def on_any_surface(self) -> bool:
        """Whether it means something on another control net, as a mask does not."""
        return self.region is not None or self.given is None or callable(self.given)


def frozen_part(frozen: Frozen | str, mesh: MeshLike) -> FrozenPart:
    """Understand what must not move; reads the mesh's file where that is a scalar of it."""
    if not isinstance(frozen, str):
        return FrozenPart(frozen)
    region = parse(frozen)
    if not region.field:
        return FrozenPart(None, region)
    return FrozenPart(None, region, read_field(mesh, region.field, "give a mask of control points"))
