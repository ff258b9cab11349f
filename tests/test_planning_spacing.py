"""New paths between neighbours that lie too far apart."""

import numpy as np
import pytest
from layup_shapes import cylinder, fitted, helices, wound

from meshwind.core.errors import BadInputError
from meshwind.layup.neighbours import neighbours
from meshwind.path import Paths
from meshwind.planning.spacing import Spaced, space_out
from meshwind.surface import Surface, shapes

CYLINDER = cylinder()


def test_no_gap_is_left_and_ends_are_where_they_belong() -> None:
    surface = shapes.elbow(3.0, 1.0, spans=(48, 32))
    even = wound(surface, 6, 1.0)
    spaced = space_out(even, 1.0, 0.25)
    assert len(spaced.partings) == 0
    assert spaced.gap <= 0.25
    assert (spaced.paths.status == 0).all()
    assert neighbours(spaced.paths).largest.max() <= 0.25
    assert spaced.even == 6
    # the ends of both rims are at the same shares of their lengths, turned by one
    turn = spaced.paths.uv[:, -1, 0] - spaced.paths.uv[:, 0, 0]
    assert np.abs(turn - spaced.paths.family).max() < 0.1
    assert np.abs(spaced.share[:, None] - np.arange(6) / 6).min(axis=0).max() < 1e-12
    for family in (1, -1):
        assert (np.diff(spaced.share[spaced.paths.family == family]) > 0).all()


def test_wide_enough_paths_are_left_alone_and_even_ones_stay_even() -> None:
    even = wound(shapes.cone(1.0, 0.5, 3.0, (64, 8)), 6, 0.3)
    assert len(space_out(even, 0.3, 10.0).paths) == 12
    spaced = space_out(even, 0.3, 0.2)
    by_family = [np.diff(spaced.share[spaced.paths.family == family]) for family in (1, -1)]
    assert np.concatenate(by_family) == pytest.approx(np.full(len(spaced.paths) - 2, by_family[0][0]))


def largest_gap(paths: Paths, partings: tuple[int, int]) -> float:
    """The largest distance between neighbours, but for the largest of each family, as many as it has partings."""
    near = neighbours(paths)
    left = []
    for family, many in zip((1, -1), partings, strict=True):
        gap = np.sort(near.largest[near.family == family])
        left.append(gap[: max(len(gap) - many, 0)])
    return float(np.concatenate(left).max(initial=0.0))


def compared(surface: Surface, turns: float, spacing: float) -> tuple[Spaced, float]:
    """Spaced paths, and the largest gap of as many even ones."""
    spaced = space_out(wound(surface, 8, turns), turns, spacing)
    count = max(int((spaced.paths.family == family).sum()) for family in (1, -1))
    return spaced, largest_gap(wound(surface, count, turns), spaced.parted)


@pytest.mark.parametrize(("name", "turns", "spacing"), [("cast.ply", 2.06, 10.0), ("bottle.obj", 0.3, 10.0)])
def test_new_paths_where_they_are_needed_beat_as_many_even_ones(name: str, turns: float, spacing: float) -> None:
    """As in Fig. 6.6, at equal count; both parts have a boss that fibres part around, which no spacing mends."""
    spaced, even = compared(fitted(name), turns, spacing)
    assert spaced.gap <= spacing
    assert spaced.gap <= 0.85 * even
    assert 0 < len(spaced.partings) <= 6
    assert spaced.widest > 3.0 * spacing


@pytest.mark.parametrize("spacing", [0.0, -1.0, float("nan"), float("inf")])
def test_a_spacing_that_is_no_length_is_refused(spacing: float) -> None:
    with pytest.raises(BadInputError, match="give a length above 0"):
        space_out(helices(3, 1.0, 11, CYLINDER), 1.0, spacing)


@pytest.mark.parametrize("spacing", [1e-3, 1e-8, 1e-300])
def test_a_spacing_that_takes_too_many_paths_is_refused_before_they_are_laid(
    spacing: float, monkeypatch: pytest.MonkeyPatch
) -> None:
    even = wound(shapes.cone(1.0, 0.5, 3.0, (64, 8)), 6, 0.3, 25)
    monkeypatch.setattr("meshwind.planning.spacing.solve", None)
    with pytest.raises(BadInputError, match="give a larger one"):
        space_out(even, 0.3, spacing)
