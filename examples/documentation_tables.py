"""Put the results of the scripts into README and the site: their tables, and the figures in their sentences.

    python examples/documentation_tables.py --keep out/*

--keep takes the tables that the pages need from folders of results and keeps them in `benchmarks/results`, and their
charts in `gallery`; without it the pages are made from what is kept.  `benchmarks/claims.csv` then says which lines of
which table, or which test, each table and sentence rests on.  `tests/test_documentation_figures.py` fails where a page
is another than this makes it.
"""

import argparse
import csv
import json
import shutil
from pathlib import Path

from documentation.documents import ROOT, documents
from documentation.kept import RESULTS, Kept
from documentation.page import filled, traced, untrue
from documentation.tables import NEEDED
from gallery import small

GALLERY = Path(__file__).parent / "gallery"
PICTURES = {
    "speed_and_accuracy": "speed_and_accuracy",
    "time_step": "stability",
    "ours_friction": "friction",
    "rough_mesh_to_surface": "rough_meshes",
}
"""Charts that the pages show, by the names of their files, and what they are called there."""
CLAIMS = RESULTS.with_name("claims.csv")


def keep(folder: Path) -> list[str]:
    """Copy the tables and charts that the pages need from a folder of results, whose run must have been a whole one."""
    report = folder / "results.json"
    if not report.is_file():
        return []
    if json.loads(report.read_text(encoding="utf-8"))["quick"]:
        raise SystemExit(f"{folder} is of a quick run; the pages show whole ones")
    names = [name for name in NEEDED if (folder / f"{name}.csv").is_file()]
    for name in names:
        shutil.copyfile(folder / f"{name}.csv", RESULTS / f"{name}.csv")
    charts = [name for name in PICTURES if (folder / f"{name}.png").is_file()]
    for name in charts:
        small(folder / f"{name}.png", GALLERY / f"{PICTURES[name]}.png")
    return names + charts


def main() -> None:
    """Keep results, write the pages and the table of claims."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--keep", type=Path, nargs="+", default=[], help="folders of results to take tables from")
    given = parser.parse_args()
    for folder in given.keep:
        print(f"{folder}: {', '.join(keep(folder)) or 'nothing that a page needs'}")
    before = documents()
    for name, text in filled(before, Kept()).items():
        if text != before[name]:  # a notebook, of which this is not the file, has no table
            (ROOT / name).write_text(text, encoding="utf-8")
    rows = list(traced())
    with CLAIMS.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, ["claim", "rests on"], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    for text in untrue(Kept()):
        print("no longer so:", text)
    print(f"{len(rows)} tables and sentences")


if __name__ == "__main__":
    main()
