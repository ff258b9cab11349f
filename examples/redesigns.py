"""Redesign parts of data/ until no fibre bridges: rounds, gaps before and after, displacement and volume.

    python examples/redesigns.py --out out/redesigns

Each part is edited for a winding or for two at once, with 12 paths per family, and wound anew from the edited mesh.
Writes redesigns.csv.
"""

import argparse
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from charts.record import Results

import meshwind as mw

DATA = Path(__file__).parents[1] / "data"
CASES = (
    ("vase.stl", (0.3,)),
    ("vase.stl", (0.8,)),
    ("bottle.obj", (0.5,)),
    ("cast.ply", (0.5,)),
    ("vase.stl", (0.3, 0.8)),
    ("cast.ply", (0.5, 0.8)),
)
"""Parts, and the revolutions of their windings."""
PATHS = 12
"""Of each family."""


def measure(part: str, revolutions: tuple[float, ...]) -> dict[str, Any]:
    """The row of one redesign; gaps are those of each winding."""
    with TemporaryDirectory() as folder:
        found = mw.redesign(str(DATA / part), paths=PATHS, revolutions=revolutions)
        report = mw.write_redesign(found, Path(folder) / "out", render=False)
    edit, windings = report["redesign"], report["windings"]
    gaps = {when: " ".join(repr(each["max_gap"][when]) for each in windings) for when in ("before", "after")}  # type: ignore[literal-required]
    return {
        "part": part, "revolutions": " ".join(f"{each:g}" for each in revolutions), "rounds": edit["rounds"],
        "bridged before": edit["bridged"]["before"], "gaps before": gaps["before"], "gaps after": gaps["after"],
        "displacement": edit["displacement"]["max"], "volume": edit["volume"]["relative"], "windable": edit["windable"],
    }  # fmt: skip


def main() -> None:
    """Edit, print, write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/redesigns"), help="folder for the table")
    parser.add_argument("--quick", action="store_true", help="one part alone")
    given = parser.parse_args()
    results = Results(given.out, "redesigns", given.quick)
    rows = []
    for part, revolutions in CASES[: 1 if given.quick else None]:
        rows.append(measure(part, revolutions))
        print(", ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    results.table("redesigns", rows)
    results.finish(f"{len(rows)} redesigns")


if __name__ == "__main__":
    main()
