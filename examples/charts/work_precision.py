"""Work-precision diagrams: the error of a path's length against time and against surface evaluations."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from functools import partial
from importlib.util import find_spec
from typing import Any

import matplotlib.pyplot as plt
from comparison.attempt import OURS, Attempt, attempt
from comparison.peers_smooth import collocate, shoot, shoot_traced
from comparison.problem import Kind, Problem
from comparison.problems import TABLE
from matplotlib.axes import Axes

from charts.maps import classify
from charts.record import Results
from charts.settings import KEPT, QUICK_SIZES, RULED, SIZES, settings
from charts.style import LOOKS, log_axes, save
from charts.timing import least, timed

CHAINS = (
    OURS,
    "backward-euler",
    "backward-euler-reuse",
    RULED,
    "explicit-euler",
    "symplectic-euler",
    "rk4",
    "kkt",
    "penalty",
)
SMOOTH: dict[str, tuple[Callable[[Problem, float], Attempt], tuple[float, ...]]] = {
    "shooting-dop853": (shoot, (1e-3, 1e-5, 1e-7, 1e-8)),
    "shooting-trace": (shoot_traced, (1e-2, 1e-3, 1e-5, 1e-7)),
    "collocation": (collocate, (1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7)),
}
"""SciPy's solvers with their tolerances."""
VERTICES = (250, 1000, 4000, 16_000)
"""Of the meshes for FlipOut and the exact polyhedral methods."""
LARGEST_EXACT = 4000
"""Vertices beyond which the exact polyhedral methods take seconds per path."""
LARGEST_QUICK = 4000
"""Vertices beyond which no mesh is made with --quick."""
LARGEST_RULED = 801
"""Particles with which the rule of the fourth order is right to round-off."""
LARGEST_DRAGGED = 201
"""Particles of a fibre that is solved for in every frame."""
FAR = 0.3
"""A path whose length is off by more is another path: a wrong answer."""
SHORT = 0.05
"""Seconds below which a run is timed twice."""
LONG = 1.0
"""Seconds of a run after which no finer tolerance is tried."""
GOOD = 1.5
"""Error over the best at a size up to which settings are chosen by their time."""
QUICK = ("barrel-1.5", "barrel-4", "vase", "catenary-0.3", "dragged", "bottle-turn")
"""Problems of --quick."""


class Reason(StrEnum):
    """Why a method cannot solve a problem, or is not tried on it."""

    NO_FRICTION = "no friction"
    NO_GAIN = "the step's error outweighs the rule's"
    NO_BRIDGES = "stays on the surface"
    SHORTEST = "finds the shortest path, not one of several turns"


@dataclass(frozen=True)
class Point:
    """One setting of one method on one problem; seconds and error are those of a run that came to rest."""

    problem: str
    kind: str
    method: str
    size: int
    setting: str
    result: str
    seconds: float
    error: float
    evaluations: int
    feet: int
    solves: int
    iterations: int
    setup_seconds: float = 0.0
    best: bool = False


def measure(problem: Problem, method: str, size: int, setting: str, call: Callable[[], Attempt]) -> Point:
    """Run once; time again only what converged."""
    seconds, found = timed(call)
    error = problem.error(found.length)
    result = classify(found, error, FAR)
    if result == "ok" and seconds < SHORT:
        seconds = min(seconds, timed(call)[0])
    return Point(
        problem.name,
        problem.kind,
        method,
        size,
        setting,
        result,
        seconds,
        error,
        found.evaluations,
        found.feet,
        found.solves,
        found.iterations,
    )


def cannot(problem: Problem, method: str) -> Reason | None:
    """Why a method cannot solve a problem, None where it can."""
    turns = abs(problem.end[0] - problem.start[0])
    if method == RULED and problem.friction:
        return Reason.NO_GAIN
    if problem.friction and (method in ("kkt", "penalty") or method not in CHAINS):
        return Reason.NO_FRICTION
    if method not in CHAINS:
        if problem.bridges:
            return Reason.NO_BRIDGES
        if method.startswith("mmp") and turns >= 0.5:
            return Reason.SHORTEST
    return None


def over_sizes(problem: Problem, method: str, sizes: Sequence[int]) -> list[Point]:
    """All settings of a scheme, size by size; the first size at which none converges is the last."""
    points: list[Point] = []
    kept: list[str] | None = None
    for n in sizes:
        if n > (LARGEST_RULED if method == RULED else LARGEST_DRAGGED if problem.dragged_from else n):
            break
        tried = []
        for setting in settings(method, problem, n):
            if kept is not None and setting.key not in kept:
                continue
            call = partial(attempt, setting.scheme, problem, n, setting.parameters)
            if kept is None:
                call()  # compile
            tried.append((measure(problem, method, n, setting.key, call), call))
        done = [(p, call) for p, call in tried if p.result == "ok"]
        for p, call in tried:
            best = any(p is q for q in front([q for q, _ in done], "seconds"))
            points.append(replace(p, seconds=least(call, p.seconds), best=True) if best else p)
        if not done:
            break
        good = min(p.error for p, _ in done)
        order = sorted(done, key=lambda item: (item[0].error > GOOD * good, item[0].seconds))
        kept = [p.setting for p, _ in order[:KEPT]]
    return points


def front(points: Sequence[Point], cost: str) -> list[Point]:
    """The points to which no other is better in both cost and error, by cost."""
    best: list[Point] = []
    for p in sorted(points, key=lambda p: (getattr(p, cost), p.error)):
        if not best or p.error < best[-1].error:
            best.append(p)
    return best


def peers(problem: Problem, quick: bool) -> list[Point]:
    """The solvers of other libraries on this problem."""
    points = []
    for method, (solver, tolerances) in SMOOTH.items():
        if cannot(problem, method) is None:
            for tolerance in tolerances[:-1] if quick else tolerances:
                call = partial(solver, problem, tolerance)
                call()
                p = measure(problem, method, 0, f"tolerance {tolerance:g}", call)
                points.append(replace(p, seconds=least(call, p.seconds)) if p.result == "ok" else p)
                if p.seconds > LONG:
                    break
    if find_spec("potpourri3d") is None or find_spec("pygeodesic") is None:
        print("the methods on meshes are left out: pip install 'meshwind[peers]'")
        return points
    return points + mesh_peers(problem, quick)


def mesh_peers(problem: Problem, quick: bool) -> list[Point]:
    """The methods on triangle meshes, where the extra `peers` is installed."""
    from comparison.peers_mesh import PEERS, facets

    points = []
    for method, solver_on_mesh in PEERS.items():
        if cannot(problem, method) is not None:
            continue
        for count in VERTICES:
            if count > (LARGEST_EXACT if method != "flipout" else VERTICES[-1]) or (quick and count > LARGEST_QUICK):
                continue
            mesh = facets(problem, count)
            # set-up: what a second path on the same mesh does not need again
            setup = timed(lambda m=mesh, f=method: m.flipper if f == "flipout" else m.exact)[0]  # type: ignore[misc]
            on_mesh = partial(solver_on_mesh, mesh, problem)
            on_mesh()
            p = measure(problem, method, len(mesh.vertices), f"{len(mesh.vertices)} vertices", on_mesh)
            points.append(replace(p, seconds=least(on_mesh, p.seconds), setup_seconds=setup) if p.result == "ok" else p)
    return points


def survey(quick: bool) -> list[Point]:
    """Every method on every problem."""
    points: list[Point] = []
    for problem in TABLE.values():
        if quick and problem.name not in QUICK:
            continue
        begin = len(points)
        for method in CHAINS:
            if cannot(problem, method) is None:
                points += over_sizes(problem, method, QUICK_SIZES if quick else SIZES)
        points += peers(problem, quick)
        print(f"  {problem.name}: {len(points) - begin} settings", flush=True)
    return points


def panel(axes: Axes, problem: Problem, points: Sequence[Point], cost: str) -> None:
    """One problem: a faint dot for every setting that converged, and a line through each method's best."""
    for method, look in LOOKS.items():
        mine = [p for p in points if p.method == method and p.result == "ok" and (cost == "seconds" or p.evaluations)]
        scale = 1e3 if cost == "seconds" else 1
        axes.scatter(
            [scale * getattr(p, cost) for p in mine],
            [p.error for p in mine],
            s=5,
            color=look.colour,
            alpha=0.3,
            linewidths=0,
        )
        best = front(mine, cost)
        axes.plot(
            [scale * getattr(p, cost) for p in best],
            [p.error for p in best],
            look.line,
            color=look.colour,
            marker=look.marker,
            ms=6 if method != OURS else 7,
            lw=2.2 if method == OURS else 1.2,
            zorder=5 if method == OURS else 3,
            label=look.label,
        )
    log_axes(axes, "time per path [ms]" if cost == "seconds" else "surface evaluations", "relative error of the length")
    axes.set_title(
        f"{problem.name}: {problem.difficulty}\nlength {problem.length:.9g}"
        + (f", friction {problem.friction:g}" if problem.friction else "")
    )
    low, high = axes.get_ylim()
    axes.set_ylim(low, min(max(high, 1e-2), 1.0))


HEADLINE = ("barrel-1.5", "bottle-turn", "bottle-neck", "catenary-0.3")
"""What is shown first: convex, freeform, bridging, friction."""


def draw(results: Results, points: Sequence[Point]) -> None:
    """A figure for each kind and cost, and one of the headline's problems."""
    done = [problem for problem in TABLE.values() if any(q.problem == problem.name for q in points)]
    chosen = [problem for problem in done if problem.name in HEADLINE]
    _figure(results, points, chosen, Panels("seconds", "", "speed_and_accuracy", columns=2))
    for kind in Kind:
        problems = [p for p in done if p.kind == kind]
        for cost, word in (("seconds", "time"), ("evaluations", "evaluations")):
            if problems:
                columns = min(4, len(problems)) if len(problems) != 5 else 3
                name = f"work_precision_{kind.name.lower()}_{word}"
                _figure(results, points, problems, Panels(cost, f", {kind}", name, columns))


@dataclass(frozen=True)
class Panels:
    """What a figure shows: cost, kind of problems for its title, name of its file, and panels side by side."""

    cost: str
    kind: str
    name: str
    columns: int


def _figure(results: Results, points: Sequence[Point], problems: Sequence[Problem], of: Panels) -> None:
    """A panel per problem, and one legend."""
    columns, cost = of.columns, of.cost
    rows = -(-len(problems) // columns)
    wide = max(5.0 * columns, 10.0)
    figure, grid = plt.subplots(rows, columns, figsize=(wide, 4.2 * rows + 0.8), squeeze=False)
    for axes in grid.flat[len(problems) :]:
        axes.set_visible(False)
    for axes, problem in zip(grid.flat, problems, strict=False):
        panel(axes, problem, [p for p in points if p.problem == problem.name], cost)
    handles: dict[str, Any] = {}
    for axes in grid.flat[: len(problems)]:
        handles |= {label: h for h, label in zip(*axes.get_legend_handles_labels(), strict=True) if len(h.get_xdata())}
    word = "time" if cost == "seconds" else "evaluations"
    figure.suptitle(
        f"Taut paths{of.kind}: error against {word}. Down and left is better.\nEach dot is a setting that converged,"
        " the line joins a method's best.",
        fontsize=11,
    )
    across = max(2, min(5, int(wide / 3.0)))
    lines = -(-len(handles) // across)
    figure.tight_layout(rect=(0, (0.25 * lines + 0.2) / (4.2 * rows + 0.8), 1, 0.99))
    figure.legend(handles.values(), handles.keys(), loc="lower center", ncol=across)
    save(figure, results.folder, of.name)
