"""shell.json: what a deck for CalculiX does not hold, but whoever reads its results needs."""

import json
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument, called
from meshwind.exporting.material import INTERACTION, STRENGTHS, Material
from meshwind.results.schema import LAYER_SURFACES, PATHS, SPLINE

_DIGITS = 16


@dataclass(frozen=True)
class About:
    """Name of the part, unit of length, fingerprints of the run and of the deck's file, and the material."""

    name: str
    units: str
    run: str
    deck: str
    material: Material


@dataclass(frozen=True)
class Strengths:
    """Strengths in MPa by the names of `STRENGTHS`, none if they are not known, and the interaction of stresses."""

    of: dict[str, float]
    interaction: float


@dataclass(frozen=True)
class ReadAbout:
    """What was read of it: as `About`, but of the material its words and strengths."""

    name: str
    units: str
    run: str
    deck: str
    material: str
    strengths: Strengths


def fingerprint(file: Path) -> str:
    """Text that two files share only if their bytes are the same."""
    return sha256(file.read_bytes()).hexdigest()[:_DIGITS]


def fingerprint_of_run(folder: Path) -> str:
    """The same of what a deck is made of: a run's surfaces and paths; "" if the folder holds no run."""
    files = [folder / name for name in (SPLINE, PATHS, LAYER_SURFACES) if (folder / name).is_file()]
    if not files:
        return ""
    return sha256("".join(map(fingerprint, files)).encode("ascii")).hexdigest()[:_DIGITS]


def again() -> str:
    """What writes a deck, for messages."""
    return f"{called('export')} with {argument('to', 'inp')}"


def write_about(file: Path, about: About) -> None:
    """Write the file."""
    material = about.material
    strengths = {name: float(value) for name, value in material.strengths.items()}
    figures = {
        "part": about.name,
        "units": about.units,
        "run": about.run,
        "deck": about.deck,
        "material": {
            "name": material.name,
            "words": material.words,
            "strengths_mpa": strengths,
            INTERACTION: material.interaction,
        },
    }
    file.write_text(json.dumps(figures, indent=2) + "\n", encoding="utf-8")


def read_about(file: Path) -> ReadAbout:
    """Read the file; raises BadInputError if it is not there or is damaged."""
    try:
        held: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
        material = held["material"]
        strengths = {str(name): float(value) for name, value in material["strengths_mpa"].items()}
        if strengths and (set(strengths) != set(STRENGTHS) or min(strengths.values()) <= 0.0):
            raise ValueError
        words = str(material["words"] or material["name"])
        part, units, run, deck = (str(held[name]) for name in ("part", "units", "run", "deck"))
        return ReadAbout(part, units, run, deck, words, Strengths(strengths, float(material[INTERACTION])))
    except FileNotFoundError as error:
        raise BadInputError(
            f"{file} is missing, which says the strengths of the deck; write it again: {again()}"
        ) from error
    except (OSError, ValueError, LookupError, TypeError, AttributeError) as error:
        raise BadInputError(f"{file} is damaged; write it again: {again()}") from error
