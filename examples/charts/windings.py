"""Our solver over revolutions and waist depth, conjugate points and friction, with an exact answer in every cell."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, Attempt, attempt
from comparison.problem import TURN, Problem
from comparison.sliding import Sliding
from scipy.integrate import quad
from scipy.optimize import brentq

from charts.maps import Row, classify, key, paint, sweep
from charts.record import Results
from charts.style import note, save
from meshwind.surface import Surface, shapes

N = 201
"""Particles of our solver."""
COARSE = 101
"""Particles where fewer do: on the torus, and of backward Euler, which is slower."""
EXACT, ROUGH = 1e-3, 1e-2
"""Relative error of the length up to which ours with friction is right, and velocity scaling, which cannot be exact."""
SAME, SHORTER = 1e-3, 1e-6
"""Relative difference of a length from the equator's up to which it is that of the equator, or above which shorter."""
NEAR = 0.05
"""Bend, relative to that of the conjugate point, next to which either answer is right."""


@dataclass(frozen=True)
class Waist:
    """A hyperboloid between rims of radius 1, 2 apart, with its waist's radius in between."""

    waist: float

    @property
    def slope(self) -> float:
        """s in r^2 = waist^2 + (s z)^2, |z| <= 1."""
        return float(np.sqrt(1.0 - self.waist**2))

    @property
    def ruling(self) -> float:
        """Twist below which the taut fibre is a chord through the air, in radians."""
        return float(2.0 * np.arctan2(self.slope, self.waist))

    def length(self, twist: float) -> float:
        """The chord, or beyond the rulings' twist the geodesic, by Clairaut with c below the waist."""
        if twist <= self.ruling:
            return float(np.hypot(2.0, 2.0 * np.sin(twist / 2)))
        # c = waist sqrt(1 - e^2); any twist is reached as e goes to 0
        e = np.exp(brentq(lambda x: self._integral(np.exp(x), True) - twist, -60.0, np.log(0.9999999)))
        return self._integral(e, False)

    def _integral(self, e: float, twist: bool) -> float:
        w, s = self.waist, self.slope
        c, d = w * np.sqrt(1 - e * e), w * e / s

        def rate(q: float) -> float:  # z = d sinh(q), so that sqrt(r^2 - c^2) = s d cosh(q)
            z = d * np.sinh(q)
            r = np.sqrt(w * w + (s * z) ** 2)
            stretch = np.sqrt(1 + (s * s * z / r) ** 2)
            return float(stretch * (c / r if twist else r) / s)

        return float(2 * quad(rate, 0.0, np.arcsinh(1.0 / d), epsabs=1e-11, epsrel=1e-11, limit=200)[0])


@cache
def waisted(waist: float) -> Surface:
    """The surface of a `Waist`."""
    return shapes.hyperboloid(waist, Waist(waist).slope, 1.0, (192, 128))


def waist(results: Results, quick: bool) -> None:
    """Revolutions from 0 to 3 over waists from 0.1 to 0.95 of the rims."""
    turns = np.linspace(0.05, 3.05, 11 if quick else 25).tolist()
    waists = np.linspace(0.1, 0.95, 7 if quick else 12).tolist()

    def cell(w: float, t: float) -> Row:
        shape, twist = Waist(w), t * TURN
        surface, length = partial(waisted, w), shape.length(twist)
        problem = Problem("waist", "", surface, (0, 0), (t, 1), length, twist < shape.ruling)
        found = attempt(OURS, problem, N)
        error = problem.error(found.length)
        result = classify(found, error, 20.0 * (twist / N) ** 2 + 1e-6)
        return dict(waist=w, turns=t, result=result, error=error, iterations=found.iterations,
                    evaluations=found.evaluations)  # fmt: skip

    classes, rows = sweep(waists, turns, cell)
    figure, axes = plt.subplots(figsize=(9, 5.4))
    paint(axes, turns, waists, classes)
    fine = np.linspace(waists[0] - 0.03, waists[-1] + 0.03, 100)
    axes.plot([Waist(float(min(w, 0.999))).ruling / TURN for w in fine], fine, "k--", lw=1.5)
    text = "left of the dashed line (the rulings): a chord through the air; right: on the surface"
    note(axes, 0.04, 0.97, text, transform=axes.transAxes)
    axes.set(
        xlabel="revolutions",
        ylabel="radius of the waist over that of the rims",
        title=(
            f"meshwind on hyperboloids, {N} particles, from a straight line in (u, v)\n"
            "exact length in every cell: chord or Clairaut's integral"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "ours_waist")
    results.table("ours_waist", rows)


def conjugate(results: Results, quick: bool) -> None:
    """The outer equator of a torus, stable up to its conjugate point only; the fibre starts exactly on it."""
    ratios = np.linspace(0.1, 0.9, 5 if quick else 9).tolist()
    bends = (np.linspace(0.2, 1.9, 9 if quick else 18) * np.pi).tolist()

    def cell(ratio: float, bend: float) -> Row:
        equator, limit = (1 + ratio) * bend, np.pi * np.sqrt(ratio / (1 + ratio))
        surface = partial(shapes.torus, 1.0, ratio, bend, (96, 128))
        found = attempt(OURS, Problem("torus", "", surface, (0, 0), (0, 1), equator), COARSE)
        result = classify(found, 0.0, 1.0)
        same = abs(found.length / equator - 1) < SAME
        # before the conjugate point the equator is a minimum; beyond it, to report it would be wrong
        right = same if bend < limit else found.length < equator * (1 - SHORTER) and not same
        if result == "ok" and not right and abs(bend / limit - 1) >= NEAR:
            result = "wrong"
        return dict(ratio=ratio, bend=bend, conjugate_bend=limit, result=result, length=found.length, equator=equator,
                    outcome=str(found.outcome), iterations=found.iterations, gap=found.gap)  # fmt: skip

    classes, rows = sweep(ratios, bends, cell)
    figure, axes = plt.subplots(figsize=(8.5, 5.2))
    paint(axes, bends, ratios, classes)
    fine = np.linspace(0.05, 0.95, 200)
    axes.plot(np.pi * np.sqrt(fine / (1 + fine)), fine, "k--", lw=1.6)
    text = "dashed: conjugate point at bend = pi sqrt(r / (R + r)); right of it the equator is no minimum"
    note(axes, 0.02, 0.96, text, transform=axes.transAxes)
    axes.set(
        xlabel="bend of the torus from end to end [rad]",
        ylabel="tube radius r over bend radius R",
        title=(
            f"meshwind started exactly on the outer equator of a torus, {COARSE} particles\n"
            "right: the equator while it is stable, beyond it a shorter path"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "ours_conjugate")
    results.table("ours_conjugate", rows)


def friction(results: Results, quick: bool) -> None:
    """Sliding on a cylinder over friction and the start's bend: stuck, stick-slip or catenary, exact everywhere."""
    coefficients = np.linspace(0.05, 1.0, 8 if quick else 20).tolist()
    bends = np.linspace(0.05, 1.5, 8 if quick else 20).tolist()
    half = float(np.pi)
    figure, grid = plt.subplots(1, 2, figsize=(14, 5.6), sharey=True)
    rows = []
    scaling = dict(step_size=0.5, damping=0.05, steps=4000)
    solvers: Sequence[tuple[str, float, int, Callable[[Problem], Attempt]]] = (
        (OURS, EXACT, 1, lambda p: attempt(OURS, p, N)),
        ("backward Euler with (4.19), h = 0.5 sqrt(m/K)", ROUGH, 1 if quick else 2,
         lambda p: attempt("backward-euler", p, COARSE, scaling)),
    )  # fmt: skip
    for (name, allowed, stride, solver), axes in zip(solvers, grid, strict=True):

        def cell(k: float, mu: float, name: str = name, allowed: float = allowed,
                 solver: Callable[[Problem], Attempt] = solver) -> Row:  # fmt: skip
            problem = Sliding(mu, k, half).problem("sliding", "")
            found = solver(problem)
            error = problem.error(found.length)
            return dict(method=name, friction=mu, bend=k, result=classify(found, error, allowed), error=error,
                        iterations=found.iterations)  # fmt: skip

        classes, found = sweep(bends[::stride], coefficients[::stride], cell)
        rows += found
        paint(axes, coefficients[::stride], bends[::stride], classes)
        fine = np.linspace(coefficients[0], coefficients[-1], 200)
        axes.plot(fine, fine, "k--", lw=1.2)
        axes.plot(fine, np.sinh(fine * half) / half, "k-", lw=1.2)
        axes.set(xlabel="friction mu", title=name, ylim=(0, 1.6))
        key(axes, classes)
    grid[0].set_ylabel("bend k of the start z = k/2 (pi^2 - t^2) on a cylinder of radius 1")
    figure.suptitle(
        "Friction: below the dashed line nothing moves, above the full line all slides, between them the middle"
        f" slides;\nright means at rest with the exact length to {EXACT:g} (meshwind) or {ROUGH:g} (velocity scaling)"
    )
    save(figure, results.folder, "ours_friction")
    results.table("ours_friction", rows)


def draw(results: Results, quick: bool) -> None:
    """All three maps."""
    waist(results, quick)
    conjugate(results, quick)
    friction(results, quick)
