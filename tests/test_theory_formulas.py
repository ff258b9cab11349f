"""The formulas of the theory pages against the functions that implement them, each written out anew from the page.

Where the source is corrected, what it prints is tried as well, and must fail.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.editing.demands import reach
from meshwind.editing.stencil import along, weights
from meshwind.march.geodesic_equation import rates
from meshwind.methods import Ending, Motion, penalty, run
from meshwind.methods.chain import Physics
from meshwind.methods.in_space import PENALTY, SpaceRules, space_work
from meshwind.methods.strand import Strand
from meshwind.path.kernels.contact import lift, pull
from meshwind.path.kernels.state import blank, energy, no_contacts
from meshwind.path.solve import straight
from meshwind.planning.pressing import pressing
from meshwind.surface import Surface, shapes
from meshwind.surface.foot import Expansion, Gradient, Symmetric, foot, newton_step

N = 9
H, DAMPING = 0.7, 0.3
ANYWHERE = np.array([[0.13, 0.21], [0.47, 0.55], [0.92, 0.83]])


@cache
def skew() -> Surface:
    """A tube without symmetry, convex in some places and hollow in others, in a chart that is not orthogonal."""

    def formula(u: Floats, v: Floats) -> Floats:
        turn = 2 * np.pi * (u + 0.2 * v)
        radius = 1.2 + 0.15 * np.cos(2 * turn) + 0.2 * np.cos(2 * np.pi * v)
        return np.stack([radius * np.cos(turn), radius * np.sin(turn), 2.0 * v + 0.2 * np.sin(turn)], axis=-1)

    return shapes.parametric(formula, (64, 32))


def wavy(n: int = N) -> Floats:
    """A curve (n, 2) in the parametric plane, unevenly spaced, its particles all inside the rims."""
    t = np.linspace(0.0, 1.0, n)
    return np.stack([0.3 * t + 0.03 * np.sin(3 * np.pi * t), 0.1 + 0.8 * t**1.2], axis=1)


def springs(n: int) -> Floats:
    """The matrix L of (4.2) on stacked positions (3 n)."""
    rows = np.zeros((n, n))
    for i in range(1, n - 1):
        rows[i, i - 1 : i + 2] = 1.0, -2.0, 1.0
    return np.asarray(np.kron(rows, np.eye(3)))


def jacobian(frames: Floats) -> Floats:
    """J of (4.3): block diagonal (3 n, 2 n)."""
    n = len(frames)
    J = np.zeros((3 * n, 2 * n))
    for i in range(n):
        J[3 * i : 3 * i + 3, 2 * i : 2 * i + 2] = frames[i, 1:3].T
    return J


def inner(n: int, size: int) -> slice:
    """Rows of the inner particles, of which each has `size`."""
    return slice(size, size * (n - 1))


def one_step(method: str, **options: Any) -> tuple[Motion, Floats, Floats, Floats]:
    """One step from rest of all particles on the surface, and its P, J and L, restricted to what can move."""
    curve = wavy()
    setting: dict[str, Any] = (
        dict(particles=N, initial=curve, steps=1, step_size=H, damping=DAMPING, lifting=False) | options
    )
    taken = run(method, skew(), curve[0], curve[-1], **setting)
    frames = skew().frames(curve)
    free, plane = inner(N, 3), inner(N, 2)
    return taken, frames[:, 0].ravel(), jacobian(frames)[free, plane], springs(N)[free]


# chapter 3


def test_balance_gives_required_friction_as_a_ratio_of_curvatures() -> None:
    """(3.4) to (3.12): on a circle of latitude the angle of the normals is arctan(|kg| / kn)."""
    polar = 0.4 * np.pi
    normal = np.array([np.sin(polar), 0.0, np.cos(polar)])
    bend = np.array([-1.0 / np.sin(polar), 0.0, 0.0])  # r'' of a circle of radius sin(polar)
    kn, across = -bend @ normal, bend + (-bend @ normal) * normal
    assert kn == pytest.approx(1.0)
    angle = np.arccos(-bend @ normal / np.linalg.norm(bend))
    assert np.tan(angle) == pytest.approx(np.linalg.norm(across) / kn)
    sphere = shapes.sphere_band(1.0, 0.25 * np.pi, 0.75 * np.pi)
    mu = np.linalg.norm(across) / kn
    path = mw.trace(sphere, (0.0, polar_to_v(polar)), 0.5 * np.pi, 1.0, slip=mu)
    assert np.ptp(path.uv[:, 1]) < 1e-7  # a constant required friction keeps it on its circle
    assert path.geodesic_curvature / path.normal_curvature == pytest.approx(mu, rel=1e-6)


def polar_to_v(polar: float) -> float:
    """v on the band from pi/4 to 3 pi/4, measured from the south pole, where the angle from the north pole is given."""
    return ((np.pi - polar) - 0.25 * np.pi) / (0.5 * np.pi)


def christoffel(frame: Floats) -> tuple[Floats, Floats]:
    """Symbols (3.21) for uu, uv and vv, as stated."""
    _, su, sv, *second = frame
    auu, auv, avv = su @ su, su @ sv, sv @ sv
    square = auu * avv - auv * auv
    first = [(avv * bend @ su - auv * bend @ sv) / square for bend in second]
    other = [(auu * bend @ sv - auv * bend @ su) / square for bend in second]
    return np.array(first), np.array(other)


@pytest.mark.parametrize("uv", ANYWHERE)
def test_geodesic_equation(uv: Floats) -> None:
    """(3.20) to (3.22), and the term of constant required friction."""
    frame = skew().frames(uv[None])[0]
    p, q = 0.21, 0.34
    for mu in (0.0, 0.3):
        out = np.empty(4)
        press, speed = rates(skew().spline, mu, np.array([*uv, p, q]), np.empty((7, 3)), out)
        scale = np.array([p * p, 2 * p * q, q * q])
        first, other = christoffel(frame)
        expected = np.array([-first @ scale, -other @ scale])
        t = p * frame[1] + q * frame[2]
        assert speed == pytest.approx(np.linalg.norm(t))
        normal = np.cross(frame[1], frame[2])
        area = np.linalg.norm(normal)
        auu, auv, avv = frame[1] @ frame[1], frame[1] @ frame[2], frame[2] @ frame[2]
        b = np.array([-(auv * p + avv * q), auu * p + auv * q]) / area
        assert b[0] * frame[1] + b[1] * frame[2] == pytest.approx(np.cross(normal / area, t))
        expected += mu * max(press, 0.0) * speed * b  # rates run through the curve at this speed
        assert out == pytest.approx([p, q, *expected])
    assert press != 0.0


# chapter 4


def test_springs_are_the_gradient_of_the_energy() -> None:
    """(4.1) and (4.2), by central differences, which are exact up to round-off for a quadratic."""
    X = np.random.default_rng(3).normal(size=(N, 3))
    force = (springs(N) @ X.ravel()).reshape(N, 3)
    for i, k in ((1, 0), (4, 2), (N - 2, 1)):
        ahead, back = X.copy(), X.copy()
        ahead[i, k] += 0.1
        back[i, k] -= 0.1
        assert -(energy(ahead)[0] - energy(back)[0]) / 0.2 == pytest.approx(force[i, k])


@pytest.mark.parametrize("inertial", [True, False])
def test_explicit_steps(inertial: bool) -> None:
    """(4.10) to (4.12): a second step of symplectic Euler, whose velocities are those of (4.11) at the new place."""
    _, P, J, L = one_step("symplectic-euler")
    metric = J.T @ J
    w = H * np.linalg.solve(metric, J.T @ (L @ P))
    curve = wavy()
    curve[1:-1] += H * w.reshape(-1, 2)
    frames = skew().frames(curve)[1:-1]
    rate = w.reshape(-1, 2)
    spin = (
        frames[:, 3] * rate[:, :1] ** 2 + 2 * frames[:, 4] * rate[:, :1] * rate[:, 1:] + frames[:, 5] * rate[:, 1:] ** 2
    ).ravel()
    J = jacobian(skew().frames(curve))[inner(N, 3), inner(N, 2)]
    P = skew().points(curve).ravel()
    force = L @ P - (spin if inertial else 0.0)
    w = w + H * np.linalg.solve(J.T @ J, J.T @ force) - H * DAMPING * w
    taken, *_ = one_step("symplectic-euler", steps=2, inertial=inertial)
    assert taken.uv[1:-1] == pytest.approx(curve[1:-1] + H * w.reshape(-1, 2), abs=1e-12)


def test_undamped_explicit_euler_grows_as_stated() -> None:
    """On a straight chain (4.10) multiplies a mode by 1 + i h omega a step, of modulus sqrt(1 + (h omega)^2)."""
    steps, mode, h = 6, 2, 0.4
    t = np.linspace(0.0, 1.0, N)
    shape = np.sin(mode * np.pi * t)
    omega = 2 * np.sin(mode * np.pi / (2 * (N - 1)))
    curve = np.stack([0.0 * t, t + 1e-2 * shape], axis=1)
    curve[[0, -1]] = [0.0, 0.0], [0.0, 1.0]
    end = run("explicit-euler", shapes.cylinder(1.0, 3.0), curve[0], curve[-1], particles=N, initial=curve,
              steps=steps, step_size=h)  # fmt: skip
    grown = (1 + 1j * h * omega) ** steps
    assert end.uv[:, 1] - t == pytest.approx(1e-2 * grown.real * shape, abs=1e-12)
    assert abs(grown) == pytest.approx(np.sqrt(1 + (h * omega) ** 2) ** steps)


@pytest.mark.parametrize("damping", [0.0, DAMPING])
def test_implicit_step(damping: float) -> None:
    """(4.16) and (4.17)."""
    taken, P, J, L = one_step("backward-euler", damping=damping)
    inside = L[:, inner(N, 3)]
    matrix = J.T @ ((1 + H * damping) * np.eye(len(inside)) - H * H * inside) @ J
    w = np.linalg.solve(matrix, H * J.T @ (L @ P))
    assert taken.uv[1:-1].ravel() == pytest.approx(wavy()[1:-1].ravel() + H * w, abs=1e-12)


def test_a_long_implicit_step_is_gauss_newtons() -> None:
    taken, P, J, L = one_step("backward-euler", step_size=1e6, damping=0.0)
    move = -np.linalg.solve(J.T @ L[:, inner(N, 3)] @ J, J.T @ (L @ P))
    assert taken.uv[1:-1].ravel() == pytest.approx(wavy()[1:-1].ravel() + move, abs=1e-9)


def test_velocities_are_scaled_by_friction() -> None:
    """(4.19), with |A . n|: with the signed (4.18) as printed a fibre that presses would be driven on."""
    mu = 0.1
    free, P, _, L = one_step("backward-euler")
    frames = skew().frames(wavy())[1:-1]
    w = (free.uv - wavy())[1:-1] / H
    speed = np.linalg.norm(np.einsum("iak,ia->ik", frames[:, 1:3], w), axis=1)
    press = np.einsum("ik,ik->i", (L @ P).reshape(-1, 3), skew().normals(wavy())[1:-1])
    share = np.maximum(1 - H * mu * np.abs(press) / speed, 0.0)
    rubbed, *_ = one_step("backward-euler", friction=mu)
    assert (rubbed.uv - wavy())[1:-1] / H == pytest.approx(share[:, None] * w, abs=1e-12)
    assert (press < 0.0).any()
    assert (1 - H * mu * press / speed).max() > 1.0
    assert 0.0 < share.min() < share.max() < 1.0


# chapter 5


def test_weights_across_a_bridge() -> None:
    """(5.2), (5.3) and (5.8): the weights of the example, and that those of a row add up to nothing."""
    X = np.random.default_rng(4).normal(size=(6, 3))
    assert pull(X, 1, 0, 4) == pytest.approx(X[0] - 4 / 3 * X[1] + X[4] / 3)
    assert pull(X, 4, 1, 5) == pytest.approx(X[1] / 3 - 4 / 3 * X[4] + X[5])
    before, i, after = 3, 5, 9
    outer = 1 / (i - before) + 1 / (after - i)
    assert -(after - before) / ((i - before) * (after - i)) + outer == pytest.approx(0.0)
    printed = -(after - before) / ((i - before) * (before - i))
    assert printed + outer != pytest.approx(0.0)


def test_the_unweighted_test_can_have_the_wrong_sign() -> None:
    """Algorithm 1 lifts a particle that (5.2) presses on the surface."""
    X = np.array([[-1.0, -0.3], [0.0, 0.0], [1.0, 0.1], [2.0, 0.2], [3.0, 0.3], [4.0, 0.4]])
    X = np.column_stack([X[:, 0], 0.0 * X[:, 0], X[:, 1]])
    normal = np.tile([0.0, 0.0, 1.0], (6, 1))
    touching = np.array([True, True, False, False, False, True])
    state = blank(6)._replace(X=X, normal=normal, touching=touching)
    assert pull(X, 1, 0, 5)[2] < 0.0
    assert (X[0] - 2 * X[1] + X[5])[2] > 0.0
    assert lift(state, 0.0, True, no_contacts(6)) == 0


def squared_distance(point: Floats, uv: Floats) -> float:
    return float(np.sum((skew().points(uv[None])[0] - point) ** 2))


def derivatives(point: Floats, uv: Floats) -> tuple[Floats, Floats]:
    """Gradient and Hessian of g / 2 as stated in (5.6) and (5.7)."""
    s, su, sv, suu, suv, svv = skew().frames(uv[None])[0]
    d = s - point
    cross = suv @ d + su @ sv
    return np.array([su @ d, sv @ d]), np.array([[suu @ d + su @ su, cross], [cross, svv @ d + sv @ sv]])


@pytest.mark.parametrize("uv", ANYWHERE)
def test_foot_points(uv: Floats) -> None:
    """(5.4) to (5.7): derivatives by differences, a step of (5.5), and the foot."""
    point = skew().points(uv[None])[0] + 0.05 * skew().normals(uv[None])[0]
    near = uv + [0.004, -0.003]
    gradient, hessian = derivatives(point, near)
    step = 1e-4
    by = step * np.eye(2)
    g = [[squared_distance(point, near + a * by[0] + b * by[1]) for b in (-1, 0, 1)] for a in (-1, 0, 1)]
    assert [g[2][1] - g[0][1], g[1][2] - g[1][0]] == pytest.approx(4 * step * gradient, rel=1e-4)
    mixed = (g[2][2] - g[2][0] - g[0][2] + g[0][0]) / 4
    assert mixed / step**2 / 2 == pytest.approx(hessian[0, 1], rel=1e-4)
    s, su, sv, suu, suv, svv = skew().frames(near[None])[0]
    d = s - point
    metric, curvature = Symmetric(su @ su, su @ sv, sv @ sv), Symmetric(suu @ d, suv @ d, svv @ d)
    move = newton_step(True, *near, Expansion(d @ d, Gradient(su @ d, sv @ d), metric, curvature))
    assert move == pytest.approx(-np.linalg.solve(hessian, gradient))
    guess = near.copy()
    foot(skew().spline, point, guess, np.empty((6, 3)))
    assert guess == pytest.approx(uv, abs=1e-9)


def test_newtons_step_as_printed_does_not_converge() -> None:
    """(5.7) as printed doubles the gradient of g but not its Hessian, so that each step goes twice too far."""
    uv = ANYWHERE[0]
    point = skew().points(uv[None])[0] + 0.05 * skew().normals(uv[None])[0]
    for double, converges in ((1.0, True), (2.0, False)):
        at = uv + [0.004, -0.003]
        for _ in range(12):
            gradient, hessian = derivatives(point, at)
            at = at - np.linalg.solve(hessian, double * gradient)
        assert bool(np.abs(at - uv).max() < 1e-9) == converges


# chapter 6


def test_initial_paths() -> None:
    """(6.1) and (6.2)."""
    ends = mw.families(shapes.cylinder(1.0, 2.0), paths=3, revolutions=0.7)
    assert np.abs(ends.end - ends.start)[:, 0] == pytest.approx(0.7)
    curve = straight(ends.start, ends.end, 11)
    slope = 1.0 / (ends.end - ends.start)[:, 0]
    assert curve[:, :, 1] == pytest.approx(slope[:, None] * (curve[:, :, 0] - ends.start[:, :1]), abs=1e-12)


def test_where_a_winding_presses() -> None:
    """(6.3) against the second difference of the curve itself, for both families, and against `pressing`."""
    uv = np.random.default_rng(6).uniform(0.05, 0.95, (300, 2))
    turns = np.linspace(0.1, 3.0, 30)
    low, high = (edge[:, :, None] for edge in (pressing(skew(), flat=0.0, uv=uv).low, pressing(skew(), 0.0, uv).high))
    found = ((low <= turns) & (turns <= high)).any(axis=1)
    frames = skew().frames(uv)
    normal = np.cross(frames[:, 1], frames[:, 2])
    suu, suv, svv = ((frames[:, row] * normal).sum(axis=1)[:, None] for row in (3, 4, 5))
    stated, printed = [], []
    for sense in (1.0, -1.0):
        z = 1.0 / (sense * turns)
        stated.append(suu + 2 * z * suv + z * z * svv < 0.0)
        printed.append(suu + z * suv + z * z * svv < 0.0)
        n, step = turns[::10], 1e-3
        ahead, back = (
            skew().points((uv[:, None] + way * step * np.stack([sense * n, np.ones_like(n)], axis=1)).reshape(-1, 2))
            for way in (1, -1)
        )
        bend = (ahead + back).reshape(len(uv), len(n), 3) - 2 * frames[:, None, 0]
        measured = np.einsum("knc,kc->kn", bend, normal) / step**2
        assert np.mean((measured < 0.0) == stated[-1][:, ::10]) > 0.99  # all but those within the difference's error
    assert np.array_equal(found, stated[0] & stated[1])
    assert np.mean(found == (printed[0] & printed[1])) < 0.98


def test_control_points_move_the_surface_linearly() -> None:
    """(6.7) to (6.9): J_C dC is the move of the surface, exactly, however large."""
    rng = np.random.default_rng(7)
    change = rng.normal(size=skew().control_points.shape)
    moved = Surface(skew().control_points + change)
    normal = skew().normals(ANYWHERE)
    which, (part,) = weights(skew(), ANYWHERE, ((0, 0),))
    rows = along(which, part, normal, change.size // 3)
    by = (moved.points(ANYWHERE) - skew().points(ANYWHERE)) * normal
    assert rows @ change.ravel() == pytest.approx(by.sum(axis=1))


def test_demands_of_lifted_particles() -> None:
    """(6.10) and (6.11): once the rows are met, the surface has reached every lifted particle, across its chord."""
    surface = shapes.revolution(lambda z: 1.0 - 0.2 * np.sin(np.pi * z) ** 2, 0.0, 1.0, (32, 16))
    paths = mw.solve(surface, [(0.0, 0.0)], [(0.05, 1.0)], particles=41)
    assert not paths.on_surface.all()
    demands = reach(paths)
    M = demands.matrix.toarray()
    change = np.linalg.lstsq(M, demands.least, rcond=1e-12)[0]
    met = M @ change >= demands.least - 1e-6
    assert met.all()
    assert demands.least.max() == pytest.approx(paths.gap.max(), rel=1e-3)


# chapter 7


def in_space(method: str, **options: Any) -> tuple[Motion, Floats, Floats, Floats]:
    """One step from rest in space, on a sphere, with the positions before it, the springs' matrix and the normals."""
    surface, curve = shapes.sphere_band(2.0, 0.2 * np.pi, 0.8 * np.pi), wavy()
    setting: dict[str, Any] = dict(particles=N, initial=curve, steps=1, step_size=H, damping=DAMPING) | options
    taken = run(method, surface, curve[0], curve[-1], **setting)
    assert taken.status == Ending.STOPPED
    return taken, surface.points(curve), springs(N)[inner(N, 3)], surface.normals(curve)[1:-1]


def chain_matrix(L: Floats) -> Floats:
    """D of (7.2), with damping as in (4.17)."""
    return np.asarray((1 + H * DAMPING) * np.eye(3 * (N - 2)) - H * H * L[:, inner(N, 3)])


def test_penalty_force() -> None:
    """(7.1) and (7.2): no force beyond epsilon, k_PF inside the body, and in between the slope of the line."""
    epsilon, push = 0.1, 0.4
    gap = np.array([np.nan, 0.2, 0.08, 0.03, -0.01, -0.5, 0.1001, 0.05, np.nan])
    rng = np.random.default_rng(8)
    normal = rng.normal(size=(N, 3))
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    X, before = rng.normal(size=(N, 3)), rng.normal(size=(N, 3))
    before[[0, -1]] = 0.0
    W = before.copy()
    strand = Strand(X, W, np.zeros((N, 2)), np.zeros((N, 6, 3)), normal, gap <= epsilon, np.zeros(N, np.bool_), gap)
    physics, rules = Physics(H, 1.0, DAMPING, 0.0, False), SpaceRules(PENALTY, 1, 0.0, epsilon, push, 0.0)
    penalty.step(strand, physics, rules, space_work(N, physics), np.zeros(4, np.int64))
    d = gap[1:-1]
    size = np.where(d > epsilon, 0.0, np.where(d > 0.0, push * (epsilon - d) / epsilon, push))
    slope = np.where((d > 0.0) & (d <= epsilon), -push / epsilon, 0.0)
    L = springs(N)[inner(N, 3)]
    force = L @ X.ravel() + (size[:, None] * normal[1:-1]).ravel()
    D = chain_matrix(L)
    for i in range(N - 2):
        D[3 * i : 3 * i + 3, 3 * i : 3 * i + 3] -= H * H * slope[i] * np.outer(normal[i + 1], normal[i + 1])
    assert W[1:-1].ravel() == pytest.approx(np.linalg.solve(D, before[1:-1].ravel() + H * force))


def test_karush_kuhn_tucker_step() -> None:
    """(7.2) to (7.9), by the dense system (7.7); (7.8) gives its multipliers, but not as printed."""
    taken, X, L, normal = in_space("kkt", stabilisation=0.0)
    D, y = chain_matrix(L), H * (L @ X.ravel())
    G = np.zeros((N - 2, 3 * (N - 2)))
    for i in range(N - 2):
        G[i, 3 * i : 3 * i + 3] = normal[i]
    whole = np.block([[D, G.T], [G, np.zeros((N - 2, N - 2))]])
    both = np.linalg.solve(whole, np.concatenate([y, np.zeros(N - 2)]))
    v, multipliers = both[: 3 * (N - 2)], both[3 * (N - 2) :]
    assert (multipliers < 0.0).all()  # the surface pushes everywhere, so that no contact is let go
    assert taken.points[1:-1].ravel() == pytest.approx(X[1:-1].ravel() + H * v, abs=1e-9)
    inverse = np.linalg.inv(D)
    assert np.linalg.solve(G @ inverse @ G.T, G @ inverse @ y) == pytest.approx(multipliers)
    assert np.linalg.solve(D, y - G.T @ multipliers) == pytest.approx(v)
    assert np.linalg.solve(G @ D @ G.T, G @ D @ y) != pytest.approx(multipliers, rel=1e-2)
    projector = np.eye(3 * (N - 2)) - G.T @ G
    w = np.linalg.lstsq(projector @ D @ projector, projector @ y, rcond=None)[0]
    assert projector @ w == pytest.approx(v)
    assert np.einsum("ik,ik->i", normal, (y - D @ v).reshape(-1, 3)) == pytest.approx(multipliers)


def test_contacts_that_pull_are_let_go() -> None:
    """(7.9) with the positive multipliers set to 0: on the inside of a bend the chain leaves the surface."""
    surface = shapes.hyperboloid(1.0, 1.0, 1.5)
    t = np.linspace(0.0, 1.0, N)
    curve = np.stack([0.0 * t, t], axis=1)  # a meridian, hollow throughout
    taken = run("kkt", surface, curve[0], curve[-1], particles=N, steps=1, step_size=H, stabilisation=0.0)
    X, L = surface.points(curve), springs(N)[inner(N, 3)]
    D = np.eye(3 * (N - 2)) - H * H * L[:, inner(N, 3)]
    free = np.linalg.solve(D, H * (L @ X.ravel()))
    assert taken.points[1:-1].ravel() == pytest.approx(X[1:-1].ravel() + H * free, abs=1e-9)
