"""An edit moves as little as possible, and as far as bounds allow: against optima from other programs and solvers."""

import numpy as np
import piqp
import pytest
from scipy import optimize, sparse
from scipy.interpolate import BSpline
from test_editing import hyperboloid, straight

from meshwind.editing.demands import reach
from meshwind.editing.edit import edit
from meshwind.editing.options import EditOptions
from meshwind.editing.result import Outcome
from meshwind.editing.stencil import weights
from meshwind.editing.step import energy
from meshwind.surface import Surface, shapes
from meshwind.workflow.options import Options


def of_profile(surface: Surface) -> np.ndarray:
    """Moves (3m, 2 nv) of the net outward and along z, the same all around."""
    net = surface.control_points
    out = net * [1.0, 1.0, 0.0]
    out /= np.linalg.norm(out, axis=2, keepdims=True)
    moves = np.zeros((*net.shape, 2, net.shape[1]))
    row = np.arange(net.shape[1])
    moves[:, row, :, 0, row] = np.moveaxis(out, 1, 0)
    moves[:, row, 2, 1, row] = 1.0
    return moves.reshape(net.size, -1)


def least_gap(surface: Surface, moved: np.ndarray, held: int, bound: float) -> float:
    """The least largest shortfall by linear programs of HiGHS, with ever more lines that touch the bound's circles."""
    rows, turn = reach(straight(surface, 16)), of_profile(surface)
    start = np.linalg.lstsq(turn, moved.ravel())[0]
    n = len(start) // 2
    free = np.arange(held, n - held)
    A = np.hstack([-(rows.matrix @ turn), -np.ones((len(rows.least), 1))])
    angle = 2 * np.pi * np.arange(720) / 720
    lines = np.zeros((len(free), len(angle), 2 * n + 1))
    lines[np.arange(len(free)), :, free] = np.cos(angle)
    lines[np.arange(len(free)), :, n + free] = np.sin(angle)
    tangents = lines.reshape(len(free) * len(angle), 2 * n + 1)
    far = bound - tangents[:, :-1] @ start
    fixed = [(0.0, 0.0) if k % n < held or k % n >= n - held else (None, None) for k in range(2 * n)]
    found = optimize.linprog(
        np.append(np.zeros(2 * n), 1.0), np.vstack([A, tangents]), np.append(-rows.least, far),
        bounds=[*fixed, (None, None)],
    )  # fmt: skip
    return float(found.x[-1])


@pytest.mark.parametrize("held", [0, 3])
def test_within_a_bound_the_largest_gap_becomes_the_least(held: int) -> None:
    surface, bound = hyperboloid(), 0.1
    mask = np.zeros(surface.control_points.shape[:2], dtype=bool)
    mask[:, :held] = mask[:, surface.control_points.shape[1] - held :] = True
    found = edit(surface, Options(16, 0.0, 61), EditOptions(bound=bound, frozen=mask))
    assert found.outcome is Outcome.OUT_OF_REACH
    moved = found.surface.control_points - surface.control_points
    assert np.linalg.norm(moved, axis=2).max() <= bound * (1 + 1e-12)
    assert (moved[mask] == 0.0).all()
    before, after = np.sqrt(1.81) - 1, float(found.paths.gap.max())
    assert before - after > 0.9 * bound
    assert after == pytest.approx(least_gap(found.surface, moved, held, bound), rel=0.01)
    worst = found.left[0]
    assert worst.gap == after and len(found.left) == 32 and worst.v == (0.0, 1.0)
    assert worst.held_by == ("bound",) if held == 0 else set(worst.held_by) <= {"bound", "frozen"}
    assert worst.by_bound == pytest.approx((before - after) / bound, rel=0.02)  # it is linear here
    assert (worst.by_frozen == {}) if held == 0 else worst.by_frozen["frozen"] > 0.9  # the rims alone carry 1


def least_profile(surface: Surface, pressing: float) -> float:
    """The least energy of a change of a round net whose meridians are curved enough, by SLSQP on the profile."""
    net, turn = surface.control_points, of_profile(surface)
    count, n = int(net.shape[0]), int(net.shape[1])
    share = (2.0 + np.cos(2.0 * np.pi / count)) / 3.0  # of the net's radius, that of the surface at its knots
    start = np.append(np.hypot(net[0, :, 0], net[0, :, 1]), net[0, :, 2])
    knots = np.arange(-3, n + 1) / (n - 3)
    splines = BSpline(knots, np.eye(n), 3)
    _, once, twice = (splines.derivative(k)(np.linspace(0.0, 1.0, 121)) if k else None for k in range(3))
    assert once is not None and twice is not None
    rate, bend = (np.block([[share * b, 0 * b], [0 * b, b]]) for b in (once, twice))
    most = pressing / surface.size

    def beyond(x: np.ndarray) -> np.ndarray:
        (r, z), (rr, zz) = ((b @ (start + x)).reshape(2, -1) for b in (rate, bend))
        curved = (r * zz - z * rr) * np.sign(np.mean(once @ start[n:])) - most * np.hypot(r, z) ** 3
        upward = z / (once @ start[n:]) - 0.3  # the profile must not fold
        return np.append(curved, upward)

    cost = turn.T @ (energy(surface, EditOptions.fairness) @ turn)
    found = optimize.minimize(
        lambda x: x @ cost @ x, np.zeros(2 * n), jac=lambda x: 2 * cost @ x, method="SLSQP",
        constraints=dict(type="ineq", fun=beyond), options=dict(maxiter=300, ftol=1e-9),
    )  # fmt: skip
    assert beyond(found.x).min() > -1e-6
    return float(found.fun)


@pytest.mark.parametrize("shape", [(1.0, 0.6, 1.5), (1.0, 0.9, 1.5), (1.0, 0.6, 1.0)])
def test_a_round_waist_is_moved_no_more_than_needed(shape: tuple[float, float, float]) -> None:
    surface = shapes.hyperboloid(*shape, (16, 16))
    found = edit(surface, Options(16, 0.0, 61))
    assert found.outcome is Outcome.WINDABLE
    change = (found.surface.control_points - surface.control_points).ravel()
    spent = float(change @ (energy(surface, EditOptions.fairness) @ change))
    assert spent == pytest.approx(least_profile(surface, EditOptions.pressing), rel=0.05)


def least_by_curvature(surface: Surface, count: int, pressing: float) -> float:
    """The least energy by own programs, solved by PIQP to rest: the meridians' curvature on S_u x S_v, linearised."""
    net, m = surface.control_points, surface.control_points.size // 3
    cost, change = energy(surface, EditOptions.fairness), np.zeros(net.size)
    for _ in range(6):
        now = Surface(net + change.reshape(net.shape))
        lines = straight(now, count).uv
        once, twice = np.gradient(lines, axis=1), np.gradient(np.gradient(lines, axis=1), axis=1)
        uv, tangent, bend = (each[:, 1:-1:2].reshape(-1, 2) for each in (lines, once, twice))
        which, (u, v, uu, uv_, vv) = weights(now, uv, ((1, 0), (0, 1), (2, 0), (1, 1), (0, 2)))
        a, b = tangent.T[:, :, None]
        first = a * u + b * v
        second = a * a * uu + 2 * a * b * uv_ + b * b * vv + bend[:, :1] * u + bend[:, 1:] * v
        at = now.control_points.reshape(-1, 3)[which]
        s_u, s_v, t, tt = (np.einsum("kj,kjd->kd", w, at) for w in (u, v, first, second))
        normal = np.cross(s_u, s_v)
        area, speed = np.linalg.norm(normal, axis=1), np.linalg.norm(t, axis=1)
        kappa = pressing / surface.size
        value = -(tt * normal).sum(axis=1) - kappa * speed**2 * area
        by_normal = -tt - (kappa * speed**2 / area)[:, None] * normal
        part = (
            second[:, :, None] * -normal[:, None] - first[:, :, None] * (2 * kappa * area[:, None] * t)[:, None]
            + u[:, :, None] * np.cross(s_v, by_normal)[:, None] + v[:, :, None] * np.cross(by_normal, s_u)[:, None]
        )  # fmt: skip
        row, column = np.repeat(np.arange(len(uv)), part[0].size), 3 * which[:, :, None] + np.arange(3)
        rows = sparse.csr_array((part.ravel(), (row, column.ravel())), (len(uv), 3 * m))
        length = np.sqrt(rows.multiply(rows).sum(axis=1))
        solver = piqp.SparseSolver()
        G = sparse.csc_matrix(sparse.diags_array(1.0 / length) @ rows)
        solver.setup(sparse.csc_matrix(cost), np.zeros(3 * m), G=G, h_l=(rows @ change - value) / length)
        solver.solve()
        change = np.array(solver.result.x)
    return float(change @ (cost @ change))


def test_a_waist_that_is_not_round_is_moved_no_more_than_needed() -> None:
    surface = Surface(shapes.hyperboloid(1.0, 0.6, 1.5, (16, 16)).control_points * [1.3, 1.0, 1.0])
    found = edit(surface, Options(16, 0.0, 61))
    assert found.outcome is Outcome.WINDABLE
    change = (found.surface.control_points - surface.control_points).ravel()
    spent = float(change @ (energy(surface, EditOptions.fairness) @ change))
    assert spent == pytest.approx(least_by_curvature(surface, 16, EditOptions.pressing), rel=0.05)
