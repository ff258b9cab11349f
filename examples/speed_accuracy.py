"""Charts of speed against accuracy for every method on every problem, and the source's figures redone.

    python examples/speed_accuracy.py --out out/speed

The methods on meshes need `pip install 'meshwind[peers]'`.  Writes PNG charts, their figures as CSV, and everything as
results.json, in under 10 minutes on two cores; --quick takes six problems and under 2 minutes.  Times are those of one
thread, the least of several repeats after a warm-up.
"""

import argparse
from pathlib import Path

import numba
from charts import (
    convergence,
    fitting,
    fitting_rough,
    source_in_space,
    source_on_surface,
    source_timing,
    summary,
    work_precision,
)
from charts.record import Results
from charts.source_claims import judge
from comparison.golden import rewrite


def main() -> None:
    """Measure, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/speed_accuracy"), help="folder for charts and figures")
    parser.add_argument("--quick", action="store_true", help="six problems and fewer settings")
    parser.add_argument("--golden", type=Path, help="only rewrite the golden file of errors and counts, here")
    given = parser.parse_args()
    if given.golden is not None:
        rewrite(given.golden)
        return
    numba.set_num_threads(1)
    results = Results(given.out, "speed_accuracy", given.quick)
    results.progress("the source's figures")
    source_on_surface.convergence(results)
    source_on_surface.friction(results)
    setting = source_timing.measure(results)
    history = source_in_space.measure(results)
    for row in judge(results, history, setting):
        print(f"  {row['verdict']:12} {row['claim']}: {row['figures']}")
    results.progress("mesh to surface")
    rows = fitting.measure(given.quick)
    results.table("mesh_to_surface", rows)
    fitting.draw(results, rows)
    rows = fitting_rough.measure(given.quick)
    results.table("rough_mesh_to_surface", rows)
    fitting_rough.draw(results, rows)
    results.progress("work and precision")
    points = work_precision.survey(given.quick)
    results.table("work_precision", points)
    work_precision.draw(results, points)
    convergence.draw(results, points)
    failed = summary.failures(points)
    results.table("failures", failed)
    summary.draw_failures(results, failed)
    results.table("capabilities", summary.capabilities())
    ratios = summary.ratios(points)
    results.table("ratios", ratios)
    results.table("ratios_at_equal_error", summary.summary(ratios))
    results.table("velocity_scaling", summary.scaled(points))
    lost = [row for cost in ("seconds", "evaluations") for row in summary.beaten(points, cost)]
    results.table("beaten", lost)
    for row in lost:
        print(
            f"  not the best in {row['cost']}: {row['problem']}, {row['particles']} particles, by {row['by']}"
            f" ({row['its_setting']}), {row['factor']:.2g} times, errors {row['our_error']:.1e} and"
            f" {row['its_error']:.1e}"
        )
    results.finish(f"{len(points)} settings")


if __name__ == "__main__":
    main()
