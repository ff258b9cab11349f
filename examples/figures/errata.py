"""A figure on the errata: Newton's method for foot points as printed and as corrected."""

import matplotlib.pyplot as plt
import numpy as np
from charts.style import ORANGE, RED
from comparison.problems import barrel
from matplotlib.figure import Figure

from meshwind.core.cast import Floats


def foot_points() -> Figure:
    """Distance from the foot, step by step, by the printed factors of (5.7) and by those of one function."""
    surface, point = barrel(), np.array([1.4, 0.3, 1.2])

    def iterate(factor: float, steps: int) -> Floats:
        uv, track = np.array([[0.03, 0.5]]), []
        for _ in range(steps):
            (s, su, sv, suu, suv, svv), d = surface.frames(uv)[0], surface.points(uv)[0] - point
            gradient = np.array([su @ d, sv @ d])
            hessian = np.array([[suu @ d + su @ su, suv @ d + su @ sv], [suv @ d + su @ sv, svv @ d + sv @ sv]])
            track.append(s)
            uv = uv - factor * np.linalg.solve(hessian, gradient)
        return np.array(track)

    right, printed = iterate(1.0, 12), iterate(2.0, 12)
    figure, axes = plt.subplots(figsize=(6.4, 3.2), layout="constrained")
    for track, colour, name in ((printed, ORANGE, "as printed: twice the gradient"), (right, RED, "corrected")):
        off = np.maximum(np.linalg.norm(track - right[-1], axis=1), 1e-17)
        axes.plot(off, "o-", color=colour, label=name)
        print(f"  foot_points: {name}: {[f'{each:.1e}' for each in off[:6]]}")
    axes.set(yscale="log", xlabel="step", ylabel="distance from the foot", title="Newton's method for a foot point")
    axes.legend(loc="best")
    return figure
