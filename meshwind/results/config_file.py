"""meshwind.toml: the options of a run, which `--config` repeats."""

import json
import os
from collections.abc import Mapping
from pathlib import Path

from meshwind.results.schema import CONFIG


def write_config(path: Path, out: Path, options: Mapping[str, object], version: str, command: str = "wind") -> None:
    """Write options by their long names; paths (Path) are written relative to `out`, the folder of the file."""
    lines = [
        f"# meshwind {version}: repeat this run with `meshwind {command} --config {CONFIG}`",
        "# paths are relative to this file",
    ]
    for name, value in options.items():
        key = name.replace("_", "-")
        given = _from(value, out) if isinstance(value, Path) else value
        lines.append(f"# {key}: not given" if given is None else f"{key} = {_toml(given)}")
    path.write_text("\n".join(lines) + "\n", encoding="utf-8", errors="replace")


def _toml(value: object) -> str:
    """A number, string or boolean as TOML: written as JSON, except for floats, which keep every bit."""
    return repr(value) if isinstance(value, float) else json.dumps(value, ensure_ascii=False)


def _from(file: Path, folder: Path) -> str:
    """The path of a file relative to a folder, with symbolic links resolved."""
    try:
        return Path(os.path.relpath(os.path.realpath(file), os.path.realpath(folder))).as_posix()
    except ValueError:  # on another drive
        return file.absolute().as_posix()
