"""Automatic surface editing: the program's certificate, what may not move, and parts that wind after it."""

from pathlib import Path

import numpy as np
import piqp
import pytest
import trimesh
from scipy import sparse

import meshwind as mw
from meshwind.editing.demands import Demands, press, reach
from meshwind.editing.edit import edit
from meshwind.editing.edited_mesh import displacement, within
from meshwind.editing.freedom import free_moves, frozen_mask
from meshwind.editing.options import EditOptions
from meshwind.editing.program import ACCURACY, FEW, Balls, Program, certified, minimise
from meshwind.editing.redesign import redesign
from meshwind.editing.result import Outcome
from meshwind.editing.shape_rows import nothing
from meshwind.editing.stencil import pitches
from meshwind.editing.step import SOFTNESS, Demanded, Limits, energy, rows_of, soft
from meshwind.mesh import mesh_from
from meshwind.mesh.geometry.areas_and_volumes import volume
from meshwind.surface import Surface, shapes
from meshwind.workflow.options import Options

DATA = Path(__file__).parents[1] / "data"


def hyperboloid() -> Surface:
    return shapes.hyperboloid(1.0, 0.6, 1.5, (16, 16))


def straight(surface: Surface, count: int = 8) -> mw.Paths:
    """Paths along the meridians, which bridge the waist from rim to rim."""
    u = np.arange(count) / count
    ends = [np.stack([u, np.full(count, v)], axis=1) for v in (0.0, 1.0)]
    return mw.solve(surface, ends[0], ends[1], particles=61)


def real_program(surface: Surface) -> Program:
    laid = straight(surface)
    whole = reach(laid), press(laid, 0.2 / surface.size)
    moves = free_moves(surface, frozen_mask(surface, None))
    moved = np.zeros((surface.control_points.size // 3, 3))
    demanded = Demanded(
        *whole, energy(surface, 0.2), Limits(moves, moved, np.full(len(moved), np.inf), nothing(surface)), 1e-3
    )
    return soft(rows_of(demanded, whole[0].chosen))


def by_piqp(program: Program) -> float:
    solver = piqp.SparseSolver()
    P, A = sparse.csc_matrix(program.P), sparse.csc_matrix(program.A)
    solver.setup(P, program.q, G=A, h_l=program.low)
    solver.solve()
    return float(solver.result.info.primal_obj)


def with_few_rows_violated() -> Program:
    """Where the rows violated without a change lead to one that violates others."""
    rng = np.random.default_rng(3)
    A = sparse.csc_array(rng.normal(size=(400, 20)))
    low = np.where(np.arange(400) % 50 == 7, 1.0, -0.05)
    assert (low > 0.0).mean() < FEW
    return Program(sparse.csc_array(np.eye(20)), np.zeros(20), A, low - 0.6)


@pytest.mark.parametrize("program", [real_program(hyperboloid()), with_few_rows_violated()])
def test_clarabel_and_piqp_agree_and_the_certificate_holds(program: Program) -> None:
    found = minimise(program)
    assert program.A.shape[0] > 100
    assert found.primal <= ACCURACY and found.dual <= ACCURACY
    assert found.objective == pytest.approx(by_piqp(program), rel=1e-5)


def test_the_certificate_sees_a_wrong_answer() -> None:
    # min x^2 / 2 + y^2 / 2 - 3 y with x >= 1 and |(x, y, 0)| <= 2: (1, sqrt 3)
    eye = sparse.csc_array(np.eye(2))
    ball = Balls(sparse.csr_array([[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]]), np.zeros(3), np.array([2.0]))
    A = sparse.csc_array(np.array([[1.0, 0.0]]))
    program = Program(eye, np.array([0.0, -3.0]), A, np.array([1.0]), ball)
    root = np.sqrt(3.0)
    x, pull = np.array([1.0, root]), 2.0 * (3.0 - root) / root  # the gradient (1, root - 3) is -pull (1, root) / 2 + y
    y = np.array([1.0 + pull / 2.0])
    right = minimise(program)
    assert right.solved and right.x == pytest.approx(x, abs=1e-7)
    assert right.multipliers == pytest.approx(y, abs=1e-6) and right.pulls == pytest.approx([pull], abs=1e-6)
    size = float(y[0])  # residuals count over the largest multiplier
    assert certified(program, x, y, np.array([pull]), 0).solved
    assert certified(program, x - [0.5, 0.0], y, np.array([pull]), 0).primal == pytest.approx(0.5)
    assert certified(program, 2.0 * x, y, np.array([pull]), 0).primal == pytest.approx(2.0)
    assert certified(program, x, y + 0.3, np.array([pull]), 0).dual == pytest.approx(0.3 / (size + 0.3))
    assert certified(program, x, y, np.array([0.0]), 0).dual > 0.1
    assert certified(program, 0.5 * x, y, np.array([pull]), 0).dual == pytest.approx(max(0.5 * size, pull) / size)


def test_without_an_active_row_nothing_moves_and_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    A = sparse.csc_array(np.array([[1.0, 0.0]]))
    found = minimise(Program(sparse.csc_array(np.eye(2)), np.zeros(2), A, np.array([-1.0])))
    assert found.solved and (found.x == 0.0).all() and (found.multipliers == 0.0).all()
    assert capfd.readouterr() == ("", "")


def test_one_row_has_the_answer_in_closed_form() -> None:
    # min |c|^2 / 2 + t^2 / 2 with w.c + sqrt(d) t >= b: c = w b / (w.w + d), along one direction, by the weights
    surface = hyperboloid()
    laid = straight(surface, 1)
    whole = reach(laid)
    middle = int(np.argmax(whole.least))
    one = Demands(whole.matrix[[middle]], whole.least[[middle]], np.array([True]), np.array([False]), np.ones(1))
    none = Demands(whole.matrix[:0], whole.least[:0], np.zeros(0, dtype=bool), np.zeros(0, dtype=bool), np.ones(0))
    moves = free_moves(surface, frozen_mask(surface, None))
    moved = np.zeros((surface.control_points.size // 3, 3))
    limits = Limits(moves, moved, np.full(len(moved), np.inf), nothing(surface))
    rows = rows_of(Demanded(one, none, energy(surface, 0.0), limits, 0.0), one.chosen)
    change = minimise(soft(rows)).x[: moved.size] * rows.unit
    weight = one.matrix.toarray()[0]
    size = float(np.linalg.norm(weight))
    assert change == pytest.approx(weight / size**2 * one.least[0] / (1 + SOFTNESS), abs=1e-8)
    # the waist of the hyperboloid lies this far below the chord between the rims, and both move
    assert one.least[0] == pytest.approx(np.sqrt(1 + 0.81) - 1, rel=1e-3)
    net = surface.control_points
    grown = np.array([1.0, 1.0, 0.0]) * net  # the whole part as thick again: the fibre comes along
    assert weight @ grown.ravel() == pytest.approx(1.0 - np.sqrt(1.81), rel=1e-3)


def test_a_row_of_press_is_the_derivative_of_the_normal_curvature() -> None:
    surface = shapes.ellipsoid(1.0, 0.8, 1.5, 0.8, 2.3, (24, 24))
    laid = mw.solve(surface, [(0.0, 0.0)], [(0.2, 1.0)], particles=81)
    rng = np.random.default_rng(3)
    change = 1e-5 * rng.standard_normal(surface.control_points.shape)
    demanded = press(laid, 0.0)
    moved = Surface(surface.control_points + change)
    again = mw.Paths(**{**laid.__dict__, "surface": moved})
    # rows are scaled by the square of the span's length, which the change moves in its sixth digit
    predicted = demanded.least - demanded.matrix @ change.ravel()
    assert press(again, 0.0).least == pytest.approx(predicted, rel=2e-3, abs=2e-6)
    assert np.abs(predicted - demanded.least).max() > 1e-5


def test_at_the_rims_the_fibres_must_press_more_and_a_thinned_program_has_fewer_rows() -> None:
    surface = hyperboloid()
    laid, curvature = straight(surface), 0.2 / surface.size
    plain, firm = press(laid, curvature), press(laid, curvature, rim=3.0)
    more = (firm.least - plain.least) / (2.0 * curvature * max(pitches(surface)) ** 2)
    assert set(np.round(more, 9)) == {0.0, 1.0}
    assert more.mean() == pytest.approx(2.0 / surface.spans[1], abs=1.0 / surface.spans[1])  # of fibres rim to rim
    thin = firm.thinned(4)
    assert abs(thin.chosen.sum() - firm.chosen.sum() / 4) < 1 and not (thin.chosen & ~firm.chosen).any()


def test_a_hyperboloid_becomes_a_barrel_that_the_fibres_press() -> None:
    surface = hyperboloid()
    found = edit(surface, Options(8, 0.0, 121))
    assert found.outcome is Outcome.WINDABLE and len(found.rounds) <= 10
    assert found.bridged == 0.0 and found.paths.gap.max() <= found.threshold
    assert found.rounds[0].gap_before == pytest.approx(np.sqrt(1.81) - 1, rel=1e-3)
    u = np.arange(64) / 64
    radius = [np.hypot(*found.surface.points(np.stack([u, np.full(64, v)], axis=1))[:, :2].T) for v in (0.0, 0.5, 1.0)]
    assert (radius[1] > 0.5 * (radius[0] + radius[2])).all()  # at least the straight line between the rims, ...
    assert (radius[1] < 1.1 * np.sqrt(1.81)).all()  # ... and not much more
    assert all(max(r.primal, r.dual) <= ACCURACY for r in found.rounds)


def test_the_inner_bend_of_an_elbow_comes_up_to_its_chord() -> None:
    surface = shapes.elbow(3.0, 1.0, np.pi / 4, (16, 16))
    found = edit(surface, Options(8, 0.0, 121))
    assert found.outcome is Outcome.WINDABLE
    start, inner, end = np.hypot(*found.surface.points([[0.5, v] for v in (0.0, 0.5, 1.0)])[:, :2].T)
    assert start == pytest.approx(end, abs=1e-3) and 2.0 < start < 2.12  # the ends give way, as that is less to move
    chord = start * np.cos(np.pi / 8)  # from the bend's axis to the chord of the intrados, whose radius was 2
    assert chord - 0.03 < inner < chord + 1e-4  # a gap of so much counts as none


def test_frozen_control_points_do_not_move_and_impossible_demands_say_so() -> None:
    surface = hyperboloid()
    mask = np.zeros(surface.control_points.shape[:2], dtype=bool)
    mask[:, [0, 1, 2, 8, 9, 10, -3, -2, -1]] = True
    found = edit(surface, Options(8, 0.0, 61), EditOptions(frozen=mask))
    assert (found.surface.control_points[mask] == surface.control_points[mask]).all()
    assert found.outcome is Outcome.OUT_OF_REACH and "less" in found.outcome.advice
    assert found.bridged > 0 and found.rounds[-1].shortfall > 0.3
    assert all(each.held_by == ("frozen",) and each.by_bound == 0.0 for each in found.left)
    low = edit(surface, Options(8, 0.0, 61), EditOptions(rounds=1, frozen=lambda at: at[:, 2] < -1.6))
    below = surface.control_points[..., 2] < -1.6
    assert (low.surface.control_points[below] == surface.control_points[below]).all()
    assert (low.surface.control_points[~below] != surface.control_points[~below]).any()


def test_the_bound_holds_and_is_used() -> None:
    surface = hyperboloid()
    winding = Options(8, 0.0, 61)
    free = edit(surface, winding)
    held = edit(surface, winding, EditOptions(bound=0.285))
    far, near = (np.linalg.norm(e.surface.control_points - surface.control_points, axis=2).max() for e in (free, held))
    assert far > 0.29 and 0.28 < near <= 0.285 * (1 + 1e-12)
    assert held.outcome is Outcome.WINDABLE


@pytest.mark.parametrize("order", [4, 16])
def test_symmetry_is_kept_to_round_off(order: int) -> None:
    surface = hyperboloid()
    found = edit(surface, Options(3, 0.1, 61), EditOptions(symmetry=order, rounds=2))
    net, turn = found.surface.control_points, 2 * np.pi / order
    turned = net @ np.array([[np.cos(turn), np.sin(turn), 0], [-np.sin(turn), np.cos(turn), 0], [0, 0, 1.0]])
    assert np.abs(np.roll(net, -(16 // order), axis=0) - turned).max() < 1e-12
    assert np.abs(net - surface.control_points).max() > 0.05


@pytest.mark.parametrize("order", [8, 16])
def test_a_symmetry_of_high_order_costs_no_rounds(order: int) -> None:
    found = edit(hyperboloid(), Options(6, 0.05, 101), EditOptions(symmetry=order))
    assert found.outcome is Outcome.WINDABLE and len(found.rounds) <= 3


def test_a_part_that_presses_everywhere_is_left_alone() -> None:
    surface = shapes.ellipsoid(1.0, 1.0, 1.5, 0.8, 2.3, (24, 24))
    found = edit(surface, Options(4, 0.2, 61))
    assert found.rounds == () and found.outcome is Outcome.WINDABLE
    assert (found.surface.control_points == surface.control_points).all()


def test_the_same_part_in_other_units_gives_the_same_edit() -> None:
    surface = hyperboloid()
    large = Surface(1000.0 * surface.control_points)
    one, other = (edit(each, Options(4, 0.05, 61), EditOptions(rounds=1)) for each in (surface, large))
    change = one.surface.control_points - surface.control_points
    assert other.surface.control_points - large.control_points == pytest.approx(1000.0 * change, abs=1e-2)


@pytest.mark.parametrize(
    ("wrong", "words"),
    [
        (dict(symmetry=5), "give one of 1, 2, 4, 8, 16"),
        (dict(bound=0.0), "give a length above 0"),
        (dict(rounds=-1), "whole number"),
        (dict(fairness=-1.0), "number from 0 up"),
        (dict(frozen=np.zeros((3, 3), dtype=bool)), r"shape \(16, 19\)"),
        (dict(frozen=np.ones((16, 19), dtype=bool)), "leave some free"),
    ],
)
def test_wrong_options_are_refused_with_advice(wrong: dict[str, object], words: str) -> None:
    with pytest.raises(mw.BadInputError, match=words):
        edit(hyperboloid(), Options(revolutions=0.1), EditOptions(**wrong))  # type: ignore[arg-type]


def test_the_edited_vase_winds_from_its_file_without_bridges(tmp_path: Path) -> None:
    found = redesign(DATA / "vase.stl", revolutions=0.8)
    assert found.windable and found.bridged == 0.0 and len(found.rounds) <= 10
    original = mw.read(DATA / "vase.stl")
    assert (found.mesh.faces == original.faces).all()
    assert (found.mesh.vertices == original.vertices + found.displacement).all()
    assert found.turned_over == 0
    assert found.volume_change == pytest.approx(volume(found.mesh.vertices, found.mesh.faces) - found.volume)
    assert found.volume_change > 0
    file = tmp_path / "edited.ply"
    trimesh.Trimesh(found.mesh.vertices, found.mesh.faces, process=False).export(file)
    before, again = mw.wind(DATA / "vase.stl", revolutions=0.8), mw.wind(file, revolutions=0.8)
    error = again.surface.error
    assert error is not None
    assert before.paths.gap.max() > 10 * error.to_surface_max
    assert again.paths.gap.max() <= error.to_surface_max and again.settled


def test_caps_follow_their_rim_and_die_out_towards_the_pole() -> None:
    ball = trimesh.creation.icosphere(4, 1.0)
    part = mesh_from(ball.vertices * [1.0, 1.0, 2.0], ball.faces)
    chart = mw.flatten(mw.annulus(part, ends="z"))
    before = mw.fit(chart, 1e-4)
    outward = before.control_points * [0.05, 0.05, 0.0]
    after = Surface(before.control_points + outward)
    moves = displacement(chart, before, after)
    cap = np.abs(part.vertices[:, 2]) > np.abs(chart.annulus.vertices[:, 2]).max()
    assert cap.sum() > 10
    assert moves[~cap] == pytest.approx(part.vertices[~cap] * [0.05, 0.05, 0.0], abs=3e-4)
    assert (moves[np.abs(part.vertices[:, 2]) > 1.999] == 0).all()
    next_to = cap & np.isin(np.arange(len(cap)), part.faces[(~cap[part.faces]).any(axis=1)])
    assert np.abs(moves[next_to] - part.vertices[next_to] * [0.05, 0.05, 0.0]).max() < 4e-5
    edge = part.faces[:, :2]
    jump = np.linalg.norm(moves[edge[:, 0]] - moves[edge[:, 1]], axis=1)
    length = np.linalg.norm(part.vertices[edge[:, 0]] - part.vertices[edge[:, 1]], axis=1)
    assert (jump / length).max() < 0.25  # no tear: the strain stays of the order of the displacement over the fade
    assert np.linalg.norm(within(moves, 0.02), axis=1).max() <= 0.02 * (1 + 1e-12)
