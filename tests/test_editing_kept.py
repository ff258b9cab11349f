"""What an edit keeps where it is asked to: one direction, the volume, and gaps that may stay."""

import numpy as np
import pytest
from test_editing import hyperboloid, straight

import meshwind as mw
from meshwind.editing.edit import edit
from meshwind.editing.options import EditOptions
from meshwind.editing.result import Outcome
from meshwind.editing.shape_rows import same_volume
from meshwind.surface import Surface, shapes
from meshwind.workflow.options import Options

WINDING = Options(8, 0.0, 61)


def outward(before: Surface, after: Surface) -> np.ndarray:
    """How far points move outward (k,)."""
    uv = np.random.default_rng(5).uniform(size=(4000, 2))
    return ((after.points(uv) - before.points(uv)) * before.normals(uv)).sum(axis=1)


def volume(surface: Surface) -> float:
    """The volume between the planes of the rims, by the divergence theorem on (x, y, 0) / 2, on a fine lattice."""
    u, v = np.meshgrid(np.arange(256) / 256, (np.arange(256) + 0.5) / 256)
    frames = surface.frames(np.stack([u.ravel(), v.ravel()], axis=1))
    flux = np.cross(frames[:, 1], frames[:, 2]) * frames[:, 0] * [0.5, 0.5, 0.0]
    return abs(float(flux.sum())) / 256**2


def test_free_it_moves_both_ways_and_asked_only_one() -> None:
    surface = hyperboloid()
    free, out, inward = (
        edit(surface, WINDING, EditOptions(only_outward=out, only_inward=inward))
        for out, inward in ((False, False), (True, False), (False, True))
    )
    assert outward(surface, free.surface).min() < -0.05 and outward(surface, free.surface).max() > 0.05
    assert all(each.outcome is Outcome.WINDABLE for each in (free, out, inward))
    most = outward(surface, free.surface).max()
    assert outward(surface, out.surface).min() > -0.01 * most  # between samples
    assert outward(surface, out.surface).max() > 0.3
    assert outward(surface, inward.surface).max() < 0.01 * most
    assert outward(surface, inward.surface).min() < -0.3


def test_the_volume_is_kept_to_a_thousandth() -> None:
    surface = hyperboloid()
    assert volume(surface) == pytest.approx(2 * np.pi * (1.5 + 0.36 * 1.5**3 / 3), rel=1e-3)
    free, kept = (edit(surface, WINDING, EditOptions(keep_volume=keep)) for keep in (False, True))
    assert kept.outcome is Outcome.WINDABLE
    assert abs(volume(free.surface) / volume(surface) - 1) > 3e-3
    assert abs(volume(kept.surface) / volume(surface) - 1) < 1e-3


def test_the_row_of_the_volume_is_its_derivative() -> None:
    surface = shapes.ellipsoid(1.0, 0.8, 1.5, 0.8, 2.3, (24, 24))
    net = surface.control_points
    change = 1e-4 * np.random.default_rng(1).standard_normal(net.shape)
    row, other = same_volume(surface, surface), same_volume(surface, Surface(net + change))
    # least is -(gone + room) and gone - room, over about the area: half their difference is what is gone
    gone = 0.5 * (other.least[1] - other.least[0])
    assert 0.5 * (row.least[1] - row.least[0]) == 0.0
    assert row.matrix[[0]] @ change.ravel() == pytest.approx(gone, rel=1e-3)
    assert abs(gone) > 1e-7


@pytest.mark.parametrize("share", [0.3, 0.8])
def test_gaps_that_may_stay_are_left_and_less_is_moved(share: float) -> None:
    surface = hyperboloid()
    gap = np.sqrt(1.81) - 1
    assert straight(surface).gap.max() == pytest.approx(gap, rel=1e-3)
    whole, some = edit(surface, WINDING), edit(surface, WINDING, EditOptions(at_most=share * gap))
    assert some.outcome is Outcome.WINDABLE and some.bridged == 0.0
    assert 0.9 * share * gap < some.paths.gap.max() <= share * gap
    size = [np.linalg.norm(each.surface.control_points - surface.control_points) for each in (whole, some)]
    assert size[1] < (1 - 0.8 * share) * size[0]
    above = edit(surface, WINDING, EditOptions(at_most=1.01 * gap))
    assert above.rounds == () and above.outcome is Outcome.WINDABLE


def test_both_ways_at_once_are_refused() -> None:
    with pytest.raises(mw.BadInputError, match="give one of them"):
        EditOptions(only_outward=True, only_inward=True)
