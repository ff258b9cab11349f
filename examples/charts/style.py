"""How every chart looks: one fixed colour and marker per method, safe for the colour-blind."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

plt.rcParams.update(
    {
        "font.size": 9,
        "axes.titlesize": 9.5,
        "axes.grid": True,
        "grid.alpha": 0.35,
        "grid.linewidth": 0.5,
        "legend.fontsize": 8.5,
        "figure.dpi": 110,
        "savefig.dpi": 130,
        "axes.spines.top": False,
        "axes.spines.right": False,
    }
)


BETWEEN = 12
"""Points of each piece of a line at which it must not lie below a legend."""


@dataclass(frozen=True)
class Look:
    """A method's name in the legend, its colour (of Okabe and Ito), marker and line."""

    label: str
    colour: str
    marker: str
    line: str = "-"


BLACK, ORANGE, SKY, GREEN = "#000000", "#E69F00", "#56B4E9", "#009E73"
BLUE, RED, PURPLE, GREY = "#0072B2", "#D55E00", "#CC79A7", "#777777"
YELLOW = "#F0E442"
LOOKS = {
    "meshwind": Look("meshwind (Newton, this work)", RED, "o"),
    "backward-euler": Look("backward Euler (4.16, 4.17)", BLUE, "s"),
    "backward-euler-reuse": Look("backward Euler, matrix reused", SKY, "s", "--"),
    "backward-euler-ruled": Look("backward Euler, lengths by our rule", BLUE, "s", ":"),
    "explicit-euler": Look("explicit Euler (4.10-4.12)", ORANGE, "v"),
    "symplectic-euler": Look("symplectic Euler", ORANGE, "^", "--"),
    "rk4": Look("Runge-Kutta 4", PURPLE, "D"),
    "kkt": Look("KKT method (7.2-7.9)", GREEN, "P"),
    "penalty": Look("penalty force (7.1)", GREEN, "X", ":"),
    "flipout": Look("FlipOut on a mesh (potpourri3d)", BLACK, "*"),
    "mmp-pygeodesic": Look("exact polyhedral (pygeodesic)", GREY, "<"),
    "mmp-libigl": Look("exact polyhedral (libigl)", GREY, ">", "--"),
    "shooting-dop853": Look("shooting, SciPy DOP853", BLACK, "1", ":"),
    "shooting-trace": Look("shooting, meshwind.trace", PURPLE, "2", ":"),
    "collocation": Look("collocation, SciPy solve_bvp", BLACK, "x", "--"),
}
"""In the order of the legend."""

CLASSES = {
    "ok": ("right", GREEN),
    "vague": ("within its stated error, which is large", PURPLE),
    "warned": ("elsewhere, by what other_rests states", YELLOW),
    "understated": ("right place, length off by more than stated", BLUE),
    "wrong": ("wrong answer without a warning", RED),
    "refused": ("refused, with the reason", SKY),
    "stalled": ("not at rest after the last step", ORANGE),
    "diverged": ("diverged", BLACK),
}
"""How an attempt can end, with its text in legends and its colour."""
SIGNS = {
    "ok": "",
    "vague": "?",
    "warned": "w",
    "understated": "u",
    "wrong": "!",
    "refused": "r",
    "stalled": "~",
    "diverged": "x",
}
"""What maps draw beside the colour."""


def covered(axes: Axes) -> bool:
    """Whether the legend of axes lies over what they show."""
    legend = axes.get_legend()
    if legend is None:
        return False
    box = legend.get_window_extent()
    dots = (np.asarray(scatter.get_offsets(), float) for scatter in axes.collections)
    shown = [axes.transData.transform(each) for each in dots if len(each)]
    for line in axes.lines:
        points = line.get_transform().transform(np.column_stack([line.get_xdata(), line.get_ydata()]).astype(float))
        share = np.linspace(0.0, 1.0, BETWEEN)[:, None, None]
        shown += [points, *(points[:-1] + share * np.diff(points, axis=0))]
    return any(box.contains(x, y) for points in shown for x, y in points)


def save(figure: Figure, folder: Path, name: str) -> None:
    """Write a chart as PNG and close it; says so where a legend lies over what is shown."""
    figure.canvas.draw()
    for axes in figure.axes:
        if covered(axes):
            print(f"  {name}.png: a legend lies over what is shown in {axes.get_title()!r}", flush=True)
    figure.savefig(folder / f"{name}.png", bbox_inches="tight")
    plt.close(figure)


def log_axes(axes: Axes, x: str, y: str) -> None:
    """Two logarithmic axes with their names and units."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(x)
    axes.set_ylabel(y)


def note(axes: Axes, x: float, y: float, text: str, **how: Any) -> None:
    """A line of text on a white ground."""
    axes.text(x, y, text, fontsize=8, bbox=dict(fc="white", ec="none", alpha=0.8), **how)
