"""Drag a fibre by its ends over a valley with a peak, as in the source's Fig. 7.1, and draw it: moving_ends.png.

    python examples/moving_ends.py --out DIR

On the surface both peaks catch the fibre.  Where the fibre may leave the surface, as a fibre in tension does, it
bridges the small peak and wraps around the large one.
"""

import argparse
from pathlib import Path

import numpy as np

from meshwind import Surface, drag
from meshwind.surface.interpolate import interpolate

FRAMES = 23
"""Positions of the ends."""
SHOWN = (0, 9, 22)
PEAKS = {"small peak, 1.2 high": 1.2, "large peak, 3.5 high": 3.5}


def valley(peak: float) -> Surface:
    """A valley with sides 2 high and a peak in its middle."""

    def formula(u: np.ndarray, v: np.ndarray) -> np.ndarray:
        x, y = 4 * (u - 0.5), 6 * (v - 0.5)
        return np.stack([x, y, 0.5 * x**2 + peak * np.exp(-(x**2 + y**2) / 0.25)], axis=-1)

    return interpolate(formula, (96, 96), periodic=False)


def main() -> None:
    """Drag, print where the fibre's middle is in each frame, and draw."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/moving_ends"), help="folder for moving_ends.png")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    v = np.linspace(0.25, 0.8, FRAMES)
    start, end = np.stack([0 * v, v], axis=1), np.stack([0 * v + 1, v], axis=1)
    grid = np.stack(np.meshgrid(np.linspace(0, 1, 61), np.linspace(0, 1, 61), indexing="ij"), axis=-1)
    figure = plt.figure(figsize=(12, 12), layout="constrained")
    row = 0
    print(f"{'':24}{'model':18}{'y of the middle as the ends go from -1.5 to 1.8'}")
    for name, peak in PEAKS.items():
        surface = valley(peak)
        x, y, z = np.moveaxis(surface.points(grid.reshape(-1, 2)).reshape(*grid.shape[:2], 3), -1, 0)
        for bridging in (False, True):
            paths = drag(surface, start, end, bridging=bridging)
            middle = paths.points[np.arange(FRAMES), np.abs(paths.points[:, :, 0]).argmin(axis=1), 1]
            model = "off the surface" if bridging else "on the surface"
            print(f"{name:24}{model:18}" + " ".join(f"{value:5.2f}" for value in middle[::3]))
            for column, frame in enumerate(SHOWN):
                axes = figure.add_subplot(4, 3, 3 * row + column + 1, projection="3d", computed_zorder=False)
                axes.plot_surface(x, y, z, color="0.85", linewidth=0, antialiased=True, zorder=0)
                axes.plot(*paths.points[frame].T, color="#0072B2", linewidth=2.0, zorder=2)
                if not paths.on_surface[frame].all():
                    feet = surface.points(paths.uv[frame])
                    axes.plot(*feet.T, color="#009E73", linewidth=1.0, zorder=1)
                axes.set_title(f"{name}, {model}: frame {frame}", fontsize=8)
                axes.view_init(elev=38, azim=-62)
                axes.set_box_aspect(np.ptp([x.ravel(), y.ravel(), z.ravel()], axis=1))
                axes.set_axis_off()
            row += 1
    figure.suptitle("A fibre dragged along a valley (blue), and its feet on the surface where it bridges (green)")
    figure.savefig(out / "moving_ends.png", dpi=110)
    print(f"wrote {out / 'moving_ends.png'}")


if __name__ == "__main__":
    main()
