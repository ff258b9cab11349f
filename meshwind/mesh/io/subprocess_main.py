"""Main program of the process that `in_subprocess` starts: it reads files with libraries that may end it.

Each line of standard input is a module, a function of it and a path.  The answer is a line of JSON, with the size of
an .npz that follows, or with the reason why there is none.  A process that ends gives no answer.
"""

import io
import json
import os
import sys
from collections.abc import Callable
from importlib import import_module
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np

from meshwind.core.errors import BadInputError
from meshwind.mesh.io.in_subprocess import Arrays

MAX_MEMORY, MEMORY_PER_BYTE = 4 << 30, 100
"""Limit of memory in bytes, and by how much each byte of the file raises it."""


def main() -> None:
    """Answer until standard input ends."""
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())  # libraries must not print into the answers
    for line in sys.stdin:
        module, name, path = json.loads(line)
        _limit_memory(Path(path).stat().st_size)
        _answer(answers, getattr(import_module(module), name), Path(path))
        answers.flush()


def _answer(answers: BinaryIO, read: Callable[[Path], Arrays], path: Path) -> None:
    """Read a file and write the answer.  Any other error than those named here ends the process."""
    packed = b""
    head: dict[str, Any]
    try:
        held = io.BytesIO()
        np.savez(held, allow_pickle=False, **read(path))
        packed = held.getvalue()
        head = {"size": len(packed)}
    except BadInputError as error:
        head = {"refused": str(error)}
    except (ValueError, OSError, MemoryError) as error:
        head = {"failed": str(error)}
    except (ArithmeticError, AssertionError, AttributeError, LookupError, RuntimeError, SystemExit, TypeError):
        head = {"failed": ""}
    answers.write(json.dumps(head).encode() + b"\n" + packed)


def _limit_memory(size: int) -> None:
    """Limit the memory for a file of so many bytes."""
    if sys.platform == "win32":
        return
    import resource

    _, hard = resource.getrlimit(resource.RLIMIT_AS)
    most = MAX_MEMORY + MEMORY_PER_BYTE * size
    resource.setrlimit(resource.RLIMIT_AS, (most if hard == resource.RLIM_INFINITY else min(most, hard), hard))


if __name__ == "__main__":
    main()
