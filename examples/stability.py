"""Where each method fails: maps of success and failure, with the theory's limit where there is one.

    python examples/stability.py --out out/stability

Writes PNG maps, their cells as CSV, and everything as results.json, in under 10 minutes on two cores; --quick draws
coarser maps in under 2.
"""

import argparse
from pathlib import Path

import numba
from charts import implicit_maps, inputs, limits, windings
from charts.record import Results


def main() -> None:
    """Measure, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/stability"), help="folder for charts and figures")
    parser.add_argument("--quick", action="store_true", help="coarser maps")
    given = parser.parse_args()
    numba.set_num_threads(1)
    results = Results(given.out, "stability", given.quick)
    for chart in (limits, implicit_maps, windings, inputs):
        chart.draw(results, given.quick)
        results.progress(chart.__name__)
    silent = results.cells(
        "wrong",
        ("ours_waist", "ours_conjugate", "ours_friction", "ours_noise", "ours_units", "ours_stretch", "time_step"),
        "meshwind",
    )
    results.table("silent_wrong_answers", silent)
    for row in silent:
        print("  wrong without a warning:", row)
    results.finish(f"{len(silent)} wrong answers by meshwind without a warning")


if __name__ == "__main__":
    main()
