"""The criterion of Tsai and Wu, against values by hand."""

import numpy as np
import pytest

from meshwind.exporting.shell_about import Strengths
from meshwind.solving.tsai_wu import index

STRONG = {"xt": 1500.0, "xc": 1200.0, "yt": 40.0, "yc": 246.0, "s": 68.0}


def at(stress: tuple[float, float, float], interaction: float = -0.5) -> tuple[float, float]:
    found = index(np.array([stress]), Strengths(STRONG, interaction))
    return float(found.polynomial[0]), float(found.exposure[0])


@pytest.mark.parametrize(
    "stress", [(1500.0, 0, 0), (-1200.0, 0, 0), (0, 40.0, 0), (0, -246.0, 0), (0, 0, 68.0), (0, 0, -68.0)]
)
def test_a_ply_fails_at_each_strength(stress: tuple[float, float, float]) -> None:
    assert at(stress) == pytest.approx((1.0, 1.0), rel=1e-12)
    half = tuple(0.5 * each for each in stress)
    assert at(half)[1] == pytest.approx(0.5, rel=1e-12)  # type: ignore[arg-type]


def test_stresses_together_count_as_by_hand() -> None:
    """At 600, 20, 30 MPa; the interaction is -1/2 sqrt(F11 F22) = -3.758e-6."""
    linear = (1 / 1500 - 1 / 1200) * 600 + (1 / 40 - 1 / 246) * 20  # -0.1 + 0.418699
    square = 600**2 / 1.8e6 + 20**2 / 9840 + (30 / 68) ** 2  # 0.2 + 0.040650 + 0.194637
    assert (linear, square) == pytest.approx((0.318699, 0.435287), abs=1e-6)
    cross = 2.0 * -0.5 / np.sqrt(1.8e6 * 9840.0) * 600 * 20
    assert cross == pytest.approx(-0.090166, abs=1e-6)
    polynomial, exposure = at((600, 20, 30))
    assert polynomial == pytest.approx(0.663820, abs=1e-6)
    assert at((600, 20, 30), 0.0)[0] == pytest.approx(0.753986, abs=1e-6)
    factor = 1.0 / exposure
    assert (square + cross) * factor**2 + linear * factor == pytest.approx(1.0, abs=1e-9)
    assert at((600 * factor, 20 * factor, 30 * factor)) == pytest.approx((1.0, 1.0), rel=1e-9)


def test_pressing_across_helps_against_shear() -> None:
    """The polynomial falls below that of shear alone, as yc is above yt; without any stress both are 0."""
    assert at((0, -60, 50))[0] < at((0, 0, 50))[0] < at((0, 20, 50))[0]
    assert at((0, 0, 0)) == (0.0, 0.0)
    assert 0.0 < at((0, -60, 0))[1] < 1.0 and at((0, -60, 0))[0] < 0.0


def test_of_an_isotropic_material_it_is_von_mises() -> None:
    strong = Strengths({**dict.fromkeys(("xt", "xc", "yt", "yc"), 100.0), "s": 100.0 / np.sqrt(3.0)}, -0.5)
    stress = np.random.default_rng(1).normal(0.0, 60.0, (20, 3))
    a, b, t = stress.T
    mises = np.sqrt(a * a - a * b + b * b + 3.0 * t * t)
    assert index(stress, strong).exposure == pytest.approx(mises / 100.0, rel=1e-9)
