"""Maps of success and failure: one coloured cell per setting, with a sign for readers who see no colours."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, TypeVar

import numpy as np
from comparison.attempt import STATUSES, Attempt, Outcome
from matplotlib.axes import Axes
from matplotlib.colors import BoundaryNorm, ListedColormap
from matplotlib.patches import Patch

from charts.style import CLASSES, SIGNS
from meshwind.core.cast import Floats
from meshwind.path import Status

KEYS = list(CLASSES)
SHADES = ListedColormap(["#BFE3D5" if key == "ok" else colour for key, (_, colour) in CLASSES.items()])
"""The colours of the classes, but for a paler one where all is right, so that failures stand out."""

Row = dict[str, Any]
"""A row of a table."""
Y = TypeVar("Y")
X = TypeVar("X")


def classify(found: Attempt, error: float, allowed: float) -> str:
    """Class of an attempt: one at rest with an error above `allowed` is a wrong answer that nobody notices."""
    return _class(found.outcome, error <= allowed)


def settled(status: int, right: bool) -> str:
    """Class of a path of ours with this status: at rest right or wrong, otherwise as the status says."""
    return _class(STATUSES.get(Status(int(status)), Outcome.REFUSED), right)


def _class(outcome: Outcome, right: bool) -> str:
    if outcome == Outcome.REST:
        return "ok" if right else "wrong"
    return {Outcome.STALLED: "stalled", Outcome.DIVERGED: "diverged"}.get(outcome, "refused")


def worst_of(results: list[str]) -> str:
    """The class of several paths of ours together."""
    return next((each for each in ("wrong", "stalled", "refused") if each in results), "ok")


def filled(points: Floats, many: int) -> Floats:
    """Polylines (..., n, 3) with so many points (..., (n - 1) many, 3) of each segment, from its start on."""
    share = np.arange(many)[:, None] / many
    dense = points[..., :-1, None, :] + share * np.diff(points, axis=-2)[..., None, :]
    return np.asarray(dense.reshape(*points.shape[:-2], -1, 3))


def sweep(y: Iterable[Y], x: Sequence[X], cell: Callable[[Y, X], Row]) -> tuple[list[list[str]], list[Row]]:
    """Classes [row of y][column of x] and the rows of the table, of which `cell` gives each with its class "result"."""
    lines = [[cell(b, a) for a in x] for b in y]
    return [[row["result"] for row in line] for line in lines], [row for line in lines for row in line]


def paint(
    axes: Axes,
    x: Sequence[float],
    y: Sequence[float],
    classes: Sequence[Sequence[str]],
    *,
    log_x: bool = False,
    log_y: bool = False,
) -> None:
    """Cells classes[row of y][column of x]; axes keep the units of x and y."""
    values = np.array([[KEYS.index(cell) for cell in row] for row in classes])
    axes.pcolormesh(
        edges(x, log_x),
        edges(y, log_y),
        values,
        cmap=SHADES,
        norm=BoundaryNorm(np.arange(len(KEYS) + 1) - 0.5, len(KEYS)),
        edgecolors="white",
        linewidth=0.3,
    )
    for j, row in enumerate(classes):
        for i, cell in enumerate(row):
            if SIGNS[cell]:
                axes.text(x[i], y[j], SIGNS[cell], ha="center", va="center", fontsize=6.5, weight="bold",
                          color="black" if cell == "warned" else "white")  # fmt: skip
    axes.grid(visible=False)
    if log_x:
        axes.set_xscale("log")
    if log_y:
        axes.set_yscale("log")


def edges(centres: Sequence[float], logarithmic: bool) -> np.ndarray[Any, Any]:
    """Cell edges (n + 1,) half way between centres (n,)."""
    c = np.log(np.asarray(centres, float)) if logarithmic else np.asarray(centres, float)
    middle = 0.5 * (c[1:] + c[:-1])
    found = np.concatenate([[2 * c[0] - middle[0]], middle, [2 * c[-1] - middle[-1]]])
    return np.asarray(np.exp(found) if logarithmic else found)


def key(axes: Axes, used: Sequence[Sequence[str]], **where: Any) -> None:
    """Legend of the classes that occur, with their number."""
    flat = [cell for row in used for cell in row]
    patches = [
        Patch(
            color=SHADES(KEYS.index(k)),
            label=f"{CLASSES[k][0]}{' (' + SIGNS[k] + ')' if SIGNS[k] else ''}: {flat.count(k)}",
        )
        for k in KEYS
        if k in flat
    ]
    axes.legend(handles=patches, **({"loc": "upper center", "bbox_to_anchor": (0.5, -0.14), "ncol": 2} | where))
