"""Numbers at their limits: no NaN comes out, whatever goes in, and the kernels do as plain Python does."""

import json
import os
import subprocess
import sys
from collections.abc import Callable
from dataclasses import fields, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from mesh_shapes import pear
from strain_cases import CASES, barrel, laid, waist

import meshwind as mw
from meshwind.core.cast import Floats
from meshwind.layup.layup import assess
from meshwind.mesh import mesh_from
from meshwind.path.lengths import bridges, lengths
from meshwind.results.maps import maps
from meshwind.surface import Surface, shapes
from meshwind.surface.grid import grid

NAN_BY_CONTRACT = {"slip"}
"""Off the surface and at the ends it is not defined; the README says so."""


def test_plain_python_gives_what_the_kernels_give() -> None:
    """Without compilation every index is checked, and no type is hidden by the compiler."""
    command = [sys.executable, str(Path(__file__).with_name("strain_cases.py"))]
    plain = os.environ | {"NUMBA_DISABLE_JIT": "1"}
    said = subprocess.run(command, env=plain, capture_output=True, text=True, check=True, timeout=240)
    told = json.loads(said.stdout)
    assert told.keys() == CASES.keys()
    for name, case in CASES.items():
        assert case() == pytest.approx(told[name], rel=1e-9, abs=1e-9), name


def assert_finite(value: Any, name: str) -> None:
    """Every number in a result and in what it holds is finite, but for what is not defined by contract."""
    if isinstance(value, np.ndarray) and value.dtype.kind == "f":
        assert name in NAN_BY_CONTRACT or np.isfinite(value).all(), name
    elif isinstance(value, float):
        assert np.isfinite(value), name
    elif is_dataclass(value) and not isinstance(value, Surface):
        for field in fields(value):
            assert_finite(getattr(value, field.name), field.name)


def placed(surface: Surface, scale: float, shift: float) -> Surface:
    """The surface in another unit and far from the origin, by so many of its sizes."""
    return Surface(scale * (surface.control_points + shift * surface.size), surface.periodic)


place = st.floats(0.0, 1.0, allow_subnormal=False)
step = st.one_of(st.sampled_from([0.0, 1e-9, 1e-6, 0.5, 3.0]), place)


@given(
    st.sampled_from(["barrel", "waist", "tube"]), st.sampled_from([1e-40, 1e-6, 1.0, 1e6, 1e40]),
    st.sampled_from([0.0, 1e3, 1e6]), st.tuples(place, place), st.tuples(step, step), st.sampled_from([3, 4, 5, 17]),
    st.sampled_from([0.0, 0.1, 10.0]),
)  # fmt: skip
@settings(max_examples=40, deadline=None, derandomize=True, database=None)
def test_no_nan_leaves_the_solver_nor_what_follows(
    name: str,
    scale: float,
    shift: float,
    start: tuple[float, float],
    way: tuple[float, float],
    particles: int,
    mu: float,
) -> None:
    """Ends that meet or nearly so, few particles, units from 1e-40 to 1e40, a million sizes from the origin."""
    shape = {"barrel": barrel, "waist": waist, "tube": lambda: shapes.cylinder(1.0, 2.0, (16, 8))}[name]()
    end = start[0] + way[0], min(start[1] + way[1], 1.0)
    curve = np.linspace(start, end, 2)[None]
    surface = placed(shape, scale, shift)
    if np.abs(curve[0, 1] - curve[0, 0]).max() <= 1e-9:
        with pytest.raises(mw.BadInputError, match="ends where it starts"):
            mw.solve(surface, [start], [end], particles=particles, friction=mu, initial=curve)
        return
    paths = mw.solve(surface, [start], [end], particles=particles, friction=mu, initial=curve)
    assert_finite(paths, "paths")
    inside = np.asarray(paths.slip)[:, 1:-1][paths.on_surface[:, 1:-1]]
    assert paths.status[0] != mw.Status.CONVERGED or not np.isnan(inside).any()
    for result in (lengths(paths), bridges(paths), assess(paths), paths.length):
        assert_finite(result, "result")


@pytest.mark.parametrize("scale", [1e-40, 1e40])
@pytest.mark.parametrize("shift", [0.0, 1e6])
def test_no_nan_in_the_maps(scale: float, shift: float) -> None:
    surface = placed(waist(), scale, shift)
    on = grid(surface, 1)
    for name, values in maps(on, assess(laid(surface))).items():
        assert_finite(np.asarray(values), name)


BAD = (float("nan"), float("inf"), -float("inf"))
ONE = [[0.2, 0.0]], [[0.4, 1.0]]
TAKES: dict[str, Callable[[float], Any]] = {
    "solve start": lambda x: mw.solve(barrel(), [[x, 0.0]], ONE[1]),
    "solve end": lambda x: mw.solve(barrel(), ONE[0], [[0.1, x]]),
    "solve friction": lambda x: mw.solve(barrel(), *ONE, friction=x),
    "solve friction table": lambda x: mw.solve(barrel(), *ONE, friction=np.full((3, 3), x)),
    "solve friction function": lambda x: mw.solve(barrel(), *ONE, friction=lambda at: np.full(len(at), x)),
    "solve initial": lambda x: mw.solve(barrel(), *ONE, initial=[[[0.2, 0.0], [x, 0.5], [0.4, 1.0]]]),
    "solve tolerance": lambda x: mw.solve(barrel(), *ONE, tolerance=-abs(x)),
    "solve accuracy": lambda x: mw.solve(barrel(), *ONE, accuracy=-abs(x)),
    "solve particles": lambda x: mw.solve(barrel(), *ONE, particles=x),  # type: ignore[arg-type]
    "solve iterations": lambda x: mw.solve(barrel(), *ONE, iterations=x),  # type: ignore[arg-type]
    "drag": lambda x: mw.drag(barrel(), [[0.1, 0.0], [x, 0.0]], [[0.2, 1.0], [0.3, 1.0]]),
    "drag particles": lambda x: mw.drag(barrel(), *ONE, particles=x),  # type: ignore[arg-type]
    "drag tolerance": lambda x: mw.drag(barrel(), *ONE, tolerance=-abs(x)),
    "families": lambda x: mw.families(barrel(), 2, x),
    "families paths": lambda x: mw.families(barrel(), x, 0.2),  # type: ignore[arg-type]
    "assess": lambda x: assess(laid(barrel()), x),
    "space out": lambda x: mw.space_out(laid(barrel()), 0.2, x),
    "space out revolutions": lambda x: mw.space_out(laid(barrel()), x, 0.2),
    "choose": lambda x: mw.choose_revolutions(barrel(), most=-abs(x)),
    "choose paths": lambda x: mw.choose_revolutions(barrel(), paths=x),  # type: ignore[arg-type]
    "trace start": lambda x: mw.trace(barrel(), (0.1, x), 0.4, 1.0),
    "trace direction": lambda x: mw.trace(barrel(), (0.1, 0.1), x, 1.0),
    "trace length": lambda x: mw.trace(barrel(), (0.1, 0.1), 0.4, x),
    "trace slip": lambda x: mw.trace(barrel(), (0.1, 0.1), 0.4, 1.0, slip=x),
    "trace step": lambda x: mw.trace(barrel(), (0.1, 0.1), 0.4, 1.0, step=x),
    "trace tolerance": lambda x: mw.trace(barrel(), (0.1, 0.1), 0.4, 1.0, tolerance=x),
    "surface": lambda x: Surface(np.full((5, 5, 3), x)),
    "surface points": lambda x: barrel().points([(x, 0.5)]),
    "surface normals": lambda x: barrel().normals([(0.5, x)]),
    "windability": lambda x: mw.windability(barrel(), np.array([[0.1, x]])),
    "friction from": lambda x: mw.friction_from(barrel(), np.zeros((1, 3)), np.array([x])),
    "image": lambda x: mw.from_image(np.full((8, 8, 3), x)),
    "mesh": lambda x: mesh_from(np.where(pear(1)[0] > 2.0, x, pear(1)[0]), pear(1)[1]),
    "opening": lambda x: mw.annulus(mesh_from(*pear(2)), opening=x),
    "ends": lambda x: mw.annulus(mesh_from(*pear(2)), ends=f"{x},0,0 0,0,1"),
    "fit tolerance": lambda x: mw.fit(mw.flatten(mw.annulus(mesh_from(*pear(2)))), -abs(x)),
}


@pytest.mark.parametrize("bad", BAD)
@pytest.mark.parametrize("name", TAKES)
def test_what_is_no_number_is_refused_in_one_line(name: str, bad: float) -> None:
    with pytest.raises(mw.BadInputError) as refusal:
        TAKES[name](bad)
    assert "\n" not in str(refusal.value)


def test_a_surface_that_is_a_point_or_a_line_gives_no_nan() -> None:
    ring: Floats = np.array(shapes.cylinder(1.0, 2.0, (16, 8)).control_points)
    with pytest.raises(mw.BadInputError, match="in one place"):
        mw.solve(Surface(0.0 * ring), *ONE, particles=9)
    for factors in ([0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0]):
        paths = mw.solve(Surface(ring * factors), *ONE, particles=9)
        assert_finite(paths, "paths")
        assert_finite(assess(paths), "layup")
