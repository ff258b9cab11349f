"""Errors and counts of every method on every problem at small settings: figures that do not depend on the machine.

A test compares them with `tests/golden_methods.json`; after an intended change `python examples/speed_accuracy.py
--golden tests/golden_methods.json` writes that file again.
"""

import json
from pathlib import Path
from typing import Any

from comparison.attempt import OURS, Attempt, attempt
from comparison.peers_smooth import collocate, shoot, shoot_traced
from comparison.problem import Problem
from comparison.problems import TABLE

PARTICLES = 41
"""Number of particles of every method."""
SETTINGS: dict[str, tuple[str, dict[str, Any]]] = {
    OURS: (OURS, {}),
    "backward-euler": ("backward-euler", dict(step_size=100.0, steps=300)),
    "backward-euler-damped": ("backward-euler", dict(step_size=5.0, damping=0.1, steps=600)),
    "backward-euler-reuse": ("backward-euler", dict(step_size=10.0, damping=0.1, reuse=5, steps=600)),
    "explicit-euler": ("explicit-euler", dict(step_size=0.2, damping=1.0, steps=20_000, tolerance=1e-6)),
    "symplectic-euler": ("symplectic-euler", dict(step_size=0.8, damping=0.15, steps=2000)),
    "rk4": ("rk4", dict(step_size=1.2, damping=0.15, steps=2000)),
    "penalty": ("penalty", dict(step_size=0.3, damping=0.1, steps=6000, tolerance=1e-6)),
    "kkt": ("kkt", dict(step_size=10.0, damping=0.1, steps=1000)),
}
"""Schemes with their settings, by name."""
SMOOTH = {"shooting-dop853": (shoot, 1e-5), "shooting-trace": (shoot_traced, 1e-5), "collocation": (collocate, 1e-4)}
"""SciPy's solvers with their tolerances."""
WITH_FRICTION: dict[str, Any] = dict(step_size=0.5, damping=0.05, steps=6000)
"""Settings of backward Euler where there is friction (4.19)."""


def rewrite(path: Path) -> None:
    """Compute errors and counts and write them."""
    path.write_text(json.dumps(figures(), indent=1) + "\n", encoding="utf-8")
    print(f"wrote {path}")


def figures() -> dict[str, dict[str, dict[str, Any]]]:
    """Outcome, relative error of the length, evaluations, feet, solves and iterations, by problem and method."""
    return {name: _problem(problem) for name, problem in TABLE.items()}


def _problem(problem: Problem) -> dict[str, dict[str, Any]]:
    found = {}
    for name, (method, setting) in SETTINGS.items():
        if problem.friction and (method in ("penalty", "kkt") or name.startswith("backward-euler-")):
            continue
        other = WITH_FRICTION if problem.friction and method == "backward-euler" else {}
        found[name] = _row(problem, attempt(method, problem, PARTICLES, setting | other))
    if not problem.friction and not problem.bridges:
        for name, (solver, tolerance) in SMOOTH.items():
            found[name] = _row(problem, solver(problem, tolerance))
    return found


def _row(problem: Problem, found: Attempt) -> dict[str, Any]:
    return dict(
        outcome=str(found.outcome),
        error=problem.error(found.length),
        evaluations=found.evaluations,
        feet=found.feet,
        solves=found.solves,
        iterations=found.iterations,
    )
