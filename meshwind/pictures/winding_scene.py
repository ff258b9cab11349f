"""Scene of winding.png."""

import numpy as np

from meshwind.appearance.words import quantity
from meshwind.core.cast import Floats, Ints
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
    return Fibres(of.paths.points[:, kept], lifts(of.paths)[:, kept], of.paths.family, of.converged)


def lifts(paths: Paths) -> Floats:
    """Lift (p, n, 3) of the particles so that tubes lie on the part, in radii of the tube.

    It is along the normal on the surface, and interpolated between the normals at both ends along a bridge, which
    stays straight.
    """
    spans = bridges(paths)
    row, column, share = _inside(paths, spans)
    size = spans.last - spans.first + 1
    first, last = (np.repeat(paths.normal[spans.path, end], size, axis=0) for end in (spans.first, spans.last))
    lift = np.array(paths.normal)
    lift[row, column] = (1.0 - share)[:, None] * first + share[:, None] * last
    return lift


def _inside(paths: Paths, spans: Bridges) -> tuple[Ints, Ints, Floats]:
    """Path, number and share of the way along its bridge of every particle of every bridge, ends included."""
    size = spans.last - spans.first + 1
    begin = np.cumsum(size) - size
    row = np.repeat(spans.path, size)
    column = np.arange(size.sum()) - np.repeat(begin - spans.first, size)
    arc = lengths(paths).arc_length
    start = np.repeat(arc[spans.path, spans.first], size)
    return row, column, (arc[row, column] - start) / np.repeat(spans.length, size)


def _bridge_lines(of: Subject) -> BridgeLines:
    """The bridges as consecutive polylines: every stride-th point and both ends."""
    paths, spans = of.paths, of.figures.spans
    row, column, _ = _inside(paths, spans)
    size = spans.last - spans.first + 1
    begin = np.cumsum(size) - size
    step = np.arange(len(row)) - np.repeat(begin, size)
    keep = (step % of.stride == 0) | (step == np.repeat(size - 1, size))
    sizes = np.add.reduceat(keep.astype(np.int64), begin) if len(begin) else begin
    row, column = row[keep], column[keep]
    lift = lifts(paths)[row, column]
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
