"""Scene of winding.png."""

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
from meshwind.core.lists import spread
from meshwind.path.lengths import Bridges, bridges, lengths
from meshwind.path.paths import Paths
from meshwind.pictures.scenes import BridgeLines, Fibres, WindingScene
from meshwind.pictures.subject import Subject


def winding_scene(of: Subject) -> WindingScene:
    """The part, the fibres, the bridges, the view and the words."""
    turns = f"{_turns(of):.4g}"
    title = f"{of.name}: {_families(of.paths)} fibres, {turns} revolution{'s' * (turns != '1')}"
    frame = of.frame(title, _subtitle(of))
    return WindingScene(frame, of.part, fibres(of), _bridge_lines(of), of.figures.max_gap)


def fibres(of: Subject) -> Fibres:
    """The fibres, with those of their particles that are drawn."""
    kept = of.kept
    return Fibres(of.paths.points[:, kept], lifts(of.paths, kept), of.paths.family, of.converged)


def lifts(paths: Paths, kept: Ints) -> Floats:
    """Lift (p, k, 3) of the particles `kept` (k,) so that tubes lie on the part, in radii of the tube.

    It is along the normal on the surface, and interpolated between the normals at both ends along a bridge, which
    stays straight.
    """
    spans = bridges(paths)
    span, column = _inside(spans)
    place = np.full(paths.gap.shape[1], -1)
    place[kept] = np.arange(len(kept))
    span, column = span[place[column] >= 0], column[place[column] >= 0]
    lift = paths.normal[:, kept]
    lift[spans.path[span], place[column]] = _lifted(paths, spans, span, column)
    return lift


def _inside(spans: Bridges) -> tuple[Ints, Ints]:
    """Bridge and number on its path of every particle of every bridge, ends included."""
    size = spans.last - spans.first + 1
    return np.repeat(np.arange(len(spans)), size), spread(spans.first, size)


def _lifted(paths: Paths, spans: Bridges, span: Ints, column: Ints) -> Floats:
    """Lift (k, 3) of particles of bridges, given by their bridges and their numbers on the paths (k,)."""
    row, first, last = spans.path[span], spans.first[span], spans.last[span]
    arc = lengths(paths).arc_length
    share = ((arc[row, column] - arc[row, first]) / spans.length[span])[:, None]
    return np.asarray((1.0 - share) * paths.normal[row, first] + share * paths.normal[row, last])


def _bridge_lines(of: Subject) -> BridgeLines:
    """The bridges as consecutive polylines: every stride-th point and both ends."""
    paths, spans = of.paths, of.figures.spans
    span, column = _inside(spans)
    keep = ((column - spans.first[span]) % of.stride == 0) | (column == spans.last[span])
    span, column = span[keep], column[keep]
    row, sizes = spans.path[span], np.bincount(span, minlength=len(spans))
    lift = _lifted(paths, spans, span, column)
    return BridgeLines(paths.points[row, column], lift, paths.gap[row, column], row, column, sizes)


def _families(paths: Paths) -> str:
    return " + ".join(str(int((paths.family == family).sum())) for family in (1, -1))


def _turns(of: Subject) -> float:
    """The given revolutions; without them the mean of the paths, which bent rims change slightly."""
    mean = float(np.abs(of.paths.uv[:, -1, 0] - of.paths.uv[:, 0, 0]).mean())
    return mean if of.revolutions is None else of.revolutions


def _subtitle(of: Subject) -> str:
    """Figures of the report in one line."""
    figures, paths = of.figures, of.paths
    length = f"fibre length {quantity(figures.fibre_length, of.units)}"
    if figures.converged < len(paths):
        whose = "these" if figures.converged else "all"
        length = f"{figures.converged} of {len(paths)} at rest; {whose}: {length}"
    bridged = f"bridged {100.0 * figures.bridged_share:.1f} %" if len(figures.spans) else "no bridges"
    return "  ·  ".join([length, bridged, f"{len(of.layup.crossings)} crossings"])
