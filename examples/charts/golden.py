"""Rewrites the golden file that the tests hold the methods to."""

import json
from pathlib import Path

from comparison.golden import figures


def rewrite(path: Path) -> None:
    """Measure errors and counts anew and write them."""
    path.write_text(json.dumps(figures(), indent=1) + "\n", encoding="utf-8")
    print(f"wrote {path}")
