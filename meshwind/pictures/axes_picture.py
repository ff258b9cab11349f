"""axes.png: the axes of a program over time, the speed of the fibre, and what limits it."""

import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from meshwind.core.cast import Floats, Ints

_INK, _FAINT, _GRID, _SIGNAL = "#1c1c1c", "#5a5a5a", "#dddddd", "#e0218a"
_COLOURS = "#5a6673", "#2f6da8", "#e08a1e", "#1c7c3c", "#8a5fb0", "#b3541e"
"""Colours of what limits: the fibre, then the axes in their order."""
_DPI = 130
_WIDE, _BESIDE = 10.5, 16.0
"""Width in inches of one column, and of two."""
_ROW, _HEAD = 1.35, 1.9
"""Height in inches of a row, and of what is above and below the rows."""
_LETTER, _LINE = 0.079, 0.2
"""Width in inches of a letter of the line below the title, on average, and height of such a line."""
_NAME = 0.09
"""Share of the time that the name of a layer takes."""
_MINUTES = 600.0
"""Seconds from which the time is in minutes."""


@dataclass(frozen=True)
class Curve:
    """What an axis is called, its unit, and its values (n,) at the blocks."""

    name: str
    unit: str
    values: Floats


@dataclass(frozen=True)
class AxesChart:
    """What the chart shows of the n blocks of a program.

    time (n,): seconds; curves: of the axes; speed (n - 1,): of the fibre through the eye on the way to each block, NaN
    where that takes no time, in mm/s; fastest: the largest that the machine allows; names, limiting (n - 1,): what
    limits, and which of it limits the way to each block; layers: name of each layer with the seconds at which it
    starts; faults: words with the seconds (k,) of the blocks at fault; circuit: seconds at which the first circuit
    starts and ends, None where it is most of the program.
    """

    title: str
    subtitle: str
    time: Floats
    curves: tuple[Curve, ...]
    speed: Floats
    fastest: float
    names: tuple[str, ...]
    limiting: Ints
    layers: tuple[tuple[str, float], ...]
    faults: tuple[tuple[str, Floats], ...]
    circuit: tuple[float, float] | None


def draw_axes(picture: Path, chart: AxesChart) -> None:
    """Draw a .png: a row for each axis, the fibre's speed and what limits; the first circuit beside the whole."""
    # imported late, as all that draws
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    spans = [("whole program", (0.0, float(chart.time[-1])))]
    if chart.circuit is not None:
        spans.append(("first circuit", chart.circuit))
    rows = len(chart.curves) + 2
    width = _WIDE if len(spans) == 1 else _BESIDE
    below = lines_of(chart.subtitle, int(width / _LETTER))
    height = _HEAD + _ROW * rows + _LINE * (len(below) - 1)
    figure = Figure(figsize=(width, height), facecolor="white", layout="constrained")
    FigureCanvasAgg(figure)
    every = figure.subplots(rows, len(spans), sharex="col", squeeze=False)
    for column, (words, span) in zip(every.T, spans, strict=True):
        _column(column, chart, span, words if len(spans) > 1 else "")
    figure.align_ylabels(every[:, 0])
    figure.suptitle(chart.title + "\n" * len(below), x=0.008, ha="left", fontsize=15, color=_INK)
    figure.text(0.008, 1.0 - 0.36 / height, "\n".join(below), fontsize=10.5, color=_FAINT, va="top")
    figure.savefig(picture, dpi=_DPI)


def lines_of(text: str, most: int) -> list[str]:
    """Phrases, which dots part, in lines of at most so many letters: one that is too long is broken at its words."""
    dot = "  \N{MIDDLE DOT}  "
    lines = [""]
    for phrase in text.split(dot):
        for part in textwrap.wrap(phrase, most) or [""]:
            if lines[-1] and len(lines[-1] + dot + part) <= most:
                lines[-1] += dot + part
            else:
                lines.append(part)
    return lines[1:]


def _column(column: Any, chart: AxesChart, span: tuple[float, float], words: str) -> None:
    """Draw all rows over a span of time."""
    share, unit = (60.0, "min") if span[1] - span[0] > _MINUTES else (1.0, "s")
    shown = chart.time >= span[0]
    shown &= chart.time <= span[1]
    for axes, curve, colour in zip(column, chart.curves, _COLOURS[1:], strict=False):
        axes.plot(chart.time / share, curve.values, color=colour, linewidth=1.1)
        axes.set_ylabel(f"{curve.name}\n{curve.unit}", fontsize=10.5)
        _fit(axes, curve.values[shown])
    speed, limits = column[-2], column[-1]
    speed.stairs(chart.speed, chart.time / share, baseline=None, color=_COLOURS[0], linewidth=1.1)
    speed.axhline(chart.fastest, color=_INK, linewidth=0.9, linestyle=(0, (4, 3)))
    speed.set_ylim(0.0, 1.15 * chart.fastest)
    speed.set_ylabel("fibre through\nthe eye, mm/s", fontsize=10.5)
    speed.annotate(
        "largest of the machine", (1.0, chart.fastest), xycoords=("axes fraction", "data"), xytext=(0, 2),
        textcoords="offset points", ha="right", va="bottom", fontsize=8, color=_FAINT,
    )  # fmt: skip
    _limits(limits, chart, span, share)
    for number, axes in enumerate(column):
        axes.set_xlim(span[0] / share, span[1] / share)
        axes.grid(color=_GRID, linewidth=0.7)
        axes.set_axisbelow(True)
        axes.tick_params(labelsize=9)
        for side in ("top", "right"):
            axes.spines[side].set_visible(False)
        _marks(axes, chart, span, share, named=number == 0)
    column[0].set_title(words, loc="left", fontsize=12, color=_INK, pad=18)
    limits.set_xlabel(f"time, {unit}", fontsize=10.5)


def _fit(axes: Any, values: Floats) -> None:
    """Set the limits to values, with some room; a value that does not change is in the middle."""
    low, high = float(values.min()), float(values.max())
    room = 0.06 * (high - low) or max(0.05 * abs(high), 1.0)
    axes.set_ylim(low - room, high + room)


def _limits(axes: Any, chart: AxesChart, span: tuple[float, float], share: float) -> None:
    """Draw a lane for each of what limits, with bars where it does, and its share of the time."""
    step = np.diff(np.clip(chart.time, *span))
    starts = np.flatnonzero(np.diff(chart.limiting, prepend=-1))
    ends = np.append(starts[1:], len(chart.limiting))
    begin, width = chart.time[starts], chart.time[ends] - chart.time[starts]
    labels = []
    for k, name in enumerate(chart.names):
        mine = (chart.limiting[starts] == k) & (width > 0.0)
        bars = np.stack([begin[mine], width[mine]], axis=1) / share
        axes.broken_barh(bars, (len(chart.names) - k - 1.4, 0.8), color=_COLOURS[k % len(_COLOURS)], linewidth=0)
        labels.append(f"{name}  {100.0 * step[chart.limiting == k].sum() / max(step.sum(), 1e-300):.0f} %")
    axes.set_yticks(range(len(chart.names)), labels[::-1])
    axes.set_ylim(-0.6, len(chart.names) - 0.4)
    axes.set_ylabel("limited by", fontsize=10.5)


def _marks(axes: Any, chart: AxesChart, span: tuple[float, float], share: float, *, named: bool) -> None:
    """Mark where layers start and which blocks are at fault; named: whether layers are named above."""
    before, raised = -np.inf, False
    for name, start in chart.layers:
        if not span[0] <= start < span[1]:
            continue
        if start > span[0]:
            axes.axvline(start / share, color=_INK, linewidth=1.0)
        if named:
            raised = not raised and start - before < _NAME * (span[1] - span[0])
            before = start
            axes.annotate(
                name, (start / share, 1.0), xycoords=("data", "axes fraction"), xytext=(3, 15 if raised else 4),
                textcoords="offset points", fontsize=9, color=_INK,
            )  # fmt: skip
    for _, times in chart.faults:
        begin = chart.time[np.maximum(np.searchsorted(chart.time, times) - 1, 0)]
        bars = np.stack([begin, times - begin], axis=1) / share
        across = {"transform": axes.get_xaxis_transform(), "color": _SIGNAL}
        axes.broken_barh(bars, (0.0, 1.0), alpha=0.22, linewidth=0, zorder=0, **across)
        inside = times[(times >= span[0]) & (times <= span[1])] / share
        if named and len(inside):  # an empty one would count as far off in the layout
            axes.plot(inside, np.ones(len(inside)), "|", markersize=9, clip_on=False, zorder=5, **across)
