"""The settings that each method is tried with: sizes from small to large and, at each, a grid of its own parameters.

Every setting is run; what a chart draws as a method's line is the front of the best.  Each size keeps the settings that
were best at the size before, so that a hopeless one is not tried at every size.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from comparison.attempt import OURS
from comparison.problem import Problem

from meshwind.methods import stable_step

SIZES = (26, 51, 101, 201, 401, 801, 1601, 3201, 6401)
QUICK_SIZES = (26, 101, 401)
"""Numbers of particles."""
STEP_LIMIT = 1.5e6
"""Particles times steps that a run may take: about 0.3 s."""
FEWEST_STEPS = 20
"""Steps that a run may take at least."""
COST = {"rk4": 4, "kkt": 8, "penalty": 8}
"""Cost of a step over that of backward Euler: these methods get fewer steps, to take about the same time."""
KEPT = 3
"""Settings that the next size keeps."""
RULED = "backward-euler-ruled"
"""Backward Euler with and without reuse, its lengths by our rule of the fourth order instead of the polyline's."""


@dataclass(frozen=True)
class Setting:
    """One setting of a method: its name in the charts, the scheme behind it, particles and parameters."""

    method: str
    scheme: str
    particles: int
    key: str
    parameters: Mapping[str, Any]


def slowest(n: int) -> float:
    """Damping that is critical for the slowest mode of a straight chain of n unit masses and springs."""
    return 2.0 * np.pi / (n - 1)


def settings(method: str, problem: Problem, n: int) -> list[Setting]:
    """All settings of a method for n particles."""
    scheme = "backward-euler" if method.startswith("backward-euler") else method
    steps = max(FEWEST_STEPS, int(STEP_LIMIT / n / COST.get(method, 1)))
    common = {} if method == OURS else {"steps": steps, "tolerance": 1e-6}
    grid = _grid(method, problem, n)
    return [Setting(method, scheme, n, key, common | parameters) for key, parameters in grid.items()]


def _grid(method: str, problem: Problem, n: int) -> dict[str, dict[str, Any]]:
    """Parameters of a method, by what charts and tables call them."""
    if method == OURS:
        return {"tolerance 1e-10 (default)": {}, "tolerance 1e-6": {"tolerance": 1e-6}}
    if method == RULED:
        both = _grid("backward-euler", problem, n) | _grid("backward-euler-reuse", problem, n)
        return {key: parameters | {"rule": True} for key, parameters in both.items()}
    if method == "backward-euler":
        if problem.friction:
            return {f"h={h:g}, damping 0.05": dict(step_size=h, damping=0.05) for h in (0.1, 0.3, 1.0, 10.0)}
        return {
            f"h={h:g}, tolerance {tol:g}": dict(step_size=h, tolerance=tol)
            for h in (10.0, 100.0, 1e3, 1e6)
            for tol in (1e-6, 1e-9)
        }
    if method == "backward-euler-reuse" and problem.friction:
        return {f"h={h:g}, damping 0.05, reuse 5": dict(step_size=h, damping=0.05, reuse=5) for h in (0.1, 0.3, 1.0)}
    if method == "backward-euler-reuse":
        return {
            f"h={h:g}, reuse {k}": dict(step_size=h, reuse=k, damping=0.0 if h > 100 else 0.02)
            for h in (30.0, 1e3)
            for k in (2, 5, 20)
        }
    if method == "kkt":
        return {
            f"h={h:g}, stabilisation {s:g}": dict(step_size=h, stabilisation=s, damping=0.1 if h < 100 else 0.0)
            for h in (3.0, 10.0, 100.0, 1e3)
            for s in (0.2, 0.5, 1.0)
        }
    if method == "penalty":
        size = problem.surface().size
        return {
            f"h={h:g}, width {w:g} size": dict(step_size=h, width=w * size, damping=slowest(n))
            for h in (0.3, 1.0, 3.0)
            for w in (1e-3, 1e-4, 1e-5)
        }
    return {
        f"{share:g} of the stable step, damping {c:g} critical": dict(
            step_size=share * stable_step(method, 2.0, damping=c * slowest(n)), damping=c * slowest(n)
        )
        for c in ((1.0, 4.0, 16.0) if method == "explicit-euler" else (0.5, 1.0, 2.0))
        for share in (0.95,)
    }
