"""Where each method breaks: maps of success and failure, with the theory's limit drawn in where there is one.

    python examples/stability.py --out out/stability

Writes PNG maps, their cells as CSV, and everything as results.json, in under 10 minutes on two cores; --quick draws
coarser maps in under 2.
"""

import argparse
from pathlib import Path
from time import perf_counter, process_time

import numba
from charts import implicit_maps, inputs, limits, windings
from charts.record import Results


def main() -> None:
    """Measure, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])  # type: ignore[union-attr]
    parser.add_argument("--out", type=Path, default=Path("out/stability"), help="folder for charts and figures")
    parser.add_argument("--quick", action="store_true", help="coarser maps")
    given = parser.parse_args()
    numba.set_num_threads(1)
    begin = perf_counter()
    results = Results(given.out, "stability", given.quick)
    for chart in (limits, implicit_maps, windings, inputs):
        chart.draw(results, given.quick)
        print(f"{chart.__name__}: {perf_counter() - begin:.0f} s", flush=True)
    silent = results.cells(
        "wrong",
        ("ours_waist", "ours_conjugate", "ours_friction", "ours_noise", "ours_units", "ours_stretch", "time_step"),
        "meshwind",
    )
    results.table("silent_wrong_answers", silent)
    for row in silent:
        print("  wrong and unnoticed:", row)
    results.table("run", [dict(seconds=perf_counter() - begin, processor_seconds=process_time())])
    results.write()
    print(
        f"{len(silent)} silent wrong answers by meshwind, {perf_counter() - begin:.0f} s ("
        f"{process_time():.0f} s of a core); charts in {given.out}"
    )


if __name__ == "__main__":
    main()
