"""tradeoffs.png: the figures of a study against the swept options."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from meshwind.results.staging import staged
from meshwind.studies.study import CaseStatus, Row

_FIGURES = {
    "bridged_share": "bridged, share of length",
    "bare_share": "bare, share of the surface",
    "angle_median": "crossing angle, median [degrees]",
    "length": "length of fibre",
}
_COLOURS = ("#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#000000")
_MARKS = "os^Dv*P"
_DPI = 130
_MOST_WORDS, _APART = 12, 0.085
"""Lines up to which each has words at its end, and distance of the words over the height of the axes."""


def draw_tradeoffs(picture: Path, rows: Sequence[Row], swept: Sequence[str]) -> None:
    """Draw a column for each option with several numbers and a row for each figure.

    A line joins cases whose other options are the same.  Cases that were refused or lost have no figures, and are
    counted in the title.
    """
    names = [_column(name) for name in swept]
    done = [row for row in rows if CaseStatus(str(row["status"])).has_figures]
    numeric = [name for name in names if len(_numbers(done, name)) > 1]
    if not numeric:
        return
    # late: Matplotlib takes long to import
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(4.6 * len(numeric) + 1.2, 2.7 * len(_FIGURES) + 0.9), facecolor="white")
    figure.set_layout_engine("constrained")
    FigureCanvasAgg(figure)
    grid = figure.subplots(len(_FIGURES), len(numeric), squeeze=False, sharex="col", sharey="row")
    for column, name in enumerate(numeric):
        others = [other for other in names if other != name]
        groups = _lines(done, name, others)
        words = line_words([group for group, _ in groups], others)
        for row, (figure_name, label) in enumerate(_FIGURES.items()):
            axes = grid[row, column]
            for group, line in groups:
                style = _style(group, done)
                at = [each[name] for each in line]
                axes.plot(at, [each[figure_name] for each in line], lw=1.1, ms=4, alpha=0.85, **style)
            if len(groups) <= _MOST_WORDS and any(words):
                _write_words(axes, [(line[-1][name], line[-1][figure_name]) for _, line in groups], words)
            axes.grid(alpha=0.3, lw=0.5)
            for side in ("top", "right"):
                axes.spines[side].set_visible(False)
            if column == 0:
                axes.set_ylabel(label, fontsize=9)
            if row == len(_FIGURES) - 1:
                axes.set_xlabel(name.replace("_", " "))
    _legend(figure, grid[0, 0])
    failed = len(rows) - len(done)
    at_rest = sum(row["status"] == CaseStatus.AT_REST for row in done)
    figure.suptitle(
        f"{len(rows)} cases: {at_rest} at rest, {len(done) - at_rest} with paths that are not, {failed} without "
        "figures.  "
        "A line joins cases whose other options are the same.",
        fontsize=10,
    )
    with staged(picture.parent, lambda _: ()) as staging:
        figure.savefig(staging / picture.name, dpi=_DPI, metadata={"Software": None})


def line_words(groups: Sequence[Row], others: Sequence[str]) -> list[str]:
    """Words for each line: those of its other options in which the lines differ, but for the mesh, which has a colour.

    groups: a case of each line.
    """
    differ = [name for name in others if name != "mesh" and len({repr(row[name]) for row in groups}) > 1]
    return [", ".join(f"{name.replace('_', ' ')} {_short(row[name])}" for name in differ) for row in groups]


def kept_apart(places: Sequence[float], gap: float) -> list[float]:
    """Places from 0 to 1 for words that are at least a gap from each other, near these places and in their order."""
    order = sorted(range(len(places)), key=places.__getitem__)
    moved, least = [0.0] * len(places), 0.0
    for k in order:
        moved[k] = max(places[k], least)
        least = moved[k] + gap
    most = 1.0
    for k in reversed(order):  # what went over the top pushes those below it down
        moved[k] = min(moved[k], most)
        most = moved[k] - gap
    return moved


def _short(value: Any) -> str:
    return f"{value:.4g}" if isinstance(value, float) else str(value)


def _write_words(axes: Any, ends: Sequence[tuple[Any, Any]], words: Sequence[str]) -> None:
    """Write words to the right of the ends of lines, on lines of their own where ends are close."""
    shown = [(x, y, each) for (x, y), each in zip(ends, words, strict=True) if y is not None and y == y]
    if not shown:
        return
    low, high = axes.get_ylim()
    places = kept_apart([(y - low) / (high - low) for _, y, _ in shown], _APART)
    for (x, y, each), place in zip(shown, places, strict=True):
        axes.annotate(
            each, (x, y), (1.02, place), textcoords="axes fraction", fontsize=6, va="center", annotation_clip=False,
            arrowprops={"arrowstyle": "-", "lw": 0.4, "color": "#999999"},
        )  # fmt: skip


def _column(name: str) -> str:
    """The table's name of an option."""
    return {"paths": "paths_a_family"}.get(name, name.replace("-", "_"))


def _numbers(rows: Sequence[Row], name: str) -> set[float]:
    return {value for row in rows if isinstance(value := row[name], int | float)}


def _lines(rows: Sequence[Row], name: str, others: Sequence[str]) -> list[tuple[Row, list[Row]]]:
    """The cases that have a number for `name`, grouped by their other options, each group by increasing numbers."""
    groups: dict[str, list[tuple[float, Row]]] = {}
    for row in rows:
        value = row[name]
        if isinstance(value, int | float):
            groups.setdefault(repr([row[other] for other in others]), []).append((value, row))
    return [(line[0][1], [row for _, row in sorted(line, key=lambda pair: pair[0])]) for line in groups.values()]


def _style(row: Row, rows: Sequence[Row]) -> dict[str, Any]:
    """A colour and a mark for each mesh."""
    meshes = list(dict.fromkeys(each["mesh"] for each in rows))
    k = meshes.index(row["mesh"])
    return {"color": _COLOURS[k % len(_COLOURS)], "marker": _MARKS[k % len(_MARKS)], "label": row["mesh"]}


def _legend(figure: Any, axes: Any) -> None:
    handles, labels = axes.get_legend_handles_labels()
    once = dict(zip(labels, handles, strict=True))
    figure.legend(once.values(), once.keys(), loc="outside lower center", ncols=min(len(once), 5), fontsize=9)
