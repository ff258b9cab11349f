"""Vessels from irregular meshes: no bridge counts where the part has no hollow, and all real ones do."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from vessels import CONVEX, HOLLOW, inside

import meshwind as mw
from meshwind.core.cast import Floats, Ints
from meshwind.layup.windability import CONVEX as PRESSED_ALL_ROUND
from meshwind.path import Paths, Status
from meshwind.path.lengths import bridged_share, bridges, bridging, lengths, unresolved_share
from meshwind.planning.pressing import pressing
from meshwind.surface.grid import midpoints, parameter_grid

TRUE_GAP = 5e-3
"""Gaps up to this on the exact parts are those of their own net."""
WINDINGS = [(0.0, 0.1), (0.0, 0.3), (0.0, 0.7), (0.2, 0.3)]
"""Friction and revolutions."""


@cache
def fitted(name: str, vertices: int) -> mw.Surface:
    return (CONVEX | HOLLOW)[name].fitted(vertices)


def wound(surface: mw.Surface, friction: float, revolutions: float) -> Paths:
    ends = mw.families(surface, 8, revolutions)
    return mw.solve(surface, ends.start, ends.end, family=ends.family, friction=friction)


def heights(paths: Paths, path: Ints, first: Ints, last: Ints) -> Floats:
    """Lowest and highest point (b, 2) of spans."""
    z = [paths.points[p, a : b + 1, 2] for p, a, b in zip(path, first, last, strict=True)]
    return np.array([(each.min(), each.max()) for each in z]).reshape(-1, 2)


@pytest.mark.parametrize("vertices", [2000, 8000])
@pytest.mark.parametrize("name", sorted(CONVEX))
def test_nothing_bridges_on_a_convex_vessel(name: str, vertices: int) -> None:
    """The spline swings where the curvature jumps: some fibre is off the surface, by less than this is uncertain."""
    surface = fitted(name, vertices)
    assert not len(CONVEX[name].hollow_heights)
    for friction, revolutions in WINDINGS:
        paths = wound(surface, friction, revolutions)
        each, spans = lengths(paths), bridges(paths)
        all_ = np.ones(len(paths), dtype=bool)
        assert not spans.resolved.any()
        assert not bridging(paths).any()
        assert bridged_share((each, all_)) == 0.0 and each.max_gap.max() == 0.0
        assert (unresolved_share((each, all_)) > 0.0) == (len(spans) > 0)
        by_hand = replace(paths, surface=replace(surface, threshold=0.0))
        assert bridges(by_hand).resolved.all()
    assert mw.windability(surface).area(PRESSED_ALL_ROUND) > 0.99
    assert mw.windability(replace(surface, threshold=0.0)).area(PRESSED_ALL_ROUND) < 0.9
    assert pressing(surface).share(np.array([0.1, 0.3, 1.0])).min() > 0.99


@pytest.mark.parametrize(
    ("name", "vertices", "within"),
    [("cone", 2000, 0.025), ("cone", 8000, 0.012), ("step", 2000, 0.02), ("step", 8000, 0.03)],
)
def test_hollows_are_those_of_the_part(name: str, vertices: int, within: float) -> None:
    """They lie at its edges and fillets, which a mesh with facets as large makes rings of a few facets' width."""
    surface, edge = fitted(name, vertices), {"cone": 80.0, "step": 99.0}[name]
    uv = parameter_grid(midpoints(64), midpoints(400))
    found = mw.windability(surface, uv)
    height = surface.points(uv)[:, 2]
    spacing = np.sqrt(2 * np.pi * 40.0 * 220.0 / vertices)  # of vertices, on the mean radius
    elsewhere = (found.kind != PRESSED_ALL_ROUND) & (np.abs(height - edge) > 1.4 * spacing)
    assert found.weight[elsewhere].sum() < 1e-3
    assert found.area(PRESSED_ALL_ROUND) == pytest.approx(HOLLOW[name].convex_share, abs=within)


@pytest.mark.parametrize("vertices", [2000, 8000])
@pytest.mark.parametrize("name", sorted(HOLLOW))
def test_bridges_are_those_of_the_part(name: str, vertices: int) -> None:
    """What counts lies over hollows of the part, where its own fibre bridges; what is three times the error counts."""
    vessel, surface = HOLLOW[name], fitted(name, vertices)
    for friction, revolutions in WINDINGS:
        paths = wound(surface, friction, revolutions)
        true = vessel.exact_paths(paths, friction)
        assert (paths.status == Status.CONVERGED).all() and (true.status == Status.CONVERGED).all()
        found, real = bridges(paths), bridges(true)
        found, real = found.where(found.resolved), real.where(real.max_gap > TRUE_GAP)
        reach = heights(paths, found.path, found.first, found.last)
        over = heights(true, real.path, real.first, real.last)
        assert inside(vessel.hollow_heights, reach).all()
        for path, low, high in zip(found.path, *reach.T, strict=True):
            assert ((over[:, 0] < high) & (over[:, 1] > low) & (real.path == path)).any()
        for path, gap, (low, high) in zip(real.path, real.max_gap, over, strict=True):
            z = paths.points[path, :, 2]
            # a gap is as uncertain as the surface under it and that at its ends together
            stated = 2.0 * surface.uncertainty_at(paths.uv[path, (z > low) & (z < high)]).max()
            if gap > 3.0 * stated:
                assert ((reach[:, 0] < high) & (reach[:, 1] > low) & (found.path == path)).any()
