"""Running CalculiX on a deck."""

import re
import subprocess
from pathlib import Path
from shutil import copyfile, which

from meshwind.core.errors import BadInputError
from meshwind.core.spoken import argument

PROGRAM = "ccx"
"""Name of CalculiX's solver."""
_JOB = "shell"
_LONGEST = 160
"""Characters of an error of CalculiX that are repeated."""
_SINGULAR = re.compile(r"singular|zero pivot|rigid body", re.IGNORECASE)
_FULL = re.compile(r"not enough memory|cannot allocate|u_calloc|u_malloc|insufficient", re.IGNORECASE)
_DIVERGED = re.compile(r"increment size smaller|best solution|divergen|no convergence", re.IGNORECASE)


def found(program: str = PROGRAM) -> str:
    """Path of CalculiX; raises BadInputError where it is not."""
    path = which(program)
    if path is None:
        raise BadInputError(
            f"no program {program!r} is here to solve the deck; install CalculiX (Debian: apt-get install "
            f"calculix-ccx), or give its path: {argument('ccx')}"
        )
    return str(Path(path).absolute())


def run(program: str, deck: Path, folder: Path) -> Path:
    """Solve a deck in an empty folder; return its tables.  Raises BadInputError with what CalculiX says if it fails."""
    copyfile(deck, folder / f"{_JOB}.inp")
    try:
        done = subprocess.run(
            [program, _JOB], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, check=False
        )  # fmt: skip
    except OSError as error:
        raise BadInputError(f"cannot run {program}: {error.strerror or error}; give the path of CalculiX") from error
    said = (done.stdout + done.stderr).decode(errors="replace")
    errors = _errors(said)
    table = folder / f"{_JOB}.dat"
    if errors or done.returncode or "Job finished" not in said:
        raise BadInputError(f"CalculiX failed on {deck.name}: {_reason(errors, said, done.returncode)}")
    if not table.is_file():
        raise BadInputError(f"CalculiX wrote no results of {deck.name}; see that {program} is CalculiX")
    return table


def _errors(said: str) -> list[str]:
    """What follows each *ERROR, with the lines that go on from it, as one line each."""
    found: list[str] = []
    lines = iter(said.splitlines())
    for line in lines:
        if "*ERROR" in line.upper():
            words = [line.strip().removeprefix("*ERROR").lstrip(" :")]
            for more in lines:
                if not more.startswith("  ") or not more.strip():
                    break
                words.append(more.strip())
            found.append(" ".join(" ".join(words).split())[:_LONGEST])
    return found


def _reason(errors: list[str], said: str, code: int) -> str:
    """What went wrong, and what to do about it."""
    what = errors[0] if errors else f"it ended with status {code}"
    if code < 0:
        return f"{what}, by signal {-code}; it may lack memory: export fewer elements ({argument('elements')})"
    if _DIVERGED.search(said):
        return f"{what}; the load is too large for this laminate, or too large a step: lower it"
    if _FULL.search(said):
        return f"{what}; export fewer elements ({argument('elements')})"
    if _SINGULAR.search(said):
        return f"{what}; something is not held: see {argument('held')} of the export"
    return f"{what}; run `{PROGRAM} {_JOB}` in the folder for all that it says, or export the deck again"
