"""Thickness against bands that are painted on the part, and on a dome; folds, and hoops that do not hold."""

from itertools import pairwise
from math import asin, cos, pi, sin, tan
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial import cKDTree

import meshwind as mw
from meshwind.core.cast import Bools, Floats, Ints
from meshwind.core.errors import BadInputError
from meshwind.filament.hoop import HoopPlan, hoop
from meshwind.filament.offset import raised
from meshwind.filament.thickness import Laying, Thickness, Tracks, deposit
from meshwind.surface.interpolate import interpolate

LAYERS = """
[[layer]]
kind = "helical"
revolutions = 0.5
paths = 9
band_width = {width}
band_thickness = 0.3
friction = 0.2

[[layer]]
kind = "hoop"
band_width = {width}
band_thickness = 0.3
friction = 1
from = 0.35
to = 0.65

[[layer]]
kind = "helical"
revolutions = 0.6
paths = 7
band_width = {width}
band_thickness = 0.4
friction = 0.2
"""


class Canvas:
    """A surface as an even grid of points, each with the area that it stands for and its normal."""

    def __init__(self, surface: mw.Surface, around: int, along: int) -> None:
        self.along = along
        u, v = np.meshgrid(np.linspace(0, 1, around + 1), np.linspace(0, 1, along + 1), indexing="ij")
        corners = surface.points(np.stack([u.ravel(), v.ravel()], axis=1)).reshape(around + 1, along + 1, 3)
        across = np.cross(corners[1:, 1:] - corners[:-1, :-1], corners[:-1, 1:] - corners[1:, :-1]).reshape(-1, 3)
        size = np.linalg.norm(across, axis=1)
        self.area, self.normal = 0.5 * size, across / size[:, None]
        uv = np.stack([(u[1:, 1:] + u[:-1, 1:]).ravel(), (v[1:, 1:] + v[1:, :-1]).ravel()], axis=1) / 2
        self.points = surface.points(uv)
        self.tree = cKDTree(self.points)

    def below(self, line: Floats, width: float) -> Ints:
        """Which points lie within half a width beside a polyline (n, 3), by the arc that their chord stands for."""
        reach = 0.5 * width + np.linalg.norm(np.diff(line, axis=0), axis=1).max()
        near = np.unique(np.concatenate(self.tree.query_ball_point(line, reach)).astype(int))
        at, nearest = self.points[near], cKDTree(line).query(self.points[near])[1]
        away, on = np.full(len(near), np.inf), np.zeros(len(near), dtype=bool)
        foot = np.zeros_like(at)
        for first in (nearest - 1, nearest):
            step = np.clip(first, 0, len(line) - 2)
            way = line[step + 1] - line[step]
            share = ((at - line[step]) * way).sum(axis=1) / (way**2).sum(axis=1)
            there = line[step] + np.clip(share, 0.0, 1.0)[:, None] * way
            far = np.linalg.norm(at - there, axis=1)
            nearer = far < away
            past: Bools = ((step == 0) & (share < 0.0)) | ((step == len(line) - 2) & (share > 1.0))
            on = np.where(nearer, ~past, on)  # a band ends square to its fibre
            foot, away = np.where(nearer[:, None], there, foot), np.minimum(far, away)
        turn = np.clip((self.normal[near] * self.normal[self.tree.query(foot)[1]]).sum(axis=1), -1.0, 1.0)
        half = 0.5 * np.arccos(turn)
        arc = away * np.divide(half, np.sin(half), out=np.ones_like(half), where=half > 1e-9)
        return near[on & (arc <= 0.5 * width)]

    def painted(self, lines: list[Floats], width: float) -> Floats:
        """Area under bands by ring of points, from the start rim on."""
        coats = np.zeros(len(self.points))
        for line in lines:
            coats[self.below(line, width)] += 1.0
        return (coats * self.area).reshape(-1, self.along).sum(axis=0)


def pieces(laid: Tracks) -> list[Floats]:
    """The fibres' feet, no piece of more than a turn, so that a band does not hide the next turn's."""
    found = []
    for uv in laid.uv:
        cuts = np.flatnonzero(np.diff(np.floor(np.abs(uv[:, 0] - uv[0, 0]))) > 0) + 1
        edges = [0, *cuts.tolist(), len(uv) - 1]
        found += [uv[a : b + 1] for a, b in pairwise(edges) if b > a]
    return found


def between(below: mw.Surface, above: mw.Surface) -> float:
    """Volume of the cells between two surfaces on the same u and v, by Simpson's rule across."""
    u, v = np.meshgrid(np.linspace(0, 1, 301), np.linspace(0, 1, 301), indexing="ij")
    at = np.stack([u.ravel(), v.ravel()], axis=1)
    low, high = (each.points(at).reshape(301, 301, 3) for each in (below, above))
    total = 0.0
    for share, weight in ((0.0, 1.0), (0.5, 4.0), (1.0, 1.0)):
        p = low + share * (high - low)
        area = 0.5 * np.cross(p[1:, 1:] - p[:-1, :-1], p[:-1, 1:] - p[1:, :-1])
        rise = high - low
        middle = 0.25 * (rise[1:, 1:] + rise[1:, :-1] + rise[:-1, 1:] + rise[:-1, :-1])
        total += weight / 6.0 * float((area * middle).sum())
    return total


@pytest.mark.parametrize(("part", "width"), [("tank.ply", 12.0), ("bottle.obj", 7.0), ("elbow.obj", 8.0)])
def test_three_layers_are_as_thick_as_their_bands_are_painted(part: str, width: float, tmp_path: Path) -> None:
    (tmp_path / "layers.toml").write_text(LAYERS.format(width=width))
    result = mw.wind(f"data/{part}", layers=tmp_path / "layers.toml", particles=201)
    assert result.layered is not None
    layers = result.layered.laminate.layers
    assert len(layers) == 3
    for below, above in pairwise(layers):
        assert above.surface is below.raised.surface
    for layer in layers:
        fibre, thick = layer.fibre_length, layer.thickness
        assert thick.volume == pytest.approx(width * layer.laying.thickness * fibre, rel=1e-9)
        # the fibre lies on the surface above the layer below, which holds that layer's volume
        assert layer.off_below < 1e-9 * layer.surface.size
        assert layer.raised.off_rms < 0.15 * layer.laying.thickness
        assert between(layer.surface, layer.raised.surface) == pytest.approx(thick.volume, rel=0.01)
        canvas = Canvas(layer.surface, 360, 480)
        feet = [layer.surface.points(np.ascontiguousarray(piece)) for piece in pieces(layer.tracks)]
        rings = canvas.painted(feet, width)
        area, volume = rings.sum(), (thick.volume - thick.over_rim) / layer.laying.thickness
        assert area == pytest.approx(volume, rel=5e-3)
        # what is left is the bridges': their feet are longer than the fibre above, by which the volume goes
        longer = sum(float(np.linalg.norm(np.diff(each, axis=0), axis=1).sum()) for each in feet) / fibre
        assert area / longer == pytest.approx(volume, rel=1.5e-3)
        # and along the part it is where it was painted
        stations = np.linspace(0.15, 0.85, 15)
        deposited = (thick.cells * thick.area).sum(axis=0) / layer.laying.thickness
        one, other = (
            np.diff(np.interp(stations, np.linspace(0, 1, len(each) + 1), np.append(0.0, np.cumsum(each))))
            for each in (rings, deposited)
        )
        assert one == pytest.approx(other, abs=0.02 * other.max())


def test_bands_on_a_dome() -> None:
    """Great circles whose bands touch the opening: each covers a parallel by the arcs within half a band of it."""
    radius, hole, width, count = 100.0, 40.0, 6.0, 60
    dome = mw.shapes.sphere_band(radius, polar0=asin(hole / radius), polar1=0.5 * pi, spans=(96, 48))
    lowest, touch = asin(hole / radius), asin(hole / radius) + 0.5 * width / radius
    t = np.linspace(-0.5 * pi, 0.5 * pi, 401)  # from the equator over the touch point and down to it
    polar, azimuth = np.arccos(cos(touch) * np.cos(t)), np.arctan2(np.sin(t), sin(touch) * np.cos(t))
    v = np.clip((polar - lowest) / (0.5 * pi - lowest), 0.0, 1.0)
    uv = np.stack(np.broadcast_arrays(np.arange(count)[:, None] / count + azimuth / (2 * pi), v), axis=-1)
    steps = np.full((count, len(t) - 1), radius * (t[1] - t[0]))
    layer = deposit(dome, Tracks(np.ascontiguousarray(uv), steps, np.zeros(uv.shape[:2])), Laying(width, 1.0))
    rings = layer.along()
    edges = np.linspace(lowest, 0.5 * pi, len(rings) + 1)
    fine = np.linspace(edges[:-1], edges[1:], 201)
    covered = [
        np.arccos(np.clip((side * sin(0.5 * width / radius) - np.cos(fine) * sin(touch)) / (np.sin(fine) * cos(touch)),
                          -1.0, 1.0))
        for side in (-1.0, 1.0)
    ]  # fmt: skip
    wanted = (count / pi * (covered[0] - covered[1]) * np.sin(fine)).mean(axis=0) / np.sin(fine).mean(axis=0)
    off = np.abs(rings / wanted - 1.0)
    assert np.median(off) < 2e-3
    assert off.max() < 0.03
    # and the classical formula of netting analysis, away from the peak
    far = radius * np.sin(edges[:-1]) > hole + 3 * width
    r, least = radius * np.sin(0.5 * (edges[:-1] + edges[1:])[far]), radius * sin(touch)
    classical = 2 * count * width / (2 * pi * r * np.sqrt(1.0 - (least / r) ** 2))
    assert np.median(np.abs(rings[far] / classical - 1.0)) < 0.01


def waist(bend: float) -> mw.Surface:
    """A neck of radius 30 whose meridian is hollow with a radius `bend` there."""
    return mw.shapes.revolution(lambda z: 30.0 + z**2 / (2.0 * bend), -20.0, 20.0, spans=(32, 64))


def even(thickness: float) -> Thickness:
    cells = np.full((48, 48), thickness)
    return Thickness(cells, np.zeros_like(cells), np.ones_like(cells), 0.0)


def test_a_layer_that_fills_a_hollow_is_noticed() -> None:
    """At the neck the height h has h + H h^2 + K h^3 / 3 = t with the curvatures 1/30 and -1/bend."""
    bend, thickness = 12.0, 5.5
    found = raised(waist(bend), even(thickness), 4.0)
    mean, gauss = 0.5 * (1.0 / 30.0 - 1.0 / bend), -1.0 / (30.0 * bend)
    roots = np.roots([gauss / 3.0, mean, 1.0, -thickness])
    height = min(float(each.real) for each in roots if abs(each.imag) < 1e-9 and each.real > 0.0)
    assert found.hollow == pytest.approx(height / bend, rel=0.01)
    assert found.tight and found.where[1] == pytest.approx(0.5, abs=0.03)
    assert not raised(waist(bend), even(2.0), 4.0).tight
    with pytest.raises(BadInputError, match=r"folds in a hollow of radius 12 at .*give a thinner band"):
        raised(waist(bend), even(7.0), 4.0)  # there is room for 12 + H 12^2 + K 12^3 / 3 = 6.8


def test_a_hoop_that_slips_or_lifts_is_said() -> None:
    """On a cone a level line needs tan of the half angle; in a section that is hollow somewhere it bridges."""
    slope = 0.3
    cone = mw.shapes.revolution(lambda z: 40.0 + slope * z, 0.0, 100.0)
    laid = hoop(cone, HoopPlan(0.2, 0.8, 4.0))
    assert laid.friction == pytest.approx(slope, rel=0.02)
    assert "100 % of the hoop slips off: it needs a friction of 0.3" in laid.advice(0.25)
    assert laid.slips(0.25) == 1.0 and laid.slips(0.32) == 0.0
    assert laid.lifts == 0.0 and laid.advice(0.32) == ""

    def bean(u: Floats, v: Floats) -> Floats:
        t = 2 * pi * u
        r = 30.0 * (1.0 + 0.25 * np.cos(2 * t))
        return np.stack([r * np.cos(t), r * np.sin(t), 100.0 * v], axis=-1)

    laid = hoop(interpolate(bean, (96, 24)), HoopPlan(0.1, 0.9, 6.0))
    # the section's curvature is r^2 + 2 r'^2 - r r'' over a positive number
    t = np.linspace(0.0, 2 * pi, 100_001)
    r, first, second = (a + b * 0.25 * f(2 * t) for a, b, f in ((1, 1, np.cos), (0, -2, np.sin), (0, -4, np.cos)))
    hollow = r**2 + 2 * first**2 - r * second < 0.0
    speed = np.hypot(r, first)
    assert laid.lifts == pytest.approx(float(speed[hollow].sum() / speed.sum()), abs=0.01)
    assert "does not press on the part" in laid.advice(5.0)
    assert abs(laid.worst[0] % 0.5 - 0.25) < 0.15


def test_straight_strips_hang_over_a_rim_by_a_corner() -> None:
    """At 45 degrees a flat band square to its fibre leaves B^2 / 8 tan(a) over each rim on one side."""
    tube, width = mw.shapes.cylinder(50.0, 200.0), 10.0
    v = np.linspace(0.0, 1.0, 401)
    uv = np.stack([200.0 * v / (2 * pi * 50.0), v], axis=1)[None]
    steps = np.full((1, 400), 0.5 * tan(0.25 * pi) * 200.0 * 2.0 / cos(0.25 * pi) / 400)
    layer = deposit(tube, Tracks(uv, steps, np.zeros((1, 401))), Laying(width, 1.0))
    assert layer.over_rim == pytest.approx(2 * width**2 / 8.0, rel=0.02)
