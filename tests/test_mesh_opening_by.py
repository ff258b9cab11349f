"""How closed ends are opened: along a level line of the distance to the pole, by a plane, or by the more even one."""

from pathlib import Path

import numpy as np
import pytest
from mesh_shapes import Part, ball, rotation
from walled_shapes import Grid, blob, bottle

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.mesh import mesh_from
from meshwind.mesh.geometry.areas_and_volumes import loop_area
from meshwind.mesh.opening.plane import Rim

ROUND, BLADE = (20.0, 20.0, 60.0), (40.0, 5.0, 100.0)
"""Half axes of an egg, and of one as flat as a blade: there a level line is bent about the edges."""


def ellipsoid(axes: tuple[float, float, float], subdivisions: int = 5) -> Part:
    vertices, faces = ball(subdivisions)
    return vertices * axes, faces


def opened(part: Part, by: str, radius: float | None = None, matrix: Floats | None = None) -> mw.Annulus:
    """The part opened at both ends of z, which may be turned elsewhere; in its own axes again."""
    matrix = np.eye(3) if matrix is None else matrix
    ends = " ".join(",".join(f"{x:.17g}" for x in sign * matrix[:, 2] * part[0][:, 2].max()) for sign in (-1.0, 1.0))
    return mw.annulus(mesh_from(part[0] @ matrix.T, part[1]), ends, radius, opening_by=by)


def rims(found: mw.Annulus) -> list[Floats]:
    return [found.vertices[rim] for rim in found.rims]


@pytest.mark.parametrize("axes", [ROUND, BLADE])
def test_a_plane_leaves_a_flat_rim_of_the_area_wanted(axes: tuple[float, float, float]) -> None:
    a, b, c = axes
    radius = 0.4 * float(np.sqrt(a * b))
    found = opened(ellipsoid(axes), "plane", radius)
    height = c * np.sqrt(1.0 - radius**2 / (a * b))  # where the section has the area of the circle
    for rim, loop, sign in zip(rims(found), found.rims, (-1.0, 1.0), strict=True):
        assert np.ptp(rim[:, 2]) < 1e-9 * c
        assert loop_area(found.vertices, loop) == pytest.approx(np.pi * radius**2, rel=2e-3)
        assert rim[:, 2].mean() == pytest.approx(sign * height, rel=2e-3)
        assert np.ptp(rim[:, 0]) / np.ptp(rim[:, 1]) == pytest.approx(a / b, rel=0.02)
    assert found.notes == () and found.ends.endswith(" by a plane")


@pytest.mark.parametrize("axes", [ROUND, BLADE])
def test_a_level_line_is_as_far_from_the_pole_as_wanted(axes: tuple[float, float, float]) -> None:
    radius = 0.4 * float(np.sqrt(axes[0] * axes[1]))
    found = opened(ellipsoid(axes), "level", radius)
    for rim, sign in zip(rims(found), (-1.0, 1.0), strict=True):
        assert np.linalg.norm(rim - [0.0, 0.0, sign * axes[2]], axis=1) == pytest.approx(radius, rel=1e-3)
    assert found.notes == () and "plane" not in found.ends


@pytest.mark.parametrize("seed", [None, 0, 1])
def test_auto_takes_the_plane_on_a_blade_only(seed: int | None) -> None:
    matrix = np.eye(3) if seed is None else rotation(seed)
    egg, blade = (opened(ellipsoid(axes), "auto", matrix=matrix) for axes in (ROUND, BLADE))
    assert egg.notes == () and "plane" not in egg.ends
    assert len(blade.notes) == 2 and all("is opened by a plane" in note for note in blade.notes)
    for rim in rims(blade):
        assert np.ptp(rim @ matrix[:, 2]) < 1e-9 * BLADE[2]
    whole = opened(ellipsoid(BLADE), "plane")
    assert [len(rim) for rim in blade.rims] == [len(rim) for rim in whole.rims]


def test_auto_is_the_level_line_where_that_is_even() -> None:
    part = ellipsoid(ROUND)
    auto, level = opened(part, "auto"), opened(part, "level")
    assert np.array_equal(auto.vertices, level.vertices) and np.array_equal(auto.faces, level.faces)


def test_a_flat_end_is_opened_below_its_edge_and_a_note_says_so() -> None:
    for part, flat in ((blob(Grid(48)), 2), (bottle(grid=Grid(48)), 1)):
        found = mw.annulus(mesh_from(part.vertices, part.faces), opening=8.0, opening_by="plane")
        notes = [note for note in found.notes if "is flat, so that a plane opens it to radius" in note]
        assert len(notes) == flat and all("instead of 8" in note for note in notes)
        lowest = min(rims(found), key=lambda rim: float(rim[:, 2].mean()))
        length = 120.0 if flat == 2 else 130.0
        assert lowest[:, 2] == pytest.approx(0.01 * length, rel=0.05)


def test_unevenness_of_rims_with_known_shapes() -> None:
    turn = np.arange(400) * 2.0 * np.pi / 400
    circle = np.column_stack([np.cos(turn), np.sin(turn), np.zeros(400)])
    outward, centre = np.array([0.0, 0.0, 1.0]), np.zeros(3)
    assert Rim(circle).radius == pytest.approx(1.0, rel=1e-4)
    assert Rim(circle).unevenness(centre, outward) == pytest.approx(0.0, abs=1e-12)
    assert Rim(circle + [0.3, 0.4, 2.0]).unevenness(centre, outward) == pytest.approx(0.5, rel=1e-3)
    saddle = circle + 0.01 * np.cos(2.0 * turn)[:, None] * outward
    assert Rim(saddle).unevenness(centre, outward) == pytest.approx(0.01 / np.sqrt(2.0), rel=2e-3)


@pytest.mark.parametrize(("radius", "size"), [(1e-3, "small"), (300.0, "large")])
@pytest.mark.parametrize("by", ["plane", "level"])
def test_openings_that_do_not_fit_are_refused_with_those_that_do(by: str, radius: float, size: str) -> None:
    with pytest.raises(mw.BadInputError, match=rf"opening {radius:g} is too {size} at .*; give a radius between"):
        opened(ellipsoid(ROUND, 4), by, radius)


def test_other_words_are_refused() -> None:
    with pytest.raises(mw.BadInputError, match="give auto, level or plane"):
        mw.annulus(mesh_from(*ball()), opening_by="knife")


@pytest.mark.parametrize(("by", "said"), [("auto", False), ("plane", True), ("level", True)])
def test_a_kind_of_opening_that_is_not_needed_is_said_to_be_unused(by: str, said: bool) -> None:
    vase = mw.read(Path(__file__).parents[1] / "data" / "vase.stl")
    assert ("no opening cut as both are open" in mw.annulus(vase, opening_by=by).ends) == said
