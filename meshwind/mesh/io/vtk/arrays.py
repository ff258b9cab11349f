"""How many points, cells and nodes the arrays of a VTU or VTP file hold: VTK reads only as many as are announced.

The arrays are not decoded: their text is counted, and binary ones begin with their length (VTK's file formats, "XML").
"""

import base64
import binascii
import re
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

_TAG = re.compile(rb"<(/?)(Points|Verts|Lines|Polys|Strips|Cells|DataArray)\b([^>]*)>")
_ATTRIBUTE = re.compile(rb"\b(\w{1,40})\s*=\s*[\"']\s*([^\"']{0,80}?)\s*[\"']")
_FILE = re.compile(rb"<VTKFile\b([^>]*)>")
_APPENDED = re.compile(rb"<AppendedData\b([^>]*)>\s*_")
_SIZES = {b"Int8": 1, b"UInt8": 1, b"Int16": 2, b"UInt16": 2, b"Int32": 4, b"UInt32": 4, b"Int64": 8, b"UInt64": 8,
          b"Float32": 4, b"Float64": 8}  # fmt: skip
"""Bytes of a value by the type of its array."""
_COUNTED = {
    (b"Polys", b"offsets"): "polygons", (b"Strips", b"offsets"): "strips", (b"Cells", b"offsets"): "cells",
    (b"Polys", b"connectivity"): "nodes of polygons", (b"Strips", b"connectivity"): "nodes of strips",
    (b"Cells", b"connectivity"): "nodes of cells",
}  # fmt: skip
"""What an array of a section has a value of each of, by its name."""
_POINTS = b"Points"
_BLANKS = np.frombuffer(b" \t\n\r\v\f\0", np.uint8)
_HEAD = 200
"""Length of the part of an array in which its length is, with blanks and line ends."""


@dataclass(frozen=True)
class _Form:
    """How arrays are written: the integers before binary ones, and where those are that are not in place.

    code: of a header's integers for NumPy; appended: where these arrays begin, -1 if there are none.
    """

    code: str
    is_compressed: bool
    appended: int
    is_raw: bool

    @classmethod
    def of(cls, content: bytes) -> "_Form":
        """The form that a file names."""
        held = _FILE.search(content)
        names = dict(_ATTRIBUTE.findall(held[1])) if held else {}
        order = ">" if names.get(b"byte_order") == b"BigEndian" else "<"
        size = 8 if names.get(b"header_type") == b"UInt64" else 4
        appended = _APPENDED.search(content)
        is_raw = appended is not None and dict(_ATTRIBUTE.findall(appended[1])).get(b"encoding") == b"raw"
        return cls(f"{order}u{size}", b"compressor" in names, appended.end() if appended else -1, is_raw)

    def length(self, content: bytes, at: int, is_raw: bool) -> int | None:
        """Number of bytes of the binary array that begins at a place, None where it cannot be told."""
        if not self.is_compressed:
            return None if (held := self._integers(content, at, is_raw, 1)) is None else held[0]
        blocks = self._integers(content, at, is_raw, 1)
        if blocks is None or blocks[0] == 0:
            return None if blocks is None else 0
        held = self._integers(content, at, is_raw, 3)  # blocks, bytes of each, and of the last one if it is shorter
        if held is None:
            return None
        return (held[0] - (held[2] > 0)) * held[1] + held[2]

    def _integers(self, content: bytes, at: int, is_raw: bool, count: int) -> list[int] | None:
        size = count * np.dtype(self.code).itemsize
        part = content[at : at + _HEAD]
        if not is_raw:
            letters = b"".join(part.split())[: 4 * -(-size // 3)]
            try:
                part = base64.b64decode(letters, validate=True)
            except binascii.Error:
                return None
        if len(part) < size:
            return None
        return [int(each) for each in np.frombuffer(part[:size], self.code)]


def held_by_xml(content: bytes) -> dict[str, int]:
    """Numbers of points, polygons, strips and cells, and of nodes of these, that the arrays of all pieces hold.

    What cannot be told is left out: arrays of unknown type, of several time steps, or with a damaged length.
    """
    form = _Form.of(content)
    found: dict[str, int] = {}
    unknown = set()
    for key, names, at in _arrays(content):
        count = None if b"TimeStep" in names else _values(content, form, names, at)
        if count is None:
            unknown.add(key)
        else:
            found[key] = found.get(key, 0) + (-(-count // 3) if key == "points" else count)
    return {key: count for key, count in found.items() if key not in unknown}


def _arrays(content: bytes) -> Iterator[tuple[str, dict[bytes, bytes], int]]:
    """What each array that is counted holds, its attributes, and where its text begins."""
    end = content.find(b"<AppendedData")
    section = b""
    for tag in _TAG.finditer(content, 0, end if end >= 0 else len(content)):
        if tag[2] != b"DataArray":
            section = b"" if tag[1] or tag[3].endswith(b"/") else tag[2]
        elif not tag[1] and section:
            names = dict(_ATTRIBUTE.findall(tag[3]))
            key = "points" if section == _POINTS else _COUNTED.get((section, names.get(b"Name", b"").lower()), "")
            if key:
                yield key, names, tag.end()


def _values(content: bytes, form: _Form, names: dict[bytes, bytes], at: int) -> int | None:
    """Number of values of an array, None where it cannot be told."""
    written = names.get(b"format", b"ascii").lower()
    size = _SIZES.get(names.get(b"type", b""))
    if written == b"ascii":
        stop = content.find(b"<", at)
        return words_in(content, at, stop if stop >= 0 else len(content))
    if size is None:
        return None
    if written == b"binary":
        length = form.length(content, at, is_raw=False)
    elif written == b"appended" and form.appended >= 0 and names.get(b"offset", b"").isdigit():
        length = form.length(content, form.appended + int(names[b"offset"]), form.is_raw)
    else:
        return None
    return None if length is None else -(-length // size)


def words_in(content: bytes, start: int, stop: int) -> int:
    """How many words there are between two places of a text."""
    blank = np.concatenate([[True], np.isin(np.frombuffer(content, np.uint8, stop - start, start), _BLANKS)])
    return int(np.count_nonzero(blank[:-1] & ~blank[1:]))


def check_held(held: dict[str, int], read: dict[str, int]) -> None:
    """Raise ValueError if the arrays hold more than was read."""
    for key, count in read.items():
        if held.get(key, 0) > count:
            raise ValueError(f"its arrays hold {held[key]} {key}, of which it announces {count} only")
