"""The gap from which a fibre counts as bridging: the surface's uncertainty, or a threshold set by hand."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from layup_shapes import bridged

import meshwind as mw
from meshwind.core.cast import frozen
from meshwind.editing.edit import lifted, threshold_of
from meshwind.path import Paths
from meshwind.path.lengths import bridges, bridging, lengths, tolerated
from meshwind.results.figures import path_figures
from meshwind.results.reading import read_results
from meshwind.workflow.notes import about_contact

ROOT = Path(__file__).parents[1]


def doubted(uncertainty: float | None = None, threshold: float | None = None) -> Paths:
    """Paths with one bridge each, on a surface that is everywhere as uncertain."""
    paths = bridged()
    table = None if uncertainty is None else frozen(np.full((3, 4), uncertainty))
    return replace(paths, surface=replace(paths.surface, uncertainty=table, threshold=threshold))


def test_a_gap_is_as_uncertain_as_the_surface_under_it_and_at_its_ends() -> None:
    paths = bridged()
    off, deepest = ~paths.on_surface, float(paths.gap.max())
    assert np.all(tolerated(paths) == 0.0)
    assert tolerated(doubted(0.1)) == pytest.approx(np.where(off, 0.2, 0.0))
    assert tolerated(doubted(0.1, 0.03)) == pytest.approx(np.where(off, 0.03, 0.0))
    assert bridges(doubted(0.499 * deepest)).resolved.all()
    assert not bridges(doubted(0.501 * deepest)).resolved.any()
    assert bridges(doubted(deepest, 0.999 * deepest)).resolved.all()
    assert not bridges(doubted(None, 1.001 * deepest)).resolved.any()
    assert bridges(doubted(deepest, 0.0)).resolved.all()


def test_uncertainty_counts_where_it_is() -> None:
    """Where only the ends of the spans are uncertain, each counts by its share of the way."""
    paths = bridged()
    table = np.zeros((1, 50))
    table[:, :25] = 1.0
    found = tolerated(replace(paths, surface=replace(paths.surface, uncertainty=frozen(table))))
    on = ~paths.on_surface[0]
    v = paths.uv[0, :, 1]
    first, last = v[on][0] - (v[1] - v[0]), v[on][-1] + (v[1] - v[0])
    upper = on & (v > 0.52)  # past the half that is uncertain
    assert found[0][upper] == pytest.approx(((last - v) / (last - first))[upper], abs=0.02)


@pytest.mark.parametrize("threshold", [None, 1.0])
def test_what_does_not_count_is_contact(threshold: float | None) -> None:
    """Of bridged and unresolved length one is that of all spans, the other 0; a note says what is left out."""
    plain, hidden = path_figures(bridged()), path_figures(doubted(1.0, threshold))
    assert (len(plain.spans), len(plain.unresolved)) == (32, 0) == (len(hidden.unresolved), len(hidden.spans))
    assert hidden.unresolved_share == plain.bridged_share > 0.0
    assert hidden.bridged_share == hidden.max_gap == hidden.longest_bridge == plain.unresolved_share == 0.0
    assert not bridging(doubted(1.0, threshold)).any() and not lifted(doubted(1.0, threshold)).any()
    each = lengths(bridged())
    assert np.array_equal(lengths(doubted(1.0, threshold)).unresolved_length, each.bridged_length)
    assert about_contact(bridged()) == ()
    (note,) = about_contact(doubted(1.0, threshold), "mm")
    less = "the surface's uncertainty" if threshold is None else "the threshold of 1 mm"
    share = f"{100 * plain.bridged_share:.1f} %"
    assert note.text == f"{share} of the fibre is off the surface by less than {less}, and counts as contact"
    assert not note.warning


def wound(threshold: float, out: Path | None = None) -> mw.Result:
    part = ROOT / "data" / "vase.stl"
    return mw.wind(part, threshold=threshold, paths=2, revolutions=0.3, particles=101, out=out, render=False)


def test_a_run_counts_by_its_threshold_and_keeps_it(tmp_path: Path) -> None:
    every = wound(0.0).report()["paths"]
    assert every["bridges"] > 0
    assert every["unresolved"] == {"threshold": 0.0, "bridges": 0, "fraction": 0.0, "max_gap": 0.0}
    limit = 1.5 * every["max_gap"]
    result = wound(limit, tmp_path / "out")
    none = result.report()["paths"]
    assert none["bridges"] == 0 and none["bridged_fraction"] == none["max_gap"] == 0.0
    assert none["unresolved"]["threshold"] == limit
    assert none["unresolved"]["fraction"] == pytest.approx(every["bridged_fraction"])
    assert none["unresolved"]["max_gap"] == pytest.approx(every["max_gap"])
    assert any("counts as contact" in note for note in result.report()["notes"])
    held, own = read_results(tmp_path / "out").surface, result.surface.uncertainty
    assert held.threshold == limit
    assert held.uncertainty is not None and own is not None and np.array_equal(held.uncertainty, own)


def test_the_redesign_ignores_what_does_not_count() -> None:
    surface = doubted(0.25).surface
    assert threshold_of(surface) == pytest.approx(0.25)
    assert threshold_of(replace(surface, threshold=0.5)) == 0.5
    assert threshold_of(bridged().surface) == pytest.approx(1e-6 * surface.size)
