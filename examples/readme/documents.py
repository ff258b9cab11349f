"""The documentation: README and the pages of the site, which hold their own text each."""

from pathlib import Path

ROOT = Path(__file__).parents[2]
SITE = ROOT / "examples" / "site"
README = "README.md"


def documents() -> dict[str, str]:
    """The text of README and of each page in Markdown, by their paths from the project's folder."""
    files = [ROOT / README, *sorted(SITE.rglob("*.md"))]
    return {file.relative_to(ROOT).as_posix(): file.read_text(encoding="utf-8") for file in files}
