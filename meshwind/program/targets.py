"""The files of a program: program.csv, program.json, and what a machine or a robot reads."""

import json
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np

from meshwind.core.brief import brief
from meshwind.core.compile_ahead import compile_ahead
from meshwind.core.defaults import MACHINE
from meshwind.core.errors import BadInputError
from meshwind.core.parsing import nearest
from meshwind.core.units import UNKNOWN, millimetres
from meshwind.core.version import version
from meshwind.program.blocks import LEGEND, TRAVEL, columns
from meshwind.program.machine import read_machine
from meshwind.program.posts.dialects import DIALECTS
from meshwind.program.program import Program, program
from meshwind.program.readback.compare import ReadBack
from meshwind.program.rewinding.rewind import Ground, rewind
from meshwind.program.robot import HEADER, rows
from meshwind.program.robot import LEGEND as OF_POSES
from meshwind.program.seen import SECONDS, SEEN, check, write_seen
from meshwind.program.texts import write_texts
from meshwind.program.work import Work
from meshwind.results.folder import beside
from meshwind.results.legends import write_legend
from meshwind.results.reading import read_results
from meshwind.results.report import plain
from meshwind.results.schema import POSES, PROGRAM_CSV, PROGRAM_JSON, PROGRAM_LEGEND

Writer: TypeAlias = Callable[[Path, Program], list[str]]
"""Writes into an existing folder; returns what the user should know."""


@dataclass(frozen=True)
class Written:
    """A program that was written, its files, its figures as in program.json, notes, and its texts as read back."""

    program: Program
    files: tuple[Path, ...]
    figures: dict[str, Any]
    notes: tuple[str, ...]
    texts: dict[str, ReadBack]

    __repr__ = brief

    @property
    def sound(self) -> bool:
        """Whether nothing is wrong with the program, and its texts say what it does."""
        return not self.program.faults and all(found.same for found in self.texts.values())


def write_program(
    folder: str | PathLike[str],
    machine: str = MACHINE,
    to: Sequence[str] = (),
    out: str | PathLike[str] | None = None,
    tension: float = 0.0,
    seconds: float = SECONDS,
    again: bool = True,
    progress: Callable[[str], None] | None = None,
) -> Written:
    """Write the program for the filament of a run's folder into `out`, by default the folder itself.

    program.csv and program.json are always written, and what `to` names of `TARGETS` beside them.  All files appear,
    or none.  seconds: of a movie; again: whether the program is wound again by physics; progress: called with the name
    of each stage as it starts.  Raises BadInputError if the folder has no filament, or a machine or a target is not
    known.
    """
    known = (*TARGETS, *SEEN, *DIALECTS)
    for name in to:
        if name not in known:
            raise BadInputError(f"target {name!r} is not known; {nearest(name, known)}")
    check(to, seconds)
    say: Callable[[str], None] = progress or (lambda _stage: None)
    used = read_machine(machine)
    results = read_results(folder)
    work = Work.of(results)
    if again:
        compile_ahead(("program",), say)
    say("program")
    made = program(work, used, tension)
    if again:
        say("wind again")
    rewound = rewind(made, Ground.of(results)) if again else None
    if rewound is not None:
        made = replace(made, faults=tuple(sorted([*made.faults, *rewound.faults(made.blocks, work.units)])))
    target = Path(folder if out is None else out)
    notes: list[str] = []
    with beside(target) as staging:
        say("write")
        wanted = dict.fromkeys(("csv", *to))
        for name in (each for each in wanted if each in TARGETS):
            notes += TARGETS[name](staging, made)
        texts = write_texts(staging, made, [name for name in wanted if name in DIALECTS])
        notes += write_seen(staging, results, made, [name for name in wanted if name in SEEN], seconds, progress)
        names = sorted(path.relative_to(staging) for path in staging.rglob("*") if path.is_file())
        names = sorted([*names, Path(PROGRAM_JSON)])
        figures = figures_of(made) | {
            "rewound": None if rewound is None else plain(rewound.figures),
            "texts": plain({name: asdict(found) for name, found in texts.items()}),
            "files": [name.as_posix() for name in names],
        }
        (staging / PROGRAM_JSON).write_text(json.dumps(figures, indent=1, allow_nan=False) + "\n", encoding="utf-8")
    return Written(made, tuple(target / name for name in names), figures, tuple(notes), texts)


def figures_of(made: Program) -> dict[str, Any]:
    """The figures of a program, for program.json."""
    blocks, mandrel = made.blocks, made.mandrel
    back = np.maximum(-np.diff(blocks.mandrel), 0.0)
    laying = np.diff(blocks.arc_length) > 0.0
    span = blocks.free_length[blocks.kind != TRAVEL]
    return plain({
        "meshwind": version(),
        "part": made.work.name,
        "machine": {"name": made.machine.name, "words": made.machine.words, "dialect": made.machine.dialect},
        "axis": {"origin": mandrel.origin, "direction": mandrel.direction, "zero": mandrel.zero},
        "units": made.work.units or UNKNOWN,
        "blocks": len(blocks),
        "seconds": made.seconds,
        "seconds_of_layers": made.seconds_of_layers,
        "limits": made.limits,
        "fibre": {
            "laid": float(blocks.arc_length[-1]),
            "speed": float((blocks.arc_length[-1] - blocks.arc_length[0]) / max(made.seconds, 1e-300)),
            "free_length": {"min": float(span.min()), "max": float(span.max())},
        },
        "clearance": made.clearance,
        "nearest": made.nearest,
        "turns": float(blocks.mandrel[-1] - blocks.mandrel[0]) / 360.0,
        "turned_back": {
            "laying": float(back[laying].sum()), "standing": float(back[~laying].sum()),
            "most": float(_stretches(back).max(initial=0.0)),
        },
        "cuts": [
            {"index": cut, "tied": tied, "layer": blocks.layer[tied], "seconds": blocks.time[tied] - blocks.time[cut]}
            for cut, tied in blocks.travels
        ],
        "lost": made.losses,
        "remedies": made.remedies,
        "faults": [{"index": each.index, "kind": each.kind, "words": each.words} for each in made.faults],
    })  # fmt: skip


def _stretches(back: Any) -> Any:
    """Sums of positive values in a row."""
    run = np.cumsum(back == 0.0)
    return np.bincount(run, back) if len(back) else back


def _csv(folder: Path, made: Program) -> list[str]:
    """Write program.csv and what its columns are."""
    held = columns(made.blocks)
    table = np.column_stack(list(held.values()))
    formats = 6 * ["%d"] + (table.shape[1] - 6) * ["%.12g"]
    write_legend(folder / PROGRAM_LEGEND, LEGEND, made.work.units)
    with (folder / PROGRAM_CSV).open("w", encoding="ascii") as file:
        np.savetxt(file, table, fmt=formats, delimiter=",", header=",".join(held), comments="")
    return []


def _poses(folder: Path, made: Program) -> list[str]:
    """Write poses.csv."""
    table = rows(made.blocks, made.mandrel, millimetres(made.work.units))
    formats = 7 * ["%d"] + (table.shape[1] - 7) * ["%.12g"]
    legend = "".join(f"# {name}: {words}\n" for name, words in OF_POSES.items())
    with (folder / POSES).open("w", encoding="ascii") as file:
        file.write(legend)
        np.savetxt(file, table, fmt=formats, delimiter=",", header=HEADER, comments="")
    return []


TARGETS: dict[str, Writer] = {"csv": _csv, "poses": _poses}
"""What can be written, by name."""
