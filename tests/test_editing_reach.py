"""The largest gap that an edit leaves within bounds and frozen ranges, against programs that are assembled here."""

from pathlib import Path

import clarabel
import numpy as np
import pytest
from scipy import sparse

import meshwind as mw
from meshwind.editing.demands import reach
from meshwind.editing.edit import Edit, edit
from meshwind.editing.frozen_part import frozen_part
from meshwind.editing.options import EditOptions
from meshwind.editing.result import Outcome
from meshwind.editing.trust import FAILED, Trust
from meshwind.editing.windings import Course
from meshwind.path import Paths
from meshwind.surface import Surface
from meshwind.workflow.options import Options

VASE = mw.read(Path(__file__).parents[1] / "data" / "vase.stl")
BOUND = 5.0
WINDING = Options(12, 0.8, 201)


@pytest.fixture(scope="module")
def held() -> tuple[Surface, np.ndarray, Edit]:
    """The vase with a tenth frozen at both ends: its surface, what is frozen of the net, and its edit."""
    chart = mw.flatten(mw.annulus(VASE))
    surface = mw.fit(chart)
    mask = np.asarray(frozen_part("v<0.1, v>0.9", VASE, VASE).on(surface, chart))
    return surface, mask, edit(surface, WINDING, EditOptions(bound=BOUND, frozen=mask, rounds=4))


def largest(paths: Paths) -> float:
    return float(paths.gap.max())


def least_step(paths: Paths, free: np.ndarray, moved: np.ndarray, near: float) -> np.ndarray:
    """The change (m, 3) of least largest shortfall of all rows, where no free point moves further than two balls."""
    rows, columns = reach(paths), (3 * free[:, None] + np.arange(3)).ravel()
    count, n = len(rows.least), len(columns)
    slack = sparse.csc_matrix(np.append(np.full(count, -1.0), -1.0)[:, None])
    linear = sparse.vstack([-rows.matrix[:, columns], sparse.csc_matrix((1, n))])
    below = 4 * np.repeat(np.arange(len(free)), 3) + np.tile([1, 2, 3], len(free))
    ball = sparse.csc_matrix((-np.ones(n), (below, np.arange(n))), shape=(4 * len(free), n + 1))
    size = [np.full((len(free), 1), each) for each in (BOUND, near)]
    solver = clarabel.DefaultSolver(
        sparse.csc_matrix(sparse.diags_array(np.append(np.full(n, 1e-9), 0.0))),
        np.append(np.zeros(n), 1.0),
        sparse.csc_matrix(sparse.vstack([sparse.hstack([linear, slack]), ball, ball])),
        np.concatenate([
            -rows.least, [0.0], np.hstack([size[0], moved[free]]).ravel(), np.hstack([size[1], 0 * moved[free]]).ravel()
        ]),
        [clarabel.NonnegativeConeT(count + 1), *[clarabel.SecondOrderConeT(4)] * (2 * len(free))],
        quiet(),
    )  # fmt: skip
    change = np.zeros(moved.size)
    change[columns] = solver.solve().x[:n]
    return change.reshape(-1, 3)


def quiet() -> clarabel.DefaultSettings:
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    return settings


def at_rest(first: Surface, start: Surface, mask: np.ndarray, near: float, steps: int) -> float:
    """The largest gap after so many linearisations, each kept where it lowers the gap that is wound with it."""
    course, free = Course.of(WINDING), np.flatnonzero(~mask.ravel())
    net, paths = start.control_points, course.dense(start)
    for _ in range(steps):
        moved = (net - first.control_points).reshape(-1, 3)
        trial = net + least_step(paths, free, moved, near).reshape(net.shape)
        wound = course.again(Surface(trial), paths)
        if largest(wound) < largest(paths):
            net, paths, near = trial, wound, 1.5 * near
        else:
            near *= 0.4
    return largest(paths)


def test_no_other_program_lowers_the_largest_gap_by_more_than_a_hundredth(
    held: tuple[Surface, np.ndarray, Edit],
) -> None:
    surface, mask, found = held
    assert found.outcome is Outcome.OUT_OF_REACH
    moved = found.surface.control_points - surface.control_points
    assert (moved[mask] == 0.0).all() and np.linalg.norm(moved, axis=2).max() <= BOUND * (1 + 1e-12)
    course = Course.of(WINDING)
    before, after = largest(course.dense(surface)), largest(course.dense(found.surface))
    assert after < 0.95 * before
    assert after <= 1.01 * at_rest(surface, surface, mask, 0.2, 12)
    assert after <= 1.01 * at_rest(surface, found.surface, mask, 0.1, 8)


def test_the_paths_that_are_asked_for_gain_as_well_as_those_between(held: tuple[Surface, np.ndarray, Edit]) -> None:
    surface, _, found = held
    assert largest(found.paths) < 0.97 * largest(Course.of(WINDING).laid(surface))
    assert "frozen" in found.left[0].held_by


def test_rounds_go_further_where_a_program_was_right_and_less_far_where_not() -> None:
    trust = Trust()
    assert trust.after(2.0, 1.0, (1.0, 0.5, 0.55)) == Trust()  # right, without a limit
    near = trust.after(2.0, 0.25, (1.0, 0.5, 0.9))
    assert near == Trust(1.0)  # twice the share that was made
    assert near.after(1.0, 1.0, (1.0, 0.9, 0.91)) == Trust(2.0)
    assert near.after(1.0, 1.0, (1.0, 0.9, 0.95)) == Trust(1.0)
    assert near.after(1.0, 1.0, (1.0, 0.9, 0.99)) == Trust(0.4)
    for failed in range(1, FAILED):
        near = near.after(1.0, 0.1, (1.0, 0.9, 1.0))
        assert near == Trust(0.1, failed)
    assert near.after(1.0, 0.1, (1.0, 0.9, 1.0)).at_rest
    assert trust.after(1.0, 1.0, (1.0, 0.9999, 0.9)).at_rest  # next to nothing is to be had
