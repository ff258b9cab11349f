"""Figures on layups: what a number of revolutions does to a bottle, and the directions in which a fibre presses."""

import matplotlib.pyplot as plt
import numpy as np
from charts.style import BLUE, GREEN, ORANGE, RED, SKY
from comparison.problems import bottle
from matplotlib.figure import Figure

import meshwind as mw
from meshwind.planning.pressing import pressing


def revolutions() -> Figure:
    """Shares of a bottle that presses by (6.3), of the fibre that bridges, and of the paths that stay."""
    surface = bottle()
    turns = np.linspace(0.02, 1.8, 90)
    share = pressing(surface).share(turns)
    wound = np.linspace(0.05, 1.8, 36)
    bridged, held = [], []
    for number in wound:
        ends = mw.families(surface, 2, float(number))
        paths = mw.solve(surface, ends.start, ends.end, family=ends.family, particles=201)
        rest = paths.status == mw.Status.CONVERGED
        held.append(rest.mean())
        step = np.linalg.norm(np.diff(paths.points, axis=1), axis=2)
        air = ~(paths.on_surface[:, 1:] & paths.on_surface[:, :-1])
        bridged.append((step * air)[rest].sum() / step[rest].sum() if rest.any() else np.nan)
    figure, axes = plt.subplots(figsize=(6.8, 3.5), layout="constrained")
    axes.plot(turns, share, color=GREEN, label="share of the surface that presses (6.3)")
    axes.plot(wound, bridged, "o-", ms=4, color=RED, label="share of the fibre that bridges")
    axes.plot(wound, held, "s", ms=4, color=BLUE, label="share of the paths that stay")
    limit = wound[np.array(held) < 1]
    print(f"  revolutions: pressing {share[[0, -1]]}, bridged {np.round(bridged, 3)}, first that slides {limit[:1]}")
    axes.set(xlabel="revolutions", ylabel="share", ylim=(-0.03, 1.03))
    figure.legend(loc="outside lower center", ncol=3, fontsize=7.5)
    return figure


def sectors() -> Figure:
    """Normal curvature over the direction at three points: where it is positive, a taut fibre presses."""
    angle = np.linspace(-180, 180, 361)
    figure, axes = plt.subplots(figsize=(6.8, 3.3), layout="constrained")
    for (k1, k2), colour, name in (
        ((1.0, 0.4), GREEN, "convex"),
        ((1.0, -0.5), ORANGE, "saddle"),
        ((-0.2, -0.8), SKY, "concave"),
    ):
        turn = np.radians(angle)
        kn = k1 * np.cos(turn) ** 2 + k2 * np.sin(turn) ** 2
        axes.plot(angle, kn, color=colour, label=f"{name}: k1 = {k1:g}, k2 = {k2:g}: {np.mean(kn[:-1] > 0):.0%}")
        axes.fill_between(angle, kn, 0, where=kn > 0, color=colour, alpha=0.2)
    axes.set(
        xlabel="direction from the first principal one [degrees]",
        ylabel="normal curvature",
        xticks=range(-180, 181, 45),
        ylim=(-1.75, 1.1),
    )
    axes.legend(loc="lower center")
    return figure
