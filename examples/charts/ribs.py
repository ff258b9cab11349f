"""A fibre along a cylinder with a narrow rib: over the rib's width and the number of particles, with the exact path."""

from dataclasses import dataclass
from functools import cache

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, Attempt, attempt
from comparison.problem import Problem
from scipy.spatial import ConvexHull

from charts.maps import Row, classify, filled, key, paint, settled, sweep
from charts.record import Results
from charts.style import note, save
from meshwind.core.cast import Floats
from meshwind.path import Paths, solve
from meshwind.surface import Surface, shapes

RADIUS, LENGTH, PLACE, HEIGHT = 50.0, 300.0, 77.1, 3.0
"""Of the cylinder, and where along it the rib is and how high, in mm."""
COUNTS = (26, 51, 101, 201, 401, 801)
"""Numbers of particles; ours also chooses its own."""
PER_WIDTH = 8.0
"""Spans of the surface within the rib's width."""
MOST_SPANS, FEWEST_SPANS = 2048, 256
SAMPLES = 400_001
"""Points of the profile from which its hull is taken."""
BETWEEN = 8
"""Points of each segment at which its place is compared."""
ROUND_OFF = 1e-7, 1e-5
"""Added to the stated errors of length and of position, over the length: what the profile's own points leave."""
SHARE = 0.1
"""Of what the rib adds to the length: what a length without a stated error may be off, and a small stated error."""
U = 0.1
"""Where the fibre is around the cylinder, in turns."""
BACKWARD = "backward-euler"


@dataclass(frozen=True)
class Ribbed:
    """The surface of a cylinder with a rib `width` wide at half its height, and its taut meridian: the upper hull."""

    surface: Surface
    z: Floats
    """Corners (n,) of the hull."""
    r: Floats

    @property
    def length(self) -> float:
        """Of the taut meridian."""
        return float(np.hypot(np.diff(self.z), np.diff(self.r)).sum())

    def off(self, points: Floats) -> float:
        """Largest distance of a polyline (n, 3) from the taut meridian, which is all but level."""
        x, y, z = filled(points, BETWEEN).T
        return float(np.abs(np.hypot(x, y) - np.interp(z, self.z, self.r)).max())


@cache
def ribbed(width: float) -> Ribbed:
    """Make the surface, with spans enough for its rib, and take the hull of its own profile."""
    narrow = width / np.sqrt(4.0 * np.log(2.0))

    def radius(z: Floats) -> Floats:
        return np.asarray(RADIUS + HEIGHT * np.exp(-(((z - PLACE) / narrow) ** 2)))

    spans = int(np.clip(PER_WIDTH * LENGTH / width, FEWEST_SPANS, MOST_SPANS))
    surface = shapes.revolution(radius, 0.0, LENGTH, (16, spans))
    v = np.linspace(0.0, 1.0, SAMPLES)
    points = surface.points(np.stack([np.full_like(v, U), v], axis=1))
    z, r = points[:, 2], np.hypot(points[:, 0], points[:, 1])
    below = [[z[0], -LENGTH], [z[-1], -LENGTH]]
    corners = np.sort(ConvexHull(np.concatenate([np.stack([z, r], axis=1), below])).vertices)
    corners = corners[corners < SAMPLES]
    return Ribbed(surface, z[corners], r[corners])


def lay(width: float, particles: int | None) -> Paths:
    """Our path along a ribbed cylinder, with a number of particles or with those that it chooses."""
    return solve(ribbed(width).surface, [(U, 0.0)], [(U, 1.0)], particles=particles)


def ours(width: float, particles: int | None) -> Row:
    """Our path: right where length and place are the hull's within the errors that are stated."""
    truth, paths = ribbed(width), lay(width, particles)
    error, off = abs(float(paths.length[0]) - truth.length), truth.off(paths.points[0])
    stated, place = float(paths.length_error[0]), float(paths.position_error[0])
    right = error <= stated + ROUND_OFF[0] * LENGTH and off <= place + ROUND_OFF[1] * LENGTH
    result = settled(paths.status[0], right)
    if result == "ok" and stated > SHARE * (truth.length - LENGTH):
        result = "vague"
    return dict(method=OURS, width=width, particles=paths.points.shape[1], asked=particles,
                result=result, error=error, stated_error=stated, off=off, stated_position_error=place)  # fmt: skip


def theirs(width: float, particles: int) -> Row:
    """Backward Euler's path, which states no error: right where its length has all but a tenth of the rib."""
    truth = ribbed(width)
    problem = Problem("rib", "", lambda: truth.surface, (U, 0.0), (U, 1.0), truth.length, bridges=True)
    found: Attempt = attempt(BACKWARD, problem, particles, dict(step_size=1e4, steps=500, tolerance=1e-6))
    error = abs(found.length - truth.length)
    result = classify(found, error, SHARE * (truth.length - LENGTH))
    return dict(method=BACKWARD, width=width, particles=particles, asked=particles, result=result, error=error)


def draw(results: Results, quick: bool) -> None:
    """A map of ours and one of backward Euler, over width and particles."""
    widths = np.geomspace(0.25, 16.0, 7 if quick else 13).tolist()
    counts = COUNTS[::2] if quick else COUNTS
    figure, grid = plt.subplots(1, 2, figsize=(13.5, 5.2), sharey=True)
    rows: list[Row] = []
    # the number that ours chooses is drawn as a last column, with a name in place of a number
    places = [float(k) for k in range(len(counts) + 1)]
    for name, axes in zip((OURS, BACKWARD), grid, strict=True):
        if name == OURS:
            classes, found = sweep(widths, [*counts, None], ours)
        else:
            classes, found = sweep(widths, counts, theirs)
        paint(axes, places[: len(classes[0])], widths, classes, log_y=True)
        axes.plot(places[: len(counts)], [LENGTH / (n - 1) for n in counts], "k--", lw=1.4)
        names = [*(str(n) for n in counts), "chosen"]
        axes.set_xticks(places[: len(classes[0])], names[: len(classes[0])])
        axes.set_ylim(widths[0] / 1.2, widths[-1] * 1.2)
        axes.set_xlabel("particles of the fibre")
        key(axes, classes)
        rows += found
    mine = [row for row in rows if row["method"] == OURS and row["result"] == "ok"]
    added = max(ribbed(w).length for w in widths) - LENGTH
    grid[0].set_title(
        f"meshwind; right: length and place within the errors that it states,\nof the length at most"
        f" {max(row['stated_error'] for row in mine) / added:.0%} of what the rib adds"
    )
    grid[1].set_title(
        f"backward Euler with lifting, h = 1e4 sqrt(m/K), which states no error;\nright: length within {SHARE:.0%} of"
        " what the rib adds"
    )
    grid[0].set_ylabel("width of the rib at half its height [mm]")
    note(grid[0], 0.3, 0.94, "dashed: the particles' distance; below it the rib is narrower",
         transform=grid[0].transAxes)  # fmt: skip
    figure.suptitle(
        f"Fibre along a cylinder of radius {RADIUS:g} and length {LENGTH:g} mm over a Gaussian rib {HEIGHT:g} mm high;"
        f" the exact path is the hull of the profile, {added:.3f} mm longer than the cylinder"
    )
    figure.tight_layout()
    save(figure, results.folder, "rough_ribs")
    results.table("rough_ribs", rows)
