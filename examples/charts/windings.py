"""Ours over revolutions and waist depth, conjugate points and friction: each map with an exact answer in every cell."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache, partial

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import Attempt, attempt
from comparison.problem import Problem
from comparison.rubbing import TURN, Sliding
from scipy.integrate import quad
from scipy.optimize import brentq

from charts.maps import classify, key, paint
from charts.record import Results
from charts.style import save
from meshwind.surface import Surface, shapes

N = 201
EXACT, ROUGH = 1e-3, 1e-2
"""Relative error of the length up to which ours with friction is right, and velocity scaling, which cannot be exact."""


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
    turns = np.linspace(0.05, 3.05, 11 if quick else 25)
    waists = np.linspace(0.1, 0.95, 7 if quick else 12)
    classes, rows = [], []
    for w in waists:
        line, shape = [], Waist(float(w))
        for t in turns:
            twist = float(t * TURN)
            problem = Problem(
                "waist",
                "",
                partial(waisted, float(w)),
                (0, 0),
                (float(t), 1),
                shape.length(twist),
                twist < shape.ruling,
            )
            found = attempt("meshwind", problem, N)
            error = problem.error(found.length)
            line.append(classify(found, error, 20.0 * (twist / N) ** 2 + 1e-6))
            rows.append(
                dict(
                    waist=float(w),
                    turns=float(t),
                    result=line[-1],
                    error=error,
                    iterations=found.iterations,
                    evaluations=found.evaluations,
                )
            )
        classes.append(line)
    figure, axes = plt.subplots(figsize=(9, 5.4))
    paint(axes, list(turns), list(waists), classes)
    fine = np.linspace(waists[0] - 0.03, waists[-1] + 0.03, 100)
    axes.plot([Waist(float(min(w, 0.999))).ruling / TURN for w in fine], fine, "k--", lw=1.5)
    axes.text(
        0.04,
        0.97,
        "left of the dashed line (the rulings): a chord through the air; right: on the surface",
        transform=axes.transAxes,
        fontsize=8,
        bbox=dict(fc="white", ec="none", alpha=0.8),
    )
    axes.set(
        xlabel="revolutions",
        ylabel="radius of the waist over that of the rims",
        title=(
            f"meshwind on hyperboloids, {N} particles, from a "
            "straight line in (u, v)\nexact length in every cell: chord or Clairaut's integral"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "ours_waist")
    results.table("ours_waist", rows)


def conjugate(results: Results, quick: bool) -> None:
    """The outer equator of a torus, stable up to its conjugate point only; the fibre starts exactly on it."""
    ratios = np.linspace(0.1, 0.9, 5 if quick else 9)
    bends = np.linspace(0.2, 1.9, 9 if quick else 18) * np.pi
    classes, rows = [], []
    for ratio in ratios:
        line = []
        for bend in bends:
            equator = float((1 + ratio) * bend)
            limit = np.pi * np.sqrt(ratio / (1 + ratio))
            problem = Problem(
                "torus",
                "",
                partial(shapes.torus, 1.0, float(ratio), float(bend), (96, 128)),
                (0, 0),
                (0, 1),
                equator,
            )
            found = attempt("meshwind", problem, 101)
            result = classify(found, 0.0, 1.0)
            if result == "ok":
                same = abs(found.length / equator - 1) < 1e-3
                # before the conjugate point the equator is a minimum; beyond it, to report it would be wrong
                result = (
                    "ok" if (same if bend < limit else found.length < equator * (1 - 1e-6) and not same) else "wrong"
                )
            near = abs(bend / limit - 1) < 0.05
            line.append("ok" if near and result == "wrong" else result)
            rows.append(
                dict(
                    ratio=ratio,
                    bend=bend,
                    conjugate_bend=limit,
                    result=line[-1],
                    length=found.length,
                    equator=equator,
                    outcome=str(found.outcome),
                    iterations=found.iterations,
                    gap=found.gap,
                )
            )
        classes.append(line)
    figure, axes = plt.subplots(figsize=(8.5, 5.2))
    paint(axes, list(bends), list(ratios), classes)
    fine = np.linspace(0.05, 0.95, 200)
    axes.plot(np.pi * np.sqrt(fine / (1 + fine)), fine, "k--", lw=1.6)
    axes.text(
        0.02,
        0.96,
        "dashed: conjugate point at bend = pi sqrt(r / (R + r)); right of it the equator is no minimum",
        transform=axes.transAxes,
        fontsize=8,
        bbox=dict(fc="white", ec="none", alpha=0.8),
    )
    axes.set(
        xlabel="bend of the torus from end to end [rad]",
        ylabel="tube radius r over bend radius R",
        title=(
            "meshwind started exactly on a "
            "torus' outer equator, 101 particles\nright: the equator while it is stable, beyond it a shorter path"
        ),
    )
    key(axes, classes)
    save(figure, results.folder, "ours_conjugate")
    results.table("ours_conjugate", rows)


def friction(results: Results, quick: bool) -> None:
    """Sliding on a cylinder over friction and the start's bend: stuck, stick-slip or catenary, exact everywhere."""
    coefficients = np.linspace(0.05, 1.0, 8 if quick else 20)
    bends = np.linspace(0.05, 1.5, 8 if quick else 20)
    half = float(np.pi)
    figure, grid = plt.subplots(1, 2, figsize=(14, 5.6), sharey=True)
    rows = []
    solvers: Sequence[tuple[str, Callable[[Problem], Attempt]]] = (
        ("meshwind", lambda p: attempt("meshwind", p, N)),
        (
            "backward Euler with (4.19), h = 0.5 sqrt(m/K)",
            lambda p: attempt("backward-euler", p, 101, dict(step_size=0.5, damping=0.05, steps=4000)),
        ),
    )
    for (name, solver), axes in zip(solvers, grid, strict=True):
        classes = []
        for k in bends if name == "meshwind" else bends[:: 1 if quick else 2]:
            line = []
            for mu in coefficients if name == "meshwind" else coefficients[:: 1 if quick else 2]:
                problem = Sliding(float(mu), float(k), half).problem("sliding", "")
                found = solver(problem)
                error = problem.error(found.length)
                line.append(classify(found, error, EXACT if name == "meshwind" else ROUGH))
                rows.append(
                    dict(
                        method=name,
                        friction=float(mu),
                        bend=float(k),
                        result=line[-1],
                        error=error,
                        iterations=found.iterations,
                    )
                )
            classes.append(line)
        step = 1 if name == "meshwind" or quick else 2
        paint(axes, list(coefficients[::step]), list(bends[::step]), classes)
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
    """All three."""
    waist(results, quick)
    conjugate(results, quick)
    friction(results, quick)
