"""Scenes of the crossings, the slip, the quad mesh and the unrolled part."""

import numpy as np
from scipy.spatial import cKDTree

from meshwind.appearance.looks import Look, Scale, fixed
from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats
from meshwind.path.apart import to_next
from meshwind.path.lengths import bridging, lengths
from meshwind.pictures.scenes import CrossingsScene, QuadsScene, SlipScene, UnrolledScene
from meshwind.pictures.subject import Subject
from meshwind.pictures.winding_scene import fibres
from meshwind.results.schema import DEGREES
from meshwind.surface.image import surface_image

ANGLE = Look("crossing angle", "angle between\nthe families", DEGREES, "viridis", fixed(0.0, 90.0), step=15.0)
_ROOM = 0.45
"""Radius of a disc over the distance to the nearest other, at most."""
NO_SLIP = 1e-6
"""Slip below this is round-off: the fibre is a geodesic."""
_BINS = 20
"""Bars of the histogram of slip."""
_PIXELS = 384


def crossings_scene(of: Subject) -> CrossingsScene:
    """Crossings of the two families, coloured by their angle."""
    crossings = of.layup.crossings
    angle = np.degrees(crossings.angle)
    scale = ANGLE.scale(angle, of.units)
    subtitle = "the families do not cross"
    if len(crossings):
        low, usual, high = np.quantile(angle, [0.0, 0.5, 1.0])
        subtitle = f"{len(crossings)} crossings at {low:.0f}° to {high:.0f}°, half of them above {usual:.0f}°"
    normals = of.paths.surface.normals(crossings.uv) if len(crossings) else np.zeros((0, 3))
    frame = of.frame(f"{of.name}: angle at which the families cross", subtitle)
    points = crossings.points
    return CrossingsScene(frame, of.part, fibres(of), scale, scale.shares(angle), points, normals, room(points))


def room(points: Floats) -> Floats:
    """Radius (n,) up to which balls round points (n, 3) keep apart: nearly half the way to the nearest other."""
    if len(points) < 2:
        return np.full(len(points), np.inf)
    return np.asarray(_ROOM * cKDTree(points).query(points, k=2)[0][:, 1])


def quads_scene(of: Subject) -> QuadsScene:
    """The quad mesh: quads, triangles at the rims, and the corners that lie off the surface."""
    mesh = of.layup.quads
    off = int((~mesh.on_surface).sum())
    where = "every corner on the surface"
    if off:
        where = f"{off} of {len(mesh.points)} corners off the surface"
    flat = quantity(_bulge(of), of.units, 2)
    subtitle = f"{len(mesh.quads)} quads, {len(mesh.triangles)} triangles  ·  {where}  ·  the part up to {flat} away"
    if not len(mesh.quads) + len(mesh.triangles):
        subtitle = f"no quad mesh: {mesh.note}" if mesh.note else "no quad mesh"
    frame = of.frame(f"{of.name}: quad mesh on the crossings", subtitle)
    return QuadsScene(frame, of.part, mesh.points, ~mesh.on_surface, mesh.quads, mesh.triangles)


def _bulge(of: Subject) -> float:
    """Largest distance of the part from the middles of the quads, square to the part."""
    mesh, surface = of.layup.quads, of.paths.surface
    corners = mesh.uv[mesh.quads]
    # corners across the seam are as near as those on the same side of it
    u = corners[..., 0] - np.round(corners[..., 0] - corners[:, :1, 0])
    uv = np.stack([np.mod(u.mean(axis=1), 1.0), corners[..., 1].mean(axis=1)], axis=1)
    away = surface.points(uv) - mesh.points[mesh.quads].mean(axis=1)
    return float(np.abs(np.einsum("qk,qk->q", away, surface.normals(uv))).max(initial=0.0))


def slip_scene(of: Subject) -> SlipScene:
    """Converged fibres by required friction; NaN where it is not defined: off the surface and at the ends."""
    friction, most = of.paths.friction, of.figures.max_slip
    end = max(friction, most) if max(friction, most) > NO_SLIP else 0.0
    scale = Scale(("slip:", "friction", "needed"), "viridis", 0.0, end or 1.0)
    return SlipScene(
        frame=of.frame(f"{of.name}: slip of the fibres", _slip_subtitle(of, end)),
        part=of.part,
        fibres=fibres(of),
        scale=scale,
        shares=scale.shares(of.paths.slip[:, of.kept]),
        needed=end > 0.0,
        bridges=not bool(of.paths.on_surface.all()),
        bins=_bins(of, scale),
        limit=float(scale.shares(np.array([friction]))[0]) if friction else 0.0,
    )


def _bins(of: Subject, scale: Scale) -> Floats:
    """Shares of the length of converged fibre that touches, by its slip, on equal parts of the scale."""
    arc, slip = lengths(of.paths).arc_length[of.converged], of.paths.slip[of.converged]
    known = np.isfinite(slip)
    mine = np.gradient(arc, axis=1)[known]
    at = np.minimum((_BINS * scale.shares(slip[known])).astype(np.int64), _BINS - 1)
    return np.bincount(at, mine, _BINS) / max(float(mine.sum()), 1e-300)


def _slip_subtitle(of: Subject, end: float) -> str:
    friction, most = of.paths.friction, of.figures.max_slip
    if end == 0.0:
        return "no friction needed: wherever a fibre touches it is a geodesic"
    parts = [f"friction {friction:g}" if friction else "wound without friction", f"largest slip {most:.3g}"]
    if friction:
        share = 100.0 * _at_limit(of.paths.slip, friction)
        parts.append(f"{share:.0f} % of the fibre that touches needs all of the friction")
    return "  ·  ".join(parts)


def _at_limit(slip: Floats, friction: float) -> float:
    """Share of the known values of slip that equal the friction, where the fibre slipped until friction held it."""
    known = slip[np.isfinite(slip)]
    return float((known > 0.999 * friction).mean()) if len(known) and friction > 0.0 else 0.0


def unrolled_scene(of: Subject) -> UnrolledScene:
    """The chart, 1 x 1, with x, y and z as red, green and blue, and the fibres; bridges by their feet."""
    points = np.array(surface_image(of.paths.surface, _PIXELS, _PIXELS))
    low, high = points.min(axis=(0, 1)), points.max(axis=(0, 1))
    return UnrolledScene(
        frame=of.frame(f"{of.name}: the part unrolled", _unrolled_subtitle(low, high, of.units)),
        image=(points - low) / np.where(high > low, high - low, 1.0),
        uv=of.paths.uv[:, of.kept],
        bridging=bridging(of.paths)[:, of.kept],
        family=of.paths.family,
        converged=of.converged,
        parted=_parted(of),
    )


def _parted(of: Subject) -> Floats:
    """Outlines (k, 2 n, 2) in the chart of the strips between neighbours that part: along one, back on the other."""
    first, second = of.partings[:, 0], of.partings[:, 1]
    uv, shift = of.paths.uv[:, of.kept], to_next(of.paths, first, second)
    other = uv[second] + np.stack([shift, np.zeros(len(shift))], axis=1)[:, None]
    return np.concatenate([uv[first], other[:, ::-1]], axis=1)


def _unrolled_subtitle(low: Floats, high: Floats, units: str) -> str:
    step = 1e-3 * float((high - low).max())  # smaller values are round-off and should not be shown
    low, high = (np.rint(end / step) * step + 0.0 for end in (low, high))
    tints = zip("xyz", low, high, ("red", "green", "blue"), strict=True)
    spans = (f"{name} {a:.4g} to {b:.4g} as {tint}" for name, a, b, tint in tints)
    return f"colour is the place in space: {', '.join(spans)}" + (f", in {units}" if units else "")
