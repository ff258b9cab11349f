"""A program in the words of machines: written, read back, and compared."""

from pathlib import Path

from meshwind.core.units import millimetres
from meshwind.program.posts.dialect import fitted
from meshwind.program.posts.dialects import dialect, file_names
from meshwind.program.posts.header import Job
from meshwind.program.posts.writer import program_text
from meshwind.program.program import Program
from meshwind.program.readback.compare import Part, ReadBack, read_back


def write_texts(folder: Path, made: Program, names: list[str]) -> dict[str, ReadBack]:
    """Write a program in dialects into an existing folder; what comes of reading each file back, by its name.

    Raises BadInputError if a dialect is not known or cannot say the program.
    """
    scale = millimetres(made.work.units)
    part = Part(made.mandrel, scale, made.work.diagonal)
    found = {}
    for name, file in file_names(names).items():
        spoken = dialect(name)
        text = program_text(made.blocks, made.machine, spoken, Job(made.work.name, scale))
        (folder / file).write_text(text, encoding="ascii")
        held = (folder / file).read_text(encoding="ascii")
        found[file] = read_back(held, made.blocks, fitted(made.machine, spoken), part)
    return found
