"""Where a fibre with friction comes to rest on rough ground: the same for any number of particles, or refused."""

from dataclasses import dataclass
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from comparison.attempt import OURS, attempt
from comparison.problem import TURN, Problem
from matplotlib.axes import Axes
from scipy.spatial import cKDTree

import meshwind as mw
from charts.maps import Row, classify, filled, key, paint, settled, sweep
from charts.record import Results
from charts.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, RED, SKY, save
from meshwind.core.cast import Floats
from meshwind.path import Paths, Status
from meshwind.surface import Surface, shapes

COUNTS = (51, 101, 201, 401, 801)
"""Numbers of particles; ours also chooses its own."""
BOTTLE = Path(__file__).parents[2] / "data" / "bottle.obj"
TURNS, PER_FAMILY, CHOSEN = 0.55, 3, 4
"""Revolutions and paths of a winding of the bottle, and the path of it that has two states of rest."""
RADIUS, LENGTH, BULGE = 50.0, 200.0, 10.0
"""Of the barrel with bumps, in mm: of its rims, from rim to rim, and how much wider its middle is."""
AROUND, ALONG = 8, 5
"""Bumps of the lattice each way."""
BUMPY_ENDS = (0.03, 0.0), (0.43, 1.0)
"""Its fibre's ends (u, v)."""
DENSE = 8
"""Points of each segment of the reference, to which distances are taken."""
SAME = 1e-3
"""Distance from the reference, over its length, up to which a path is the same and not in another state of rest."""
ROUND_OFF = 1e-7
"""Relative, added to the stated errors of lengths."""
SCALED = dict(step_size=0.5, damping=0.05, steps=4000)
"""Settings of velocity scaling (4.19)."""
ROUGH = 1e-3
"""Relative error of the length up to which velocity scaling, which states no error, is right."""
COLOURS = (BLUE, RED, GREEN, ORANGE, PURPLE, SKY, BLACK, GREY)


@dataclass(frozen=True)
class Course:
    """A surface, a fibre's ends, and how it lies with very many particles: what fewer are compared with."""

    surface: Surface
    start: Floats
    end: Floats
    friction: float
    particles: int

    def lay(self, particles: int | None) -> Paths:
        """The fibre with a number of particles or with those that are chosen."""
        return mw.solve(self.surface, [self.start], [self.end], particles=particles, friction=self.friction)


@dataclass(frozen=True)
class Reference:
    """The same fibre with very many particles."""

    course: Course
    paths: Paths
    tree: cKDTree

    @classmethod
    def of(cls, course: Course) -> "Reference":
        """Solve it."""
        paths = course.lay(course.particles)
        points = paths.points[0]
        return cls(course, paths, cKDTree(np.concatenate([filled(points, DENSE), points[-1:]])))

    def compare(self, particles: int | None) -> Row:
        """A row of ours: right where it lies as the reference does, and both lengths agree as they state."""
        found = self.course.lay(particles)
        mine, best = float(found.length[0]), float(self.paths.length[0])
        stated = float(found.length_error[0] + self.paths.length_error[0])
        off = float(self.tree.query(found.points[0])[0].max())
        result = settled(found.status[0], True)
        resting = self.paths.status[0] == Status.CONVERGED
        if result == "ok" and (not resting or off > SAME * best):
            rests = found.other_rests
            result = "warned" if rests.found[0] or (resting and off <= rests.moved[0]) else "wrong"
        elif result == "ok" and abs(mine - best) > stated + ROUND_OFF * best:
            result = "understated"
        return dict(method=OURS, friction=self.course.friction, asked=particles, particles=found.points.shape[1],
                    result=result, status=Status(int(found.status[0])).name, length=mine, reference=best,
                    difference=mine - best, stated_error=stated, off=off)  # fmt: skip

    def scale(self, particles: int) -> Row:
        """A row of velocity scaling by (4.19), which states no error."""
        course, best = self.course, float(self.paths.length[0])
        problem = Problem("rest", "", lambda: course.surface, tuple(course.start), tuple(course.end), best, True,
                          friction=course.friction)  # fmt: skip
        found = attempt("backward-euler", problem, particles, SCALED)
        rests = self.paths.status[0] == Status.CONVERGED
        error = abs(found.length / best - 1.0) if rests else np.inf
        off = float("nan") if found.points is None else float(self.tree.query(found.points)[0].max())
        return dict(method="backward-euler", friction=course.friction, asked=particles, particles=particles,
                    result=classify(found, error, ROUGH), length=found.length, reference=best,
                    difference=found.length - best, off=off)  # fmt: skip


def distances(axes: Axes, rows: list[Row], names: list[str], by: str, word: str) -> None:
    """A line for each value of `by`: the distance from the reference over the number of particles."""
    for value, colour in zip(dict.fromkeys(row[by] for row in rows), COLOURS, strict=False):
        mine = [row for row in rows if row[by] == value]
        axes.plot(range(len(mine)), [max(row["off"], 1e-7) for row in mine], "o-", ms=4.5, color=colour,
                  label=f"{word} {value:.2g}")  # fmt: skip
    axes.set_xticks(range(len(names)), names)
    axes.set_yscale("log")
    axes.set(xlabel="particles of the fibre", ylabel="largest distance from the reference [mm]")
    axes.legend(ncol=3, loc="upper center", bbox_to_anchor=(0.5, -0.14))


def two_states(results: Results, quick: bool) -> None:
    """A path over the neck of a bottle that has two states of rest: over friction and particles."""
    coefficients = [0.05, 0.15, 0.25, 0.4] if quick else [0.05, 0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4]
    counts = COUNTS[1::2] if quick else COUNTS
    most = 1601 if quick else 6401
    surface = mw.fit(mw.flatten(mw.annulus(mw.read(BOTTLE))), tolerance=1e-5)
    ends = mw.families(surface, PER_FAMILY, TURNS)
    start, end = ends.start[CHOSEN], ends.end[CHOSEN]
    references = {mu: Reference.of(Course(surface, start, end, mu, most)) for mu in coefficients}
    figure, grid = plt.subplots(1, 3, figsize=(17, 5.2), gridspec_kw={"width_ratios": (6, 6, 6)})
    names = [*(str(n) for n in counts), "chosen"]
    classes, mine = sweep(coefficients, [*counts, None], lambda mu, n: references[mu].compare(n))
    paint(grid[0], list(range(len(names))), coefficients, classes)
    theirs, scaled = sweep(coefficients, counts, lambda mu, n: references[mu].scale(n))
    paint(grid[1], list(range(len(counts))), coefficients, theirs)
    for axes, cells in zip(grid, (classes, theirs), strict=False):
        axes.set_xticks(range(len(cells[0])), names[: len(cells[0])])
        axes.set(xlabel="particles of the fibre", ylabel="coefficient of friction")
        key(axes, cells)
    grid[0].set_title("meshwind; right: where the reference lies, and of its length\nwithin the errors that both state")
    grid[1].set_title(
        f"backward Euler with velocity scaling (4.19), h = 0.5 sqrt(m/K);\nright: length within {ROUGH:g} of the"
        " reference's"
    )
    resting = [row for row in mine if references[row["friction"]].paths.status[0] == Status.CONVERGED]
    distances(grid[2], resting, names, "friction", "friction")
    grid[2].set_title("meshwind: how the path depends on the particles,\nwhere the reference is at rest")
    figure.suptitle(
        f"A fibre over the neck of data/bottle.obj, {TURNS} revolutions, where friction leaves more than one state of"
        f" rest; reference: meshwind with {most} particles"
    )
    figure.tight_layout()
    save(figure, results.folder, "rough_rest_states")
    results.table("rough_rest_states", mine + scaled)


def bumpy(height: float) -> Surface:
    """A barrel with a lattice of round bumps and hollows of a height, in mm."""

    def formula(u: Floats, v: Floats) -> Floats:
        lattice = np.cos(TURN * AROUND * u) * np.cos(TURN * ALONG * (v - 0.5)) * np.sin(np.pi * v) ** 2
        r = RADIUS + BULGE * (1.0 - (2.0 * v - 1.0) ** 2) + height * lattice
        return np.stack([r * np.cos(TURN * u), r * np.sin(TURN * u), LENGTH * v], -1)

    return shapes.parametric(formula, (128, 96))


def bumps(results: Results, quick: bool) -> None:
    """A fibre over a barrel with bumps: over their height and friction."""
    heights = np.linspace(0.0, 8.0, 5 if quick else 9).tolist()
    coefficients = np.linspace(0.0, 0.6, 4 if quick else 13).tolist()
    most = 801 if quick else 1601
    counts = (101,) if quick else (101, 401)
    figure, grid = plt.subplots(1, len(counts), figsize=(6.8 * len(counts), 5.2), squeeze=False, sharey=True)
    rows: list[Row] = []
    surfaces = {height: bumpy(height) for height in heights}
    start, end = np.array(BUMPY_ENDS)
    references = {
        (height, mu): Reference.of(Course(surfaces[height], start, end, mu, most))
        for height in heights
        for mu in coefficients
    }
    for particles, axes in zip(counts, grid[0], strict=True):

        def cell(height: float, mu: float, particles: int = particles) -> Row:
            return dict(height=height) | references[height, mu].compare(particles)

        classes, found = sweep(heights, coefficients, cell)
        rows += found
        paint(axes, coefficients, heights, classes)
        right = [row["off"] for row in found if row["result"] == "ok"]
        axes.set(
            xlabel="coefficient of friction",
            title=(
                f"meshwind, {particles} particles; where right, at most {max(right, default=0.0):.2g} mm from the"
                " reference"
            ),
        )
        key(axes, classes)
    grid[0, 0].set_ylabel("height of the bumps [mm]")
    figure.suptitle(
        f"Fibre of {end[0] - start[0]:g} revolutions over a barrel of radius {RADIUS:g} to {RADIUS + BULGE:g}, length"
        f" {LENGTH:g} mm with {AROUND} x {ALONG} bumps; right: where the fibre with {most}\nparticles lies, and of its"
        " length within the errors that both state"
    )
    figure.tight_layout()
    save(figure, results.folder, "rough_bumps")
    results.table("rough_bumps", rows)


def draw(results: Results, quick: bool) -> None:
    """Both maps."""
    two_states(results, quick)
    bumps(results, quick)
