"""What must not move, in words: ranges and fields to the control points that they hang on."""

import numpy as np
import pytest

import meshwind as mw
from meshwind.editing.region import parse
from meshwind.mesh.io.scalars import Scalars
from meshwind.surface import Surface, shapes

NONE = np.zeros((0, 2))


@pytest.mark.parametrize("text", ["v<0.2", "0.3<v<0.45", "z>1.2", "x > 0.5, v<0.1", "0.9<u", "-0.1<Y<.1"])
def test_whatever_else_moves_the_region_stays(text: str) -> None:
    surface = shapes.hyperboloid(1.0, 0.6, 1.5, (16, 16))
    held = parse(text).control_points(surface, NONE)
    assert held.any() and not held.all()
    rng = np.random.default_rng(2)
    change = np.where(held[..., None], 0.0, rng.standard_normal(surface.control_points.shape))
    moved = Surface(surface.control_points + change)
    uv = rng.uniform(size=(20_000, 2))
    points = surface.points(uv)
    names = {"u": uv[:, 0], "v": uv[:, 1], "x": points[:, 0], "y": points[:, 1], "z": points[:, 2]}
    rules = {
        "v<0.2": names["v"] < 0.2,
        "0.3<v<0.45": (names["v"] > 0.3) & (names["v"] < 0.45),
        "z>1.2": names["z"] > 1.2,
        "x > 0.5, v<0.1": (names["x"] > 0.5) | (names["v"] < 0.1),
        "0.9<u": names["u"] > 0.9,
        "-0.1<Y<.1": np.abs(names["y"]) < 0.1,
    }
    inside = rules[text]
    off = np.linalg.norm(moved.points(uv) - points, axis=1)
    assert off[inside].max() < 1e-3  # between the samples a corner of another span may be touched
    assert off[~inside].max() > 0.5


def test_a_field_holds_where_it_is_above_0() -> None:
    surface = shapes.cylinder(1.0, 2.0, (16, 16))
    points = surface.points(np.random.default_rng(3).uniform(size=(4000, 2)))
    upper = Scalars(points, (points[:, 2] > 1.5).astype(np.float64))
    by_name, ranged = parse("field:upper"), parse("z>1.5")
    assert by_name.field == "upper"
    field, by_range = by_name.control_points(surface, NONE, upper), ranged.control_points(surface, NONE)
    assert (field[:, -4:]).all() and not field[:, :10].any()
    assert (np.abs(field.sum(axis=1) - by_range.sum(axis=1)) <= 1).all()


@pytest.mark.parametrize("text", ["", "v", "w<1", "1>v>0", "v<", "field:", "v<0.1,,z<2", "field:a, field:b", "v<nan"])
def test_other_words_are_refused_with_what_may_be_said(text: str) -> None:
    with pytest.raises(mw.BadInputError, match="give ranges of u, v, x, y or z by commas"):
        parse(text)
