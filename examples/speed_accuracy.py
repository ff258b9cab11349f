"""Every method on every problem: speed charted against accuracy, and the source's own figures redone.

    python examples/speed_accuracy.py --out out/speed

needs `pip install 'meshwind[peers]'` for the mesh peers.  Writes PNG charts, their figures as CSV, and everything as
results.json, in under 10 minutes on two cores; --quick takes six problems and under 2 minutes.  One thread, least of
several repeats after a warm-up.
"""

import argparse
from pathlib import Path
from time import perf_counter, process_time

import numba
from charts import comparison, fitting, particles, source_in_space, source_on_surface, source_timing, work_precision
from charts.claims import judge
from charts.golden import rewrite
from charts.record import Results


def main() -> None:
    """Measure, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--out", type=Path, default=Path("out/speed_accuracy"), help="folder for charts and figures")
    parser.add_argument("--quick", action="store_true", help="six problems and fewer settings")
    parser.add_argument("--golden", type=Path, help="only rewrite the golden file of errors and counts, here")
    given = parser.parse_args()
    if given.golden is not None:
        rewrite(given.golden)
        return
    numba.set_num_threads(1)
    begin = perf_counter()
    results = Results(given.out, "speed_accuracy", given.quick)
    print("the source's figures", flush=True)
    source_on_surface.convergence(results)
    source_on_surface.friction(results)
    setting = source_timing.measure(results)
    history = source_in_space.measure(results)
    for row in judge(results, history, setting):
        print(f"  {row['verdict']:12} {row['claim']}: {row['figures']}")
    print(f"mesh to surface, {perf_counter() - begin:.0f} s", flush=True)
    rows = fitting.measure(given.quick)
    results.table("mesh_to_surface", rows)
    fitting.draw(results, rows)
    print(f"work and precision, {perf_counter() - begin:.0f} s", flush=True)
    points = work_precision.survey(given.quick)
    results.table("work_precision", points)
    work_precision.draw(results, points)
    particles.draw(results, points)
    failed = comparison.failures(points)
    results.table("failures", failed)
    comparison.draw_failures(results, failed)
    results.table("capabilities", comparison.capabilities())
    results.table("ratios", comparison.ratios(points))
    lost = [row for cost in ("seconds", "evaluations") for row in comparison.beaten(points, cost)]
    results.table("beaten", lost)
    for row in lost:
        print(
            f"  beaten in {row['cost']}: {row['problem']}, {row['particles']} particles, by {row['by']}"
            f" ({row['its_setting']}), {row['factor']:.2g} times, errors {row['our_error']:.1e} and"
            f" {row['its_error']:.1e}"
        )
    results.table("run", [dict(seconds=perf_counter() - begin, processor_seconds=process_time())])
    results.write()
    print(
        f"{len(points)} settings, {perf_counter() - begin:.0f} s ("
        f"{process_time():.0f} s of a core); charts in {given.out}"
    )


if __name__ == "__main__":
    main()
