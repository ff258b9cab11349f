"""What a redesign must not move: control points, or a region of the surface in words such as "v<0.1, z>20"."""

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial import cKDTree

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.editing.stencil import lattice, weights
from meshwind.mesh.io.scalars import Scalars
from meshwind.surface.surface import Surface
from meshwind.workflow.option_checks import FIELD

SAMPLES_PER_SPAN = 6
"""Samples of the surface per span and direction: a control point that moves any sample of the region is frozen."""
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?"
_RANGE = re.compile(rf"(?:({_NUMBER})<)?([uvxyz])(?:([<>])({_NUMBER}))?", re.IGNORECASE)
FACES = "faces:"
"""Before numbers of faces of the mesh, as in 3 or 3-17, or the name of a file that lists them."""
_NUMBERS = re.compile(r"(\d+)(?:-(\d+))?")
_ADVICE = (
    f'give ranges of u, v, x, y or z by commas, as in "v<0.1, 20<z<35 & x>0", {FIELD}NAME for a scalar of the mesh '
    f"file, or {FACES}3-17 or {FACES}FILE for faces by their numbers"
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
    """All points that lie in one of the boxes, where a scalar of the mesh file is above 0, or on picked faces.

    boxes: each of ranges that hold all; field: name of the scalar, "" without one; faces (k,): numbers of picked faces;
    text: the region as it was given.
    """

    boxes: tuple[tuple[Range, ...], ...]
    field: str
    faces: Ints
    text: str

    def control_points(self, surface: Surface, uv: Floats, scalars: Scalars | None = None) -> Bools:
        """Mask (nu, nv) of the control points that the surface within the region depends on.

        uv (n, 2): parameters of points in it, beside those of a lattice over the whole surface.  Raises BadInputError
        where the region is empty.
        """
        samples = lattice(surface, SAMPLES_PER_SPAN)
        inside = samples[self.contains(samples, surface.points(samples), scalars)]
        inside = np.concatenate([inside, uv])
        if not len(inside):
            raise BadInputError(f"freeze {self.text!r} contains no point of the part; {_ADVICE}")
        which, _ = weights(surface, inside, ((0, 0),))
        mask = np.zeros(surface.control_points.shape[:2], dtype=bool)
        mask.reshape(-1)[which] = True
        return mask

    @property
    def parts(self) -> tuple["Region", ...]:
        """A region of each of its terms."""
        terms = [term.strip() for term in self.text.split(",")]
        return tuple(parse(term) for term in terms)

    def contains(self, uv: Floats, points: Floats, scalars: Scalars | None) -> Bools:
        """Mask (k,) of the points (k, 3) that lie in a box or where the scalar is above 0; uv (k, 2) may be NaN."""
        inside = np.zeros(len(uv), dtype=bool)
        for box in self.boxes:
            inside |= np.all([each.contains(uv, points) for each in box], axis=0)
        if scalars is not None and self.field:
            inside |= scalars.values[cKDTree(scalars.points).query(points)[1]] > 0.0
        return inside


def parse(text: str) -> Region:
    """Understand ranges, a field and faces, separated by commas; raises BadInputError for anything else."""
    if not isinstance(text, str):
        raise BadInputError(f"freeze is {text!r}; {_ADVICE}")
    boxes, field, faces = [], "", list[Ints]()
    for term in (term.strip() for term in text.split(",")):
        if term.startswith(FIELD) and term.removeprefix(FIELD).strip() and not field:
            field = term.removeprefix(FIELD).strip()
        elif term.startswith(FACES):
            faces.append(_faces(term.removeprefix(FACES).strip(), text))
        else:
            boxes.append(tuple(_range(each, text) for each in term.replace(" ", "").split("&")))
    return Region(tuple(boxes), field, np.concatenate([*faces, np.zeros(0, dtype=np.int64)]), text)


def _faces(term: str, text: str) -> Ints:
    """Numbers (k,) of faces: one, as in 7, several, as in 7-20, or those that a file lists."""
    found = _NUMBERS.fullmatch(term)
    if found is not None:
        first, last = int(found[1]), int(found[2] or found[1])
        if last >= first:
            return np.arange(first, last + 1)
    elif term:
        try:
            words = Path(term).read_text(encoding="utf-8").replace(",", " ").split()
            return np.array([int(word) for word in words], dtype=np.int64)
        except (OSError, ValueError) as error:
            raise BadInputError(f"{FACES}{term} is no file of whole numbers ({error}); {_ADVICE}") from error
    raise BadInputError(f"freeze is {text!r}; {_ADVICE}")


def _range(term: str, text: str) -> Range:
    found = _RANGE.fullmatch(term)
    if found is None or not (found[1] or found[3]) or (found[1] and found[3] == ">"):
        raise BadInputError(f"freeze is {text!r}; {_ADVICE}")
    bound = float(found[4]) if found[3] else np.inf
    low = float(found[1]) if found[1] else bound if found[3] == ">" else -np.inf
    return Range(found[2].lower(), low, np.inf if found[3] == ">" else bound)
