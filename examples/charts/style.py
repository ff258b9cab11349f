"""How every chart looks: one fixed colour and marker a method, safe for the colour-blind."""

from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
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


@dataclass(frozen=True)
class Look:
    """A method's name in the legend, its colour (Okabe and Ito's), marker and line."""

    label: str
    colour: str
    marker: str
    line: str = "-"


BLACK, ORANGE, SKY, GREEN, BLUE, RED, PURPLE, GREY = (
    "#000000",
    "#E69F00",
    "#56B4E9",
    "#009E73",
    "#0072B2",
    "#D55E00",
    "#CC79A7",
    "#777777",
)
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
    "ok": ("right", "#009E73"),
    "wrong": ("wrong answer, unnoticed", "#D55E00"),
    "refused": ("refused, with the reason", "#56B4E9"),
    "stalled": ("not at rest when the steps ran out", "#E69F00"),
    "diverged": ("diverged", "#000000"),
}
"""How an attempt can end, with its words and colour; maps draw a sign as well."""
SIGNS = {"ok": "", "wrong": "!", "refused": "r", "stalled": "~", "diverged": "x"}


def save(figure: Figure, folder: Path, name: str) -> None:
    """Write a chart as PNG and forget it."""
    figure.savefig(folder / f"{name}.png", bbox_inches="tight")
    plt.close(figure)


def log_axes(axes: Axes, x: str, y: str) -> None:
    """Two logarithmic axes with their names and units."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel(x)
    axes.set_ylabel(y)
