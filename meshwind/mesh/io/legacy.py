"""Check a legacy VTK file before VTK reads it: on damaged ones VTK ends the process."""

import re

import numpy as np

from meshwind.core.cast import Ints

_LISTS = rb"^(?:VERTICES|LINES|POLYGONS|TRIANGLE_STRIPS|CELLS)\s+(\d{1,10})\s+(\d{1,10})[ \t\r]*\n"
_DAMAGED = "damaged, cut short or of another format"


def check_legacy(content: bytes) -> None:
    """Raise ValueError where version and cells disagree, or where lists of cells do not add up."""
    version = re.match(rb"# vtk DataFile Version (\d)\.\d\s*\n[^\n]*\n\s*(ASCII|BINARY)", content)
    if version is None:
        raise ValueError(_DAMAGED)
    lists = list(re.finditer(_LISTS, content, re.MULTILINE))
    split = re.search(rb"^OFFSETS ", content, re.MULTILINE) is not None  # since version 5
    if lists and split != (int(version[1]) >= 5):
        raise ValueError(_DAMAGED)
    if split or version[2] == b"ASCII":
        return
    for found in lists:
        count, size = int(found[1]), int(found[2])
        if found.end() + 4 * size > len(content):
            raise ValueError(_DAMAGED)
        numbers = np.frombuffer(content, ">i4", size, found.end()).astype(np.int64)
        if not _adds_up(numbers, count):
            raise ValueError(_DAMAGED)


def _adds_up(numbers: Ints, count: int) -> bool:
    """Whether `count` cells, each its size and then its nodes, fill the numbers just so.

    A chain of steps, followed by doubling their length: no loop over cells.
    """
    size = len(numbers)
    step = np.minimum(np.arange(size) + 1 + np.maximum(numbers, 0), size + 1)
    step = np.concatenate([step, [size + 1, size + 1]])  # the end, and beyond it
    place = 0
    while count:
        if count & 1:
            place = int(step[place])
        step = step[step]
        count >>= 1
    return place == size
