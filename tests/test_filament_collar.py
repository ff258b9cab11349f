"""Turnarounds on a collar: closed forms on a circle, one turn for all sections, and the differential equation."""

from math import asinh, atan2, cos, degrees, pi, radians, sin, tan

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.integrate import solve_ivp

from meshwind.core.cast import Floats
from meshwind.core.errors import BadInputError
from meshwind.filament.collar import angle_after, overrun, turned_to_hoop
from meshwind.filament.section import section

property_test = settings(max_examples=60, deadline=None, derandomize=True, database=None)


def ellipse(a: float, b: float, count: int = 20000) -> Floats:
    t = np.arange(count) * (2.0 * pi / count)
    return np.stack([a * np.cos(t), b * np.sin(t)], axis=1)


@pytest.mark.parametrize(
    ("angle", "slip", "axial", "turned"),
    [(45, 0.2, 103.553, 505.0), (45, 0.3, 69.04, 336.7), (30, 0.2, 250.0, 754.6), (15, 0.2, 715.93, 1161.7),
     (75, 0.2, 8.82, 151.7)],
)  # fmt: skip
def test_a_circular_collar(angle: float, slip: float, axial: float, turned: float) -> None:
    a = radians(angle)
    assert 2.0 * degrees(turned_to_hoop(a, slip)) == pytest.approx(turned, abs=0.05)
    found = overrun(section(ellipse(50.0, 50.0)), 0.3, a, slip)
    assert found.axial == pytest.approx(axial, abs=5e-3)
    assert found.axial == pytest.approx(50.0 / slip * (1.0 / sin(a) - 1.0), rel=1e-6)
    assert found.fibre == pytest.approx(50.0 / slip / tan(a), rel=1e-6)


@pytest.mark.parametrize(("start", "axial"), [(0.0, 112.281), (1.0, 156.424)])
def test_an_elliptic_collar(start: float, axial: float) -> None:
    """Half axes 80 and 30, 45 degrees, slip 0.2, from the points at 0 and 1 of the ellipse's parameter."""
    normal = atan2(80.0 * sin(start), 30.0 * cos(start))
    found = overrun(section(ellipse(80.0, 30.0)), normal, radians(45.0), 0.2)
    assert found.axial == pytest.approx(axial, abs=2e-3)


@property_test
@given(st.floats(0.1, 1.5), st.floats(0.05, 1.0), st.floats(0.2, 5.0), st.floats(0.0, 6.2))
def test_the_turn_is_that_of_the_equation(angle: float, slip: float, ratio: float, start: float) -> None:
    """d angle / ds = slip kappa sin(angle) with ds sin(angle) along an ellipse whose curvature is kappa."""

    def speed(t: float) -> float:
        return float(np.hypot(ratio * sin(t), cos(t)))

    def rate(t: float, state: Floats) -> list[float]:
        # per parameter t: the normal turns by kappa |p'|, kappa = ratio / speed^3
        return [slip * (ratio / speed(t) ** 3) * speed(t) * sin(state[0])]

    reach = 0.5 * turned_to_hoop(angle, slip)
    last = start + min(reach, 6.0) / 4.0
    found = solve_ivp(rate, (start, last), [angle], rtol=1e-10, atol=1e-12).y[0, -1]

    def normal(t: float) -> float:
        return float(np.unwrap([atan2(ratio * sin(x), cos(x)) for x in np.linspace(start, t, 200)])[-1])

    turned = normal(last) - normal(start)
    assert found == pytest.approx(min(angle_after(angle, slip, [turned])[0], 0.5 * pi), abs=1e-7) or found > 0.5 * pi


def test_the_hoop_is_reached_at_once_by_a_hoop() -> None:
    assert turned_to_hoop(0.5 * pi, 0.3) == pytest.approx(0.0, abs=1e-12)
    assert turned_to_hoop(radians(40.0), 0.25) == pytest.approx(asinh(1.0 / tan(radians(40.0))) / 0.25)


def test_a_section_says_what_it_cannot_be() -> None:
    star = ellipse(50.0, 50.0, 12)
    star[::2] *= 0.5
    with pytest.raises(BadInputError, match="hollow somewhere"):
        section(star)
    with pytest.raises(BadInputError, match="against the clock"):
        section(ellipse(50.0, 50.0, 12)[::-1])
    with pytest.raises(BadInputError, match="no curve"):
        section([[0.0, 0.0], [1.0, 0.0]])
    with pytest.raises(BadInputError, match="does not steer"):
        turned_to_hoop(0.5, 0.0)
    with pytest.raises(BadInputError, match="no turn on a collar"):
        turned_to_hoop(0.0, 0.2)
