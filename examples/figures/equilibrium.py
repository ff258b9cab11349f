"""Figures on equilibrium: forces and the cone of friction, and what Clairaut's relation says of marched fibres."""

import matplotlib.pyplot as plt
import numpy as np
from charts.style import BLACK, BLUE, GREEN, GREY, ORANGE, RED, SKY
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import meshwind as mw


def arrow(axes: Axes, tail: tuple[float, float], way: tuple[float, float], colour: str, name: str) -> None:
    """An arrow from its tail, with its name just past its head."""
    head = (tail[0] + way[0], tail[1] + way[1])
    axes.annotate("", head, tail, arrowprops=dict(arrowstyle="-|>", color=colour, lw=1.8, shrinkA=0, shrinkB=0))
    past = 0.1 / np.hypot(*way)
    axes.text(head[0] + past * way[0], head[1] + past * way[1], name, color=colour, ha="center", va="center")


def forces() -> Figure:
    """What pulls and what carries a piece of fibre, seen from its side and along it."""
    figure, (side, end) = plt.subplots(1, 2, figsize=(7.6, 3.4), layout="constrained")
    angle = np.linspace(-0.9, 0.9, 61)
    piece = np.abs(angle) < 0.45
    side.fill_between(np.sin(angle), np.cos(angle), 0.3, color="0.88")
    side.plot(np.sin(angle), np.cos(angle), color=GREY)
    side.plot(np.sin(angle[piece]), np.cos(angle[piece]), color=ORANGE, lw=4, solid_capstyle="butt")
    tip = (np.sin(0.44), np.cos(0.44))
    arrow(side, tip, (0.4 * np.cos(0.44), -0.4 * np.sin(0.44)), BLUE, "$T\\,t_1$")
    arrow(side, (-tip[0], tip[1]), (-0.4 * np.cos(0.44), -0.4 * np.sin(0.44)), BLUE, "$-T\\,t_0$")
    for turn in (-0.3, 0.0, 0.3):
        arrow(side, (np.sin(turn), np.cos(turn)), (0.3 * np.sin(turn), 0.3 * np.cos(turn)), RED,
              "$N\\,n$" if turn == 0 else "")  # fmt: skip
    side.set(xlim=(-1.0, 1.0), ylim=(0.3, 1.75), title="along the fibre: tension against support")

    friction, needed = 0.3, 0.2
    cone, lean = np.arctan(friction), np.arctan(needed)
    end.fill_between([-1, 1.2], [0, 0], -0.35, color="0.88")
    end.axhline(0.0, color=GREY)
    end.fill([0, np.sin(cone), -np.sin(cone)], [0, np.cos(cone), np.cos(cone)], color=SKY, alpha=0.35)
    arrow(end, (0, 0), (0, 0.75), RED, "$N\\,n$")
    arrow(end, (0, 0), (0.75 * needed, 0), GREEN, "$f$")
    arrow(end, (0, 0), (1.0 * np.sin(lean), 1.0 * np.cos(lean)), BLACK, "$-n_r$")
    arrow(end, (0, 0), (-0.6, 0), GREY, "$b$")
    end.plot(0, 0, "o", ms=9, color=ORANGE)
    end.text(0.4, 0.72, f"cone of $\\mu$ = {friction}:\n$\\pm${np.degrees(cone):.1f}°", color=BLUE)
    end.text(0.4, 0.4, f"this fibre needs {needed}:\n{np.degrees(lean):.1f}°, and stays")
    end.set(xlim=(-0.9, 1.1), ylim=(-0.25, 1.2), title="across the fibre: the cone of friction (3.12)")
    for axes in (side, end):
        axes.set_aspect("equal")
        axes.axis("off")
    return figure


def marching() -> Figure:
    """Fibres marched over a barrel from one point in one direction, with four slips, and Clairaut's constant."""
    barrel = mw.shapes.revolution(lambda z: 1 - 0.3 * (z - 1) ** 2, 0.0, 2.0, (256, 64))
    figure, (chart, constant) = plt.subplots(1, 2, figsize=(7.6, 3.3), layout="constrained")
    for slip, colour in ((0.2, ORANGE), (0.1, GREEN), (0.0, RED), (-0.1, BLUE)):
        fibre = mw.trace(barrel, start=(0.0, 0.5), direction=1.1, length=6.0, slip=slip)
        radius = np.hypot(fibre.points[:, 0], fibre.points[:, 1])
        around = np.stack([-fibre.points[:, 1], fibre.points[:, 0]], axis=1) / radius[:, None]
        clairaut = radius * (fibre.tangent[:, :2] * around).sum(axis=1)
        chart.plot(fibre.uv[:, 0], fibre.uv[:, 1], color=colour, label=f"slip {slip:g}")
        constant.plot(fibre.arc_length, clairaut, color=colour)
        if slip == 0.0:
            print(f"  marching: r sin(alpha) is {clairaut[0]:.6f}, constant within {np.ptp(clairaut):.1e}", flush=True)
    chart.axhline(1.0, color=GREY, lw=0.8)
    chart.set(xlabel="u [turns]", ylabel="v", title="in the chart")
    constant.axhline(0.7, color=GREY, lw=0.8, ls="--")
    constant.text(0.1, 0.705, "radius of the rims", color=GREY, va="bottom")
    constant.set(xlabel="arc length [radius of the middle]", ylabel="r sin(alpha)", title="Clairaut's relation")
    chart.legend(loc="best")
    return figure
