"""What an edit of a mesh keeps, measured on its vertices and faces, and what of a rough mesh it leaves alone."""

import numpy as np
import pytest

import meshwind as mw
from meshwind.editing.redesign import Redesign, redesign
from meshwind.editing.result import Outcome

NOISE = 0.004
AROUND, ALONG = 48, 40


def waisted(depth: float, noise: float = 0.0) -> mw.Mesh:
    """A tube of radius 1 from z = -1 to 1 with a waist of a depth about z = 0, vertices moved radially at random."""
    phi, z = np.meshgrid(2.0 * np.pi * np.arange(AROUND) / AROUND, np.linspace(-1.0, 1.0, ALONG), indexing="ij")
    radius = 1.0 - depth * np.exp(-((z / 0.35) ** 2)) + noise * np.random.default_rng(3).standard_normal(z.shape)
    points = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=-1).reshape(-1, 3)
    row, next_ = (ALONG * np.roll(np.arange(AROUND), -k)[:, None] + np.arange(ALONG - 1) for k in (0, 1))
    lower = np.stack([row, next_, next_ + 1], axis=-1).reshape(-1, 3)
    return mw.Mesh(points, np.concatenate([lower, np.stack([row, next_ + 1, row + 1], axis=-1).reshape(-1, 3)]))


def edited(part: mw.Mesh, turns: float = 0.2, **asked: bool) -> Redesign:
    return redesign(part, revolutions=turns, paths=6, particles=101, **asked)  # type: ignore[arg-type]


def enclosed(mesh: mw.Mesh) -> float:
    """Volume between the planes of the rims, by the divergence theorem on (x, y, 0) / 2."""
    corners = mesh.vertices[mesh.faces]
    normal = 0.5 * np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    flux = normal * corners.mean(axis=1) * [0.5, 0.5, 0.0]  # the field is linear: its mean over a face is exact
    return abs(float(flux.sum()))


def outward(found: Redesign) -> np.ndarray:
    """How far each vertex was moved along the normal of the faces about it (n,)."""
    corners = found.part.vertices[found.part.faces]
    normal = np.zeros_like(found.part.vertices)
    for column in found.part.faces.T:
        np.add.at(normal, column, np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]))
    return np.asarray((found.displacement * normal).sum(axis=1) / np.linalg.norm(normal, axis=1))


def test_bridges_within_what_a_rough_mesh_is_known_to_are_no_demand() -> None:
    shallow = edited(waisted(0.03, NOISE))
    assert 0.0 < shallow.before.gap < NOISE
    assert shallow.outcome is Outcome.WINDABLE and not shallow.displacement.any() and shallow.stages == ()
    deep = edited(waisted(0.08, NOISE))
    assert deep.before.gap > NOISE and deep.outcome is Outcome.WINDABLE
    assert np.abs(deep.displacement).max() > NOISE


def test_the_volume_of_a_mesh_is_kept_to_a_thousandth() -> None:
    free, kept = edited(waisted(0.08), 0.0), edited(waisted(0.08), 0.0, keep_volume=True)
    before = enclosed(kept.part)
    assert before == pytest.approx(enclosed(free.part))
    assert kept.outcome is Outcome.WINDABLE
    assert abs(enclosed(free.mesh) / before - 1.0) > 3e-3
    assert abs(enclosed(kept.mesh) / before - 1.0) < 1e-3


@pytest.mark.parametrize("way", ["only_outward", "only_inward"])
def test_no_vertex_is_moved_the_other_way(way: str) -> None:
    sign = 1.0 if way == "only_outward" else -1.0
    free, kept = edited(waisted(0.08)), edited(waisted(0.08), **{way: True})
    assert kept.outcome is Outcome.WINDABLE
    most = np.abs(kept.displacement).max()
    assert (sign * outward(free)).min() < -0.05 * most
    assert (sign * outward(kept)).min() > -0.01 * most
