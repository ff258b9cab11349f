"""The documentation: README and the pages of the site, which hold their own text each."""

import json
from pathlib import Path

ROOT = Path(__file__).parents[2]
SITE = ROOT / "examples" / "site"
README = "README.md"


def documents() -> dict[str, str]:
    """The text of README, of each page and of each notebook in Markdown, by their paths from the project's folder."""
    pages = sorted(file for file in SITE.rglob("*") if file.suffix in {".md", ".ipynb"})
    texts = {file: file.read_text(encoding="utf-8") for file in (ROOT / README, *pages)}
    return {
        file.relative_to(ROOT).as_posix(): as_markdown(text) if file.suffix == ".ipynb" else text
        for file, text in texts.items()
    }


def as_markdown(notebook: str) -> str:
    """The text of a notebook: what it says, and its code as blocks of Python."""
    cells = json.loads(notebook)["cells"]
    texts = (("".join(cell["source"]), cell["cell_type"]) for cell in cells)
    return "\n\n".join(f"```python\n{text}\n```" if kind == "code" else text for text, kind in texts) + "\n"
