"""A study in TOML: options of `wind` with lists in the place of values, and the cases that they make."""

import hashlib
import itertools
import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.core.parsing import count, turns
from meshwind.core.toml import nearest, read_toml
from meshwind.core.version import version
from meshwind.workflow.options import Options

MOST = 100_000
"""Cases of one study; more are a slip in a list."""
SHARED = ("component", "ends", "opening", "tolerance")
"""Options that reading and fitting depend on: cases that agree in them share a fitted part."""
_NAMES = {field.name.replace("_", "-"): field.name for field in fields(Options)}
_FILES = ("mesh", "pins")
_LONGEST = 40


@dataclass(frozen=True)
class Case:
    """One winding of a study: the mesh's file, its options, and whether pictures are drawn.

    key: the same for the same file's content, options and version of meshwind, whatever the study; it names the
    case's folder.
    """

    mesh: Path
    options: Options
    render: bool
    key: str

    @property
    def folder(self) -> str:
        """Name of its folder: the mesh's, made harmless, and the key."""
        return f"{re.sub('[^A-Za-z0-9_-]+', '-', self.mesh.stem)[:_LONGEST].strip('-') or 'part'}-{self.key}"

    @property
    def shared(self) -> tuple[object, ...]:
        """What a fitted part is the same for."""
        field = self.options.friction if isinstance(self.options.friction, str) else ""
        return str(self.mesh), field, *(getattr(self.options, name) for name in SHARED)


@dataclass(frozen=True)
class Study:
    """The cases in their order; swept: names of what differs between them, as in the file."""

    cases: tuple[Case, ...]
    swept: tuple[str, ...]

    def __len__(self) -> int:
        return len(self.cases)


def read_study(file: str | Path) -> Study:
    """Read a study; paths in it are relative to its folder.

    At the top stand options of `meshwind wind` by their long names, mesh among them; a list is swept over, and all
    lists are combined.  Each table [[case]] is a product of its own, which takes from the top what it does not name.
    Raises BadInputError, in one line, for whatever is wrong with any case.
    """
    path = Path(file)
    told = read_toml(path, "study")
    tables = told.pop("case", None)
    if tables is not None and not (isinstance(tables, list) and all(isinstance(table, dict) for table in tables)):
        raise BadInputError(f"{path}: case is no table; write each list of values under a line [[case]]")
    cases: dict[str, Case] = {}
    hashes: dict[Path, str] = {}
    for table in tables or [{}]:
        for values in _combined(path, told | table):
            case = _case(path, values, hashes)
            cases.setdefault(case.key, case)
    if not cases:
        raise BadInputError(f"{path}: a list is empty, so that there is no case; give it a value")
    return Study(tuple(cases.values()), _swept(list(cases.values())))


def _combined(path: Path, told: Mapping[str, Any]) -> list[dict[str, Any]]:
    """All combinations of the lists."""
    if "mesh" not in told:
        raise BadInputError(f"{path}: mesh is missing; give a file or a list of files")
    for key in told:
        if key not in (*_NAMES, "mesh", "render"):
            raise BadInputError(f"{path}: {key!r} is no option; {nearest(key, ('mesh', 'render', 'case', *_NAMES))}")
    lists = [value if isinstance(value, list) else [value] for value in told.values()]
    many = 1
    for values in lists:
        many *= len(values)
    if many > MOST:
        raise BadInputError(f"{path}: the lists make {many:,} cases, and {MOST:,} are allowed; sweep fewer values")
    return [dict(zip(told, values, strict=True)) for values in itertools.product(*lists)]


def _case(path: Path, values: Mapping[str, Any], hashes: dict[Path, str]) -> Case:
    told = dict(values)
    for name in _FILES:
        if name in told:
            if not isinstance(told[name], str) or not told[name].strip():
                raise BadInputError(f"{path}: {name} is {told[name]!r}; give the path of a file, in quotes")
            told[name] = str(path.parent / told[name])
    mesh, render = Path(told.pop("mesh")), told.pop("render", False)
    if not isinstance(render, bool):
        raise BadInputError(f"{path}: render is {render!r}; give true or false")
    if isinstance(told.get("revolutions"), str):
        told["revolutions"] = turns(told["revolutions"])
    if isinstance(told.get("particles"), str):
        told["particles"] = count(told["particles"])
    told.setdefault("units", "mm")
    try:
        options = Options(**{_NAMES[key]: value for key, value in told.items()})
    except BadInputError as error:
        raise BadInputError(f"{path}: {error}") from error
    files = [mesh] if options.pins is None else [mesh, Path(options.pins)]
    held = [hashes.setdefault(file, _hash(file)) for file in files]
    same = {"files": held, "options": asdict(options) | {"pins": None}, "render": render, "version": version()}
    key = hashlib.sha256(json.dumps(same, sort_keys=True).encode()).hexdigest()[:12]
    return Case(mesh, options, render, key)


def _hash(file: Path) -> str:
    """Of a file's content; of its name where it cannot be read: the case will say why."""
    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return str(file)


def _swept(cases: list[Case]) -> tuple[str, ...]:
    """What takes more than one value, in the order of the options."""
    names = ["mesh"] if len({case.mesh for case in cases}) > 1 else []
    return (*names, *(key for key, name in _NAMES.items() if len({getattr(c.options, name) for c in cases}) > 1))
