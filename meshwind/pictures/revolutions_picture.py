"""revolutions.png: the choice of revolutions and its reasons."""

from pathlib import Path
from typing import Any

import numpy as np

from meshwind.planning.alternatives import FRICTION, WIDER
from meshwind.planning.revolutions import Revolutions

_INK, _FAINT = "#1c1c1c", "#5a5a5a"
_PRESSES, _COMMON, _BRIDGED, _SLIDES, _CHOICE = "#b9cfe4", "#2f6da8", "#b3541e", "#d9d4cb", "#1c7c3c"
_BARS = 120
_DPI = 150


def draw_revolutions(picture: Path, chosen: Revolutions, name: str = "") -> None:
    """Draw a .png: the share of the surface on which fibres press, the bounds, the bridged shares, and the choice."""
    # imported late, as all that draws
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9.0, 5.4), facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    last = _last(chosen)
    _histogram(axes, chosen, last)
    _bound(axes, chosen, last)
    _bridged(axes, chosen, last)
    axes.axvline(chosen.choice, color=_CHOICE, linewidth=2.5, label=f"chosen: {chosen.choice:.3g} revolutions")
    axes.set(xlim=(0.0, last), ylim=(0.0, 1.02), xlabel="revolutions from end to end", ylabel="share")
    axes.set_title(chosen.why, loc="left", fontsize=10, color=_FAINT)
    figure.suptitle(f"Revolutions of {name}".removesuffix(" of "), x=0.01, ha="left", fontsize=14, color=_INK)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.13), ncols=2, frameon=False, fontsize=9)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    figure.savefig(picture, dpi=_DPI)


def _last(chosen: Revolutions) -> float:
    """Right end of the picture, beyond all bounds of the choice."""
    bound = chosen.feasible.high
    ends = [1.5 * chosen.choice, 1.2 * chosen.square, 1.3 * bound if np.isfinite(bound) else 0.0]
    ends += [1.05 * gain for gain in (chosen.with_friction, chosen.with_opening) if np.isfinite(gain)]
    ends += [1.5 * low for low, _ in chosen.common]
    return max(*ends, 0.1)


def _histogram(axes: Any, chosen: Revolutions, last: float) -> None:
    edges = np.linspace(0.0, last, _BARS + 1)
    share = chosen.pressing.share(0.5 * (edges[1:] + edges[:-1]))
    axes.stairs(share, edges, fill=True, color=_PRESSES, label="share of the surface on which both families press")
    if not chosen.feasible.any:  # there is no interval in which it could be common
        return
    for k, (low, high) in enumerate(chosen.common):
        words = f"most common interval ({100.0 * chosen.common_share:.3g} % of the surface)" if k == 0 else None
        axes.plot([low, min(high, last)], [chosen.common_share] * 2, color=_COMMON, linewidth=4, label=words)


def _bound(axes: Any, chosen: Revolutions, last: float) -> None:
    found = chosen.feasible
    if found.any and not np.isfinite(found.high):
        return
    how = f"Clairaut's bound {found.high:.3g}" if found.by == "Clairaut" else f"bound, by trials, {found.high:.3g}"
    how = how if found.any else "no number was found that holds all"
    where = {"both": "both ends", "start": "the start", "end": "the end"}.get(found.slides, "a rim")
    axes.axvspan(found.high, last, color=_SLIDES, alpha=0.8, zorder=0, label=f"may slide off {where} ({how})")
    axes.axvline(found.high, color=_INK, linewidth=1.2)
    gains = (
        (f"friction {FRICTION:g}", chosen.with_friction),
        (f"openings {WIDER:g} times as wide", chosen.with_opening),
    )
    for (what, gain), dashes in zip(gains, ((0, (4, 2)), (0, (1, 1.5))), strict=True):
        if gain > 0.0 and np.isfinite(gain):
            axes.axvline(gain, color=_INK, linewidth=1.2, linestyle=dashes, label=f"bound with {what}: {gain:.3g}")


def _bridged(axes: Any, chosen: Revolutions, last: float) -> None:
    seen = [each for each in chosen.trials if 0.0 < each.revolutions <= last]
    for feasible, look in ((True, "o"), (False, "x")):
        tried = [each for each in seen if each.feasible == feasible and each.converged > 0.0]
        words = "share of the fibre that bridges, by trial" if feasible else "the same, where some fibres slide off"
        if tried:
            points = [(each.revolutions, each.bridged_share) for each in tried]
            axes.plot(*np.transpose(points), look, color=_BRIDGED, markersize=4, label=words, clip_on=False, zorder=5)
