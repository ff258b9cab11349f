"""The winding angle that is asked for, and as many paths as cover the part."""

from math import atan, cos, degrees, pi, radians, tan
from pathlib import Path

import numpy as np
import pytest
import pyvista as pv
from layup_shapes import drawn

import meshwind as mw
from meshwind.core.errors import BadInputError
from meshwind.filament.levels import levels
from meshwind.filament.stations import angles_at
from meshwind.layup.direction import directions
from meshwind.layup.direction import winding_angle as angle_map
from meshwind.surface import Surface
from meshwind.surface.interpolate import interpolate
from meshwind.workflow.helices import Helices


def helices(surface: Surface) -> Helices:
    return Helices(surface, (0.0, 1.0), 0.0, levels(surface))


def test_a_cylinder_is_covered_by_23_circuits() -> None:
    """Radius 50, length 400, 45 degrees, band 10: 22.2144, so 23."""
    tube = helices(mw.shapes.cylinder(50.0, 400.0))
    turns = tube.turned_to(radians(45.0)).revolutions
    assert degrees(atan(turns * 2 * pi * 50.0 / 400.0)) == pytest.approx(45.0, abs=0.06)
    assert tube.circuits(400.0 * tan(radians(45.0)) / (2 * pi * 50.0), 10.0) == 23


def test_an_elliptic_spar_is_covered_by_26_circuits() -> None:
    """Half axes 80 and 30, perimeter 363.668628, 45 degrees, band 10: 25.7153, so 26."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        return np.stack([80.0 * np.cos(2 * pi * u), 30.0 * np.sin(2 * pi * u), 400.0 * v], axis=-1)

    spar = helices(interpolate(place, (192, 16)))
    assert 363.668628 * cos(radians(45.0)) / 10.0 == pytest.approx(25.7153, abs=1e-4)
    assert spar.circuits(400.0 / 363.668628, 10.0) == 26


def test_a_cone_is_covered_at_its_large_end() -> None:
    """Diameters 98 to 54 over 120, 30 degrees at the large end: 44.4381 bands of 6, so 45."""
    cone = helices(mw.shapes.cone(49.0, 27.0, 120.0))
    turns = cone.turned_to(radians(30.0), "V=0").revolutions
    assert 360.0 * turns == pytest.approx(194.919942, abs=1.0)  # the angle is met to 0.05 degrees
    assert cone.circuits(194.919942 / 360.0, 6.0) == 45


@pytest.mark.parametrize(("part", "angle"), [("tank.ply", 30.0), ("elbow.obj", 30.0), ("cast.ply", 30.0)])
def test_the_angle_is_met_in_the_files(part: str, angle: float, tmp_path: Path) -> None:
    """Measured from paths.vtp alone: steps of the fibre against the level lines of the fitted surface."""
    result = mw.wind(f"data/{part}", angle=angle, angle_at="v=0.5", friction=0.2, out=tmp_path, render=False)
    fibres = pv.read(tmp_path / "paths.vtp")
    uv, points = fibres.point_data["uv"].reshape(24, -1, 2), np.asarray(fibres.points).reshape(24, -1, 3)
    found = []
    for path, at in zip(points, uv, strict=True):
        k = min(max(int(np.searchsorted(at[:, 1], 0.5)), 1), len(at) - 1)
        step, delta = path[k] - path[k - 1], 1e-5
        middle = 0.5 * (at[k] + at[k - 1])
        level = np.diff(result.surface.points([middle - [delta, 0.0], middle + [delta, 0.0]]), axis=0)[0]
        found.append(degrees(np.arcsin(abs(step @ level) / np.linalg.norm(step) / np.linalg.norm(level))))
    assert np.median(found) == pytest.approx(angle, abs=0.5)
    assert str(angle).removesuffix(".0") in " ".join(result.report()["notes"])
    assert result.report()["winding"]["revolutions"] == result.revolutions


def test_enough_paths_to_cover_as_one_filament(tmp_path: Path) -> None:
    result = mw.wind("data/tank.ply", paths=None, band_width=15.0, angle=35.0, friction=0.2, particles=101,
                     continuous=True, out=tmp_path, render=False)  # fmt: skip
    figures = result.report()["pattern"][0]
    assert figures["circuits"] == result.report()["winding"]["paths_per_family"] > 12
    assert 1.0 <= figures["cover"]["min"] < 1.1
    assert 'paths = "auto"' in (tmp_path / "meshwind.toml").read_text()


def test_an_angle_out_of_reach_is_wound_at_the_nearest_with_a_warning() -> None:
    """On a domed tank r sin(angle) is constant along a fibre, so that small openings allow no 88 degrees."""
    result = mw.wind("data/tank.ply", angle=88.0, paths=4, particles=101)
    (warning,) = [note for note in result.notes if "88 degrees" in note.text]
    assert warning.warning and "is out of reach" in warning.text and "slide off" in warning.text
    assert result.settled  # no fibre is given away for a degree
    at = angles_at(result.paths, np.array([float(warning.text.split("v=")[1].split(":")[0])]))
    assert f"wound at {degrees(np.median(at)):.1f}" in warning.text


def test_the_angle_is_no_other_where_the_chart_is_oblique() -> None:
    """A cylinder whose lines u = 0 wind as well: the angle is still that from the axis, in maps as at stations."""

    def place(u: np.ndarray, v: np.ndarray) -> np.ndarray:  # type: ignore[type-arg]
        turned = 2 * pi * (u + 0.3 * v)
        return np.stack([50.0 * np.cos(turned), 50.0 * np.sin(turned), 400.0 * v], axis=-1)

    surface, v = interpolate(place, (192, 16)), np.linspace(0.0, 1.0, 101)
    paths = drawn(surface, np.array([np.stack([k / 6 + 0.4 * v, v], axis=1) for k in range(6)]), np.ones(6))
    wanted = atan(0.7 * 2 * pi * 50.0 / 400.0)
    assert angles_at(paths, v) == pytest.approx(np.full((6, 101), wanted), abs=1e-5)
    assert angle_map(paths, 24, 9) == pytest.approx(np.full((24, 9), wanted), abs=1e-5)
    tangents, signed = directions(paths, np.array([[0.1, 0.3], [0.7, 0.9]]))
    assert signed == pytest.approx(np.full(2, wanted), abs=1e-5)
    assert tangents[:, 2] == pytest.approx(np.full(2, cos(wanted)), abs=1e-5)


@pytest.mark.parametrize(("options", "line"), [
    ({"angle": 95.0}, "angle is 95; give a number from 0 to 89"),
    ({"angle": 30.0, "revolutions": 0.5}, "give one of them"),
    ({"angle_at": "z=3"}, "without an angle"),
    ({"paths": None}, "need band_width"),
    ({"angle": 30.0, "angle_at": "z=1e9"}, "lies off the part"),
])  # fmt: skip
def test_what_cannot_be_asked_for(options: dict[str, object], line: str) -> None:
    with pytest.raises(BadInputError, match=line):
        mw.wind("data/tank.ply", **options)  # type: ignore[arg-type]
