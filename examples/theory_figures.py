"""Draws the figures of the theory's pages: examples/figures/PAGE_NAME.png, and prints the numbers that they show.

    python examples/theory_figures.py

--only equilibrium,bridging takes some of the pages.
"""

import argparse
import inspect
from importlib import import_module
from pathlib import Path

from charts.style import save
from matplotlib.figure import Figure

PAGES = ("equilibrium", "geodesics", "bridging", "layups", "comparisons", "errata")


def main() -> None:
    """Draw and write."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("out/theory_figures"), help="folder for the pictures")
    parser.add_argument("--only", default=",".join(PAGES), help="pages by commas")
    given = parser.parse_args()
    given.out.mkdir(parents=True, exist_ok=True)
    for page in given.only.split(","):
        module = import_module(f"figures.{page}")
        for name, draw in inspect.getmembers(module, inspect.isfunction):
            if draw.__module__ == module.__name__ and draw.__annotations__ == {"return": Figure}:
                save(draw(), given.out, f"{page}_{name}")
                print(f"wrote {given.out / page}_{name}.png", flush=True)


if __name__ == "__main__":
    main()
