"""Where each method fails: maps of success and failure, with the theory's limit where there is one.

    python examples/stability.py --out out/stability

Writes PNG maps, their cells as CSV, and everything as results.json, in under 10 minutes on two cores; --quick draws
coarser maps in under 2.
"""

import argparse
from pathlib import Path

import numba
from charts import (
    folds,
    implicit_maps,
    inputs,
    laminates,
    limits,
    rest_states,
    rewound,
    ribs,
    rough_meshes,
    turnarounds,
    windings,
)
from charts.record import Results
from threadpoolctl import threadpool_limits

CHARTS = (
    limits,
    implicit_maps,
    windings,
    inputs,
    ribs,
    rest_states,
    rough_meshes,
    folds,
    laminates,
    turnarounds,
    rewound,
)
OURS_IN = (
    "ours_waist",
    "ours_conjugate",
    "ours_friction",
    "ours_noise",
    "ours_units",
    "ours_stretch",
    "time_step",
    "rough_ribs",
    "rough_rest_states",
    "rough_bumps",
    "rough_meshes",
    "rough_folds",
    "rough_layers",
    "turnarounds",
    "rewound_tube",
)
"""Tables with answers of ours."""
SILENT = ("wrong", "understated")
"""Classes of answers that look right and are not, or not as nearly as they say."""


def main() -> None:
    """Measure, draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/stability"), help="folder for charts and figures")
    parser.add_argument("--quick", action="store_true", help="coarser maps")
    given = parser.parse_args()
    numba.set_num_threads(1)
    threadpool_limits(1)  # SciPy solves thousands of small systems for each shape
    results = Results(given.out, "stability", given.quick)
    for chart in CHARTS:
        chart.draw(results, given.quick)
        results.progress(chart.__name__)
    results.table("outcomes", results.outcomes())
    silent = [row for result in SILENT for row in results.cells(result, OURS_IN, "meshwind")]
    results.table("silent_wrong_answers", silent)
    for row in silent:
        print(f"  {row['result']} without a warning:", row)
    wrong, understated = (sum(row["result"] == result for row in silent) for result in SILENT)
    results.finish(
        f"{wrong} wrong answers by meshwind without a warning, {understated} with a length off by more than stated"
    )


if __name__ == "__main__":
    main()
