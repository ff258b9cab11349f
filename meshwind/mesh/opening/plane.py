"""Open an end by a plane square to the part's axis, and compare the rims that different cuts leave."""

from dataclasses import dataclass, replace

import numpy as np

from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.vectors import unit
from meshwind.mesh.geometry.areas_and_volumes import areas, edge_lengths, loop_area_vector, loop_centroid
from meshwind.mesh.geometry.topology import boundary, components, edges, euler, loops
from meshwind.mesh.opening.curved_facets import CurvedFacets, edge_points, split_edges
from meshwind.mesh.opening.cut_opening import pinched, split_where, without_unused

_SHALLOW, _DEEPEST = 1e-4, 1.0 / 3.0
"""Depths of the plane below the pole that are tried, over the distance of the ends."""
_BELOW = 0.01
"""Over that distance, how far below a flat end the plane lies: an opening as small as is wanted does not fit there."""
FLAT = 1.2
"""The end is flat where the shallowest rim is wider than is wanted by this factor."""
_STEPS = 16
"""Steps in which the depth is found, to 1e-4 of itself."""
_FINEST = 0.5
"""Longest edge near the rim over its radius."""
_ROUNDS = 40


@dataclass(frozen=True)
class Rim:
    """A rim, as points (k, 3) in their order."""

    points: Floats

    @property
    def radius(self) -> float:
        """Radius of the circle with the area that the rim encloses."""
        return float(np.sqrt(np.linalg.norm(self._area) / np.pi))

    @property
    def _area(self) -> Floats:
        return loop_area_vector(self.points, np.arange(len(self.points)))

    def unevenness(self, pole: Floats, outward: Floats) -> float:
        """How far the rim is off a plane, root mean square, and its middle off the axis, over its radius.

        The axis runs along `outward` through the pole.
        """
        following = np.roll(self.points, -1, axis=0)
        weight = np.linalg.norm(following - self.points, axis=1)
        centre = loop_centroid(self.points, np.arange(len(self.points)))
        height = (0.5 * (self.points + following) - centre) @ unit(self._area)
        off = centre - pole
        off = off - (off @ outward) * outward
        return float(np.hypot(np.sqrt(weight @ height**2 / weight.sum()), np.linalg.norm(off))) / self.radius


def new_rim(before: CurvedFacets, after: CurvedFacets) -> Rim:
    """The rim that a cut has left: the one with points that were on no rim."""
    old = set(map(tuple, before.vertices[np.unique(boundary(before.faces))].tolist()))
    rims = [after.vertices[rim] for rim in loops(after.faces)]
    return Rim(next(rim for rim in rims if not old.issuperset(map(tuple, rim.tolist()))))


def linked(faces: Ints, mask: Bools, seeds: Ints) -> Bools:
    """The vertices of the mask (n,) that are connected, within it, with one of the seeds in it."""
    ends = edges(faces).ends
    ends = ends[mask[ends].all(axis=1)]
    label = components(len(mask), ends[:, 0], ends[:, 1])
    return np.asarray(mask & np.isin(label, label[seeds[mask[seeds]]]))


@dataclass(frozen=True)
class Plane:
    """A plane square to the axis of an end with a pole (3,), `depth` below it; outward (3,): a unit vector out of it.

    other (3,): the pole at the other end, which must stay; most: area that may be cut off.
    """

    pole: Floats
    outward: Floats
    other: Floats
    most: float
    depth: float = 0.0

    def height(self, points: Floats) -> Floats:
        """Heights (n,) of points (n, 3) above the plane."""
        return np.asarray((points - self.pole) @ self.outward + self.depth)

    def beyond(self, surface: CurvedFacets) -> Bools:
        """Mask (n,) of the vertices above the plane that are connected with the one nearest to the pole."""
        above = self.height(surface.vertices) > 0.0
        away = np.where(above, np.linalg.norm(surface.vertices - self.pole, axis=1), np.inf)
        return linked(surface.faces, above, np.argmin(away, keepdims=True))


def opened_by_plane(surface: CurvedFacets, plane: Plane, radius: float) -> CurvedFacets | None:
    """Cut off the end at the pole by a plane so deep that its rim is as wide as `radius`.

    On a flat end, where the rim is wider than that as soon as there is one, the plane lies a hundredth of the part
    below it.  None where no plane cuts off a disc that is clear of rims and of the other pole, and not too large.
    """
    length = float(abs((plane.pole - plane.other) @ plane.outward))
    low, high = _SHALLOW * length, _DEEPEST * length
    best: tuple[CurvedFacets, float] | None = None
    for _ in range(_STEPS):
        middle = replace(plane, depth=float(np.sqrt(low * high)))
        cut, too_much = _cut(surface, middle, radius)
        wide = 0.0 if cut is None else new_rim(surface, cut).radius
        if cut is not None and wide >= radius:
            high, best = middle.depth, (cut, wide)
        elif too_much:
            high = middle.depth
        else:
            low = middle.depth
    if best is None:
        return None
    if best[1] > FLAT * radius:
        return _cut(surface, replace(plane, depth=high + _BELOW * length), radius)[0] or best[0]
    return best[0]


def _cut(surface: CurvedFacets, plane: Plane, radius: float) -> tuple[CurvedFacets | None, bool]:
    """The surface cut at the plane, None where it leaves no rim; and whether what lies beyond it is too much."""
    beyond = plane.beyond(surface)
    inside = beyond[surface.faces]
    if areas(surface.vertices, surface.faces[inside.all(axis=1)]).sum() > plane.most or plane.height(plane.other) > 0.0:
        return None, True
    if not beyond.any():
        return None, False
    touched = np.zeros(len(beyond), dtype=bool)
    touched[surface.faces[inside.any(axis=1)]] = True
    near = touched[surface.faces].any(axis=1)  # a ring more, so that refining leaves no hanging vertex
    fine, beyond = _refined(replace(surface, faces=surface.faces[near]), plane, beyond, radius)
    rims = np.unique(boundary(fine.faces))
    parted, side = split_where(fine, plane.height, beyond)
    removed = (side[parted.faces] >= 0).all(axis=1)
    disc, left = parted.faces[removed], parted.faces[~removed]
    if len(disc) == 0 or np.isin(disc, rims).any() or euler(disc) != 1 or pinched(left, disc):
        return None, False
    if areas(parted.vertices, disc).sum() > plane.most:
        return None, True
    return without_unused(replace(parted, faces=np.concatenate([surface.faces[~near], left]))), False


def _refined(surface: CurvedFacets, plane: Plane, beyond: Bools, radius: float) -> tuple[CurvedFacets, Bools]:
    """Halve long edges of the faces that the plane crosses; also gives the vertices beyond it."""
    for _ in range(_ROUNDS):
        inside = plane.height(surface.vertices)[surface.faces] > 0.0
        crossed = np.flatnonzero(inside.any(axis=1) & ~inside.all(axis=1) & beyond[surface.faces].any(axis=1))
        long = edge_lengths(surface.vertices, surface.faces[crossed]) > _FINEST * radius
        if not long.any():
            break
        found = edges(surface.faces)
        cut = found.ends[np.unique(found.of_face[crossed][long])]
        count = len(surface.vertices)
        surface = split_edges(surface, cut, edge_points(surface, cut, np.full(len(cut), 0.5)))
        # the middle of an edge goes with its ends
        beyond = np.concatenate([beyond, beyond[cut].any(axis=1) & (plane.height(surface.vertices[count:]) > 0.0)])
    return surface, beyond
