"""A study in TOML: options of `wind` with lists of values, and the cases that their combinations make."""

import hashlib
import itertools
import json
import re
from collections.abc import Mapping
from dataclasses import asdict, dataclass, fields
from enum import StrEnum
from os import PathLike
from pathlib import Path
from typing import Any

from meshwind.core.brief import brief
from meshwind.core.checks import path_given
from meshwind.core.errors import BadInputError
from meshwind.core.option import options_of
from meshwind.core.parsing import nearest, read_toml
from meshwind.core.version import version
from meshwind.workflow.band_plan import check_band
from meshwind.workflow.options import Options

MAX_CASES = 100_000
"""Most cases of one study; more are a mistake in a list."""
FIT_OPTIONS = ("component", "ends", "opening", "side", "opening_by", "tolerance", "units")
"""Options that reading and fitting depend on: cases with the same values share a fitted part."""
_OPTIONS = options_of(Options)
_NAMES = {field.name.replace("_", "-"): field.name for field in fields(Options)}
_FILES = ("mesh", "pins")
_MAX_NAME = 40
"""Most characters of a mesh's name in the name of a folder."""


Cell = str | int | float | None
Row = dict[str, Cell]
"""A row of a study's table, by its columns."""


class CaseStatus(StrEnum):
    """How a case ended; one that was refused or lost has no figures."""

    AT_REST = "at rest"
    NOT_ALL_AT_REST = "not all at rest"
    REFUSED = "refused"
    LOST = "lost"

    @property
    def has_figures(self) -> bool:
        """Whether the case was wound."""
        return self in (CaseStatus.AT_REST, CaseStatus.NOT_ALL_AT_REST)


@dataclass(frozen=True)
class Case:
    """One winding of a study: the mesh file, the options, and whether pictures are drawn.

    key: the same in every study for the same content of the file, options and version of meshwind; it names the
    folder of the case.
    """

    mesh: Path
    options: Options
    render: bool
    key: str

    @property
    def folder(self) -> str:
        """Name of its folder: that of the mesh without special characters, and the key."""
        return f"{re.sub('[^A-Za-z0-9_-]+', '-', self.mesh.stem)[:_MAX_NAME].strip('-') or 'part'}-{self.key}"

    @property
    def shared(self) -> tuple[object, ...]:
        """What the fitted part depends on."""
        field = self.options.friction if isinstance(self.options.friction, str) else ""
        return str(self.mesh), field, *(getattr(self.options, name) for name in FIT_OPTIONS)


@dataclass(frozen=True)
class Study:
    """The cases in their order; swept: names of the options that differ between them, as in the file."""

    cases: tuple[Case, ...]
    swept: tuple[str, ...]

    __repr__ = brief

    def __len__(self) -> int:
        return len(self.cases)


def read_study(study: str | PathLike[str] | Mapping[str, Any]) -> Study:
    """Read a study from a file, to whose folder paths in it are relative, or from what it would hold.

    Its top level holds options of `meshwind wind` by their long names, and mesh; all combinations of the values in
    lists become cases.  Each table [[case]] makes cases of its own, and takes what it does not name from the top level.
    Raises BadInputError, with one line, where anything is wrong with any case.
    """
    if isinstance(study, Mapping):
        path, common = Path("study"), {str(key).replace("_", "-"): value for key, value in study.items()}
    else:
        path = path_given(study, "study", "file, or the study itself as a dict")
        common = read_toml(path, "study")
    tables = common.pop("case", None)
    if tables is not None and not (isinstance(tables, list) and all(isinstance(table, dict) for table in tables)):
        raise BadInputError(f"{path}: case is not a table; write each list of values under a line [[case]]")
    cases: dict[str, Case] = {}
    hashes: dict[Path, str] = {}
    for table in tables or [{}]:
        for values in _combined(path, common | table):
            case = _case(path, values, hashes)
            cases.setdefault(case.key, case)
    if not cases:
        raise BadInputError(f"{path}: a list is empty, so there is no case; give it a value")
    return Study(tuple(cases.values()), _swept(list(cases.values())))


def _combined(path: Path, given: Mapping[str, Any]) -> list[dict[str, Any]]:
    """All combinations of the lists."""
    if "mesh" not in given:
        raise BadInputError(f"{path}: mesh is missing; give a file or a list of files")
    for key in given:
        if key not in (*_NAMES, "mesh", "render"):
            raise BadInputError(f"{path}: {key!r} is no option; {nearest(key, ('mesh', 'render', 'case', *_NAMES))}")
    plain = [value.tolist() if hasattr(value, "tolist") else value for value in given.values()]  # of NumPy and pandas
    lists = [list(value) if isinstance(value, list | tuple | range) else [value] for value in plain]
    many = 1
    for values in lists:
        many *= len(values)
    if many > MAX_CASES:
        raise BadInputError(f"{path}: the lists make {many:,} cases, and {MAX_CASES:,} are allowed; sweep fewer values")
    return [dict(zip(given, values, strict=True)) for values in itertools.product(*lists)]


def _case(path: Path, values: Mapping[str, Any], hashes: dict[Path, str]) -> Case:
    """The case with these values by the names of the file; hashes: of the files that were hashed before."""
    given = dict(values)
    for name in _FILES:
        if name in given:
            given[name] = str(given[name]) if isinstance(given[name], PathLike) else given[name]
            if not isinstance(given[name], str) or not given[name].strip():
                raise BadInputError(f"{path}: {name} is {given[name]!r}; give the path of a file, in quotes")
            given[name] = str(path.parent / given[name])
    mesh, render = Path(given.pop("mesh")), given.pop("render", False)
    if not isinstance(render, bool):
        raise BadInputError(f"{path}: render is {render!r}; give true or false")
    try:
        options = Options(**{_NAMES[key]: _read(_NAMES[key], value) for key, value in given.items()})
        check_band(options)
    except BadInputError as error:
        raise BadInputError(f"{path}: {error}") from error
    files = [mesh] if options.pins is None else [mesh, Path(options.pins)]
    contents = [hashes.setdefault(file, _hash(file)) for file in files]
    same = {"files": contents, "options": asdict(options) | {"pins": None}, "render": render, "version": version()}
    key = hashlib.sha256(json.dumps(same, sort_keys=True).encode()).hexdigest()[:12]
    return Case(mesh, options, render, key)


def _read(name: str, value: Any) -> Any:
    """The value of an option, read from its text where it may be a number or a word."""
    read = _OPTIONS[name].read
    return read(value) if read is not None and isinstance(value, str) else value


def _hash(file: Path) -> str:
    """The hash of a file's content, or its name where it cannot be read: the case will say why."""
    try:
        with file.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return str(file)


def _swept(cases: list[Case]) -> tuple[str, ...]:
    """The names of what has more than one value, in the order of the options."""
    names = ["mesh"] if len({case.mesh for case in cases}) > 1 else []
    return (*names, *(key for key, name in _NAMES.items() if len({getattr(c.options, name) for c in cases}) > 1))
