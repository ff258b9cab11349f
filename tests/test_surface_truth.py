"""The fitted surface against the true part, where its mesh is sampled, decimated or noisy, and its stated error."""

from collections.abc import Callable

import igl
import numpy as np
import pytest
from comparison.problem import TURN
from comparison.problems import vase_radius
from irregular import annulus
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.chart import flatten
from meshwind.chart.chart import Chart
from meshwind.core.cast import Floats, Ints
from meshwind.mesh import mesh_from
from meshwind.surface.fitting.quadrature import facet_points
from meshwind.surface.fitting.samples import Samples

Profile = Callable[[Floats], tuple[Floats, Floats]]
"""Radius and height of a shape of revolution by v."""


def vase(v: Floats) -> tuple[Floats, Floats]:
    return vase_radius(4 * v), 4 * v


def barrel(v: Floats) -> tuple[Floats, Floats]:
    return 1.0 - 0.3 * (2 * v - 1.0) ** 2, 2 * v


def hyperboloid(v: Floats) -> tuple[Floats, Floats]:
    return np.sqrt(0.09 + (2 * v - 1) ** 2), 2 * v - 1


def vessel(v: Floats) -> tuple[Floats, Floats]:
    """A cylinder of radius 50 and length 200 with hemispherical ends, opened to radius 12."""
    opening = np.arcsin(12.0 / 50.0)
    dome = 50.0 * (np.pi / 2 - opening)
    s = v * (2 * dome + 200.0)
    low, high = opening + s / 50.0, (s - dome - 200.0) / 50.0
    radius = np.where(s < dome, 50.0 * np.sin(low), np.where(s > dome + 200.0, 50.0 * np.cos(high), 50.0))
    height = np.where(s < dome, -50.0 * np.cos(low), np.where(s > dome + 200.0, 200.0 + 50.0 * np.sin(high), s - dome))
    return radius, height


SHAPES: dict[str, tuple[Profile, float]] = {
    "vase": (vase, 0.7), "barrel": (barrel, 0.45), "hyperboloid": (hyperboloid, 0.45), "vessel": (vessel, 0.83),
}  # fmt: skip
"""Profiles, and how many turns each is as long as."""


def formula(profile: Profile) -> Callable[[Floats, Floats], Floats]:
    def points(u: Floats, v: Floats) -> Floats:
        radius, height = profile(v)
        return np.stack([radius * np.cos(TURN * u), radius * np.sin(TURN * u), height], -1)

    return points


def from_profile(profile: Profile, points: Floats) -> Floats:
    """Distances (n,) of points (n, 3) to the shape of revolution, to 1e-7 of its size."""
    at = np.stack(profile(np.linspace(0.0, 1.0, 20_001)), axis=1)
    here = np.stack([np.hypot(points[:, 0], points[:, 1]), points[:, 2]], axis=1)
    near = np.clip(cKDTree(at).query(here)[1], 1, len(at) - 2)
    distance = np.full(len(here), np.inf)
    for first in (near - 1, near):
        a, b = at[first], at[first + 1]
        share = np.clip(((here - a) * (b - a)).sum(1) / ((b - a) ** 2).sum(1), 0.0, 1.0)
        distance = np.minimum(distance, np.linalg.norm(here - a - share[:, None] * (b - a), axis=1))
    return distance


def decimated(name: str, keep: float) -> tuple[Chart, Floats, Ints]:
    """A fine mesh of a shape, decimated as people do (quadric error) and flattened."""
    profile, aspect = SHAPES[name]
    fine = annulus(formula(profile), 16_000, aspect)
    found = igl.qslim(np.array(fine.vertices), np.array(fine.faces, np.int32), int(keep * len(fine.faces)))
    vertices, faces = found[1:3] if isinstance(found[0], bool | np.bool_) else found[:2]
    return flatten(mw.annulus(mesh_from(vertices, faces))), vertices, faces


def inner(count: int = 8000) -> Floats:
    """Places on a surface, away from its rims."""
    return np.random.default_rng(3).random((count, 2)) * [1.0, 0.94] + [0.0, 0.03]


def on_facets(chart: Chart, count: int = 8000) -> Floats:
    """Points spread over a chart's facets, away from the rims."""
    faces, rng = chart.annulus.faces, np.random.default_rng(4)
    area = igl.doublearea(np.array(chart.annulus.vertices), np.array(faces))
    face, share = rng.choice(len(faces), count, p=area / area.sum()), rng.dirichlet([1, 1, 1], count)
    v = (chart.corner_uv[face, :, 1] * share).sum(axis=1)
    points = (chart.annulus.vertices[faces[face]] * share[:, :, None]).sum(axis=1)
    return np.asarray(points[(v > 0.03) & (v < 0.97)])


def rms(values: Floats) -> float:
    return float(np.sqrt(np.mean(values**2)))


@pytest.mark.parametrize("keep", [0.25, 0.06])
@pytest.mark.parametrize("name", sorted(SHAPES))
def test_a_decimated_part_is_as_true_as_its_facets(name: str, keep: float) -> None:
    """Whichever data lead, the surface is at least as true as the facets, and the stated error covers the true one."""
    chart, _, _ = decimated(name, keep)
    surface = mw.fit(chart)
    error = surface.error
    assert error is not None
    profile = SHAPES[name][0]
    facets, places = rms(from_profile(profile, on_facets(chart))), inner()
    off = from_profile(profile, surface.points(places))
    assert rms(off) <= max(1.1 * facets, 1.5e-4 * error.diagonal)
    assert np.quantile(off, 0.999) <= max(1.5 * np.quantile(from_profile(profile, on_facets(chart)), 0.999),
                                          1e-3 * error.diagonal)  # fmt: skip
    assert rms(off) <= rms(surface.uncertainty_at(places))
    assert (off <= surface.uncertainty_at(places)).mean() > 0.9


@pytest.mark.parametrize("noise", [0.02, 0.1, 0.3])
@pytest.mark.parametrize("name", ["barrel", "hyperboloid", "vase"])
def test_noise_is_smoothed_as_far_as_it_asks(name: str, noise: float) -> None:
    """Gaussian noise in mean edges on 4,000 vertices: the surface is off by at most half of it."""
    profile, aspect = SHAPES[name]
    clean = annulus(formula(profile), 4000, aspect)
    edges = clean.vertices[clean.faces[:, 0]] - clean.vertices[clean.faces[:, 1]]
    size = noise * float(np.linalg.norm(edges, axis=1).mean())
    moved = clean.vertices + size * np.random.default_rng(1).normal(size=clean.vertices.shape)
    surface = mw.fit(flatten(mw.annulus(mesh_from(moved, clean.faces))))
    assert surface.error is not None and surface.error.data == "vertices"
    assert rms(from_profile(profile, surface.points(inner()))) <= 0.5 * size
    assert surface.error.noise == pytest.approx(size, rel=0.15)


@pytest.mark.parametrize("name", ["barrel", "hyperboloid", "vase"])
def test_sampled_parts_are_followed_at_their_vertices(name: str) -> None:
    """The fit stays far closer than the facets, and states an error that covers the true one."""
    profile, aspect = SHAPES[name]
    surface = mw.fit(flatten(annulus(formula(profile), 4000, aspect)), 1e-12)
    assert surface.error is not None and surface.error.data == "vertices"
    off = from_profile(profile, surface.points(inner()))
    assert rms(off) <= 2e-6 * surface.error.diagonal
    assert rms(off) <= rms(surface.uncertainty_at(inner()))


def test_long_triangles_through_true_vertices_are_curved() -> None:
    """A cylinder meshed in one strip between its rims: no vertices hold a net there, and flat facets cut its circle."""
    surface = mw.fit(flatten(mw.annulus(strip(64))))
    points = surface.points(inner())
    assert np.abs(np.hypot(points[:, 0], points[:, 1]) - 1.0).max() < 2e-4  # the facets' sagitta is 1.2e-3


def strip(around: int) -> mw.Mesh:
    """A tube of radius 1 and length 3 meshed in one strip between its rims."""
    angle = TURN * np.arange(around) / around
    ring = np.stack([np.cos(angle), np.sin(angle), np.zeros(around)], axis=1)
    a = np.arange(around)
    b = (a + 1) % around
    faces = np.concatenate([np.stack([a, b, b + around], -1), np.stack([a, b + around, a + around], -1)])
    return mesh_from(np.concatenate([ring, ring + [0.0, 0.0, 3.0]]), faces)


def test_facets_across_many_spans_leave_none_without_a_point() -> None:
    """However long facets are, a net that is fitted to them has data in all its spans, and their integral is exact."""
    samples = Samples.of(flatten(mw.annulus(strip(12))))
    spans = (40, 300)
    points = facet_points(samples, spans)
    uv = points.places(samples.uv)
    assert np.histogram2d(uv[:, 0] % 1.0, uv[:, 1], spans, ((0.0, 1.0), (0.0, 1.0)))[0].min() > 0
    faces = samples.facets.faces
    area = igl.doublearea(samples.points, faces) / 2
    np.testing.assert_allclose(np.bincount(points.facet, points.area), area, rtol=1e-12)
    centre = [points.per_facet(each, len(faces)) for each in points.between(samples.points).T]
    np.testing.assert_allclose(np.stack(centre, 1), samples.points[faces].mean(axis=1), atol=1e-12)
    assert len(points.facet) < 60 * spans[0] * spans[1]
