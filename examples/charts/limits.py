"""Where the explicit schemes diverge: over time step and number of particles, against the theory's limit."""

from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import move
from comparison.problems import TABLE

from charts.maps import key, paint
from charts.record import Results
from charts.style import save
from meshwind.methods import Ending, largest_frequency, stable_step

PROBLEM = TABLE["barrel-1.5"]
SCHEMES = (
    ("explicit-euler", 1.0, "explicit Euler, damping 1: h = min(c / w^2, 2 / c)"),
    ("symplectic-euler", 0.0, "symplectic Euler, undamped: h = 2 / w"),
    ("rk4", 0.0, "Runge-Kutta 4, undamped: h = 2.83 / w"),
)
"""Schemes with their damping, and what their limit is in theory."""
COUNTS = (6, 11, 21, 51, 101, 201, 401)
"""Numbers of particles."""
STEPS = 1000
WILD = 100.0
"""Growth of the residual that counts as diverged: few particles can move wildly within bounds, held by the rims."""
ASIDE = 1e-4
"""Turns by which every other particle is moved at first."""
RATIO, GROWTH = 1.02, 1.1
"""Accuracy of the measured limit, and the factor of the search before the bisection."""


def diverges(scheme: str, n: int, step: float, damping: float, curve: Any) -> bool:
    """Whether a run from near rest gains energy without bound, or ends with a residual grown by WILD."""
    found = move(scheme, PROBLEM, n, steps=STEPS, step_size=step, damping=damping, initial=curve, lifting=False,
                 tolerance=0.0, history=True)  # fmt: skip
    if found.history is None:
        raise SystemExit("the run kept no history")
    return found.status == Ending.DIVERGED or found.residual > WILD * found.history.residual[0]


def near_rest(n: int) -> tuple[Any, float]:
    """The path at rest with every other particle moved a little aside, and the chain's largest frequency there."""
    rest = move("backward-euler", PROBLEM, n, steps=2000, step_size=1e4, lifting=False).uv
    curve = np.array(rest)
    curve[1:-1, 0] += ASIDE * (-1.0) ** np.arange(n - 2)
    return curve, largest_frequency(PROBLEM.surface(), rest)


def bisect(scheme: str, n: int, damping: float, curve: Any, theory: float) -> float:
    """The measured limit: the least step that diverges, as above it there are islands that the rims keep stable."""
    low, high = 0.3 * theory, 0.3 * GROWTH * theory
    while high < 3.0 * theory and not diverges(scheme, n, high, damping, curve):
        low, high = high, GROWTH * high
    while high / low > RATIO:
        middle = np.sqrt(low * high)
        low, high = (low, middle) if diverges(scheme, n, middle, damping, curve) else (middle, high)
    return float(np.sqrt(low * high))


def draw(results: Results, quick: bool) -> None:
    """A map per scheme, with the theory's limit as a line and the measured limits as dots."""
    counts = COUNTS[1::2] if quick else COUNTS
    shares = np.geomspace(0.1, 6.0, 14 if quick else 24)
    figure, grid = plt.subplots(1, 3, figsize=(16.5, 5.4), sharey=True)
    rows: list[dict[str, Any]] = []
    for (scheme, damping, title), axes in zip(SCHEMES, grid, strict=True):
        classes, theory, measured = [], [], []
        for n in counts:
            curve, omega = near_rest(n)
            limit = stable_step(scheme, omega, damping=damping)
            classes.append(["diverged" if diverges(scheme, n, h, damping, curve) else "ok" for h in shares])
            found = bisect(scheme, n, damping, curve, limit)
            theory.append(limit)
            measured.append(found)
            rows.append(
                dict(
                    scheme=scheme,
                    damping=damping,
                    particles=n,
                    omega_max=omega,
                    theory=limit,
                    measured=found,
                    ratio=found / limit,
                    two_over_omega=2 / omega,
                )
            )
        paint(axes, list(shares), list(counts), classes, log_x=True, log_y=True)
        axes.plot(theory, counts, "k--", lw=1.6, label="theory")
        axes.plot(measured, counts, "wo", mec="k", ms=6, label="measured, to 2 %")
        axes.set(
            xlabel="time step h [sqrt(m/K)]",
            title=(
                f"{title}\nmeasured / theory: {min(r['ratio'] for r in rows if r['scheme'] == scheme):.2f}"
                f" to {max(r['ratio'] for r in rows if r['scheme'] == scheme):.2f}"
            ),
        )
        axes.set_yticks(counts, [str(n) for n in counts])
        axes.minorticks_off()
        key(axes, classes)
    grid[0].set_ylabel("particles")
    figure.suptitle(
        f"Explicit schemes on {PROBLEM.name} near rest, {STEPS} steps: bounded or diverging. Dashed: theory with the"
        " chain's own largest frequency w; dots: measured by bisection"
    )
    figure.tight_layout()
    save(figure, results.folder, "explicit_limits")
    results.table("explicit_limits", rows)
