"""How far facets and a fitted surface lie off a part of revolution, and what the surface states."""

from dataclasses import dataclass

import igl
import numpy as np
from scipy.spatial import cKDTree

import meshwind as mw
from comparison.parts import Revolved
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from

PLACES, RIM, PROFILE = 20_000, 0.03, 20_001
"""Places where distances are taken, how far they keep from the rims, and points of a profile."""


@dataclass(frozen=True)
class Truth:
    """Rms distances of facets and surface from the part, that which the surface states, and how much is within it."""

    surface: mw.Surface
    facets: float
    fitted: float
    stated: float
    within: float

    @property
    def led_by(self) -> str:
        """What led the fit."""
        return self.surface.error.data if self.surface.error else ""

    @property
    def noise(self) -> float:
        """What was found of it in the mesh."""
        return self.surface.error.noise if self.surface.error else 0.0

    def over(self, unit: float) -> dict[str, float]:
        """The distances in a unit of length, by name."""
        return {"facets": self.facets / unit, "surface": self.fitted / unit, "stated": self.stated / unit}


def off(part: Revolved, points: Floats) -> Floats:
    """Distances (n,) of points from the part's profile, a fine polyline."""
    z = np.linspace(0.0, part.height, PROFILE)
    profile = np.stack([part.radius(z), z], axis=1)
    here = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
    near = np.clip(cKDTree(profile).query(here)[1], 1, PROFILE - 2)
    distance = np.full(len(here), np.inf)
    for first in (near - 1, near):
        a, b = profile[first], profile[first + 1]
        share = np.clip(((here - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0.0, 1.0)
        distance = np.minimum(distance, np.linalg.norm(here - a - share[:, None] * (b - a), axis=1))
    return distance


def rms(values: Floats) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(values**2)))


def measure(part: Revolved, vertices: Floats, faces: Ints) -> Truth:
    """Fit a mesh and compare with its part."""
    chart = mw.flatten(mw.annulus(mesh_from(vertices, faces)))
    surface, rng = mw.fit(chart), np.random.default_rng(1)
    corners = chart.annulus.faces
    area = igl.doublearea(np.array(chart.annulus.vertices), np.array(corners))
    face, share = rng.choice(len(area), PLACES, p=area / area.sum()), rng.dirichlet([1.0, 1.0, 1.0], PLACES)
    uv = (chart.corner_uv[face] * share[:, :, None]).sum(axis=1)
    inner = (uv[:, 1] > RIM) & (uv[:, 1] < 1.0 - RIM)
    flat = (chart.annulus.vertices[corners[face]] * share[:, :, None]).sum(axis=1)[inner]
    true, stated = off(part, surface.points(uv[inner])), surface.uncertainty_at(uv[inner])
    return Truth(surface, rms(off(part, flat)), rms(true), rms(stated), float((true <= stated).mean()))
