"""Errors and counts of every method on every problem against the golden file: never times.

After a change that is meant, `python examples/speed_accuracy.py --golden tests/golden_methods.json` writes it anew.
"""

import json
from pathlib import Path
from typing import Any

import pytest
from comparison.golden import PARTICLES, figures

GOLDEN = json.loads((Path(__file__).parent / "golden_methods.json").read_text(encoding="utf-8"))
ERROR = 0.05
"""Margin of an error, relative; below FLOOR errors are round-off, or the spline's own."""
FLOOR = 1e-8
ROUGH = 2e-3
"""Margin of an error where the method did not converge: the state after the last step depends on round-off."""
COUNT, FEW = 0.1, 3
"""Margin of a count: relative, and absolute for iterations and solves; evaluations have it per particle."""
PEERS = ("shooting-dop853", "collocation")
"""SciPy's own choice of steps may change from one of its versions to the next: only the magnitude is held."""


@pytest.fixture(scope="module")
def found() -> dict[str, dict[str, dict[str, Any]]]:
    return figures()


def test_every_method_and_problem_is_there(found: dict[str, Any]) -> None:
    assert {name: set(methods) for name, methods in found.items()} == {
        name: set(methods) for name, methods in GOLDEN.items()
    }


@pytest.mark.parametrize(("problem", "method"), [(p, m) for p, methods in GOLDEN.items() for m in methods])
def test_errors_and_counts(found: dict[str, Any], problem: str, method: str) -> None:
    now, then = found[problem][method], GOLDEN[problem][method]
    assert now["outcome"] == then["outcome"]
    if then["outcome"] != "at rest":  # stopped half way, or diverging: only roughly the same
        if then["outcome"] == "stalled":
            assert now["error"] == pytest.approx(then["error"], rel=0.5, abs=ROUGH)
        return
    if method in PEERS:
        assert 0.1 * then["error"] - FLOOR < now["error"] < 10 * then["error"] + FLOOR
        assert 0.3 * then["evaluations"] < now["evaluations"] < 3 * then["evaluations"]
        return
    assert now["error"] == pytest.approx(then["error"], rel=ERROR, abs=FLOOR)
    for count in ("solves", "iterations"):
        assert now[count] == pytest.approx(then[count], rel=COUNT, abs=FEW)
    for count in ("evaluations", "feet"):
        assert now[count] == pytest.approx(then[count], rel=COUNT, abs=FEW * PARTICLES)


def test_ours_is_right_on_every_problem() -> None:
    """The golden file itself."""
    for problem, methods in GOLDEN.items():
        assert methods["meshwind"]["outcome"] == "at rest"
        assert methods["meshwind"]["error"] < 0.03, problem
