"""The chart: no flipped triangle, no trace of the seam, no artificial twist."""

from pathlib import Path

import numpy as np
import pytest
from comparison.problems import barrel_radius
from irregular import annulus, tube

import meshwind as mw
from meshwind.chart import Chart, flatten
from meshwind.core.cast import Floats
from meshwind.mesh import Annulus

DATA = sorted((Path(__file__).parents[1] / "data").iterdir())


def barrel(u: Floats, v: Floats) -> Floats:
    r = 1.0 - 0.3 * (2 * v - 1) ** 2
    return np.stack([r * np.cos(2 * np.pi * u), r * np.sin(2 * np.pi * u), 2 * v], -1)


def signed_areas(chart: Chart) -> Floats:
    a = chart.corner_uv[:, 1] - chart.corner_uv[:, 0]
    b = chart.corner_uv[:, 2] - chart.corner_uv[:, 0]
    return np.asarray((a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]) / 2)


@pytest.mark.parametrize("path", DATA, ids=lambda p: p.name)
def test_no_triangle_flips(path: Path) -> None:
    chart = flatten(mw.annulus(mw.read(path)))
    area = signed_areas(chart)
    assert chart.flipped == 0
    assert (area > 0).all()
    assert area.sum() == pytest.approx(1.0, abs=1e-9)  # it covers the periodic rectangle exactly once


def test_corners_agree_with_vertices_up_to_whole_turns() -> None:
    chart = flatten(annulus(barrel, 1000, 0.4))
    apart = chart.corner_uv - chart.uv[chart.annulus.faces]
    assert np.abs(apart[..., 0] - np.round(apart[..., 0])).max() < 1e-12
    assert np.abs(apart[..., 1]).max() == 0


def test_rims_are_the_ends() -> None:
    chart = flatten(annulus(barrel, 1000, 0.4))
    for value, rim in enumerate(chart.annulus.rims):
        assert (chart.uv[rim, 1] == value).all()
        assert np.mod(np.diff(chart.uv[rim, 0]), 1.0).sum() < 1  # the loops run once around, u growing


@pytest.mark.parametrize("vertices", [1000, 4000])
def test_a_shape_of_revolution_gets_its_meridians(vertices: int) -> None:
    """u is the polar angle but for a constant, the same at both rims: no twist."""
    uv, _, rims = tube(vertices, 0.4)
    chart = flatten(annulus(barrel, vertices, 0.4))
    apart = chart.uv[:, 0] - uv[:, 0]
    apart -= np.round(apart - apart[0])
    assert apart.std() < 0.05 / vertices
    assert abs(apart[rims[0]].mean() - apart[rims[1]].mean()) < 0.02 / vertices


def test_v_is_even_along_the_part() -> None:
    """On the barrel the mean speed along v becomes constant: v is the share of the meridian's length."""
    chart = flatten(annulus(barrel, 4000, 0.4))
    z = np.linspace(0, 2, 20001)
    r = np.array([barrel_radius(t) for t in z])
    length = np.r_[0, np.cumsum(np.hypot(np.diff(z), np.diff(r)))]
    exact = np.interp(chart.annulus.vertices[:, 2], z, length / length[-1])
    assert np.abs(chart.uv[:, 1] - exact).max() < 3e-3


def test_the_seam_leaves_no_trace() -> None:
    """Rolling the vertices moves the cut elsewhere; the map only turns."""
    part = annulus(barrel, 1000, 0.4)
    n, by = len(part.vertices), 371
    order = np.roll(np.arange(n), by)  # new index k holds old vertex order[k]
    position = np.empty(n, dtype=np.int64)
    position[order] = np.arange(n)
    rims = tuple(np.roll(position[rim], 17) for rim in part.rims)
    rolled = Annulus(part.mesh, part.vertices[order], position[part.faces], (rims[0], rims[1]), part.trusted, "rolled")
    apart = flatten(rolled).uv[position] - flatten(part).uv
    apart[:, 0] -= apart[0, 0]
    apart[:, 0] -= np.round(apart[:, 0])
    assert np.abs(apart).max() < 1e-10


def test_obtuse_meshes_fall_back_on_positive_weights() -> None:
    """Slivers make cotangents negative: the chart must still be an embedding."""
    rng = np.random.default_rng(3)

    def squashed(u: Floats, v: Floats) -> Floats:
        return barrel(u, v) * [1.0, 1.0, 12.0] + 0.0 * rng.random()

    chart = flatten(annulus(squashed, 1500, 0.4))
    assert chart.flipped == 0


def test_stages_name_what_they_take() -> None:
    """Each stage with input of the wrong type: one line that names the stage before it."""
    mesh = mw.read(DATA[0])
    for call, before in (
        (lambda: mw.flatten(mesh), "annulus"),  # type: ignore[arg-type]
        (lambda: mw.fit(mesh), "flatten"),  # type: ignore[arg-type]
        (lambda: mw.assess(mesh), "solve"),  # type: ignore[arg-type]
        (lambda: mw.fit(flatten(mw.annulus(mesh)), float("nan")), "tolerance"),
        (lambda: mw.shapes.cylinder("a", 2), "radius"),  # type: ignore[arg-type]
    ):
        with pytest.raises(mw.BadInputError, match=before):
            call()
