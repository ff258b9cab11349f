"""Whether an IGES file is cut short, which OpenCASCADE does not say.

The last line of a file, its terminate section, counts the lines of the sections before it (IGES 5.3, clause 2.2.4.6),
and the directory says where each entity's parameters are (clause 2.2.4.4).
"""

import re
from codecs import BOM_UTF8
from collections import Counter
from pathlib import Path

from meshwind.core.errors import BadInputError
from meshwind.core.opencascade import IGES

_LETTER = slice(72, 73)
"""Column of the letter of a line's section."""
_FIRST, _COUNT = slice(8, 16), slice(24, 32)
"""Columns of an entity's first line of parameters, and of their number, in the two lines of its directory entry."""
_TERMINATE = re.compile(rb"S *(\d+)G *(\d+)D *(\d+)P *(\d+)")


def about_end(path: Path) -> tuple[str, ...]:
    """Warnings of a file whose end is not what it announces.  Raises BadInputError if parameters are missing."""
    if path.suffix.lower() not in IGES:
        return ()
    lines = path.read_bytes().removeprefix(BOM_UTF8).splitlines()
    found = Counter(line[_LETTER] for line in lines)
    entries = [line for line in lines if line[_LETTER] == b"D"]
    wanted = max((_last(*pair) for pair in zip(entries[::2], entries[1::2], strict=False)), default=0)
    if found[b"P"] < wanted or len(entries) % 2:
        raise BadInputError(
            f"{path.name}: is cut short, as {found[b'P']} of {wanted} lines of its parameter section are there; copy "
            "it or export it again"
        )
    end = next((_TERMINATE.match(line) for line in lines if line[_LETTER] == b"T"), None)
    if end is None:
        return ("its last line, which counts the others, is missing; it may be cut short",)
    return tuple(
        f"{found[letter]} of {int(count)} lines of its section {letter.decode()} are there; it may be cut short"
        for letter, count in zip((b"S", b"G", b"D", b"P"), end.groups(), strict=True)
        if found[letter] < int(count)
    )


def _last(one: bytes, two: bytes) -> int:
    """Number of an entity's last line of parameters, 0 if its directory entry does not say."""
    try:
        return int(one[_FIRST]) + max(int(two[_COUNT] or 1), 1) - 1
    except ValueError:
        return 0
